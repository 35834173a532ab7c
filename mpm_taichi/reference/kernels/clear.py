"""Stage 1: empty the nodes."""


def clear(grid):
    """On return every node is zero, and so are the largest speed and rate."""
    for field in (grid.m, grid.mv, grid.given, grid.impulse, grid.v_old, grid.v):
        field[:] = 0.0
    grid.speed_squared, grid.rate_squared, grid.compression = 0.0, 0.0, 0.0
