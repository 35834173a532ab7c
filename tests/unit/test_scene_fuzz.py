"""The reader against texts and values that nobody thought of."""

from hypothesis import given, settings
from hypothesis import strategies as st

from mpm_taichi.errors import InputError
from mpm_taichi.scene import Scene, load_scene
from mpm_taichi.scene.document import parse
from mpm_taichi.scene.wording import path_text

from .scene_text import TEXT

INDICATORS = ["{", "}", "[", "]", ": ", "- ", "\n", "\n  ", "\t", "? ", "'", '"', "|\n", "#", ","]
BEYOND_SCENES = ["&a ", "*a", "!x ", "<<: ", "---\n", "%YAML 1.2\n", "[[[", '"\\ud800"']
WORDS = ["type", "none", "auto", "mesh", "box", "true", "~", "{}", "[]", "/"]
NUMBERS = ["-0", "-1", "1e400", "1e-320", "1e308", "0x1F", ".nan", "9" * 30]
CHARACTERS = ["\u2028", "\x85", "\ufeff", "\r", "\x00", "\U0001f600", chr(0xD800)]
PIECES = st.sampled_from(INDICATORS) | st.sampled_from(BEYOND_SCENES) | st.sampled_from(CHARACTERS)
PIECES |= st.sampled_from(WORDS) | st.sampled_from(NUMBERS)
EDITS = st.lists(
    st.tuples(
        st.integers(0, len(TEXT)), st.integers(0, 20), st.one_of(PIECES, st.text(max_size=3))
    ),
    min_size=1,
    max_size=4,
)


def loads_or_is_refused(path, overrides=()) -> None:
    try:
        assert isinstance(load_scene(path, overrides), Scene)
    except InputError as error:
        for line in str(error).split("\n"):
            assert line.startswith((f"{path}:", "--set ")) and line.isprintable()


@settings(max_examples=200, deadline=None)
@given(EDITS)
def test_any_text_is_a_scene_or_an_input_error(tmp_path_factory, edits):
    """Whatever happens to the text of a valid scene: no other exception, and printable lines that
    begin with the file."""
    text = TEXT
    for begin, length, piece in edits:
        text = text[:begin] + piece + text[begin + length :]
    path = tmp_path_factory.getbasetemp() / "edited.yaml"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    loads_or_is_refused(path)


VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**17), 10**17)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.sampled_from(["auto", "none", "slip", "ball", "mesh", "gmsh", "rubber", "snow", "/"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["type", "file", "size", "min", "left", "preset"]), inner)
    ),
    max_leaves=4,
)
KEYS = st.sampled_from([path_text(path) for path in parse(TEXT, "text").places if path])


def in_yaml(value) -> str:
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {in_yaml(entry)}' for key, entry in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(map(in_yaml, value))}]"
    return "null" if value is None else str(value)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(KEYS, VALUES), min_size=1, max_size=3))
def test_any_value_is_accepted_or_an_input_error(tmp_path_factory, changes):
    """Whatever stands at a key of a valid scene: no other exception."""
    path = tmp_path_factory.getbasetemp() / "values.yaml"
    path.write_text(TEXT)
    loads_or_is_refused(path, [f"{key}={in_yaml(value)}" for key, value in changes])
