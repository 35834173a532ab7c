// Formulas in the ASCII of mpm_taichi/stage_formulas.py, set for people.

const SIGNS = {
  sum: "\u2211", "grad ": "\u2207", tau: "\u03c4", sigma: "\u03c3", alpha: "\u03b1",
  dt: "\u0394t", dx: "\u0394x", "<-": "\u2190", "-": "\u2212",
};
const TOKEN = /_[A-Za-z]+|\^(?:[A-Za-z]+|-?\d+|\+)|<-|grad |[A-Za-z]+|./g;

/** Elements and texts; a single letter or a sign is a quantity, a longer word a word. */
function formula(line) {
  return line.match(TOKEN).map(token => {
    if (token.startsWith("_")) return make("sub", {}, token.slice(1));
    if (token.startsWith("^")) return make("sup", {}, token.slice(1).replace("-", "\u2212"));
    const sign = SIGNS[token] ?? token;
    return /^\p{L}$|^\u0394/u.test(sign) ? make("i", {}, sign) : document.createTextNode(sign);
  });
}
