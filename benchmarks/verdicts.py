"""What the runs of `speed_vs_error.py` say beside each other."""

from experiments import EXPERIMENTS
from turns import Child

QUANTITIES = ("displacement", "velocity", "stress", "energy")


def judge(children: list[Child]) -> list[dict]:
    """Rows with relative errors, Pareto fronts, and what got worse with smaller cells."""
    scales = {}
    for child in children:
        for quantity, found in child.found.items():
            key = (child.row["experiment"], quantity)
            scales[key] = max(scales.get(key, 0.0), found["scale"])
    rows = [child.row for child in children]
    for child in children:
        name = child.row["experiment"]
        of = EXPERIMENTS[name].scale or name
        child.row["errors"] = {
            quantity: found["error"] / (scales.get((of, quantity)) or scales[name, quantity])
            for quantity, found in child.found.items()
        }
    for row in rows:
        row["pareto"] = [q for q in QUANTITIES if on_front(row, rows, q)]
        row["worse"] = row["failure"] is None and any(
            same(row, other) and other["level"] == row["level"] - 1
            and u(row) > 0.9 * u(other) for other in rows
        )  # fmt: skip
    return rows


def u(row: dict) -> float:
    """Error of the displacement, infinite where the run failed."""
    return row["errors"].get("displacement", float("inf"))


def same(row: dict, other: dict) -> bool:
    keys = ("experiment", "scheme", "precision")
    return all(row[key] == other[key] for key in keys)


def on_front(row: dict, rows: list[dict], quantity: str) -> bool:
    """Whether no other run of the experiment is at once cheaper and more accurate."""

    def point(row):
        return row["cpu_seconds"], row["errors"].get(quantity)

    if None in point(row):
        return False
    others = [point(o) for o in rows if o["experiment"] == row["experiment"] and o is not row]
    time, error = point(row)
    return not any(
        t <= time and e <= error for t, e in others if t is not None and e is not None
    )  # fmt: skip
