"""What Taichi works out of the source of a function: once, and by a shorter way."""

import ast
import inspect
import os
import time
from types import SimpleNamespace

import pytest
import taichi as ti
from taichi.lang import kernel_impl
from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

from mpm_taichi import runtime, taichi_memory
from mpm_taichi.kernels import p2g, update_stress


def test_places_are_drawn_once_for_each_node():
    """Two nodes at one place are drawn once; another place, kind of node or function is drawn for
    itself, since an error message shows it."""
    drawn = []

    def place_of(context, node):
        drawn.append((context, node))
        return f"place {len(drawn)}"

    def node(kind, line):
        return kind(lineno=line, end_lineno=line, col_offset=0, end_col_offset=4)

    def context(function):
        return SimpleNamespace(func=SimpleNamespace(func=function))

    class OtherNode(SimpleNamespace):
        pass

    place = taichi_memory._remembered(place_of)
    found = [
        place(context(function), node(kind, line))
        for function, kind, line in [
            (len, SimpleNamespace, 1), (len, SimpleNamespace, 1), (len, SimpleNamespace, 2),
            (len, OtherNode, 1), (min, SimpleNamespace, 1), (min, SimpleNamespace, 1),
        ]
    ]  # fmt: skip
    assert found == ["place 1", "place 1", "place 2", "place 3", "place 4", "place 4"]


ODD = [
    "name = " + " + ".join(11 * ["\u00e4\u00e4\u00e4"]) + ", 2.0 * x",
    f"longer = {' + '.join(40 * ['abc'])}, x",
    "tabbed = x +\ty, [x,",
    "    y]",
]


@pytest.mark.parametrize(
    "lines",
    [inspect.getsource(p2g).splitlines(), inspect.getsource(update_stress).splitlines(), ODD],
    ids=["p2g", "update_stress", "odd"],
)
def test_places_look_as_taichi_draws_them(lines):
    """Each node of real kernels, and of lines that have to be wrapped or are not ASCII."""
    context = SimpleNamespace(
        file="file.py", lineno_offset=7, indent=0, src=lines, func=SimpleNamespace(func=len)
    )
    theirs = inspect.unwrap(ASTTransformerContext.get_pos_info)
    assert theirs.__module__ == "taichi.lang.ast.ast_transformer_utils"
    ours = taichi_memory._unwrapped(theirs)
    nodes = [
        node
        for node in ast.walk(ast.parse("\n".join(lines)))
        if isinstance(node, (ast.stmt, ast.expr))
    ]
    assert len(nodes) > 10
    for node in nodes:
        assert ours(context, node) == theirs(context, node)


class Holder:
    @staticmethod
    @ti.func
    def inside(x):
        return x

    @ti.kernel
    def method(self):
        pass


@ti.func
def outside(x):
    return x


def test_who_stands_in_a_class():
    """Functions and kernels in the body of a class, and not those of modules and functions."""

    @ti.func
    def within(x):
        return x

    @ti.kernel
    def kernel():
        pass

    functions = {one.__name__: vars(one) for one in (Holder.inside, outside, within)}
    assert {name: marks["func"].classfunc for name, marks in functions.items()} == {
        "inside": True, "outside": False, "within": False,
    }  # fmt: skip
    kernels = {one.__name__: vars(one) for one in (Holder.method, kernel)}
    assert {name: marks["_is_classkernel"] for name, marks in kernels.items()} == {
        "method": True, "kernel": False,
    }  # fmt: skip


def test_is_at_work():
    """Wherever Taichi is started: the second reading of a function is the first one's answer."""
    assert runtime.taichi_memory is taichi_memory
    assert hasattr(ASTTransformerContext.get_pos_info, "__wrapped__")
    assert kernel_impl._inside_class is taichi_memory._inside_class
    assert kernel_impl.getsourcelines(test_is_at_work) is kernel_impl.getsourcelines(
        test_is_at_work
    )


def test_a_lock_left_behind_is_removed(tmp_path, monkeypatch):
    """What a process killed amid writing leaves: a lock a minute old is gone after a start, that of
    another process at work, a second old, is not."""
    lock = tmp_path / "ticache.lock"
    monkeypatch.setenv("TI_OFFLINE_CACHE_FILE_PATH", str(tmp_path))
    for age, stays in ((1, True), (90, False)):
        lock.touch()
        then = time.time() - age
        os.utime(lock, (then, then))
        runtime.start("cpu")
        assert lock.exists() == stays
