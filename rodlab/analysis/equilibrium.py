"""An equilibrium at one load: Newton's method from a guess and, where that fails and the model knows its energy, downhill."""

from typing import Any

from rodlab.analysis.downhill import downhill, has_energy
from rodlab.analysis.equations import Equations, started
from rodlab.analysis.newton import Newton, NoConvergence
from rodlab.analysis.point import Point
from rodlab.numerics.arrays import number, whole


def equilibrium(model: Equations, lam: float, guess: Any = None, *, limit: int = 100) -> Point:
    """The solution of F(u, lam) = 0 that Newton's method reaches from `guess`.

    guess: u as an array, for a strut also a function of s; None is the model's own start (the unstressed shape).
    Far from every root Newton's method may fail; the way down the energy then leads to a minimum, never to a saddle.
    Raises `NoConvergence`, with the history, after `limit` linear solves of Newton's method and ten times as many
    downhill; `ValueError` for a wrong argument.

    >>> from rodlab.mechanics.strut import Strut
    >>> p = equilibrium(Strut(n=1), lam=2.0, guess=[1.5])            # phi = 2 sin(phi)
    >>> round(p.tip_angle, 12), p.index, p.error < 1e-14
    (1.895494267034, 0, True)
    """
    lam = number("lam", lam)
    u = started(model, guess)
    run = Newton.at(model, lam, whole("limit", limit, least=1))
    try:
        root = run.solve(u)
        return Point(model, lam, root.u, root.history, root.remaining)
    except NoConvergence as failure:
        if not has_energy(model):
            raise
        tried = failure.history
    root = downhill(model, lam, u, run)
    return Point(model, lam, root.u, (*tried, *root.history), root.remaining)
