"""An eigenvalue that only touches zero: a branch point at which the index does not change, as a pitchfork met on its side branch.

Next to it the eigenvalue is a parabola, mu = c sigma^2. On a side branch the load turns in the same place; where it does
not, two branches cross and the eigenvalue turns. Either gives the place; that it *is* zero there, to rounding, and that
F_lam lies in the range of J, makes it a branch point and no near miss. With F_lam outside of it and a load that goes on it
is a cusp: two folds that have just met, or will, as another parameter changes.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from rodlab.analysis.crossings import Crossing, Locator, Place, change
from rodlab.analysis.curve import Curve, Segment
from rodlab.analysis.newton import NoConvergence
from rodlab.numerics.arrays import EPS
from rodlab.numerics.nullspace import near_null

INSIDE = 1e-5  # part of F_lam along the null vectors below which it is in the range of J
WIDE, NARROW = 1e-2, 0.05  # half-width of the first fence and of the next, as parts of the last
ZERO = 1e-3  # an eigenvalue at the touching point over that at the fence


def touching(locator: Locator, left: Place, right: Place) -> Crossing | None:
    """The touching zero between two places of one index, or None."""
    segment = locator.segment(left, right)
    turns = _turns(left, right)
    where = _turning_load if turns else _turning_eigenvalue(locator.curve)
    sigma = where(segment)
    width = WIDE * segment.length
    try:
        for _ in range(3):
            if sigma is None:
                return None
            places = [locator.place(segment, min(max(sigma + side * width, 0.0), segment.length)) for side in (-1, 1)]
            segment = locator.segment(*places)
            sigma = where(segment)
            width = NARROW * segment.length
    except NoConvergence:
        return None
    found = None if sigma is None else _at(segment, sigma, locator)
    cusp = found is not None and not turns and found.multiplicity == 1
    return found if found is None or cusp or not outside(locator.curve, found) else None


def outside(curve: Curve, crossing: Crossing) -> int:
    """1 where F_lam has a part along the left null vectors: the load turns; 0 where it is in the range of J."""
    f = [curve.d_lam(y) for y in (crossing.y, crossing.fence.a, crossing.fence.b)]
    size = max(float(np.sqrt(g @ g)) for g in f)
    part = crossing.null.left.T @ f[0]
    return int(float(np.sqrt(part @ part)) > INSIDE * size) if size > 0 else 0


def root(f: Callable[[float], float], low: float, high: float) -> float:
    """A zero between low and high, where f has different signs; the nearer end where it has not, by rounding."""
    at = f(low), f(high)
    if at[0] * at[1] >= 0:
        return low if abs(at[0]) < abs(at[1]) else high
    return float(brentq(f, low, high, xtol=4 * EPS * max(abs(low), abs(high)), rtol=8 * EPS))


def _turns(left: Place, right: Place) -> bool:
    return float(left.tangent[-1]) * float(right.tangent[-1]) < 0


def _turning_load(segment: Segment) -> float | None:
    """Where the load of the cubic is stationary."""
    ends = segment.rates(np.array([0.0, 1.0]))
    if ends[0] * ends[1] >= 0:
        return None
    return segment.length * root(lambda x: float(segment.rates(np.asarray(x))), 0.0, 1.0)


def _turning_eigenvalue(curve: Curve) -> Callable[[Segment], float | None]:
    """Where the eigenvalue nearest zero is stationary along the cubic."""

    def where(segment: Segment) -> float | None:
        def rate(x: float) -> float:
            y = segment.at(x * segment.length)
            near = near_null(curve.jacobian(y), 1, symmetric=curve.symmetric(y))
            return float(change(curve, segment, x * segment.length, near, 1e-3)[0, 0]) * float(np.sign(near.values[0]) or 1.0)

        return segment.length * root(rate, 0.02, 0.98) if rate(0.02) * rate(0.98) < 0 else None

    return where


def _at(fence: Segment, sigma: float, locator: Locator) -> Crossing | None:
    curve = locator.curve
    y = fence.at(sigma)
    symmetric = curve.symmetric(y)
    end = abs(float(near_null(curve.jacobian(fence.a), 1, symmetric=symmetric).values[0]))
    here = near_null(curve.jacobian(y), min(3, y.size - 1), symmetric=symmetric)
    p = int((np.abs(here.values) <= ZERO * end).sum())
    if p == 0:
        return None
    crossing = locator.crossing(fence, sigma, p, 1e-15, p)
    off = float(np.sqrt(abs(here.values[p - 1]) / end)) * fence.length  # the eigenvalue is quadratic in it
    slopes = fence.rates(np.array([0.0, 1.0, sigma / fence.length]))
    bend = abs(float(slopes[1] - slopes[0])) / fence.length
    return crossing._replace(touches=True, error=crossing.error + abs(float(slopes[2])) * off + bend * off**2)
