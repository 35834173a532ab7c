"""Extended particle-in-cell of order m: Hammerquist and Nairn (2017), CMAME 318:724."""

from .flip import FLIP


class XPIC(FLIP):
    """v_p = V - (1 - S S+)^m V + sum_i w_i (v_i - v_i^old), with V the velocities of before, S+ the
    average to the nodes and S the sum over the stencil: order 1 is PIC, and a high order is FLIP
    without the velocities that the nodes do not see.

    G2P leaves what FLIP keeps and PIC loses, (1 - S S+) V; `kernels/residual.py` applies the other
    m - 1 factors and takes the result from the velocity."""

    filtered = True
