"""Where a branch ends: at a load, back where it began, outside of the limits given. The first on a step counts."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from rodlab.analysis.continuation import Step, Walk, carried
from rodlab.analysis.curve import Corrected, Curve, Segment
from rodlab.analysis.equilibrium import on_its_mesh
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.touching import root
from rodlab.numerics.inertia import Inertia

Within = Mapping[str, tuple[float, float]] | Callable[[Point], Any] | None

LOOKS = 8  # places of a step at which the limits are looked at
BEGUN = 1e-6  # part of the first step that is still its beginning
FAR = 1e6  # loads beyond this many times those in question: the branch runs away


def piece(a: Point, b: Point) -> Segment:
    """The cubic between two neighbours on a branch; a first point without tangent gets that of the chord."""
    ya, yb = carried(a.equations, b.equations, np.append(a.u, a.lam)), np.append(b.u, b.lam)
    curve = Curve(b.equations)
    chord = (yb - ya) / curve.norm(yb - ya)
    ta = chord if a.tangent is None else carried(a.equations, b.equations, a.tangent, direction=True)
    tb = chord if b.tangent is None else b.tangent
    return Segment(ya, np.asarray(ta), yb, np.asarray(tb), curve.row(chord))


def rises(segment: Segment) -> bool:
    """True when the load changes one way at both ends, as it does between them."""
    way = float(segment.b[-1] - segment.a[-1])
    return all(way * segment.length * float(slope[-1]) >= 0 for slope in segment.slopes) and way != 0


def straddles(segment: Segment, lam: float) -> bool:
    """True for a load between those of its ends."""
    return bool((segment.a[-1] - lam) * (segment.b[-1] - lam) < 0)


def passages(segment: Segment, lam: float) -> list[float]:
    """Parts of its length, above 0 and up to 1, at which the cubic passes a load."""
    a, b = float(segment.a[-1]), float(segment.b[-1])
    da, db = (segment.length * float(slope[-1]) for slope in segment.slopes)
    hull = (a, a + da / 3, b - db / 3, b)
    if not min(hull) <= lam <= max(hull):
        return []
    cubic = np.array([da + db - 2 * (b - a), 3 * (b - a) - 2 * da - db, da, a - lam])
    roots = np.roots(cubic[:-1] if a == lam else cubic)
    real = sorted(float(x.real) for x in roots if abs(x.imag) <= 1e-9 * (1 + abs(x)))
    if b == lam:  # one of the roots is 1, up to rounding
        return [*(x for x in real if 1e-12 < x < 1 - 1e-7), 1.0]
    return [x for x in real if 1e-12 < x < 1]


def at_load(curve: Curve, segment: Segment, part: float, lam: float, accepted: str, known: Inertia | None = None) -> Point:
    """The point of a segment exactly at a load, next to the part of its length; `NoConvergence` where it is not there."""
    guess = segment.at(part * segment.length)
    guess[-1] = lam
    found = curve.correct(guess, np.append(np.zeros(guess.size - 1), 1.0))
    if curve.norm(found.y - guess) > 0.1 * segment.length:
        raise NoConvergence(f"the point at lam = {lam:g} was lost", found.history)
    t = curve.tangent(found.y, segment.derivative(part * segment.length))
    u = found.y[:-1].copy()
    return on_its_mesh(Point(curve.equations, lam, u, found.history, found.remaining, t, accepted, known))


def passed(
    curve: Curve, segment: Segment, part: float, lam: float, accepted: str, known: Inertia | None = None
) -> tuple[float, Point]:
    """The same with its part; by solutions across the branch where a fold or branch point hides a load between the ends.

    Raises `NoConvergence` where only the cubic passes the load.
    """
    try:
        return part, at_load(curve, segment, part, lam, accepted, known)
    except NoConvergence:
        if not straddles(segment, lam):
            raise

    def across(x: float) -> Corrected:
        return curve.correct(segment.at(x * segment.length), segment.row)

    part = root(lambda x: float(across(x).y[-1]) - lam, 0.0, 1.0)
    found = across(part)
    y = np.append(found.y[:-1], lam)
    t = curve.tangent(y, segment.derivative(part * segment.length))
    return part, Point(curve.equations, lam, found.y[:-1].copy(), found.history, found.remaining, t, accepted)


def inside_of(within: Within) -> Callable[[Point], bool]:
    """True for points within the limits; `ValueError` for limits that are none."""
    if within is None:
        return lambda _: True
    if isinstance(within, Mapping):
        for name, limits in within.items():
            pair = isinstance(limits, (tuple, list)) and len(limits) == 2 and all(isinstance(x, (int, float)) for x in limits)
            if not pair or not limits[0] < limits[1]:
                raise ValueError(f"within must map measures to (low, high); {name} is mapped to {limits!r}")
        return lambda p: all(low <= _measure(p, name) <= high for name, (low, high) in within.items())
    if callable(within):
        return lambda p: bool(within(p))
    raise ValueError(f"within must be a function of a point or map measures to (low, high); it is {within!r:.60}")


def _measure(p: Point, name: str) -> float:
    if name == "lam":
        return p.lam
    try:
        return p.measure(name)
    except AttributeError as error:
        raise ValueError(f"within must name measures of the model: {error}") from None


class Stops:
    """Where a step ends the branch: the first of all reasons on it."""

    def __init__(self, walk: Walk, p: Point, ends: Sequence[float], within: Within, inside: Callable[[Point], bool]) -> None:
        self.walk, self.start, self.to, self.within, self.inside = walk, walk.here, ends[0], within, inside
        self.equations = p.equations
        setting_out = float(walk.here.tangent[-1]) * (ends[0] - p.lam) > 0
        self.loads = {end: f"lam = {end:g} reached" for end in ends}
        if setting_out and len(ends) == 1:
            self.loads.setdefault(p.lam, f"back at lam = {p.lam:g}")
        self.steps = 0

    def of(self, step: Step) -> tuple[float, Point, str] | None:
        """(how far along the step, the last point, the reason), or None."""
        self.steps += 1
        found = [*self._at_loads(step), *self._closing(step), *self._leaving(step), *self._away(step)]
        return min(found, key=lambda entry: entry[0]) if found else None

    def _at_loads(self, step: Step) -> Iterator[tuple[float, Point, str]]:
        segment, curve = step.segment, self.walk.curve
        known = step.point.known_inertia if step.proved and not step.windows else None
        for load, reason in self.loads.items():
            for part in passages(segment, load):
                if self.steps == 1 and part < BEGUN and load == float(self.start.y[-1]):
                    continue  # the first point itself, moved by rounding
                try:
                    exact, point = passed(curve, segment, part, load, step.point.accepted, known)
                except NoConvergence:
                    if straddles(segment, load):
                        raise
                    continue
                yield exact, point, reason
                break

    def _closing(self, step: Step) -> Iterator[tuple[float, Point, str]]:
        segment, curve, old = step.segment, self.walk.curve, self.equations
        start, t = carried(old, curve.equations, self.start.y), carried(old, curve.equations, self.start.tangent, direction=True)
        sigma = float(segment.row @ (start - segment.a))
        if self.steps < 3 or not 0 < sigma <= segment.length or curve.norm(segment.at(sigma) - start) > 0.05 * segment.length:
            return
        try:
            here = self.walk.locator.place(segment, sigma)
        except NoConvergence:
            return
        size = max(curve.norm(start), 1e-3)
        if curve.norm(here.y - start) <= 1e-8 * size and curve.dot(here.tangent, t) > 0.9:
            y = start if old is curve.equations else here.y
            point = Point(curve.equations, float(y[-1]), y[:-1].copy(), tangent=here.tangent, accepted=step.point.accepted)
            yield sigma / segment.length, point, "closed: back at its first point"

    def _leaving(self, step: Step) -> Iterator[tuple[float, Point, str]]:
        if self.within is None:
            return
        segment = step.segment
        parts = [float(x) for x in np.linspace(0.0, 1.0, LOOKS + 1)]
        out = next((x for x in parts[1:-1] if not self.inside(self._guessed(segment, x))), None)
        if out is None and self.inside(step.point):
            return
        high = 1.0 if out is None else out
        low = high - 1 / LOOKS
        for _ in range(40):
            middle = (low + high) / 2
            low, high = (middle, high) if self.inside(self._point(segment, middle, step)) else (low, middle)
        yield low, self._point(segment, low, step), "left the limits given"

    def _away(self, step: Step) -> Iterator[tuple[float, Point, str]]:
        if abs(step.point.lam) > FAR * max(abs(self.to), abs(float(self.start.y[-1])), self.walk.curve.scale):
            yield 1.0, step.point, f"it runs away from {self.to:g}: lam = {step.point.lam:.3g}"

    def _guessed(self, segment: Segment, part: float) -> Point:
        y = segment.at(part * segment.length)
        return Point(self.walk.curve.equations, float(y[-1]), y[:-1])

    def _point(self, segment: Segment, part: float, step: Step) -> Point:
        found = self.walk.curve.correct(segment.at(part * segment.length), segment.row)
        y = found.y
        t = self.walk.curve.tangent(y, segment.derivative(part * segment.length))
        return Point(
            self.walk.curve.equations, float(y[-1]), y[:-1].copy(), found.history, found.remaining,
            tangent=t, accepted=step.point.accepted,
        )  # fmt: skip
