"""Buckling loads against n, for both rules: error, observed order, run time, and the extrapolated limit."""

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from rodlab.mechanics.buckling import buckling_each
from rodlab.mechanics.joints import RULES
from rodlab.mechanics.strut import Strut

ORDER = {"end": 1, "trapezoid": 2}


@dataclass(frozen=True)
class Load:
    """Load of a mode at n joints by a rule; `limit` is the exact load of the rod, `error` the distance from it."""

    rule: str
    mode: int
    n: int
    load: float
    bound: float
    limit: float
    seconds: float
    order: float | None

    @property
    def error(self) -> float:
        """|load - limit|, the discretisation's error."""
        return abs(self.load - self.limit)


@dataclass(frozen=True)
class Extrapolated:
    """The limit that the loads of one mode and rule point to, with an estimate of its error."""

    rule: str
    mode: int
    load: float
    estimate: float
    limit: float

    @property
    def error(self) -> float:
        """|load - limit|, to compare with the estimate."""
        return abs(self.load - self.limit)


def exact_load(mode: int) -> float:
    """((2j - 1) pi / 2)^2, the load of the uniform rod with K = 1 [N 2.8.1]."""
    return ((2 * mode - 1) * math.pi / 2) ** 2


def loads_against_n(sizes: Sequence[int], modes: Sequence[int], rules: Sequence[str] = RULES) -> Iterator[Load]:
    """Every load of every rule and n, as it is computed; each n twice the last, so that orders are observed."""
    for rule in rules:
        last: dict[int, float] = {}
        for n in sizes:
            strut = Strut(n=n, rule=rule)
            for mode in modes:
                start = time.perf_counter()
                load, bound = next(buckling_each(strut, (mode,)))
                seconds = time.perf_counter() - start
                error = abs(load - exact_load(mode))
                order = math.log2(last[mode] / error) if mode in last and error > 10 * bound else None
                last[mode] = error
                yield Load(rule, mode, n, load, bound, exact_load(mode), seconds, order)


def extrapolate(loads: Sequence[Load]) -> Extrapolated:
    """Richardson's extrapolation of the loads of one mode and rule, n doubled each time.

    The error of the end rule has every power of h, that of the trapezoid only the even ones, so that a stage gains
    one order or two. The estimate is the change of the last stage, and what rounding of the loads does to it.
    """
    rule, column = loads[0].rule, [entry.load for entry in loads]
    rounding, power = max(entry.bound for entry in loads), ORDER[rule]
    best, estimate = column[-1], math.inf
    while len(column) > 1:
        column = [b + (b - a) / (2**power - 1) for a, b in pairwise(column)]
        rounding *= (2**power + 1) / (2**power - 1)  # as this stage can do with the rounding of the last
        change = abs(column[-1] - best) + rounding
        if change >= estimate:  # further stages only turn rounding over
            break
        best, estimate = column[-1], change
        power += ORDER[rule]
    return Extrapolated(rule, loads[0].mode, best, estimate, loads[0].limit)
