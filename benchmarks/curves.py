"""How the time of a particle-step depends on the number of particles and on empty cells, and what a
step of few particles takes."""

from statistics import median

from interleaved import in_turns
from tables import markdown

COUNTS = (1_000, 10_000, 100_000, 1_000_000)
LARGE = 10_000_000
ROOMS = (1, 2, 4)
"""Cells along each axis for the same block, as a multiple."""

IN_ROOMS = 100_000
FEW = 1_000


def points(dim, most=None, large=False) -> list[tuple[int, int]]:
    """(particles, room): the curve over particles, up to `most`, and in 3D over empty cells."""
    largest = LARGE if large else COUNTS[-1]
    most = min(most or largest, largest)
    found = [(count, 1) for count in (*COUNTS, LARGE) if count < most] + [(most, 1)]
    if dim == 3:
        found += [(min(most, IN_ROOMS), room) for room in ROOMS]
    return list(dict.fromkeys(found))


def measured(dim, precision, form, threads, rounds, most=None, large=False) -> list[dict]:
    """A row for each point and number of threads: least and median over rounds
    [ns per particle-step], the sort included."""
    specs = [
        {
            "kind": "steps", "dim": dim, "precision": precision, "form": form,
            "particles": count, "room": room, "threads": workers,
        }
        for count, room in points(dim, most, large)
        for workers in threads
    ]  # fmt: skip
    rows = []
    for child in in_turns(specs, rounds):
        turns, spec = child.turns, child.spec
        rows.append({
            "case": f"{dim}D {precision} {form}", "threads": spec["threads"], "room": spec["room"],
            "particles": child.about["particles"], "cells": child.about["cells"],
            "sort_share": min(turn["sort"] / turn["cpu"] for turn in turns),
            "steps_per_sort": turns[0]["steps_per_sort"],
            **{clock: min(turn[clock] for turn in turns) for clock in ("cpu", "wall")},
            **{f"median_{c}": median(turn[c] for turn in turns) for c in ("cpu", "wall")},
        })  # fmt: skip
    return rows


def table(rows) -> str:
    """A line for each row of `measured`."""
    head = ["case", "particles", "cells", "threads", "CPU", "median", "wall", "median"]
    lines = [
        [
            row["case"], f"{row['particles']:,}", " x ".join(map(str, row["cells"])),
            str(row["threads"]), f"{row['cpu']:.1f}", f"{row['median_cpu']:.1f}",
            f"{row['wall']:.1f}", f"{row['median_wall']:.1f}",
            f"{100 * row['sort_share']:.1f} %", f"{row['steps_per_sort']:.0f}",
        ]
        for row in rows
    ]  # fmt: skip
    return markdown([*head, "sort", "steps per sort"], lines)


def small_scene(form, precisions, rounds) -> list[dict]:
    """A row for each precision: microseconds of a step of few particles in 2D, least and median."""
    specs = [
        {"kind": "small", "dim": 2, "precision": precision, "particles": FEW, "form": form}
        for precision in precisions
    ]
    rows = []
    for child in in_turns(specs, rounds):
        row = child.about | {"case": f"2D {child.spec['precision']} {form}"}
        for way in ("whole", "by_stage"):
            for clock in ("cpu", "wall"):
                times = [t for turn in child.turns for t in turn[way][clock]]
                row[f"{way}_{clock}"], row[f"{way}_median_{clock}"] = min(times), median(times)
        rows.append(row)
    return rows


def small_table(rows) -> str:
    """A line for each row of `small_scene`."""
    head = ["case", "particles", "whole steps", "median", "CPU", "stage by stage", "median", "CPU"]
    ways, clocks = ("whole", "by_stage"), ("wall", "median_wall", "cpu")
    keys = [f"{way}_{clock}" for way in ways for clock in clocks]
    lines = [
        [row["case"], f"{row['particles']:,}", *(f"{row[key]:.0f}" for key in keys)] for row in rows
    ]
    return markdown(head, lines)
