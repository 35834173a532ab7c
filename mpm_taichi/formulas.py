"""Formulas in scenes: a text is read into a term, never run as Python.

A term is a number, a name, or an operation and its arguments:
`"2*sin(X)"` is `("*", 2.0, ("sin", "X"))`."""

import ast
import keyword
import re
import warnings
from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any, NoReturn, TypeAlias

import numpy as np

Term: TypeAlias = "float | str | tuple"
Formula: TypeAlias = "float | str"

LONGEST = 10_000  # characters
DEEPEST = 100  # operations inside each other, and values of one min or max
AXES = "XYZ"
VARIABLES = ("X", "Y", "Z", "x", "y", "z", "t")
CONSTANTS = {"pi": np.pi}
STRANGER = re.compile(r"[^\w\s.+\-*/(),<>=!%]", re.ASCII)

OPERATORS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
LEAST_AND_MOST = {"atan2": (2, 2), "where": (3, 3), "min": (2, DEEPEST), "max": (2, DEEPEST)}
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan,
    "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2,
    "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh,
    "exp": np.exp, "log": np.log, "sqrt": np.sqrt,
    "abs": np.abs, "floor": np.floor, "where": np.where,
    "min": lambda *values: reduce(np.minimum, values),
    "max": lambda *values: reduce(np.maximum, values),
}  # fmt: skip
OPERATIONS: dict[str, Callable[..., Any]] = FUNCTIONS | {
    "+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, "**": np.power,
    "<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal,
}  # fmt: skip


def parse(formula: Formula, dim: int, definitions: Mapping[str, Term] = {}) -> Term:
    """The term of a formula that may use the names of `definitions`; its constant parts are
    numbers already.  A ValueError says what is wrong, in one sentence without the place."""
    if not isinstance(formula, str):
        return _number(formula, f"{formula}")
    if len(formula) > LONGEST:
        raise ValueError(
            f"the formula is longer than {LONGEST} characters: split it by definitions"
        )
    if stranger := STRANGER.search(formula):
        cure = ": use ** for powers" if stranger[0] == "^" else ""
        raise ValueError(f"the character {stranger[0]!r} has no meaning in a formula{cure}")
    text = " ".join(formula.split())
    if not text:
        raise ValueError("the formula is empty")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of Python, on '1or 2'
            tree = ast.parse(text, mode="eval")
    except SyntaxError as error:
        rest = text[(error.offset or 1) - 1 :]
        place = f"from {_quoted(rest)} on" if rest else "at its end"
        raise ValueError(f"the formula cannot be read {place}") from None
    except (MemoryError, RecursionError, ValueError):
        raise ValueError(_too_deep()) from None
    return _Reader(text, dim, definitions).term(tree.body, DEEPEST)


def check_name(name: str) -> None:
    """A definition's name is a plain identifier that is not taken; else a ValueError."""
    if not (name.isascii() and name.isidentifier()) or keyword.iskeyword(name):
        own = " (it is a word of Python)" if keyword.iskeyword(name) else ""
        raise ValueError(
            f"{name!r} cannot name a definition{own}: take a letter, then letters, digits and _"
        )
    if name in (*VARIABLES, *CONSTANTS, *FUNCTIONS):
        raise ValueError(f"{name!r} has a meaning already: take another name")


def _too_deep() -> str:
    return f"the formula nests or chains more than {DEEPEST} operations: split it by definitions"


def _quoted(text: str) -> str:
    return f"'{text}'" if len(text) <= 40 else f"'{text[:36]} ...'"


def _number(value: Any, text: str) -> float:
    if type(value) not in (int, float):
        raise ValueError(f"{text} is no real number")
    try:
        number = float(value)
    except OverflowError:
        number = np.inf
    if not np.isfinite(number):
        raise ValueError(f"{text} is no finite number")
    return number


class _Reader:
    """From Python's syntax tree to a term; what is not in the language is refused."""

    def __init__(self, text: str, dim: int, definitions: Mapping[str, Term]):
        self.bytes = text.encode()
        self.definitions = definitions
        self.known = {v for v in VARIABLES if v == "t" or AXES.index(v.upper()) < dim}

    def term(self, node: ast.expr, levels: int) -> Term:
        """The term of a node that has at most so many levels of operations."""
        if not levels:
            raise ValueError(_too_deep())
        below = levels - 1
        match node:
            case ast.Constant(value=value):
                return _number(value, self.piece(node))
            case ast.Name(id=name):
                return self.name(name)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self.term(operand, below)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self.operation(node, "*", -1.0, self.term(operand, below))
            case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
                left, right = self.term(left, below), self.term(right, below)
                return self.operation(node, OPERATORS[type(op)], left, right)
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
                return self.call(node, name, arguments, below)
        self.refuse(node)

    def name(self, name: str) -> Term:
        if name in CONSTANTS:
            return CONSTANTS[name]
        if name in self.known:
            return name
        if name in self.definitions:
            term = self.definitions[name]
            return name if isinstance(term, tuple) else term
        if name in VARIABLES:
            raise ValueError(f"there is no '{name}' in two dimensions")
        if name in FUNCTIONS:
            raise ValueError(f"'{name}' is a function: write {name}(...)")
        raise ValueError(_unknown("name", name, [*self.known, *CONSTANTS, *self.definitions]))

    def call(self, node: ast.Call, name: str, arguments: list[ast.expr], levels: int) -> Term:
        if name not in FUNCTIONS:
            if name in self.known or name in CONSTANTS or name in self.definitions:
                self.refuse(node)
            raise ValueError(_unknown("function", name, FUNCTIONS))
        least, most = LEAST_AND_MOST.get(name, (1, 1))
        if not least <= len(arguments) <= most:
            wanted = f"{least}" if least == most else f"{least} to {most}"
            noun = "value" if most == 1 else "values"
            raise ValueError(f"{name} takes {wanted} {noun}, not {len(arguments)}")
        if name != "where":
            return self.operation(node, name, *[self.term(a, levels) for a in arguments])
        condition = self.condition(arguments[0], levels)
        yes, no = [self.term(a, levels) for a in arguments[1:]]
        if isinstance(condition, float):
            return yes if condition else no
        return "where", condition, yes, no

    def condition(self, node: ast.expr, levels: int) -> Term:
        match node:
            case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in COMPARISONS:
                left, right = self.term(left, levels - 1), self.term(right, levels - 1)
                return self.operation(node, COMPARISONS[type(op)], left, right)
            case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not()):
                self.refuse(node)
        raise ValueError(f"where begins with a comparison such as X < 1, not {self.piece(node)}")

    def operation(self, node: ast.expr, operation: str, *arguments: Term) -> Term:
        """The operation, or its value where all arguments are numbers."""
        if not all(isinstance(a, float) for a in arguments):
            return operation, *arguments
        with np.errstate(all="ignore"):
            return _number(float(OPERATIONS[operation](*arguments)), self.piece(node))

    def piece(self, node: ast.expr | ast.keyword) -> str:
        """What the formula has at this node."""
        return _quoted(self.bytes[node.col_offset : node.end_col_offset].decode())

    def refuse(self, node: ast.expr) -> NoReturn:
        piece = self.piece(node)
        match node:
            case ast.Call(keywords=[named, *_]):
                reason = f"{self.piece(named)} is no part of a formula"
            case ast.Call(func=ast.Attribute() as function):
                reason = f"{self.piece(function)} has a dot: functions here are plain names"
            case ast.Call(func=function):
                reason = f"{self.piece(function)} is no function: write * for a product"
            case ast.Attribute():
                reason = f"{piece} has a dot: names here are plain"
            case ast.BinOp():
                reason = f"{piece} has an unknown operator: there are + - * / **"
            case ast.Compare(ops=[_, _, *_]):
                reason = f"{piece} compares twice: put one where inside another"
            case ast.Compare(ops=[op]) if type(op) not in COMPARISONS:
                reason = f"{piece} is no comparison by < <= > >="
            case ast.Compare():
                reason = f"{piece} is no number: write where({piece[1:-1]}, a, b)"
            case ast.BoolOp() | ast.UnaryOp():
                reason = f"{piece} uses and, or, not: put one where inside another"
            case ast.IfExp():
                reason = f"{piece} uses if: write where(condition, a, b)"
            case _:
                reason = f"{piece} is no part of a formula"
        raise ValueError(reason)


def _unknown(kind: str, name: str, known) -> str:
    from .scene.wording import suggestion  # here, since the package `scene` imports this module

    cure = suggestion(name, known) or f"; there are {', '.join(sorted(known))}"
    return f"unknown {kind} '{name}'{cure}"
