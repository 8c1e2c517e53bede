"""Two ways down the energy: steepest descent, as the notes weigh it against Newton [N 2.7], and Newton with a shift.

    steepest      u <- u - t grad V                  reaches minima only, from almost anywhere, and slowly
    shifted       u <- u - (V'' + mu)^{-1} grad V    the same valleys at Newton's pace; mu -> 0 near the minimum

mu is the Levenberg-Marquardt shift: large it gives short steps down the gradient, zero it gives Newton's own. It is raised
until V'' + mu is positive definite (index 0, by inertia) and the energy falls as its quadratic model says.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from rodlab.analysis.equations import Equations, jacobian, started
from rodlab.analysis.newton import FLOOR, Newton, NewtonStep, NoConvergence, Solution
from rodlab.analysis.point import Point
from rodlab.numerics.arrays import EPS, Array, number, whole
from rodlab.numerics.factor import inertia_of, largest_diagonal, shifted, solve

IDLE = 20  # steps that change neither energy nor angles beyond rounding before giving up


class DescentStep(NamedTuple):
    """One step down: energy and gradient norm where it began, and its length factor t."""

    energy: float
    gradient: float
    t: float


def steepest_descent(
    model: Equations, lam: float, guess: Any = None, *, tol: float = 1e-8, limit: int = 100_000
) -> tuple[Point, tuple[DescentStep, ...]]:
    """The minimum that steepest descent reaches, and its history, one entry a step.

    A step may not raise the energy nor pass the lowest point of its line, told by the gradient there, which unlike
    the energy is not drowned by rounding near the minimum; the next one tries twice its length. Stops when the
    gradient's norm is below tol times its largest; it does not move from where the gradient is zero, a saddle included.
    The model must know its energy (`measures`). The point's error is its distance from the root that Newton's method
    finds next to it.
    Raises `NoConvergence` after `limit` steps: for n joints it needs of the order of n^2 of them.

    >>> from rodlab.mechanics.strut import Strut
    >>> p, history = steepest_descent(Strut(n=2), 5.0, [0.1, 0.2])
    >>> p.index, round(p.tip_angle, 6), len(history)
    (0, 2.561719, 27)
    """
    lam, u, V, limit = number("lam", lam), started(model, guess), _energy(model), whole("limit", limit, least=1)
    energy, t, largest = V(u, lam), 1.0, 0.0
    g = np.asarray(model.residual(u, lam))
    history: list[DescentStep] = []
    while len(history) < limit:
        size = math.sqrt(g @ g)
        largest = max(largest, size)
        if size <= tol * largest:
            root = Newton.at(model, lam).solve(u)
            return Point(model, lam, u, (), root.remaining + float(np.abs(root.u - u).max())), tuple(history)
        t *= 2
        while True:
            trial = u - t * g
            after, gradient = V(trial, lam), np.asarray(model.residual(trial, lam))
            if gradient @ g >= 0 and after <= energy + 8 * EPS * abs(energy):  # not past the lowest point of the line
                break
            t /= 2
            if t < 1e-300:
                raise NoConvergence("steepest descent found no way down: is the residual the gradient?", tuple(history))
        history.append(DescentStep(energy, size, t))
        u, energy, g = trial, after, gradient
    raise NoConvergence(
        f"steepest descent has not arrived after {limit} steps: its gradient fell from {largest:.2g} to {size:.2g}",
        tuple(history),
    )


def downhill(model: Equations, lam: float, u: Array, run: Newton) -> Solution:
    """A minimum of the energy by shifted Newton steps from u, finished by Newton's own method `run`."""
    V, mu, near = _energy(model), 0.0, 1e-2
    history: list[NewtonStep] = []
    energy, start, idle = V(u, lam), run.norm(u), 0
    for _ in range(10 * run.limit):
        g, H = np.asarray(model.residual(u, lam)), jacobian(model, u, lam)
        least = 16 * EPS * largest_diagonal(H) or float(np.abs(g).max()) or 1.0
        noise = 1e3 * EPS * abs(energy)
        while True:
            step, fall = _downward(H, g, mu)
            gain = -math.inf if step is None else energy - V(u + step, lam)
            if step is not None and (gain >= fall / 10 or (fall <= noise and gain >= -noise)):
                break
            mu = max(8 * mu, least)
            if not math.isfinite(mu):
                raise NoConvergence("no step from this guess lowers the energy", tuple(history))
        size = run.norm(step)
        history.append(NewtonStep(size, run.norm(g), least / (least + mu)))
        u = u + step
        energy = V(u, lam)
        scale = max(run.norm(u), start)
        if size <= near * scale and _is_positive(jacobian(model, u, lam)):
            try:
                root = run.solve(u)
            except NoConvergence:
                near /= 100
            else:
                return Solution(root.u, (*history, *root.history), root.remaining)
        if gain >= fall / 2 or fall <= noise:
            mu = mu / 8 if mu > least else 0.0
        idle = idle + 1 if abs(gain) <= noise or size <= FLOOR * scale else 0
        if idle == IDLE:
            raise NoConvergence(
                f"neither Newton's method nor {len(history)} steps down the energy arrive: rounding hides the way at a"
                f" residual of {history[-1].residual:.2g}",
                tuple(history),
            )
    raise NoConvergence(f"{10 * run.limit} steps down the energy did not arrive at a minimum", tuple(history))


def has_energy(model: Equations) -> bool:
    """True when the model tells the energy of which its residual is the gradient, and nothing but that is asked of it.

    Multipliers of constraints are no unknowns to go downhill in.
    """
    return "energy" in getattr(model, "measures", {}) and not hasattr(model, "constraints")


def _downward(H: Any, g: Array, mu: float) -> tuple[Array | None, float]:
    """The step -(H + mu)^{-1} g and the fall of energy it promises, if H + mu is positive definite."""
    shift = shifted(H, mu)
    if not _is_positive(shift):
        return None, 0.0
    step = solve(shift, -g)
    return (step, float(-g @ step) / 2) if np.isfinite(step).all() else (None, 0.0)


def _is_positive(matrix: Any) -> bool:
    known = inertia_of(matrix)
    return known is not None and known.negative == known.unclear == 0


def _energy(model: Equations) -> Any:
    if not has_energy(model):
        why = "is held by constraints" if hasattr(model, "constraints") else "has no measure 'energy'"
        raise ValueError(f"model must know its energy, and that alone, to go downhill; {type(model).__name__} {why}")
    measures: dict[str, Any] = getattr(model, "measures", {})
    return measures["energy"]
