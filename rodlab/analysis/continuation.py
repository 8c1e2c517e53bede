"""A branch as a stream of points, each step shown to stay on it [N 2.7, Parameter Continuation; Keller 1977].

    predict    along the cubic through the last two points and their tangents, of the fourth order in the step
    correct    by Newton's method in the plane across the branch (arclength) or at the predicted load (natural)
    show       that the step is a piece of one branch: proved, or checked
    adapt      the length to the error of the prediction

A step is *proved* where `rodlab.analysis.proof` covers all of it. What stays open - around branch points, or all of it where the
model knows no bounds - is *checked*: the solution half-way is where the cubic says, the tangent turns little, the
corrections shrink, and a change of the index is explained by eigenvalues found to cross zero. A step of which neither holds
is halved.
"""

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from rodlab.analysis.crossings import Locator, Place
from rodlab.analysis.curve import Corrected, Curve, Segment
from rodlab.analysis.derivatives import check_derivatives
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.proof import Prover
from rodlab.analysis.shown import Inspector, Open, Patience, Unverified, Window
from rodlab.numerics.arrays import Array, number
from rodlab.numerics.inertia import Inertia
from rodlab.numerics.nullspace import near_null

GROWTH = 3.0  # longest step after a step
MOST = 200  # lengths tried for one step
REFUSED = 8  # refusals for open parts, step after step, before what stays open is checked instead
MESHES = 20  # tried for one step
UNVERIFIED = 3  # ends without a verified index before one is accepted
SHORTEST = 1e-11  # of the size of the point: no shorter step is tried


class Step(NamedTuple):
    """One accepted step: the segment, its ends, what was shown, and the point it arrived at."""

    segment: Segment
    a: Place
    b: Place
    proved: bool
    windows: tuple[Window, ...]
    point: Point


def branch(
    p: Point, step: float = 0.1, *, toward: float | None = None, natural: bool = False, scale: float | None = None,
    bare: bool = False,
) -> Iterator[Point]:  # fmt: skip
    """The points of the branch through p, p itself left out: endless and lazy.

    step: first and longest length of a step, |.|^2 = inner(du, du) + (dlam / scale)^2, scale 1 unless given. Direction: the
    point's tangent if it has one, else of growing load, or towards the load `toward`. natural: steps in the load alone,
    which end at a fold.
    Each point tells how its step was accepted: `p.proved` or `p.checked`. bare: neither; steps are taken as other codes take
    them, by their prediction and corrections alone, on the mesh of p: several times as fast, and as easily on another branch.
    Raises `NoConvergence` where the branch can be followed no further; `ValueError` for wrong arguments or derivatives.

    >>> from itertools import islice
    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.mechanics.strut import Strut
    >>> [round(q.lam, 3) for q in islice(branch(equilibrium(Strut(n=10, u_hat=0.1), 0.0), 0.5), 4)]
    [0.5, 0.807, 1.189, 1.552]
    """
    walk = Walk(p, step=number("step", step, above=0.0), toward=toward, natural=natural, scale=scale, bare=bare)
    return _points(walk)


def _points(walk: "Walk") -> Iterator[Point]:
    while True:
        yield walk.advance().point


class Pace(NamedTuple):
    """How far a step may go: least cosine between the tangents at its ends, greatest error of its prediction as a part of its
    length, and the error that the next step aims at.
    """

    turn: float
    miss: float
    aim: float


CAREFUL, BARE = Pace(0.8, 0.1, 0.01), Pace(0.3, 1.0, 0.3)


class Remeshed(NoConvergence):
    """The mesh did not serve at the end of the step; the same step is tried again on a better one."""


class Walk:
    """Where a continuation stands: the last point with its tangent, the point before, and the length of the next step."""

    def __init__(
        self, p: Point, *, step: float | None, toward: float | None = None, natural: bool = False, scale: float | None = None,
        bare: bool = False,
    ) -> None:  # fmt: skip
        if not isinstance(p, Point):
            raise ValueError(f"p must be a Point, as equilibrium returns it; it is {p!r:.60}")
        self.longest = math.inf if step is None else min(number("step", step, above=0.0), 1e100)
        size = _scale(p, step, toward) if scale is None else number("scale", scale, above=0.0)
        self._stand_on(Curve(p.equations, size, wide=not bare))
        self.natural, self.bare, self.pace = natural, bare, BARE if bare else CAREFUL
        if not bare:
            check_derivatives(p.equations, p.u, p.lam)
        y = np.append(p.u, p.lam)
        self.here = Place(y, self._start(p, y, toward), None if bare else self.curve.index(y))
        self.before: Place | None = None
        self.refused = 0  # refusals for open parts since a step was shown at its first length
        self.length = min(self.longest, self._first(p, toward))
        self.coarser: Any = None  # the equations on a coarser mesh that serves as well, for the next step

    def _stand_on(self, curve: Curve) -> None:
        self.curve = curve
        self.prover, self.locator = Prover(self.curve), Locator(self.curve)
        self.inspector = Inspector(self.prover, self.locator)

    # --- meshes ------------------------------------------------------------------------------------------------

    def _serves(self, y: Array, t: Array) -> None:
        """Raise `Remeshed` where the mesh does not serve at a new point, having moved to one that does; note a coarser one."""
        adapted = getattr(self.curve.equations, "adapted", None)
        better = None if adapted is None else adapted(y[:-1], float(y[-1]), t)
        self.coarser = None
        if better is None:
            return
        if better[1].size < y.size - 1:
            self.coarser = better[0]
            return
        self._move_to(better[0])
        raise Remeshed("the mesh was too coarse for the end of the step", ())

    def _move_to(self, equations: Any) -> None:
        """Take the last two points along to the same equations on another mesh; raises `NoConvergence`, all as it was."""
        old, here, before = self.curve.equations, self.here, self.before
        curve = Curve(equations, self.curve.scale)
        t = carried(old, equations, here.tangent, direction=True)
        y = curve.correct(carried(old, equations, here.y), curve.row(t)).y
        self.here = Place(y, curve.tangent(y, t), curve.index(y))
        if before is not None:
            past = carried(old, equations, before.tangent, direction=True)
            self.before = Place(carried(old, equations, before.y), past, before.index)
        self._stand_on(curve)

    def _start(self, p: Point, y: Array, toward: float | None) -> Array:
        if p.tangent is not None:
            return np.asarray(p.tangent / self.curve.norm(p.tangent))
        ahead = np.zeros_like(y)
        ahead[-1] = 1.0 if toward is None or toward >= p.lam else -1.0
        try:
            return self.curve.tangent(y, ahead)
        except NoConvergence:  # at a fold the tangent is the null vector
            near = near_null(self.curve.jacobian(y), 1, symmetric=self.curve.symmetric(y))
            return self.curve.tangent(y, np.append(near.right[:, 0], 0.0))

    def _first(self, p: Point, toward: float | None) -> float:
        """A first length: that given, else a small part of the way."""
        if math.isfinite(self.longest):
            return self.longest
        way = abs(toward - p.lam) / self.curve.scale / 20 if toward is not None and toward != p.lam else 0.1
        return min(0.1, way)

    def row(self, t: Array) -> Array:
        """The plane of the corrector: across the branch, or at one load."""
        if not self.natural:
            return self.curve.row(t)
        row = np.zeros_like(t)
        row[-1] = np.sign(t[-1]) / self.curve.scale
        return row

    def advance(self) -> Step:
        """Take one step. Raises `NoConvergence` when none is short enough to be shown."""
        if self.coarser is not None:
            with suppress(NoConvergence):
                self._move_to(self.coarser)
            self.coarser = None
        s, least = self.length, SHORTEST * max(1e-3, self.curve.norm(self.here.y))
        why: NoConvergence | None = None
        opened = unverified = meshes = 0  # refusals of this step
        for _ in range(MOST):
            if s < least and why is not None:
                break
            try:
                step = self._tried(s, Patience(self.refused + opened < REFUSED, unverified < UNVERIFIED))
            except Remeshed as failure:
                why, meshes = failure, meshes + 1
                s *= 1.0 if meshes < MESHES else 0.5
            except NoConvergence as failure:
                why = failure
                opened += isinstance(failure, Open)
                unverified += isinstance(failure, Unverified)
                s *= 0.8 if isinstance(failure, Unverified) else 0.5
            else:
                lenient = any(not w.fold and not w.crossings for w in step.windows)
                self.refused = self.refused + opened if opened or lenient else 0
                return step
        at = f"lam = {self.here.y[-1]:.9g}"
        fold = "; natural continuation ends at a fold" if self.natural else ""
        raise NoConvergence(f"the branch cannot be followed beyond {at}: {why}{fold}", () if why is None else why.history)

    # --- one attempt -------------------------------------------------------------------------------------------

    def _tried(self, s: float, patience: Patience) -> Step:
        here, curve = self.here, self.curve
        row = self.row(here.tangent)
        guess = self._predicted(s, row)
        found = curve.correct(guess, row)
        miss = self._miss(found.y, guess, s)
        if miss > self.pace.miss:
            raise NoConvergence(f"the prediction was wrong by {miss:.2g} of the step", found.history)
        segment = Segment(
            here.y, here.tangent, found.y, curve.tangent(found.y, here.tangent, found.solver if self.bare else None), row
        )
        if not self.bare:
            self._serves(found.y, segment.tb)
        turn = curve.dot(here.tangent, segment.tb)
        if not turn > self.pace.turn:
            raise NoConvergence(f"the tangent turned by {math.degrees(math.acos(max(-1.0, min(1.0, turn)))):.0f} degrees", ())
        step = self._taken(segment, found) if self.bare else self._shown(segment, found, patience)
        self.before, self.here = here, step.b
        self.length = min(self.longest, s * min(GROWTH, max(0.3, (self.pace.aim / max(miss, 1e-12)) ** (1 / 3))))
        return step

    def _miss(self, y: Array, guess: Array, s: float) -> float:
        """Error of the prediction as a part of the step; that of the unknowns by itself, lest long steps in the load hide it."""
        curve, off = self.curve, y - guess
        moved, here = y - self.here.y, self.here.y.copy()
        off[-1] = moved[-1] = here[-1] = 0.0
        unknowns = curve.norm(off) / (2 * curve.norm(moved) + 0.1 * curve.norm(here) + 0.1 * min(s, 1.0))
        return max(curve.norm(y - guess) / s, unknowns)

    def _predicted(self, s: float, row: Array) -> Array:
        here, before = self.here, self.before
        if before is None:
            return np.asarray(here.y + (s / (row @ here.tangent)) * here.tangent)
        past = Segment(before.y, before.tangent, here.y, here.tangent, row)
        return past.at(past.length + s)

    def _taken(self, segment: Segment, found: Corrected) -> Step:
        """The step as it is, nothing shown."""
        end = Place(segment.b, segment.tb, None)
        point = Point(
            self.curve.equations, float(segment.b[-1]), segment.b[:-1].copy(), found.history, found.remaining, tangent=segment.tb
        )
        return Step(segment, self.here, end, False, (), point)

    def _shown(self, segment: Segment, found: Corrected, patience: Patience) -> Step:
        """The step with what was shown of it. Raises `NoConvergence` when it is not explained."""
        end = self.curve.index(segment.b) if self.here.index is not None and self.prover.proves else None
        spans = self.prover.spans(segment, hasty=end is not None and end == self.here.index)
        last = spans[-1]
        if not self.prover.proves:
            self.inspector.smooth(segment)
        index = last.index if last.kind == "regular" else end if end is not None else self.curve.index(segment.b)
        a, b = self.here, Place(segment.b, segment.tb, index)
        if a.index is None and spans[0].index is not None:
            a = replace(a, index=spans[0].index)
        windows, shown = self.inspector.explain(segment, a, b, spans, patience)
        return self._step(segment, found, index, shown and self.prover.proves, tuple(windows))

    def _step(self, segment: Segment, found: Corrected, index: int | None, proved: bool, windows: tuple[Window, ...]) -> Step:
        inertia = None
        own = hasattr(self.curve.equations, "inertia")  # where meshes are compared for it
        if proved and not own and index is not None and not (windows and windows[-1].b.y is segment.b):
            inertia = Inertia(index, 0, segment.b.size - 1 - index)  # shown for all solutions near by, the exact one among them
        point = Point(
            self.curve.equations, float(segment.b[-1]), segment.b[:-1].copy(), found.history, found.remaining,
            tangent=segment.tb, accepted="proved" if proved else "checked", known_inertia=inertia,
        )  # fmt: skip
        return Step(segment, self.here, Place(segment.b, segment.tb, index), proved, windows, point)


def carried(old: Any, new: Any, y: Array, *, direction: bool = False) -> Array:
    """y = (u, lam), or a direction, of the same equations on another mesh."""
    if old is new or not hasattr(new, "moved"):
        return y
    return np.append(new.moved(old, y[:-1], direction=direction), y[-1])


def _scale(p: Point, step: float | None, toward: float | None) -> float:
    """1 where a length is given in it; else a tenth of the loads in question, so that loads and unknowns weigh alike."""
    loads = max(abs(p.lam), abs(toward or 0.0)) / 10
    return loads if step is None and loads > 1e-100 else 1.0
