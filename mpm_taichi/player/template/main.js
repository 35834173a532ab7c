// The state of the page, and what its controls do to it.

const byId = id => document.getElementById(id);

/** A new element with properties and a text; never markup. */
function make(tag, properties, text) {
  const element = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) element.textContent = text;
  return element;
}

/** Gives a canvas the pixels with which it is shown. */
function fitPixels(canvas, pixelRatio) {
  const width = Math.round(canvas.clientWidth * pixelRatio);
  const height = Math.round(canvas.clientHeight * pixelRatio);
  if (canvas.width != width || canvas.height != height) [canvas.width, canvas.height] = [width, height];
}

/** The pen of a canvas with the pixels with which it is shown; it takes CSS pixels. */
function onPixels(canvas, pixelRatio) {
  fitPixels(canvas, pixelRatio);
  const pen = canvas.getContext("2d");
  pen.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
  return pen;
}

const FILM_SECONDS = 8;  // that a whole run takes to play, about

class Page {
  constructor(film) {
    this.film = film;
    this.theme = readTheme();
    this.camera = new Camera(film.domain.size);
    this.ground = new Ground(film, this.theme);
    this.colors = new Colors(film);
    this.log = new Log(film, byId("numbers"));
    this.chart = film.history && new Chart(film, byId("chart"), byId("key"), time => {
      this.stop();
      this.go(film.frameAt(time));
    });
    byId("energies").hidden = !film.history;
    this.places = new Float32Array(4 * wholeRows(film.particles));
    this.frame = 0;
    this.time = film.times[0];  // s, between the frames too
    this.playing = this.isDue = false;
    this.isGridShown = film.gridOpacity > 0;
    this.picked = null;
    this.quantity = film.quantities.find(quantity => quantity.name == film.colorBy) ?? film.quantities[0];
    this.duration = film.times.at(-1) - film.times[0];
    this.usual = this.duration > 0 ? roundLength(1.2 * this.duration / FILM_SECONDS) : 1;
    this.fillIn();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(byId("stage"));
  }

  /** Texts that do not change. */
  fillIn() {
    const { film } = this, cells = film.domain.cells.join(" \u00d7 ");
    const frames = film.times.length;
    byId("title").textContent = document.title = film.title;
    byId("summary").textContent =
      `${film.particles.toLocaleString("en")} particles, ${cells} cells, ${frames} frames`;
    byId("about").replaceChildren(...definitions(film.about));
    byId("scene").textContent = film.scene;
    byId("drag-words").textContent = film.dimension == 2
      ? "moves the picture" : "turns the picture; with shift or two fingers, moves it";
    byId("color").append(...film.quantities.map(({ name, label }) => make("option", { value: name }, label)));
    byId("color").value = this.quantity.name;
    byId("seek").max = frames - 1;
    byId("opacity").value = film.gridOpacity || 0.25;
    byId("grid").setAttribute("aria-pressed", this.isGridShown);
    this.colors.describe(this.quantity, byId("legend"));
    this.showSettings();
  }

  listen() {
    const clicks = {
      play: () => this.playing ? this.stop() : this.play(),
      step: () => { this.stop(); this.go(this.frame + 1); },
      reset: () => { this.stop(); this.go(0); },
      grid: () => this.toggleGrid(),
      "log-button": () => this.toggleLog(),
    };
    for (const [id, act] of Object.entries(clicks)) byId(id).onclick = act;
    byId("seek").oninput = () => { this.stop(); this.go(+byId("seek").value); };
    byId("speed").oninput = byId("opacity").oninput = () => this.showSettings();
    byId("color").onchange = () => this.colorBy(byId("color").value);
    document.addEventListener("keydown", event => this.press(event));
    matchMedia("(prefers-color-scheme: dark)").onchange = () => this.draw();
    this.gestures = new Gestures(byId("stage"), this.camera, () => this.draw(), (column, row) => {
      this.picked = this.particleAt(column, row);
      if (this.picked != null) this.toggleLog(true);
      this.draw();
    });
    const canvas = byId("particles");
    canvas.addEventListener("webglcontextlost", event => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => { this.painter = null; this.draw(); });
  }

  press(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const focus = document.activeElement?.tagName, key = event.key.length == 1 ? event.key.toLowerCase() : event.key;
    const inSlider = focus == "INPUT" || focus == "SELECT";
    const acts = {
      " ": focus == "BUTTON" || focus == "SELECT" || focus == "SUMMARY" ? null : () => byId("play").click(),
      ArrowLeft: inSlider ? null : () => { this.stop(); this.go(this.frame - 1); },
      ArrowRight: inSlider ? null : () => { this.stop(); this.go(this.frame + 1); },
      Home: inSlider ? null : () => { this.stop(); this.go(0); },
      End: inSlider ? null : () => { this.stop(); this.go(this.film.times.length - 1); },
      g: () => this.toggleGrid(),
      l: () => this.toggleLog(),
      c: focus == "SELECT" ? null : () => this.nextColor(),
      "+": () => this.zoom(1.25),
      "=": () => this.zoom(1.25),
      "-": () => this.zoom(0.8),
      0: () => this.gestures.restore(),
      Escape: () => { this.picked = null; this.draw(); },
    };
    if (!acts[key]) return;
    event.preventDefault();
    acts[key]();
  }

  /** Simulated seconds in a second of the clock. */
  get rate() { return this.usual * 10 ** +byId("speed").value; }

  showSettings() {
    const words = `${withUnit(this.rate, "s")} per second`;
    byId("speed-text").value = words;
    byId("speed").setAttribute("aria-valuetext", `${words} of the clock`);
    byId("opacity-text").value = `${Math.round(100 * byId("opacity").value)} %`;
    this.draw();
  }

  play() {
    if (this.frame == this.film.times.length - 1) this.go(0);
    this.time = this.film.times[this.frame];
    this.playing = true;
    byId("play").textContent = "Stop";
    let before = performance.now();
    const tick = now => {
      if (!this.playing) return;
      this.time += Math.max(now - before, 0) / 1000 * this.rate;
      before = now;
      const frame = this.film.frameAt(this.time);
      if (frame != this.frame) this.show(frame);
      if (this.frame == this.film.times.length - 1) this.stop();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  stop() {
    this.playing = false;
    byId("play").textContent = "Start";
  }

  go(frame) {
    this.show(Math.min(Math.max(frame, 0), this.film.times.length - 1));
    this.time = this.film.times[this.frame];
  }

  /** A frame, or the last that is loaded. */
  show(frame) {
    this.frame = Math.min(frame, this.film.loaded - 1);
    this.draw();
  }

  toggleGrid() {
    this.isGridShown = !this.isGridShown;
    byId("grid").setAttribute("aria-pressed", this.isGridShown);
    this.draw();
  }

  toggleLog(shown = byId("log").hidden) {
    byId("log").hidden = !shown;
    byId("log-button").setAttribute("aria-pressed", shown);
    this.draw();
  }

  nextColor() {
    const { quantities } = this.film;
    const next = quantities[(quantities.indexOf(this.quantity) + 1) % quantities.length];
    byId("color").value = next.name;
    this.colorBy(next.name);
  }

  colorBy(name) {
    this.quantity = this.film.quantities.find(quantity => quantity.name == name);
    this.colors.describe(this.quantity, byId("legend"));
    this.draw();
  }

  zoom(factor) {
    this.camera.zoomBy(factor);
    this.draw();
  }

  resize() {
    const { clientWidth, clientHeight } = byId("stage");
    this.camera.fit(clientWidth, clientHeight);
    this.draw();
  }

  /** The number of the particle that is seen at a place of the stage, or null. */
  particleAt(column, row) {
    const { places, film } = this;
    let found = null, best = -Infinity;
    for (let p = 0; p < film.particles; p++) {
      const [x, y, scale, toward] = this.camera.look(places.subarray(4 * p, 4 * p + 3));
      const away = Math.hypot(x - column, y - row), reach = Math.max(film.radius[p] * scale, 8);
      if (!(away < reach)) continue;
      const merit = film.dimension == 3 ? toward : -away;
      if (merit > best) [found, best] = [p, merit];
    }
    return found;
  }

  /** Before the next picture of the browser. */
  draw() {
    if (this.isDue || this.film.loaded == 0) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.drawNow();
    });
  }

  drawNow() {
    const { film, camera, ground, frame } = this, ratio = devicePixelRatio || 1;
    if (!(camera.width > 0)) return;
    const [under, over] = ["under", "over"].map(id => onPixels(byId(id), ratio));
    for (const pen of [under, over]) pen.clearRect(0, 0, camera.width, camera.height);
    ground.drawUnder(under, camera, this.isGridShown ? +byId("opacity").value : 0);
    this.paint(ratio);
    ground.drawOver(over, camera);
    if (this.picked != null) {
      const at = 4 * this.picked;
      ground.drawRing(over, camera, this.places.subarray(at, at + 3), film.radius[this.picked]);
    }
    const words = `frame ${frame + 1} of ${film.times.length}`, time = withUnit(film.times[frame], "s", 4);
    byId("seek").value = frame;
    byId("seek").setAttribute("aria-valuetext", `${words}, ${time}`);
    byId("clock").value = `${time}  \u00b7  ${words}`;
    byId("stage").setAttribute("aria-label", `${film.title}: particles at ${time}, ${words}`);
    if (!byId("log").hidden) this.log.show(frame, this.picked);
    this.chart?.draw(frame, ratio);
  }

  paint(ratio) {
    const canvas = byId("particles");
    fitPixels(canvas, ratio);
    this.painter ??= new Painter(canvas, this.film, this.theme);
    this.film.places(this.frame, this.places);
    this.painter.draw(this.places, this.colors.of(this.quantity, this.frame), this.camera, ratio);
  }
}

/** The colors of the stage: as CSS, and the two that the painter mixes, from 0 to 1. */
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const read = name => style.getPropertyValue(`--${name}`).trim();
  const parts = name => rgb(read(name).slice(1)).map(part => part / 255);
  return {
    css: {
      background: read("background"), panel: read("panel"), line: read("line"), ink: read("ink"),
      faintInk: read("faint-ink"), wall: read("missing"),
    },
    shadow: parts("shadow"),
    panel: parts("panel"),
  };
}

/** Draws the first frame as soon as it is there, then takes the others. */
async function open() {
  const film = new Film(JSON.parse(byId("header").textContent)), page = new Page(film);
  Object.assign(window.player, { page, film });
  await film.loadParticles();
  for (let block = 0; block < film.blocks; block++) {
    await film.loadBlock(block);
    if (block == 0) {
      page.resize();
      page.drawNow();
      performance.mark("first frame");
    }
    byId("message").textContent = `Loading ${Math.round(100 * film.loaded / film.times.length)} %`;
    await new Promise(resolve => setTimeout(resolve));
  }
  byId("message").hidden = true;
  const isWhole = film.checksum == film.checksumWritten;
  byId("integrity").textContent = isWhole
    ? `Check sum ${film.checksum}: the frames are as they were written.`
    : `This file is damaged: check sum ${film.checksum} instead of ${film.checksumWritten}.`;
  window.player.checksum = film.checksum;
}

window.player = {};
window.player.ready = open().catch(error => {
  byId("message").hidden = false;
  byId("message").textContent = typeof DecompressionStream == "undefined"
    ? "This browser is too old for the player: it needs one of 2023 or later."
    : `The simulation cannot be shown: ${error.message ?? error}`;
  throw error;
});
