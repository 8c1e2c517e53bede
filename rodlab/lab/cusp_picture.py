"""A pitchfork and what an imperfection makes of it: the branches, the cusp of folds, and the two power laws."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rodlab.analysis.follow import Branch
from rodlab.lab.breaking import Breaking
from rodlab.lab.picture import DASHES, curve, figure
from rodlab.numerics.arrays import Array

NAMES = {"u_hat": r"unstressed curvature $\hat u$"}


def cusp_picture(b: Breaking, perfect: Sequence[Branch], bent: Sequence[tuple[float, Sequence[Branch]]]) -> Figure:
    """Left the branches, perfect black and imperfect grey; middle the cusp; right its power law and that of the tip angle."""
    fig, (left, middle, right) = figure(11.4, 4.0, ncols=3)
    label = NAMES.get(b.imperfection.name, b.imperfection.name)
    most = 1.35 * b.event.lam
    for branch in perfect:
        for side in (1, -1):
            curve(left, branch, "tip_angle", most, side=side, label_at=None, color="k", lw=1.4)
    for i, (_, branches) in enumerate(bent):
        for branch in branches:
            curve(left, branch, "tip_angle", most, label_at=None, color=str(0.45 + 0.3 * i / len(bent)), lw=1.0)
    left.set_xlim(0.6 * b.event.lam, most)
    left.set_ylim(-2.2, 2.2)
    left.set_xlabel(r"load $\lambda$")
    left.set_ylabel(r"tip angle $\varphi_n$ (radians)")
    grey = "0.55"
    handles = [
        Line2D([], [], color="k", lw=1.4, label="perfect"),
        Line2D([], [], color=grey, lw=1.0, label=", ".join(f"{beta:g}" for beta, _ in bent)),
        Line2D([], [], color=grey, lw=1.0, ls=DASHES, label="unstable"),
    ]
    left.legend(handles=handles, fontsize=8, frameon=False, loc="upper left")
    _cusp(middle, b, label)
    _laws(right, b, label)
    return fig


def _cusp(axes: Any, b: Breaking, label: str) -> None:
    lam, beta = _fine(b.curve, b.imperfection.name)
    axes.plot(beta, lam, color="k", lw=1.4)
    law = [b.imperfection.fold(float(x)) for x in beta]
    axes.plot(beta, law, color="k", lw=1.0, ls=":")
    axes.plot(0, b.event.lam, "o", color="k", mfc="w", ms=5)
    top = float(lam.max())
    axes.text(0, b.event.lam + 0.72 * (top - b.event.lam), "3 equilibria", ha="center", fontsize=9)
    axes.text(0.6 * float(beta.max()), b.event.lam + 0.1 * (top - b.event.lam), "1", ha="center", fontsize=9)
    axes.set_xlabel(label)
    axes.set_ylabel(r"load of the fold $\lambda$")
    axes.set_title("cusp of folds; dotted: lowest order", fontsize=9)


def _laws(axes: Any, b: Breaking, label: str) -> None:
    axes.loglog(b.beta, b.off, "-s", color="k", ms=4, lw=1.0, label=rf"$\lambda_f - \lambda_1$: slope {b.exponent[-1]:.4f}")
    axes.loglog(b.small, b.tips, "-o", color="0.5", ms=4, lw=1.0, label=rf"$\varphi_n$ at $\lambda_1$: slope {b.root[-2]:.4f}")
    axes.axvspan(b.small.min() / 5, 2.3e-16, color="0.9", lw=0)
    axes.text(2.5e-16, float(b.off.min()), "rounding", fontsize=8, color="0.35", ha="left", va="bottom", rotation=90)
    axes.set_xlim(b.small.min() / 5, 1)
    axes.set_xlabel(label)
    axes.legend(fontsize=8, frameon=False, loc="lower right", bbox_to_anchor=(1.0, 0.06))
    axes.grid(True, which="major", lw=0.3, color="0.85")


def _fine(branch: Branch, name: str) -> tuple[Array, Array]:
    points = [branch.along(float(x)) for x in np.linspace(0, len(branch) - 1, 12 * len(branch))]
    return np.array([p.lam for p in points]), np.array([p.measure(name) for p in points])
