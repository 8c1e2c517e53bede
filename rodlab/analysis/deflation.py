"""Further solutions of F(u, lam) = 0 at one load: known ones are divided out [Farrell, Birkisson and Funke 2015].

    G(u) = M(u) F(u),    M = prod_i (1 / r_i^p + alpha),    r_i^2 = inner(u - u_i, u - u_i),   p = 2, alpha = 1
    G' = M J + F m^T,    s = -J^{-1} F   =>   deflated step tau s,    tau = 1 / (1 - m.s / M)         [Sherman and Morrison]
    m.s / M = -p sum_i inner(u - u_i, s) / (r_i^2 (1 + alpha r_i^p))

G has the roots of F but for the u_i, and Newton's method for it takes Newton's own steps, longer, shorter or backwards: next to a
known root s = -(u - u_i) and tau = 1 / (1 - p) = -1. Every matrix is solved as it is.
"""

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import chain
from typing import Any

import numpy as np

from rodlab.analysis.continuation import carried
from rodlab.analysis.curve import Curve
from rodlab.analysis.equations import Equations, started
from rodlab.analysis.equilibrium import equilibrium, on_its_mesh
from rodlab.analysis.newton import Newton, NewtonStep, NoConvergence
from rodlab.analysis.point import Point
from rodlab.numerics.arrays import EPS, Array, number, vector, whole
from rodlab.numerics.nullspace import near_null

LONGEST, GROWTH = 0.5, 1.03  # step, as a part of the size of u, at least 1: the first, and per solve, lest a run be caught
MODES = 4  # along which runs start, a distance 1 to either side
NEAR, MET = 1e-2, 1e-6  # relative: steps below which Newton's own method takes over; distances at which M is singular
MOVED = 0.1  # by which Newton's method may move what is said to be known
TRIPLE = 10 * EPS ** (1 / 3)  # how far rounding moves a triple root


def deflation(
    model: Equations, lam: float, known: Sequence[Any] = (), guesses: Sequence[Any] = (None,), *, most: int = 20, limit: int = 100
) -> list[Point]:
    """Solutions at one load beyond the `known` ones, in the order found; at most `most`, or []: never a claim of all.

    known: points at this load, or arrays. guesses: as of `equilibrium`. A run begins at each guess; then at its reflection in the
    nearest known solution and beside it, on either side along the modes nearest null; then so for every solution, known or
    found. It ends after `limit` linear solves; what it finds is solved by Newton's method, nothing divided out, and is further
    from all others than its error and theirs. `newton` of a point lists the solves of the run that found it, not those of runs
    that found nothing. Where a mesh adapts all runs are on the finest of those of known points and guesses.
    Raises `ValueError` for wrong arguments, such as a known solution that is none.

    >>> from rodlab.mechanics.strut import Strut
    >>> sorted(round(p.tip_angle, 6) for p in deflation(Strut.from_joints(k=[1, 1]), 3.0))
    [-2.966878, -0.529526, 0.0, 0.529526, 2.966878]
    """
    lam, most, limit = number("lam", lam), whole("most", most, least=1), whole("limit", limit, least=1)
    if not (isinstance(known, (list, tuple)) and isinstance(guesses, (list, tuple))):
        raise ValueError(f"known and guesses must be lists; they are {known!r:.60} and {guesses!r:.60}")
    first = [started(model, guess) for guess in guesses]
    size = first[0].size if first else None
    points = [p if isinstance(p, Point) else Point(model, lam, vector(f"known[{i}]", p, size)) for i, p in enumerate(known)]
    on = _finest(model, lam, points, guesses)
    runs = Runs(on, lam, limit, [_settled(on, lam, p, f"known[{i}]") for i, p in enumerate(points)])
    found, others = list[Point](), [on_its_mesh(p) for p in runs.known]
    for u in runs.starts([carried(model, on, np.append(u, lam))[:-1] for u in first]):
        while len(found) < most and (p := runs.run(u)) is not None:
            runs.known.append(p)
            with suppress(NoConvergence):  # raised for a solution of this mesh alone
                p = on_its_mesh(p)
                found += [p] if all(_apart(p, q) for q in (*others, *found)) else []
    return found


class Runs:
    """Newton's method on M F from one start after the other, for the equations on one mesh; `known` grows."""

    def __init__(self, on: Any, lam: float, limit: int, known: list[Point]) -> None:
        self.on, self.lam, self.limit, self.known, self.newton = on, lam, limit, known, Newton.at(on, lam)

    def starts(self, guesses: list[Array]) -> Iterator[Array]:
        """The guesses, then places across and beside them, and so of all that is known by then."""
        yield from guesses
        curve = Curve(self.on)
        for u in chain(guesses, (p.u for p in self.known)):
            if self.newton._residual(u) is not None:
                yield 2 * min((p.u for p in self.known if p.u is not u), key=lambda v: self.newton.norm(v - u), default=u) - u
                y = np.append(u, self.lam)
                for v in near_null(curve.jacobian(y), min(MODES, u.size), symmetric=curve.symmetric(y)).right.T:
                    yield from (u + v / self.newton.norm(v), u - v / self.newton.norm(v))

    @np.errstate(all="ignore")
    def run(self, u: Array) -> Point | None:
        """A solution that is not yet known, or None."""
        newton, history, near = self.newton, list[NewtonStep](), NEAR if self.known else math.inf
        while len(history) < self.limit:
            F = newton._residual(u)
            if F is None or (s := newton._step(u, F)) is None or not math.isfinite(slope := self._slope(u, s)):
                return None
            size, scale = newton.norm(s), max(1.0, newton.norm(u))
            tau = math.copysign(1 / max(abs(slope), size / (LONGEST * GROWTH ** len(history) * scale)), slope)
            history.append(NewtonStep(size, newton.norm(F), tau))
            if size <= near * scale and abs(slope - 1) < 0.5:
                p, near = _solved(self.on, self.lam, u, history), min(near / 100, NEAR)
                if p is not None and not any(newton.norm(p.u - q.u) <= MET * scale + p.remaining for q in self.known):
                    return p
            u = u + tau * s
        return None

    def _slope(self, u: Array, s: Array) -> float:
        """1 - m.s / M = 1 / tau; infinite at a known solution."""
        away, size = [u - p.u for p in self.known], max(1.0, self.newton.norm(u))
        square = [float(self.on.inner(d, d)) for d in away]
        if not min(square, default=1.0) > (MET * size) ** 2:
            return math.inf
        return 1.0 + sum(2 * float(self.on.inner(d, s)) / (r * (1 + r)) for d, r in zip(away, square, strict=True))


def _finest(model: Any, lam: float, known: list[Point], guesses: Sequence[Any]) -> Any:
    """The equations on the mesh of most points, of known points and of solutions near the guesses."""
    on = [model, *(p.equations for p in known if type(p.equations) is type(model))]
    for guess in guesses if hasattr(model, "adapted") else ():
        with suppress(NoConvergence):
            on.append(equilibrium(model, lam, guess).equations)
    return max(on, key=lambda equations: equations.mesh.size) if hasattr(model, "adapted") else model


def _settled(on: Any, lam: float, p: Point, name: str) -> Point:
    """A known solution on the mesh of the runs. Raises `ValueError` for what is none."""
    same = type(p.equations) is type(on) and p.lam == lam
    u = carried(p.equations, on, np.append(p.u, lam))[:-1] if same else p.u
    root = _solved(on, lam, u, []) if same else None
    if root is None or float(np.abs(root.u - u).max()) > MOVED * max(1.0, float(np.abs(u).max())):
        raise ValueError(f"{name} must be a solution of this {type(on).__name__} at lam = {lam:g}; it is {p!r:.80}")
    return root


def _solved(on: Any, lam: float, u: Array, history: list[NewtonStep]) -> Point | None:
    """What Newton's own method reaches from u; its solves are added to the history."""
    newton, root = Newton.at(on, lam), None
    with suppress(NoConvergence):
        root = newton.solve(u)
    history += newton.history
    if root is None or not math.isfinite(history[-1].residual):  # too large to be told from its rounding
        return None
    return Point(on, lam, root.u, tuple(history), root.remaining)


def _apart(p: Point, q: Point) -> bool:
    """True when two solutions differ by more than their errors, on the finer of their meshes."""
    p, q = sorted((p, q), key=lambda point: point.u.size)
    errors = [x.error if math.isfinite(x.error) else TRIPLE * max(1.0, float(np.abs(x.u).max())) for x in (p, q)]
    u = carried(p.equations, q.equations, np.append(p.u, p.lam))[:-1]
    same = p if p.equations is q.equations else _solved(q.equations, q.lam, u, [])
    return same is None or float(np.abs(same.u - q.u).max()) > 4 * (p.remaining_angle + q.remaining_angle + sum(errors))
