// The step that follows a frame, stage by stage: what a stage has to show of the picked particle
// and its nodes, and where the walk stands.

const UNRECORDED = "This run has recorded no stages. To see them, run its scene with " +
  "\u201c--set output.stages=true\u201d and export it again.";
const MOVED_CELLS = 0.4;  // about, by which the fastest node of the particle is seen to move

class Walk {
  constructor(film) {
    Object.assign(this, { film, stages: film.stages, isOn: false, number: 0 });
  }

  get isThere() { return this.film.dimension == 2; }
  get last() { return (this.stages?.stages.length ?? 1) - 1; }
  get name() { return this.stages.stages[this.number].name; }

  /** Whether this stage, by its formulas, gives a new value to a symbol. */
  gives(symbol, { formulas } = this.stages.stages[this.number]) {
    return formulas.some(line => line.startsWith(`${symbol} `));
  }

  /** Whether a symbol has had its new value. */
  hasGiven(symbol) {
    return this.stages.stages.findIndex(stage => this.gives(symbol, stage)) <= this.number;
  }

  /** All of a particle in the step after frame k; its nodes have place, x, w, dw, mass and v, their
   *  velocity at this stage. */
  moment(k, p) {
    const { film, stages, name } = this, dt = stages.lengths[k], nodes = stages.frames[k];
    const dx = film.domain.size[0] / film.domain.cells[0], x = film.position(k, p);
    const mine = stencilOf(stages.basis, x, film.radius[p], film.domain)
      .map(node => ({ ...node, i: nodes.at(node.place), x: node.place.map(i => i * dx) }))
      .filter(({ i }) => i !== undefined);
    const moving = name == "nodes to particles" ? "grid update" : name;
    const isStill = name == "reset";
    const velocityIn = (stage, i) => isStill ? [0, 0] : nodes.velocity(stage, i);
    for (const node of mine) {
      node.v = velocityIn(moving, node.i);
      node.mass = isStill ? 0 : nodes.mass[node.i];
    }
    const step = mine.map(({ i, w }) => nodes.velocity("grid update", i).map(v => w * v * dt))
      .reduce(added, [0, 0]);
    const v = stages.of("velocity", k, p), gain = stages.of("gain", k, p);
    const speeds = mine.map(({ i }) => Math.hypot(...nodes.velocity("grid update", i)));
    return {
      name, dt, dx, nodes, mine, x, isStill,
      velocityOf: i => velocityIn(moving, i),
      isGridMoved: moving == "grid update",
      step: this.hasGiven("x_p") ? step : [0, 0],
      v: this.hasGiven("v_p") ? added(v, gain) : v,
      L: velocityGradient(mine, x, stages.inverseMoment, dx),
      larger: roundLength(Math.max(MOVED_CELLS * dx / (Math.max(...speeds) * dt || Infinity), 1)),
    };
  }

  /** Rows of a symbol and a value, for the panel. */
  rows(k, p, moment) {
    const { film, stages } = this, { name, dt, x, step, v, L } = moment;
    const place = ["x_p", vector(added(x, step), "m", 4)];
    const velocity = ["v_p", vector(v, "m/s", 3)];
    if (name == "particles to nodes") {
      const [xx, yy, xy] = stages.of("stress", k, p), [a, b, c, d] = stages.of("gradient", k, p);
      return [
        ["m_p", withUnit(film.mass[p], "kg", 4, false)], place, velocity,
        ["sigma_p", matrix([xx, xy, xy, yy], "Pa")], ["F_p", matrix([1 + a, b, c, 1 + d], "")],
      ];
    }
    if (name == "grid update") return [["dt", withUnit(dt, "s")]];
    if (name == "reset") return [velocity, place];
    return [velocity, ["L_p", matrix(L, "1/s")], place].filter(([symbol]) => this.gives(symbol));
  }

  show(k, p) {
    byId("walk").hidden = !this.isOn;
    byId("walk-button").setAttribute("aria-pressed", this.isOn);
    if (!this.isOn) return null;
    const say = words => {
      byId("walk-title").textContent = "Stages of a step";
      for (const part of ["formulas", "numbers", "nodes"]) byId(`walk-${part}`).replaceChildren();
      byId("walk-note").textContent = words;
      return null;
    };
    if (!this.stages) return say(UNRECORDED);
    if (!this.stages.frames[k]) return say("Loading ...");
    if (p == null) return say("Click a particle.");
    if (this.film.isGone(k, p)) return say(`Particle ${p} has left.`);
    if (this.stages.lengths[k] == 0) return say("The step after this frame has failed.");
    const moment = this.moment(k, p), { formulas } = this.stages.stages[this.number];
    byId("walk-title").textContent = `Stage ${this.number + 1} of ${this.last + 1}: ${this.name}`;
    byId("walk-formulas").replaceChildren(...formulas.map(line => {
      const row = make("p", {});
      row.append(...formula(line));
      return row;
    }));
    byId("walk-numbers").replaceChildren(...this.rows(k, p, moment).flatMap(([symbol, value]) => {
      const [word, number] = [make("dt", {}), make("dd", {})];
      word.append(...formula(symbol));
      number.append(value);
      return [word, number];
    }));
    byId("walk-nodes").replaceChildren(...nodeRows(moment));
    byId("walk-note").textContent = moment.larger == 1 || this.name == "particles to nodes"
      ? `Particle ${p}.` : `Particle ${p}. Motion is drawn ${plain(moment.larger, 6)} times as far.`;
    return moment;
  }
}

const added = (a, b) => a.map((entry, axis) => entry + b[axis]);

/** L_p [xx, xy, yx, yy] (1/s), of the gradients of the weights or, with an inverse moment, of
 *  moments. */
function velocityGradient(mine, x, inverseMoment, dx) {
  return mine.map(node => {
    const g = inverseMoment == null ? node.dw
      : node.x.map((at, axis) => node.w * (at - x[axis]) * inverseMoment / dx ** 2);
    return node.v.flatMap(v => g.map(slope => v * slope));
  }).reduce(added, [0, 0, 0, 0]);
}

/** Two rows in brackets, and a unit. */
function matrix(entries, unit) {
  const whole = make("span", { className: "with-unit" });
  const box = make("span", { className: "matrix" });
  box.append(...entries.map(entry => make("span", {}, plain(entry, 4))));
  whole.append(box, unit);
  return whole;
}

/** Of the unit in which a magnitude is a handy number. */
function powerOfThousand(magnitude) {
  const isHandy = magnitude == 0 || (magnitude >= 0.1 && magnitude < 1e4);
  return isHandy ? 0 : 3 * Math.floor(Math.log10(magnitude) / 3);
}

const weight = w => w > 0 && w < 5e-4 ? "< 0.001" : w.toFixed(3);

/** The table of the nodes: place, weight, mass, velocity. */
function nodeRows({ name, mine, isStill }) {
  if (isStill) return [];
  const row = (kind, cells) => {
    const made = make("tr", {});
    made.append(...cells.map(cell => {
      const box = make(kind, {});
      box.append(...[cell].flat());
      return box;
    }));
    return made;
  };
  const motion = name == "particles to nodes" ? "(m v)_i / m_i" : "v_i";
  const head = ["i", "w_ip", "m_i", motion].map(formula);
  const [factor, prefixed] = prefix(Math.max(...mine.flatMap(({ v }) => v.map(Math.abs))));
  const power = powerOfThousand(Math.max(...mine.map(({ mass }) => mass)));
  head[2].push(" [", ...(power ? formula(`10^${power} `) : []), "kg]");
  head[3].push(` [${prefixed}m/s]`);
  return [
    row("th", head),
    ...mine.map(({ place, w, mass, v }) => row("td", [
      place.map(i => plain(i)).join(", "), weight(w), plain(mass / 10 ** power, 3),
      v.map(entry => plain(entry / factor, 3)).join(", "),
    ])),
    row("td", [formula("sum_i"), mine.reduce((sum, { w }) => sum + w, 0).toFixed(3), "", ""]),
  ];
}
