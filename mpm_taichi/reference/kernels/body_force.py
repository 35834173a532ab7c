"""Before P2G: the body force of a formula, at the particles."""


def push(particles, grid, body_force, time, dt):
    """On return the force of each particle is dt m b(X, x, t), b the force per mass [m/s^2]."""
    b = body_force.value(particles.X, particles.x, time)
    particles.force[:] = dt * particles.m[:, None] * b
