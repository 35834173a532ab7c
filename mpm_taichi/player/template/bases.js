// The functions of mpm_taichi/bases: which nodes a particle touches, and with what weight.

/** Per axis: nodes, the first at xi = x / dx, their weights and slopes (per cell) at a = xi - first;
 *  l is the half width of the particle [cells]. */
const HAT = {
  support: 2,
  first: xi => Math.floor(xi),
  weights: a => [1 - a, a],
  slopes: () => [-1, 1],
};
const QUADRATIC = {
  support: 3,
  first: xi => Math.floor(xi - 0.5),
  weights: a => [0.5 * (1.5 - a) ** 2, 0.75 - (a - 1) ** 2, 0.5 * (a - 0.5) ** 2],
  slopes: a => [a - 1.5, 2 - 2 * a, a - 0.5],
};
const CUBIC = {
  support: 4,
  first: xi => Math.floor(xi) - 1,
  weights: a => [0, 1, 2, 3].map(k => {
    const r = Math.abs(a - k);
    return r < 1 ? 2 / 3 - r * r + r ** 3 / 2 : (2 - r) ** 3 / 6;
  }),
  slopes: a => [0, 1, 2, 3].map(k => {
    const r = Math.abs(a - k);
    return Math.sign(a - k) * (r < 1 ? r * (1.5 * r - 2) : -0.5 * (2 - r) ** 2);
  }),
};
const GIMP = {
  support: 3,
  first: xi => Math.floor(xi - 0.5),
  weights: (a, l) => {
    const side = r => r > 1 - l ? Math.max(1 + l - r, 0) ** 2 / (4 * l) : 1 - r;
    const [low, high] = [side(a), side(2 - a)];
    return [low, 1 - low - high, high];
  },
  slopes: (a, l) => {
    const side = r => r > 1 - l ? -Math.max(1 + l - r, 0) / (2 * l) : -1;
    const [low, high] = [side(a), -side(2 - a)];
    return [low, -low - high, high];
  },
};
const BASES = {
  linear: HAT,
  gimp: GIMP,
  quadratic: QUADRATIC,
  cubic: CUBIC,
  quadratic_boundary: { ...QUADRATIC, modified: true },
  cubic_boundary: { ...CUBIC, modified: true },
};

const isWall = rule => rule != "none" && rule != "periodic";

/** Along an axis: the first node, weights and slopes of a particle at xi.  With a modified basis
 *  the node behind a wall gives what it has to the two before it, as if v_-1 = 2 v_0 - v_1. */
function weighAxis(basis, xi, l, cells, walls) {
  let first = basis.first(xi);
  const last = basis.support - 1, [lower, upper] = walls.map(rule => basis.modified && isWall(rule));
  if (upper) first = Math.min(first, cells + 1 - last);
  const w = basis.weights(xi - first, l), dw = basis.slopes(xi - first, l);
  const bend = (behind, wall, before) => {
    for (const part of [w, dw]) {
      part[wall] += 2 * part[behind];
      part[before] -= part[behind];
      part[behind] = 0;
    }
  };
  if (lower && first == -1) bend(0, 1, 2);
  if (upper && first == cells + 1 - last) bend(last, last - 1, last - 2);
  return { first, w, dw };
}

/** The nodes that a particle at x touches in 2D: place (x / dx), weight w and its gradient dw
 *  [1/m]. */
function stencilOf(name, x, radius, domain) {
  const dx = domain.size[0] / domain.cells[0];
  const [a, b] = [0, 1].map(axis => weighAxis(
    BASES[name], x[axis] / dx, radius / dx, domain.cells[axis], domain.walls[axis]));
  return a.w.flatMap((_, i) => b.w.map((_, j) => ({
    place: [a.first + i, b.first + j],
    w: a.w[i] * b.w[j],
    dw: [a.dw[i] * b.w[j] / dx, a.w[i] * b.dw[j] / dx],
  })));
}
