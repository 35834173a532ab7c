// The numbers of the moment: of the run, and of the picked particle.

class Log {
  constructor(film, element) {
    Object.assign(this, { film, element });
    this.values = new Float32Array(film.particles);
  }

  /** Rows of words and numbers; `picked` is the number of a particle, or null. */
  rows(k, picked) {
    const { film } = this;
    const rows = [["step", String(film.steps[k])], ["time", withUnit(film.times[k], "s", 6)]];
    if (picked == null) {
      rows.push(["particle", "click one to see its values"]);
    } else if (film.isGone(k, picked)) {
      rows.push(["particle", `${picked}, which has left`]);
    } else {
      const velocity = film.velocity(k, picked), m = film.mass[picked];
      const place = film.coordinates.map((channel, axis) =>
        film.low[axis] + film.step[axis] * channel[k * film.particles + picked]);
      rows.push(
        ["particle", `${picked} (${film.bodies[film.body[picked]]})`],
        ["mass", withUnit(m, "kg", 4, false)],
        ["position", vector(place, "m", 4)],
        ["velocity", vector(velocity, "m/s", 3)],
      );
      for (const quantity of film.packed) {
        const value = quantity.low + quantity.step * quantity.channel[k * film.particles + picked];
        rows.push([quantity.label, withUnit(value, quantity.unit, 3, quantity.prefixed)]);
      }
      rows.push(["kinetic energy", withUnit(0.5 * m * Math.hypot(...velocity) ** 2, "J")]);
    }
    for (const [name, energy] of Object.entries(film.history ? withTotal(film.history.frames) : {}))
      rows.push([
        name == "total" ? "energy of all" : `${name} energy of all`, withUnit(energy[k], "J", 4),
      ]);
    return rows;
  }

  show(k, picked) {
    this.element.replaceChildren(...definitions(this.rows(k, picked)));
  }
}

function vector(entries, unit, digits) {
  return `(${entries.map(entry => plain(entry, digits)).join(", ")}) ${unit}`;
}
