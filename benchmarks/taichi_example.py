"""Taichi's own example `mpm3d`, from the installed package, at our size and with our law.

Its text is read at run time, a few lines are changed, and the rest runs as it is: one kernel for
the whole step.  Where another version of Taichi has another text, ValueError says which line."""

import importlib.util
import tempfile
from pathlib import Path

import taichi as ti

SOURCE = Path(ti.__file__).parent / "examples" / "simulation" / "mpm3d.py"

LAW = """\
        F_F[p] = (ti.Matrix.identity(float, dim) + dt * F_C[p]) @ F_F[p]
        tau = mu * (F_F[p] @ F_F[p].transpose() - ti.Matrix.identity(float, dim))
        tau += ti.Matrix.identity(float, dim) * (lam * ti.log(F_F[p].determinant()))
        affine = -dt * 4 * p_vol / dx**2 * tau + p_mass * F_C[p]
"""


def changes(dim, cells, count, dt, density, mu, lam) -> dict[str, str]:
    """Old lines and what takes their place: size, constants, and tau = mu (b - I) + lam ln J I in
    place of a fluid's pressure."""
    return {
        "ti.init(arch=ti.gpu)\n": "",
        "\ndim, n_grid, steps, dt = 3, 32, 25, 4e-4\n": (
            f"\ndim, n_grid, dt, mu, lam = {dim}, {cells}, {dt!r}, {mu!r}, {lam!r}\n"
        ),
        "n_particles = n_grid**dim // 2 ** (dim - 1)\n": f"n_particles = {count}\n",
        "p_rho = 1\n": f"p_rho = {density!r}\n",
        "p_vol = (dx * 0.5) ** 2\n": "p_vol = (dx * 0.5) ** dim\n",
        "gravity = 9.8\n": "gravity = 0.0\n",
        "F_J = ti.field(float, n_particles)\n": (
            "F_F = ti.Matrix.field(dim, dim, float, n_particles)\n"
        ),
        "        stress = -dt * 4 * E * p_vol * (F_J[p] - 1) / dx**2\n": "",
        "        affine = ti.Matrix.identity(float, dim) * stress + p_mass * F_C[p]\n": LAW,
        "        F_J[p] *= 1 + dt * new_C.trace()\n": "",
        "        F_J[i] = 1\n": "        F_F[i] = ti.Matrix.identity(float, dim)\n",
    }


class TaichiExample:
    """Particles x, v [n, dim] in a box of cells^dim of edge 1, quadratic B-splines, dt [s]."""

    def __init__(self, x, v, cells, material, dt):
        n, dim = x.shape
        c = material.constants(1.0 / cells)
        text = SOURCE.read_text()
        new = changes(dim, cells, n, float(dt), float(material.density), c["mu"], c["lam"])
        for old, line in new.items():
            if text.count(old) != 1:
                raise ValueError(f"{SOURCE} has not exactly one line {old.strip()!r}")
            text = text.replace(old, line)
        folder = tempfile.TemporaryDirectory()
        path = Path(folder.name) / "mpm3d.py"
        path.write_text(text)
        spec = importlib.util.spec_from_file_location("mpm3d_as_installed", path)
        assert spec is not None and spec.loader is not None
        example = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(example)
        vars(example)["folder"] = folder  # Taichi reads a kernel from its file at the first call
        example.init()
        self.x, self.v = example.F_x, example.F_v
        self.particle_fields = [example.F_x, example.F_v, example.F_C, example.F_F]
        self.node_fields = [example.F_grid_v, example.F_grid_m]
        self.substep = example.substep
        kind = self.x.to_numpy().dtype
        self.x.from_numpy(x.astype(kind))
        self.v.from_numpy(v.astype(kind))
