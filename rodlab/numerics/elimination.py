"""Negative eigenvalues of a symmetric block tridiagonal matrix, counted safely: cyclic reduction, in log2 n steps of numpy.

Every second block S is eliminated at once, its eigenvalues counted, and its neighbours take -B S^{-1} B^T [Haynsworth 1968];
then of those left every second, ... By themselves the blocks eliminated are short cantilevers, but in the last few steps, so
that S is seldom near singular. Whatever rounding may do to a block is taken from its diagonal, or added to it, before its
eigenvalues are counted: the counts are of matrices below and above the exact one (Loewner's order); its index lies between.
"""

import numpy as np

from rodlab.numerics.arrays import EPS, TINY, Array, is_finite

NEAR = 32 * EPS**0.5  # a block nearer to singular is moved away: that costs less than what its inverse would magnify


def counted_by_elimination(S: Array, B: Array, side: int) -> int:
    """Negative eigenvalues of blocks S (n, p, p), each joined by B (n, p, p) to the one below: at most (side 1), at least (-1).

    >>> S, B = np.full((3, 1, 1), 2.0), np.full((3, 1, 1), -1.0)
    >>> counted_by_elimination(S - 1.0, B, 1), counted_by_elimination(S - 1.0, B, -1)      # eigenvalues 1 and 1 -+ sqrt 2
    (1, 1)
    """
    found, (n, p) = 0, S.shape[:2]
    with np.errstate(all="ignore"):
        while S.shape[0] > 1 and is_finite(S):
            S, B, negative = _every_second_eliminated(S, B, side)
            found += negative
    if not is_finite(S):  # an overflow: nothing is known
        return n * p if side > 0 else 0
    return found + _counted(np.asarray(np.linalg.eigvalsh(S), dtype=np.float64), np.zeros((1, 1)), side)[1]


def _every_second_eliminated(S: Array, B: Array, side: int) -> tuple[Array, Array, int]:
    """Blocks of the joints left, of each with the one below it, and the negative eigenvalues of those eliminated."""
    p, gone = S.shape[1], S.shape[0] // 2
    w, V = np.linalg.eigh(S[1::2])
    coupled = np.zeros((gone, p, 2 * p))  # to the joint below, and to that above
    coupled[:, :, :p] = B[1::2]
    above = B[2::2].transpose(0, 2, 1)
    coupled[: above.shape[0], :, p:] = above
    R = V.transpose(0, 2, 1) @ coupled
    size = np.sqrt(np.einsum("ijk,ijk->ij", R, R))
    w, negative, lost = _eliminated(w, size, side)
    taken = R.transpose(0, 2, 1) @ (R / w[:, :, None])
    left, beside = S[::2].copy(), B[::2].copy()
    largest = np.abs(left).max(axis=(1, 2))
    left[:gone] -= taken[:, :p, :p]
    beside[1:] = -taken[: above.shape[0], p:, :p]
    left[1:] -= taken[: above.shape[0], p:, p:]
    rounding = 2 * p * EPS * (largest + np.abs(left).max(axis=(1, 2)))
    rounding[:gone] += lost
    rounding[1:] += lost[: above.shape[0]]
    np.einsum("iaa->ia", left)[:] -= side * rounding[:, None]
    return left, beside, negative


def _eliminated(w: Array, size: Array, side: int) -> tuple[Array, int, Array]:
    """The eigenvalues w (N, p) moved, the negative ones among them, and what rounding does to R^T w^{-1} R.

    The rows of R have the norms `size` (N, p). Where an eigenvalue is near zero all are moved further, by what costs least.
    """
    p = w.shape[1]
    moved, negative = _counted(w, np.zeros((w.shape[0], 1)), side)
    lost = _lost(moved, size)
    near = np.flatnonzero(np.abs(moved).min(axis=1) < NEAR / 4 * np.sqrt((size**2).sum(axis=1)))
    for step in range(1, p + 2) if near.size else ():
        extra = step * NEAR * np.sqrt((size[near] ** 2).sum(axis=1))[:, None]
        other, _ = _counted(w[near], extra, side)
        cost = _lost(other, size[near])
        better = extra[:, 0] + cost < lost[near]
        moved[near[better]], lost[near[better]] = other[better], cost[better]
    return moved, int((moved < 0).sum()) if near.size else negative, lost


def _counted(w: Array, extra: Array, side: int) -> tuple[Array, int]:
    """Eigenvalues w (N, p) moved to the safe side of what eigh's rounding can do, and `extra`; the negative ones."""
    moved = w - side * (8 * w.shape[1] * EPS * np.abs(w).max(axis=1, keepdims=True) + extra)
    moved[moved == 0] = -side * TINY
    return moved, int((moved < 0).sum())


def _lost(w: Array, size: Array) -> Array:
    """Bound on the rounding of R^T w^{-1} R, (N,): R is known to 4 p eps |R|."""
    whole = 8 * w.shape[1] * EPS * np.sqrt((size**2).sum(axis=1, keepdims=True))
    return np.asarray((whole * (size + whole) / np.abs(w)).sum(axis=1))
