"""How well a mesh serves, told by the companion: the same mesh with polynomials of twice the degree.

    corrected    Newton's method on the companion from the rod's own solution; what it changes is the error, as the companion's
                 own, of twice the order, is far smaller. Residuals in the longest float, lest rounding be taken for error
    e_i          what interval i contributes: the moments that it misses at its ends, when its inside is solved by the companion,
                 times how far such a moment turns the rod there (the diagonal of the inverse of the second variation)
    g_i          and what it misses of its second variation, condensed to its ends, per unit of load: of this depend
                 tangents, index and branch points. Not asked for where the load stiffens

A mesh serves while the sum of all e_i + g_i is below KEEP tol; a new one is made for AIM tol [Ascher, Mattheij, Russell, 9].
"""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rodlab.mechanics import rod_bounds
from rodlab.mechanics.profile import Profile
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.collocated import BandFactor, Collocated, Condensed
from rodlab.numerics.collocation import Grid
from rodlab.numerics.difference import DifferenceForm, Springs
from rodlab.numerics.inertia import Inertia
from rodlab.numerics.mesh import equidistributed
from rodlab.numerics.nullspace import quadratic
from rodlab.numerics.pieces import smooth_pieces
from rodlab.numerics.slack import Slack

if TYPE_CHECKING:
    from rodlab.mechanics.rod import Rod

KEEP, AIM = 3e-3, 3e-4  # of tol, and of the largest angle where that is small
DROWNED = 1e-4  # what an error hidden by rounding is taken for, as a part of it
SMALLEST = 1e-2  # an angle counted as small at most
SAME = 1e-4  # relative difference of loads at which two meshes are compared
SPARE = 0.5  # of AIM tol: below it a coarser mesh is tried
FEWER = 0.6  # of the intervals: a coarser mesh is worth its while
FAR = 0.5  # a correction of the angles, in radians, that tells nothing but that the mesh is too coarse
FINE, PIECE = 1e-10, 12  # to which a guess is represented, and by which degree
COARSE, LEVELS = 1e-7, 3  # an error from which on the companion is doubted, and companions that are asked in turn
ROUNDED = 1e-6  # errors that may be rounding and no longer fall
LONG = 250  # points of a mesh beyond which it is refined by halves
HALVED = 512  # intervals of a mesh that is halved throughout, at most
CHORD = 1e-8  # a correction of the angles after which the companion's derivative is as it was
CANCEL = 1e-3  # part of the sum of all errors that is counted even where they cancel
SAFE = 2.0  # on what the companion changes
RESOLVED = 0.9 * np.pi**2  # of h^2 lam cos(phi) / K: an interval by itself, its ends held, is stable


class Corrected(NamedTuple):
    """The companion's solution next to one of the rod: unknowns, the two steps of Newton's method, and its derivative."""

    rod: "Rod"
    u: Array
    first: Array
    second: Array
    matrix: Collocated
    factor: BandFactor


def companion_of(rod: "Rod", u: Array, lam: float) -> Corrected:
    """The companion's solution; kept for the last u that was asked for."""
    last: Any = rod.__dict__.get("last_corrected")
    if last is not None and last[1] == lam and np.array_equal(last[0], u):
        known: Corrected = last[2]
        return known
    fine = rod.companion
    v = fine.moved(rod, u)
    matrix = fine.jacobian(v, lam)
    factor = matrix.factor()
    with np.errstate(all="ignore"):
        first = factor.solve(-fine.residual_wide(v, lam))
        if float(np.abs(first).max()) > CHORD and np.isfinite(first).all():  # else the same factor serves again
            matrix = fine.jacobian(v + first, lam)
            factor = matrix.factor()
        second = factor.solve(-fine.residual_wide(v + first, lam))
    known = Corrected(fine, v + first + second, first, second, matrix, factor)
    rod.__dict__["last_corrected"] = (u, lam, known)
    return known


def corrected(rod: "Rod", u: Array, lam: float) -> tuple["Rod", Array]:
    """The companion and its solution, or the rod's own where that could not be reached."""
    known = companion_of(rod, u, lam)
    settled = float(np.abs(known.second).max()) <= max(0.1 * float(np.abs(known.first).max()), 1e-9)
    return (known.rod, known.u) if settled else (rod, u)


# --- what a point asks ---------------------------------------------------------------------------------------------


def tip_error(rod: "Rod", u: Array, lam: float, remaining: float) -> float:
    """Estimate from above of the tip angle's error: of the mesh, of Newton's method, and of rounding."""
    known = companion_of(rod, u, lam)
    unit = np.zeros_like(known.u)
    unit[-1] = 1.0
    with np.errstate(all="ignore"):
        adjoint = known.factor.solve(unit)
        rounded = rod_bounds.WIDE + (EPS if rod.varies else 0.0)  # a profile's values are doubles
        noise = rod_bounds.rounding(known.rod, known.u, lam, adjoint, rounded)
        left = float(abs(known.second[-1]) + np.abs(known.second).max() ** 2 * np.abs(adjoint).sum())
        missed = _missed_tip(known, float(u[-1]), lam)
        total = SAFE * (missed + left) + noise + 2 * EPS * abs(float(u[-1])) + 0 * remaining
    return total if np.isfinite(total) else np.inf


def _missed_tip(known: Corrected, tip: float, lam: float) -> float:
    """How far the tip is from the companion's; where that is far, from the companion's own companion, and so on."""
    found = abs(float(known.u[-1]) - tip)
    for _ in range(LEVELS):
        if not found > COARSE:
            break
        finer = companion_of(known.rod, known.u, lam)
        moved = abs(float(finer.u[-1] - known.u[-1]))
        found, known = abs(float(finer.u[-1]) - tip) + moved, finer
        if moved <= 0.05 * found:
            break
    return found


def missed(rod: "Rod", u: Array, lam: float, v: Array) -> tuple[float, float]:
    """How much the mesh misses of v . F and of v . J v, by the companion: what moves folds and branch points.

    Where v is a null vector both are stationary, so that u and v need not be those of the companion.
    """
    fine = rod.companion
    w, finer = fine.moved(rod, v, direction=True), fine.moved(rod, u)
    force = float(w @ fine.residual_wide(finer, lam)) - float(v @ rod.residual_wide(u, lam))
    stiffness = quadratic(fine.jacobian(finer, lam), w)[0] - quadratic(rod.jacobian(u, lam), v)[0]
    return SAFE * abs(force), SAFE * abs(stiffness)


def inertia(rod: "Rod", u: Array, lam: float, remaining: float) -> Inertia:
    """That of the second variation, verified where mesh and companion have it in common and every interval is resolved."""
    known = companion_of(rod, u, lam)
    with np.errstate(all="ignore"):
        off = float(np.abs(known.second).max()) + 4 * EPS * float(np.abs(known.u).max(initial=0.0)) + 0 * remaining
    if not np.isfinite(off):
        return Inertia(0, rod.size, 0)
    fine, own = _inertia_of(known.rod, known.u, lam, off), _inertia_of(rod, u, lam, 0.0)
    low, high = min(own.negative, fine.negative), max(own.negative + own.unclear, fine.negative + fine.unclear)
    if low == high and _resolved(rod, u, lam):
        return Inertia(low, 0, rod.size - low)
    high = max(high, low + 1)
    return Inertia(low, high - low, max(rod.size - high, 0))


def _inertia_of(rod: "Rod", u: Array, lam: float, off: float) -> Inertia:
    """Of all solutions within `off` of u; condensed to springs and softening, which rounding of the stiffness does not blur."""
    matrix, slack = rod.jacobian(u, lam), rod.lipschitz(u, lam)(off, 0.0)[0]
    spread = slack.values.sum(axis=1) if isinstance(slack, Slack) else np.full(rod.grid.N, off * abs(lam))
    if not matrix.is_steady():
        return matrix.inertia(slack if isinstance(slack, Slack) else off * abs(lam))
    k, rest = _springs(rod, u, matrix.condensed(), lam)
    if not k.min() > 0:
        return matrix.inertia(slack if isinstance(slack, Slack) else off * abs(lam))
    c, wide = -rest[:, 1], 4 * spread
    c[:-1] -= rest[1:, 0]
    wide[:-1] += 4 * spread[1:]
    size = np.abs(rest[:, 1]) + np.append(np.abs(rest[1:, 0]), 0.0)
    known = DifferenceForm(Springs(k), c).inertia(wide + 64 * rod.degree * EPS * size)
    return Inertia(known.negative, known.unclear, rod.size - known.negative - known.unclear)


def _softening(rod: "Rod", u: Array, lam: float) -> Array:
    """How much the load softens at Gauss's points: -W_phiphi, (N, m)."""
    W, grid = rod.kernel(lam), rod.grid
    angle, slope = grid.at_gauss(grid.nodal(u, rod.phi0))
    soft = W.stiffness(slope, angle, lam, **rod.given(W))[2]
    return -np.broadcast_to(soft, angle.shape)


def _resolved(rod: "Rod", u: Array, lam: float) -> bool:
    K = np.broadcast_to(rod.parameters["K"], rod.grid.s.shape).min(axis=1)
    return bool((np.diff(rod.mesh) ** 2 * _softening(rod, u, lam).max(axis=1) < RESOLVED * K).all())


# --- meshes ----------------------------------------------------------------------------------------------------------


def adapted(rod: "Rod", u: Array, lam: float, tangent: Array | None) -> "tuple[Rod, Array, Array | None] | None":
    """The rod on a better mesh with u (no longer an exact solution there) and tangent on it; None where its mesh serves."""
    if not rod.adapts:
        return None
    known = companion_of(rod, u, lam)
    with np.errstate(all="ignore"):
        change = float(np.abs(known.first + known.second).max())
        settled = change < FAR and float(np.abs(known.second).max()) <= max(0.25 * change, 1e-9, _noise(known, lam))
    if not settled and rod.grid.N > HALVED:
        return None  # what a finer mesh would not mend: the error of a point tells
    if not settled:
        return _on(rod, rod, u, _halved(rod.mesh), tangent)
    errors = _errors(rod, u, lam, known) / min(max(float(np.abs(known.u).max()), SMALLEST), 1.0)
    total = float(errors.sum())
    if abs(lam - rod.expected[0]) <= SAME * abs(lam) and rod.expected[1] < total < ROUNDED:
        rod.stuck = 4 * total  # the last mesh was no better here: rounding, which the error of a point tells
    if total <= rod.stuck:
        return None
    if AIM * SPARE * rod.tol < total <= KEEP * rod.tol:
        return None
    if total <= KEEP * rod.tol:
        drowned = errors < 4 * EPS * max(float(np.abs(known.u).max()), 1.0)  # in rounding: how small they are is not known
        errors = np.where(drowned, DROWNED * errors, errors)
    mesh = equidistributed(rod.mesh, errors, AIM * rod.tol, 2 * rod.degree + 1, rod.breaks)
    if mesh.size > 2 * rod.mesh.size > LONG:  # errors that ask for so much may be rounding: one step at a time
        mesh = _halved(rod.mesh)
    if total <= KEEP * rod.tol and mesh.size - 1 > FEWER * rod.grid.N:
        return None
    if total > KEEP * rod.tol and mesh.size <= rod.mesh.size and np.array_equal(mesh, rod.mesh):
        mesh = _halved(rod.mesh)
    return _on(rod, known.rod, known.u, mesh, tangent, (lam, total / 2 if total > KEEP * rod.tol else np.inf))


def suited(rod: "Rod", guess: Any, finer: int) -> "Rod":
    """The rod on a mesh on which a guess, a function of s, can be represented, halved so many times."""
    if not (rod.adapts and callable(guess)):
        return rod
    try:
        pieces, _ = smooth_pieces(Profile("guess", guess).at, np.array([0.0, *rod.breaks, 1.0]), FINE, PIECE)
    except ValueError as error:
        if "guess" in str(error):
            raise
        return rod  # rough: it is taken as it is seen at the nodes
    mesh = np.union1d(rod.mesh, _halved(pieces)) if pieces.size > rod.breaks.size + 2 else rod.mesh
    for _ in range(finer):
        mesh = _halved(mesh)
    return rod if mesh is rod.mesh else rod.on(mesh)


def _halved(mesh: Array) -> Array:
    return np.union1d(mesh, (mesh[1:] + mesh[:-1]) / 2)


def _on(
    rod: "Rod", source: "Rod", v: Array, mesh: Array, tangent: Array | None, expected: tuple[float, float] = (0.0, np.inf)
) -> "tuple[Rod, Array, Array | None]":
    other = rod.on(mesh)
    other.expected = expected
    if tangent is None:
        return other, other.moved(source, v), None
    t = other.moved(rod, tangent[:-1], direction=True)
    return other, other.moved(source, v), np.append(t, tangent[-1])


def _errors(rod: "Rod", u: Array, lam: float, known: Corrected) -> Array:
    """What each interval contributes to the error, (N,)."""
    fine, N = known.rod, rod.grid.N
    matrix = rod.jacobian(u, lam)
    ends, own_ends = known.matrix.condensed(), matrix.condensed()
    own, tested = rod.tested(u, lam, rod.grid.wide), fine.tested(fine.moved(rod, u), lam, fine.grid.wide)
    missed = np.asarray(np.abs(_at_ends(tested, ends) - _at_ends(own, own_ends)), dtype=np.float64)
    turn = _diagonal_of_inverse(ends.S)
    errors = missed[:, 0] * np.append(0.0, turn[:-1]) + missed[:, 1] * turn
    rest = matrix.factor().solve(-np.asarray(Grid.gathered(own), dtype=np.float64))  # what Newton's method left undone
    turned = (known.first + known.second).reshape(N, -1)[:, -1] - rest.reshape(N, -1)[:, -1]
    if float(np.abs(rest).max()) > CHORD:  # stiffness is compared where both are solved
        u = u + rest
        own_ends = rod.jacobian(u, lam).condensed()
    seen, total = float(np.abs(turned).max()), float(errors.sum())
    errors = errors * max(seen / total, CANCEL) if total > 0 else np.full(N, seen / N)
    if seen <= _noise(known, lam):  # no mesh does better
        errors *= min(1.0, 0.5 * KEEP * rod.tol / max(float(errors.sum()), 1e-300))
    return np.asarray(errors + _missed_stiffness((rod, u, own_ends), (fine, known.u, ends), lam))


def _noise(known: Corrected, lam: float) -> float:
    """How far rounding alone can move the companion's angles: its answer to noise of random signs, and a margin."""
    size = rod_bounds.sizes(known.rod, known.u, lam)
    signs = np.where(np.sin(1.0 + 7.0 * np.arange(size.size) ** 2) > 0, 1.0, -1.0)
    return 16 * rod_bounds.WIDE * float(np.abs(known.factor.solve(signs * size)).max())


def _at_ends(tested: Any, condensed: Condensed) -> Array:
    """Moments at the ends of the intervals, (N, 2), their inner nodes brought into balance."""
    inner = np.asarray(tested[:, 1:-1], dtype=np.float64)
    return np.asarray(tested[:, [0, -1]] - (inner[:, None, :] @ condensed.F)[:, 0])


Side = tuple["Rod", Array, Condensed]


def _missed_stiffness(own: Side, companion: Side, lam: float) -> Array:
    """What the condensed second variation of each interval misses, (N,), per unit of load, where the load softens.

    Compared as a spring k between its ends and their softening, as `rodlab.mechanics.loads` has them: without cancellation.
    """
    rod = own[0]
    (k, c), (fine_k, fine_c) = (_springs(*side, lam) for side in (own, companion))
    missed = np.diff(rod.mesh) * np.abs(k / fine_k - 1) + np.abs(c - fine_c).max(axis=1) / max(abs(lam), 1 / rod.compliance[0])
    return np.asarray(np.where(_softening(rod, own[1], lam).max(axis=1) > 0, np.minimum(missed, 1.0), 0.0))


def _springs(rod: "Rod", u: Array, condensed: Condensed, lam: float) -> tuple[Array, Array]:
    """k (N,) and the response of the ends to a turn of all nodes, (N, 2), in which no stiffness takes part."""
    W, grid = rod.kernel(lam), rod.grid
    angle, slope = rod.at_gauss(u)
    _, mixed, soft = W.stiffness(slope, angle, lam, **rod.given(W))
    rest = grid.tested(mixed + np.zeros_like(angle), soft + np.zeros_like(angle))
    return -condensed.S[:, 0, 1], rest[:, [0, -1]] - (rest[:, None, 1:-1] @ condensed.F)[:, 0]


def _diagonal_of_inverse(ends: Array) -> Array:
    """|diagonal| of the inverse of the condensed second variation, (N,): by its pivots from both ends."""
    d, e = ends[:, 1, 1].copy(), ends[1:, 0, 1]
    d[:-1] += ends[1:, 0, 0]
    below, above = _pivots(d, e), _pivots(d[::-1], e[::-1])[::-1]
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(1 / np.abs(below + above - d), 1e6 / float(np.abs(d).min() or 1.0)))


def _pivots(d: Array, e: Array) -> Array:
    pivots = np.empty_like(d)
    last = np.inf
    for i, (x, y) in enumerate(zip(d.tolist(), [0.0, *(e * e).tolist()], strict=True)):
        last = pivots[i] = x - y / last or EPS * x
    return pivots


def between(rod: "Rod", u: Array, s: Array) -> tuple[Array, Array, Array]:
    """phi, x, z at arclengths s (k,): the polynomials, and their sine and cosine integrated from the last mesh point."""
    grid = rod.grid
    Y = grid.nodal(u, rod.phi0)
    x, z = (f.reshape(grid.N, -1)[:, -1] for f in (f[1:] for f in rod.shape(u)))
    i = np.clip(np.searchsorted(grid.mesh, s, side="left") - 1, 0, grid.N - 1)
    start = grid.mesh[i]
    inner = start[:, None] + (s - start)[:, None] * grid.basis.c
    angle = np.stack([grid.value(Y, column) for column in inner.T], axis=1)
    weight = (s - start)[:, None] * grid.basis.b
    foot = [np.append(0.0, place[:-1])[i] for place in (x, z)]
    return grid.value(Y, s), foot[0] + np.sum(weight * np.sin(angle), axis=1), foot[1] + np.sum(weight * np.cos(angle), axis=1)


def slopes(rod: "Rod", u: Array) -> tuple[Array, Array]:
    """s and phi' at Gauss's points, (N m,)."""
    return rod.grid.s.ravel(), rod.grid.at_gauss(Grid.nodal(rod.grid, u, rod.phi0))[1].ravel()
