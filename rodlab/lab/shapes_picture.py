"""Shapes of a scene to scale with what holds and loads them: `[draw] shapes`, one panel a state."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rodlab.analysis.point import Point
from rodlab.lab import supports
from rodlab.lab.branches import Shown
from rodlab.lab.picture import DASHES, figure
from rodlab.mechanics.indices import indices

ACROSS, WIDTH, HEIGHT = 4, 2.1, 2.75  # panels in a row, inches of one
SYMBOLS = {
    "lam": r"\lambda", "shortening": "d", "q": "q", "c": "c", "tau": r"\tau", "N1": "N_1", "u_hat": r"\hat u", "phi1": r"\phi_1",
    "phi0": r"\phi_0", "offset": "x_1",
}  # fmt: skip


@dataclass(frozen=True)
class State:
    """A point that is to be drawn, and the name of the branch that it is on."""

    branch: str
    point: Point


def states(shown: Sequence[Shown], asked: Sequence[Mapping[str, Any]]) -> list[State]:
    """The states that a scene names: {of = a branch's name, at = a value of what is followed}; without `of` on all branches."""
    found: list[State] = []
    for entry in asked:
        on = [s for s in shown if entry.get("of") in (None, s.name)]
        if not on:
            known = ", ".join(s.name for s in shown)
            raise ValueError(f"of must be the name of a branch, one of {known}; it is {entry.get('of')!r}")
        new = [State(s.name, p) for s in on for p in s.branch.at(float(entry["at"]))]
        if not new:
            raise ValueError(
                f"at must be a value that the branch passes; {', '.join(s.name for s in on)} does not pass {entry['at']:g}"
            )
        found += new
    return found


def of_states(drawn: Sequence[State], *, both: bool) -> list[dict[str, Any]]:
    """The same as plain data; with `both` the indices under the dead load and under the shortening, None where not verified."""
    said = []
    for s in drawn:
        entry = {
            "branch": s.branch,
            "at": s.point.lam,
            "load": load_on(s.point),
            "height": s.point.height,
            "index": s.point.index,
        }
        known = indices(s.point)._asdict() if both else {}
        said.append({**entry, **{name: one.negative if one.verified else None for name, one in known.items()}})
    return said


def load_on(p: Point) -> float:
    """The load on the end: what is followed, a reaction, or what stays."""
    _, _, lam = p.equations.acting(p.u, p.lam)  # type: ignore[attr-defined]
    return float(lam)


def shapes_picture(drawn: Sequence[State], *, both: bool = False) -> Figure:
    """One panel a state, to one scale: solid where stable, dashed where not."""
    columns = min(ACROSS, len(drawn))
    rows = -(-len(drawn) // columns)
    fig, panels = figure(WIDTH * columns + 0.4, HEIGHT * rows, ncols=columns, nrows=rows, squeeze=False)
    for axes, state in zip(panels.flat, drawn, strict=False):
        _state(axes, state.point)
        axes.set_title(_title(state.point, both=both), fontsize=8)
        axes.tick_params(labelsize=7)
    used = list(panels.flat)[: len(drawn)]
    supports.shape_axes(*used)
    for axes in list(panels.flat)[len(drawn) :]:
        axes.set_visible(False)
    for axes in panels[:, 1:].flat:
        axes.tick_params(labelleft=False)
        axes.set_ylabel("")
    for axes in used[:-columns]:
        axes.set_xlabel("")
    return fig


def _state(axes: Axes, p: Point) -> None:
    equations: Any = p.equations
    owner = getattr(equations, "strut", getattr(equations, "rod", equations))
    foot, top = getattr(owner, "ends", ("clamped", "free"))
    model, _, lam = equations.acting(p.u, p.lam)
    held = "lam" in getattr(equations, "unknowns", ())  # the end may not come down
    given = {name: model.parameters[name] for term in owner.terms for name in term.parameters}
    supports.reference(axes)
    supports.support(axes, foot, p.x[0], p.z[0], p.phi[0])
    supports.support(axes, top, p.x[-1], p.z[-1], p.phi[-1], top=True, slides=not held)
    if "c" in given:
        supports.foundation(axes, p.x, p.z)
    if "q" in given and np.any(given["q"]):
        supports.weight(axes, p.x, p.z, float(np.mean(given["q"])))
    style = "-" if p.index == 0 else DASHES
    axes.plot(p.x, p.z, color="k", lw=1.8, ls=style, solid_capstyle="round")
    N1, tau = (float(given.get(name, 0.0)) for name in ("N1", "tau"))
    supports.load(axes, p.x[-1], p.z[-1], lam=0.0 if held else lam, N1=N1, tau=tau, phi=float(p.phi[-1]), on=top)


def _title(p: Point, *, both: bool) -> str:
    equations: Any = p.equations
    follows = str(getattr(equations, "follows", getattr(equations, "name", "lam")))
    told = f"${SYMBOLS.get(follows, follows)} = {p.lam:.4g}$"
    if follows == "shortening":
        told += rf", $\lambda = {load_on(p):.4g}$"
    if both:
        known = [str(one.negative) if one.verified else "?" for one in indices(p)]
        return f"{told}\nindex {known[0]} under the load,\n{known[1]} held at its height"
    return f"{told}\nindex {p.index}" + ("" if p.index_verified else "?")
