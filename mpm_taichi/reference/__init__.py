"""The NumPy twin: the same method in plain loops and float64, file by file and name by name.

No rows, no lanes, no sorting, no Taichi: what must match is the mathematics.  Read a stage here
first; tests hold the fast form to it."""
