// Elements and canvases.

const byId = id => document.getElementById(id);

/** A new element with properties and a text; never markup. */
function make(tag, properties, text) {
  const element = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) element.textContent = text;
  return element;
}

/** Pairs of words as the entries of a <dl>. */
function definitions(rows) {
  return rows.flatMap(([word, text]) => [make("dt", {}, word), make("dd", {}, text)]);
}

/** Gives a canvas the pixels with which it is shown. */
function fitPixels(canvas, pixelRatio) {
  const width = Math.round(canvas.clientWidth * pixelRatio);
  const height = Math.round(canvas.clientHeight * pixelRatio);
  if (canvas.width != width || canvas.height != height)
    [canvas.width, canvas.height] = [width, height];
}

/** The pen of a canvas with the pixels with which it is shown; it takes CSS pixels. */
function onPixels(canvas, pixelRatio) {
  fitPixels(canvas, pixelRatio);
  const pen = canvas.getContext("2d");
  pen.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
  pen.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  return pen;
}

/** "rrggbb" -> [0 to 255, ...]. */
const rgb = code => [0, 2, 4].map(at => parseInt(code.slice(at, at + 2), 16));

/** The colors of the stage: as CSS, and the two that the painter mixes, from 0 to 1. */
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const read = name => style.getPropertyValue(`--${name}`).trim();
  const parts = name => rgb(read(name).slice(1)).map(part => part / 255);
  return {
    css: {
      background: read("background"), panel: read("panel"), line: read("line"),
      wall: read("missing"), faintInk: read("faint-ink"), ink: read("ink"),
    },
    shadow: parts("shadow"),
    panel: parts("panel"),
  };
}
