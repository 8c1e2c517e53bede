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
from rodlab.analysis.stops import Stops, Within, at_load, inside_of, passages, piece
from rodlab.numerics.arrays import Array, number, whole


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
        """False when it ended because no further step could be shown, or because it ran away."""
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
            segment = piece(a, b)
            inner = [part for part in passages(segment, lam) if part < 1]
            found += [at_load(Curve(b.equations), segment, part, lam, b.accepted) for part in inner]
            found += [b] if b.lam == lam else []
        return found

    def save(self, path: Any) -> Any:
        """Write the branch whole to a .json or .npz file, to be read by `rl.read`; returns the path."""
        from rodlab.analysis.saved import save

        return save(self, path)


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
    wanted, inside = finders(events), inside_of(within)
    walk = Walk(p, step=step, toward=to, scale=scale)
    if to == p.lam and p.tangent is None:
        raise ValueError(f"to must differ from the load of p, which tells the direction; both are {to:g}")
    if not inside(p):
        raise ValueError(f"p must lie within the limits given; it does not: {p!r:.80}")
    points, found = [p], list[Event]()
    stops = Stops(walk, p, to, within, inside)
    while True:
        if len(points) >= most:
            return _ended(points, found, f"max_points, {most}, reached")
        try:
            step_taken = walk.advance()
            stop = stops.of(step_taken)
        except NoConvergence as failure:
            return _ended(points, found, str(failure), converged=False)
        limit = np.inf if stop is None else stop[0]
        found += _sorted(step_taken, walk, wanted, limit, len(points) - 1)
        points.append(step_taken.point if stop is None else stop[1])
        if watch is not None:
            watch(points[-1])
        if stop is not None:
            return _ended(points, found, stop[2], converged=not stop[2].startswith("it runs away"))


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


def _ended(points: list[Point], events: list[Event], reason: str, *, converged: bool = True) -> Branch:
    last = points[-1]
    end = Event("end", last.lam, 0.0, last, reason=reason, converged=converged, where=len(points) - 1.0)
    return Branch(points, [*events, end])
