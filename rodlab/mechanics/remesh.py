"""A mesh that serves, for what the companion tells of each interval [Ascher, Mattheij and Russell, 9].

    e_i    the moments that interval i misses at its ends, when its inside is solved by the companion, times how far such a
           moment turns the rod there (the diagonal of the inverse of the second variation)
    g_i    what it misses of its second variation, condensed to its ends, per unit of load: of this depend tangents, index
           and branch points. Not asked for where the load stiffens

A mesh serves while the sum of all e_i + g_i is below KEEP tol; a new one is made for AIM tol, coarser as well as finer. What
rounding makes of them is told apart, so that no mesh is refined in vain.
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics import rod_bounds
from rodlab.mechanics.profile import Profile
from rodlab.mechanics.resolution import CHORD, Corrected, companion_of, softening, springs
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.collocated import Collocated, Condensed
from rodlab.numerics.mesh import equidistributed, halved
from rodlab.numerics.pieces import smooth_pieces

if TYPE_CHECKING:
    from rodlab.mechanics.rod import Rod

KEEP, AIM = 3e-3, 3e-4  # of tol, and of the largest angle where that is small
SMALLEST = 1e-2  # an angle counted as small at most
SPARE, FEWER = 0.5, 0.6  # a coarser mesh is tried below this part of AIM tol, and made if it has this part of the intervals
DROWNED = 1e-4  # what an error hidden by rounding is then taken for, as a part of it
SAME = 1e-4  # relative difference of loads at which two meshes are compared
FAR = 0.5  # a correction of the angles, in radians, that tells nothing but that the mesh is too coarse
FINE, PIECE = 1e-10, 12  # to which a guess is represented, and by which degree
ROUNDED = 1e-6  # errors that may be rounding and no longer fall
LONG, HALVED = 250, 512  # points beyond which a mesh is refined by halves; intervals of one that is halved throughout, at most
CANCEL = 1e-3  # part of the sum of all errors that is counted even where they cancel


def adapted(rod: "Rod", u: Array, lam: float, tangent: Array | None) -> "tuple[Rod, Array, Array | None] | None":
    """The rod on a better mesh with u (no longer an exact solution there) and tangent on it; None where its mesh serves."""
    if not rod.adapts:
        return None
    known = companion_of(rod, u, lam)
    with np.errstate(all="ignore"):
        change, last = (float(np.abs(step).max()) for step in (known.moved(), rod.angles(known.second)))
        settled = change < FAR and last <= max(0.25 * change, 1e-9, noise(known, lam))
    if not settled:  # beyond a length a finer mesh would not mend it: the error of a point tells
        return _on(rod, rod, u, halved(rod.mesh), tangent) if rod.grid.N <= HALVED else None
    errors = _errors(rod, u, lam, known) / min(max(float(np.abs(rod.angles(known.u)).max()), SMALLEST), 1.0)
    total, keep, aim = float(errors.sum()), KEEP * rod.tol, AIM * rod.tol
    if abs(lam - rod.expected[0]) <= SAME * abs(lam) and rod.expected[1] < total < ROUNDED:
        rod.stuck = 4 * total  # the last mesh was no better here: rounding, which the error of a point tells
    if total <= rod.stuck or SPARE * aim < total <= keep:
        return None
    if total <= keep:
        mesh = _coarser(rod, errors, float(np.abs(rod.angles(known.u)).max()))
        return None if mesh is None else _on(rod, known.rod, known.u, mesh, tangent)
    mesh = equidistributed(rod.mesh, errors, aim, 2 * rod.degree + 1, rod.breaks)
    if mesh.size > 2 * rod.mesh.size > LONG or np.array_equal(mesh, rod.mesh):
        mesh = halved(rod.mesh)  # errors that ask for so much may be rounding: one step at a time
    return _on(rod, known.rod, known.u, mesh, tangent, (lam, total / 2))


def _coarser(rod: "Rod", errors: Array, largest: float) -> Array | None:
    """A mesh of far fewer intervals that should serve as well; None where there is none."""
    drowned = errors < 4 * EPS * max(largest, 1.0)  # in rounding: how small they are is not known
    guessed = np.where(drowned, DROWNED * errors, errors)
    mesh = equidistributed(rod.mesh, guessed, AIM * rod.tol, 2 * rod.degree + 1, rod.breaks)
    return mesh if mesh.size - 1 <= FEWER * rod.grid.N else None


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
    mesh = np.union1d(rod.mesh, halved(pieces)) if pieces.size > rod.breaks.size + 2 else rod.mesh
    for _ in range(finer):
        mesh = halved(mesh)
    return rod if mesh is rod.mesh else rod.on(mesh)


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
    ends, own_ends = known.local(lam).condensed(), (matrix if isinstance(matrix, Collocated) else rod.local(u, lam)).condensed()
    own, tested = rod.tested(u, lam, rod.grid.wide), fine.tested(fine.moved(rod, u), lam, fine.grid.wide)
    missed = np.asarray(np.abs(_at_ends(tested, ends) - _at_ends(own, own_ends)), dtype=np.float64)
    turn = _diagonal_of_inverse(ends)
    errors = missed[:, 0] * np.append(0.0, turn[:-1]) + missed[:, 1] * turn
    rest = matrix.factor().solve(-rod.residual_wide(u, lam))  # what Newton's method left undone
    left = rod.angles(rest)
    turned = known.moved().reshape(N, -1)[:, -1] - left.reshape(N, -1)[:, -1]
    if float(np.abs(left).max()) > CHORD:  # stiffness is compared where both are solved
        u = u + rest
        own_ends = rod.local(u, lam).condensed()
    seen, total = float(np.abs(turned).max()), float(errors.sum())
    errors = errors * max(seen / total, CANCEL) if total > 0 else np.full(N, seen / N)
    if seen <= noise(known, lam):  # no mesh does better
        errors *= min(1.0, 0.5 * KEEP * rod.tol / max(float(errors.sum()), 1e-300))
    return np.asarray(errors + _missed_stiffness((rod, u, own_ends), (fine, known.u, ends), lam))


def noise(known: Corrected, lam: float) -> float:
    """How far rounding alone can move the companion's angles: its answer to noise of random signs, and a margin."""
    size = known.rod.sizes(known.u, lam)
    signs = np.where(np.sin(1.0 + 7.0 * np.arange(size.size) ** 2) > 0, 1.0, -1.0)
    return 16 * rod_bounds.WIDE * float(np.abs(known.rod.angles(known.factor.solve(signs * size))).max())


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
    (k, c), (fine_k, fine_c) = (springs(*side, lam) for side in (own, companion))
    missed = np.diff(rod.mesh) * np.abs(k / fine_k - 1) + np.abs(c - fine_c).max(axis=1) / max(abs(lam), 1 / rod.compliance[0])
    return np.asarray(np.where(softening(rod, own[1], lam).max(axis=1) > 0, np.minimum(missed, 1.0), 0.0))


def _diagonal_of_inverse(ends: Condensed) -> Array:
    """|diagonal| of the inverse of the condensed second variation, (N,): by its pivots from both ends."""
    d, e = ends.diagonal, ends.S[1:, 0, 1]
    below, above = _pivots(d, e), _pivots(d[::-1], e[::-1])[::-1]
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(1 / np.abs(below + above - d), 1e6 / float(np.abs(d).min() or 1.0)))


def _pivots(d: Array, e: Array) -> Array:
    pivots = np.empty_like(d)
    last = np.inf
    for i, (x, y) in enumerate(zip(d.tolist(), [0.0, *(e * e).tolist()], strict=True)):
        last = pivots[i] = x - y / last or EPS * x
    return pivots
