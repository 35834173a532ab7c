"""Stage 2: particles to nodes."""

from .stencil import stencil


def p2g(particles, grid, basis, transfer):
    """m_i = sum_p w_ip m_p, (m v)_i = sum_p w_ip (m_p v_p + A_p (x_i - x_p)) and
    impulse_i = sum_p T_p grad w_ip; MLS-MPM has its impulse in A."""
    for p in range(particles.count):
        for i, r, w, dw in stencil(particles.x[p], grid, basis):
            grid.m[i] += w * particles.m[p]
            grid.mv[i] += w * (particles.m[p] * particles.v[p] + particles.A[p] @ r)
            if transfer.gradient:
                grid.impulse[i] += particles.T[p] @ dw
