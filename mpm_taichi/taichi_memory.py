"""Taichi keeps what it otherwise works out again and again, a fifth of the start of a scene whose
kernels are in its cache (0.9 s in 3D), and takes shorter ways to the same, another sixth (0.5 s).

Even for those it goes through the syntax tree of each function at each call of it, reads the source
anew, and draws for each node a picture of its place, which only an error message shows.  Both
depend on the source alone.  For each function that it decorates it searches all modules for the
source around, to see whether that is a class."""

import functools
import sys
import textwrap
from types import SimpleNamespace

from taichi.lang import kernel_impl
from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

WIDTH = 80
"""Columns from which a line of source is wrapped in an error message."""


def _remembered(place_of):
    """`ASTTransformerContext.get_pos_info`, once for each node of a function."""
    known = {}

    @functools.wraps(place_of)
    def place(self, node):
        at = node.lineno, node.end_lineno, node.col_offset, node.end_col_offset
        key = self.func.func, type(node), at
        if key not in known:
            known[key] = place_of(self, node)
        return known[key]

    return place


def _unwrapped(place_of):
    """`ASTTransformerContext.get_pos_info`; a line with nothing to wrap meets no TextWrapper."""

    @functools.wraps(place_of)
    def place(self, node):
        line = self.src[node.lineno - 1]
        mark = " " * (self.indent + node.col_offset) + "^" * (node.end_col_offset - node.col_offset)
        is_long = max(len(line), len(mark)) > WIDTH  # a mark counts bytes
        if node.lineno != node.end_lineno or is_long or not line.isprintable():
            return place_of(self, node)
        where = f'File "{self.file}", line {node.lineno + self.lineno_offset}'
        return f"{where}, in {self.func.func.__name__}:\n{line.rstrip()}\n{mark}\n"

    return place


def _inside_class(level_of_class_stackframe):
    """Whether what is decorated stands in the body of a class, one frame below the named one."""
    return "__qualname__" in sys._getframe(level_of_class_stackframe - 1).f_locals


def install() -> None:
    """For this process."""
    ASTTransformerContext.get_pos_info = _remembered(_unwrapped(ASTTransformerContext.get_pos_info))
    for name in ("getsourcefile", "getsourcelines"):
        setattr(kernel_impl, name, functools.cache(getattr(kernel_impl, name)))
    steps = {name: functools.cache(getattr(textwrap, name)) for name in ("fill", "dedent")}
    kernel_impl.textwrap = SimpleNamespace(**steps)
    kernel_impl._inside_class = _inside_class
