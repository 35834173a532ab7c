// What buttons, sliders, keys and gestures do to the page.

function connect(page) {
  const clicks = {
    play: () => page.playing ? page.stop() : page.play(),
    step: () => page.step(1),
    reset: () => page.restart(),
    grid: () => page.toggleGrid(),
    "log-button": () => page.toggleLog(),
    "walk-button": () => page.toggleWalk(),
  };
  for (const [id, act] of Object.entries(clicks)) byId(id).onclick = act;
  byId("seek").oninput = () => page.go(+byId("seek").value);
  byId("speed").oninput = byId("opacity").oninput = () => page.showSettings();
  byId("color").onchange = () => page.colorBy(byId("color").value);
  page.chart?.onSeek(time => page.go(page.film.frameAt(time)));
  matchMedia("(prefers-color-scheme: dark)").onchange = () => page.draw();
  new Gestures(byId("stage"), page);
  document.addEventListener("keydown", event => pressKey(event, page, clicks));
}

const KEYS = {
  " ": (page, clicks) => clicks.play(),
  arrowleft: page => page.step(-1),
  arrowright: page => page.step(1),
  home: page => page.go(0),
  end: page => page.go(page.last),
  g: page => page.toggleGrid(),
  l: page => page.toggleLog(),
  s: page => page.toggleWalk(),
  c: page => page.nextColor(),
  "+": page => page.zoom(1.25),
  "=": page => page.zoom(1.25),
  "-": page => page.zoom(0.8),
  0: page => page.showAll(),
  escape: page => page.walk.isOn ? page.toggleWalk() : page.pick(null),
};

/** Keys that mean something to the element that has the focus. */
const MOVES = ["arrowleft", "arrowright", "home", "end"];
const TAKEN = {
  INPUT: MOVES, PRE: MOVES, SELECT: [...MOVES, " ", "c"], BUTTON: [" "], SUMMARY: [" "],
};

function pressKey(event, page, clicks) {
  const key = event.key.toLowerCase(), element = document.activeElement?.tagName;
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (!(key in KEYS) || TAKEN[element]?.includes(key)) return;
  event.preventDefault();
  KEYS[key](page, clicks);
}
