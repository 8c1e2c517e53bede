"""An equilibrium at one load: Newton's method from a guess and, where that fails and the model knows its energy, downhill.

A model with a mesh is then solved on better ones until one serves.
"""

from dataclasses import replace
from typing import Any

from rodlab.analysis.downhill import downhill, has_energy
from rodlab.analysis.equations import Equations, started
from rodlab.analysis.newton import Newton, NoConvergence
from rodlab.analysis.point import Point
from rodlab.numerics.arrays import Array, number, whole

MESHES = 24  # tried one after the other
FINER = (2, 4, 1, 3)  # how often the mesh is halved for a guess, tried in turn before the way goes downhill


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
    lam, limit = number("lam", lam), whole("limit", limit, least=1)
    tried: list[tuple[Any, Array, Newton, NoConvergence]] = []
    suited = getattr(model, "suited", None)
    for finer in FINER if callable(guess) and suited is not None else FINER[:1]:
        own = model if suited is None else suited(guess, finer)
        u, run = started(own, guess), Newton.at(own, lam, limit)
        try:
            root = run.solve(u)
            return on_its_mesh(Point(own, lam, root.u, root.history, root.remaining))
        except NoConvergence as failure:
            tried.append((own, u, run, failure))
    own, u, run, failed = tried[0]
    if not has_energy(own):
        raise failed
    root = downhill(own, lam, u, run)
    return on_its_mesh(Point(own, lam, root.u, (*failed.history, *root.history), root.remaining), down=True)


def on_its_mesh(p: Point, *, down: bool = False) -> Point:
    """The same solution on a mesh that serves, where the model adapts one; else p itself. Raises `NoConvergence`.

    down: where Newton's method fails on a better mesh, go down the energy there too.
    """
    for _ in range(MESHES):
        adapted = getattr(p.equations, "adapted", None)
        better = None if adapted is None else adapted(p.u, p.lam, p.tangent)
        if better is None:
            break
        model, u, tangent = better
        run = Newton.at(model, p.lam)
        try:
            root = run.solve(u)
        except NoConvergence:
            if not down:
                raise
            root = downhill(model, p.lam, u, run)
        history = (*p.newton, *root.history)
        p = replace(p, equations=model, u=root.u, newton=history, remaining=root.remaining, tangent=tangent)
    return p
