"""What a sequence of answers says of its method: observed order, rounding floor, limit, growth of cost.

    e(n) = C n^-p (1 + c n^-q + ...)      p_i = log(e_{i-1} / e_i) / log(n_i / n_{i-1}) = p + c' n_i^-q + ...

Observed orders p_i settle with n until rounding takes over. The order told is that of the last pair that is clear, extrapolated
by its own trend; its uncertainty is what that changed, how far the pair is apart, what the pair before would have told, and
what rounding of the errors can do to it.
Limits by Richardson's extrapolation [Joyce, SIAM Rev. 13 (1971) 435]; for errors in powers of h^q it is Neville's scheme in h^q.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from rodlab.numerics.arrays import Array, vector

CLEAR = 30.0  # times its noise an error must be to tell an order
FLAT = 10.0  # ratio of errors on a floor
NEAR = 100.0  # times rounding, within which few errors that do not fall are a floor
SETTLED = 0.1  # change of the observed order within which a method is said to have reached its own


class Observed(NamedTuple):
    """Order with its uncertainty (None where too few errors tell), local orders, and the floor: its level and first row.

    `local[i]` compares row i with the one before, None where rounding hides it; rows `first` to `last` have the order told.
    """

    order: float | None
    uncertainty: float | None
    local: tuple[float | None, ...]
    first: int | None
    last: int | None
    floor: float | None
    floor_from: int | None

    @property
    def clear(self) -> bool:
        """True when the order is known to a tenth."""
        return self.uncertainty is not None and self.uncertainty <= SETTLED


class Limit(NamedTuple):
    """The value that a sequence tends to, an estimate of its error, and the stages of extrapolation that gave it."""

    value: float
    estimate: float
    stages: int


class Growth(NamedTuple):
    """cost = c n^exponent from size `first` on, with the exponent's standard error; None where overhead hides growth."""

    exponent: float | None
    uncertainty: float | None
    first: float | None


def observed_order(
    sizes: Sequence[float], errors: Sequence[float], noise: Sequence[float] | float = 0.0, step: int = 1
) -> Observed:
    """The order in 1/size of errors (m,) at ascending sizes (m,); `noise` of the errors (m,), powers of 1/size `step` apart.

    >>> n = np.array([4, 8, 16, 32, 64])
    >>> found = observed_order(n, 3 / n**2 + 1 / n**3)
    >>> round(found.order, 3), found.uncertainty < 0.02, found.floor
    (2.0, True, None)
    """
    n, e = _checked(sizes, errors)
    level = np.broadcast_to(np.asarray(noise, dtype=np.float64), e.shape)
    below = _floor_from(e, level)
    floor = None if below is None else float(e[below:].max())
    level = np.maximum(level, 0.0 if floor is None else floor)
    clear = (e > CLEAR * level) & (e > 0)
    usable = int(np.argmin(clear)) if not clear.all() else len(e)  # rows before the first unclear one
    local: list[float | None] = [None] * len(e)
    for i in range(1, usable):
        local[i] = float(np.log(e[i - 1] / e[i]) / np.log(n[i] / n[i - 1]))
    known = [p for p in local if p is not None]
    if len(known) < 2:
        only = known[0] if known else None
        return Observed(only, None, tuple(local), 0 if known else None, 1 if known else None, floor, below)
    order, uncertainty, at = _told(n, e, level, known, step)
    first = last = at
    while first > 1 and _near(local[first - 1], order):
        first -= 1
    while last + 1 < usable and _near(local[last + 1], order):
        last += 1
    return Observed(order, uncertainty, tuple(local), first - 1, last, floor, below)


def _floor_from(e: Array, level: Array) -> int | None:
    """The row from which errors only fluctuate, within FLAT of the last two; None where they fall to the end.

    Fewer than four rows are a floor only where rounding is near.
    """
    last = float(e[-2:].max())
    tail = next(i for i in range(len(e)) if e[i:].max() <= FLAT * last)
    first = next((i for i in range(tail, len(e) - 1) if e[i] <= e[i + 1]), None)
    if first is None or (len(e) - first < 4 and e[first:].max() > NEAR * float(level[first:].max())):
        return None
    return first


def _told(n: Array, e: Array, level: Array, local: Sequence[float], step: int) -> tuple[float, float, int]:
    """(order, uncertainty, row): of the last pair of local orders that is clear and that no later one contradicts.

    With e = C n^-p (1 + c n^-q) the local orders are p + c g, g the change of n^-q over that of log n.
    """
    g = -np.diff(n ** -float(step)) / np.diff(np.log(n))
    told: list[tuple[float, float, int]] = []
    guesses = [local[i] + (local[i] - local[i - 1]) * g[i] / (g[i - 1] - g[i]) for i in range(1, len(local))]
    for i in range(len(local) - 1, 0, -1):
        guess = float(guesses[i - 1])
        spread = abs(guess - local[i]) + abs(local[i] - local[i - 1])
        spread += abs(guess - float(guesses[i - 2])) if i > 1 else 0.0
        rounding = sum(level[j] / e[j] for j in (i - 1, i, i + 1)) / np.log(n[i + 1] / n[i])
        found = guess, float(spread + rounding), i + 1
        told.append(found)
        if found[1] <= SETTLED and all(abs(later - guess) <= SETTLED + found[1] for later in local[i + 1 :]):
            return found
    return told[0]


def _near(local: float | None, order: float) -> bool:
    return local is not None and abs(local - order) <= SETTLED


def richardson(
    sizes: Sequence[float], values: Sequence[float], order: int, step: int, rounding: float = 0.0, stages: int | None = None
) -> tuple[Limit, list[list[float]]]:
    """The limit of values (m,) whose errors have the powers order, order + step, ... of 1/size, and the columns of the scheme.

    The estimate is the larger of what the last stage and the last size changed, and what rounding becomes in it; stages end
    when it no longer falls.
    Column k begins at row k. With step != order the sizes must have one ratio beyond the first stage.

    >>> limit, columns = richardson([1, 2, 4], [2.0, 1.5, 1.25], order=1, step=1)
    >>> limit, columns[1]
    (Limit(value=1.0, estimate=0.0, stages=2), [1.0, 1.0])
    """
    n, v = _checked(sizes, values)
    columns, column, power = [list(map(float, v))], v, order
    best, estimate, used, growing = float(v[-1]), np.inf, 0, rounding
    for k in range(1, len(v) if stages is None else min(stages + 1, len(v))):
        ratio = (n[k:] / n[:-k]) ** step if order == step else (n[k:] / n[k - 1 : -1]) ** power
        growing *= float((ratio[-1] + 1) / (ratio[-1] - 1))
        column = column[1:] + np.diff(column) / (ratio - 1)
        columns.append(list(map(float, column)))
        slow = max(1.0, float(1 / (ratio[-1] - 1)))  # sizes that are near each other change little
        change = max(abs(float(column[-1]) - best), *(slow * np.abs(np.diff(column[-2:]))), 0.0) + growing
        if change < estimate:
            best, estimate, used = float(column[-1]), change, k
        elif stages is None:
            break  # further stages only turn rounding over
        power += step
    return Limit(best, float(estimate), used), columns


def growth(sizes: Sequence[float], costs: Sequence[float]) -> Growth:
    """How a cost grows with size: its exponent by least squares from where it is thrice its least, over three sizes at least.

    >>> n = 10.0 ** np.arange(1, 7)
    >>> found = growth(n, 1e-3 + 1e-6 * n)
    >>> found.first, 0.9 < found.exponent < 1.0
    (10000.0, True)
    """
    n, cost = _checked(sizes, costs)
    above = np.flatnonzero(cost < 3 * cost.min())
    first = int(above[-1]) + 1 if cost.min() > 0 else len(n)
    if len(n) - first < 3:
        return Growth(None, None, None)
    x, y = np.log(n[first:]), np.log(cost[first:])
    slope = float(np.polyfit(x, y, 1)[0])
    left = y - y.mean() - slope * (x - x.mean())
    spread = np.sqrt(float(left @ left) / (len(x) - 2) / float((x - x.mean()) @ (x - x.mean())))
    return Growth(slope, float(spread), float(n[first]))


def _checked(sizes: Sequence[float], values: Sequence[float]) -> tuple[Array, Array]:
    n = vector("sizes", sizes)
    if not n.size or n[0] <= 0 or any(b <= a for a, b in pairwise(n)):
        raise ValueError(f"sizes must be positive and ascending; they are {list(sizes)!r:.60}")
    return n, vector("values", values, n.size)
