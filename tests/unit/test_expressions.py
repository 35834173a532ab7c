"""Formulas: read without running them; one field on the host, in derivatives and in kernels."""

import random
import time
import warnings

import numpy as np
import pytest
import taichi as ti
from hypothesis import given, settings
from hypothesis import strategies as st

from mpm_taichi import runtime
from mpm_taichi.expressions import DEVICE, Expressions
from mpm_taichi.formulas import OPERATIONS, check_name, parse
from mpm_taichi.runtime import Array, Template

VORTEX = {
    "A": 1, "E": 1000, "mu": 384.615, "rho": 1000, "c": 1,
    "R": "sqrt(X**2 + Y**2)",
    "theta": "atan2(Y, X)",
    "h": "1 - 32*(R - 1)**2 + 256*(R - 1)**4",
    "alpha": "A*sin(c*pi*t)*h",
    "beta": "theta + alpha",
    "b_r": """-R*A**2*c**2*pi**2*cos(c*pi*t)**2*(4*R - 3)**4*(4*R - 5)**4
              + (4096*mu/rho)*R*A**2*sin(c*pi*t)**2*(4*R - 5)**2*(R - 1)**2*(4*R - 3)**2""",
    "b_t": """-A*sin(c*pi*t)*(R*c**2*pi**2*(4*R - 3)**2*(4*R - 5)**2
              + (64*mu/rho)*(96*R**3 - 240*R**2 + 188*R - 45))""",
}  # fmt: skip
VORTEX_FORCE = ["cos(beta)*b_r - sin(beta)*b_t", "sin(beta)*b_r + cos(beta)*b_t"]

# Every operation, at points where it is smooth, for X, Y in (0.1, 0.9)
SMOOTH = [
    "sin(X)", "cos(X*Y)", "tan(X)", "asin(X*Y)", "acos(X)", "atan(Y/X)", "atan2(Y, X)",
    "sinh(X)", "cosh(Y)", "tanh(X - Y)", "exp(-X)", "log(X*Y)", "sqrt(X + Y)", "abs(X - 2)",
    "min(X, 2, Y + 3)", "max(X, -2, Y - 3)", "floor(X) + Y", "where(X < 2, X*Y, log(-X))",
    "where(X > 2, 1/0.5, Y**2)", "where(X <= 2, 1, Y)", "where(X >= Y + 1, X, Y*t)",
    "(X - 1)**3", "(-X)**-2", "X**0", "X**1", "X**1.5", "2**X", "X**Y", "-X**2", "+X/Y - t*X",
    "3", "t", "pi*t",
]  # fmt: skip


@ti.kernel
def evaluate(field: Template, positions: Template, t: float, out: Array):
    for p in range(out.shape[0]):
        b = ti.Vector(ti.static(field.on_device(positions.X[p], positions.x[p], t)))
        for i in ti.static(range(b.n)):
            out[p, i] = b[i]


@ti.kernel
def evaluate_initial(field: Template, positions: Template, out: Array):
    for p in range(out.shape[0]):
        b = ti.Vector(ti.static(field.on_device(positions.X[p], None, 0.0)))
        for i in ti.static(range(b.n)):
            out[p, i] = b[i]


class Positions:
    """X and x of particles, as fields."""

    def __init__(self, X, x):
        n, dim = X.shape
        self.X, self.x = (ti.Vector.field(dim, float, n) for _ in range(2))
        self.X.from_numpy(X)
        self.x.from_numpy(x)


def on_device(field, X, x, t):
    """The field by a kernel, whose compilation must not warn."""
    out = np.zeros((len(X), len(field.entries)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        evaluate(field, Positions(X, x), t, out)
    return out


def test_values(rng):
    """The formulas in NumPy's own words: the same operations in the same order, so equal."""
    X, x, t = rng.uniform(0.1, 2, (20, 3)), rng.uniform(-1, 1, (20, 3)), 0.3
    field = Expressions(
        ["0.1*sin(pi*X/2) - Z**2", 7, "where(z < y, r, min(x, Y, t))"],
        {"square": "x**2 + y**2", "r": "sqrt(square)"},
        dim=3,
    )
    r = np.sqrt(x[:, 0] ** 2 + x[:, 1] ** 2)
    least = np.minimum(np.minimum(x[:, 0], X[:, 1]), t)
    expected = [
        0.1 * np.sin(np.pi * X[:, 0] / 2) - X[:, 2] ** 2,
        np.full(20, 7.0),
        np.where(x[:, 2] < x[:, 1], r, least),
    ]
    np.testing.assert_array_max_ulp(field.value(X, x, t), np.stack(expected, axis=1), 2)


def test_vortex_check_value():
    """numerics.md 8.2: the body force that 40-digit arithmetic confirmed, as printed there."""
    b = Expressions(VORTEX_FORCE, VORTEX, dim=2).value(np.array([[0.7, 0.55]]), t=0.21)
    np.testing.assert_allclose(b, [[2.500332, 0.682352]], atol=5e-7, rtol=0)


def test_axis_aligned_check_value():
    """numerics.md 8.1: as the vortex; the values are printed to 4 decimals."""
    definitions = {"E": 1e4, "nu": 0.3, "rho": 1, "A": 0.05, "c": "sqrt(E/rho)"}
    definitions |= {"mu": "E/(2*(1 + nu))", "lam": "E*nu/((1 + nu)*(1 - 2*nu))"}
    for axis, phase in zip("XYZ", ("0", "2/3", "4/3"), strict=True):
        definitions[f"s{axis}"] = f"sin(pi*(c*t + {phase}))"
        definitions[f"u{axis}"] = f"A*sin(pi*{axis})*s{axis}"
        definitions[f"F{axis}"] = f"1 + A*pi*cos(pi*{axis})*s{axis}"
    definitions["K"] = "log(FX*FY*FZ)"
    b = "pi**2*u{0}*(mu/rho - c**2 - (lam*(K - 1) - mu)/(rho*F{0}**2))"
    field = Expressions([b.format(axis) for axis in "XYZ"], definitions, dim=3)
    value = field.value(np.array([[0.3, 0.6, 0.2]]), t=0.003)
    np.testing.assert_allclose(value, [[792.4037, 190.7811, -1740.9580]], atol=5e-5, rtol=0)


def test_derivatives_of_the_vortex_motion(rng):
    """x = Q(alpha) X: its rate is alpha' e_z x x, its gradient Q + (e_z x x) (x) grad alpha, by
    hand.  A few dozen operations of 1e-16, where 1 - 32 s + 256 s^2 cancels little."""
    motion = ["cos(alpha)*X - sin(alpha)*Y", "sin(alpha)*X + cos(alpha)*Y"]
    field = Expressions(motion, VORTEX, dim=2)
    R, angle, t = rng.uniform(0.75, 1.25, 50), rng.uniform(-3, 3, 50), rng.uniform(0.1, 0.9)
    X = np.stack([R * np.cos(angle), R * np.sin(angle)], axis=1)
    s = np.linalg.norm(X, axis=1) - 1
    h, dh = 1 - 32 * s**2 + 256 * s**4, -64 * s + 1024 * s**3
    alpha = np.sin(np.pi * t) * h
    Q = np.moveaxis(
        np.array([[np.cos(alpha), -np.sin(alpha)], [np.sin(alpha), np.cos(alpha)]]), 2, 0
    )
    x = np.einsum("nij,nj->ni", Q, X)
    turned = np.stack([-x[:, 1], x[:, 0]], axis=1)
    slope = np.sin(np.pi * t) * dh[:, None] * X / (1 + s)[:, None]
    rate = np.pi * np.cos(np.pi * t) * h[:, None] * turned
    np.testing.assert_allclose(field.rate(X, t), rate, rtol=1e-14, atol=1e-14)
    gradient = Q + turned[:, :, None] * slope[:, None, :]
    np.testing.assert_allclose(field.gradient(X, t), gradient, rtol=1e-14, atol=3e-14)


def test_every_derivative(rng):
    """Each operation against fourth-order differences: truncation (0.002)^4 times a fifth
    derivative of some 1e5 at most, near X = 0.1; a wrong partial is wrong by far more."""
    X, t, step = rng.uniform(0.2, 0.8, (20, 2)), 0.4, 5e-4
    field = Expressions(SMOOTH, dim=2)

    def difference(f):
        return (8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step)

    for d, direction in enumerate(np.eye(2)):
        expected = difference(lambda s, e=direction: field.value(X + s * e, t=t))
        np.testing.assert_allclose(field.gradient(X, t)[:, :, d], expected, rtol=1e-7, atol=1e-7)
    expected = difference(lambda s: field.value(X, t=t + s))
    np.testing.assert_allclose(field.rate(X, t), expected, rtol=1e-7, atol=1e-7)


def random_formula(draw: random.Random, depth: int) -> str:
    """Analytic everywhere, of modest size."""
    if not depth:
        return draw.choice(["X", "Y", "t", f"{draw.uniform(-1, 1):.3f}"])
    a, b = random_formula(draw, depth - 1), random_formula(draw, depth - 1)
    templates = [
        "({a} + {b})", "({a} - {b})", "{a}*{b}", "sin({a})", "cos({a})", "exp(-({a})**2)",
        "({a})**2", "-({a})", "({a})/(2 + sin({b}))", "tanh({a})", "sqrt(2 + cos({b}))",
    ]  # fmt: skip
    return draw.choice(templates).format(a=a, b=b)


def test_derivatives_of_random_formulas(rng):
    """Complex steps, which have no rounding of their own: the walker runs on NumPy's complex
    numbers, and Im f(X + ih)/h is the derivative but for h^2 = 1e-60.  Both sum some 2^5 terms of
    round-off, which grow along the chain: 1e-12 is a hundred times what is seen."""
    draw = random.Random(int(rng.integers(2**31)))
    X, t, h = rng.uniform(-1, 1, (10, 2)), 0.7, 1e-30

    def walk(term, names):
        if isinstance(term, tuple):
            return OPERATIONS[term[0]](*[walk(a, names) for a in term[1:]])
        return names.get(term, term)

    for _ in range(100):
        text = random_formula(draw, 5)
        field = Expressions([text], dim=2)
        gradient, rate = field.gradient(X, t), field.rate(X, t)
        for name, ours in (("X", gradient[:, 0, 0]), ("Y", gradient[:, 0, 1]), ("t", rate[:, 0])):
            names = {"X": X[:, 0], "Y": X[:, 1], "t": t}
            names[name] = names[name] + 1j * h
            expected = np.broadcast_to(np.imag(walk(field.entries[0], names)) / h, 10)
            np.testing.assert_allclose(ours, expected, rtol=1e-12, atol=1e-12, err_msg=text)


@pytest.mark.parametrize(
    ("formula", "slope"),
    [
        ("floor(log(X)) + X", 1),
        ("X**0", 0), ("X**1", 1), ("X**2", 0), ("X**3", 0), ("3*X**1 + X**2*t", 3),
        ("abs(X)", 0), ("max(X, 0)", 0.5), ("min(X, 2*X)", 1.5), ("sqrt(X**2 + Y**2)", 0),
        ("where(X > 0, sqrt(X)*log(X), 4*X)", 4), ("max(log(X), X - 5)", 1), ("sqrt(X)", np.inf),
        ("t**1*X", 0), ("X*t**-1", np.inf), ("X/2**t", 1),
    ],
)  # fmt: skip
def test_derivatives_at_zero(formula, slope):
    """At X = Y = t = 0: powers, kinks (the mean of both sides), branches that are not taken."""
    gradient = Expressions([formula], dim=2).gradient(np.zeros((1, 2)), 0.0)
    assert gradient.shape == (1, 1, 2)
    assert gradient[0, 0, 0] == slope
    assert gradient[0, 0, 1] == 0


def test_current_positions_have_no_gradient():
    """x depends on the motion, which a formula does not know."""
    field = Expressions(["X + x"], dim=2)
    for derivative in (field.gradient, field.rate):
        with pytest.raises(ValueError, match="the formula uses 'x', which is not known here"):
            derivative(np.zeros((1, 2)), 0.0)


@pytest.mark.parametrize("dim", [2, 3])
def test_device(exact, rng, dim):
    """Every operation, also of current positions: the C library's functions differ from NumPy's by
    some units of 1e-16, which a condition of up to 10 amplifies."""
    X, x = rng.uniform(0.1, 0.9, (2, 50, dim))
    t = rng.uniform(0, 1)
    current = ["x*Y - t", "sqrt(x**2 + y**2)", "where(x < X, y, t)"]
    third = ["Z*z", "Z - 2*X"] if dim == 3 else []
    for entries in (SMOOTH[:20], SMOOTH[20:], current + third):
        field = Expressions(entries, dim=dim)
        expected = field.value(X, x, t)
        np.testing.assert_allclose(on_device(field, X, x, t), expected, rtol=1e-14, atol=1e-14)


def test_device_vortex(exact, rng):
    """Definitions of definitions, and no x at all.  In b_t terms of up to 250*25 cancel: some
    units of 1e-16 of them."""
    R, angle = rng.uniform(0.75, 1.25, 50), rng.uniform(-3, 3, 50)
    X = np.stack([R * np.cos(angle), R * np.sin(angle)], axis=1)
    field, out = Expressions(VORTEX_FORCE, VORTEX, dim=2), np.zeros((50, 2))
    expected = field.value(X, t=0.21)
    np.testing.assert_allclose(on_device(field, X, X, 0.21), expected, rtol=1e-14, atol=5e-12)
    evaluate_initial(field, Positions(X, X), out)
    np.testing.assert_allclose(out, field.value(X), rtol=1e-14, atol=5e-12)


def test_device_negative_bases(exact):
    """Whole constant exponents, also named or computed ones, are exact powers of any base."""
    field = Expressions(["X**2", "X**n", "X**(1 + 2)", "X**-1", "X**0", "Y**2"], {"n": 3.0}, dim=2)
    X = np.array([[-2.0, 0.0]])
    assert on_device(field, X, X, 0.0).tolist() == [[4, -8, -8, -0.5, 1, 0]]


def test_whole_exponents_stay_integers(monkeypatch):
    """A CPU's pow takes negative bases with the float 3.0 too; that of Vulkan gives NaN."""
    monkeypatch.setattr(ti, "pow", lambda base, exponent: exponent)
    exponents = [DEVICE["**"](-2.0, exponent) for exponent in (3.0, -1.0, 2.5, 1e10)]
    assert [(type(e), e) for e in exponents] == [(int, 3), (int, -1), (float, 2.5), (float, 1e10)]


def test_device_single_precision(rng):
    """f32: some units of 6e-8, amplified by up to 10."""
    runtime.start("cpu", "f32", threads=2, fast_math=False)
    X, x = rng.uniform(0.1, 0.9, (2, 50, 2)).astype(np.float32)
    for entries in (SMOOTH[:20], SMOOTH[20:]):
        field = Expressions(entries, dim=2)
        expected = field.value(X, x, 0.25)
        np.testing.assert_allclose(on_device(field, X, x, 0.25), expected, rtol=3e-6, atol=1e-6)


def test_definitions_are_computed_once(exact):
    """Forty definitions, each of which uses the one before three times: expanded they were 3^40
    terms; shared they compile and run at once."""
    chain = {"a0": "X"} | {f"a{i}": f"sin(a{i - 1}*a{i - 1}) + a{i - 1}/2" for i in range(1, 41)}
    field, X = Expressions(["a40"], chain, dim=2), np.full((1, 2), 0.5)
    began = time.perf_counter()
    np.testing.assert_allclose(on_device(field, X, X, 0.0), field.value(X), rtol=1e-13)
    assert field.gradient(X).shape == (1, 1, 2)
    assert time.perf_counter() - began < 30


def test_deepest_formula_compiles(exact):
    """What the reader admits, the recursions of the walker and of Taichi can do."""
    field, X = Expressions(["cos(" * 99 + "X" + ")" * 99], dim=2), np.full((1, 2), 0.5)
    np.testing.assert_allclose(on_device(field, X, X, 0.0), field.value(X), rtol=1e-14)
    assert field.gradient(X).shape == (1, 1, 2)


def test_only_what_is_used():
    """Constants are folded and unused definitions left out; equal fields are equal keys."""
    definitions = {"c": "sqrt(2)/2", "unused": "t", "R": "c*X", "S": "R + R", "far": "Z"}
    field = Expressions(["S**2", "1 + c"], definitions, dim=3)
    assert field.variables == {"X"}
    assert list(field.definitions) == ["R", "S"]
    assert field.entries == (("**", "S", 2.0), 1 + np.sqrt(2) / 2)
    same = Expressions(["(S)**2", "1 + c"], definitions, dim=3)
    assert field == same and hash(field) == hash(same)
    assert field != Expressions(["S**2", "2 + c"], definitions, dim=3)
    assert Expressions([1], dim=2) != Expressions([1], dim=3)


def test_every_operation_has_each_form():
    """Host and device know the same operations."""
    assert set(DEVICE) == set(OPERATIONS)


@pytest.mark.parametrize(
    ("formula", "sentence"),
    [
        ("", "the formula is empty"),
        ("X^2", "the character '^' has no meaning in a formula: use ** for powers"),
        ("X # note", "the character '#' has no meaning in a formula"),
        ("X[0]", "the character '[' has no meaning in a formula"),
        ("sin(\x00)", r"the character '\x00' has no meaning in a formula"),
        ("\ud800", r"the character '\ud800' has no meaning in a formula"),
        ("2·X", "the character '·' has no meaning in a formula"),
        ("'X'", "the character \"'\" has no meaning in a formula"),
        ("2 X", "the formula cannot be read from 'X' on"),
        ("X + )", "the formula cannot be read from ')' on"),
        ("rad + X", "unknown name 'rad'; there are R, X, Y, density, pi, t, x, y"),
        ("sqr(X)", "unknown function 'sqr'; did you mean 'sqrt'?"),
        ("densty*X", "unknown name 'densty'; did you mean 'density'?"),
        ("__import__", "unknown name '__import__'; there are R, X, Y, density, pi, t, x, y"),
        ("Z", "there is no 'Z' in two dimensions"),
        ("sin + 1", "'sin' is a function: write sin(...)"),
        ("X(Y + 1)", "'X' is no function: write * for a product"),
        ("2(Y + 1)", "'2' is no function: write * for a product"),
        ("R(Y + 1)", "'R' is no function: write * for a product"),
        ("math.sin(X)", "'math.sin' has a dot: functions here are plain names"),
        ("X.real", "'X.real' has a dot: names here are plain"),
        ("().__class__.__bases__", "'().__class__.__bases__' has a dot: names here are plain"),
        ("sin()", "sin takes 1 value, not 0"),
        ("atan2(X)", "atan2 takes 2 values, not 1"),
        ("min(X)", "min takes 2 to 100 values, not 1"),
        ("max(" + "X," * 200 + "X)", "max takes 2 to 100 values, not 201"),
        ("atan2(X, y=2)", "'y=2' is no part of a formula"),
        ("max(*X, 2)", "'*X' is no part of a formula"),
        ("X, Y", "'X, Y' is no part of a formula"),
        ("max(X for X in Y)", "max takes 2 to 100 values, not 1"),
        ("X % 2", "'X % 2' has an unknown operator: there are + - * / **"),
        ("X < 1", "'X < 1' is no number: write where(X < 1, a, b)"),
        ("where(X, 1, 2)", "where begins with a comparison such as X < 1, not 'X'"),
        ("where(0 < X < 1, 1, 2)", "'0 < X < 1' compares twice: put one where inside another"),
        ("where(X == 1, 1, 2)", "'X == 1' is no comparison by < <= > >="),
        ("where(X < 1 or Y < 1, 1, 2)",
         "'X < 1 or Y < 1' uses and, or, not: put one where inside another"),
        ("1 if X else 2", "'1 if X else 2' uses if: write where(condition, a, b)"),
        ("1j*X", "'1j' is no real number"),
        ("X + True", "'True' is no real number"),
        ("1e999", "'1e999' is no finite number"),
        ("9" * 400, "'999999999999999999999999999999999999 ...' is no finite number"),
        ("9**9**9**9", "'9**9**9' is no finite number"),
        ("X + log(-1)", "'log(-1)' is no finite number"),
        ("X" * 10_001, "the formula is longer than 10000 characters: split it by definitions"),
        (True, "True is no real number"),
        (float("nan"), "nan is no finite number"),
        *((deep, "the formula nests or chains more than 100 operations: split it by definitions")
          for deep in ("-" * 9000 + "1", "1+" * 4000 + "1", "X" + "**X" * 3000, "1" + "*X" * 100)),
    ],
)  # fmt: skip
def test_refused(formula, sentence):
    """One sentence that names the offending piece."""
    definitions = {"R": parse("X*Y", 2), "density": 1000.0}
    with pytest.raises(ValueError) as error:
        parse(formula, 2, definitions)
    assert str(error.value) == sentence


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("t", "'t' has a meaning already: take another name"),
        ("Z", "'Z' has a meaning already: take another name"),
        ("pi", "'pi' has a meaning already: take another name"),
        ("where", "'where' has a meaning already: take another name"),
        ("lambda", "'lambda' cannot name a definition (it is a word of Python): "
         "take a letter, then letters, digits and _"),
        ("2a", "'2a' cannot name a definition: take a letter, then letters, digits and _"),
        ("ﬁ", "'ﬁ' cannot name a definition: take a letter, then letters, digits and _"),
        ("", "'' cannot name a definition: take a letter, then letters, digits and _"),
    ],
)  # fmt: skip
def test_refused_names(name, sentence):
    """A definition may not hide what a formula can mean."""
    with pytest.raises(ValueError) as error:
        check_name(name)
    assert str(error.value) == sentence
    with pytest.raises(ValueError, match="name"):
        Expressions([1], {name: 1}, dim=2)


def test_definitions_come_in_order():
    """A definition knows those before it, not itself, nor those after it."""
    for definitions in ({"a": "b", "b": 1}, {"a": "a + 1"}):
        with pytest.raises(ValueError, match="unknown name"):
            Expressions(["a"], definitions, dim=2)


PIECES = [
    "X", "Y", "Z", "x", "t", "pi", "R", "1", "2.5", "1e3", "9", "**", "*", "+", "-", "/", "%",
    "(", ")", ",", "<", ">=", "=", "sin", "min", "where(", "atan2", "if", "else", "lambda", "and",
    "not", "for", "in", "yield", "await", ".", "_", "0x", "1_0", "1j", " ", "\n", "'", "[", "{",
    ":", "\\", "\x00", "é", "None", "...", "import", "==",
]  # fmt: skip


@settings(max_examples=1000, deadline=None)
@given(
    st.one_of(st.text(max_size=200), st.lists(st.sampled_from(PIECES), max_size=40).map("".join))
)
def test_any_text_is_read_or_refused(text):
    """No other exception, no warning; what is read can be evaluated and differentiated."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            field = Expressions([text], {"R": "X*t"}, dim=2)
        except ValueError as error:
            assert str(error)
            return
        X = np.full((2, 2), 0.5)
        assert field.value(X, X, 0.5).shape == (2, 1)
        if not field.variables & {"x", "y"}:
            assert field.gradient(X, 0.5).shape == (2, 1, 2)
            assert field.rate(X, 0.5).shape == (2, 1)
