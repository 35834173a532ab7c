"""Forward-mode differentiation: every operation with its partial derivatives."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .formulas import OPERATIONS


class Dual(NamedTuple):
    """A value [n] and its derivatives [directions, n]."""

    value: Any
    rate: Any


def differentiate(operation: str, *arguments: Any) -> Any:
    """The operation on numbers, arrays and duals; comparisons and floor give plain arrays.

    Chain rule: d f(a, b) = f_a da + f_b db.  A term is 0 where da is 0, though f_a be infinite,
    and where a is not chosen (where, min, max), though da be infinite."""
    values = [np.asarray(a.value if isinstance(a, Dual) else a) for a in arguments]
    value = OPERATIONS[operation](*values)
    if operation not in PARTIALS:
        return value
    rate = np.zeros((1, 1))
    for f_a, a in zip(PARTIALS[operation](*values), arguments, strict=True):
        if isinstance(a, Dual):
            absent = (a.rate == 0) | ((f_a == 0) & (operation in CHOICES))
            rate = rate + np.where(absent, 0.0, f_a * a.rate)
    return Dual(value, rate)


def _shares(extreme, values) -> list:
    """Of each argument of min or max: 1 where it is the extreme, divided where several are."""
    hits = [value == extreme for value in values]
    return [hit / sum(hits) for hit in hits]


CHOICES = ("where", "min", "max")
PARTIALS: dict[str, Callable[..., Any]] = {
    "+": lambda a, b: (1.0, 1.0),
    "-": lambda a, b: (1.0, -1.0),
    "*": lambda a, b: (b, a),
    "/": lambda a, b: (1 / b, -a / (b * b)),
    "**": lambda a, b: (
        np.where(b == 0, 0.0, b * a ** (b - 1)),
        np.where(a == 0, 0.0, a**b * np.log(a)),
    ),
    "sin": lambda a: (np.cos(a),),
    "cos": lambda a: (-np.sin(a),),
    "tan": lambda a: (1 / np.cos(a) ** 2,),
    "asin": lambda a: (1 / np.sqrt((1 - a) * (1 + a)),),
    "acos": lambda a: (-1 / np.sqrt((1 - a) * (1 + a)),),
    "atan": lambda a: (1 / (1 + a * a),),
    "atan2": lambda a, b: (b / (a * a + b * b), -a / (a * a + b * b)),
    "sinh": lambda a: (np.cosh(a),),
    "cosh": lambda a: (np.sinh(a),),
    "tanh": lambda a: (1 / np.cosh(a) ** 2,),
    "exp": lambda a: (np.exp(a),),
    "log": lambda a: (1 / a,),
    "sqrt": lambda a: (0.5 / np.sqrt(a),),
    "abs": lambda a: (np.sign(a),),
    "where": lambda condition, a, b: (
        0.0,
        np.where(condition, 1.0, 0.0),
        np.where(condition, 0.0, 1.0),
    ),
    "min": lambda *values: _shares(np.minimum.reduce(np.broadcast_arrays(*values)), values),
    "max": lambda *values: _shares(np.maximum.reduce(np.broadcast_arrays(*values)), values),
}
