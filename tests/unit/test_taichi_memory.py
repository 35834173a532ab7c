"""What Taichi works out of the source of a function is worked out once."""

from types import SimpleNamespace

from taichi.lang import kernel_impl
from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

from mpm_taichi import runtime, taichi_memory


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


def test_is_at_work():
    """Wherever Taichi is started: the second reading of a function is the first one's answer."""
    assert runtime.taichi_memory is taichi_memory
    assert hasattr(ASTTransformerContext.get_pos_info, "__wrapped__")
    assert kernel_impl.getsourcelines(test_is_at_work) is kernel_impl.getsourcelines(
        test_is_at_work
    )
