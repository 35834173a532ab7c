// Numbers for people, as in mpm_taichi/renderers/units.py.

const PREFIXES = {
  "-12": "p", "-9": "n", "-6": "\u00b5", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T",
};

/** The factor and name of the unit in which a magnitude is a handy number. */
function prefix(magnitude) {
  if (magnitude == 0 || (magnitude >= 0.1 && magnitude < 1000)) return [1, ""];
  const power = Math.min(Math.max(3 * Math.floor(Math.log10(magnitude) / 3), -12), 12);
  return [10 ** power, PREFIXES[power]];
}

/** 0.02, "m" -> "20 mm". */
function withUnit(value, unit, digits = 3, prefixed = true) {
  const [factor, name] = prefixed ? prefix(Math.abs(value)) : [1, ""];
  return `${plain(value / factor, digits)} ${name}${unit}`.trim();
}

/** Without an exponent where it would be no longer than the number, with a true minus sign. */
function plain(value, digits = 3) {
  return String(Number(value.toPrecision(digits))).replace("-", "\u2212");
}

/** The longest of 1, 2 and 5 times a power of ten that is no longer than `longest`. */
function roundLength(longest) {
  const power = 10 ** Math.floor(Math.log10(longest));
  const lengths = [0.5, 1, 2, 5].map(factor => factor * power);
  return Math.max(...lengths.filter(length => length <= longest));
}

/** Values in one unit, to a hundredth of their range, and the unit. */
function tickLabels(values, unit, prefixed = true) {
  const [factor, name] = prefixed ? prefix(Math.max(...values.map(Math.abs))) : [1, ""];
  const span = (Math.max(...values) - Math.min(...values)) / factor;
  const decimals = Math.min(Math.max(2 - Math.floor(Math.log10(span)), 0), 9);
  const labels = values.map(value => String(Number((value / factor).toFixed(decimals))));
  return [labels.map(label => label.replace("-", "\u2212")), name + unit];
}
