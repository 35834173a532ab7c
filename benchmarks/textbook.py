"""The usual Taichi form of one MLS-MPM step, to compare with: separate fields, atomic scatter.

Stage by stage the kernels of Taichi's own example `mpm3d` (taichi.examples.simulation, Apache-2.0;
the structure, not the text), for 2D and 3D, with the law of `materials/neo_hookean.py` in place of
the example's fluid: tau = mu (b - I) + lam ln J I."""

import taichi as ti


@ti.data_oriented
class Textbook:
    """Particles x, v [n, dim], V0 [n] in a box of cells^dim of edge 1, quadratic B-splines."""

    def __init__(self, x, v, V0, cells, material, dt):
        n, self.dim = x.shape
        self.cells, self.dx, self.inv_dx = cells, 1.0 / cells, float(cells)
        self.V0, self.m, self.dt = float(V0[0]), float(material.density * V0[0]), dt
        c = material.constants(self.dx)
        self.mu, self.lam = c["mu"], c["lam"]
        self.x = ti.Vector.field(self.dim, float, n)
        self.v = ti.Vector.field(self.dim, float, n)
        self.C = ti.Matrix.field(self.dim, self.dim, float, n)
        self.F = ti.Matrix.field(self.dim, self.dim, float, n)
        self.grid_v = ti.Vector.field(self.dim, float, (cells,) * self.dim)
        self.grid_m = ti.field(float, (cells,) * self.dim)
        self.neighbor = (3,) * self.dim
        self.x.from_numpy(x.astype(self.x.to_numpy().dtype))
        self.v.from_numpy(v.astype(self.x.to_numpy().dtype))
        self.begin()

    @ti.kernel
    def begin(self):
        for p in self.x:
            self.F[p] = ti.Matrix.identity(float, self.dim)

    @ti.kernel
    def clear(self):
        for i in ti.grouped(self.grid_m):
            self.grid_v[i] = ti.zero(self.grid_v[i])
            self.grid_m[i] = 0

    @ti.kernel
    def p2g(self):
        for p in self.x:
            xi = self.x[p] * self.inv_dx
            base = int(xi - 0.5)
            fx = xi - base
            w = [0.5 * (1.5 - fx) ** 2, 0.75 - (fx - 1) ** 2, 0.5 * (fx - 0.5) ** 2]
            identity = ti.Matrix.identity(float, self.dim)
            self.F[p] = (identity + self.dt * self.C[p]) @ self.F[p]
            J = self.F[p].determinant()
            tau = self.mu * (self.F[p] @ self.F[p].transpose() - identity)
            tau += identity * self.lam * ti.log(J)
            stress = -self.dt * 4 * self.V0 * self.inv_dx**2 * tau
            affine = stress + self.m * self.C[p]
            for offset in ti.static(ti.grouped(ti.ndrange(*self.neighbor))):
                dpos = (offset - fx) * self.dx
                weight = 1.0
                for d in ti.static(range(self.dim)):
                    weight *= w[offset[d]][d]
                self.grid_v[base + offset] += weight * (self.m * self.v[p] + affine @ dpos)
                self.grid_m[base + offset] += weight * self.m

    @ti.kernel
    def grid_update(self):
        for i in ti.grouped(self.grid_m):
            if self.grid_m[i] > 0:
                self.grid_v[i] /= self.grid_m[i]
            for d in ti.static(range(self.dim)):
                if i[d] < 3 and self.grid_v[i][d] < 0:
                    self.grid_v[i][d] = 0
                if i[d] > self.cells - 3 and self.grid_v[i][d] > 0:
                    self.grid_v[i][d] = 0

    @ti.kernel
    def g2p(self):
        for p in self.x:
            xi = self.x[p] * self.inv_dx
            base = int(xi - 0.5)
            fx = xi - base
            w = [0.5 * (1.5 - fx) ** 2, 0.75 - (fx - 1) ** 2, 0.5 * (fx - 0.5) ** 2]
            new_v = ti.zero(self.v[p])
            new_C = ti.zero(self.C[p])
            for offset in ti.static(ti.grouped(ti.ndrange(*self.neighbor))):
                dpos = (offset - fx) * self.dx
                weight = 1.0
                for d in ti.static(range(self.dim)):
                    weight *= w[offset[d]][d]
                g_v = self.grid_v[base + offset]
                new_v += weight * g_v
                new_C += 4 * weight * g_v.outer_product(dpos) * self.inv_dx**2
            self.v[p] = new_v
            self.x[p] += self.dt * new_v
            self.C[p] = new_C
