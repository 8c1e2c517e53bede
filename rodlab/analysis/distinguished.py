"""Maddocks' distinguished diagram: the load against its conjugate, dV/dlam [Maddocks 1987, Stability and folds, ARMA 99].

    F(u, lam) = V_u = 0,    V_lam = height,    F_lam = height_u       so that dV/dlam = height along a branch
    V'' du + F_lam dlam = 0    =>    dlam dheight = -du.V'' du        along any tangent (du, dlam), at folds too

Between folds this is dheight/dlam = -u'.V'' u', u' = du/dlam: where the index is 0 the height does not increase with the load.
At a fold du is the null vector; beside it its eigenvalue has the sign of du.V'' du = -dlam dheight. So on the side on which the
height falls with growing load one eigenvalue less is negative: changes of the index at folds are read off the picture.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rodlab.analysis.curve import Curve
from rodlab.analysis.events import Event
from rodlab.analysis.follow import Branch
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.nullspace import quadratic

WIDEST, HALVINGS = 0.2, 9  # of differences: the first change of any one unknown, as a part of u, at least 1; its halvings
WRONG = 1e-6  # relative difference between d_lam and differences of a measure that no rounding explains
BESIDE = (1e-3, 1e-2, 1e-4)  # distances from a fold at which the picture is read: the first that shows it


class Fold(NamedTuple):
    """Change of the index at a fold: by the picture, and as verified beside it, that of a branch point there included."""

    lam: float
    predicted: int | None
    found: int | None  # None: not clear


@dataclass(frozen=True, eq=False)
class Distinguished:
    """Arrays over the points of a branch that have tangents, shape (m,); |(du, dlam)|^2 = inner(du, du) + dlam^2 = 1.

    lam, value: the picture. rate: of the value along the tangent, by differences of the measure. curvature: du.V'' du.
    mismatch: |dlam rate + curvature| as a part of |dlam rate| + |curvature|; error: what differences, rounding and the residual
    of the tangent make of it.
    """

    lam: Array
    value: Array
    rate: Array
    curvature: Array
    mismatch: Array
    error: Array
    folds: tuple[Fold, ...]


def distinguished(branch: Branch, measure: str = "height") -> Distinguished:
    """The branch in the plane of its load and of the measure that is conjugate to it: any whose gradient is the model's `d_lam`.

    Raises `ValueError` where the model has no such measure, or `d_lam` is not its gradient.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.analysis.follow import follow
    >>> from rodlab.mechanics.strut import Strut
    >>> d = distinguished(follow(equilibrium(Strut(n=10, u_hat=0.1), 6.0, lambda s: -2 * s), to=0.0))
    >>> d.folds[0].predicted, d.folds[0].found, bool((d.mismatch <= d.error).all())
    (1, 1, True)
    """
    if not isinstance(branch, Branch):
        raise ValueError(f"branch must be a Branch, as follow returns it; it is {branch!r:.60}")
    points = [p for p in branch.points if p.tangent is not None]
    if not points:
        raise ValueError(f"branch must have points with tangents; of its {len(branch)} none has one")
    _check(points[len(points) // 2], measure)
    lam, value, rate, curvature, mismatch, error = np.array([_row(p, measure) for p in points]).T
    folds = tuple(_fold(e, measure) for e in branch.events if e.kind == "fold")
    return Distinguished(lam, value, rate, curvature, mismatch, error, folds)


def _row(p: Point, measure: str) -> tuple[float, ...]:
    """lam, value, rate, curvature, mismatch, error."""
    curve, y = Curve(p.equations), np.append(p.u, p.lam)
    t = curve.tangent(y, np.asarray(p.tangent))
    du, dlam = t[:-1], float(t[-1])
    rate, off = _rate(p, measure, du)
    V = curve.second_variation(y)
    curvature, rounding = quadratic(V, du)
    rest = abs(float(du @ (V @ du + dlam * curve.d_lam(y))))
    size, error = abs(dlam * rate) + abs(curvature) or 1.0, abs(dlam) * off + 2 * (rounding + rest)
    return p.lam, p.measure(measure), rate, curvature, abs(dlam * rate + curvature) / size, error / size


def _rate(p: Point, measure: str, v: Array) -> tuple[float, float]:
    """The derivative of a measure along v, and its error."""
    f: Callable[[Array, float], float] = p.equations.measures[measure]  # type: ignore[attr-defined]
    noise = 4 * EPS * (abs(f(p.u, p.lam)) + float(np.abs(p.equations.d_lam(p.u, p.lam)) @ np.abs(p.u)))
    if not v.any():
        return 0.0, 0.0
    first = WIDEST * max(1.0, float(np.abs(p.u).max())) / float(np.abs(v).max())
    return _derivative(lambda x: f(p.u + x * v, p.lam), first, noise)


def _derivative(f: Callable[[float], float], e: float, noise: float) -> tuple[float, float]:
    """f'(0) and its error: central differences, extrapolated to none [Ridders 1982]; `noise` is that of f."""
    best, error, row = 0.0, math.inf, list[float]()
    for _ in range(HALVINGS):
        before, row = row, [(f(e) - f(-e)) / (2 * e)]
        for j, coarse in enumerate(before):
            row.append(row[j] + (row[j] - coarse) / (4 ** (j + 1) - 1))
            off = max(abs(row[-1] - row[-2]), abs(row[-1] - coarse)) + 2 * noise / e
            best, error = (row[-1], off) if off < error else (best, error)
        e /= 2
    return best, error


def _check(p: Point, measure: str) -> None:
    """Raise `ValueError` unless, beside p, d_lam is the gradient of the measure, and that a function of u alone."""
    name, known, rng = type(p.equations).__name__, getattr(p.equations, "measures", {}), np.random.default_rng(1)
    if measure not in known:
        raise ValueError(f"measure must be one of those of {name}, {sorted(known)}; it is {measure!r}")
    near = Point(p.equations, p.lam, p.u + 0.05 * (1 + np.abs(p.u)) * rng.uniform(-1, 1, p.u.size))
    g = np.asarray(p.equations.d_lam(near.u, near.lam))
    for v in rng.uniform(-1, 1, (3, p.u.size)):
        rate, off = _rate(near, measure, v)
        if abs(rate - float(g @ v)) > off + WRONG * float(np.abs(g) @ np.abs(v)):
            why = f"along a random direction its rate is {rate:.6g}, that by d_lam {float(g @ v):.6g}"
            raise ValueError(f"measure must have d_lam for its gradient; {measure} of {name} has not: {why}")
    value, other = (float(known[measure](near.u, lam)) for lam in (near.lam, near.lam + 1))
    if abs(value - other) > WRONG * (abs(value) + abs(other)):
        raise ValueError(f"measure must not depend on the load itself; {measure} of {name} does")


def _fold(e: Event, measure: str) -> Fold:
    """The picture at a fold, and the index, by solutions on both sides."""
    p, y, curve = e.point, np.append(e.point.u, e.lam), Curve(e.point.equations)
    for distance in BESIDE if p.tangent is not None else ():
        with suppress(NoConvergence):
            t = curve.tangent(y, np.asarray(p.tangent))
            found = [curve.correct(y + side * distance * t, curve.row(t)) for side in (-1, 1)]
            sides = [Point(p.equations, float(f.y[-1]), f.y[:-1], f.history, f.remaining) for f in found]
            loads = [q.lam - e.lam for q in sides]
            rises = [q.measure(measure) - p.measure(measure) for q in sides]
            if loads[0] * loads[1] > 0 > rises[0] * rises[1] and min(map(abs, loads)) > 4 * e.error:
                before, after = (q.index if q.index_verified else None for q in sides)
                known = None if before is None or after is None else after - before
                return Fold(e.lam, int(loads[0] * rises[0] < 0) - int(loads[1] * rises[1] < 0), known)
    return Fold(e.lam, None, None)
