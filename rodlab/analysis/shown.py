"""What is shown of a step: its spans, and an explanation for every part where the Jacobian may be singular.

regular, all of it           nothing can happen there: no window
fold, all of it              a window in which the load may turn, and nothing else
open, the index changes      eigenvalues that cross zero, each found; what lies beside them shown like a step of its own
open, the index stays        halved, the solutions half-way computed; an eigenvalue that only touches zero is found
open, nothing explains it    refused: the step is too long
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

from rodlab.analysis.crossings import Crossing, Locator, Place
from rodlab.analysis.curve import Curve, Segment
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.proof import Prover, Span
from rodlab.analysis.touching import outside, touching

PARTS = 2  # how often a step that stays open is halved, the solutions half-way computed
FINE = 2.0**-3  # the smallest part of such a half that is tried
SMOOTH = 1e-6  # how far half-way from the cubic, as a part of its length, without a further look
GAIN = 3.0  # how much nearer in the halves at least; 16 where the branch is smooth and the step short
HALFWAY = 2e-3  # how far half-way from the cubic, as a part of its length, where nothing better can be shown
TINY = 1e-5  # parts shorter than this, relative to the point, may stay open: rounding hides what is there


class Open(NoConvergence):
    """A part of the step could not be shown; a shorter one may be."""


class Unverified(NoConvergence):
    """The index at the end of a step is not certain; a step of another length may end where it is."""


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """A part of a step where the Jacobian may be singular: a fold at most, or the crossings that were found in it."""

    a: Place
    b: Place
    fold: bool
    crossings: tuple[Crossing, ...] = ()

    @property
    def turns(self) -> bool:
        """True when the load turns back between its ends."""
        return float(self.a.tangent[-1]) * float(self.b.tangent[-1]) < 0


class Patience(NamedTuple):
    """Whether a shorter step may still be asked for: to show an open part, to verify an index."""

    show: bool = True
    verify: bool = True


class Inspector:
    """Explains the parts of a step that are not regular, or refuses it."""

    def __init__(self, prover: Prover, locator: Locator) -> None:
        self.prover, self.locator, self.curve = prover, locator, locator.curve

    def explain(self, segment: Segment, a: Place, b: Place, spans: list[Span], patience: Patience) -> tuple[list[Window], bool]:
        """The windows of a step, in order, and whether all of it was shown; with no patience what cannot be shown is checked.

        Raises `NoConvergence` where a part cannot be explained.
        """
        open_somewhere = any(span.kind == "open" for span in spans)
        counted = a.index is not None and b.index is not None and self.curve.has_index(a.y)
        if open_somewhere and counted and all(span.index in (None, a.index) for span in spans) and a.index == b.index:
            windows = list(self._part(a, b, patience))  # from its ends again, that tubes may meet at solutions
            return windows, all(window.fold for window in windows)
        windows = list(self._grouped(segment, a, b, spans, patience))
        _orientation(a, b, windows, self.curve)
        return windows, not open_somewhere

    def smooth(self, segment: Segment) -> None:
        """Raise unless the solution half-way is where the cubic says, and those half-way to it ever better: no kink.

        The cubic is wrong by the fourth power of its length; a step from one branch to another is wrong by the first.
        """
        middle, off = self._off(segment)
        if off <= SMOOTH * abs(segment.length):
            return
        ends = Place(segment.a, segment.ta, None), middle, Place(segment.b, segment.tb, None)
        for a, b in pairwise(ends):
            _, half = self._off(self.locator.segment(a, b))
            if half > off / GAIN:
                raise NoConvergence(f"the branch has a kink: off its cubic by {off:.1g}, in a half of it still by {half:.1g}", ())

    def _off(self, segment: Segment) -> tuple[Place, float]:
        """The solution half-way, and how far beside the cubic it is."""
        middle = self.locator.place(segment, segment.length / 2)
        return middle, self.curve.norm(middle.y - segment.at(segment.length / 2))

    def _grouped(self, segment: Segment, a: Place, b: Place, spans: list[Span], patience: Patience) -> Iterator[Window]:
        for group in _groups(spans):
            left = a if group[0] is spans[0] else self._gate(segment, group[0].start, spans)
            right = b if group[-1] is spans[-1] else self._gate(segment, group[-1].stop, spans)
            if all(span.kind == "fold" for span in group):
                yield Window(left, right, fold=True)
            elif left.index is None or right.index is None:
                if left.index is not None and patience.verify:
                    raise Unverified("the index at the end of the step cannot be verified", ())
                self._halfway(left, right)
                yield Window(left, right, fold=False)
            elif not self.curve.has_index(left.y):
                crossings = tuple(self.locator.between(left, right))
                if not crossings:
                    self._halfway(left, right)
                yield Window(left, right, fold=False, crossings=crossings)
            else:
                yield from self._explained(left, right, patience)

    def _explained(self, left: Place, right: Place, patience: Patience) -> Iterator[Window]:
        crossings = self.locator.between(left, right)
        if not crossings:
            yield from self._part(left, right, patience)
            return
        last = left
        for crossing in crossings:
            fence = crossing.fence
            before, after = (Place(y, t, self.curve.index(y)) for y, t in ((fence.a, fence.ta), (fence.b, fence.tb)))
            yield from self._beside(last, before)
            yield Window(before, after, fold=False, crossings=(crossing,))
            last = after
        yield from self._beside(last, right)

    def _beside(self, left: Place, right: Place) -> Iterator[Window]:
        """A part between crossings: as near to one as the fence is, it may stay open."""
        if (
            self.curve.norm(right.y - left.y) > TINY * self.curve.norm(right.y)
            and float(self.curve.row(left.tangent) @ (right.y - left.y)) > 0
        ):
            yield from self._part(left, right, Patience(show=False))

    def _part(self, left: Place, right: Place, patience: Patience) -> Iterator[Window]:
        """A part whose index stays."""
        shown = self._by_parts(left, right, PARTS)
        if shown == {"regular"}:
            return
        if "open" not in shown:
            yield Window(left, right, fold=True)
            return
        touch = touching(self.locator, left, right)
        if touch is not None:
            yield Window(left, right, fold=False, crossings=(touch,))
            return
        window = Window(left, right, fold=False)
        if self.curve.norm(right.y - left.y) > TINY * max(1.0, self.curve.norm(right.y)):
            if patience.show or window.turns:
                raise Open("part of the step could not be shown to stay on the branch", ())
            for part in (0.25, 0.75):
                self._halfway(left, right, part)
        self._halfway(left, right)
        yield window

    def _by_parts(self, left: Place, right: Place, depth: int) -> set[str]:
        """What can be shown when the solution half-way is computed as well, and again in the halves."""
        middle = self._half(left, right)
        if middle.index != left.index:
            raise NoConvergence(f"the index is {middle.index} half-way between two places where it is {left.index}", ())
        kinds: set[str] = set()
        for a, b in ((left, middle), (middle, right)):
            piece = self.locator.segment(a, b)
            spans = self.prover.spans(piece, FINE, hasty=True)
            if all(span.kind == "regular" for span in spans) and float(a.tangent[-1]) * float(b.tangent[-1]) < 0:
                raise NoConvergence("the load turns on a part without a fold", ())
            if any(span.index not in (None, left.index) for span in spans):
                raise NoConvergence("the index changes and changes back within a step", ())
            shown = {str(span.kind) for span in spans}
            kinds |= self._by_parts(a, b, depth - 1) if "open" in shown and depth else shown
            if "open" in kinds:
                break
        return kinds

    def _gate(self, segment: Segment, sigma: float, spans: list[Span]) -> Place:
        """The solution at the end of a regular span, with the index shown there."""
        place = self.locator.place(segment, sigma)
        known = [s.index for s in spans if s.index is not None and sigma in (s.start, s.stop)]
        return replace(place, index=known[0]) if known else place

    def _half(self, left: Place, right: Place) -> Place:
        """The solution half-way; raises `NoConvergence` where it is not next to the cubic."""
        piece = self.locator.segment(left, right)
        return self.locator.place(piece, piece.length / 2)

    def _halfway(self, left: Place, right: Place, part: float = 0.5) -> None:
        """Raise unless the solution half-way is where the cubic says, with the same index."""
        piece = self.locator.segment(left, right)
        middle = self.locator.place(piece, part * piece.length)
        off = self.curve.norm(middle.y - piece.at(part * piece.length))
        if off > HALFWAY * abs(piece.length):
            raise NoConvergence(f"half-way the branch is {off / abs(piece.length):.1g} of the length beside its cubic", ())
        if left.index is not None and middle.index is not None and middle.index != left.index:
            raise NoConvergence("the index half-way is another", ())


def _orientation(a: Place, b: Place, windows: list[Window], curve: Curve) -> None:
    """Raise where the index and the way of the load contradict each other.

    dlam/dsigma is det J over the determinant of the bordered matrix, which changes its sign at branch points alone, by as
    many null vectors as F_lam leaves: the load turns where the index changes, and nowhere else.
    """
    crossings = [crossing for window in windows for crossing in window.crossings]
    if a.index is None or b.index is None or any(c.touches or not c.converged for c in crossings):
        return
    passed = sum(crossing.multiplicity - outside(curve, crossing) for crossing in crossings)
    turned = float(a.tangent[-1]) * float(b.tangent[-1]) < 0
    if (a.index + b.index + passed + turned) % 2:
        raise NoConvergence("the load turns where no eigenvalue crosses zero, or goes on where one does", ())


def _groups(spans: list[Span]) -> Iterator[list[Span]]:
    """Runs of spans that are not regular."""
    group: list[Span] = []
    for span in spans:
        if span.kind == "regular":
            if group:
                yield group
            group = []
        else:
            group.append(span)
    if group:
        yield group
