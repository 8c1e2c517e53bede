"""The second variation of a collocated problem: a symmetric matrix of overlapping blocks, one an interval.

    [ B_1          ]       block i (m+1, m+1) couples the m + 1 nodes of interval i; neighbours share a node, the
    [    B_2       ]       mesh point between them. Unknowns: all nodes but the first, which is clamped; (N m,).
    [       ...    ]
    [          B_N ]

Solved as a band by LAPACK (dgbtrf, partial pivoting): the nodes inside of an interval are eliminated before its end, which
*is* their condensation. For the index they are condensed by hand: what remains couples mesh points only and is tridiagonal,

    S_i = B_ee - B_ei B_ii^{-1} B_ie,      index(B) = sum_i index(B_ii) + index(tridiagonal of the S_i)   [Haynsworth 1968]

Cost: O(N m^2) a solve, O(N m^3) a factor.
"""

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import lapack

from rodlab.numerics.arrays import EPS, TINY, Array, vector
from rodlab.numerics.inertia import Inertia, Symmetric, sign_of_pivots
from rodlab.numerics.slack import Slack
from rodlab.numerics.tridiagonal import Tridiagonal

STEADY = 1e-8  # an inner eigenvalue smaller than this, relative to the largest, is not condensed over
DENSE = 3000  # order up to which eigenvalues are computed where condensation will not do


class Layout(NamedTuple):
    """Where the entries of the blocks go in LAPACK's bands: for N blocks of degree m."""

    general: Array  # into the band of dgbtrf
    positive: Array  # into the lower band of dpbtrf
    taken: Array  # of the flat blocks, for the first
    lower: Array  # for the second


def layout(N: int, m: int) -> Layout:
    """The places of all entries but those of the clamped node and the shared corners."""
    i, a, b = (index.ravel() for index in np.meshgrid(np.arange(N), np.arange(m + 1), np.arange(m + 1), indexing="ij"))
    row, column = i * m + a - 1, i * m + b - 1
    flat = np.arange(i.size)
    inside = (row >= 0) & (column >= 0) & ~((a == 0) & (b == 0))
    below = inside & (row >= column)
    general = column * (3 * m + 1) + 2 * m + row - column
    positive = column * (m + 1) + row - column
    return Layout(general[inside], positive[below], flat[inside], flat[below])


class Condensed(NamedTuple):
    """The ends of intervals after their inner nodes are eliminated: S (N, 2, 2), F = B_ii^{-1} B_ie, and the inner inverse."""

    S: Array
    F: Array
    inverse: Array

    @property
    def diagonal(self) -> Array:
        """Diagonal of the tridiagonal matrix of the mesh points, (N,); its couplings are S_01."""
        return Collocated.gathered(np.einsum("iaa->ia", self.S))

    def springs(self, rest: Array) -> tuple[Array, Array]:
        """k (N,) between the ends, and the response of the ends (N, 2) to a turn of all nodes, whose rows sum to `rest` (N, m+1).

        The same matrix as D^T k D - C with C the responses, summed and negative: no stiffness takes part in them.
        """
        return -self.S[:, 0, 1], rest[:, [0, -1]] - (rest[:, None, 1:-1] @ self.F)[:, 0]


class Collocated(Symmetric):
    """The matrix of `blocks` (N, m+1, m+1), each symmetric; the first node is clamped.

    >>> A = Collocated(np.array([[[1.0, -1.0], [-1.0, 1.0]]] * 3))      # three springs in a row, degree 1
    >>> A.toarray()
    array([[ 2., -1.,  0.],
           [-1.,  2., -1.],
           [ 0., -1.,  1.]])
    >>> A.solve(np.array([0.0, 0.0, 1.0])), A.index
    (array([1., 2., 3.]), 0)
    """

    def __init__(self, blocks: Array, places: Layout | None = None) -> None:
        N, m = blocks.shape[0], blocks.shape[1] - 1
        self.foot = float(blocks[0, 0, 0])  # what belongs to the clamped node, for a rod whose foot turns
        blocks[:-1, m, m] += blocks[1:, 0, 0]
        blocks[:, 0, 0] = 0.0  # a shared corner is kept once
        self.blocks, self.N, self.m = blocks, N, m
        self.parts: Callable[[Array], tuple[float, float]] | None = None  # x -> x . A x, by what the blocks were summed from
        self.layout = layout(N, m) if places is None else places

    @property
    def shape(self) -> tuple[int, int]:
        """(N m, N m)."""
        return (self.N * self.m, self.N * self.m)

    @property
    def diagonal(self) -> Array:
        """Diagonal entries, shape (N m,)."""
        return np.asarray(np.einsum("iaa->ia", self.blocks)[:, 1:].ravel())

    def toarray(self) -> Array:
        """The dense matrix."""
        n, m = self.shape[0], self.m
        full = np.zeros((n + 1, n + 1))
        for i, block in enumerate(self.blocks):
            full[i * m : i * m + m + 1, i * m : i * m + m + 1] += block
        return full[1:, 1:]

    def __matmul__(self, x: Array) -> Array:
        nodal = self.spread(x)
        return self.gathered((self.blocks @ nodal[:, :, None])[:, :, 0])

    def __abs__(self) -> "Collocated":
        return Collocated(np.abs(self.blocks), self.layout)

    def shifted(self, mu: Array | float | Slack) -> "Collocated":
        """A + mu I, A + diag(mu), or A and what a slack may add to it."""
        if isinstance(mu, Slack):
            wider = Collocated(self.blocks + mu.grid.soft(mu.values), self.layout)
            return wider.shifted(mu.level) if mu.level else wider
        blocks = self.blocks.copy()
        np.einsum("iaa->ia", blocks)[:, 1:] += np.broadcast_to(mu, self.N * self.m).reshape(self.N, self.m)
        return Collocated(blocks, self.layout)

    def spread(self, x: Array) -> Array:
        """Unknowns (N m,) as nodal values (N, m+1), zero at the clamp."""
        nodal = np.empty((self.N, self.m + 1))
        nodal[:, 1:] = x.reshape(self.N, self.m)
        nodal[0, 0] = 0.0
        nodal[1:, 0] = nodal[:-1, -1]
        return nodal

    @staticmethod
    def gathered(nodal: Array) -> Array:
        """Contributions (N, m+1) of the intervals to their nodes, summed: (N m,)."""
        out = nodal[:, 1:].copy()
        out[:-1, -1] += nodal[1:, 0]
        return out.ravel()

    # --- solving -------------------------------------------------------------------------------------------------

    def factor(self) -> "BandFactor":
        """L U with partial pivoting, for many right-hand sides."""
        return BandFactor(self)

    def solve(self, b: Array) -> Array:
        """x with A x = b, once."""
        return self.factor().solve(vector("b", b, self.shape[0]))

    # --- index ---------------------------------------------------------------------------------------------------

    def condensed(self) -> Condensed:
        """The intervals with their inner nodes eliminated. Raises `ArithmeticError` where an inner block is singular."""
        m, B = self.m, self.blocks
        ends = B[:, ::m, ::m]
        if m == 1:
            return Condensed(ends, np.zeros((self.N, 0, 2)), np.zeros((self.N, 0, 0)))
        coupling = B[:, 1:m, ::m]
        try:
            inverse = np.linalg.inv(B[:, 1:m, 1:m])
        except np.linalg.LinAlgError as error:
            raise ArithmeticError("an interval's inner nodes cannot be condensed: its own problem is singular") from error
        F = np.asarray(inverse @ coupling)
        return Condensed(ends - coupling.transpose(0, 2, 1) @ F, F, np.asarray(inverse))

    def inertia(self, slack: Array | float | Slack = 0.0) -> Inertia:
        """Signs of the eigenvalues of every symmetric matrix within a slack, and rounding, of this one."""
        rounding = 8 * self.m * EPS * self._row_sums
        lower, upper = self, self
        if isinstance(slack, Slack):
            soft = slack.grid.soft(slack.values)
            lower, upper = (Collocated(self.blocks + side * soft, self.layout) for side in (-1, 1))
            slack = slack.level
        spread = slack + rounding
        most = lower.shifted(-spread)._count(most=True)
        least = most and upper.shifted(spread)._count(most=False)
        return Inertia(least, max(most - least, 0), self.shape[0] - max(most, least))

    def index_within(self, slack: Array | float | Slack) -> int | None:
        """The index that all symmetric matrices within a slack of this one share; None where they do not, or may not."""
        known = self.inertia(slack)
        return known.negative if known.verified else None

    @cached_property
    def _row_sums(self) -> Array:
        return self.gathered(np.abs(self.blocks).sum(axis=2))

    def _count(self, *, most: bool) -> int:
        """Negative eigenvalues, at most or at least: by Cholesky's factor if there are none, else condensed."""
        if self._is_positive():
            return 0
        m, worst = self.m, 0
        if not self.is_steady():
            inner = np.linalg.eigvalsh(self.blocks[:, 1:m, 1:m])
            if float(np.abs(inner).min()) <= STEADY * float(np.abs(inner).max()):
                return self._counted(most=most)
            worst = int((inner < 0).sum())
        known = self.condensed()
        size = np.abs(self.blocks[:, ::m, ::m]).sum(axis=2) + np.abs(known.S).sum(axis=2)
        if m > 1:
            size += (np.abs(self.blocks[:, ::m, 1:m]) @ np.abs(known.F)).sum(axis=2)
        rounding = 8 * m * EPS * self.gathered(size)
        found = Tridiagonal.of(known.diagonal, known.S[1:, 0, 1]).inertia(rounding)
        return worst + found.negative + (found.unclear if most else 0)

    def is_steady(self) -> bool:
        """True when every interval by itself, its ends held, is certainly stable."""
        if self.m == 1:
            return True
        inner = self.blocks[:, 1 : self.m, 1 : self.m].copy()
        diagonal = np.einsum("iaa->ia", inner)
        diagonal -= STEADY * np.abs(diagonal).max()
        try:
            np.linalg.cholesky(inner)
        except np.linalg.LinAlgError:
            return False
        return True

    def _is_positive(self) -> bool:
        m = self.m
        band = np.zeros((self.N * m, m + 1))
        band.ravel()[self.layout.positive] = self.blocks.ravel()[self.layout.lower]
        return bool(lapack.dpbtrf(band.T, lower=1, overwrite_ab=1)[1] == 0)

    def _counted(self, *, most: bool) -> int:
        """By eigenvalues; where there are too many, nothing is known."""
        if self.shape[0] > DENSE:
            return self.shape[0] if most else 0
        w = np.linalg.eigvalsh(self.toarray())
        bound = self.shape[0] * EPS * float(np.abs(w).max())
        return int((w < (bound if most else -bound)).sum())


class BandFactor:
    """P A = L U of the band (dgbtrf). Zero pivots are replaced by eps times the largest entry."""

    def __init__(self, matrix: Collocated) -> None:
        self.matrix, m = matrix, matrix.m
        band = np.zeros((matrix.N * m, 3 * m + 1))
        band.ravel()[matrix.layout.general] = matrix.blocks.ravel()[matrix.layout.taken]
        self.lu, self.order, info = lapack.dgbtrf(band.T, m, m, overwrite_ab=1)
        if info > 0:
            pivots = self.lu[2 * m]
            pivots[pivots == 0] = EPS * float(np.abs(matrix.blocks).max()) or TINY

    def solve(self, b: Array, /) -> Array:
        """x with A x = b."""
        m = self.matrix.m
        return np.asarray(lapack.dgbtrs(self.lu, m, m, b, self.order)[0])

    def solve_transposed(self, b: Array, /) -> Array:
        """The same: A is symmetric."""
        return self.solve(b)

    def sign(self) -> int:
        """Sign of the determinant; 0 where A is singular to working precision."""
        exchanges = int(np.count_nonzero(self.order != np.arange(self.order.size)))
        return sign_of_pivots(self.lu[2 * self.matrix.m], exchanges)

    def inertia(self) -> Inertia:
        """Signs of the eigenvalues of A."""
        return self.matrix.inertia()
