"""Error against run time, one line a method, up to where its error stops falling: the picture of work and precision."""

import re
from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

from matplotlib.figure import Figure

from rodlab.lab.picture import figure

LEAST = 1e-16
FAMILIES: dict[str, dict[str, Any]] = {  # one entry of the legend each; what tells its members apart stands at their lines
    "strut, end": {"color": "0.45", "lw": 1.2, "marker": "o", "ms": 4},
    "strut, trapezoid": {"color": "0.45", "lw": 1.2, "marker": "s", "ms": 4},
    "strut, end, Richardson": {"color": "0.65", "lw": 0.9, "ls": "--", "marker": "o", "ms": 2.5},
    "strut, trapezoid, Richardson": {"color": "0.65", "lw": 0.9, "marker": "s", "ms": 2.5},
    "strut, shooting": {"color": "0.45", "lw": 0.9, "ls": (0, (5, 2)), "marker": "d", "ms": 4.5, "mfc": "w"},
    "strut, steepest descent": {"color": "0.45", "lw": 0.9, "ls": (0, (5, 2)), "marker": "H", "ms": 4.5, "mfc": "w"},
    "rod, degree": {"color": "0.0", "lw": 1.1, "marker": "o", "ms": 3.5, "mfc": "w"},
    "rod, adapted": {"color": "0.0", "lw": 1.1, "marker": "D", "ms": 4},
    "collocation of (phi, m), degree": {"color": "0.0", "lw": 0.8, "ls": (0, (3, 1, 1, 1)), "marker": "^", "ms": 4, "mfc": "w"},
    "elliptic functions": {"color": "0.0", "ls": "none", "marker": "*", "ms": 9, "mfc": "w"},
    "scipy solve_bvp": {"color": "0.0", "lw": 1.2, "ls": ":", "marker": "x", "ms": 6},
    "scipy solve_ivp, shooting": {"color": "0.0", "lw": 1.2, "ls": ":", "marker": "1", "ms": 8},
    "AUTO": {"color": "0.0", "lw": 1.2, "ls": ":", "marker": "+", "ms": 8},
}
OTHER = {"color": "0.0", "lw": 0.8, "marker": "p", "ms": 4}
SHORT = {"end": "end", "trapezoid": "trap."}


def picture(found: Mapping[str, Any]) -> Figure:
    """The study's rows: relative error against seconds of a solve, the least of the repeats."""
    fig, axes = figure(7.2, 5.6)
    shown: dict[str, Any] = {}
    for method, own in groupby(found["rows"], key=lambda row: str(row["method"])):
        line = _falling([row for row in own if "value" in row])
        if not line:
            continue
        family, member = _family(method)
        x = [1e3 * row["cost"]["solve"] for row in line]
        y = [max(row["error"] / abs(row["truth"]), LEAST) for row in line]
        (drawn,) = axes.loglog(x, y, zorder=3 if family.startswith("rod") else 2, **FAMILIES.get(family, OTHER))
        shown.setdefault(family, drawn)
        if member:
            axes.annotate(member, (x[0], y[0]), (-3, 3), textcoords="offset points", fontsize=7, ha="right", va="bottom")
    axes.set_xlabel("run time of a solve (ms), the least of the repeats")
    axes.set_ylabel("relative error")
    axes.set_ylim(LEAST / 3, 3)
    axes.grid(True, which="major", lw=0.3, color="0.85")
    axes.tick_params(labelsize=8.5)
    fig.legend(list(shown.values()), list(shown), fontsize=7.5, frameon=False, ncols=3, loc="outside lower center")
    return fig


def _family(method: str) -> tuple[str, str]:
    """The family of a method, and what it is in it: a degree, a stage, a rule."""
    named = re.fullmatch(r'(.*?(?:degree|Richardson)) (\d+)|(.*?), "(\w+)"', method)
    if named and named[1]:
        return named[1], named[2]
    if named:
        return named[3], SHORT.get(named[4], named[4])
    return next((family for family in sorted(FAMILIES, key=len, reverse=True) if method.startswith(family)), method), ""


def _falling(rows: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Rows, coarse to fine, up to the first of the least error."""
    errors = [max(row["error"], LEAST) for row in rows]
    return list(rows[: errors.index(min(errors)) + 1]) if rows else []
