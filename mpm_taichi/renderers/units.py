"""Numbers for people: round lengths and SI prefixes."""

import math

PREFIXES = {-12: "p", -9: "n", -6: "u", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
"""Power of ten -> prefix; "u" for micro, since the font of the pictures has no Greek."""


def prefix(magnitude: float) -> tuple[float, str]:
    """The factor and name of the unit in which a magnitude is a handy number: the plain unit from
    0.1 to 1000 and for 0, else the one in which it is from 1 to 1000."""
    if magnitude == 0 or 0.1 <= magnitude < 1000:
        return 1.0, ""
    power = 3 * math.floor(math.log10(magnitude) / 3)
    power = min(max(power, min(PREFIXES)), max(PREFIXES))
    return 10.0**power, PREFIXES[power]


def with_unit(value: float, unit: str) -> str:
    """0.02, "m" -> "20 mm"."""
    factor, name = prefix(abs(value))
    return f"{value / factor:.4g} {name}{unit}"


def round_length(longest: float) -> float:
    """The longest of 1, 2 and 5 times a power of ten that is no longer than `longest`."""
    power = 10.0 ** math.floor(math.log10(longest))
    return max(factor * power for factor in (0.5, 1, 2, 5) if factor * power <= longest)


def tick_labels(values: list[float], unit: str, prefixed: bool = True) -> tuple[list[str], str]:
    """Values in one unit, prefixed or plain, to a hundredth of their range, and the unit."""
    factor, name = prefix(max(abs(value) for value in values)) if prefixed else (1.0, "")
    span = (max(values) - min(values)) / factor
    decimals = min(max(2 - math.floor(math.log10(span)), 0), 9)
    labels = [f"{round(value / factor, decimals) + 0.0:.{decimals}f}" for value in values]
    if decimals:
        labels = [label.rstrip("0").rstrip(".") for label in labels]
    return labels, name + unit
