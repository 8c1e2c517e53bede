"""How well a mesh serves, told by the companion: the same mesh with polynomials of twice the degree.

corrected    Newton's method on the companion from the rod's own solution; what it changes is the error, as the companion's
             own, of twice the order, is far smaller. Residuals in the longest float, lest rounding be taken for error
index        that of the second variation condensed to mesh points, springs k between them and a softening c of each,
             where mesh and companion have it in common
missed       v . F and v . J v of the companion for a null vector v: what moves folds and branch points
"""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rodlab.mechanics import rod_bounds
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.bordered import Bordered
from rodlab.numerics.collocated import Collocated, Condensed
from rodlab.numerics.collocation import Grid
from rodlab.numerics.difference import DifferenceForm, Springs
from rodlab.numerics.factor import Factor
from rodlab.numerics.inertia import Inertia
from rodlab.numerics.nullspace import quadratic
from rodlab.numerics.slack import Slack

if TYPE_CHECKING:
    from rodlab.mechanics.rod import Rod

COARSE, LEVELS = 1e-7, 3  # an error from which on the companion is doubted, and companions that are asked in turn
HIGH = 16  # degree of a companion that is trusted
CHORD = 1e-8  # a correction of the angles after which the companion's derivative is as it was
SAFE = 2.0  # on what the companion changes
RESOLVED = 0.9 * np.pi**2  # of h^2 lam cos(phi) / K: an interval by itself, its ends held, is stable


class Corrected(NamedTuple):
    """The companion's solution next to one of the rod: unknowns, the two steps of Newton's method, and its derivative."""

    rod: "Rod"
    u: Array
    first: Array
    second: Array
    matrix: Any
    factor: Factor

    def local(self, lam: float) -> Collocated:
        """The second variation with all forces as they are: the matrix itself, unless ends or places couple the intervals."""
        return self.matrix if isinstance(self.matrix, Collocated) else self.rod.local(self.u, lam)

    def moved(self) -> Array:
        """How far the angles are from the rod's own."""
        return self.rod.angles(self.first + self.second)


def companion_of(rod: "Rod", u: Array, lam: float) -> Corrected:
    """The companion's solution; kept for the last u that was asked for."""
    last = rod.last_corrected
    if last is not None and last[1] == lam and np.array_equal(last[0], u):
        return last[2]
    fine = rod.companion
    v = fine.moved(rod, u)
    matrix = fine.jacobian(v, lam)
    factor = matrix.factor()
    with np.errstate(all="ignore"):
        first = factor.solve(-fine.residual_wide(v, lam))
        if float(np.abs(rod.angles(first)).max()) > CHORD and np.isfinite(first).all():  # else the same factor serves again
            matrix = fine.jacobian(v + first, lam)
            factor = matrix.factor()
        second = factor.solve(-fine.residual_wide(v + first, lam))
    known = Corrected(fine, v + first + second, first, second, matrix, factor)
    rod.last_corrected = (u, lam, known)
    return known


def corrected(rod: "Rod", u: Array, lam: float) -> tuple["Rod", Array]:
    """The companion and its solution, or the rod's own where that could not be reached."""
    known = companion_of(rod, u, lam)
    first, second = (float(np.abs(rod.angles(step)).max()) for step in (known.first, known.second))
    settled = second <= max(0.1 * first, 1e-9)
    return (known.rod, known.u) if settled else (rod, u)


# --- what a point asks ---------------------------------------------------------------------------------------------


def tip_error(rod: "Rod", u: Array, lam: float) -> float:
    """Estimate from above of the tip angle's error: of the mesh, of Newton's method, and of rounding."""
    known, i = companion_of(rod, u, lam), rod.observed(u)
    unit, there, own = np.zeros_like(known.u), known.rod.at_mesh(i), float(u[rod.at_mesh(i)])
    unit[there] = 1.0
    with np.errstate(all="ignore"):
        adjoint = known.factor.solve(unit)
        rounded = rod_bounds.WIDE + (EPS if rod.varies else 0.0)  # a profile's values are doubles
        noise = known.rod.rounding(known.u, lam, adjoint, rounded)
        turned = known.rod.angles(known.second)
        left = float(abs(known.second[there]) + np.abs(turned).max() ** 2 * np.abs(adjoint).sum())
        missed = _missed_tip(known, i, own, lam)
        total = SAFE * (missed + left) + noise + 2 * EPS * abs(own)
    return total if np.isfinite(total) else np.inf


def condition(rod: "Rod", u: Array, lam: float) -> float:
    """Of the tip angle: how many relative units of rounding in the terms of the gradient show in it, relative to itself."""
    unit = np.zeros_like(u)
    unit[-1] = 1.0
    with np.errstate(all="ignore"):
        adjoint = rod.jacobian(u, lam).factor().solve(unit)
        return float(np.abs(adjoint) @ rod.sizes(u, lam) / abs(u[-1]))


def _missed_tip(known: Corrected, i: int, tip: float, lam: float) -> float:
    """How far the angle at the end of interval i is from the companion's; where that is far, from its companion's, and so on."""
    found = abs(float(known.u[known.rod.at_mesh(i)]) - tip)
    for _ in range(LEVELS):
        if not found > COARSE:
            break
        finer = companion_of(known.rod, known.u, lam)
        there = float(finer.u[finer.rod.at_mesh(i)])
        moved = abs(there - float(known.u[known.rod.at_mesh(i)]))
        found, known = abs(there - tip) + moved, finer
        if moved <= 0.05 * found:
            break
    return found


def missed(rod: "Rod", u: Array, lam: float, v: Array) -> tuple[float, float]:
    """How much the mesh misses of v . F and of v . J v at a null vector v: what moves folds and branch points.

    On the companion, u and v are corrected by bordered systems first (Lyapunov and Schmidt's reduction): what is left of F stands
    along v. Companions of companions are asked until they agree. Infinite where that leads nowhere.
    """
    own = np.array([float(v @ rod.residual_wide(u, lam)), quadratic(rod.jacobian(u, lam), v)[0]])
    found, change = np.zeros(2), np.full(2, np.inf)
    for _ in range(LEVELS):
        fine = rod.companion
        u, v, reduced = _reduced(fine, fine.moved(rod, u), fine.moved(rod, v, direction=True), lam)
        change, found, rod = np.abs(reduced - own - found), reduced - own, fine
        if not (change > 0.05 * np.abs(found)).any() or fine.degree >= HIGH:
            break
    force, stiffness = SAFE * np.abs(found)
    return (float(force), float(stiffness)) if np.isfinite(found).all() else (np.inf, np.inf)


def _reduced(fine: "Rod", u: Array, v: Array, lam: float) -> tuple[Array, Array, Array]:
    """u where F has no part but along v, v where J v has none either, and (v . F, v . J v) there."""
    size = float(v @ v)
    for _ in range(2):
        J = fine.jacobian(u, lam)
        bordered = Bordered(J, J.factor(), B=v[:, None], C=v[:, None], D=np.zeros((1, 1)))
        step, _ = bordered.solve_once(-fine.residual_wide(u, lam), np.zeros(1))
        turned, _ = bordered.solve_once(np.zeros(u.size), np.array([size]))
        u, v = u + step, turned
    return u, v, np.array([float(v @ fine.residual_wide(u, lam)), quadratic(fine.jacobian(u, lam), v)[0]])


def inertia(rod: "Rod", u: Array, lam: float) -> Inertia:
    """That of the second variation, verified where mesh and companion have it in common and every interval is resolved."""
    known = companion_of(rod, u, lam)
    with np.errstate(all="ignore"):
        off = float(np.abs(rod.angles(known.second)).max()) + 4 * EPS * float(np.abs(rod.angles(known.u)).max(initial=0.0))
    if not np.isfinite(off):
        return Inertia(0, rod.freedom, 0)
    fine, own = _inertia_of(known.rod, known.u, lam, off), _inertia_of(rod, u, lam, 0.0)
    low, high = min(own.negative, fine.negative), max(own.negative + own.unclear, fine.negative + fine.unclear)
    if low == high and _resolved(rod, u, lam):
        return Inertia(low, 0, rod.freedom - low)
    high = max(high, low + 1)
    return Inertia(low, high - low, max(rod.freedom - high, 0))


def _inertia_of(rod: "Rod", u: Array, lam: float, off: float) -> Inertia:
    """Of all solutions within `off` of u; condensed to springs and softening, which rounding of the stiffness does not blur."""
    matrix = rod.jacobian(u, lam)
    if not isinstance(matrix, Collocated) or rod.lipschitz is None:
        known: Inertia = matrix.inertia(2 * off * float(np.abs(softening(rod, u, lam)).max()))
        return known
    slack = rod.lipschitz(u, lam)(off, 0.0)[0]
    if not isinstance(slack, Slack):  # no bound is known for a term of one's own
        slack = Slack(rod.grid, np.zeros_like(rod.grid.s), off * abs(lam))
    if not matrix.is_steady():
        return matrix.inertia(slack)
    k, ends = springs(rod, u, matrix.condensed(), lam)
    if not k.min() > 0:
        return matrix.inertia(slack)
    spread = slack.values.sum(axis=1, keepdims=True) + slack.level
    moved = 4 * spread + 64 * rod.degree * EPS * np.abs(ends)
    own = DifferenceForm(Springs(k), -Grid.gathered(ends)).inertia(Grid.gathered(moved))
    return Inertia(own.negative, own.unclear, rod.freedom - own.negative - own.unclear)


def springs(rod: "Rod", u: Array, condensed: Condensed, lam: float) -> tuple[Array, Array]:
    """k (N,) and the response of the ends to a turn of all nodes, (N, 2), in which no stiffness takes part."""
    _, mixed, soft = rod.stiffness(u, lam)
    none = np.zeros_like(rod.grid.s)
    rest = rod.grid.tested(mixed + none, soft + none)
    return condensed.springs(rest)


def softening(rod: "Rod", u: Array, lam: float) -> Array:
    """How much the load softens at Gauss's points: -W_phiphi, (N, m)."""
    return -np.broadcast_to(rod.stiffness(u, lam)[2], rod.grid.s.shape)


def _resolved(rod: "Rod", u: Array, lam: float) -> bool:
    K = np.broadcast_to(rod.parameters["K"], rod.grid.s.shape).min(axis=1)
    return bool((np.diff(rod.mesh) ** 2 * softening(rod, u, lam).max(axis=1) < RESOLVED * K).all())


def between(rod: "Rod", u: Array, lam: float, s: Array) -> tuple[Array, Array, Array]:
    """phi, x, z at arclengths s (k,): the polynomials, and x', z' integrated from the last mesh point."""
    grid, W = rod.grid, rod.kernel()
    Y = grid.nodal(u, rod.phi0)
    x, z = (f[:: grid.degree] for f in rod.reached(u, lam))
    i = np.clip(np.searchsorted(grid.mesh, s, side="left") - 1, 0, grid.N - 1)
    start = grid.mesh[i]
    inner = start[:, None] + (s - start)[:, None] * grid.basis.c
    angle = np.stack([grid.value(Y, column) for column in inner.T], axis=1)
    given = {name: rod.profiles[name].at(inner) for name in W.parameters}
    dx, dz = W.reach(np.zeros_like(angle), angle, lam, **given)
    weight = (s - start)[:, None] * grid.basis.b
    return grid.value(Y, s), x[i] + np.sum(weight * dx, axis=1), z[i] + np.sum(weight * dz, axis=1)
