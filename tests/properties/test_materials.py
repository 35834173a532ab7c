"""What every law keeps, on the fast form: independent truths, not the twin."""

from types import SimpleNamespace
from typing import Literal

import numpy as np
import pytest
import taichi as ti

from mpm_taichi import runtime
from mpm_taichi.materials import DruckerPrager, Fluid, Gas, VonMises
from mpm_taichi.materials.invariants import exp_less_one, log_volume_ratio, volume_strain
from mpm_taichi.runtime import Array

from ..laws import (
    BY_NAME,
    DX,
    LAWS,
    MODULUS,
    STIFF,
    VISCOUS,
    deformations,
    followed,
    followed_by_twin,
    rates_of,
    response,
    rotations,
    stress_in_space,
)

PRECISIONS = {"f32": 2e-5, "f64": 1e-12}
"""Rounding of a stress of order E, relative to E: about 100 rounding errors.

All of a precision comes together, and that of the tests without one last: in each a law is compiled
once."""

TURNING = [law for law in LAWS if law.type != "linear_elastic"]
"""Laws whose stress turns with the body."""

WITHIN = {
    "neo_hookean": (1.1, 1.0), "fixed_corotated": (1.1, 1.0), "hencky": (1.1, 1.0),
    "von_mises": (1.0, 0.02), "drucker_prager": (0.95, 0.01), "snow": (0.99, 0.03),
    "fluid": (0.9, 0.15), "gas": (1.1, 1.0),
}  # fmt: skip
"""Middle and width of the stretches where a law stores all work: stress follows from energy."""

each_precision = pytest.mark.parametrize("precision", PRECISIONS, scope="module")
each_dim = pytest.mark.parametrize("dim", [2, pytest.param(3, marks=pytest.mark.slow)])


def together(law):
    """One worker for all tests of a law, which it compiles once."""
    return pytest.mark.xdist_group(law)


def each(laws):
    rows = [pytest.param(law, id=law.type, marks=together(law.type)) for law in laws]
    return pytest.mark.parametrize("material", rows)


def walks(rng, steps, n, dim, size):
    """Random velocity gradients [steps, n, dim, dim]."""
    return size * rng.normal(size=(steps, n, dim, dim))


@each_precision
@each_dim
@each(LAWS)
def test_no_stress_at_rest(material, dim, precision):
    """F = I, fresh state: tau = 0 and psi = 0 exactly; a gas has its pressure and its energy."""
    found = response(material, np.eye(dim)[None], precision)
    pressure = material.pressure if isinstance(material, Gas) else 0.0
    assert np.abs(stress_in_space(found) + pressure * np.eye(3)).max() <= 1e-6 * pressure
    assert abs(found.psi[0] - 2.5 * pressure) <= 1e-6 * pressure
    assert found.lost[0] == found.plastic_strain[0] == 0 and found.J[0] == 1


@each_dim
@each([law for law in LAWS if law.type in WITHIN])
def test_stress_is_the_derivative_of_the_energy(rng, material, dim):
    """tau = dpsi/dF F^T by central differences with h = 1e-5: error h^2 times the third derivative
    (of a fluid with gamma = 7 a hundred times E) and u / h, 1e-8 of E."""
    F, h = deformations(rng, 20, dim, *WITHIN[material.type]), 1e-5
    steps = h * np.eye(dim**2).reshape(-1, 1, dim, dim)  # of one component each
    found = response(material, np.concatenate([F, *(F + steps), *(F - steps)]))
    tau, ahead, behind = found.tau[:20], *found.psi[20:].reshape(2, dim, dim, 20)
    P = ((ahead - behind) / 2 / h).transpose(2, 0, 1)
    bound = 1e-6 if material.type == "fluid" else 1e-8
    assert np.abs(P @ F.swapaxes(1, 2) - tau).max() < bound * MODULUS
    assert not found.lost.any()


@each_precision
@each_dim
@each(TURNING)
def test_objective_and_isotropic(rng, material, dim, precision):
    """tau(Q F) = Q tau(F) Q^T and tau(F Q) = tau(F) for rotations Q, also where the law flows."""
    F, Q = deformations(rng, 20, dim), rotations(rng, 20, dim)
    tau, turned, relabeled = response(
        material, np.concatenate([F, Q @ F, F @ Q]), precision
    ).tau.reshape(3, 20, dim, dim)  # fmt: skip
    scale = np.abs(tau).max()
    assert np.abs(turned - Q @ tau @ Q.swapaxes(1, 2)).max() < PRECISIONS[precision] * scale
    assert np.abs(relabeled - tau).max() < PRECISIONS[precision] * scale


@each_dim
@each(TURNING)
def test_turning_changes_nothing(rng, material, dim):
    """Deformed once, then turned by random rotations: the stress turns along, nothing flows and
    nothing is lost; after 50 turns rounding errors of 1e-13 each."""
    F0 = deformations(rng, 20, dim, 1.0, 0.3)
    Q = rotations(rng, 1000, dim).reshape(50, 20, dim, dim)
    found = followed(material, rates_of(np.concatenate([F0[None], Q @ F0])))
    tau = Q @ found.tau[0] @ Q.swapaxes(2, 3)
    assert np.abs(found.tau[1:] - tau).max() < 1e-11 * np.abs(tau).max()
    for values in (found.psi, found.lost, found.plastic_strain, found.J):
        assert np.abs(values - values[0]).max() <= 1e-11 * np.abs(values).max()


@each_dim
@each(TURNING)
def test_a_thousand_revolutions(rng, material, dim):
    """Sheared, flowing where the law flows, then turned a thousand times about an axis of its own,
    in fifths: the stress is that of the start, turned; nothing flows (hard_cases.md, H10: 1e-9;
    rounding errors of 5000 steps are some 1e-12).  One of the four is compressed: of a fluid that
    bears no tension all others may have no stress to compare with."""
    F0 = deformations(rng, 4, dim, 1.0, 0.3)
    F0[0] *= 0.9 / np.linalg.det(F0[0]) ** (1 / dim)
    fifth, turn = 2 * np.pi / 5, np.eye(dim)
    turn[:2, :2] = [[np.cos(fifth), -np.sin(fifth)], [np.sin(fifth), np.cos(fifth)]]
    Q = rotations(rng, 4, dim)
    R = Q @ turn @ Q.swapaxes(1, 2)
    rates = np.concatenate([F0[None], np.tile(R, (5000, 1, 1, 1))]) - np.eye(dim)
    found = followed(material, rates)
    for step, turned in ((-1, np.eye(dim)), (-3, R.swapaxes(1, 2) @ R.swapaxes(1, 2))):
        tau = turned @ found.tau[0] @ turned.swapaxes(-1, -2)
        assert np.abs(found.tau[step] - tau).max() <= 1e-9 * np.abs(tau).max()
    for values in (found.lost, found.plastic_strain, found.J):
        assert np.abs(values - values[0]).max() <= 1e-9 * np.abs(values).max()


@pytest.mark.slow
@each(LAWS + VISCOUS)
def test_plane_strain_is_space_without_a_third_stretch(rng, material):
    """The same random walk in 2D and, with nothing along z, in 3D: stress, energies, volume and
    plastic strain are equal.  So yield surfaces of a plane are those of space."""
    plane = walks(rng, 8, 30, 2, 0.1)
    space = np.zeros((8, 30, 3, 3))
    space[..., :2, :2] = plane
    thin, whole = followed(material, plane), followed(material, space)
    if material.type == "linear_elastic":  # its strain does not turn: the same in both
        assert np.abs(thin.J - whole.J).max() < 1e-13
    # The viscous stress is of a rate, which an evaluation of tau_zz does not know.
    compared = (slice(None),) * 2 + (slice(2),) * 2 if material in VISCOUS else ...
    tau = stress_in_space(thin)
    assert np.abs(tau[compared] - whole.tau[compared]).max() < 1e-12 * np.abs(tau).max()
    for name in ("psi", "lost", "J", "plastic_strain"):
        a, b = getattr(thin, name), getattr(whole, name)
        assert np.abs(a - b).max() <= 1e-12 * np.abs(b).max(), name


@each_dim
@each([law for law in LAWS + VISCOUS if "elastic" not in law.type])
def test_work_is_stored_or_lost(rng, material, dim):
    """Along smooth random paths the work sum tau : sym(L) dt is what psi and the loss grow by: to
    first order in the step, so that half the step leaves half the difference.  Of the work done and
    taken back less than 0.1 % is left by extrapolation from 400 and 800 steps."""
    a, b = rng.normal(size=(2, 30, dim, dim))
    size = {"snow": 0.03, "drucker_prager": 0.05}.get(material.type, 0.1)

    def difference(steps):
        s = np.arange(1, steps + 1)[:, None, None, None] / steps
        F = np.eye(dim) + size * (np.sin(6 * s) * a + (np.cos(6 * s) - 1) * b)
        rates = rates_of(F) * steps
        found = followed(material, rates, 1 / steps)
        power = (found.tau * rates).sum(axis=(2, 3)) / steps
        start = 2.5 * MODULUS if isinstance(material, Gas) else 0.0
        kept = found.psi[-1] - start + found.lost[-1]
        return (power.sum(axis=0) - kept) / np.abs(power).sum(axis=0).max()

    coarse, fine = difference(400), difference(800)
    print(f"{material.type}: {np.abs(coarse).max():.2e}, {np.abs(fine).max():.2e}")
    assert np.abs(2 * fine - coarse).max() < 1e-3


@each_precision
@each_dim
@each([BY_NAME["von_mises"], BY_NAME["drucker_prager"]])
def test_on_or_below_the_yield_surface(rng, material, dim, precision):
    """After each step of violent random walks f <= 1e-6 of the yield stress (f64; of the pressures
    at hand for sand), where f is taken from the stress alone; most states flow, and the plastic
    work of each step is positive."""
    found, bound = (
        followed(material, walks(rng, 10, 100, dim, 0.1), precision=precision),
        {"f32": 1e-4, "f64": 1e-6}[precision],
    )
    tau = stress_in_space(found)
    p = -np.trace(tau, axis1=2, axis2=3) / 3
    size = np.sqrt(((tau + p[..., None, None] * np.eye(3)) ** 2).sum(axis=(2, 3)))
    if isinstance(material, VonMises):
        limit = material.yield_stress + material.hardening * found.plastic_strain
        f, scale = np.sqrt(1.5) * size - limit, material.yield_stress
    else:
        phi = np.radians(material.friction_angle)
        M, C = 6 * np.sin(phi) / (3 - np.sin(phi)), material.cohesion
        f = np.sqrt(1.5) * size - M * p - 6 * C * np.cos(phi) / (3 - np.sin(phi))
        scale = np.abs(p).max()
        f[tau.any(axis=(2, 3)) == 0] = 0  # torn
    assert f.max() <= bound * scale
    assert (f > -bound * scale).mean() > 0.2
    work = np.diff(found.lost, axis=0, prepend=0)
    assert work.min() >= -bound * found.lost.max() and (work > 0).mean() > 0.2


@together("snow")
@each_precision
@each_dim
def test_stretches_of_snow_are_clamped(rng, dim, precision):
    """Singular values of the elastic part within [1 - theta_c, 1 + theta_s] to round-off, all else
    in J_P: J = J_E J_P is det F; counted where the hardening is capped.  Plastic work is positive,
    but where a stretch is clamped under pressure from the sides: less than 1 % of all.  Snow three
    times as wide in each of ten steps has no stress left, however large xi J_P is."""
    snow, bound = BY_NAME["snow"], PRECISIONS[precision]
    rates = walks(rng, 10, 100, dim, 0.03)
    rates[:, 98], rates[:, 99] = -0.05 * np.eye(dim), 2.0 * np.eye(dim)  # shrinks, widens
    found = followed(snow, rates, precision=precision)
    assert np.abs(found.tau[1:, 99]).max() <= bound * MODULUS
    J_P = found.J[:, 98] / (1 - snow.critical_compression) ** dim
    beyond = (snow.hardening * (1 - J_P) > np.log(snow.largest_hardening)).sum()
    assert beyond > 0 and found.capped[-1, 98] == beyond
    s = np.linalg.svd(found.H + np.eye(dim), compute_uv=False)
    assert s.min() > 1 - snow.critical_compression - bound
    assert s.max() < 1 + snow.critical_stretch + bound
    J = np.cumprod(np.linalg.det(np.eye(dim) + rates), axis=0)
    assert np.abs(found.J / J - 1).max() < 10 * bound
    work = np.diff(found.lost, axis=0, prepend=0)[:, :98]
    assert -work[work < 0].sum() < 0.01 * work.sum()


@each_precision
@each_dim
@each([law for law in LAWS if law.type not in ("drucker_prager", "gas")])
def test_small_strain_is_hookes_law(rng, material, dim, precision):
    """At strains of 1e-6 tau = 2 mu eps + lam tr(eps) I to 1e-5 (the next order of the strain, of a
    fluid gamma times it, and in f32 a few rounding errors): H = F - I loses no digits.  A fluid has
    lam = K, mu = 0, and is compressed."""
    H = 1e-6 * rng.normal(size=(20, dim, dim))
    c = SimpleNamespace(**material.constants(DX))
    if isinstance(material, Fluid):
        H -= 1e-5 * np.eye(dim)
        c = SimpleNamespace(mu=0.0, lam=material.bulk_modulus)
    eps = 0.5 * (H + H.swapaxes(1, 2))
    lateral = c.lam * np.trace(eps, axis1=1, axis2=2)
    hooke = 2 * c.mu * eps + lateral[:, None, None] * np.eye(dim)
    found, bound = (
        followed(material, H[None], precision=precision),
        1e-4 if isinstance(material, Fluid) else 1e-5,
    )
    assert np.abs(found.tau[0] - hooke).max() < bound * np.abs(hooke).max()
    if dim == 2:
        assert np.abs(found.tau_zz[0] - lateral).max() < bound * np.abs(lateral).max()


@each_dim
@each(LAWS + VISCOUS)
def test_twin_gives_the_same(rng, material, dim):
    """Along random walks all answers equal to 1e-12 of the largest."""
    rates = walks(rng, 6, 30, dim, 0.05)
    ours, twin = vars(followed(material, rates, 0.5)), vars(followed_by_twin(material, rates, 0.5))
    for name, values in twin.items():
        assert np.abs(ours[name] - values).max() <= 1e-12 * np.abs(values).max(), name


@pytest.mark.slow
@together("von_mises")
def test_extension_beyond_yield(rng):
    """Extension e = (a, -a, 0) at constant volume, in one step or in many: tau_1 - tau_3 by hand,
    q = sqrt(3) tau_1 = Y + h k with 2 sqrt(3) mu (a - sqrt(3)/2 k) = sqrt(3) tau_1."""
    metal = BY_NAME["von_mises"]
    mu, Y, h = metal.constants(DX)["mu"], metal.yield_stress, metal.hardening
    a = rng.uniform(0.1, 0.5)
    k = (2 * np.sqrt(3) * mu * a - Y) / (3 * mu + h)
    for steps in (1, 7):
        way = np.exp(a * np.arange(1, steps + 1) / steps)
        F = np.array([[np.diag([x, 1 / x, 1.0])] for x in way])
        found = followed(metal, rates_of(F))
        assert found.plastic_strain[-1, 0] == pytest.approx(k, rel=1e-12)
        assert np.sqrt(3) * found.tau[-1, 0, 0, 0] == pytest.approx(Y + h * k, rel=1e-12)


@pytest.mark.slow
@together("drucker_prager")
@pytest.mark.parametrize("corrected", [True, False])
def test_opened_sand_has_to_close(corrected):
    """Cohesionless sand opened by 10 % and closed by 5 and by 11 %: with the volume correction the
    pressure is that of the volume, 0 and 0 and K ln(1.1 x .95 x .89); without, it returns at
    once."""
    sand = DruckerPrager(
        type="drucker_prager", friction_angle=30.0, volume_correction=corrected, **STIFF
    )
    stretch = np.cbrt([1.1, 0.95, 0.89])
    found = followed(sand, np.array([[(s - 1) * np.eye(3)] for s in stretch]))
    c = sand.constants(DX)
    K = c["lam"] + 2 / 3 * c["mu"]
    J = np.cumprod(stretch**3)
    expected = np.minimum(0, np.log(J)) if corrected else np.log([1, 0.95, 0.95 * 0.89])
    assert found.tau[:, 0, 0, 0] == pytest.approx(K * expected, abs=1e-12 * MODULUS)
    assert found.J[:, 0] == pytest.approx(J, rel=1e-12)


@pytest.mark.slow
@together("drucker_prager")
def test_cohesion_and_cones():
    """Both cones give Mohr-Coulomb's (s1 - s3) / 2 = C cos phi - (s1 + s3) / 2 sin phi: the one in
    triaxial compression, the other where its normal has no component across the plane, dev s ~ (b +
    n, - 2 n, n - b) with n = tan phi / sqrt(9 + 12 tan^2 phi), b^2 = 1 - 3 n^2 (Drucker and Prager
    1952)."""
    phi, C = np.radians(30), 500.0
    n = np.tan(phi) / np.sqrt(9 + 12 * np.tan(phi) ** 2)
    b = np.sqrt(1 - 3 * n**2)
    cones: tuple[tuple[Literal["plane_strain", "compression"], list[float]], ...] = (
        ("plane_strain", [b + n, -2 * n, n - b]),
        ("compression", [0.5, 0.5, -1]),
    )
    for cone, axes in cones:
        sand = DruckerPrager(
            type="drucker_prager", friction_angle=30.0, cohesion=C, cone=cone, **STIFF
        )
        F = np.diag(np.exp(0.5 * np.array(axes) - 0.01))
        tau = np.diag(response(sand, F[None]).tau[0])
        shear, mean = (tau[0] - tau[2]) / 2, -(tau[0] + tau[2]) / 2
        assert shear == pytest.approx(C * np.cos(phi) + mean * np.sin(phi), rel=1e-9), cone


@together("fluid")
def test_viscosity_does_not_depend_on_the_step(rng):
    """Simple shear at a rate g: tau_xy = eta g at every dt, and eta g^2 t is lost."""
    fluid, g = VISCOUS[0], rng.uniform(1, 2)
    L = np.zeros((2, 1, 2, 2))
    L[..., 0, 1] = g
    for dt in (1e-3, 1e-6):
        found = followed(fluid, L, dt)
        assert found.tau[-1, 0, 0, 1] == pytest.approx(fluid.viscosity * g, rel=1e-12)
        assert found.lost[-1, 0] == pytest.approx(fluid.viscosity * g**2 * 2 * dt, rel=1e-9)


@together("fluid")
def test_a_fluid_tears_at_its_tension():
    """Stretched by 1 % in each of 5 steps, K / gamma (J^-gamma - 1) would fall below - p_t in the
    second one: four are counted, J stays where the pressure is - p_t, and what opened further took
    the work p_t dJ.  Closed by 1 %, it is compressed from there at once."""
    fluid = VISCOUS[0].model_copy(update={"viscosity": 0.0})
    L = np.zeros((6, 1, 2, 2))
    L[..., 0, 0] = [[0.01]] * 5 + [[-0.01]]
    found = followed(fluid, L)
    J = (1 - fluid.tension * 7 / MODULUS) ** (-1 / 7)
    assert found.cut_off[0, 0] == 4
    assert found.J[:, 0] == pytest.approx([1.01, J, J, J, J, 0.99 * J], rel=1e-12)
    assert found.tau[1:5, 0, 0, 0] == pytest.approx(J * fluid.tension, rel=1e-12)
    assert found.lost[-1, 0] == pytest.approx(fluid.tension * (1.01**2 - J + 0.03 * J), rel=1e-9)


@together("gas")
def test_gas_without_heat(rng):
    """Without artificial viscosity p J^gamma stays, whatever the steps."""
    L = 0.1 * rng.normal(size=(9, 20, 3, 3))
    gas = BY_NAME["gas"]
    found = followed(gas, L)
    p = -found.tau[..., 0, 0] / found.J
    assert p * found.J**gas.heat_ratio == pytest.approx(gas.pressure, rel=1e-12)


@together("gas")
def test_artificial_viscosity_heats():
    """Compressed at a rate D, a gas pushes back with q = rho dx (c0 dx D^2 - c1 a D) more, and its
    energy grows by the work of q; expanding it has none."""
    gas, D, dt = VISCOUS[1], -50.0, 1e-6
    for rate in (D, -D):
        L = np.zeros((1, 1, 2, 2))
        L[..., 0, 0] = rate
        found = followed(gas, L, dt)
        a = gas.wave_speed()
        q = gas.density * DX * (2 * DX * D**2 - a * D) if rate < 0 else 0.0
        assert -found.tau[0, 0, 0, 0] == pytest.approx(0.4 * found.psi[0, 0] + q, rel=1e-9)
        isentropic = 2.5 * gas.pressure * found.J[0, 0] ** (1 - gas.heat_ratio)
        heat = found.psi[0, 0] - isentropic
        assert heat == pytest.approx(-q * rate * dt, rel=1e-3, abs=1e-9)


@ti.kernel
def logarithms(strain: Array, result: Array):
    for p in range(strain.shape[0]):
        result[p] = log_volume_ratio(strain[p])


@ti.kernel
def volumes(H: Array, result: Array):
    for p in range(H.shape[0]):
        M = ti.Matrix.zero(float, 3, 3)
        for d, e in ti.static(ti.ndrange(3, 3)):
            M[d, e] = H[p, d, e]
        result[p] = volume_strain(M)


@pytest.mark.parametrize(("precision", "bound"), [("f64", 4e-16), ("f32", 3e-7)])
def test_logarithm_keeps_small_strains(rng, precision, bound):
    """ln(1 + e) to a few rounding errors of the result for |e| from 1e-12 to 0.9, fast-math on."""
    runtime.start("cpu", precision)
    dtype = {"f32": np.float32, "f64": np.float64}[precision]
    strain = (10 ** rng.uniform(-12, -0.05, 2000) * rng.choice([-1, 1], 2000)).astype(dtype)
    result = np.zeros_like(strain)
    logarithms(strain, result)
    truth = np.log1p(strain.astype(float))
    assert np.abs(result / truth - 1).max() < 4 * bound


def test_volume_strain_keeps_small_strains(exact, rng):
    """J - 1 of H = 1e-9 times a random matrix, against tr H + order 2 computed in full: det(I + H)
    - 1 would keep 7 digits only."""
    H = 1e-9 * rng.normal(size=(50, 3, 3))
    result = np.zeros(50)
    volumes(H, result)
    trace = np.trace(H, axis1=1, axis2=2)
    second = 0.5 * (trace**2 - np.trace(H @ H, axis1=1, axis2=2))
    assert np.abs(result - (trace + second)).max() < 1e-13 * np.abs(trace).max()


@ti.kernel
def exponentials(y: Array, result: Array):
    for p in range(y.shape[0]):
        result[p] = exp_less_one(y[p])


@pytest.mark.parametrize(("precision", "bound"), [("f64", 4e-16), ("f32", 3e-7)])
def test_exponential_keeps_small_numbers(rng, precision, bound):
    """exp(y) - 1 for |y| from 1e-12 to 20 to a few rounding errors of the result, and |y| more, as
    doubling magnifies them; fast-math on."""
    runtime.start("cpu", precision)
    dtype = {"f32": np.float32, "f64": np.float64}[precision]
    y = (10 ** rng.uniform(-12, 1.3, 2000) * rng.choice([-1, 1], 2000)).astype(dtype)
    result = np.zeros_like(y)
    exponentials(y, result)
    truth = np.expm1(y.astype(float))
    assert (np.abs(result / truth - 1) < bound * (3 + np.abs(y))).all()
