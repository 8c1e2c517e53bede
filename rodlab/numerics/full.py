"""A symmetric matrix without zeros to use: what couples everything with everything. O(n^2) to store, O(n^3) to solve."""

import numpy as np

from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.factor import DenseFactor, dense_inertia
from rodlab.numerics.inertia import Inertia, Symmetric


def relative_change(A: Array, B: Array) -> float:
    """The largest |x . (B - A) x| / x . |A| x: below one no symmetric matrix between A and B is singular; inf where A is.

    >>> relative_change(np.diag([1.0, 1e-6]), np.diag([1.5, 1.2e-6]))
    0.5
    """
    w, Q = np.linalg.eigh(A)
    size = np.abs(w)
    if not size.min() > 4 * size.size * EPS * size.max():
        return np.inf
    R = Q / np.sqrt(size)
    return float(np.abs(np.linalg.eigvalsh(R.T @ (B - A) @ R)).max())


class Full(Symmetric):
    """A dense symmetric matrix with the face of the structured ones.

    >>> A = Full(np.array([[0.0, 1.0], [1.0, 0.0]]))
    >>> A.index, A.solve(np.array([1.0, 2.0]))
    (1, array([2., 1.]))
    """

    def __init__(self, entries: Array) -> None:
        self._entries = entries

    @property
    def shape(self) -> tuple[int, int]:
        """(n, n)."""
        return (self._entries.shape[0], self._entries.shape[0])

    @property
    def diagonal(self) -> Array:
        """Entries (i, i), shape (n,)."""
        return np.diagonal(self._entries).copy()

    @property
    def off_diagonal(self) -> Array:
        """Entries (i, i+1), shape (n-1,); the matrix has others."""
        return np.diagonal(self._entries, 1).copy()

    def toarray(self) -> Array:
        """The dense matrix, shape (n, n)."""
        return self._entries.copy()

    def __abs__(self) -> "Full":
        return Full(np.abs(self._entries))

    def __matmul__(self, x: Array) -> Array:
        return np.asarray(self._entries @ x)

    def largest_change(self, other: "Full") -> float:
        """The 2-norm of the difference."""
        return float(np.abs(np.linalg.eigvalsh(self._entries - other._entries)).max())

    def solve(self, b: Array) -> Array:
        """x with A x = b."""
        return self.factor().solve(b)

    def factor(self) -> DenseFactor:
        """L U with partial pivoting."""
        return DenseFactor(self._entries)

    def shifted(self, mu: Array | float) -> "Full":
        """A + mu I, or A + diag(mu)."""
        return Full(self._entries + mu * np.eye(self.shape[0]))

    def inertia(self, slack: Array | float = 0.0) -> Inertia:
        """Signs of the eigenvalues of every symmetric matrix within diag(slack), and rounding, of this one."""
        known = dense_inertia((self._entries + self._entries.T) / 2, float(np.max(slack)))
        assert known is not None  # it was made symmetric
        return known
