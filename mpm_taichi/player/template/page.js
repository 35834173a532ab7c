// The state of the page: the frame, whether it plays, how it is looked at; and how that is shown.

const FILM_SECONDS = 8;  // that a whole run takes to play, about

class Page {
  constructor(film) {
    this.film = film;
    this.theme = readTheme();
    this.camera = new Camera(film.domain.size);
    this.ground = new Ground(film, this.theme);
    this.colors = new Colors(film);
    this.log = new Log(film);
    this.chart = film.history && new Chart(film, byId("chart"), byId("key"));
    this.places = new Float32Array(4 * wholeRows(film.particles));
    this.frame = 0;
    this.time = film.times[0];  // s; while it plays, between the frames too
    this.playing = this.isDue = false;
    this.isGridShown = film.gridOpacity > 0;
    this.picked = null;
    this.quantity = film.quantities.find(({ name }) => name == film.colorBy) ?? film.quantities[0];
    const duration = film.times.at(-1) - film.times[0];
    this.usualRate = duration > 0 ? roundLength(1.2 * duration / FILM_SECONDS) : 1;
    this.fillIn();
    new ResizeObserver(() => this.resize()).observe(byId("stage"));
    const canvas = byId("particles");
    canvas.addEventListener("webglcontextlost", event => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => { this.painter = null; this.draw(); });
  }

  get last() { return this.film.times.length - 1; }

  /** Simulated seconds in a second of the clock. */
  get rate() { return this.usualRate * 10 ** +byId("speed").value; }

  /** What the controls are at the start, and the texts that do not change. */
  fillIn() {
    const { film } = this, cells = film.domain.cells.join(" \u00d7 ");
    byId("title").textContent = document.title = film.title;
    byId("summary").textContent = `${film.particles.toLocaleString("en")} particles, ${cells} ` +
      `cells, ${film.times.length} frames`;
    byId("about").replaceChildren(...definitions(film.about));
    byId("scene").textContent = film.scene;
    byId("drag-words").textContent = film.dimension == 2
      ? "moves the picture" : "turns the picture; with shift or two fingers, moves it";
    byId("energies").hidden = !film.history;
    byId("color").append(
      ...film.quantities.map(({ name, label }) => make("option", { value: name }, label)));
    byId("color").value = this.quantity.name;
    byId("seek").max = this.last;
    byId("opacity").value = film.gridOpacity || 0.25;
    byId("grid").setAttribute("aria-pressed", this.isGridShown);
    this.colors.describe(this.quantity, byId("legend"));
    this.showSettings();
  }

  showSettings() {
    const words = `${withUnit(this.rate, "s")} per second`;
    byId("speed-text").value = words;
    byId("speed").setAttribute("aria-valuetext", `${words} of the clock`);
    byId("opacity-text").value = `${Math.round(100 * byId("opacity").value)} %`;
    this.draw();
  }

  /** From here on, or from the start again after the end, by the clock. */
  play() {
    if (this.frame == this.last) this.show(0);
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
      if (this.frame == this.last) this.stop();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  stop() {
    this.playing = false;
    byId("play").textContent = "Start";
  }

  /** Stops at a frame, or at the first or last where there is none. */
  go(frame) {
    this.stop();
    this.show(Math.min(Math.max(frame, 0), this.last));
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

  colorBy(name) {
    this.quantity = this.film.quantities.find(quantity => quantity.name == name);
    byId("color").value = name;
    this.colors.describe(this.quantity, byId("legend"));
    this.draw();
  }

  nextColor() {
    const { quantities } = this.film;
    this.colorBy(quantities[(quantities.indexOf(this.quantity) + 1) % quantities.length].name);
  }

  zoom(factor) {
    this.camera.zoomBy(factor);
    this.draw();
  }

  showAll() {
    this.camera.reset();
    this.draw();
  }

  /** Picks the particle that is seen at a place of the stage, if one is, for the log. */
  pickAt(column, row) {
    this.pick(this.particleAt(column, row));
    if (this.picked != null) this.toggleLog(true);
  }

  pick(particle) {
    this.picked = particle;
    this.draw();
  }

  /** The number of the particle that is seen at a place of the stage, or null. */
  particleAt(column, row) {
    const { places, film, camera } = this;
    let found = null, best = -Infinity;
    for (let p = 0; p < film.particles; p++) {
      const radius = places[4 * p + 3];
      const [x, y, scale, toward] = camera.look(places.subarray(4 * p, 4 * p + 3));
      const away = Math.hypot(x - column, y - row);
      if (radius == 0 || !(away < Math.max(radius * scale, FINGER))) continue;
      const merit = film.dimension == 3 ? toward : -away;
      if (merit > best) [found, best] = [p, merit];
    }
    return found;
  }

  resize() {
    const { clientWidth, clientHeight } = byId("stage");
    this.camera.fit(clientWidth, clientHeight);
    this.draw();
  }

  /** Before the browser's next picture. */
  draw() {
    if (this.isDue || this.film.loaded == 0) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.drawNow();
    });
  }

  drawNow() {
    const { film, camera, ground, frame, picked } = this, ratio = devicePixelRatio || 1;
    if (!(camera.width > 0 && camera.height > 0)) return;
    film.places(frame, this.places);
    ground.drawUnder(
      onPixels(byId("under"), ratio), camera, this.isGridShown ? +byId("opacity").value : 0);
    this.paint(ratio);
    const over = onPixels(byId("over"), ratio);
    ground.drawOver(over, camera);
    if (picked != null && !film.isGone(frame, picked)) {
      const place = this.places.subarray(4 * picked, 4 * picked + 3);
      ground.drawRing(over, camera, place, film.radius[picked]);
    }
    this.tell();
    if (!byId("log").hidden) this.log.show(frame, picked);
    this.chart?.draw(frame, ratio);
  }

  paint(ratio) {
    const canvas = byId("particles");
    fitPixels(canvas, ratio);
    this.painter ??= new Painter(canvas, this.film, this.theme);
    this.painter.draw(this.places, this.colors.of(this.quantity, this.frame), this.camera, ratio);
  }

  /** Frame and time in words. */
  tell() {
    const { film, frame } = this, time = withUnit(film.times[frame], "s", 4);
    const words = `frame ${frame + 1} of ${this.last + 1}`;
    byId("seek").value = frame;
    byId("seek").setAttribute("aria-valuetext", `${words}, ${time}`);
    byId("clock").value = `${time}  \u00b7  ${words}`;
    byId("stage").setAttribute("aria-label", `${film.title}: particles at ${time}, ${words}`);
  }
}

const FINGER = 8;  // pixels from a particle at which it is meant
