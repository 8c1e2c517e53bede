"""The bifurcation diagram: every branch that is connected to a start within a window of loads, each once.

    follow a branch to the edges of the window, or to a branch point that is known already
    at each new branch point, switch; what lies on a known branch, or is the image of one, is left out
    until no branch point is left

A branch begins and ends at branch points, folds inside of it, at an edge of the window, or closes. Images under the model's
`symmetries` are counted, not followed.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from rodlab.analysis.curve import Curve
from rodlab.analysis.equations import Equations
from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.events import Event
from rodlab.analysis.follow import Branch, follow
from rodlab.analysis.kinds import kind_of
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.places import images, lies_on, orbit, same, symmetric
from rodlab.analysis.point import Point
from rodlab.analysis.switching import switch
from rodlab.numerics.arrays import number, whole

MEETS = 1e-8  # relative distance of branch points that are the same, beyond their errors
CLEAR = 1e-5  # relative distance of special loads between which solutions are counted


@dataclass(frozen=True)
class Special:
    """A row of the table: what happens where, on which branch, and which branches leave there.

    kind: "fold", "cusp", "transcritical", "supercritical pitchfork", "subcritical pitchfork", "end", or "branch point":
    several null vectors, or coefficients that decide nothing. index: before and after along its branch, None where unknown.
    """

    kind: str
    lam: float
    error: float
    branch: int
    index: tuple[int | None, int | None] = (None, None)
    multiplicity: int = 0
    leaving: tuple[int, ...] = ()
    reason: str = ""
    event: Event | None = field(default=None, repr=False)


@dataclass(frozen=True, eq=False)
class Diagram:
    """All branches found, number 0 through the first start; `copies[i]`: how many images branch i stands for, itself included.

    components[i]: the start that branch i is connected to, 0 for the first. `complete`: every branch point was switched at and
    every branch followed to its end; what failed is in the table.
    """

    window: tuple[float, float]
    branches: list[Branch]
    copies: list[int]
    components: list[int]
    table: list[Special]
    complete: bool

    def __repr__(self) -> str:
        low, high = self.window
        total = sum(self.copies)
        images = f", {total} with images" if total != len(self.branches) else ""
        said = "" if self.complete else "; not complete"
        return f"Diagram(lam {low:g} to {high:g}: {len(self.branches)} branches{images}; {len(self.table)} special points{said})"

    def at(self, lam: float) -> list[Point]:
        """Every solution of the diagram at a load, images among them. `ValueError` outside of the window."""
        lam = number("lam", lam)
        low, high = self.window
        if not low <= lam <= high:
            raise ValueError(f"lam must lie in the window of the diagram, {low:g} to {high:g}; it is {lam:g}")
        return [p for i in range(len(self.branches)) for p in self._on(i, lam)]

    def _on(self, i: int, lam: float) -> list[Point]:
        own = self.branches[i].at(lam)
        if self.copies[i] == 1:
            return own
        found: list[Point] = []
        for p in own:
            found += [q for q in (p, *images(p)) if not any(same(q, other) for other in found)]
        return found

    def count(self, lam: float) -> int:
        """The number of solutions at a load, images among them; where branches meet each is counted."""
        return len(self.at(lam))

    @property
    def counts(self) -> list[tuple[float, float, int]]:
        """(from, to, number of solutions) between neighbouring special loads."""
        low, high = self.window
        inner = sorted({row.lam for row in self.table if low < row.lam < high})
        apart = [low]
        for load in [*inner, high]:
            if load - apart[-1] > CLEAR * (high - low) or load == high:
                apart.append(load)
        return [(a, b, self.count((a + b) / 2)) for a, b in pairwise(apart)]

    def connected(self, p: Point) -> bool:
        """True when a solution is connected to the first start; what is not is detached, or a parasite of the discretisation."""
        return any(same(p, q) for q in self.connected_at(p.lam))

    def connected_at(self, lam: float) -> list[Point]:
        """The solutions at a load that are connected to the first start."""
        return [p for i, component in enumerate(self.components) if component == 0 for p in self._on(i, lam)]


def diagram(
    model: Equations, lam: tuple[float, float], start: Any = None, *, step: float | None = None, most: int = 1000,
    max_points: int = 10_000, watch: Callable[[Point], Any] | None = None,
) -> Diagram:  # fmt: skip
    """All branches connected to a start, within a window (low, high) of loads.

    start: a Point, several, or a guess at the lower load; None is the model's own start at the load nearest zero.
    step: as of `follow`. most: branches at most. watch: called with every point. Detached branches need starts of their own.
    What could not be followed or switched at stands in the table with its reason, and `complete` is False.
    Raises `ValueError` for wrong arguments; `NoConvergence` where there is no solution to start from.

    >>> from rodlab.mechanics.strut import Strut
    >>> d = diagram(Strut.from_joints(k=[1, 1]), lam=(0, 3))
    >>> d
    Diagram(lam 0 to 3: 3 branches, 5 with images; 5 special points)
    >>> [(row.kind, round(row.lam, 6), row.leaving) for row in d.table if row.leaving]
    [('supercritical pitchfork', 0.381966, (1,)), ('supercritical pitchfork', 2.618034, (2,))]
    >>> d.count(0.2), d.count(1.0), d.count(2.9)
    (1, 3, 5)
    """
    low, high = window_of(lam)
    given = start if isinstance(start, (tuple, list)) and start and isinstance(start[0], Point) else [start]
    points = [begun(model, (low, high), p) for p in given]
    for p in points:
        if not low <= p.lam <= high:
            raise ValueError(f"start must lie in the window, {low:g} to {high:g}; its load is {p.lam:g}")
    options = {"step": step, "max_points": whole("max_points", max_points, least=2), "watch": watch}
    return _Explorer((low, high), whole("most", most, least=1), options).run(points)


def window_of(lam: Any) -> tuple[float, float]:
    """A window of loads, checked."""
    if not isinstance(lam, (tuple, list)) or len(lam) != 2:
        raise ValueError(f"lam must be a pair of loads (low, high); it is {lam!r:.60}")
    low, high = (number("lam", edge) for edge in lam)
    if not low < high:
        raise ValueError(f"lam must be a pair of loads (low, high) with low < high; it is {lam!r}")
    return low, high


def begun(model: Equations, window: tuple[float, float], start: Any) -> Point:
    """The point of a start: itself, or the solution from a guess at the lower edge, from none at the load nearest zero."""
    if isinstance(start, Point):
        return start
    low, high = window
    return equilibrium(model, min(max(low, 0.0), high) if start is None else low, start)


@dataclass
class _Crossing:
    """A branch point that was met: on which branch, and what leaves it."""

    event: Event
    branch: int
    leaving: list[int] = field(default_factory=list)
    starts: list[Point] = field(default_factory=list)
    reason: str = ""


class _Explorer:
    """A diagram in the making: branches followed, branch points met, those not yet switched at last."""

    def __init__(self, window: tuple[float, float], most: int, options: dict[str, Any]) -> None:
        self.window, self.most, self.options = window, most, options
        self.branches: list[Branch] = []
        self.components: list[int] = []
        self.rows: list[Special] = []
        self.crossings: list[_Crossing] = []
        self.complete, self.component = True, 0

    def run(self, starts: Sequence[Point]) -> Diagram:
        done = 0
        for p in starts:
            if self._known(p) is None:
                self.component = len(set(self.components))
                self._add(self._through(p))
                self._singular(p)
            while done < len(self.crossings):
                self._switch(self.crossings[done])
                done += 1
        copies = [orbit(branch) for branch in self.branches]
        return Diagram(self.window, self.branches, copies, self.components, list(self._table()), self.complete)

    # --- branches -----------------------------------------------------------------------------------------------

    def _through(self, p: Point) -> Branch:
        """The branch on both sides of a start within the window."""
        low, high = self.window
        ahead = self._followed(p, (high, low)) if p.lam < high else None
        if ahead is not None and (p.lam == low or ahead.reason.startswith("closed")):
            return ahead
        back = self._followed(p, (low, high))
        return back.reversed() if ahead is None else back.reversed().joined(ahead)

    def _followed(self, p: Point, to: tuple[float, float]) -> Branch:
        return follow(p, to, until=self._meeting, **self.options)

    def _meeting(self, event: Event) -> str | None:
        """Note a branch point that is new; say which branch it is on where it is not."""
        if event.kind != "branch point":
            return None
        near = [event.point, *images(event.point)]
        for crossing in self.crossings:
            off = 10 * (event.error + crossing.event.error) / (abs(event.lam) or 1.0)
            if any(same(p, crossing.event.point, MEETS + off) for p in near):
                return f"meets branch {crossing.branch} at its branch point {crossing.event.lam:.9g}"
        self.crossings.append(_Crossing(event, len(self.branches)))
        return None

    def _add(self, branch: Branch) -> int:
        self.branches.append(branch)
        self.components.append(self.component)
        self.complete &= all(event.converged for event in branch.events) and not branch.reason.startswith("max_points")
        return len(self.branches) - 1

    def _known(self, p: Point) -> int | None:
        """The number of the branch that a solution, or an image of it, is on."""
        for q in (p, *images(p)):
            for i, branch in enumerate(self.branches):
                if lies_on(branch, q):
                    return i
        return None

    # --- branch points --------------------------------------------------------------------------------------------

    def _switch(self, crossing: _Crossing) -> None:
        """Follow what leaves a branch point and is not known."""
        try:
            crossing.starts = [symmetric(p) for p in switch(crossing.event, self.window)]
        except (NoConvergence, ValueError) as failure:
            crossing.reason, self.complete = str(failure), False
            return
        low, high = self.window
        for start in crossing.starts:
            number = self._known(start)
            if number is None and len(self.branches) >= self.most:
                crossing.reason, self.complete = f"most, {self.most} branches, reached", False
                return
            if number is None:
                up = start.tangent is None or start.tangent[-1] > 0
                own = self._followed(start, (high, low) if up else (low, high))
                number = self._add(_from(crossing.event.point, start).joined(own))
            if number != crossing.branch and number not in crossing.leaving:
                crossing.leaving.append(number)

    # --- the table ----------------------------------------------------------------------------------------------------

    def _singular(self, p: Point) -> None:
        """Say so where a start itself is a fold or branch point, which no step from it meets."""
        if p.nullity:
            self.complete = False
            reason = "the start is singular: begin at another load to know what leaves there"
            self.rows.append(Special("branch point", p.lam, np.inf, len(self.branches) - 1, reason=reason))

    def _table(self) -> Iterator[Special]:
        yield from self.rows
        for i, branch in enumerate(self.branches):
            for event, index in zip(branch.events, pairwise([*branch.indices(), None]), strict=True):
                yield self._row(i, event, index)

    def _row(self, i: int, event: Event, index: tuple[int | None, int | None]) -> Special:
        about = (event.lam, event.error, i, index, event.multiplicity)
        if event.kind != "branch point":
            return Special(event.kind, *about, reason=event.reason, event=event)
        crossing = next(c for c in self.crossings if c.branch == i and c.event.null is event.null)
        kind = kind_of(event, crossing.starts, index)
        return Special(kind, *about, tuple(sorted(crossing.leaving)), event.reason or crossing.reason, event)


def _from(origin: Point, start: Point) -> Branch:
    """The first step of a half-branch, from its branch point; its tangent there by the parabola through both."""
    curve = Curve(start.equations)
    first, last = np.append(origin.u, origin.lam), np.append(start.u, start.lam)
    chord = (last - first) / curve.norm(last - first)
    assert start.tangent is not None
    t = 2 * chord - start.tangent / curve.norm(start.tangent)
    begin = replace(origin, tangent=t / curve.norm(t), accepted="")
    end = Event("end", start.lam, 0.0, start, where=1.0)
    return Branch([begin, start], [end], f"branch point at lam = {origin.lam:.9g}")
