"""The picture of the stability study: true error against condition number, ours filled and the naive formulas open.

Left out: an index, whose error is none or whole, and what lies next to underflow, where a relative error says nothing.
"""

import math
from collections.abc import Mapping
from typing import Any

from matplotlib.figure import Figure

from rodlab.lab.picture import figure
from rodlab.numerics.arrays import EPS

MARKS = {"loads": "o", "equilibrium": "s", "layer": "D", "elastica": "v", "rod_loads": "P"}
NAMES = dict(zip(MARKS, ("loads of struts", "equilibria", "layers", "elastica", "loads of rods"), strict=True))
LEAST, MOST = 1e-19, 1e3  # errors shown; what is smaller, zero among it, stands on the lower edge
WIDEST = 1e28  # condition numbers shown
EDGE = 1e5  # where refusals stand
STYLES = {"right": "0.25", "loose": "0.5", "WRONG": "0.0"}
PAPER = {"fc": "w", "ec": "none", "pad": 0.6, "alpha": 0.85}  # under a label
SMALL = 1e-290  # truths below are next to underflow


def picture(found: Mapping[str, Any]) -> Figure:
    """Two panels: every verified answer of ours, refusals above; ours and the naive one to the same question, joined."""
    fig, (left, right) = figure(9.4, 4.7, ncols=2, sharey=True, sharex=True)
    rows = [row for row in found["rows"] if row["verdict"] == "WRONG" or not _underflows(row)]
    _ours(left, [row for row in rows if row["kind"] in NAMES])
    _both(right, [row for row in rows if row.get("scale") == "relative" and "naive_verdict" in row])
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.plot([1, MOST * 10 / EPS], [EPS, MOST * 10], color="0.4", lw=0.9, ls=(0, (5, 3)), zorder=1)
        axes.set_xlim(0.3, WIDEST)
        axes.set_ylim(LEAST / 3, EDGE * 8)
        axes.axhline(MOST * 10, color="0.75", lw=0.6)
        axes.grid(True, which="major", lw=0.3, color="0.88")
        axes.set_xlabel("condition number")
        axes.tick_params(labelsize=8)
    left.text(1.5e11, EPS * 1.5e11 * 25, r"$\epsilon\times$ condition", fontsize=8.5, color="0.3", rotation=43, ha="center")
    left.set_ylabel("true error, relative")
    left.set_yticks([LEAST, *(10.0**k for k in range(-15, 3, 3)), EDGE / 8, EDGE * 1.5])
    left.set_yticklabels(["none", *(f"$10^{{{k}}}$" for k in range(-15, 3, 3)), "not verified", "refused"])
    left.tick_params(axis="y", which="minor", left=False)
    right.tick_params(axis="y", which="minor", left=False)
    right.text(1e27, EDGE * 1.5, "no answer: fails, overflows", fontsize=8, ha="right", va="center")
    return fig


def _ours(axes: Any, rows: list[Mapping[str, Any]]) -> None:
    for kind, name in NAMES.items():
        own = [row for row in rows if row["kind"] == kind and row["verdict"] in STYLES and row.get("scale") == "relative"]
        for verdict, grey in STYLES.items():
            those, right = [row for row in own if row["verdict"] == verdict], verdict == "right"
            filled = {"color": grey, "mfc": grey if right else "w", "mew": 0.7, "alpha": 0.8 if right else 1.0}
            label = name if right and those else None
            axes.plot(*_places(those, "forward"), MARKS[kind], ms=9 if verdict == "WRONG" else 3.6, label=label, **filled)
    refused = [row for row in rows if row["verdict"] in ("refused", "unverified")]
    for verdict, mark, at in (("refused", "x", EDGE * 1.5), ("unverified", "+", EDGE / 8)):
        own = [row for row in refused if row["verdict"] == verdict]
        x = [min(row["condition"], WIDEST / 3) if math.isfinite(row.get("condition", math.nan)) else WIDEST / 3 for row in own]
        axes.plot(x, [at] * len(x), mark, color="k", ms=5, mew=0.9)
    axes.set_title("ours, every kind of case", fontsize=10)
    axes.legend(fontsize=7.5, frameon=False, loc="upper left", bbox_to_anchor=(0.08, 0.9), handletextpad=0.2)


def _both(axes: Any, rows: list[Mapping[str, Any]]) -> None:
    for row in rows:
        (x,), (ours,) = _places([row], "forward")
        axes.plot([x, x], [ours, _places([row], "naive_forward")[1][0]], color="0.75", lw=0.5, zorder=1)
    axes.plot(*_places(rows, "forward"), "o", ms=3.6, color="0.25", mew=0.7, label="ours", zorder=3)
    axes.plot(*_places(rows, "naive_forward"), "o", ms=4.2, mfc="w", mec="k", mew=0.7, ls="none", label="naive", zorder=2)
    for group in dict.fromkeys(row["group"] for row in rows if row["kind"] == "contrast"):
        worst = max((row for row in rows if row["group"] == group), key=lambda row: _finite(row["naive_forward"]))
        (x,), (naive,) = _places([worst], "naive_forward")
        axes.annotate(group, (x, naive), (13, 0), textcoords="offset points", fontsize=7, va="center", color="0.2", bbox=PAPER)
    axes.set_title("ours and naive, the same question joined", fontsize=10)
    axes.legend(fontsize=8, frameon=False, loc="center right", bbox_to_anchor=(1.0, 0.33), handletextpad=0.2)


def _places(rows: list[Mapping[str, Any]], which: str) -> tuple[list[float], list[float]]:
    """Condition numbers and errors, held inside of the picture; an error that is infinite stands at the top."""
    x = [min(max(row["condition"], 0.5), WIDEST / 3) if row["condition"] == row["condition"] else WIDEST / 3 for row in rows]
    errors = [row[which] for row in rows]
    return x, [EDGE * 1.5 if not math.isfinite(e) else min(max(e, LEAST), MOST) for e in errors]


def _finite(error: float) -> float:
    return error if math.isfinite(error) else -1.0


def _underflows(row: Mapping[str, Any]) -> bool:
    """True where the truth is next to underflow, or below the least float."""
    truth = abs(row.get("truth") or 0.0)
    return truth < SMALL and row.get("scale") == "relative"
