"""Follow a branch to a load and keep what was met: the stream of points, stopped and stored.

Stopping lies outside of the continuation (`stops`); the last event is always the end, and says why.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from rodlab.analysis.continuation import Step, Walk
from rodlab.analysis.curve import Curve
from rodlab.analysis.events import Event, SingularPoints, Zero, branch_point, finders, fold
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.stops import Stops, Within, inside_of, passages, passed, piece, rises, straddles
from rodlab.numerics.arrays import Array, number, whole


@dataclass(frozen=True, eq=False)
class Branch:
    """Points of one branch in order, and its events; the last event is the end. `begin`: why it does not go on before the first.

    `b.lam` and `b.measure("tip_angle")` are arrays over the points.
    """

    points: list[Point]
    events: list[Event]
    begin: str = ""

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
        """False when it ended because no further step could be shown, or because it ran away."""
        return self.end.converged

    def extended(self, to: float, **options: Any) -> "Branch":
        """The same branch followed further, from its last point; options as those of `follow`."""
        return self.joined(follow(self.points[-1], to, **options))

    def joined(self, more: "Branch") -> "Branch":
        """One branch of two, where the second begins with the last point of the first."""
        shift = len(self.points) - 1
        later = [replace(e, where=e.where + shift) for e in more.events]
        return Branch([*self.points, *more.points[1:]], [*self.events[:-1], *later], self.begin)

    def reversed(self) -> "Branch":
        """The same from its end to its beginning."""
        last = len(self.points) - 1
        accepted = ["", *(p.accepted for p in self.points[:0:-1])]
        points = [_turned(p, how) for p, how in zip(self.points[::-1], accepted, strict=True)]
        events = [replace(e, where=last - e.where, point=_turned(e.point, e.point.accepted)) for e in self.events[-2::-1]]
        end = replace(self.end, lam=points[-1].lam, point=points[-1], reason=self.begin or "its first point")
        return Branch(points, [*events, end], self.reason)

    def along(self, where: float) -> Point:
        """The point at a place counted in points, between them on the cubic, not corrected."""
        i = max(0, min(int(where), len(self.points) - 2))
        if where == i or len(self.points) == 1:
            return self.points[i]
        segment = piece(self.points[i], self.points[i + 1])
        y = segment.at((where - i) * segment.length)
        return Point(self.points[i + 1].equations, float(y[-1]), y[:-1])

    def indices(self) -> list[int | None]:
        """The index before the first event, between the events, and after the last one; None where it is not known."""
        places = [0.0, *(e.where for e in self.events[:-1]), len(self.points) - 1.0]
        return [self._index_between(a, b) for a, b in pairwise(places)]

    def _index_between(self, a: float, b: float) -> int | None:
        inner = self.points[int(a) + 1 : int(np.ceil(b))]
        p = inner[len(inner) // 2] if inner else self.along((a + b) / 2)
        return p.index if p.index_verified else None

    def at(self, lam: float) -> list[Point]:
        """The points of the branch at a load, one for each time it passes, in order; needs the tangents of its points.

        Raises `NoConvergence` where a passage is lost, a fold next to it.
        """
        lam = number("lam", lam)
        found = [p for p in self.points[:1] if p.lam == lam]
        for a, b in pairwise(self._turning_points()):
            segment = piece(a, b)
            inner = [part for part in passages(segment, lam) if part < 1]
            if rises(segment):  # then it passes the load once or not at all, whatever its cubic does
                inner = inner[:1] or [0.5] if straddles(segment, lam) else []
            found += [passed(Curve(b.equations), segment, part, lam, b.accepted)[1] for part in inner]
            found += [b] if b.lam == lam else []
        return found

    def _turning_points(self) -> list[Point]:
        """The points, with the folds between them."""
        folds = [(e.where, e.point) for e in self.events if e.kind == "fold" and e.converged]
        every = [*((float(i), p) for i, p in enumerate(self.points)), *folds]
        return [p for _, p in sorted(every, key=lambda entry: entry[0])]

    def save(self, path: Any) -> Any:
        """Write the branch whole to a .json or .npz file, to be read by `rl.read`; returns the path."""
        from rodlab.analysis.saved import save

        return save(self, path)


def follow(
    p: Point, to: float | tuple[float, float], step: float | None = None, events: Any = (fold, branch_point),
    within: Within = None, max_points: int = 10_000, *, scale: float | None = None,
    until: Callable[[Event], str | None] | None = None, watch: Callable[[Point], Any] | None = None,
) -> Branch:  # fmt: skip
    """The branch through p as far as the load `to`, with the events met on the way.

    step: first and longest length of a step, |.|^2 = inner(du, du) + (dlam / scale)^2; None leaves it to the error of the
    predictions. scale: 1 where a step is given, else a tenth of the loads in question. Direction: the point's tangent if it
    has one, else towards `to`. within: a function of a point that is true inside, or ranges of measures,
    {"tip_angle": (-3, 3)} or {"lam": (0, 50)}. Ends exactly at `to`; on leaving `within`; on closing; after max_points;
    and, having set out towards `to`, back at p.lam. Two loads for `to` are a window: it ends at either, the first its aim.
    until: called with every event; it ends the branch there by returning the reason. watch: called with every point.
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
    ends = [number("to", load) for load in (to if isinstance(to, (tuple, list)) else (to,))]
    to, most = ends[0], whole("max_points", max_points, least=1)
    wanted, inside = finders(events), inside_of(within)
    walk = Walk(p, step=step, toward=to, scale=scale)
    if to == p.lam and p.tangent is None:
        raise ValueError(f"to must differ from the load of p, which tells the direction; both are {to:g}")
    if not inside(p):
        raise ValueError(f"p must lie within the limits given; it does not: {p!r:.80}")
    points, found = [p], list[Event]()
    stops = Stops(walk, p, ends, within, inside)
    while True:
        if len(points) >= most:
            return _ended(points, found, f"max_points, {most}, reached")
        try:
            step_taken = walk.advance()
            stop = stops.of(step_taken)
        except NoConvergence as failure:
            return _ended(points, found, str(failure), converged=False)
        limit = np.inf if stop is None else stop[0]
        for event in _sorted(step_taken, walk, wanted, limit, len(points) - 1):
            reason = None if until is None else until(event)
            if reason:
                return _ended([*points, event.point], found, reason, where=event.where)
            found.append(event)
        points.append(step_taken.point if stop is None else stop[1])
        if watch is not None:
            watch(points[-1])
        if stop is not None:
            runaway = stop[2].startswith("it runs away")
            return _ended(points, found, stop[2], converged=not runaway, where=len(points) - 2 + stop[0])


def _sorted(step: Step, walk: Walk, wanted: list[SingularPoints | Zero], limit: float, before: int) -> Iterator[Event]:
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


def _turned(p: Point, accepted: str) -> Point:
    return replace(p, tangent=None if p.tangent is None else -p.tangent, accepted=accepted)


def _ended(
    points: list[Point], events: list[Event], reason: str, *, converged: bool = True, where: float | None = None
) -> Branch:
    last = points[-1]
    if where is not None:  # the events of the last step are counted in the part of it that is left
        start = len(points) - 2
        events = [replace(e, where=start + (e.where - start) / (where - start)) if e.where > start else e for e in events]
    end = Event("end", last.lam, 0.0, last, reason=reason, converged=converged, where=len(points) - 1.0)
    return Branch(points, [*events, end])
