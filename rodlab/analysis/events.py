"""What happens along a branch: folds, branch points, and zeros of any function of a point, each located to full precision.

    fold           the load turns back: J v = 0 with F_lam not in the range of J
    cusp           the same where the load goes on: two folds in one place, reported with the folds
    branch point   J V = 0 with F_lam in the range of J: other branches leave, one or more for each null vector
    of your own    lambda p: p.tip_angle - 1.0

An event is passed to `follow` as one of `events`; what is not passed is not reported, and folds and functions not looked for.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rodlab.analysis.continuation import Step
from rodlab.analysis.crossings import Crossing, Locator, Place
from rodlab.analysis.curve import Segment
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.shown import Window
from rodlab.analysis.touching import outside, root
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.nullspace import near_null

SAMPLES = 16  # of the cubic between two points, for several zeros in one step


@dataclass(frozen=True, eq=False)
class Event:
    """Something at a point of a branch. `error` bounds that of its load as far as rounding and the location can be known.

    kind: "fold", "branch point", "cusp", "end", or the name of your function. multiplicity: eigenvalues zero there within
    `error` (of a fold 1). null: the null vectors, shape (n, multiplicity). reason: why a branch ended, or what did not
    converge. where: how far along its branch, counted in points.
    """

    kind: str
    lam: float
    error: float
    point: Point
    multiplicity: int = 0
    reason: str = ""
    converged: bool = True
    null: Array | None = None
    where: float = 0.0
    fence: Segment | None = field(default=None, repr=False)

    def __repr__(self) -> str:
        times = f", multiplicity={self.multiplicity}" if self.multiplicity > 1 else ""
        why = f", reason={self.reason!r}" if self.reason else ""
        return f"Event({self.kind!r}, lam={self.lam:.12g}, error={self.error:.1e}{times}{why})"


@dataclass(frozen=True)
class Singular:
    """What to ask for: a kind of singular point of the Jacobian."""

    kind: str

    def __repr__(self) -> str:
        return f"<event: {self.kind}>"


fold = Singular("fold")
branch_point = Singular("branch point")


class SingularPoints:
    """Folds and branch points of a step, told apart by F_lam, each located once; those of the kinds asked for."""

    def __init__(self, kinds: set[str]) -> None:
        self.kinds = kinds | {"cusp"} if "fold" in kinds else kinds
        self.kind = " or ".join(sorted(kinds))

    def find(self, step: Step, locator: Locator) -> Iterator[Event]:
        """The events of these kinds in a step, in order."""
        found = (event for window in step.windows for event in _singular(window, locator, step))
        return (event for event in found if event.kind in self.kinds)


class Zero:
    """Where a function of a point passes through zero."""

    def __init__(self, function: Callable[[Point], Any]) -> None:
        self.function = function
        self.kind = str(getattr(function, "__name__", type(function).__name__))

    def find(self, step: Step, locator: Locator) -> Iterator[Event]:
        """The zeros in a step, several where the cubic between its ends shows them."""
        segment, equations = step.segment, locator.curve.equations

        def value(y: Array) -> float:
            given = self.function(Point(equations, float(y[-1]), y[:-1]))
            try:
                return float(given)
            except (TypeError, ValueError):
                raise ValueError(f"the event {self.kind} must return a number; it returned {given!r:.60}") from None

        grid = np.linspace(0.0, segment.length, SAMPLES + 1)
        values = [value(segment.a), *(value(segment.at(s)) for s in grid[1:-1]), value(segment.b)]
        for i in range(SAMPLES):
            if values[i] * values[i + 1] < 0 or (values[i + 1] == 0 and values[i] != 0):
                yield self._located(step, locator, value, (float(grid[i]), float(grid[i + 1])))

    def _located(self, step: Step, locator: Locator, value: Callable[[Array], float], where: tuple[float, float]) -> Event:
        segment = step.segment

        def exact(sigma: float) -> float:
            return value(_solution(segment, locator, sigma))

        low, high = where
        span = 1e-3 * (high - low)
        while exact(low) * exact(high) > 0 and span < segment.length:
            low, high, span = max(0.0, low - span), min(segment.length, high + span), 4 * span
        if exact(low) * exact(high) > 0:
            y = segment.at(low)
            return _event(
                self.kind,
                y,
                float(abs(segment.b[-1] - segment.a[-1])),
                step,
                segment,
                reason="it was not found between its neighbours",
                converged=False,
            )
        sigma = root(exact, low, high)
        y = _solution(segment, locator, sigma)
        error = 4 * EPS * (abs(float(y[-1])) + abs(high)) * 4 + abs(value(y)) * _load_per_value(segment, value, sigma)
        return _event(self.kind, y, error, step, segment)


def finders(events: Any) -> list[SingularPoints | Zero]:
    """The events asked for as finders; one sentence for what is none."""
    given = tuple(events) if isinstance(events, (tuple, list)) else (events,)
    for event in given:
        if not (isinstance(event, Singular) or callable(event)):
            raise ValueError(f"events must be rl.fold, rl.branch_point or functions of a point; one is {event!r:.60}")
    kinds = {event.kind for event in given if isinstance(event, Singular)}
    zeros = [Zero(event) for event in given if not isinstance(event, Singular)]
    return [SingularPoints(kinds), *zeros] if kinds else list(zeros)


# --- singular points ---------------------------------------------------------------------------------------------


def _singular(window: Window, locator: Locator, step: Step) -> Iterator[Event]:
    curve = locator.curve
    if window.fold:
        yield from _folds(window.a, window.b, locator, step)
        return
    if not window.crossings:
        yield from _folds(window.a, window.b, locator, step)
    for crossing in window.crossings:
        p = crossing.multiplicity
        turning = outside(curve, crossing)
        reason = "" if crossing.converged else f"{p} eigenvalues cross zero near here; they could not be told apart"
        if turning and crossing.touches:
            yield _event("cusp", crossing.y, crossing.error, step, crossing.fence, crossing, 1, reason)
        elif turning and p == 1 and crossing.converged:
            yield _exact_fold(crossing, locator, step)
        elif turning:
            yield _event("fold", crossing.y, crossing.error, step, crossing.fence, crossing, 1, reason)
        if p > turning:
            yield _event("branch point", crossing.y, crossing.error, step, crossing.fence, crossing, p - turning, reason)


def _folds(a: Place, b: Place, locator: Locator, step: Step) -> Iterator[Event]:
    """Every place between a and b where the load turns."""
    segment, curve = locator.segment(a, b), locator.curve
    parts = np.linspace(0.0, 1.0, SAMPLES + 1) * segment.length

    def rate(sigma: float) -> float:
        y = _solution(segment, locator, sigma)
        return float(curve.tangent(y, segment.derivative(sigma))[-1])

    turns = np.flatnonzero(np.diff(np.sign(segment.rates(parts / segment.length))))
    brackets = [(float(parts[i]), float(parts[i + 1])) for i in turns]
    turning = [bracket for bracket in brackets if rate(bracket[0]) * rate(bracket[1]) < 0]
    if not turning and float(a.tangent[-1]) * float(b.tangent[-1]) < 0:
        turning = [(0.0, segment.length)]  # where the cubic is wrong about the place
    for low, high in turning:
        yield _fold_at(_solution(segment, locator, root(rate, low, high)), segment, locator, step)


def _exact_fold(crossing: Crossing, locator: Locator, step: Step) -> Event:
    """A fold is a regular point of the curve: the corrector gives it to full precision, beyond the cubic."""
    try:
        y = locator.curve.correct(crossing.y, crossing.fence.row).y
    except NoConvergence:
        return _event("fold", crossing.y, crossing.error, step, crossing.fence, crossing, 1)
    return _fold_at(y, crossing.fence, locator, step)


def _fold_at(y: Array, segment: Segment, locator: Locator, step: Step) -> Event:
    curve = locator.curve
    near = near_null(curve.jacobian(y), 1, symmetric=curve.symmetric(y))
    point = Point(curve.equations, float(y[-1]), y[:-1])
    psi = near.left[:, 0]
    own = getattr(curve.equations, "rounding", None)
    noise = float(own(y[:-1], float(y[-1]), psi)) if own is not None else float(np.abs(psi) @ point._noise)
    push = abs(float(psi @ curve.d_lam(y))) or np.inf
    noise += locator.missed(y, psi)[0]
    error = (noise + abs(float(psi @ curve.residual(y)))) / push + 2 * EPS * abs(float(y[-1]))
    return _event("fold", y, error, step, segment, None, 1, null=near.right)


# --- small parts -------------------------------------------------------------------------------------------------


def _solution(segment: Segment, locator: Locator, sigma: float) -> Array:
    return locator.curve.correct(segment.at(sigma), segment.row).y


def _load_per_value(segment: Segment, value: Callable[[Array], float], sigma: float) -> float:
    e = 1e-4 * segment.length
    change = value(segment.at(sigma + e)) - value(segment.at(sigma - e))
    return abs(2 * e * float(segment.derivative(sigma)[-1]) / change) if change else np.inf


def _event(
    kind: str, y: Array, error: float, step: Step, fence: Segment, crossing: Crossing | None = None, multiplicity: int = 0,
    reason: str = "", null: Array | None = None, converged: bool | None = None,
) -> Event:  # fmt: skip
    sigma = float(step.segment.row @ (y - step.segment.a))
    converged = (crossing is None or crossing.converged) if converged is None else converged
    t = fence.derivative(float(fence.row @ (y - fence.a)))
    point = Point(step.point.equations, float(y[-1]), y[:-1].copy(), tangent=t, accepted=step.point.accepted)
    return Event(
        kind, float(y[-1]), float(error), point, multiplicity, reason, converged,
        crossing.null.right if crossing is not None else null, sigma / step.segment.length, fence,
    )  # fmt: skip
