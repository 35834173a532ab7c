// The energies over time, with a cursor that can be dragged.

const LEFT = 44, RIGHT = 8, TOP = 14, BOTTOM = 20;  // pixels around the curves
const SERIES = ["kinetic", "elastic", "gravitational", "dissipated", "total"];

/** Their sum at each place. */
function withTotal(energies) {
  const sum = i => SERIES.slice(0, 4).reduce((total, name) => total + energies[name][i], 0);
  return { ...energies, total: energies.kinetic.map((_, i) => sum(i)) };
}

/** The series that are more than rounding errors. */
function notZero(energies) {
  const largest = name => Math.max(...energies[name].map(Math.abs));
  const all = Math.max(...SERIES.map(largest));
  return SERIES.filter(name => largest(name) > 1e-9 * all);
}

class Chart {
  constructor(film, canvas, key) {
    Object.assign(this, { film, canvas });
    this.curves = withTotal(film.history.curves);
    this.frames = withTotal(film.history.frames);
    this.shown = notZero(this.curves);
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
  }

  /** `seek(time)` is called where the user points. */
  onSeek(seek) {
    const { canvas } = this;
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
    const { canvas, low, high, frames } = this;
    const { clientWidth: width, clientHeight: height } = canvas;
    const pen = onPixels(canvas, pixelRatio), style = getComputedStyle(canvas);
    const end = this.curves.time.at(-1) || 1;
    Object.assign(this, { pen, end, right: width - RIGHT, bottom: height - BOTTOM });
    this.color = name => style.getPropertyValue(`--${name}`);
    this.x = time => LEFT + time / end * (width - LEFT - RIGHT);
    this.y = energy => TOP + (high - energy) / (high - low) * (height - TOP - BOTTOM);
    this.drawAxes();
    this.drawCurves();
    this.drawCursor(this.x(this.film.times[k]), name => frames[name][k]);
    for (const [name, output] of this.outputs) output.value = withUnit(frames[name][k], "J");
  }

  drawAxes() {
    const { pen, x, y, color, end, right, bottom } = this;
    const energies = roundTicks(this.low, this.high), [labels, joule] = tickLabels(energies, "J");
    const times = roundTicks(0, end), [moments, second] = tickLabels(times, "s");
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "middle";
    pen.fillStyle = color("quiet");
    pen.lineWidth = 1;
    pen.textAlign = "right";
    energies.forEach((energy, i) => {
      pen.strokeStyle = color(energy == 0 ? "edge" : "faint-edge");
      segment(pen, LEFT, y(energy), right, y(energy));
      pen.fillText(labels[i], LEFT - 6, y(energy));
    });
    times.forEach((time, i) => {
      pen.textAlign = i == 0 ? "left" : x(time) > right - 16 ? "right" : "center";
      pen.fillText(moments[i] + (i == 0 ? ` ${second}` : ""), x(time), bottom + 13);
    });
    pen.textAlign = "left";
    pen.fillText(joule, 0, 7);
  }

  drawCurves() {
    const { pen, x, y } = this, { time } = this.curves;
    pen.lineWidth = 1.75;
    pen.lineJoin = "round";
    for (const name of this.shown) {
      pen.strokeStyle = this.color(name);
      pen.setLineDash(name == "total" ? [5, 3] : []);
      pen.beginPath();
      this.curves[name].forEach((energy, i) => pen.lineTo(x(time[i]), y(energy)));
      pen.stroke();
    }
    pen.setLineDash([]);
  }

  drawCursor(now, energyOf) {
    const { pen } = this;
    pen.strokeStyle = this.color("text");
    pen.lineWidth = 1;
    segment(pen, now, TOP - 4, now, this.bottom);
    for (const name of this.shown) {
      pen.fillStyle = this.color(name);
      pen.beginPath();
      pen.arc(now, this.y(energyOf(name)), 3, 0, 2 * Math.PI);
      pen.fill();
    }
  }
}

function segment(pen, x0, y0, x1, y1) {
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
  pen.stroke();
}

/** Three to six round numbers from low to high. */
function roundTicks(low, high) {
  const step = roundLength((high - low) / 3), ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i <= high / step + 1e-9; i++) ticks.push(i * step);
  return ticks;
}
