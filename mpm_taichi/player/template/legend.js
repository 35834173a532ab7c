// What the colors mean, and the colors themselves.

class Colors {
  constructor(film) {
    this.film = film;
    this.maps = Object.fromEntries(
      Object.entries(film.palette).map(([name, codes]) => [name, codes.map(rgb)]));
    this.values = new Float32Array(film.particles);
    this.bytes = new Uint8Array(4 * wholeRows(film.particles)).fill(255);
  }

  /** [n, 4] bytes of all particles of a frame, by a quantity. */
  of(quantity, k) {
    const { film, values, bytes } = this, { bodies } = this.maps;
    if (quantity.name == "body") {
      film.body.forEach((body, p) => bytes.set(bodies[body % bodies.length], 4 * p));
      return bytes;
    }
    film.values(quantity, k, values);
    const map = this.maps[quantity.map], last = map.length - 1, [low, high] = quantity.shown;
    const factor = last / (high - low);
    for (let p = 0; p < values.length; p++) {
      const shade = map[Math.min(Math.max(Math.round((values[p] - low) * factor), 0), last)];
      bytes[4 * p] = shade[0];
      bytes[4 * p + 1] = shade[1];
      bytes[4 * p + 2] = shade[2];
    }
    return bytes;
  }

  /** Fills the element of the legend: a dot and a name for each body, or a bar with three ticks. */
  describe(quantity, element) {
    element.replaceChildren();
    if (quantity.name == "body") {
      const { bodies } = this.film, codes = this.film.palette.bodies;
      bodies.forEach((name, i) => {
        const item = make("span", { className: "body" }, name);
        item.style.setProperty("--color", `#${codes[i % codes.length]}`);
        element.append(item);
      });
      return;
    }
    const [low, high] = quantity.shown, codes = this.film.palette[quantity.map];
    const values = [low, (low + high) / 2, high];
    const [labels, unit] = tickLabels(values, quantity.unit, quantity.prefixed);
    const bar = make("div", { className: "bar" });
    const stops = codes.filter((_, i) => i % 15 == 0).map(code => `#${code}`);
    bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
    const ticks = make("div", { className: "ticks" });
    ticks.append(...labels.map(label => make("span", {}, label)));
    const scale = make("div", { className: "scale" });
    scale.append(make("div", {}, quantity.label + (unit && ` [${unit}]`)), bar, ticks);
    element.append(scale);
  }
}
