"""What each stage of the step computes, as formulas in ASCII.

`_` and `^` begin an index of letters, digits, `+`; `^-1` is the inverse, `<-` gives a new value;
r_ip = x_i - x_p, V_p is the volume at the start and tau_p = J_p sigma_p (Kirchhoff's stress)."""

from .scene import Scene
from .transfers import FLIPBlend

GRADIENT, MOMENT = "sum_i v_i grad w_ip^T", "sum_i w_ip v_i r_ip^T D^-1"
MOVE = "x_p <- x_p + dt sum_i w_ip v_i"
STRESS = ("F_p <- (I + dt L_p) F_p", "tau_p from F_p, L_p by the law of the material")


def stage_names(scene: Scene) -> tuple[str, ...]:
    """The stages of a step, in order: `Solver.stages` and the reset of the nodes.  A stress that is
    updated last is part of the way from nodes to particles."""
    names = ["particles to nodes", "grid update", "nodes to particles", "reset"]
    if scene.method.stress_update != "usl":
        names.insert(0 if scene.method.stress_update == "usf" else 3, "stress")
    return tuple(names)


def formulas(scene: Scene, stage: str) -> tuple[str, ...]:
    """Of a stage, in the method of the scene, a line each."""
    transfer, order = scene.method.transfer_class, scene.method.stress_update
    if stage == "particles to nodes":
        return ("m_i = sum_p w_ip m_p", *_given(scene))
    if stage == "grid update":
        both = "v_i and v_i^old" if transfer.increment else "v_i"
        held = (f"{both} by the rules of the walls",) if scene.domain.rules else ()
        gravity = " + dt g" if any(scene.gravity_vector) else ""
        if transfer.increment:
            return ("v_i^old = (m v)_i / m_i", f"v_i = v_i^old + dt f_i / m_i{gravity}", *held)
        return (f"v_i = (m v)_i / m_i{gravity}", *held)
    if stage == "nodes to particles":
        taken = _taken(transfer, scene.method.filter_order)
        if order == "usl" or transfer.affine:
            taken += _gradients(transfer)
        stress = STRESS if order == "usl" else ()
        move = () if order == "musl" else (MOVE,)
        return (*taken, *stress, *move)
    if stage == "stress":
        given = "w_ip (m_p v_p + A_p r_ip)" if transfer.affine else "w_ip m_p v_p"
        now = f"v_i = sum_p {given} / m_i"
        move = (f"{MOVE}, v_i of the grid update",) if order == "musl" else ()
        return (now, f"L_p = {GRADIENT}", *STRESS, *move)
    return ("m_i <- 0, v_i <- 0", "x_i <- i dx")


def _given(scene) -> tuple[str, ...]:
    """What particles give to the nodes beside their mass."""
    transfer, basis = scene.method.transfer_class, scene.method.basis_class
    motion = "m_p v_p"
    if transfer.affine:
        motion = "m_p v_p + A_p r_ip"
    if scene.body_force is not None and not transfer.increment:
        motion += " + dt m_p b_p"
    motion = f"w_ip ({motion})" if "+" in motion else f"w_ip {motion}"
    affine = ()
    if transfer.affine:
        velocity = "m_p C_p" if transfer.moments else "m_p L_p"
        affine = (f"A_p = {velocity}",)
        if not transfer.gradient:
            affine = (f"A_p = {velocity} - dt V_p tau_p D^-1, D = dx^2 / {basis.inverse_moment:g}",)
    stress = "V_p tau_p grad w_ip"
    if transfer.increment:
        force = f"f_i = - sum_p {stress}"
        if scene.body_force is not None:
            force = f"f_i = sum_p (w_ip m_p b_p - {stress})"
        return (f"(m v)_i = sum_p {motion}", force)
    if transfer.gradient:
        return (f"(m v)_i = sum_p ({motion} - dt {stress})", *affine)
    return (f"(m v)_i = sum_p {motion}", *affine)


def _taken(transfer, order) -> tuple[str, ...]:
    """The velocity that particles take back."""
    change = "sum_i w_ip (v_i - v_i^old)"
    if transfer.filtered:
        return (
            f"v_p <- v_p - (1 - S S^+)^{order} v_p + {change}",
            "S: nodes to particles, S^+: particles to nodes",
        )
    if not transfer.increment:
        return ("v_p = sum_i w_ip v_i",)
    if transfer is FLIPBlend:
        return (f"v_p <- alpha (v_p + {change}) + (1 - alpha) sum_i w_ip v_i",)
    return (f"v_p <- v_p + {change}",)


def _gradients(transfer) -> tuple[str, ...]:
    """The velocity gradient, and the affine velocity."""
    if not transfer.gradient:
        return (f"L_p = C_p = {MOMENT}",)
    return ((f"C_p = {MOMENT}",) if transfer.moments else ()) + (f"L_p = {GRADIENT}",)
