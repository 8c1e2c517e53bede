"""A symmetric matrix with a border: unknowns that stand alone, and multipliers of constraints.

    [ D   B^T ] [p]       p (m,)   multipliers first, c of them, then other unknowns of their own
    [ B   A   ] [y]       y (n,)   A banded or full, known by its own factor

Second variation of V(y; p), stationary in all: where p_j is a multiplier its row says B_j . y = 0, and the index of V on the y
that obey it is that of the whole matrix less c [Haynsworth 1968; Maddocks 1987: constrained quadratic forms]:

    index = index(A) + index(D - B^T A^{-1} B) - c
"""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.bordered import Bordered
from rodlab.numerics.factor import factor, inertia_of, largest_change, shifted
from rodlab.numerics.inertia import Inertia, Symmetric
from rodlab.numerics.nullspace import quadratic

NUDGES = (1.0, 8.0, 64.0, 512.0)  # shifts tried where A itself is singular to within rounding
CLEAR = 64 * EPS  # of the parts of the small matrix
TRUSTED = 1e-6  # relative size of a refinement above which elimination is not trusted


class Constrained(Symmetric):
    """The matrix above, in the order (p, y); `constraints` is c, and the index that of the constrained form.

    noise: how far the entries of each column of the border may be off; one that is nothing but rounding constrains nothing.

    >>> A = Constrained(np.diag([1.0, -1.0]), np.array([[0.0], [1.0]]), np.zeros((1, 1)), constraints=1)       # y_2 = 0
    >>> A.index, A.solve(np.array([2.0, 3.0, 0.0]))
    (0, array([2., 3., 2.]))
    """

    def __init__(self, matrix: Any, border: Array, corner: Array, constraints: int, noise: Array | float = 0.0) -> None:
        self.matrix, self.border, self.corner, self.constraints = matrix, border, corner, constraints
        self.noise = np.broadcast_to(noise, corner.shape[:1])  # of the entries of each column of the border

    @property
    def width(self) -> int:
        """m."""
        return int(self.corner.shape[0])

    @property
    def shape(self) -> tuple[int, int]:
        """(m + n, m + n)."""
        size = sum(self.border.shape)
        return (size, size)

    @property
    def diagonal(self) -> Array:
        """Diagonal entries."""
        own = np.diagonal(self.matrix) if isinstance(self.matrix, np.ndarray) else self.matrix.diagonal
        return np.append(np.diagonal(self.corner), own)

    def toarray(self) -> Array:
        """The dense matrix."""
        A = self.matrix if isinstance(self.matrix, np.ndarray) else self.matrix.toarray()
        return np.block([[self.corner, self.border.T], [self.border, A]])

    def __matmul__(self, x: Array) -> Array:
        p, y = x[: self.width], x[self.width :]
        return np.append(self.corner @ p + self.border.T @ y, self.matrix @ y + self.border @ p)

    def __abs__(self) -> "Constrained":
        return Constrained(abs(self.matrix), np.abs(self.border), np.abs(self.corner), self.constraints)

    def quadratic(self, x: Array, of: Callable[[Any, Array], tuple[float, float]] = quadratic) -> tuple[float, float]:
        """x . A x and a bound on its rounding; `of` knows that of the matrix A alone."""
        p, y = x[: self.width], x[self.width :]
        value, rounding = of(self.matrix, y)
        rest = 2 * float(p @ (self.border.T @ y)) + float(p @ self.corner @ p)
        size = 2 * float(np.abs(p) @ (np.abs(self.border).T @ np.abs(y))) + float(np.abs(p) @ np.abs(self.corner) @ np.abs(p))
        return value + rest, rounding + 4 * EPS * size

    def shifted(self, mu: Any) -> "Constrained":
        """A + mu, or A + diag(mu) with one entry for each y; the border as it is."""
        return Constrained(shifted(self.matrix, mu), self.border, self.corner, self.constraints, self.noise)

    def largest_change(self, other: "Constrained") -> float:
        """Bound on the change of A, its border left aside: a slack is one of A."""
        return largest_change(self.matrix, other.matrix)

    # --- solving -------------------------------------------------------------------------------------------------

    def factor(self) -> "ConstrainedFactor":
        """A factor for many right-hand sides: that of A, and the border around it."""
        return ConstrainedFactor(self)

    def solve(self, b: Array) -> Array:
        """(p, y) with the matrix times it equal to b, refined once."""
        return self.factor().solve(b)

    # --- index ---------------------------------------------------------------------------------------------------

    def inertia(self, slack: Array | float = 0.0) -> Inertia:
        """Signs of the eigenvalues on the constrained y, of every A within diag(slack), and rounding, of this one."""
        low, high = max(self._negative(slack, 1)[0], 0), max(self._negative(slack, -1)[1], 0)
        total = max(0, self.shape[0] - 2 * self.constraints)
        if self.corner[: self.constraints, : self.constraints].any():  # multipliers that yield leave what was eliminated
            total = max(total, high)
        if low > min(high, total):  # constraints that depend on each other
            return Inertia(0, total, 0)
        high = min(high, total)
        return Inertia(low, high - low, total - high)

    def index_within(self, slack: Array | float) -> int | None:
        """The index that all within a slack share; None where they do not, or may not."""
        known = self.inertia(slack)
        return known.negative if known.verified else None

    def _negative(self, slack: Array | float, side: int) -> tuple[int, int]:
        """Least and most negative eigenvalues with A raised (side 1) or lowered (-1) by the slack, and until A is clear."""
        small = EPS * float(np.abs(self._size).max())
        known, moved = Inertia(0, self.width, 0), self.matrix
        for nudge in NUDGES:
            moved = (
                self.matrix if not (np.any(slack) or nudge > 1) else shifted(self.matrix, side * (slack + (nudge - 1) * small))
            )
            found = inertia_of(moved)
            assert found is not None
            known = found
            if known.verified:
                break
        low, high = self._small(moved)
        return known.negative + low - self.constraints, known.negative + known.unclear + high - self.constraints

    def _small(self, moved: Any) -> tuple[int, int]:
        """Least and most negative eigenvalues of D - B^T A^{-1} B."""
        with np.errstate(all="ignore"):
            known = factor(moved)
            X = np.column_stack([_refined(moved, known, b) for b in self.border.T])
            left = self.border - np.column_stack([moved @ x for x in X.T])
            S = self.corner - self.border.T @ X
            lost = np.abs(X).T @ np.abs(left) + CLEAR * (np.abs(self.corner) + np.abs(self.border).T @ np.abs(X))
            blurred = np.outer(self.noise, np.abs(X).sum(axis=0))
            lost += blurred + blurred.T
            S, lost = _balanced((S + S.T) / 2, lost)  # entries of any size: forces beside angles
        if not (np.isfinite(S).all() and np.isfinite(lost).all()):
            return 0, self.width
        w = np.linalg.eigvalsh(S)
        off = float(lost.sum(axis=1).max()) + CLEAR * self.width
        return int((w < -off).sum()), int((w <= off).sum())

    @cached_property
    def _size(self) -> Array:
        return np.asarray(self.diagonal[self.width :])


class ConstrainedFactor:
    """The factor of A and X = A^{-1} B; where A is too near singular for these, block elimination of the border [Govaerts]."""

    def __init__(self, matrix: Constrained) -> None:
        self.matrix, self.known = matrix, factor(matrix.matrix)
        with np.errstate(all="ignore"):
            self.X = np.column_stack([self.known.solve(b) for b in matrix.border.T])
            self.small = matrix.corner - matrix.border.T @ self.X
        self.plain = bool(np.isfinite(self.small).all())

    @cached_property
    def _bordered(self) -> Bordered:
        matrix = self.matrix
        return Bordered(matrix.matrix, self.known, B=matrix.border, C=matrix.border, D=matrix.corner)

    def solve(self, b: Array, /) -> Array:
        """(p, y), refined once; where that shows A to be too near singular by elimination of the border, and refined twice."""
        if self.plain:
            x = self._eliminated(b)
            if x is not None:
                left = b - self.matrix @ x
                step = self._eliminated(left)
                if step is not None and float(np.abs(step).max()) <= TRUSTED * float(np.abs(x).max(initial=0.0)):
                    return x + step
            self.plain = False
        m, x = self.matrix.width, np.zeros_like(b)
        for _ in range(3):
            left = b - self.matrix @ x
            y, p = self._bordered.solve_once(left[m:], left[:m])
            x = x + np.append(p, y)
        return x

    def _eliminated(self, b: Array) -> Array | None:
        m = self.matrix.width
        with np.errstate(all="ignore"):
            y = self.known.solve(b[m:])
            try:
                p = np.linalg.solve(self.small, b[:m] - self.matrix.border.T @ y)
            except np.linalg.LinAlgError:
                return None
            x = np.append(p, y - self.X @ p)
        return x if np.isfinite(x).all() else None

    def solve_transposed(self, b: Array, /) -> Array:
        """The same: the matrix is symmetric."""
        return self.solve(b)

    def sign(self) -> int:
        """Sign of the determinant; 0 where it is singular to working precision."""
        known = self.matrix.inertia()
        return 0 if known.unclear else (-1) ** (known.negative + self.matrix.constraints)

    def inertia(self) -> Inertia:
        """Signs of the eigenvalues of the constrained form."""
        return self.matrix.inertia()


def _balanced(S: Array, lost: Array) -> tuple[Array, Array]:
    """S and its rounding, scaled from both sides so that the largest entry of every row is about one [Ruiz 2001]."""
    for _ in range(6):
        size = np.sqrt(np.abs(S).max(axis=1))
        size[size == 0] = 1.0
        S, lost = S / np.outer(size, size), lost / np.outer(size, size)
    return S, lost


def _refined(matrix: Any, known: Any, b: Array) -> Array:
    x = known.solve(b)
    return np.asarray(x + known.solve(b - matrix @ x))
