"""One door to every matrix: structured, dense or sparse, `factor(A)` solves, solves transposed and knows inertia.

A structured matrix brings its own factor; a numpy array is factored by LAPACK, a scipy sparse one by SuperLU. Zero
pivots are perturbed by eps times the norm, so that the factor of a singular matrix still serves a bordered solve.
"""

from typing import Any, Protocol

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from rodlab.numerics.arrays import EPS, TINY, Array, is_finite
from rodlab.numerics.inertia import Inertia, sign_of_pivots


class Solves(Protocol):
    """A factored matrix A of shape (n, n): solves with it and with its transpose."""

    def solve(self, b: Array, /) -> Array:
        """x with A x = b."""
        ...

    def solve_transposed(self, b: Array, /) -> Array:
        """x with A^T x = b."""
        ...


class Factor(Solves, Protocol):
    """A factored matrix that also knows its inertia, or at least the sign of its determinant."""

    def sign(self) -> int:
        """Sign of the determinant; 0 where A is singular to working precision."""
        ...

    def inertia(self) -> Inertia | None:
        """Signs of the eigenvalues of A; None where A is not symmetric and so has no index."""
        ...


def factor(matrix: Any) -> Factor:
    """The factor of a structured matrix, a numpy array or a scipy sparse matrix.

    Raises `ValueError` when it is none of these, not square or not finite.

    >>> factor(np.diag([2.0, -1.0])).inertia()
    Inertia(negative=1, unclear=0, positive=1)
    """
    if hasattr(matrix, "factor"):
        structured: Factor = matrix.factor()
        return structured
    if hasattr(matrix, "tocsc"):
        from rodlab.numerics.sparse import SparseFactor

        return SparseFactor(matrix)
    return DenseFactor(matrix)


def solve(matrix: Any, b: Array) -> Array:
    """x with A x = b, once: a structured matrix may know a shorter way than its factor."""
    if hasattr(matrix, "solve"):
        return np.asarray(matrix.solve(b))
    return factor(matrix).solve(b)


def inertia_of(matrix: Any, slack: float = 0.0) -> Inertia | None:
    """Signs of the eigenvalues of every matrix within slack of this one, of any kind; None where it is not symmetric.

    >>> inertia_of(np.diag([1.0, -1.0, 1e-3]), slack=0.01)
    Inertia(negative=1, unclear=1, positive=1)
    """
    if hasattr(matrix, "inertia"):
        structured: Inertia = matrix.inertia(slack)
        return structured
    known = factor(matrix).inertia()
    if known is None or known.unclear or slack == 0:
        return known
    least, most = (factor(shifted(matrix, side * slack)).inertia() for side in (1, -1))
    assert least is not None
    assert most is not None
    return Inertia(least.negative, most.negative + most.unclear - least.negative, most.positive)


def index_within(matrix: Any, slack: Array | float) -> int | None:
    """The index that all symmetric matrices within diag(slack) of this one share; None where they do not, or may not.

    >>> index_within(np.diag([1.0, -1.0]), slack=0.5), index_within(np.diag([1.0, -1.0]), slack=1.5)
    (1, None)
    """
    if hasattr(matrix, "index_within"):
        shared: int | None = matrix.index_within(slack)
        return shared
    known = inertia_of(matrix, float(np.max(slack)))
    return known.negative if known is not None and known.verified else None


def shifted(matrix: Any, mu: Array | float) -> Any:
    """A + mu I, or A + diag(mu), of the same kind as A.

    >>> shifted(np.eye(1), 2.0)
    array([[3.]])
    """
    if hasattr(matrix, "shifted"):
        return matrix.shifted(mu)
    if hasattr(matrix, "tocsc"):
        from scipy.sparse import eye_array

        return matrix + eye_array(matrix.shape[0]).multiply(mu) if np.ndim(mu) else matrix + mu * eye_array(matrix.shape[0])
    return matrix + mu * np.eye(matrix.shape[0])


def largest_diagonal(matrix: Any) -> float:
    """The largest |a_ii| of a matrix of any kind."""
    diagonal = np.diagonal(matrix) if isinstance(matrix, np.ndarray) else matrix.diagonal
    return float(np.abs(diagonal() if callable(diagonal) else diagonal).max())


def largest_change(a: Any, b: Any) -> float:
    """Bound on the 2-norm of a - b, two symmetric matrices of one kind; a structured one may know its own."""
    if hasattr(a, "largest_change"):
        return float(a.largest_change(b))
    if hasattr(a, "tocsc"):
        return float(abs(a - b).sum(axis=1).max())
    if isinstance(a, np.ndarray) or not hasattr(a, "off_diagonal"):
        a, b = (m if isinstance(m, np.ndarray) else m.toarray() for m in (a, b))
        return float(np.abs(a - b).sum(axis=1).max())
    beside = float(np.abs(a.off_diagonal - b.off_diagonal).max(initial=0.0))
    return float(np.abs(a.diagonal - b.diagonal).max()) + 2 * beside


class DenseFactor:
    """P A = L U of a dense matrix (dgetrf), O(n^3)."""

    def __init__(self, matrix: Any) -> None:
        if np.iscomplexobj(matrix):
            raise ValueError("the matrix must be real; it is complex")
        A = np.asarray(matrix, dtype=np.float64)
        if A.ndim != 2 or A.shape[0] != A.shape[1]:
            raise ValueError(f"the matrix must be square; it has shape {A.shape}")
        if not is_finite(A):
            raise ValueError("the matrix must be finite; it has a NaN or infinite entry")
        self.matrix = A
        with np.errstate(all="ignore"):
            lu, order = _quiet_lu(A)
        pivots = np.einsum("ii->i", lu)
        self._sign = sign_of_pivots(pivots, int(np.count_nonzero(order != np.arange(order.size))))
        pivots[pivots == 0] = EPS * np.abs(A).max(initial=0.0) or TINY
        self._factors = (lu, order)

    def solve(self, b: Array, /) -> Array:
        """x with A x = b."""
        return np.asarray(lu_solve(self._factors, b))

    def solve_transposed(self, b: Array, /) -> Array:
        """x with A^T x = b."""
        return np.asarray(lu_solve(self._factors, b, trans=1))

    def sign(self) -> int:
        """Sign of the determinant: of the pivots, and of the exchanges of rows."""
        return self._sign

    def inertia(self) -> Inertia | None:
        """Signs of the eigenvalues of A, or None where A is not symmetric."""
        return dense_inertia(self.matrix)


def dense_inertia(A: Array, slack: float = 0.0) -> Inertia | None:
    """Signs of the eigenvalues of a dense symmetric matrix to within n eps |A|, or None if it is not symmetric."""
    bound = slack + A.shape[0] * EPS * float(np.abs(A).max(initial=0.0)) * 4
    if np.abs(A - A.T).max(initial=0.0) > bound:
        return None
    w = np.linalg.eigvalsh((A + A.T) / 2)
    negative, positive = int((w < -bound).sum()), int((w > bound).sum())
    return Inertia(negative, w.size - negative - positive, positive)


def _quiet_lu(A: Array) -> tuple[Array, Any]:
    import warnings

    with warnings.catch_warnings():  # scipy warns of the exact zero pivot that is replaced here
        warnings.simplefilter("ignore")
        lu, order = lu_factor(A, check_finite=False)
    return lu, order
