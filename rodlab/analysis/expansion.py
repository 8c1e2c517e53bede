"""Koiter's expansion of a branch at its branch point, numerically, for any model [Koiter 1945; Lyapunov and Schmidt].

    lam(eps) = lam_0 + c_1 eps + c_2 eps^2 + ...,    u(eps) = u_0 + eps v + eps^2 u_2 + ...,    eps = <v, u - u_0>, |v| = 1

The branch itself is computed at Chebyshev points of eps on both sides of the branch point, where it is regular, and fitted: no
derivative beyond the Jacobian is asked of the model. c_1 tells a transcritical branch point from a pitchfork, then the sign of
c_2 its direction. In a measure, the tip angle say, the same with eps its change.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import cheb2poly, chebvander
from numpy.polynomial.polynomial import polyval

from rodlab.analysis.beginning import STILL
from rodlab.analysis.curve import Curve
from rodlab.analysis.events import Event
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.switching import FIRST, SLIM, switch
from rodlab.numerics.arrays import EPS, Array, whole

NODES = 12  # on each side
REACH = 4.0  # farthest eps, over that of the start
NEARER = 1.7
DEGREE = 12


@dataclass(frozen=True, eq=False)
class Expansion:
    """`load`: c_0 .. c_order; `error`: of each; `u`: coefficients (order + 1, n) of the unknowns.

    `in_terms_of`: "eps", or the measure.
    """

    load: Array
    error: Array
    u: Array
    in_terms_of: str

    def __repr__(self) -> str:
        terms = " ".join(
            f"{c:+.10g} {self.in_terms_of}^{k}"
            for k, (c, e) in enumerate(zip(self.load, self.error, strict=True))
            if k and abs(c) > e
        )
        return f"Expansion(lam = {self.load[0]:.10g} {terms})"

    def __call__(self, eps: float) -> float:
        """The load at eps."""
        return float(polyval(eps, self.load))


def expansion(event: Event, order: int = 4, *, measure: str | None = None, starts: list[Point] | None = None) -> Expansion:
    """The expansion of the branch that leaves at a branch point where one eigenvalue is zero.

    measure: expand in the change of this measure along the branch instead of eps. order: at most 6. starts: what `switch` gave.
    Raises `ValueError` unless the branch point has one null vector and one other branch, or for a measure that the model does not
    have; `NoConvergence` where that branch cannot be followed on both sides.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.analysis.follow import follow
    >>> from rodlab.mechanics.strut import Strut
    >>> b = follow(equilibrium(Strut(n=1), 0.0), to=2.0)
    >>> e = expansion(b.events[0], measure="tip_angle")                     # lam = phi / sin(phi)
    >>> bool((abs(e.load - [1, 0, 1 / 6, 0, 7 / 360]) <= e.error).all()), bool(e.error[2] < 1e-8)
    (True, True)
    """
    order = whole("order", order, least=1)
    if order > 6:
        raise ValueError(f"order must be at most 6; it is {order}")
    if measure is not None and measure not in getattr(event.point.equations, "measures", {}):
        raise ValueError(f"measure must be one that the model has; it is {measure!r}")
    starts = switch(event) if starts is None else starts
    if event.multiplicity != 1 or len(starts) != 2:
        raise ValueError(
            f"event must be a branch point of two branches; it has multiplicity {event.multiplicity}, {len(starts)} leave"
        )
    curve = Curve(event.point.equations)
    y = np.append(event.point.u, event.lam)
    assert event.null is not None
    v = np.append(event.null[:, 0], 0.0)
    side = _Sides(curve, y, v / curve.norm(v), [np.append(start.u, start.lam) for start in starts])
    far, middle, near = (_fitted(*side.solved(reach), curve, measure, order) for reach in _reaches(side))
    errors = np.array([2 * np.abs(a[0] - b[0]) + a[2] for a, b in ((far, middle), (middle, near))])
    best = errors.argmin(axis=0)  # truncation asks for near solutions, rounding for far ones: each coefficient has its own best
    error = errors.min(axis=0)
    error[0] += event.error
    u = np.where(best[:, None] == 0, far[1], middle[1])
    return Expansion(np.where(best == 0, far[0], middle[0]), error, u, measure or "eps")


class _Sides:
    """The other branch at given distances eps on both sides of the branch point."""

    def __init__(self, curve: Curve, y: Array, v: Array, ends: list[Array]) -> None:
        self.curve, self.y, self.row = curve, y, curve.row(v)
        eps = [float(self.row @ (end - y)) for end in ends]
        moved = [curve.norm(np.append((end - y)[:-1], 0.0)) for end in ends]
        if any(abs(e) <= max(SLIM * size, STILL) for e, size in zip(eps, moved, strict=True)):
            raise ValueError("event must be met on a branch other than the one expanded, which has no part along its null vector")
        self.known = {0.0: y} | dict(zip(eps, ends, strict=True))
        self.start = min(abs(e) for e in eps)

    def solved(self, reach: float) -> tuple[Array, Array]:
        """eps (m,) and solutions (m, n + 1) at Chebyshev's points as far as `reach`; `NoConvergence` where one is lost."""
        nodes = reach * np.cos(np.pi * (np.arange(NODES) + 0.5) / (2 * NODES))
        every = sorted((side * eps for eps in nodes for side in (1, -1)), key=lambda eps: abs(np.log(abs(eps) / self.start)))
        found = [(0.0, self.y), *((eps, self._at(float(eps))) for eps in every)]
        eps, solutions = zip(*sorted(found, key=lambda entry: entry[0]), strict=True)
        return np.array(eps), np.array(solutions)

    def _at(self, eps: float) -> Array:
        if eps not in self.known:
            near = sorted(self.known, key=lambda other: abs(other - eps))[:5]
            weights = [np.prod([(eps - b) / (a - b) for b in near if b != a]) for a in near]
            guess = np.sum([w * self.known[a] for w, a in zip(weights, near, strict=True)], axis=0)
            self.known[eps] = self.curve.correct(guess, self.row, limit=12).y
        return self.known[eps]


def _reaches(side: _Sides) -> tuple[float, ...]:
    """The farthest eps that can be had, and parts of it."""
    reach = REACH * side.start
    while True:
        try:
            side.solved(reach)
        except NoConvergence:
            reach /= 2
            if reach < side.start:
                raise
        else:
            return reach, reach / NEARER, reach / NEARER**2


def _fitted(eps: Array, solutions: Array, curve: Curve, measure: str | None, order: int) -> tuple[Array, Array, Array]:
    """Coefficients of load and unknowns, and what rounding may do to those of the load."""
    zero = int(np.flatnonzero(eps == 0)[0])
    near = np.abs(eps) + np.where(
        eps == 0, np.inf, 0.0
    )  # across the branch: next to the branch point solutions are known less well
    noise = 8 * EPS * float(np.abs(solutions[:, -1]).max()) * (1 + FIRST / near)
    if measure is not None:
        values = [Point(curve.equations, float(y[-1]), y[:-1]).measure(measure) for y in solutions]
        eps = np.array(values) - values[zero]
    width = float(np.abs(eps).max())
    vander = chebvander(eps / width, DEGREE)
    monomials = np.array([np.pad(cheb2poly(unit), (0, DEGREE))[: order + 1] for unit in np.eye(DEGREE + 1)])
    fit = (monomials / width ** np.arange(order + 1)).T @ np.linalg.pinv(vander)
    coefficients = fit @ solutions
    return coefficients[:, -1], coefficients[:, :-1], np.abs(fit) @ noise
