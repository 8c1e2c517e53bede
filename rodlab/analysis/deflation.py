"""Further solutions of F(u, lam) = 0 at one load: known ones are divided out [Farrell, Birkisson and Funke 2015].

    G(u) = M(u) F(u),    M = prod_i (1 / r_i^p + alpha),    r_i^2 = inner(u - u_i, u - u_i),   p = 2, alpha = 1
    G' = M J + F m^T,    s = -J^{-1} F   =>   deflated step tau s,    tau = 1 / (1 - m.s / M)         [Sherman and Morrison]
    m.s / M = -p sum_i inner(u - u_i, s) / (r_i^2 (1 + alpha r_i^p))

G has the roots of F but for the u_i, and Newton's method for it takes Newton's own steps, longer, shorter or backwards: next to a
known root s = -(u - u_i) and tau = 1 / (1 - p) = -1. Every matrix is solved as it is.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import Any

import numpy as np

from rodlab.analysis.continuation import carried
from rodlab.analysis.curve import Curve
from rodlab.analysis.equations import Equations, started
from rodlab.analysis.equilibrium import on_its_mesh
from rodlab.analysis.newton import Newton, NewtonStep, NoConvergence
from rodlab.analysis.point import Point
from rodlab.numerics.arrays import EPS, Array, number, vector, whole
from rodlab.numerics.nullspace import near_null

LONGEST = 0.5  # step, as a part of the size of u, at least 1
ASIDE, MODES = 1.0, 4  # how far beside a solution a run starts, on either side along so many modes nearest null
NEAR = 1e-2  # relative step below which Newton's own method, nothing divided out, takes over
MET = 1e-6  # relative distance from a known solution at which M is taken for singular
MOVED = 0.1  # relative distance by which Newton's method may move what is said to be known
TRIPLE = 10 * EPS ** (1 / 3)  # how far rounding moves a triple root


def deflation(
    model: Equations, lam: float, known: Sequence[Any] = (), guesses: Sequence[Any] = (None,), *, most: int = 20, limit: int = 100
) -> list[Point]:
    """Solutions at one load beyond the `known` ones, in the order found; at most `most`, or []: never a claim of all.

    known: points at this load, or arrays. guesses: as of `equilibrium`. A run begins at each guess, then beside it on either
    side along the few modes nearest null, then so beside every solution, known or found; it ends after `limit` linear solves.
    What it finds is solved by Newton's method, nothing divided out, and is further from all others than its error and theirs.
    `newton` of a point lists the solves of the run that found it; runs that found nothing are in none. Where a mesh adapts
    all runs are on the finest given, and what they find is then adapted.
    Raises `ValueError` for wrong arguments, such as a known solution that is none.

    >>> class Cubic:
    ...     def residual(self, u, lam): return u**3 - u - lam
    ...     def jacobian(self, u, lam): return np.diag(3 * u**2 - 1)
    ...     def d_lam(self, u, lam): return -np.ones_like(u)
    ...     def inner(self, u, v): return u @ v
    >>> [round(float(p.u[0]), 9) for p in deflation(Cubic(), 0.0, known=[[0.0]], guesses=[[0.0]])]
    [1.0, -1.0]
    """
    lam, most, limit = number("lam", lam), whole("most", most, least=1), whole("limit", limit, least=1)
    for name, given in (("known", known), ("guesses", guesses)):
        if not isinstance(given, (list, tuple)):
            raise ValueError(f"{name} must be a list; it is {given!r:.60}")
    runs = Runs(_finest(model, known), lam, limit)
    runs.guesses = [_first(model, runs.on, guess) for guess in guesses]
    for i, given in enumerate(known):
        runs.known.append(_settled(model, runs, i, given))
    found: list[Point] = []
    others = list(runs.known)
    for u in runs.starts():
        while len(found) < most and (p := runs.run(u)) is not None:
            runs.known.append(p)
            try:
                p = on_its_mesh(p)
            except NoConvergence:  # a solution of this mesh alone
                continue
            if all(_apart(p, q) for q in (*others, *found)):
                found.append(p)
        if len(found) == most:
            break
    return found


class Runs:
    """Newton's method on M F from one start after the other, for the equations on one mesh; `known` grows."""

    def __init__(self, on: Any, lam: float, limit: int) -> None:
        self.on, self.lam, self.limit, self.newton = on, lam, limit, Newton.at(on, lam)
        self.guesses: list[Array] = []
        self.known: list[Point] = []

    def starts(self) -> Iterator[Array]:
        """The guesses, then places beside them and beside all that is known by then."""
        yield from self.guesses
        curve = Curve(self.on)
        for u in chain(self.guesses, (p.u for p in self.known)):
            if self.newton._residual(u) is not None:
                y = np.append(u, self.lam)
                for v in near_null(curve.jacobian(y), min(MODES, u.size), symmetric=curve.symmetric(y)).right.T:
                    yield from (u + side * v / self.newton.norm(v) for side in (ASIDE, -ASIDE))

    def run(self, u: Array) -> Point | None:
        """A solution that is not yet known, or None."""
        newton, history, near = self.newton, list[NewtonStep](), NEAR
        while len(history) < self.limit:
            F = newton._residual(u)
            s = None if F is None else newton._step(u, F)
            slope = math.inf if s is None else self._slope(u, s)
            if F is None or s is None or not math.isfinite(slope):
                return None
            size, scale = newton.norm(s), max(1.0, newton.norm(u))
            tau = math.copysign(1 / max(abs(slope), size / (LONGEST * scale)), slope)
            history.append(NewtonStep(size, newton.norm(F), tau))
            if size <= near * scale and abs(tau - 1) < 0.5:
                p = self._polished(u, history)
                if p is not None:
                    return p
                near /= 100
            u = u + tau * s
        return None

    def _slope(self, u: Array, s: Array) -> float:
        """1 - m.s / M = 1 / tau; infinite at a known solution."""
        total, size = 1.0, max(1.0, self.newton.norm(u))
        with np.errstate(all="ignore"):
            for p in self.known:
                away = u - p.u
                r = float(self.on.inner(away, away))
                if not r > (MET * size) ** 2:
                    return math.inf
                total += 2 * float(self.on.inner(away, s)) / (r * (1 + r))
        return total

    def _polished(self, u: Array, history: list[NewtonStep]) -> Point | None:
        try:
            root = self.newton.solve(u)
        except NoConvergence as failure:
            history += failure.history
            return None
        history += root.history
        p = Point(self.on, self.lam, root.u, tuple(history), root.remaining)
        return p if all(_apart(p, q) for q in self.known) else None


# --- from mesh to mesh -------------------------------------------------------------------------------------------


def _finest(model: Any, known: Sequence[Any]) -> Any:
    """The equations on the mesh of most points, of the model and of the known points."""
    meshes = [p.equations for p in known if isinstance(p, Point) and type(p.equations) is type(model)]
    return max([model, *meshes], key=lambda on: on.mesh.size) if hasattr(model, "moved") else model


def _first(model: Any, on: Any, guess: Any) -> Array:
    read = on if guess is None or callable(guess) else model
    return _moved(read, on, started(read, guess))


def _moved(source: Any, on: Any, u: Array) -> Array:
    return carried(source, on, np.append(u, 0.0))[:-1]


def _settled(model: Any, runs: Runs, i: int, given: Any) -> Point:
    """A known solution, solved on the mesh of the runs. Raises `ValueError` for what is none."""
    point, known = isinstance(given, Point), f"known must hold solutions of this {type(model).__name__} at lam = {runs.lam:g}"
    if point and (type(given.equations) is not type(model) or given.lam != runs.lam):
        raise ValueError(f"{known}; entry {i} is of a {type(given.equations).__name__} at lam = {given.lam:g}")
    if point and given.equations is runs.on:
        return Point(runs.on, runs.lam, given.u, given.newton, given.remaining)
    u = given.u if point else started(model, vector(f"known[{i}]", given))
    u = _moved(given.equations if point else model, runs.on, u)
    like = next((v.size for v in (*runs.guesses, *(p.u for p in runs.known))), None)
    try:
        root = runs.newton.solve(vector(f"known[{i}]", u, like))
        moved = runs.newton.norm(root.u - u) / max(1.0, runs.newton.norm(u))
    except NoConvergence:
        moved = math.inf
    if moved > MOVED:
        raise ValueError(f"{known}; Newton's method moves entry {i} by {moved:.2g}")
    return Point(runs.on, runs.lam, root.u, root.history, root.remaining)


def _apart(p: Point, q: Point) -> bool:
    """True when two solutions differ by more than their errors, on the finer of their meshes."""
    p, q = sorted((p, q), key=lambda point: point.u.size)
    u = p.u
    if p.equations is not q.equations and hasattr(q.equations, "moved"):
        try:
            u = Newton.at(q.equations, q.lam).solve(_moved(p.equations, q.equations, u)).u
        except NoConvergence:
            return True
    return float(np.abs(u - q.u).max()) > _blur(p) + _blur(q)


def _blur(p: Point) -> float:
    """How far from the exact solution a point may be."""
    error = p.error if math.isfinite(p.error) else TRIPLE * max(1.0, float(np.abs(p.u).max()))
    return 4 * (p.remaining_angle + error)
