"""A diagram with what is not connected: seeded with every equilibrium at some loads.

For a strut the seeds are complete (`all_equilibria`); for any other model they are what deflation finds. A closed branch
that lies between two neighbouring loads altogether is still missed: `looks` says how many loads there are.
"""

from typing import Any

import numpy as np

from rodlab.analysis.deflation import deflation
from rodlab.analysis.diagram import Diagram, begun, diagram, window_of
from rodlab.analysis.equations import Equations
from rodlab.analysis.point import Point
from rodlab.lab.equilibria import all_equilibria
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import whole


def census(model: Equations, lam: tuple[float, float], *, looks: int = 9, start: Any = None, **options: Any) -> Diagram:
    """The diagram of everything: branches connected to the start first, then those through what is found at `looks` loads.

    `components` of the diagram tell the connected ones (0) from the rest. options: those of `diagram`.
    Raises as `diagram` and `all_equilibria` do.

    >>> d = census(Strut.from_joints(k=[1, 1], beta=[0.1, 0]), (0, 3), looks=3)
    >>> [(row.kind, round(row.lam, 6), d.components[row.branch]) for row in d.table if row.kind == "fold"]
    [('fold', 0.47896, 1), ('fold', 2.862871, 2)]
    """
    looks = whole("looks", looks, least=1)
    low, high = window_of(lam)
    seeds = [begun(model, (low, high), start)]
    for load in np.linspace(low, high, looks + 1)[:0:-1]:
        seeds += _found(model, float(load))
    return diagram(model, (low, high), seeds, **options)


def _found(model: Any, load: float) -> list[Point]:
    if isinstance(model, Strut) and not hasattr(model, "unknowns"):
        return list(all_equilibria(model, load).points)
    return deflation(model, load)
