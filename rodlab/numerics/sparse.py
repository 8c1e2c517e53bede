"""A scipy sparse matrix: solved by SuperLU; its inertia by block elimination along the band.

Reverse Cuthill-McKee order gives bandwidth b; cut into blocks of at least b rows the matrix is block tridiagonal, and
the Schur complements S_i = A_i - C_i S_{i-1}^{-1} C_i^T have together the signs of all its eigenvalues
(Sylvester, Haynsworth). Cost O(n b^2); nothing is squared and no determinant is formed. What rounding leaves
unclear is looked for by moving the diagonal both ways, 16 eps |A| times the bandwidth: an estimate, as blocks are not
pivoted against each other.
"""

from typing import Any

import numpy as np
from scipy.sparse import csc_array, eye_array
from scipy.sparse.csgraph import reverse_cuthill_mckee
from scipy.sparse.linalg import splu

from rodlab.numerics.arrays import EPS, TINY, Array, is_finite
from rodlab.numerics.inertia import Inertia, sign_of_pivots


class SparseFactor:
    """P A Q = L U of a sparse matrix; a singular one is factored with its diagonal moved by eps |A|.

    >>> SparseFactor(csc_array(np.diag([1.0, -1.0, 0.0]))).inertia()
    Inertia(negative=1, unclear=1, positive=1)
    """

    def __init__(self, matrix: Any) -> None:
        A = csc_array(matrix).astype(np.float64)
        if A.shape[0] != A.shape[1]:
            raise ValueError(f"the matrix must be square; it has shape {A.shape}")
        if not is_finite(A.data):
            raise ValueError("the matrix must be finite; it has a NaN or infinite entry")
        self.matrix = A
        self._scale = float(np.abs(A.data).max(initial=0.0)) or TINY
        try:
            self._lu: Any = splu(A)
        except RuntimeError:  # SuperLU: "Factor is exactly singular"
            self._lu = splu(csc_array(A + 4 * EPS * self._scale * eye_array(A.shape[0])))

    def solve(self, b: Array, /) -> Array:
        """x with A x = b."""
        return np.asarray(self._lu.solve(b))

    def solve_transposed(self, b: Array, /) -> Array:
        """x with A^T x = b."""
        return np.asarray(self._lu.solve(b, trans="T"))

    def sign(self) -> int:
        """Sign of the determinant: of the pivots, and of both permutations."""
        exchanges = sum(_transpositions(order) for order in (self._lu.perm_r, self._lu.perm_c))
        return sign_of_pivots(self._lu.U.diagonal(), exchanges)

    def inertia(self) -> Inertia | None:
        """Signs of the eigenvalues of A, or None where A is not symmetric."""
        A, n = self.matrix, self.matrix.shape[0]
        if abs(A - A.T).max() > 4 * EPS * self._scale:
            return None
        blocks = _BlockTridiagonal(A)
        spread = 16 * EPS * self._scale * blocks.width
        least, most = blocks.negatives(spread), blocks.negatives(-spread)
        return Inertia(least, most - least, n - most)


def _transpositions(order: Any) -> int:
    """Exchanges that make up a permutation: its size less its cycles."""
    seen, cycles = np.zeros(len(order), dtype=bool), 0
    for start in range(len(order)):
        if not seen[start]:
            cycles += 1
            while not seen[start]:
                seen[start] = True
                start = int(order[start])  # noqa: PLW2901
    return len(order) - cycles


class _BlockTridiagonal:
    """A reordered into diagonal blocks A_i and blocks C_i below them, dense one at a time."""

    def __init__(self, A: Any) -> None:
        order = reverse_cuthill_mckee(A.tocsr(), symmetric_mode=True)
        self.A = A.tocsr()[order][:, order].tocsr()
        rows, columns = self.A.nonzero()
        self.width = max(16, int(np.abs(rows - columns).max(initial=0)))

    def negatives(self, spread: float) -> int:
        """Number of negative eigenvalues of A + spread I."""
        n, b, count = self.A.shape[0], self.width, 0
        carried = np.zeros((b, b))
        for start in range(0, n, b):
            stop = min(start + b, n)
            rows = self.A[start:stop]
            S = rows[:, start:stop].toarray() + spread * np.eye(stop - start) - carried[: stop - start, : stop - start]
            w, V = np.linalg.eigh((S + S.T) / 2)
            count += int((w < 0).sum())
            w = np.where(np.abs(w) < TINY / EPS, TINY / EPS, w)
            C = self.A[stop : stop + b, start:stop].toarray() @ V
            carried = (C / w) @ C.T
        return count
