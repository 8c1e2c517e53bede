"""Three routes to one number: the strut as n grows, the rod as its mesh is refined, and the exact elastica between them.

The tip angle of the first mode at one load, each method against the elastica: error, observed order, run time.
"""

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from rodlab.analysis.equilibrium import equilibrium
from rodlab.mechanics.elastica import Elastica, elastica
from rodlab.mechanics.joints import RULES
from rodlab.mechanics.rod import Rod
from rodlab.mechanics.strut import Strut

DEGREES = (1, 2, 3, 4)


@dataclass(frozen=True)
class Route:
    """The tip angle by a method of theoretical order `order` with so many unknowns; `observed` against the coarser one before."""

    method: str
    order: int
    unknowns: int
    tip_angle: float
    estimate: float
    error: float
    seconds: float
    observed: float | None


def routes(lam: float, joints: Sequence[int], intervals: Sequence[int]) -> Iterator[Route]:
    """Every method at every size, sizes doubled each time. `estimate`: of the strut against its own equations, not the limit."""
    exact = elastica(lam)
    for rule, order in zip(RULES, (1, 2), strict=True):
        yield from _refined(f'strut, "{rule}"', order, [Strut(n=n, rule=rule) for n in joints], exact)
    for degree in DEGREES:
        own = [Rod(mesh=N, degree=degree) for N in intervals]
        yield from _refined(f"rod, degree {degree}", 2 * degree, own, exact)


def _refined(method: str, order: int, models: Sequence[Strut | Rod], exact: Elastica) -> Iterator[Route]:
    last = math.nan
    known = np.linspace(0, 1, 33)
    shape = CubicSpline(known, exact(known).phi)
    for model in models:
        start = time.perf_counter()
        p = equilibrium(model, exact.lam, shape)
        seconds = time.perf_counter() - start
        error = abs(p.tip_angle - exact.tip_angle)
        above = error > 1e-13 and last > 1e-13
        observed = math.log2(last / error) if above else None
        last = error
        unknowns = model.n if isinstance(model, Strut) else model.size
        yield Route(method, order, unknowns, p.tip_angle, p.error, error, seconds, observed)
