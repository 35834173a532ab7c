// The numbers of the moment: of the run, and of the picked particle.

class Log {
  constructor(film) {
    this.film = film;
    this.energies = film.history && withTotal(film.history.frames);
    this.shown = film.history ? notZero(this.energies) : [];
    byId("sums-title").hidden = !film.history;
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
      rows.push(
        ["particle", `${picked} (${film.bodies[film.body[picked]]})`],
        ["mass", withUnit(m, "kg", 4, false)],
        ["position", vector(film.position(k, picked), "m", 4)],
        ["velocity", vector(velocity, "m/s", 3)],
      );
      for (const quantity of film.packed) {
        const value = quantity.low + quantity.step * quantity.channel[k * film.particles + picked];
        rows.push([quantity.label, withUnit(value, quantity.unit, 3, quantity.prefixed)]);
      }
      rows.push(["kinetic energy", withUnit(0.5 * m * Math.hypot(...velocity) ** 2, "J")]);
    }
    return rows;
  }

  show(k, picked) {
    byId("numbers").replaceChildren(...definitions(this.rows(k, picked)));
    const inJoule = name => withUnit(this.energies[name][k], "J", 4);
    const sums = this.shown.map(name => [`${name} energy`, inJoule(name)]);
    byId("sums").replaceChildren(...definitions(sums));
  }
}

function vector(entries, unit, digits) {
  return `(${entries.map(entry => plain(entry, digits)).join(", ")}) ${unit}`;
}
