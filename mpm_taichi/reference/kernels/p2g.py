"""Stage 2: particles to nodes."""

from .stencil import moment, stencil, weigh


def affine_momentum(p, particles, grid, basis, transfer):
    """A of a particle, and A without the stress; where D varies, the place of the scatter gives
    it."""
    if not transfer.moments or basis.inverse_moment:
        return particles.A[p], particles.free_A[p]
    _, a, w, _ = weigh(p, particles, grid, basis)
    return particles.A[p] / moment(w, a), particles.free_A[p] / moment(w, a)


def p2g(particles, grid, basis, transfer, what="all"):
    """m_i = sum_p w_ip m_p, (m v)_i = sum_p w_ip (m_p v_p + A_p (x_i - x_p)) and
    impulse_i = sum_p T_p grad w_ip + w_ip dt m_p b_p; MLS-MPM has that of the stress in A.  Of
    these `what` asks for "all" or for mass and "momentum"; or it is the "residual",
    sum_p w_ip m_p R_p."""
    for p in range(particles.count):
        A, free_A = affine_momentum(p, particles, grid, basis, transfer)
        for i, r, w, dw in stencil(p, particles, grid, basis):
            if what == "residual":
                grid.residual[i] += w * particles.m[p] * particles.R[p]
                continue
            grid.m[i] += w * particles.m[p]
            grid.mv[i] += w * (particles.m[p] * particles.v[p] + A @ r)
            grid.given[i] += w * (particles.m[p] * particles.v[p] + free_A @ r)
            if what == "all":
                grid.impulse[i] += w * particles.force[p]
                if transfer.gradient:
                    grid.impulse[i] += particles.T[p] @ dw
