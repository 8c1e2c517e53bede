"""Follow a branch to a load and keep what was met: the stream of points, stopped and stored.

Stopping lives here, outside of the continuation: at `to`, on leaving `within`, on closing, back at the load it set out from, at
`max_points`. The last event is always the end, and says why.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from rodlab.analysis.continuation import Step, Walk
from rodlab.analysis.curve import Curve, Segment
from rodlab.analysis.events import Event, Singular, Zero, branch_point, finders, fold
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.touching import root
from rodlab.numerics.arrays import Array, number, whole
from rodlab.numerics.inertia import Inertia

LOOKS = 8  # places of a step at which the limits are looked at
FAR = 1e6  # loads beyond this many times those in question: the branch runs away

Within = Mapping[str, tuple[float, float]] | Callable[[Point], Any] | None


@dataclass(frozen=True, eq=False)
class Branch:
    """Points of one branch in order, and its events; the last event is the end.

    `b.lam` and `b.measure("tip_angle")` are arrays over the points.
    """

    points: list[Point]
    events: list[Event]

    def __repr__(self) -> str:
        kinds = ", ".join(f"{e.kind} at {e.lam:.6g}" for e in self.events[:-1]) or "no event"
        first, last = self.points[0].lam, self.points[-1].lam
        return f"Branch({len(self.points)} points, lam {first:.6g} to {last:.6g}; {kinds}; end: {self.reason})"

    def __len__(self) -> int:
        return len(self.points)

    @property
    def lam(self) -> Array:
        """Loads of the points, shape (m,)."""
        return np.array([p.lam for p in self.points])

    def measure(self, name: str) -> Array:
        """A measure of every point, shape (m,)."""
        return np.array([p.measure(name) for p in self.points])

    @property
    def end(self) -> Event:
        """The last event: where and why the branch ended."""
        return self.events[-1]

    @property
    def reason(self) -> str:
        """Why it ended."""
        return self.end.reason

    @property
    def completed(self) -> bool:
        """False when it ended because no further step could be shown, or for max_points."""
        return self.end.converged

    def extended(self, to: float, **options: Any) -> "Branch":
        """The same branch followed further, from its last point; options as those of `follow`."""
        more = follow(self.points[-1], to, **options)
        shift = len(self.points) - 1
        later = [replace(e, where=e.where + shift) for e in more.events]
        return Branch([*self.points, *more.points[1:]], [*self.events[:-1], *later])

    def at(self, lam: float) -> list[Point]:
        """The points of the branch at a load, one for each time it passes, in order; needs the tangents of its points.

        Raises `NoConvergence` where a passage is lost, a fold next to it.
        """
        lam = number("lam", lam)
        found = [p for p in self.points[:1] if p.lam == lam]
        for a, b in pairwise(self.points):
            if b.lam == lam:
                found.append(b)
            elif (a.lam - lam) * (b.lam - lam) < 0:
                found.append(_between(a, b, lam))
        return found

    def save(self, path: Any) -> Any:
        """Write the branch whole to a .json or .npz file, to be read by `rl.read`; returns the path."""
        from rodlab.analysis.saved import save

        return save(self, path)


def piece(a: Point, b: Point) -> Segment:
    """The cubic between two neighbours on a branch; a first point without tangent gets that of the chord."""
    ya, yb = np.append(a.u, a.lam), np.append(b.u, b.lam)
    curve = Curve(b.equations)
    chord = (yb - ya) / curve.norm(yb - ya)
    ta, tb = (chord if p.tangent is None else p.tangent for p in (a, b))
    return Segment(ya, np.asarray(ta), yb, np.asarray(tb), curve.row(chord))


def _between(a: Point, b: Point, lam: float) -> Point:
    """The point at a load between two neighbours."""
    segment = piece(a, b)
    return at_load(Curve(b.equations), segment, passages(segment, lam)[0], lam, b.accepted)


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
    found = [x for x in real if 1e-12 < x < 1]
    return [*found, 1.0] if b == lam else found


def at_load(curve: Curve, segment: Segment, part: float, lam: float, accepted: str, known: Inertia | None = None) -> Point:
    """The point of a segment exactly at a load, next to the part of its length; `NoConvergence` where it is not there."""
    guess = segment.at(part * segment.length)
    guess[-1] = lam
    found = curve.correct(guess, np.append(np.zeros(guess.size - 1), 1.0))
    if curve.norm(found.y - guess) > 0.1 * segment.length:
        raise NoConvergence(f"the point at lam = {lam:g} was lost", found.history)
    t = curve.tangent(found.y, segment.derivative(part * segment.length))
    u = found.y[:-1].copy()
    return Point(curve.equations, lam, u, found.history, found.remaining, t, accepted, known)


def follow(
    p: Point, to: float, step: float | None = None, events: Any = (fold, branch_point), within: Within = None,
    max_points: int = 10_000, *, scale: float | None = None, watch: Callable[[Point], Any] | None = None,
) -> Branch:  # fmt: skip
    """The branch through p as far as the load `to`, with the events met on the way.

    step: first and longest length of a step, |.|^2 = inner(du, du) + (dlam / scale)^2; None leaves it to the error of the
    predictions. scale: 1 where a step is given, else a tenth of the loads in question. Direction: the point's tangent if it
    has one, else towards `to`. within: a function of a point that is true inside, or ranges of measures,
    {"tip_angle": (-3, 3)} or {"lam": (0, 50)}. Ends exactly at `to`; on leaving `within`; on closing; after max_points;
    and, having set out towards `to`, back at p.lam. watch: called with every point as it is found.
    Where the Jacobian has no index (neither symmetric nor with a second variation) only the sign of its determinant is
    followed: an even number of eigenvalues that cross zero in one step is then missed.
    Where no further step can be shown the branch ends there, `completed` is False and the reason says why.
    Raises `ValueError` for wrong arguments, or derivatives that are not those of the residual.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.mechanics.strut import Strut
    >>> b = follow(equilibrium(Strut.from_joints(k=[1, 1]), 0.0), to=3.0)
    >>> [(e.kind, round(e.lam, 12), e.multiplicity) for e in b.events]
    [('branch point', 0.38196601125, 1), ('branch point', 2.61803398875, 1), ('end', 3.0, 0)]
    """
    to, most = number("to", to), whole("max_points", max_points, least=1)
    wanted, inside = finders(events), _inside(within)
    walk = Walk(p, step=step, toward=to, scale=scale)
    if to == p.lam and p.tangent is None:
        raise ValueError(f"to must differ from the load of p, which tells the direction; both are {to:g}")
    if not inside(p):
        raise ValueError(f"p must lie within the limits given; it does not: {p!r:.80}")
    points, found = [p], list[Event]()
    stops = _Stops(walk, p, to, within, inside)
    while True:
        if len(points) >= most:
            return _ended(points, found, f"max_points, {most}, reached", converged=False)
        try:
            step_taken = walk.advance()
        except NoConvergence as failure:
            return _ended(points, found, str(failure), converged=False)
        stop = stops.of(step_taken)
        limit = np.inf if stop is None else stop[0]
        found += _sorted(step_taken, walk, wanted, limit, len(points) - 1)
        points.append(step_taken.point if stop is None else stop[1])
        if watch is not None:
            watch(points[-1])
        if stop is not None:
            return _ended(points, found, stop[2], converged=not stop[2].startswith("it runs away"))


def _sorted(step: Step, walk: Walk, wanted: list[Singular | Zero], limit: float, before: int) -> Iterator[Event]:
    events: list[Event] = []
    for finder in wanted:
        try:
            events += finder.find(step, walk.locator)
        except NoConvergence as why:
            reason = f"in this step, but it could not be located: {why}"
            events.append(Event(finder.kind, step.point.lam, np.inf, step.point, 1, reason, converged=False, where=1.0))
    for event in sorted(events, key=lambda e: e.where):
        if event.where <= limit:
            yield replace(event, where=before + event.where)


def _ended(points: list[Point], events: list[Event], reason: str, *, converged: bool = True) -> Branch:
    last = points[-1]
    end = Event("end", last.lam, 0.0, last, reason=reason, converged=converged, where=len(points) - 1.0)
    return Branch(points, [*events, end])


def _inside(within: Within) -> Callable[[Point], bool]:
    if within is None:
        return lambda _: True
    if isinstance(within, Mapping):
        for name, limits in within.items():
            if not (isinstance(limits, (tuple, list)) and len(limits) == 2 and limits[0] < limits[1]):
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


class _Stops:
    """Where a step ends the branch: the first of all reasons on it."""

    def __init__(self, walk: Walk, p: Point, to: float, within: Within, inside: Callable[[Point], bool]) -> None:
        self.walk, self.start, self.to, self.within, self.inside = walk, walk.here, to, within, inside
        self.equations = p.equations
        setting_out = float(walk.here.tangent[-1]) * (to - p.lam) > 0
        self.loads = {to: f"lam = {to:g} reached"}
        if setting_out:
            self.loads[p.lam] = f"back at lam = {p.lam:g}"
        self.steps = 0

    def of(self, step: Step) -> tuple[float, Point, str] | None:
        """(how far along the step, the last point, the reason), or None."""
        self.steps += 1
        found = [*self._at_loads(step), *self._closing(step), *self._leaving(step), *self._away(step)]
        return min(found, key=lambda entry: entry[0]) if found else None

    def _at_loads(self, step: Step) -> Iterator[tuple[float, Point, str]]:
        segment, curve = step.segment, self.walk.curve
        known = step.point.known_inertia if not step.windows else None
        for load, reason in self.loads.items():
            for part in passages(segment, load):
                try:
                    yield part, at_load(curve, segment, part, load, step.point.accepted, known), reason
                    break
                except NoConvergence:  # a fold in the same place; or only the cubic passes this load
                    if (segment.a[-1] - load) * (segment.b[-1] - load) < 0:
                        exact, y = self._by_arclength(segment, load)
                        yield exact, self._point(segment, exact, step, y), reason
                        break

    def _by_arclength(self, segment: Segment, load: float) -> tuple[float, Array]:
        """Where a load is passed, by solutions across the branch: good next to a fold too."""

        def off(x: float) -> float:
            return float(self.walk.curve.correct(segment.at(x * segment.length), segment.row).y[-1]) - load

        part = root(off, 0.0, 1.0)
        y = self.walk.curve.correct(segment.at(part * segment.length), segment.row).y
        y[-1] = load
        return part, y

    def _closing(self, step: Step) -> Iterator[tuple[float, Point, str]]:
        segment, curve, start = step.segment, self.walk.curve, self.start
        sigma = float(segment.row @ (start.y - segment.a))
        if self.steps < 3 or not 0 < sigma <= segment.length or curve.norm(segment.at(sigma) - start.y) > 0.05 * segment.length:
            return
        try:
            here = self.walk.locator.place(segment, sigma)
        except NoConvergence:
            return
        size = max(curve.norm(start.y), 1e-3)
        if curve.norm(here.y - start.y) <= 1e-8 * size and curve.dot(here.tangent, start.tangent) > 0.9:
            y = start.y
            point = Point(self.equations, float(y[-1]), y[:-1].copy(), tangent=here.tangent, accepted=step.point.accepted)
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
        return Point(self.equations, float(y[-1]), y[:-1])

    def _point(self, segment: Segment, part: float, step: Step, y: Array | None = None) -> Point:
        found = self.walk.curve.correct(segment.at(part * segment.length), segment.row)
        y = found.y if y is None else y
        t = self.walk.curve.tangent(y, segment.derivative(part * segment.length))
        return Point(
            self.equations, float(y[-1]), y[:-1].copy(), found.history, found.remaining,
            tangent=t, accepted=step.point.accepted,
        )  # fmt: skip
