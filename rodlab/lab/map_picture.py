"""Equilibria drawn on the phase portrait of the standard map, one panel a strut."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rodlab.lab.equilibria import Equilibria
from rodlab.lab.picture import figure
from rodlab.lab.standard_map import orbit, parameter, portrait

MOST = 40  # equilibria that are drawn in one panel
TICKS = ([-np.pi, 0, np.pi], [r"$-\pi$", "0", r"$\pi$"])


def map_picture(*found: Equilibria) -> Figure:
    """Connected equilibria as joined dots, parasites as crosses, over orbits of the map; one of each mirror pair is drawn."""
    panels = len(found)
    fig, axes = figure(1.0 + 3.5 * panels, 5.0 if panels == 1 else 4.6, ncols=panels, sharey=True)
    fig.set_layout_engine("compressed")
    for ax, one in zip(np.atleast_1d(axes), found, strict=True):
        _panel(ax, one)
    np.atleast_1d(axes)[0].set_ylabel(r"turn at the joint $p_i = \varphi_i - \varphi_{i-1}$")
    handles = [
        Line2D([], [], color="k", marker="o", ms=3, lw=0.8, label="connected to the straight strut"),
        Line2D([], [], color="k", marker="x", ms=5, ls="none", label="parasite of the discretisation"),
        Line2D([], [], color="0.7", marker=".", ms=2, ls="none", label="other orbits"),
    ]
    fig.legend(handles=handles, fontsize=8, frameon=False, ncols=1 if panels == 1 else 3, loc="outside lower center")
    return fig


def _panel(ax: Any, found: Equilibria) -> None:
    r = parameter(found.strut, found.lam)
    phi, p = portrait(r)
    ax.plot(phi.ravel(), p.ravel(), ",", color="0.6", rasterized=True)
    for i, point in _drawn(found):
        x, y = orbit(point)
        if found.standing(i) == "connected":
            far = np.flatnonzero((np.abs(np.diff(x)) > np.pi) | (np.abs(np.diff(y)) > np.pi)) + 1  # around the cylinder
            ax.plot(
                np.insert(x, far, np.nan), np.insert(y, far, np.nan), "-o", color="k", ms=2.6, lw=0.8, zorder=4, clip_on=False
            )
        else:
            ax.plot(x, y, "x", color="k", ms=4.5, mew=0.8, zorder=3)
    loose = len(found) - sum(found.connected)
    name = rf"$n = {found.strut.n}$, $\lambda h/k = {r:.3g}$"
    ax.set_title(f"{name}\n{len(found)} equilibria" + (f", {loose} of them parasites" if loose else ""), fontsize=10)
    ax.set_xticks(*TICKS)
    ax.set_yticks(*TICKS)
    ax.set_xlim(-np.pi, np.pi)
    ax.set_ylim(-np.pi, np.pi)
    ax.set_xlabel(r"angle $\varphi_i$")
    ax.set_aspect("equal")


def _drawn(found: Equilibria) -> list[tuple[int, Any]]:
    """The connected ones and some of the rest, those that bend to the right of each mirror pair."""
    half = [(i, p) for i, p in enumerate(found.points) if found.images[i] is None or p.tip_angle >= 0]
    half.sort(key=lambda entry: not found.connected[entry[0]])
    return half[:MOST]
