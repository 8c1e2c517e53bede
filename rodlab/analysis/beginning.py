"""The part of a half-branch between its branch point and its start, which no step of a continuation looks at.

On it the load is a parabola in the distance, as the solutions a half and a quarter of the way must tell; the index does not
change, and where one eigenvalue crosses zero it is that of the followed branch on the other side of the branch point: exchange of
stability [Crandall and Rabinowitz 1973]. Else a fold or branch point lies between, and the start is taken nearer.
"""

import numpy as np

from rodlab.analysis.curve import Corrected, Curve
from rodlab.analysis.events import Event
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.numerics.arrays import EPS, Array

LEAST = 1e-6  # distance of a start, in the length of the equations
SHARE = 0.02  # of the window of loads: no start is farther from its branch point
STILL = 1e-9  # unknowns that change by less are at rest


class Beginning:
    """The part of a half-branch before its start, looked at; a nearer start where something happens on it."""

    def __init__(
        self, curve: Curve, y: Array, event: Event, beside: tuple[int | None, int | None],
        within: tuple[float, float] | None,
    ) -> None:  # fmt: skip
        self.curve, self.y, self.within, self.error = curve, y, within, event.error
        self.crowded = False  # another branch point lies next to this one
        self.exchanged = self._exchanged(event, beside)

    def _exchanged(self, event: Event, beside: tuple[int | None, int | None]) -> dict[bool, int]:
        """The index that a half-branch to higher loads (True) or lower ones has: that of the followed branch on the other side.

        Exchange of stability [Crandall and Rabinowitz 1973], where one eigenvalue crosses zero as the load grows; else unknown.
        """
        fence = event.fence
        assert fence is not None
        low, high = beside if fence.a[-1] < fence.b[-1] else beside[::-1]
        passes = (fence.a[-1] - self.y[-1]) * (fence.b[-1] - self.y[-1]) < 0
        if event.multiplicity != 1 or not passes or low is None or high is None:
            return {}
        self.crowded = abs(low - high) > 1 and self.curve.has_index(self.y)
        return {True: low, False: high} if abs(low - high) == 1 else {}

    def start(self, p: Point) -> Point:
        """The start, or one nearer to the branch point; where none is near enough the start itself.

        Within a window `NoConvergence` then: what is between would be missed.
        """
        first, far = p, np.append(p.u, p.lam)
        while not self.crowded and self.curve.norm(far - self.y) >= LEAST:
            half, quarter = self._part(far, 0.5), self._part(far, 0.25)
            if half is not None and quarter is not None and self._inside(far) and self._plain(far, half.y, quarter.y):
                return p
            if quarter is None:
                break
            far = quarter.y
            t = self.curve.tangent(far, far - self.y)
            p = Point(p.equations, float(far[-1]), far[:-1].copy(), quarter.history, quarter.remaining, t, "checked")
        if self.within is None:
            return first
        at = f"lam = {self.y[-1]:.12g}"
        if self.crowded:
            raise NoConvergence(f"another branch point lies next to the one at {at}", first.newton)
        raise NoConvergence(f"what leaves at {at} is singular again, or leaves the window, next to it", first.newton)

    def _part(self, far: Array, part: float) -> Corrected | None:
        """The solution at a part of the way, across the way; None where there is none."""
        away = np.append(far[:-1] - self.y[:-1], 0.0)
        size = self.curve.norm(away)
        if size <= STILL * max(1.0, self.curve.norm(np.append(far[:-1], 0.0))):  # nothing but the load changes
            away, size = far - self.y, self.curve.norm(far - self.y)
        guess = self.y + part * (far - self.y)
        try:
            return self.curve.correct(guess, self.curve.row(away / size), limit=12)
        except NoConvergence:
            return None

    def _inside(self, far: Array) -> bool:
        """True within the window, and where no window is given."""
        if self.within is None:
            return True
        low, high = self.within
        return low <= far[-1] <= high and abs(float(far[-1] - self.y[-1])) <= SHARE * (high - low)

    def _plain(self, far: Array, half: Array, quarter: Array) -> bool:
        """No change of index on the way, and a load that the parabola through the ends and the middle tells at a quarter."""
        found = {self.curve.index(y) for y in (far, half, quarter)}
        if len(found) > 1 or self.exchanged.get(bool(far[-1] > self.y[-1]), None) not in (None, *found):
            return False
        d, e, f = (float(y[-1] - self.y[-1]) for y in (far, half, quarter))
        bend, slope = 2 * d - 4 * e, 4 * e - d
        noise = 64 * EPS * (abs(float(self.y[-1])) + abs(d)) + 4 * self.error
        wrong = abs(f - (bend / 16 + slope / 4))
        turn = -slope / (2 * bend) if bend else np.inf
        turns = 0 < turn < 1 and abs(slope) > 20 * (wrong + noise)  # by more than terms of the third and fourth power explain
        return wrong <= 0.05 * max(abs(d), abs(e)) + noise and not turns
