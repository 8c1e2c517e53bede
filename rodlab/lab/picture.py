"""Pictures that print: black and grey lines, markers that tell series apart, lengths to scale."""

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rodlab.analysis.follow import Branch
from rodlab.analysis.point import Point
from rodlab.lab.branches import Found, Shown
from rodlab.lab.curves import pieces

if TYPE_CHECKING:  # a picture of a scene has no need of studies
    from rodlab.lab.studies.series import Series

FORMATS = (".png", ".pdf", ".svg")
GREYS = ("0.0", "0.35", "0.6")
LABELS = {
    "tip_angle": "tip angle (radians)", "height": "height", "energy": "energy", "load": r"load $\lambda$",
    "shortening": "end shortening", "N1": "reaction across $N_1$", "tau": r"couple on the top $\tau$",
    "phi0": "angle of the foot (radians)",
}  # fmt: skip
DASHES = (0, (4, 2.2))
MARKS = {"end": "o", "trapezoid": "s"}


def figure(width: float, height: float, **grid: Any) -> tuple[Figure, Any]:
    """A figure in inches with its axes, without any window."""
    fig = Figure(figsize=(width, height), layout="constrained")
    return fig, fig.subplots(**grid)


def png(fig: Figure) -> bytes:
    """The picture as PNG, the same bytes for the same figure."""
    out = io.BytesIO()
    fig.savefig(out, format="png", dpi=160, metadata={"Software": None})
    return out.getvalue()


def drawn(fig: Figure, path: str) -> bytes:
    """The picture in the format that a file's name asks for."""
    if path.endswith(".png"):
        return png(fig)
    out = io.BytesIO()
    fig.savefig(out, format=path[-3:], metadata={"Date": None} if path.endswith("svg") else {"CreationDate": None})
    return out.getvalue()


def loads_picture(loads: "Sequence[Series]") -> Figure:
    """Error of the buckling loads against n: one line a mode, one panel a rule, with the slope of its order."""
    fig, panels = figure(8.2, 3.9, ncols=2, sharey=True)
    for axes, (rule, mark) in zip(panels, MARKS.items(), strict=True):
        own = [series for series in loads if series.method == f"strut, {rule}"]
        for series, grey in zip(own, GREYS, strict=False):
            mode, sizes = series.question.mode, series.sizes
            errors = [found["error"] / found["truth"] for found in series.results]
            style = {"marker": mark, "ms": 1 + 2.6 * mode, "mfc": grey if mode == 1 else "w", "zorder": 5 - mode / 10}
            axes.loglog(sizes, errors, color=grey, lw=1.2, label=f"mode {mode}", **style)
            if series.limit is not None:
                truth = series.results[0]["truth"]
                best = max(abs(series.limit.value / truth - 1), 1e-16)
                axes.loglog(sizes[-1], best, marker="*", color=grey, ms=9, ls="none", mec="k", mew=0.4)
        _slope(axes, own[0].sizes, [found["error"] / found["truth"] for found in own[0].results], own[0].order or 1)
        axes.set_title(f'rule "{rule}": order {own[0].order}', fontsize=10)
        axes.set_xlabel("number of joints $n$")
        axes.grid(True, which="major", lw=0.3, color="0.85")
        axes.text(own[0].sizes[-1] / 1.5, 1e-13, "extrapolated\nfrom all $n$", fontsize=8, color="0.25", ha="right", va="center")
    panels[0].set_ylabel(r"relative error $|\lambda_j(n) - \lambda_j|\,/\,\lambda_j$")
    panels[0].legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(0.0, 0.42))
    return fig


def shapes_picture(columns: Sequence[tuple[int, Sequence[Found], float]]) -> Figure:
    """Buckled shapes to scale, one panel a mode; each shape labelled by its load over the mode's buckling load."""
    fig, panels = figure(8.2, 5.0, ncols=len(columns), sharey=True)
    for axes, (mode, found, load) in zip(np.atleast_1d(panels), columns, strict=True):
        axes.plot([0, 0], [0, 1], color="0.6", lw=1.0, ls=(0, (4, 3)))
        for i, entry in enumerate(found):
            shape(axes, entry.point, color=str(0.62 * (1 - (i + 1) / len(found))))
            _label(axes, entry.point, f"{entry.point.lam / load:.3g}")
        _clamp(axes)
        axes.annotate("", (0, 1.05), (0, 1.25), arrowprops={"arrowstyle": "-|>", "lw": 1.2, "color": "k"})
        axes.text(-0.04, 1.15, r"$\lambda$", fontsize=11, ha="right")
        index = sorted({str(entry.point.index) for entry in found})
        axes.set_title(f"mode {mode}, index {', '.join(index)}", fontsize=10)
        axes.set_aspect("equal")
        axes.set_xlim(-0.2, 0.92)
        axes.set_ylim(-0.55, 1.3)
        axes.set_xlabel("$x$")
        axes.tick_params(labelsize=8)
    np.atleast_1d(panels)[0].set_ylabel("$z$")
    return fig


def routes_picture(routed: "Sequence[Series]") -> Figure:
    """Error of a tip angle against the number of unknowns, one line a method."""
    fig, axes = figure(6.4, 4.6)
    for series, mark in zip(routed, "os^vDP*X", strict=False):
        shown = [found for found in series.results if found["error"] > 0]
        strut = series.method.startswith("strut")
        style = {"color": "0.5" if strut else "0.0", "mfc": "0.5" if strut else "w", "marker": mark, "ms": 4.5}
        label = f"{series.method}: order {series.order}"
        axes.loglog([found["unknowns"] for found in shown], [found["error"] for found in shown], lw=1.1, label=label, **style)
    axes.legend(fontsize=8, frameon=False, loc="lower right")
    axes.set_xlabel("number of unknowns: joints, or nodes of the collocated rod")
    axes.set_ylabel(r"error of the tip angle $|\phi(1) - \alpha|$ (radians)")
    axes.set_xlim(1.5, 8e3)
    axes.set_ylim(2e-16, 3)
    axes.grid(True, which="major", lw=0.3, color="0.85")
    return fig


def diagram_picture(shown: Sequence[Shown], known: Sequence[float]) -> Figure:
    """The bifurcation diagram, perfect and imperfect, beside shapes along the imperfect strut's branch."""
    fig, (left, right) = figure(8.6, 4.6, ncols=2, width_ratios=(1.75, 1))
    by_name = {s.name: s.branch for s in shown}
    most = float(by_name["imperfect"].points[-1].lam)
    for name, branch in by_name.items():
        imperfect = name in ("imperfect", "detached")
        if name == "straight" or imperfect or branch.points[0].lam < most:
            style = {"color": "0.5", "lw": 1.1} if imperfect else {"color": "k", "lw": 1.5}
            for side in (1, -1) if name.startswith("mode") else (1,):
                at = (0.35 if imperfect else 0.7) if side == 1 else None
                curve(left, branch, "tip_angle", most, side=side, label_at=at, **style)
    left.set_xlim(0, most)
    left.set_ylim(-3.1, 3.1)
    left.set_xlabel(r"load $\lambda$")
    left.set_ylabel(r"tip angle $\phi_n$ (radians)")
    left.legend(handles=_legend(), fontsize=8, frameon=False, loc="lower left")
    _along(left, right, by_name["imperfect"], [1.0, 1.2, 1.7, 3.0], known[0])
    return fig


def branches_picture(shown: Sequence[Shown], measure: str, label: str) -> Figure:
    """All branches of a scene in one diagram, a measure against what is followed."""
    fig, axes = figure(6.2, 4.4)
    most = max(float(s.branch.lam.max()) for s in shown)
    for s in shown:
        curve(axes, s.branch, measure, most, color="k", lw=1.4)
    axes.margins(x=0.02, y=0.08)
    axes.set_xlabel(label)
    axes.set_ylabel(LABELS.get(measure, measure))
    handles = [
        Line2D([], [], color="k", lw=1.5, label="stable"),
        Line2D([], [], color="k", lw=1.5, ls=DASHES, label="unstable"),
        *_legend()[3:],
    ]
    handles[3].set(color="k", markerfacecolor="k")
    axes.legend(handles=handles, fontsize=8, frameon=False, ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return fig


def curve(
    axes: Axes, branch: Branch, measure: str, most: float, *, side: int = 1, label_at: float | None = 0.5, **style: Any
) -> None:
    """A branch in a bifurcation diagram: solid where stable, dashed where not, its index on it, its events marked."""
    for part in pieces(branch, measure):
        axes.plot(part.lam, side * part.value, ls="-" if part.stable else DASHES, **style)
        seen = part.lam <= most
        if label_at is not None and part.index is not None and seen.any():
            _index_label(axes, part.lam[seen], side * part.value[seen], part.index, style["color"], label_at)
    for event in branch.events:
        if event.kind in ("fold", "branch point"):
            filled = "w" if event.kind == "branch point" else style["color"]
            mark = "o" if event.kind == "branch point" else "s"
            value = side * event.point.measure(measure)
            axes.plot(event.lam, value, mark, color=style["color"], mfc=filled, ms=5 if mark == "o" else 4, zorder=6)


def _index_label(axes: Axes, lam: np.ndarray, value: np.ndarray, index: int, color: str, at: float) -> None:
    """The index in a small circle on the curve, at a part of its length as drawn."""
    wide, high = np.ptp(lam) or 1.0, np.ptp(value) or 1.0
    length = np.append(0.0, np.cumsum(np.hypot(np.diff(lam) / wide, np.diff(value) / high)))
    x, y = (float(np.interp(at * length[-1], length, values)) for values in (lam, value))
    box = {"boxstyle": "circle,pad=0.18", "fc": "w", "ec": color, "lw": 0.6}
    axes.annotate(str(index), (x, y), fontsize=7.5, ha="center", va="center", color=color, zorder=7, bbox=box)


def _legend() -> list[Line2D]:
    return [
        Line2D([], [], color="k", lw=1.5, label="perfect, stable"),
        Line2D([], [], color="k", lw=1.5, ls=DASHES, label="perfect, unstable"),
        Line2D([], [], color="0.5", lw=1.1, label="imperfect"),
        Line2D([], [], color="k", marker="o", mfc="w", ls="none", ms=5, label="branch point"),
        Line2D([], [], color="0.5", marker="s", ls="none", ms=4, label="fold"),
        Line2D([], [], color="k", marker=r"$\bigcirc$", mew=0.2, ls="none", ms=8, label="index, in the circle"),
    ]


def _along(left: Axes, right: Axes, branch: Branch, ratios: Sequence[float], own: float) -> None:
    """Shapes at some loads of a branch, numbered in the diagram and drawn to scale beside it."""
    right.plot([0, 0], [0, 1], color="0.6", lw=1.0, ls=(0, (4, 3)))
    for number, ratio in zip("abcdefgh", ratios, strict=False):
        point = branch.at(ratio * own)[0]
        left.plot(point.lam, point.tip_angle, "o", color="0.5", ms=3.5)
        left.annotate(number, (point.lam, point.tip_angle), (-9, 4), textcoords="offset points", fontsize=9, style="italic")
        shape(right, point, color="0.25")
        _label(right, point, number)
    _clamp(right)
    right.set_aspect("equal")
    right.set_xlim(-0.2, 0.95)
    right.set_ylim(-0.45, 1.2)
    right.set_xlabel("$x$")
    right.set_ylabel("$z$")
    right.set_title("imperfect strut, states $a$ to $" + "abcdefgh"[len(ratios) - 1] + "$", fontsize=10)


def shape(axes: Axes, point: Point, **style: Any) -> None:
    """The centreline of a point."""
    axes.plot(point.x, point.z, lw=1.6, solid_capstyle="round", **style)


def _label(axes: Axes, point: Point, text: str) -> None:
    x, z = float(point.x[-1]), float(point.z[-1])
    axes.plot(x, z, "o", color="k", ms=2.6)
    out = np.array([np.sin(point.tip_angle), np.cos(point.tip_angle)])
    axes.annotate(text, (x, z), tuple(10 * out), textcoords="offset points", fontsize=7.5, ha="center", va="center")


def _clamp(axes: Axes) -> None:
    axes.plot([-0.12, 0.12], [0, 0], color="k", lw=1.6)
    for x in np.linspace(-0.12, 0.09, 6):
        axes.plot([x, x - 0.03], [0, -0.045], color="k", lw=0.7)


def _slope(axes: Axes, sizes: Sequence[float], errors: Sequence[float], order: int) -> None:
    """A small triangle under the line that shows its slope."""
    i = len(sizes) // 2
    a, b = sizes[i], 2 * sizes[i]
    top = errors[i] / 5
    axes.plot([a, b, a, a], [top, top / 2**order, top / 2**order, top], color="0.3", lw=0.8)
    axes.text(a * 0.86, top / 2 ** (order / 2), str(order), fontsize=8, ha="right", va="center")
