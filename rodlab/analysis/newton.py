"""Newton's method for F(u) = 0, plain while it contracts and damped where it does not [N 2.7].

    J(u_k) s_k = -F(u_k),    u_{k+1} = u_k + t_k s_k

It is judged by its steps in the norm of the equations, not by the residual, whose scale means nothing (at n = 10^6
joints rounding of u alone leaves a residual of 1e-10). Damping follows Deuflhard's natural monotonicity test
[Newton Methods for Nonlinear Problems, 2004, NLEQ-ERR]: a step of length t is taken when the simplified step, with the same
Jacobian from the new point, is shorter by 1 - t/4. Steps near a regular root shrink quadratically, and the history shows it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from rodlab.analysis.equations import Equations, jacobian
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.factor import Factor, factor, solve

SHORTEST = 1e-9  # damping below this finds nothing more
FLOOR = 1e-7  # relative step below which steps that stop shrinking are rounding, or a singular root


class NewtonStep(NamedTuple):
    """One linear solve: norm of the step, norm of the residual it started from, and the damping.

    Damping is the fraction of the step taken; for a shifted step downhill, how near its shift is to none: 1 / (1 + mu / mu_0).
    """

    step: float
    residual: float
    damping: float


class NoConvergence(ArithmeticError):
    """No solution was reached. `history` holds what was tried, a `NewtonStep` (or descent step) each."""

    def __init__(self, message: str, history: tuple[Any, ...]) -> None:
        super().__init__(message)
        self.history = history

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self.history))


@dataclass(frozen=True)
class Solution:
    """A root, the history of its iteration, and an estimate of the distance left to the root, in any one unknown."""

    u: Array
    history: tuple[NewtonStep, ...]
    remaining: float


@dataclass
class Newton:
    """One run of Newton's method: the residual, its Jacobian, the norm, and where it stands.

    >>> run = Newton(lambda u: u**2 - 2, lambda u: np.diag(2 * u), lambda v: float(np.abs(v).max()))
    >>> root = run.solve(np.array([1.0]))
    >>> root.u, [f"{entry.step:.0e}" for entry in root.history]
    (array([1.41421356]), ['5e-01', '8e-02', '2e-03', '2e-06', '2e-12'])
    """

    residual: Callable[[Array], Array]
    jacobian: Callable[[Array], Any]
    norm: Callable[[Array], float]
    limit: int = 100

    @classmethod
    def at(cls, model: Equations, lam: float, limit: int = 100) -> "Newton":
        """Newton's method for the equations at a load, in their own length; with the residual of most digits that they have."""
        own = getattr(model, "residual_wide", model.residual)

        def residual(u: Array) -> Array:
            F = np.asarray(own(u, lam))
            if F.shape != u.shape:
                raise ValueError(f"residual must return the shape of u, {u.shape}; it returned {F.shape}")
            return F

        def norm(v: Array) -> float:
            with np.errstate(over="ignore"):
                square = float(model.inner(v, v))
            if square < 0:
                raise ValueError(f"inner(v, v) must not be negative; it is {square:g}")
            return math.sqrt(square)

        return cls(residual, lambda u: jacobian(model, u, lam), norm, limit)

    def solve(self, u: Array) -> Solution:
        """A root from the first iterate u; raises `NoConvergence` with its history."""
        self.history: list[NewtonStep] = []
        F = self._residual(u)
        if F is None:
            raise NoConvergence("Newton cannot start: the residual at the first guess is not finite", ())
        start = self.norm(u)
        while True:
            found = self._plain(u, F, start)
            if isinstance(found, Solution):
                return found
            u, F = self._damped(*found)

    def _plain(self, u: Array, F: Array, start: float) -> Solution | tuple[Array, Array]:
        """Full steps: a root, or the last iterate and residual from which they still contracted."""
        before, last, contraction = (u, F), math.inf, math.inf
        while len(self.history) < self.limit:
            if not F.any():  # exactly in equilibrium, be the Jacobian singular or not
                self._tell(0.0, F)
                return self._solution(u, F, 0.0)
            step = self._step(u, F)
            size = self.norm(step) if step is not None else math.inf
            self._tell(size, F)
            floor = 2 * EPS * max(self.norm(u), 1e-3 * start)
            if step is not None and size <= floor and self._fell(u, F):
                return self._solution(u + step, step, size)
            if not size < last or step is None:
                if last < math.inf and self._is_rounding(*before):  # steps can shrink no more; the error says how far
                    small = last <= FLOOR * max(self.norm(u), start)
                    left = last * max(1.0, contraction / (1 - contraction)) if small else 2 * last
                    return self._solution(u if small else before[0], u - before[0], left)
                return before
            beyond = u + step
            after = self._residual(beyond)
            if after is None:
                return u, F
            contraction = size / last if last < math.inf else math.inf
            left = size * contraction / (1 - contraction) if contraction < 0.5 else math.inf
            if left <= floor and self._fell(beyond, after):
                return self._solution(beyond, step, left)
            before, last = (u, F), size
            u, F = beyond, after
        raise self._failure(f"after {self.limit} linear solves the last step was {self.history[-1].step:.2g}")

    def _damped(self, u: Array, F: Array) -> tuple[Array, Array]:
        """Steps of the length that natural monotonicity allows, until a full one contracts well."""
        t, before = 1.0, None
        while len(self.history) < self.limit:
            with np.errstate(all="ignore"):
                J = factor(self.jacobian(u))
                step = _finite(J.solve(-F))
            if step is None:
                raise self._failure("the Jacobian is singular where a damped step would start")
            size = self.norm(step)
            if size <= 2 * EPS * self.norm(u):
                return u, F
            if before is not None:  # the length that the change of the last step foretells [Deuflhard, 3.3.2]
                change = self.norm(before[1] - step) * size
                t = min(1.0, t * self.norm(before[0]) * self.norm(before[1]) / change) if change else 1.0
            t, u, F, simplified = self._shortened(u, F, J, step, t)
            if t == 1.0 and self.norm(simplified) < size / 4:
                return u, F
            before = (step, simplified)
        raise self._failure(f"after {self.limit} linear solves the damped step was still {self.history[-1].step:.2g}")

    def _shortened(self, u: Array, F: Array, J: Factor, step: Array, t: float) -> tuple[float, Array, Array, Array]:
        """The longest t tried for which the simplified step from u + t step is shorter by 1 - t/4."""
        size = self.norm(step)
        while t >= SHORTEST and len(self.history) < self.limit:
            self._tell(size, F, t)
            trial = self._residual(u + t * step)
            simplified = None if trial is None else _finite(J.solve(-trial))
            if trial is None or simplified is None:
                t /= 4
                continue
            if self.norm(simplified) <= (1 - t / 4) * size:
                return t, u + t * step, trial, simplified
            t = min(t * t * size / (2 * self.norm(simplified - (1 - t) * step)), t / 2)
        raise self._failure(f"a step of {size:.2g} was cut to {t:.1g} of its length in vain")

    def _residual(self, u: Array) -> Array | None:
        with np.errstate(all="ignore"):
            try:
                return _finite(self.residual(u))
            except ValueError:
                if np.isfinite(u).all():
                    raise
                return None

    def _step(self, u: Array, F: Array) -> Array | None:
        with np.errstate(all="ignore"):
            return _finite(solve(self.jacobian(u), -F))

    def _is_rounding(self, u: Array, F: Array) -> bool:
        """True when F is no larger than what moving u by a few units of rounding, up and down in turn, does to it."""
        sign = np.where(np.arange(u.size) % 2, 1.0, -1.0)
        noise = [self._residual(u * (1 + side * 4 * EPS * sign)) for side in (1, -1)]
        return all(moved is not None and self.norm(F) <= 16 * self.norm(moved - F) for moved in noise)

    def _fell(self, u: Array, F: Array) -> bool:
        """True where the residual fell with the steps, or is rounding: a solve that lost an unknown takes steps of zero there."""
        return self.norm(F) <= 1e-3 * self.history[0].residual or self._is_rounding(u, F)

    def _tell(self, size: float, F: Array, damping: float = 1.0) -> None:
        self.history.append(NewtonStep(size, self.norm(F), damping))

    def _solution(self, u: Array, step: Array, left: float) -> Solution:
        size = self.norm(step)
        return Solution(u, tuple(self.history), left * float(np.abs(step).max()) / size if size else 0.0)

    def _failure(self, why: str) -> NoConvergence:
        first = self.history[0].residual if self.history else math.nan
        least = min((entry.residual for entry in self.history), default=math.nan)
        return NoConvergence(
            f"Newton did not converge: {why} (residual {first:.2g} at first, {least:.2g} at best)", tuple(self.history)
        )


def _finite(v: Array) -> Array | None:
    return v if np.isfinite(v).all() else None
