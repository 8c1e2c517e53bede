"""Error against unknowns, one panel a question, one line a method, its observed order beside it."""

import math
from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rodlab.lab.picture import figure
from rodlab.lab.studies.convergence import question_key
from rodlab.lab.studies.series import COUNTED

COLUMNS = 3
LEAST = 1e-16  # an error drawn, where it is zero
STRUTS = {"strut, end": "o", "strut, trapezoid": "s"}
DEGREES = "^vDP*Xph"  # marks of the degrees 1, 2, ...
BEHIND = {"boxstyle": "square,pad=0.05", "fc": "w", "ec": "none", "alpha": 0.8}


def picture(found: Mapping[str, Any]) -> Figure:
    """One panel a question of the study's answer; whole numbers are left out."""
    orders = {(question_key(row), row["method"]): row for row in found["orders"]}
    questions = [(key, list(rows)) for key, rows in groupby(found["rows"], key=question_key)]
    questions = [(key, rows) for key, rows in questions if key[0] != COUNTED and any(row.get("error") for row in rows)]
    if not questions:
        raise ValueError(
            "the study must ask for a quantity that converges to be drawn; it asks for whole numbers, or nothing was answered"
        )
    columns = min(COLUMNS, len(questions))
    lines = math.ceil(len(questions) / columns)
    fig, panels = figure(3.0 * columns + 0.4, 2.75 * lines + 0.7, nrows=lines, ncols=columns, squeeze=False)
    for axes in panels.ravel()[len(questions) :]:
        axes.remove()
    shown: dict[str, dict[str, Any]] = {}
    for axes, (key, rows) in zip(panels.ravel(), questions, strict=False):
        for method, own in groupby(rows, key=lambda row: str(row["method"])):
            answered = [row for row in own if "error" in row]
            if answered:
                shown.setdefault(_family(method), _style(method))
                _line(axes, answered, orders[key, method])
        _dress(axes, _title(key))
    for axes in panels[:, 0]:
        axes.set_ylabel("error")
    handles = [Line2D([], [], label=name, **style) for name, style in shown.items()]
    fig.legend(
        handles=handles, fontsize=8, frameon=False, ncols=min(len(handles), 4 if columns > 2 else 2), loc="outside lower center"
    )
    return fig


def _line(axes: Axes, rows: Sequence[Mapping[str, Any]], order: Mapping[str, Any]) -> None:
    """One method's errors, and its observed order where it is clear, at the last of the sizes that tell it."""
    method = str(rows[0]["method"])
    x, y = [row["unknowns"] for row in rows], [max(row["error"], LEAST) for row in rows]
    axes.loglog(x, y, **_style(method))
    if order["clear"] and "Richardson" not in method:
        last = max(i for i, row in enumerate(rows) if row["size"] <= order["to"])
        axes.annotate(f"{order['order']:.2f}", (x[last], y[last]), (4, 3), textcoords="offset points", fontsize=6.5, bbox=BEHIND)


def _style(method: str) -> dict[str, Any]:
    if "Richardson" in method:
        return {"color": "0.7", "lw": 0.7, "ls": "-" if "trapezoid" in method else (0, (4, 2)), "zorder": 1}
    if method in STRUTS:
        return {"color": "0.45", "lw": 1.0, "marker": STRUTS[method], "ms": 3.5, "mfc": "0.45"}
    mark = DEGREES[(int(method.rsplit(" ", 1)[1]) - 1) % len(DEGREES)] if "degree" in method else "x"
    return {"color": "0.0", "lw": 1.0, "marker": mark, "ms": 4.0, "mfc": "w"}


def _family(method: str) -> str:
    return method.rsplit(" ", 1)[0] + " 1, 2, 3" if "Richardson" in method else method


def _dress(axes: Axes, title: str) -> None:
    axes.set_title(title, fontsize=8.5)
    axes.set_xlabel("unknowns", fontsize=8)
    axes.set_ylim(bottom=LEAST / 3)
    axes.tick_params(labelsize=7.5)
    axes.grid(True, which="major", lw=0.3, color="0.85")
    axes.margins(x=0.12)


def _title(key: tuple[Any, ...]) -> str:
    quantity, mode, lam, K, u_hat = key
    at = "" if quantity in ("load", "fold") else rf", $\lambda$ = {lam:g}"
    made = (f", K = {K}" if len(str(K)) < 12 else ", K jumps" if "Piecewise" in str(K) else ", K(s)") if K != 1.0 else ""
    bent = rf", $\hat u$ = {u_hat}" if u_hat != 0 else ""
    of = f", mode {mode}" if u_hat == 0 else ""
    return f"{quantity.replace('_', ' ')}{of}{at}{made}{bent}"
