"""Branches as answers: what `--json` says of points and events, and the tables that a person reads."""

from collections.abc import Mapping, Sequence
from typing import Any

from rodlab.analysis.events import Event
from rodlab.analysis.follow import Branch
from rodlab.analysis.point import Point
from rodlab.lab.branches import Shown
from rodlab.lab.table import known_to, small, table

MEASURES = ("tip_angle", "height", "energy")
OF_ENDS = ("load", "shortening", "N1", "tau", "phi0")  # of a model between other ends, its reactions among them
ROWS = 24  # rows of a table of points; of more points every so many are shown


def of_branch(branch: Branch) -> dict[str, Any]:
    """Points and events, numbers at full precision."""
    return {
        "points": [of_point(p) for p in branch.points],
        "events": [of_event(e) for e in branch.events],
        "end": branch.reason,
        "completed": branch.completed,
    }


def of_point(p: Point) -> dict[str, Any]:
    """A point's load, measures, index, how its step was accepted, and the error of its tip angle."""
    known: Mapping[str, Any] = getattr(p.equations, "measures", {})
    return {
        "lam": p.lam, **{name: p.measure(name) for name in (*MEASURES, *OF_ENDS) if name in known}, "index": p.index,
        "index_verified": p.index_verified, "error": p.error, "accepted": p.accepted or "given",
    }  # fmt: skip


def of_event(e: Event) -> dict[str, Any]:
    """An event with the error of its load."""
    said = {"kind": e.kind, "lam": e.lam, "error": e.error, "multiplicity": e.multiplicity, "converged": e.converged}
    if "tip_angle" in getattr(e.point.equations, "measures", {}):
        said["tip_angle"] = e.point.tip_angle
    return {**said, "reason": e.reason} if e.reason else said


def points_table(title: str, branch: Branch) -> str:
    """Some of the points of a branch, the first and the last among them."""
    every = max(1, -(-len(branch) // ROWS))
    shown = [*branch.points[:-1:every], branch.points[-1]]
    rows: list[list[Any]] = [
        [
            f"{p.lam:.6f}", known_to(p.tip_angle, p.error), small(p.error), f"{p.height:.6f}", f"{p.energy:.6f}",
            f"{p.index}" + ("" if p.index_verified else "?"), p.accepted or "given",
        ]
        for p in shown
    ]  # fmt: skip
    note = f"\n(one in {every} of {len(branch)} points)" if every > 1 else ""
    return table(title, ["load", "tip angle", "+-", "height", "energy", "index", "step"], rows) + note


def events_table(branch: Branch) -> str:
    """The events of a branch, the end among them."""
    rows: list[list[Any]] = []
    for e in branch.events:
        times = "" if e.multiplicity <= 1 else f"x{e.multiplicity}"
        rows.append([e.kind, times, known_to(e.lam, max(e.error, 1e-15)), small(e.error) if e.kind != "end" else "", e.reason])
    return table("Events", ["kind", "", "load", "+-", "why"], rows)


def branches_table(title: str, shown: Sequence[Shown]) -> str:
    """One row a branch: from, to, points, how many steps were proved, events and run time."""
    rows: list[list[Any]] = []
    for s in shown:
        branch = s.branch
        events = "; ".join(f"{e.kind} {e.lam:.10g}" for e in branch.events[:4] if e.kind != "end")
        more = len(branch.events) - 5
        rows.append(
            [
                s.name, f"{branch.points[0].lam:.4f}", f"{branch.points[-1].lam:.4f}", len(branch),
                sum(p.proved for p in branch.points), f"{1e3 * s.seconds:.0f}", events + (f"; {more} more" if more > 0 else ""),
            ]
        )  # fmt: skip
    return table(title, ["branch", "from", "to", "points", "proved", "ms", "events"], rows)
