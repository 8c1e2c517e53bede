"""A symmetric tridiagonal matrix T: solves and knows its inertia in linear time.

    T = tridiag(e, d, e)      d (n,) diagonal, e (n-1,) off the diagonal

Inertia by Sturm's sequence: the pivots q_i = d_i - e_{i-1}^2 / q_{i-1} of L D L^T have the signs of the
eigenvalues (Sylvester). Nothing is pivoted and no determinant is formed. The computed signs are the exact ones
of a matrix whose off-diagonal entries differ by less than one unit of rounding each [Kahan 1966; Demmel,
Applied Numerical Linear Algebra, 5.3.4], hence of one between T - E and T + E,
E = diag(4 eps (|e_{i-1}| + |e_i|)): counting both ends either proves the index or says what is unclear.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from rodlab.numerics.arrays import EPS, TINY, Array, is_finite, vector
from rodlab.numerics.inertia import Inertia, Symmetric


@dataclass(frozen=True, eq=False)
class Tridiagonal(Symmetric):
    """Symmetric tridiagonal matrix with `diagonal` (n,) and `off_diagonal` (n-1,).

    >>> T = Tridiagonal(np.array([1.0, 0.0]), np.array([-1.0]))     # a zero pivot, yet nonsingular
    >>> T.index, T.solve(np.array([0.0, 1.0]))
    (1, array([-1., -1.]))
    """

    diagonal: Array
    off_diagonal: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "diagonal", vector("diagonal", self.diagonal))
        if self.diagonal.size == 0:
            raise ValueError("diagonal must have at least one entry; it has none")
        object.__setattr__(self, "off_diagonal", vector("off_diagonal", self.off_diagonal, self.diagonal.size - 1))

    @classmethod
    def of(cls, diagonal: Array, off_diagonal: Array) -> "Tridiagonal":
        """The same from arrays that are known to be finite and of the right shape: they are not looked at again."""
        matrix = cls.__new__(cls)
        object.__setattr__(matrix, "diagonal", diagonal)
        object.__setattr__(matrix, "off_diagonal", off_diagonal)
        return matrix

    @property
    def shape(self) -> tuple[int, int]:
        """(n, n)."""
        return (self.diagonal.size, self.diagonal.size)

    def toarray(self) -> Array:
        """The dense matrix, shape (n, n)."""
        return np.diag(self.diagonal) + np.diag(self.off_diagonal, 1) + np.diag(self.off_diagonal, -1)

    def __abs__(self) -> "Tridiagonal":
        return Tridiagonal(np.abs(self.diagonal), np.abs(self.off_diagonal))

    def __matmul__(self, x: Array) -> Array:
        y = self.diagonal * x
        y[:-1] += self.off_diagonal * x[1:]
        y[1:] += self.off_diagonal * x[:-1]
        return y

    def solve(self, b: Array) -> Array:
        """x with T x = b, linear in n: L D L^T where its pivots stay away from zero, else dgtsv with partial pivoting."""
        n = self.diagonal.size
        b = vector("b", b, n)
        if n == 1:
            return self.factor().solve(b)
        pivots, multipliers = self.diagonal.copy(), self.off_diagonal.copy()
        negative, done = _factor_in_place(pivots, multipliers, 64, closed=False)
        if done == n and (negative == 0 or _away_from_zero(pivots, self.diagonal, self.off_diagonal)):
            x, _ = lapack.dpttrs(pivots, multipliers, b)
            return np.asarray(x)
        *_, x, info = lapack.dgtsv(self.off_diagonal, self.diagonal, self.off_diagonal, b)
        return self.factor().solve(b) if info else np.asarray(x)

    def factor(self) -> "TridiagonalFactor":
        """L U with partial pivoting, for many right-hand sides."""
        return TridiagonalFactor(self)

    def shifted(self, mu: Array | float) -> "Tridiagonal":
        """T + mu I."""
        return Tridiagonal(self.diagonal + mu, self.off_diagonal)

    def inertia(self, slack: Array | float = 0.0) -> Inertia:
        """Signs of the eigenvalues of every symmetric matrix within diag(slack) of this one."""
        spread = np.empty_like(self.diagonal)
        spread[:] = slack
        rounding = np.abs(self.off_diagonal)
        rounding *= 4 * EPS
        spread[:-1] += rounding
        spread[1:] += rounding
        most = count_overwriting(self.diagonal - spread, self.off_diagonal.copy(), closed=True)
        least = most and count_overwriting(self.diagonal + spread, self.off_diagonal.copy(), closed=False)
        return Inertia(least, most - least, self.diagonal.size - most)


class TridiagonalFactor:
    """P T = L U (dgttrf). An exact zero pivot is replaced by eps times the largest entry.

    With a replaced pivot `solve` returns the solution of a matrix one unit of rounding away: large along the null
    vector, as inverse iteration and the bordered solve want it.
    """

    def __init__(self, matrix: Tridiagonal) -> None:
        self.matrix = matrix
        d, e = matrix.diagonal, matrix.off_diagonal
        scale = max(np.abs(d).max(), np.abs(e).max(initial=0.0))
        self._padding = np.zeros(max(0, 3 - d.size))  # LAPACK's Python face takes no order below 3
        if d.size < 3:
            d, e = np.append(d, self._padding + 1.0), np.append(e, self._padding)
        lower, pivots, upper, upper2, order, _ = lapack.dgttrf(e, d, e)
        pivots[pivots == 0] = EPS * scale or TINY
        self._factors = (lower, pivots, upper, upper2, order)

    def solve(self, b: Array) -> Array:
        """x with T x = b."""
        if not (isinstance(b, np.ndarray) and b.size == self.matrix.diagonal.size):  # else of the house: not looked at
            b = vector("b", b, self.matrix.diagonal.size)
        x, _ = lapack.dgttrs(*self._factors, np.append(b, self._padding) if self._padding.size else b)
        return np.asarray(x[: b.size])

    def solve_transposed(self, b: Array) -> Array:
        """x with T^T x = b: the same, T being symmetric."""
        return self.solve(b)

    def sign(self) -> int:
        """Sign of the determinant: that of the number of negative eigenvalues."""
        known = self.inertia()
        return 0 if known.unclear else 1 - 2 * (known.negative % 2)

    def inertia(self) -> Inertia:
        """Signs of the eigenvalues of T."""
        return self.matrix.inertia()


def count_below_zero(diagonal: Array, off_diagonal: Array, *, closed: bool) -> int:
    """Number of eigenvalues < 0 (closed: <= 0) of a tridiagonal matrix, by Sturm's sequence; O(n).

    >>> count_below_zero(np.array([1.0, 0.0, 3.0]), np.zeros(2), closed=False)
    0
    >>> count_below_zero(np.array([1.0, 0.0, 3.0]), np.zeros(2), closed=True)
    1
    """
    return count_overwriting(diagonal.copy(), off_diagonal.copy(), closed=closed)


def count_overwriting(d: Array, e: Array, *, closed: bool) -> int:
    """The same count, overwriting the diagonal `d` and the off-diagonal `e`."""
    if not is_finite(d):
        raise ValueError("diagonal must be finite; an entry overflowed")
    n, below = d.size, int(np.count_nonzero(d < 0))
    if 2 * below > n:  # count the fewer: -T has the positive ones of T
        return n - _count(np.negative(d, out=d), e, n - below, closed=not closed)
    return _count(d, e, below, closed=closed)


def _count(d: Array, e: Array, guess: int, *, closed: bool) -> int:
    few = 64 + d.size // 256  # stopping and starting beats dstebz while negative pivots are few
    negative, done = _factor_in_place(d, e, few if guess < few else 0, closed=closed)
    return negative if done == d.size else negative + _count_by_bisection(d[done:], e[done:], closed=closed)


def _factor_in_place(d: Array, e: Array, stops: int, *, closed: bool) -> tuple[int, int]:
    """T = L D L^T without pivoting: D over d, the multipliers over e; (negative pivots, rows done).

    dpttrf runs to the next pivot that is not positive; after as many stops as allowed the rest is left undone, d holding
    there what is to be factored. An exact zero counts as negative if `closed`.
    """
    n, start, negative = d.size, 0, 0
    for _ in range(stops):
        if start == n - 1:
            return negative + int(d[start] < 0 or (closed and d[start] == 0)), n
        *_, info = lapack.dpttrf(d[start:], e[start:], overwrite_d=1, overwrite_e=1)
        if info == 0:
            return negative, n
        i = start + info - 1
        if d[i] == 0:
            d[i] = -TINY if closed else TINY
        negative += int(d[i] < 0)
        start = i + 1
        if start == n:
            return negative, n
        with np.errstate(over="ignore"):
            multiplier = e[i] / d[i]
            d[start] -= multiplier * e[i]
            e[i] = multiplier
    return negative, start


def _away_from_zero(pivots: Array, diagonal: Array, off_diagonal: Array) -> bool:
    """True when no pivot is so small that elimination without pivoting loses more than half the digits."""
    size = max(float(array.max()) if side > 0 else -float(array.min()) for array in (diagonal, off_diagonal) for side in (1, -1))
    return float(np.abs(pivots).min()) > 1e-7 * size


def _count_by_bisection(d: Array, e: Array, *, closed: bool) -> int:
    """The same count from dstebz: one bisection step of an interval that reaches to zero."""
    scale = max(np.abs(d[1:]).max(initial=0.0), np.abs(e).max(initial=0.0)) or 1.0  # d[0] may carry a huge pivot
    d = np.append(np.clip(d[:1], -1e10 * scale, 1e10 * scale), d[1:]) / scale
    nothing = 4 * TINY if closed else -4 * TINY  # dstebz counts with pivots at least the safe minimum
    found, *_, info = lapack.dstebz(d, np.append(e / scale, 0.0)[: max(1, e.size)], 1, -1e300, nothing, 0, 0, 1e300, "B")
    if info != 0:
        raise ArithmeticError(f"dstebz could not count the eigenvalues (info {info}) of a matrix of order {d.size}")
    return int(found)
