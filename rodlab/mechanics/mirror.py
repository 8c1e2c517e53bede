"""The mirror image: which struts and rods have the same energy for phi and -phi."""

from collections.abc import Callable
from typing import Any

import numpy as np

from rodlab.numerics.arrays import EPS, Array


def mirror(model: Any, n: int) -> tuple[Callable[[Array], Array], ...]:
    """The map u -> -u of n unknowns where it takes equilibria to equilibria, as a model's `symmetries`; else none.

    >>> from rodlab.mechanics.strut import Strut
    >>> mirror(Strut(n=3), 3), mirror(Strut(n=3, u_hat=0.1), 3)
    ((<ufunc 'negative'>,), ())
    """
    if not model.is_straight:
        return ()
    u = np.cos(1.0 + np.arange(n))
    here, there = (np.asarray(model.residual(side * u, 1.0)) for side in (1.0, -1.0))
    return (np.negative,) if np.abs(here + there).max() <= 8 * EPS * np.abs(here).max() else ()
