"""All equilibria of a strut at a load, with proof: the circle of tip angles covered by boxes, each decided by enclosures.

    no whole turn in phi_0(box) - phi0               no equilibrium
    0 not in psi_0(box): phi_0 is monotone           as many as whole turns between its ends, each the only one between
    neither                                          two halves

Boxes that stay open though all angles in them agree to a millionth hold an equilibrium that is degenerate, several next to each
other, or none but nearly one: a cluster. Cost: boxes times n; the boxes grow with the number of equilibria, and with the load.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from rodlab.mechanics.recurrence import CUTS, Recurrence, index_of, precision
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array
from rodlab.numerics.balls import Balls, balls

FIRST = 16  # boxes to begin with
CLOSE = 1e-6  # angles that agree to this are not told apart
SHARP = 1e-17  # radius of the angles of an equilibrium
SLOW = 0.6  # an interval Newton step that shrinks its box by less is replaced by half the box
LOOPS = 400
NEWTON = 40
COST = 2  # boxes that a root is worth


@dataclass(frozen=True, eq=False)
class Root:
    """Angles (n,) of an equilibrium within `radius`, rounding to floats in it; its index, None where not proved to be alone."""

    phi: Array
    radius: float
    index: int | None


@dataclass
class Cover:
    """What the boxes showed. `complete`: everywhere; else `boxes` of them did not suffice."""

    method: str
    roots: list[Root] = field(default_factory=list)
    clusters: list[Root] = field(default_factory=list)
    boxes: int = 0
    complete: bool = True


def cover(strut: Strut, lam: float, *, most: int, engine: str | None = None) -> Cover:
    """Every equilibrium at the load, each proved to exist and to be alone in its box, and where a proof stays open.

    most: boxes before giving up, a root being worth two. Raises `ValueError` for terms that the map does not know, and
    `ArithmeticError` where no sensible precision would do.

    >>> found = cover(Strut.from_joints(k=[1.0, 1.0]), 3.0, most=1000)
    >>> [(root.phi.round(3).tolist(), root.index) for root in found.roots]
    [([0.0, 0.0], 2), ([-0.986, 0.53], 1), ([0.986, -0.53], 1), ([2.445, 2.967], 0), ([-2.445, -2.967], 0)]
    """
    with balls(precision(strut, lam), engine) as numbers:
        search = _Search(Recurrence(strut, lam, numbers), numbers, most)
        search.run()
        return search.found


class _Search:
    """A cover in the making: boxes on a stack, what they showed in `found`."""

    def __init__(self, map_: Recurrence, numbers: Balls, most: int) -> None:
        self.map, self.numbers, self.most = map_, numbers, most
        self.found = Cover(numbers.name)

    def run(self) -> None:
        number, two_pi = self.numbers.number, self.numbers.two_pi
        if self.map.odd:  # -a is the mirror image of a
            low, high = self._middle(), two_pi / 2
        else:
            cut = next((a for a in CUTS if not self.numbers.has_integer(self._turns(self.map.end(number(a))[0]))), CUTS[0])
            low, high = number(cut), number(cut) + two_pi
        ends = [low + (high - low) * i / FIRST for i in range(FIRST)] + [high]
        open_: list[tuple[Any, Any]] = []
        stack = list(pairwise(ends))[::-1]
        while stack:
            if not self.found.complete or self.found.boxes + COST * len(self.found.roots) >= self.most:
                self.found.complete = False
                return
            open_ += self._decide(*stack.pop(), stack)
        self._clusters(open_)

    # --- one box ------------------------------------------------------------------------------------------------

    def _decide(self, low: Any, high: Any, stack: list[tuple[Any, Any]]) -> Iterator[tuple[Any, Any]]:
        """Roots of the box are kept; halves go onto the stack; the box is returned where it must stay open."""
        numbers, found = self.numbers, self.found
        found.boxes += 1
        box, angles, slopes, phi, psi = self._enclosed(low, high)
        if numbers.sign(psi[-1]):
            turns = self._whole_turns(low, high)
            if turns is not None:
                found.complete = found.boxes + COST * (len(found.roots) + len(turns)) <= self.most
                for j in turns if found.complete else ():
                    self._keep(box, j)
                return
        elif not numbers.has_integer(self._turns(angles[-1] + psi[-1] * (box - angles[0]))) or not numbers.has_integer(
            self._turns(phi[-1])
        ):
            return
        if self._reach(box, slopes) < CLOSE:
            yield low, high
            return
        middle = angles[0]
        stack += [(middle, high), (low, middle)]

    def _enclosed(self, low: Any, high: Any) -> tuple[Any, Sequence[Any], Sequence[Any], list[Any], list[Any]]:
        box = self.numbers.hull(low, high)
        a = self.numbers.middle(box)
        angles, slopes = self.map.thin(a)
        return box, angles, slopes, *self.map.wide(box, a, angles, slopes)

    def _turns(self, phi_0: Any) -> Any:
        return (phi_0 - self.map.phi0) / self.numbers.two_pi

    def _whole_turns(self, low: Any, high: Any) -> range | None:
        """The numbers of turns that phi_0 passes between two ends; None where one of them is too near a whole turn."""
        below, above = (self.numbers.floor(self._turns(self.map.end(end)[0])) for end in (low, high))
        if below is None or above is None:
            return None
        return range(min(below, above) + 1, max(below, above) + 1)

    def _middle(self) -> Any:
        """Keep the straight equilibrium, and return up to which angle it is the only one; a cluster where it is degenerate."""
        numbers, width = self.numbers, 0.1
        while True:
            box, _, slopes, phi, psi = self._enclosed(numbers.number(-width), numbers.number(width))
            self.found.boxes += 1
            index = index_of([numbers.sign(x) for x in slopes])
            alone = numbers.sign(psi[-1]) and numbers.sign(numbers.two_pi - phi[-1]) and numbers.sign(numbers.two_pi + phi[-1])
            zero = np.zeros(self.map.n)
            if alone and index is not None:
                self.found.roots.append(Root(zero, 0.0, index))
                return numbers.number(width)
            if self._reach(box, slopes) < CLOSE:
                self.found.clusters.append(Root(zero, width, None))
                return numbers.number(width)
            width /= 2

    def _reach(self, box: Any, slopes: Sequence[Any]) -> float:
        """How far any angle differs within a box, about."""
        return self.numbers.radius(box) * max(abs(self.numbers.value(slope)) for slope in slopes)

    # --- roots --------------------------------------------------------------------------------------------------

    def _keep(self, box: Any, turns: int) -> None:
        """The one root in a monotone box: where Newton's method arrives, if that is proved, else by intervals."""
        numbers, target = self.numbers, self.map.phi0 + self.numbers.two_pi * turns
        a, reach = self._newton(numbers.middle(box), target)
        near = a + numbers.number(0.0, reach)
        if numbers.holds(box, near):
            angles, slopes = self.map.thin(a)
            phi, psi = self.map.wide(near, a, angles, slopes)
            off, change = angles[-1] - target, psi[-1] * numbers.number(reach)
            index = index_of([numbers.sign(x) for x in psi])
            if numbers.sign(off + change) * numbers.sign(off - change) < 0 and index is not None:
                self._kept(self.found.roots, phi, turns, index)
                return
        self._halved(box, target, turns)

    def _newton(self, a: Any, target: Any) -> tuple[Any, float]:
        """A number next to the root, and how far a may be off so that no angle is off by more than SHARP."""
        numbers, reach = self.numbers, 0.0
        for _ in range(NEWTON):
            angles, slopes = self.map.thin(a)
            step = (angles[-1] - target) / slopes[-1]
            a = numbers.middle(a - step)
            reach = SHARP / max(abs(numbers.value(slope)) for slope in slopes)
            if abs(numbers.value(step)) < reach:
                break
        return a, reach

    def _halved(self, box: Any, target: Any, turns: int) -> None:
        """The interval Newton method, with half the box where that is slow."""
        numbers = self.numbers
        for _ in range(LOOPS):
            a = numbers.middle(box)
            angles, slopes = self.map.thin(a)
            phi, psi = self.map.wide(box, a, angles, slopes)
            index = index_of([numbers.sign(x) for x in psi])
            if max(numbers.radius(x) for x in phi) < SHARP and index is not None:
                self._kept(self.found.roots, phi, turns, index)
                return
            off, size = angles[-1] - target, numbers.radius(box)
            newton = a - off / psi[-1]
            if not numbers.radius(newton) < SLOW * size:
                side = numbers.sign(off) * numbers.sign(psi[-1])  # of a from the root
                newton = numbers.hull(a, a - side * numbers.number(2 * size))
            box = numbers.meet(box, newton)
        self._kept(self.found.clusters, phi, turns, None)

    def _kept(self, where: list[Root], phi: Sequence[Any], turns: int, index: int | None, radius: float = 0.0) -> None:
        numbers = self.numbers
        exact = [x - numbers.two_pi * turns for x in phi[-2::-1]]
        angles = np.array([numbers.value(x) for x in exact])
        radius = max(radius, *(numbers.radius(x - numbers.number(a)) for x, a in zip(exact, angles.tolist(), strict=True)))
        radius += float(np.spacing(np.abs(angles).max())) / 2
        where.append(Root(angles, radius, index))
        if self.map.odd:
            where.append(Root(-angles, radius, index))

    def _clusters(self, open_: Sequence[tuple[Any, Any]]) -> None:
        """Boxes that stayed open, neighbours as one."""
        numbers, groups = self.numbers, list[tuple[Any, Any]]()
        for low, high in open_:
            if groups and numbers.sign(low - groups[-1][1]) <= 0:
                low = groups.pop()[0]  # noqa: PLW2901
            groups.append((low, high))
        ends = (groups[0][0], groups[-1][1]) if len(groups) > 1 and not self.map.odd else None
        if ends and numbers.sign(ends[1] - ends[0] - numbers.two_pi) == 0:  # two that meet where the circle was cut
            low, _ = groups.pop()
            groups[0] = (low - numbers.two_pi, groups[0][1])
        straight = self.found.clusters[:1] if self.map.odd else []
        if straight and groups and abs(numbers.value(groups[0][0]) - straight[0].radius) < CLOSE:
            self.found.clusters[0] = Root(straight[0].phi, numbers.value(groups.pop(0)[1]), None)
        for low, high in groups:
            box, angles, slopes, *_ = self._enclosed(low, high)
            turns = round(numbers.value(self._turns(angles[-1])))
            self._kept(self.found.clusters, angles, turns, None, self._reach(box, slopes))
