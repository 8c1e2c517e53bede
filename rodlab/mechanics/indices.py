"""The index of one equilibrium under a dead load and under a prescribed shortening [Maddocks 1987].

    dead load     the second variation on the directions that keep what the ends hold: between clamps x(1), one constraint
    shortening    on those that keep z(1) as well, whose reaction the load is: between clamps two

A constraint more takes one negative eigenvalue or none: index(dead load) - index(shortening) = 1 exactly where along the branch
the height rises with the load. So the two differ beside every fold: what snaps under weights does not in a vice.
"""

from typing import Any, NamedTuple

import numpy as np

from rodlab.numerics.inertia import Inertia


class Indices(NamedTuple):
    """Signs of the eigenvalues of the second variation of one state, by what its end is given."""

    dead_load: Inertia
    shortening: Inertia


def indices(p: Any) -> Indices:
    """The indices of an equilibrium of a strut or rod under its load and with its end held at its height.

    Where the shortening does not change with the shape to first order, as of a straight rod, the second is not verified.
    Raises `ValueError` for another model, or where a third thing is followed.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.mechanics.strut import Strut
    >>> arch = Strut(n=20, u_hat=0.3)
    >>> found = indices(equilibrium(arch, 3.5, lambda s: -0.9 * s))                 # bent against its curvature: it would snap
    >>> found.dead_load.negative, found.shortening.negative
    (1, 0)
    """
    model = p.equations
    if getattr(model, "follows", "lam") == "shortening":
        return Indices(_inertia(model.released(), p.u[1:], p.measure("load")), p.inertia)
    if not hasattr(model, "vary") or getattr(model, "follows", "lam") != "lam" or not hasattr(model, "is_straight"):
        raise ValueError(f"p must be an equilibrium of a strut or rod under a load or a shortening; its model is {model!r:.60}")
    return Indices(p.inertia, _inertia(model.vary("shortening"), np.append(p.lam, p.u), 1 - p.height))


def _inertia(model: Any, u: Any, value: float) -> Inertia:
    known: Inertia = model.inertia(u, value)
    return known
