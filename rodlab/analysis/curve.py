"""The solutions of F(u, lam) = 0 as a curve in the space of y = (u, lam), arrays of shape (n + 1,).

    |y|^2 = inner(u, u) + (lam / scale)^2        length, in which steps are measured
    [ F_u  F_lam ] t = 0,   |t| = 1              unit tangent
    [ F_u  F_lam ] [du  ]   [-F]                 one iteration of the corrector, in the plane row . (y - y_predicted) = 0:
    [    row     ] [dlam] = [ 0]                 nonsingular at folds, where F_u is singular [Keller 1977]

With the tangent's own row this is pseudo-arclength continuation, with row = (0, 1) natural continuation in the load.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from rodlab.analysis.equations import Equations, jacobian, second_variation
from rodlab.analysis.newton import NewtonStep, NoConvergence
from rodlab.numerics.arrays import EPS, Array, is_finite
from rodlab.numerics.bordered import OneBorder
from rodlab.numerics.factor import factor, inertia_of
from rodlab.numerics.inertia import Inertia, Symmetric

WIDE = 1e-4  # relative correction below which the residual is asked for to more digits, where the model has them
PLATEAU = 1e-11  # relative size at which slow corrections are rounding
ROUGH = 1e-7  # relative size below which corrections that stop shrinking are rounding
BARE = 1e-10  # relative size of what may be left to correct where nothing is shown
CHORD = 1e-5  # relative size below which one more correction with the same factor finishes


class Corrected(NamedTuple):
    """A solution y, its history, and the distance left in any one unknown."""

    y: Array
    history: tuple[NewtonStep, ...]
    remaining: float
    solver: OneBorder | None = None  # the last bordered matrix, taken a correction before


class Curve:
    """The equations with the geometry of their solution curves.

    >>> class Circle:
    ...     def residual(self, u, lam): return u**2 + lam**2 - 1
    ...     def jacobian(self, u, lam): return np.diag(2 * u)
    ...     def d_lam(self, u, lam): return np.array([2 * lam])
    ...     def inner(self, u, v): return u @ v
    >>> Curve(Circle()).tangent(np.array([0.0, 1.0]), toward=np.array([1.0, 0.0])).round(15)     # at the fold
    array([ 1., -0.])
    """

    def __init__(self, equations: Equations, scale: float = 1.0, *, wide: bool = True) -> None:
        self.equations, self.scale = equations, scale
        self.accuracy = 0.0 if wide else BARE  # of corrections, as a part of the size of y
        self._symmetric: bool | None = None
        self._wide = getattr(equations, "residual_wide", None) if wide else None
        bound = getattr(equations, "embedding", None)
        self.embedding = bound if bound is not None else lambda _: (0.0, 1.0)

    # --- the equations on y ------------------------------------------------------------------------------------

    def residual(self, y: Array, *, wide: bool = False) -> Array:
        """F(u, lam); `wide` with more digits, where the model has them."""
        if wide and self._wide is not None:
            return np.asarray(self._wide(y[:-1], float(y[-1])))
        return np.asarray(self.equations.residual(y[:-1], float(y[-1])))

    def jacobian(self, y: Array) -> Any:
        """F_u."""
        return jacobian(self.equations, y[:-1], float(y[-1]))

    def d_lam(self, y: Array) -> Array:
        """F_lam."""
        return np.asarray(self.equations.d_lam(y[:-1], float(y[-1])), dtype=np.float64)

    def second_variation(self, y: Array) -> Any:
        """The symmetric matrix whose negative eigenvalues are the index."""
        return second_variation(self.equations, y[:-1], float(y[-1]))

    def inertia(self, y: Array) -> Inertia | None:
        """Signs of the eigenvalues of the second variation; None where there is none."""
        return inertia_of(self.second_variation(y))

    def index(self, y: Array) -> int | None:
        """The index, None where it cannot be verified; without symmetry 0 or 1, the sign of the determinant, no more."""
        known = self.inertia(y)
        if known is None:
            sign = factor(self.jacobian(y)).sign()
            return None if sign == 0 else int(sign < 0)
        return known.negative if known.verified else None

    def symmetric(self, y: Array) -> bool:
        """True when the Jacobian is symmetric, as the derivative of an energy's gradient is."""
        if self._symmetric is None:
            aside = y + 0.01 * np.cos(np.arange(y.size))  # where no symmetry of the state makes it so
            self._symmetric = all(_is_symmetric(self.jacobian(at)) for at in (y, aside))
        return self._symmetric

    def has_index(self, y: Array) -> bool:
        """True where eigenvalues can be counted: a second variation is known, or the Jacobian is symmetric."""
        return hasattr(self.equations, "second_variation") or self.symmetric(y)

    # --- geometry ----------------------------------------------------------------------------------------------

    def dot(self, a: Array, b: Array) -> float:
        """The scalar product of steps."""
        return float(self.equations.inner(a[:-1], b[:-1])) + float(a[-1] * b[-1]) / self.scale**2

    def norm(self, a: Array) -> float:
        """The length of a step."""
        with np.errstate(over="ignore", invalid="ignore"):
            square = self.dot(a, a)
        return math.sqrt(square) if square > 0 else square * 0.0

    def row(self, t: Array) -> Array:
        """The functional y -> t . y as a row: 1 on the unit vector t itself.

        `inner` is known only through its values; on directions other than t the plain product serves as well.
        """
        u = t[:-1]
        plain = float(u @ u)
        weight = float(self.equations.inner(u, u)) / plain if plain > 0 else 0.0
        return np.append(weight * u, t[-1] / self.scale**2)

    def tangent(self, y: Array, toward: Array, solver: OneBorder | None = None) -> Array:
        """The unit tangent at a solution y, on the side of the direction `toward` (by a matrix of next to y, if given)."""
        row = self.row(toward / self.norm(toward))
        solver = self._solver(y, row, []) if solver is None else solver
        side = np.zeros_like(y)
        side[-1] = 1.0
        with np.errstate(all="ignore"):
            t = solver.solve(side)
        size = self.norm(t)
        if not (np.isfinite(size) and size > 0):
            raise NoConvergence("the branch has no tangent here: its bordered matrix is singular", ())
        return np.asarray(t / (size * np.sign(row @ t or 1.0)))

    # --- corrector ---------------------------------------------------------------------------------------------

    def correct(self, y: Array, row: Array, limit: int = 8) -> Corrected:
        """The solution in the plane through y that `row` cuts, by Newton's method.

        Raises `NoConvergence` unless every correction is at most half the last, up to rounding.
        """
        with np.errstate(all="ignore"):
            return self._corrections(y, row, limit)

    def _corrections(self, y: Array, row: Array, limit: int) -> Corrected:
        history: list[NewtonStep] = []
        last, solver, scale, wide, reusable = math.inf, None, self.norm(y), False, True
        floor = max(2 * EPS * max(self.norm(np.append(y[:-1], 0.0)), 1e-3 * scale), self.accuracy * scale)
        right = np.zeros_like(y)
        while len(history) < limit + 4 * wide:
            if self._wide is not None and not wide and last <= WIDE * scale:
                wide, last = True, math.inf  # what follows sees a better residual, and is not compared with the last step
            right[:-1] = self._finite_residual(y, history, wide=wide)
            reused = solver is not None
            if solver is None:
                solver = self._solver(y, row, history)
            step = solver.solve(-right)
            size = self.norm(step)
            history.append(NewtonStep(size, self.norm(right), 1.0))
            if not math.isfinite(size) or size > scale + 1e3:
                raise NoConvergence(f"the corrector left: a correction of {size:.2g} from a point of {scale:.2g}", tuple(history))
            theta = size / last if 0 < last < math.inf else math.inf
            if theta > 0.5 and reused and math.isfinite(theta):
                solver, reusable = None, False  # a nearly singular matrix serves once only
                continue
            if theta > 0.5 and math.isfinite(theta) and size > floor:
                if last <= ROUGH * scale:  # corrections of the size of rounding shrink no more
                    return self._corrected(y, step, 2 * last, history, solver)
                raise NoConvergence(f"corrections do not shrink: {last:.2g}, then {size:.2g}", tuple(history))
            y = y + step
            left = size * theta / (1 - theta) if theta < 0.5 else math.inf
            if size <= floor or left <= floor:
                return self._corrected(y, step, min(size, left), history, solver)
            last = size
            if size > CHORD * scale or not reusable:
                solver = None  # else the last factor serves once more
        if last <= PLATEAU * scale:
            return self._corrected(y, step, 2 * last, history, solver)
        raise NoConvergence(f"after {len(history)} corrections the last was {last:.2g}", tuple(history))

    def _finite_residual(self, y: Array, history: list[NewtonStep], *, wide: bool) -> Array:
        try:
            F = self.residual(y, wide=wide) if is_finite(y) else np.full(y.size - 1, np.nan)
        except (ValueError, ArithmeticError) as error:
            raise NoConvergence(f"the residual cannot be computed: {error}", tuple(history)) from error
        if not is_finite(F):
            raise NoConvergence("the residual is not finite at the predicted point", tuple(history))
        return F

    def _solver(self, y: Array, row: Array, history: list[NewtonStep]) -> OneBorder:
        """The bordered matrix at y, factored."""
        try:
            with np.errstate(all="ignore"):
                return OneBorder(factor(self.jacobian(y)), self.d_lam(y), row[:-1], float(row[-1]))
        except (ValueError, ArithmeticError) as error:
            raise NoConvergence(f"the derivatives cannot be used: {error}", tuple(history)) from error

    def _corrected(self, y: Array, step: Array, left: float, history: list[NewtonStep], solver: OneBorder | None) -> Corrected:
        size = self.norm(step)
        remaining = left * float(np.abs(step[:-1]).max(initial=0.0)) / size if size else 0.0
        return Corrected(y, tuple(history), remaining, solver)


def _is_symmetric(J: Any) -> bool:
    return isinstance(J, Symmetric) or factor(J).inertia() is not None


@dataclass(frozen=True, eq=False)
class Segment:
    """A piece of a curve between two solutions a and b with unit tangents; sigma = row . (y - a) runs from 0 to `length`.

    Between them Hermite's cubic in sigma, wrong by O(length^4).
    """

    a: Array
    ta: Array
    b: Array
    tb: Array
    row: Array

    @cached_property
    def length(self) -> float:
        """sigma at b."""
        return float(self.row @ (self.b - self.a))

    @cached_property
    def slopes(self) -> tuple[Array, Array]:
        """dy/dsigma at the two ends."""
        return self.ta / (self.row @ self.ta), self.tb / (self.row @ self.tb)

    def at(self, sigma: float) -> Array:
        """The cubic at sigma; beyond the ends it extrapolates."""
        s, x = self.length, sigma / self.length
        da, db = self.slopes
        return _cubic(x, self.a, self.b, s * da, s * db)

    def loads(self, parts: Array) -> Array:
        """The load of the cubic at parts of its length, shape of `parts`."""
        da, db = (self.length * slope[-1] for slope in self.slopes)
        return _cubic(parts, self.a[-1], self.b[-1], da, db)

    def derivative(self, sigma: float) -> Array:
        """dy/dsigma of the cubic."""
        da, db = self.slopes
        return _slope(sigma / self.length, (self.b - self.a) / self.length, da, db)

    def rates(self, parts: Array) -> Array:
        """dlam/dsigma of the cubic at parts of its length, shape of `parts`."""
        da, db = (slope[-1] for slope in self.slopes)
        return _slope(parts, (self.b[-1] - self.a[-1]) / self.length, da, db)


def _cubic(x: Any, a: Any, b: Any, da: Any, db: Any) -> Array:
    """Hermite's cubic on 0 <= x <= 1 with values a, b and slopes da, db."""
    return np.asarray((1 + 2 * x) * (1 - x) ** 2 * a + x * x * (3 - 2 * x) * b + x * (1 - x) * ((1 - x) * da - x * db))


def _slope(x: Any, chord: Any, da: Any, db: Any) -> Array:
    """Its derivative."""
    return np.asarray(6 * x * (1 - x) * chord + (1 - x) * (1 - 3 * x) * da + x * (3 * x - 2) * db)
