// The energies over time, with a cursor that can be dragged.

const LEFT = 44, RIGHT = 8, TOP = 14, BOTTOM = 20;  // pixels around the curves
const SERIES = ["kinetic", "elastic", "gravitational", "dissipated", "total"];

/** Their sum at each place. */
function withTotal(energies) {
  const parts = SERIES.slice(0, 4).map(name => energies[name]);
  return { ...energies, total: parts[0].map((_, i) => parts.reduce((sum, part) => sum + part[i], 0)) };
}

class Chart {
  /** `seek(time)` is called where the user points. */
  constructor(film, canvas, key, seek) {
    Object.assign(this, { film, canvas });
    this.curves = withTotal(film.history.curves);
    this.frames = withTotal(film.history.frames);
    const largest = name => Math.max(...this.curves[name].map(Math.abs));
    const all = Math.max(...SERIES.map(largest));
    this.shown = SERIES.filter(name => largest(name) > 1e-9 * all);
    const values = this.shown.flatMap(name => this.curves[name]);
    this.low = Math.min(0, ...values);
    this.high = Math.max(0, ...values);
    if (this.high == this.low) this.high = 1;
    this.outputs = this.shown.map(name => {
      const item = make("span", { className: `series ${name}` }, name), output = make("output");
      item.append(output);
      key.append(item);
      return [name, output];
    });
    const point = event => {
      if (event.buttons != 1) return;
      const { left, width } = canvas.getBoundingClientRect();
      const share = (event.clientX - left - LEFT) / (width - LEFT - RIGHT);
      seek(Math.min(Math.max(share, 0), 1) * this.curves.time.at(-1));
    };
    canvas.addEventListener("pointerdown", event => {
      canvas.setPointerCapture(event.pointerId);
      point(event);
    });
    canvas.addEventListener("pointermove", point);
  }

  /** With the cursor at frame k. */
  draw(k, pixelRatio) {
    const { canvas, low, high } = this, style = getComputedStyle(canvas);
    const pen = onPixels(canvas, pixelRatio), width = canvas.clientWidth, height = canvas.clientHeight;
    const end = this.curves.time.at(-1) || 1;
    const x = time => LEFT + time / end * (width - LEFT - RIGHT);
    const y = energy => TOP + (high - energy) / (high - low) * (height - TOP - BOTTOM);
    const color = name => style.getPropertyValue(`--${name}`);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "middle";

    const ticks = roundTicks(low, high), [labels, unit] = tickLabels(ticks, "J");
    pen.lineWidth = 1;
    ticks.forEach((tick, i) => {
      pen.strokeStyle = color(tick == 0 ? "edge" : "faint-edge");
      segment(pen, LEFT, y(tick), width - RIGHT, y(tick));
      pen.fillStyle = color("quiet");
      pen.textAlign = "right";
      pen.fillText(labels[i], LEFT - 6, y(tick));
    });
    pen.textAlign = "left";
    pen.fillText(unit, 0, 7);

    pen.lineWidth = 1.75;
    pen.lineJoin = "round";
    for (const name of this.shown) {
      pen.strokeStyle = color(name);
      pen.setLineDash(name == "total" ? [5, 3] : []);
      pen.beginPath();
      this.curves[name].forEach((energy, i) => pen.lineTo(x(this.curves.time[i]), y(energy)));
      pen.stroke();
    }
    pen.setLineDash([]);

    const times = roundTicks(0, end), [times_, second] = tickLabels(times, "s");
    pen.fillStyle = color("quiet");
    times.forEach((time, i) => {
      pen.textAlign = i == 0 ? "left" : x(time) > width - 24 ? "right" : "center";
      pen.fillText(times_[i] + (i == 0 ? ` ${second}` : ""), x(time), height - 7);
    });

    const now = x(this.film.times[k]);
    pen.strokeStyle = color("ink");
    pen.lineWidth = 1;
    segment(pen, now, TOP - 4, now, height - BOTTOM);
    for (const name of this.shown) {
      pen.fillStyle = color(name);
      pen.beginPath();
      pen.arc(now, y(this.frames[name][k]), 3, 0, 2 * Math.PI);
      pen.fill();
    }
    for (const [name, output] of this.outputs) output.value = withUnit(this.frames[name][k], "J");
  }
}

function segment(pen, ...ends) {
  pen.beginPath();
  pen.moveTo(ends[0], ends[1]);
  pen.lineTo(ends[2], ends[3]);
  pen.stroke();
}

/** Three to six round numbers from low to high. */
function roundTicks(low, high) {
  const step = roundLength((high - low) / 3);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i <= high / step + 1e-9; i++) ticks.push(i * step);
  return ticks;
}
