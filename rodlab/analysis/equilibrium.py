"""An equilibrium at one load: Newton's method from a guess and, where that fails and the model knows its energy, downhill."""

from typing import Any

import numpy as np

from rodlab.analysis.downhill import downhill, has_energy
from rodlab.analysis.equations import Equations, started
from rodlab.analysis.newton import Newton, NoConvergence
from rodlab.analysis.point import Point
from rodlab.numerics.arrays import Array, number


def equilibrium(model: Equations, lam: float, guess: Any = None, *, limit: int = 100) -> Point:
    """The solution of F(u, lam) = 0 that Newton's method reaches from `guess`.

    guess: u as an array, for a strut also a function of s; None is the model's own start (the unstressed shape).
    Far from every root Newton's method may fail; the way down the energy then leads to a minimum, never to a saddle.
    Raises `NoConvergence`, with the history, after `limit` linear solves; `ValueError` for a wrong argument.

    >>> from rodlab.mechanics.strut import Strut
    >>> equilibrium(Strut(n=1), lam=2.0, guess=[1.5])                # phi = 2 sin(phi)
    Point(lam=2, tip_angle=1.89549, index=0, error=4.7e-15)
    """
    lam = number("lam", lam)
    u = started(model, guess)

    def norm(v: Array) -> float:
        return float(np.sqrt(model.inner(v, v)))

    run = Newton(lambda v: np.asarray(model.residual(v, lam)), lambda v: model.jacobian(v, lam), norm, limit)
    try:
        root = run.solve(u)
    except NoConvergence:
        if not has_energy(model):
            raise
        root = downhill(model, lam, u, run)
    return Point(model, lam, root.u, root.history, root.remaining)
