"""From a branch point onto every branch that leaves it, one start for each half-branch.

The algebraic bifurcation equations are solved near the point, on the sphere |xi| = rho in the space of its null vectors and,
where the followed branch itself lies there, along the load as well. Roots on the followed branch are dropped; every other
one is corrected to a solution of the full equations and compared with the followed branch at the same place: a start that
has not left it is no start. Where the eigenvalues all cross one way, the count is checked by Poincare and Hopf's theorem: the
signs of the roots sum to the Euler characteristic of the sphere. And the count must be the same nearer by.
"""

from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from rodlab.analysis.beginning import LEAST, Beginning
from rodlab.analysis.curve import Curve, Segment
from rodlab.analysis.events import Event
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.reduced import Polynomial, Reduced
from rodlab.numerics.arrays import Array
from rodlab.numerics.nullspace import NearNull, near_null

FIRST = 0.05  # distance of a start from its branch point, in the length of the equations
FIT = 1e-3  # misfit of the cubic polynomial that still tells the directions
SLIM = 0.05  # part of the null vectors on a half-branch along the load
MOST = 3  # null vectors


def switch(event: Event, within: tuple[float, float] | None = None) -> list[Point]:
    """One start for each half-branch that leaves the followed branch at a branch point; each has its tangent, away from it.

    Starts are solutions a small distance off, verified to have left. Null spaces up to dimension 3. Where a fold or branch point
    lies between, by looks at a half and a quarter of the way, they are nearer. With a window `within` of loads they lie in it,
    and looks that cannot tell raise `NoConvergence`.
    Raises `ValueError` unless the event is a branch point; `NoConvergence` where the half-branches found cannot be all.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.analysis.follow import follow
    >>> from rodlab.mechanics.strut import Strut
    >>> b = follow(equilibrium(Strut(n=10), 0.0), to=5.0)
    >>> [(round(p.lam, 3), round(p.tip_angle, 3)) for p in switch(b.events[0])]
    [(2.235, 0.069), (2.235, -0.069)]
    """
    if not isinstance(event, Event) or event.kind != "branch point":
        raise ValueError(f"event must be a branch point, of a branch that was followed; it is {event!r:.80}")
    if event.fence is None or event.null is None:
        raise ValueError("event must come from following a branch; one that was read from a file needs its model")
    if not event.converged:
        raise ValueError(f"event must have converged; it did not: {event.reason}")
    curve = Curve(event.point.equations, _load_size(event))
    y = np.append(event.point.u, event.lam)
    null = _null(curve, y, event)
    if null.right.shape[1] > MOST:
        raise ValueError(f"event must have at most {MOST} null vectors; it has {null.right.shape[1]}")
    beside = curve.index(event.fence.a), curve.index(event.fence.b)
    near = Beginning(curve, y, event, beside, within)
    simple = _simple(curve, event, y, null, beside)
    if simple:
        return [near.start(p) for p in simple]
    reduced = Reduced(curve, y, null)
    rho, farther, failure = FIRST, list[Point](), "none leaves"
    while rho >= LEAST:
        try:
            starts = _Leaving(curve, reduced, event, rho).starts()
        except NoConvergence as why:
            starts, failure = [], str(why)
        if starts and len(starts) == len(farther):  # the same nearer by: no other branch passes between
            return [near.start(p) for p in farther]
        farther = starts
        rho /= 4
    raise NoConvergence(f"no half-branch could be told at lam = {event.lam:.9g}: {failure}", ())


def _simple(curve: Curve, event: Event, y: Array, null: NearNull, beside: tuple[int | None, int | None]) -> list[Point]:
    """The two half-branches where a single eigenvalue crosses zero: one other curve passes [Crandall and Rabinowitz 1971].

    Each is found across the null direction at two distances, and must have left the followed branch; else none is returned,
    and the bifurcation equations decide.
    """
    fence = event.fence
    assert fence is not None
    before, after = beside
    if null.right.shape[1] != 1 or before is None or after is None or abs(before - after) != 1:
        return []
    parent = fence.derivative(float(fence.row @ (y - fence.a)))
    slope = abs(float(parent[-1])) / (curve.norm(np.append(parent[:-1], 0.0)) or 1e-300)
    if LEAST * curve.scale < slope < curve.scale / LEAST:  # loads measured so that the followed branch passes at 45 degrees
        curve = Curve(curve.equations, slope)
    parent = parent / curve.norm(parent)
    v = np.append(null.right[:, 0], 0.0)
    across = v - curve.dot(v, parent) * parent
    if curve.norm(across) < SLIM * curve.norm(v):
        return []
    across /= curve.norm(across)
    rho = FIRST
    while rho >= LEAST:
        starts = [_aside(curve, y, side * across, parent, rho) for side in (1.0, -1.0)]
        found = [start for start in starts if start is not None]
        if len(found) == 2:
            return _in_order(found, rho)
        rho /= 4
    return []


def _aside(curve: Curve, y: Array, across: Array, parent: Array, rho: float) -> Point | None:
    """A solution a distance rho aside of a branch point, by way of one half as far; None where no curve passes both."""
    row = curve.row(across)
    try:
        near = curve.correct(y + rho / 2 * across, row, limit=12).y
        far = curve.correct(y + 2 * (near - y), row, limit=12)
    except NoConvergence:
        return None
    bend = curve.norm(far.y - y - 2 * (near - y))
    along = abs(curve.dot(far.y - y, parent))
    if bend > 0.2 * rho or along > 0.5 * rho:  # not a smooth curve from y, or the followed branch itself
        return None
    t = curve.tangent(far.y, far.y - y)
    return Point(curve.equations, float(far.y[-1]), far.y[:-1].copy(), far.history, far.remaining, t, "checked")


def _in_order(starts: list[Point], rho: float) -> list[Point]:
    """Those with a greater first angle first; differences far below their distance rho do not count."""
    return sorted(starts, key=lambda p: tuple(-np.round(p.u[[0, p.u.size // 2, -1]] / (1e-3 * rho))))


def _load_size(event: Event) -> float:
    """A size of loads here, so that lengths do not depend on their units."""
    assert event.fence is not None
    return max(abs(event.lam), 100 * abs(float(event.fence.b[-1] - event.fence.a[-1]))) or 1.0


def _null(curve: Curve, y: Array, event: Event) -> NearNull:
    assert event.null is not None
    symmetric = curve.symmetric(y)
    p = event.null.shape[1]
    return near_null(curve.jacobian(y), p, symmetric=symmetric, start=event.null)


class _Leaving:
    """The half-branches at a distance rho."""

    def __init__(self, curve: Curve, reduced: Reduced, event: Event, rho: float) -> None:
        assert event.fence is not None
        self.curve, self.reduced, self.event, self.rho = curve, reduced, event, rho
        self.fence: Segment = event.fence
        self.parent = self.fence.derivative(float(self.fence.row @ (reduced.y - self.fence.a)))
        self.polynomial = Polynomial(reduced, rho, self._load_scale())
        self.near = Curve(curve.equations, self.polynomial.mu0 / rho)  # rho and mu_0 weigh alike
        if self.polynomial.misfit > FIT:
            raise NoConvergence(f"the cubic misses the equations by {self.polynomial.misfit:.1g}", ())

    def starts(self) -> list[Point]:
        """All of them, those with a greater first angle first."""
        found: list[Point] = []
        for root in self._roots():
            start = self._start(root)
            if start is not None and all(self._apart(start, other) for other in found):
                found.append(start)
        return _in_order(found, self.rho)

    def _load_scale(self) -> float:
        """Size of mu on the branches at the distance rho, from the eigenvalues' rate of crossing."""
        reduced, rho = self.reduced, self.rho
        p = reduced.p
        b = max(float(np.abs(reduced.at(sign * rho * e, 0.0)[1]).max()) for e in np.eye(p) for sign in (1, -1))
        mu = 1e-2 * rho * self.curve.scale
        side = [reduced.at(0.1 * rho * e, s * mu)[1] for e in np.eye(p) for s in (1, 0)]
        rate = max(float(np.abs(side[2 * j] - side[2 * j + 1]).max()) for j in range(p)) / (0.1 * rho * mu)
        scale = b / (rho * rate) if rate > 0 and b > 1e-14 * rho else mu
        return min(max(scale, 1e-8 * mu), self.curve.scale)

    def _roots(self) -> Iterator[Array]:
        p, polynomial = self.reduced.p, self.polynomial
        for starts in (16 * 4 ** (p - 1), 128 * 4 ** (p - 1)):
            roots = polynomial.roots_on_sphere(starts)
            if self._complete(roots):
                break
        else:
            raise NoConvergence(f"{len(roots)} directions were found, and their signs say that some are missing", ())
        if not polynomial.isolated(roots):
            raise NoConvergence("the half-branches form a continuum (a symmetry?), or terms beyond the third order decide", ())
        yield from roots
        yield from self._along_the_load()

    def _complete(self, roots: Array) -> bool:
        """Poincare and Hopf: signs of the tangential field sum to 0 on the circle, 2 on S^0 and S^2, if all cross one way."""
        rates = [np.linalg.eigvalsh(rate + rate.T) for rate in self.polynomial.rates]
        if self.polynomial.turns or not any(all((sign * w > 0).all() for w in rates) for sign in (1, -1)):
            return True
        signs = 0
        for J, xm in zip(self.polynomial.jacobian(roots), roots, strict=True):
            signs += int(np.sign(np.linalg.det(np.vstack([J, np.append(xm[:-1], 0.0)]))))
        return abs(signs) == (2 if self.reduced.p % 2 else 0)

    def _along_the_load(self) -> Iterator[Array]:
        """The two halves on which the null vectors hardly take part: not on the sphere, and often the followed branch."""
        for m in (1.0, -1.0):
            xm = np.append(np.zeros(self.reduced.p), m)
            for _ in range(20):
                J = self.polynomial.jacobian(xm[None])[0][:, :-1]
                xm[:-1] -= np.linalg.lstsq(J, self.polynomial(xm[None])[0], rcond=1e-12)[0]
            if np.abs(self.polynomial(xm[None])).max() < 1e-8 and np.abs(xm[:-1]).max() < SLIM:
                yield xm

    # --- from a root of the polynomial to a point ------------------------------------------------------------------

    def _start(self, root: Array) -> Point | None:
        """The solution of the full equations at a root, None where that is on the followed branch."""
        reduced, curve = self.reduced, self.curve
        guess, _ = reduced.at(self.rho * root[:-1], self.polynomial.mu0 * float(root[-1]))
        if not self._left(guess):
            return None
        away = guess - reduced.y
        if np.abs(root[:-1]).max() > SLIM:  # in the plane across the null direction: regular on the new branch
            row = curve.row(np.append(away[:-1], 0.0) / curve.norm(np.append(away[:-1], 0.0)))
        else:
            row = np.append(np.zeros(away.size - 1), np.sign(away[-1]))
        found = curve.correct(guess, row, limit=12)
        moved, size = self.near.norm(found.y - guess), self.near.norm(guess - reduced.y)
        if moved > 0.2 * size:
            raise NoConvergence(f"a half-branch was moved by {moved / size:.2g} of its distance", found.history)
        if not self._left(found.y):
            return None
        t = curve.tangent(found.y, away)
        return Point(curve.equations, float(found.y[-1]), found.y[:-1].copy(), found.history, found.remaining, t, "checked")

    def _left(self, y: Array) -> bool:
        """True when a solution is not on the followed branch: that is computed at the same place and is elsewhere."""
        curve, parent = self.near, self.parent / self.near.norm(self.parent)
        row = curve.row(parent)
        guess = self.reduced.y + float(row @ (y - self.reduced.y)) * parent
        with suppress(NoConvergence):  # where the plane is too near the branch point the tangent must do
            guess = curve.correct(guess, row).y
        return curve.norm(y - guess) > 0.1 * curve.norm(y - self.reduced.y)

    def _apart(self, p: Point, q: Point) -> bool:
        return self.near.norm(np.append(p.u - q.u, p.lam - q.lam)) > 1e-3 * self.rho
