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
    this.walk = new Walk(film);
    this.sketch = new Sketch(this.theme);
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
    byId("summary").textContent =
      `${counted(film.particles, "particle")}, ${cells} cells, ${counted(this.last + 1, "frame")}`;
    byId("about").replaceChildren(...definitions(film.about));
    byId("scene").textContent = film.scene;
    byId("drag-words").textContent = film.dimension == 2
      ? "moves the picture" : "turns the picture; with shift or two fingers, moves it";
    byId("energies").hidden = !film.history;
    byId("walk-button").hidden = !this.walk.isThere;
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

  /** A frame on (1) or back (-1); stage by stage, a stage. */
  step(way) {
    const { walk } = this, number = walk.number + way;
    if (!walk.isOn || !walk.stages) {
      this.go(this.frame + way);
    } else if (number >= 0 && number <= walk.last) {
      walk.number = number;
      this.go(this.frame);
    } else if (this.frame + way >= 0 && this.frame + way <= this.last) {
      walk.number = way > 0 ? 0 : walk.last;
      this.go(this.frame + way);
    }
  }

  restart() {
    this.walk.number = 0;
    this.go(0);
  }

  /** A frame, or the last that is loaded. */
  show(frame) {
    this.frame = Math.min(frame, this.film.loaded - 1);
    this.follow();
    this.draw();
  }

  /** Shows the step that follows the frame stage by stage, close to the picked particle or, where
   *  none is, to that in the middle; or the whole again. */
  toggleWalk() {
    const { walk, camera, film } = this;
    if (!walk.isThere) return;
    walk.isOn = !walk.isOn;
    walk.number = 0;
    if (walk.isOn && walk.stages) {
      this.stop();
      this.picked ??= this.nearest(camera.column, camera.row, Infinity);
      this.viewBefore = { ...camera.view };
      const cell = film.domain.size[0] / film.domain.cells[0];
      const cells = BASES[walk.stages.basis].support + 3;  // across the shorter side
      const close = Math.min(camera.width, camera.height) / cells / cell;
      camera.zoomBy(Math.max(close / camera.scale, 1));
      this.follow();
    } else if (this.viewBefore) {
      camera.view = this.viewBefore;
      this.viewBefore = null;
    }
    this.draw();
  }

  /** Stage by stage, the picked particle stays in the middle. */
  follow() {
    if (!this.walk.isOn || this.picked == null || this.film.isGone(this.frame, this.picked)) return;
    this.camera.view.center = [...this.film.position(this.frame, this.picked), 0].slice(0, 3);
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

  /** Picks the particle that is seen at a place of the stage, if one is, for the log or for the
   *  stages, which are shown of the next one. */
  pickAt(column, row) {
    const { walk } = this;
    this.pick(this.nearest(column, row, walk.isOn ? Infinity : FINGER));
    if (this.picked != null && !walk.isOn) this.toggleLog(true);
  }

  pick(particle) {
    this.picked = particle;
    this.follow();
    this.draw();
  }

  /** The number of the particle that is seen at a place of the stage, or up to `far` pixels from
   *  it, or null. */
  nearest(column, row, far) {
    const { places, film, camera } = this;
    let found = null, best = -Infinity;
    for (let p = 0; p < film.particles; p++) {
      const radius = places[4 * p + 3];
      const [x, y, scale, toward] = camera.look(places.subarray(4 * p, 4 * p + 3));
      const away = Math.hypot(x - column, y - row);
      if (radius == 0 || !(away < Math.max(radius * scale, far))) continue;
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
    const moment = this.walk.show(frame, picked), isSketched = moment != null && !this.playing;
    const opacity = this.isGridShown ? +byId("opacity").value : 0;
    ground.drawUnder(onPixels(byId("under"), ratio), camera, opacity, !isSketched);
    this.paint(ratio);
    const over = onPixels(byId("over"), ratio);
    ground.drawOver(over, camera);
    byId("particles").classList.toggle("faint", isSketched);
    if (picked != null && !film.isGone(frame, picked)) {
      const place = this.places.subarray(4 * picked, 4 * picked + 3);
      ground.drawRing(over, camera, place, film.radius[picked]);
    }
    if (isSketched) this.sketch.draw(over, camera, moment);
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
