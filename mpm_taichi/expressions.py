"""Fields given by formulas: values and exact derivatives on the host, values inside kernels."""

import operator
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import reduce
from typing import Any

import numpy as np
import taichi as ti

from .dual_numbers import Dual, differentiate
from .formulas import AXES, OPERATIONS, VARIABLES, Formula, Term, check_name, parse
from .runtime import Template


class Expressions:
    """A field of the initial position X, the current position x and the time t.

    `entries` are its components: numbers or formulas, which may use `definitions` (name to
    formula, each after those that it uses).  A ValueError says which text is wrong and why.

    Immutable; equal fields are equal keys, so a kernel is compiled once for both.  In a kernel,
    with the field as a template: `b = ti.Vector(ti.static(field.on_device(X[p], x[p], t)))`."""

    def __init__(
        self, entries: Sequence[Formula], definitions: Mapping[str, Formula] = {}, *, dim: int
    ):
        terms: dict[str, Term] = {}
        for name, formula in definitions.items():
            check_name(name)
            terms[name] = parse(formula, dim, terms)
        self.dim = dim
        self.entries = tuple(parse(formula, dim, terms) for formula in entries)
        used = {name for entry in self.entries for name in _names(entry)}
        for name in reversed(terms):
            if name in used:
                used.update(_names(terms[name]))
        self.definitions = {name: term for name, term in terms.items() if name in used}
        self.variables = frozenset(used.intersection(VARIABLES))
        self._key = (dim, self.entries, tuple(self.definitions.items()))

    def __eq__(self, other):
        return isinstance(other, Expressions) and self._key == other._key

    def __hash__(self):
        return hash(self._key)

    @np.errstate(all="ignore")
    def value(self, X=None, x=None, t: float = 0.0) -> np.ndarray:
        """The field [n, entries] at X, x [n, dim], of which one may be missing if no formula uses
        it.  Not finite where a formula is not."""
        n = len(X if X is not None else x)  # type: ignore[arg-type]
        names = self._variables(X, x, t, _column)
        entries = self._evaluate(names, lambda name, *values: OPERATIONS[name](*values))
        return np.stack([np.broadcast_to(np.asarray(e, float), n) for e in entries], axis=1)

    def gradient(self, X, t: float = 0.0) -> np.ndarray:
        """d field_i / d X_j, [n, entries, dim], exact but for round-off.

        At a kink (abs, min, max) it is the mean of both sides; where an infinite slope meets an
        inner derivative of 0 it is 0, so sqrt(X**2 + Y**2) has gradient 0 at the origin; floor,
        and the condition of where, count as constant."""
        names = self._variables(X, None, t, _column)
        for name in self.variables & set(AXES):
            one = np.eye(self.dim)[:, [AXES.index(name)]]
            names[name] = Dual(names[name], one)
        return np.moveaxis(self._derivatives(names, (self.dim, len(X))), 2, 0)

    def rate(self, X, t: float) -> np.ndarray:
        """d field_i / dt at fixed X, [n, entries], exact as `gradient` is."""
        names = self._variables(X, None, t, _column)
        if "t" in names:
            names["t"] = Dual(names["t"], np.ones((1, 1)))
        return self._derivatives(names, (1, len(X)))[:, 0].T

    def on_device(self, X, x, t) -> list:
        """The entries as Taichi expressions, for a kernel that is being compiled; each definition
        is computed once, in a local variable.  None stands for an X or x that no formula uses."""
        names = self._variables(X, x, _local(t), _entry)
        return self._evaluate(names, lambda name, *values: DEVICE[name](*values), _local)

    def _variables(self, X, x, t, component: Callable) -> dict[str, Any]:
        """The variables in use."""
        names = {"t": t} if "t" in self.variables else {}
        for name in self.variables - {"t"}:
            vectors = X if name in AXES else x
            if vectors is None:
                raise ValueError(f"the formula uses '{name}', which is not known here")
            names[name] = component(vectors, AXES.index(name.upper()))
        return names

    def _evaluate(self, names: dict, apply: Callable, keep: Callable = lambda value: value) -> list:
        """The entries in the algebra whose operations `apply` does."""
        for name, term in self.definitions.items():
            names[name] = keep(_evaluate(term, names, apply))
        return [_evaluate(term, names, apply) for term in self.entries]

    @np.errstate(all="ignore")
    def _derivatives(self, names: dict, shape: tuple[int, int]) -> np.ndarray:
        """[entries, directions, n]"""
        entries = self._evaluate(names, differentiate)
        rates = [e.rate if isinstance(e, Dual) else 0.0 for e in entries]
        return np.stack([np.broadcast_to(rate, shape) for rate in rates])


def _names(term: Term) -> Iterator[str]:
    if isinstance(term, str):
        yield term
    elif isinstance(term, tuple):
        for argument in term[1:]:
            yield from _names(argument)


def _evaluate(term: Term, names: Mapping[str, Any], apply: Callable) -> Any:
    if isinstance(term, tuple):
        operation, *arguments = term
        return apply(operation, *[_evaluate(a, names, apply) for a in arguments])
    return names[term] if isinstance(term, str) else term


def _column(vectors, d: int) -> np.ndarray:
    return np.asarray(vectors, float)[:, d]


@ti.func
def _entry(vector: Template, d: Template):
    return vector[d]


@ti.func
def _local(value):
    """A variable of the kernel: what is used many times is computed once."""
    return value


@ti.func
def _cosh(a):
    return 0.5 * (ti.exp(a) + ti.exp(-a))


@ti.func
def _sinh(a):
    return ti.tanh(a) * _cosh(a)


def _power(a, b):
    """Whole constant exponents stay integers: a negative base has no other powers."""
    whole = isinstance(b, float) and b.is_integer() and abs(b) < 2**31
    return ti.pow(a, int(b) if whole else b)


DEVICE: dict[str, Callable[..., Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "**": _power,
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge,
    "sin": ti.sin, "cos": ti.cos, "tan": ti.tan,
    "asin": ti.asin, "acos": ti.acos, "atan": lambda a: ti.atan2(a, 1.0), "atan2": ti.atan2,
    "sinh": _sinh, "cosh": _cosh, "tanh": ti.tanh,
    "exp": ti.exp, "log": ti.log, "sqrt": ti.sqrt,
    "abs": ti.abs, "floor": ti.floor, "where": ti.select,
    "min": lambda *values: reduce(ti.min, values),
    "max": lambda *values: reduce(ti.max, values),
}  # fmt: skip
