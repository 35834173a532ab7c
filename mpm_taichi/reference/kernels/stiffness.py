"""For the time step: how stiff the stiffest particle of a material is."""


def stiffest(particles, group, grid):
    """The largest rho0 c^2 [Pa] of the particles of a material and whose it is, and the largest
    modulus M_d [Pa] of a lone one and whose that is."""
    moduli = {
        p: group.law.moduli(group.constants, particles.H[p], group.state[p]) for p in group.members
    }
    stiffest = max(moduli, key=lambda p: moduli[p][0])
    loneliest = max(moduli, key=lambda p: moduli[p][1])
    return moduli[stiffest][0], stiffest, moduli[loneliest][1], loneliest
