"""A tridiagonal matrix known by its factors: springs between neighbours, and a diagonal.

    A = D^T diag(k) D - diag(c),   (D y)_i = y_i - y_{i-1},  y_0 = 0,   k (n,) positive, c (n,)
    diagonal k_i + k_{i+1} - c_i (last: k_n - c_n), off the diagonal -k_{i+1}

Summing k_i + k_{i+1} throws digits away: for n equal springs the entries are n^2 times larger than the smallest
eigenvalue, so at n = 10^6 the summed form knows it to 4 digits. The *mixed* form keeps the spring moments
m_i = k_i (y_i - y_{i-1}) as unknowns beside y and sums nothing. With A y = r it reads

    -m_i / k_i - y_{i-1} + y_i = 0,    m_i - m_{i+1} - c_i y_i = r_i:

again symmetric and tridiagonal, of order 2 n, in (m_1, y_1, m_2, y_2, ...). Its inertia is that of A and n negative
eigenvalues [Haynsworth 1968], and now rounding moves k and c only by a relative 4 n eps at most. The recurrence
in i is the linearised initial value problem: the sign changes counted are discrete conjugate points.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rodlab.numerics.arrays import EPS, Array, is_finite, vector
from rodlab.numerics.inertia import Inertia, Symmetric
from rodlab.numerics.tridiagonal import Tridiagonal, TridiagonalFactor, count_below_zero, count_overwriting


@dataclass(frozen=True, eq=False)
class Springs:
    """The spring constants k (n,) of D^T diag(k) D, all positive, with what depends on them alone."""

    k: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "k", vector("k", self.k))
        if self.k.size == 0 or not self.k.min() > 0:
            raise ValueError(f"k must be positive; entry {int(self.k.argmin()) if self.k.size else 0} is not")

    @cached_property
    def diagonal(self) -> Array:
        """k_i + k_{i+1}, the last k_n."""
        d = self.k.copy()
        d[:-1] += self.k[1:]
        return d

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """The diagonal lowered and raised by what rounding of the sums and of Sturm's sequence can do."""
        return (1 - 8 * EPS) * self.diagonal, (1 + 8 * EPS) * self.diagonal

    @cached_property
    def off_diagonal(self) -> Array:
        """-k_{i+1}."""
        return np.negative(self.k[1:])

    @cached_property
    def compliance(self) -> Array:
        """1 / k_i."""
        return np.asarray(1.0 / self.k)

    @cached_property
    def total_compliance(self) -> float:
        """Sum of 1 / k_i."""
        return float(self.compliance.sum())

    @cached_property
    def summing_hurts(self) -> bool:
        """True when rounding of k_i + k_{i+1} matters to the whole chain: eps sum(k) sum(1/k) above 1/1000."""
        return bool(EPS * self.k.sum() * self.total_compliance > 1e-3)


class DifferenceForm(Symmetric):
    """A = D^T diag(k) D - diag(c), symmetric tridiagonal, with the accuracy of its factors.

    >>> A = DifferenceForm(Springs(np.array([1.0, 1e-20])), np.array([0.0, 1e-21]))
    >>> A.solve(np.array([0.0, 9e-21]))         # a solve with the sums of the springs would not see the soft one
    array([1.e-20, 1.e+00])
    >>> A.index, A.nullity
    (0, 0)
    """

    def __init__(self, springs: Springs, c: Array, spread: float = 0.0) -> None:
        self.springs, self.spread = springs, spread
        self.c = vector("c", c, springs.k.size)

    @property
    def shape(self) -> tuple[int, int]:
        """(n, n)."""
        return (self.c.size, self.c.size)

    @cached_property
    def summed(self) -> Tridiagonal:
        """The same matrix by its entries."""
        return Tridiagonal.of(self.springs.diagonal - self.c, self.springs.off_diagonal)

    @property
    def diagonal(self) -> Array:
        """Entries (i, i), shape (n,)."""
        return self.summed.diagonal

    @property
    def off_diagonal(self) -> Array:
        """Entries (i, i+1), shape (n-1,)."""
        return self.summed.off_diagonal

    def toarray(self) -> Array:
        """The dense matrix, shape (n, n)."""
        return self.summed.toarray()

    def __abs__(self) -> Tridiagonal:
        return abs(self.summed)

    def __matmul__(self, y: Array) -> Array:
        moment = self.springs.k * np.diff(y, prepend=0.0)
        out = moment - self.c * y
        out[:-1] -= moment[1:]
        return np.asarray(out)

    def quadratic(self, y: Array) -> tuple[float, float]:
        """y . A y = sum k (D y)^2 - sum c y^2, and a bound on its rounding: of the two sums, not of the entries."""
        stretched, pressed = self.springs.k @ np.diff(y, prepend=0.0) ** 2, self.c * y * y
        size = float(stretched + np.abs(pressed).sum())
        return float(stretched - pressed.sum()), 4 * EPS * size * max(1.0, np.log2(y.size)) + self.spread * float(y @ y)

    def solve(self, r: Array) -> Array:
        """y with A y = r, linear in n: by the entries where they keep at least three digits, else by the mixed form.

        Enough for Newton's method, whose residual decides; at 10^6 equal springs the entries keep four digits.
        """
        return self.solve_fully(r) if self.springs.summing_hurts else self.summed.solve(r)

    def solve_fully(self, r: Array) -> Array:
        """y with A y = r by the mixed form: to a relative 4 n eps in k and c, at twice the price."""
        return self._mixed_solution(self._mixed().solve(self._mixed_side(vector("b", r, self.c.size))))

    def factor(self) -> "DifferenceFactor":
        """A factor for many right-hand sides, of whichever form `solve` would use."""
        return DifferenceFactor(self)

    def shifted(self, mu: Array | float) -> "DifferenceForm":
        """A + mu I, or A + diag(mu)."""
        return DifferenceForm(self.springs, self.c - mu, self.spread)

    def inertia(self, slack: Array | float = 0.0) -> Inertia:
        """Signs of the eigenvalues of every D^T k D - diag(c') with |c' - c| <= slack + `spread` + 4 eps |c|.

        The entries decide first, at half the price; what they leave unclear the mixed form may still decide.
        """
        n, spread = self.c.size, self._spread(slack)
        least, most = self._counted(spread)
        return Inertia(least, 0, n - least) if least == most else self._mixed_inertia(spread)

    def index_within(self, slack: Array | float) -> int | None:
        """The index that all D^T k D - diag(c') with |c' - c| <= slack share; None where they do not, or may not.

        The mixed form is asked only where rounding of the entries, not the slack, is what leaves it open.
        """
        spread = self._spread(slack)
        least, most = self._counted(spread)
        if least == most:
            return least
        if 8 * EPS * float(self.springs.k.max()) < float(spread.max()) / 4:
            return None
        known = self._mixed_inertia(spread)
        return None if known.unclear else known.negative

    def _spread(self, slack: Array | float) -> Array:
        spread = np.abs(self.c)
        spread *= 4 * EPS
        spread += slack
        if self.spread:
            spread += self.spread
        return spread

    def _counted(self, spread: Array) -> tuple[int, int]:
        """Least and most negative eigenvalues with c within the spread, by the entries."""
        low, high = self.springs.bounds
        d, e = low - self.c, self.springs.off_diagonal.copy()
        d -= spread
        most = least = count_overwriting(d, e, closed=True)
        if most:  # the same two arrays again: fresh ones of this size cost as much as the count
            np.subtract(high, self.c, out=d)
            d += spread
            e[:] = self.springs.off_diagonal
            least = count_overwriting(d, e, closed=False)
        return least, most

    def _mixed(self, spread: Array | float = 0.0, side: int = 0) -> Tridiagonal:
        """The mixed form, divided by a factor that gives compliances and c one size; c moved by side * spread."""
        n = self.c.size
        d = np.empty(2 * n)
        d[0::2] = (-self._balance) * self.springs.compliance
        d[1::2] = (self.c + side * spread) / -self._balance
        e = np.ones(2 * n - 1)
        e[1::2] = -1.0
        if side:
            d += (-side * 8 * EPS) * np.maximum(np.abs(d), 1.0)
        return Tridiagonal(d, e)

    @cached_property
    def _balance(self) -> float:
        """a in m = a m^: then -a / k and -c / a stand on the diagonal between ones."""
        c = float(np.abs(self.c).mean())
        a = float(np.sqrt(c / self.springs.compliance.mean()))
        return a if a > 0 and np.isfinite(a) else float(1 / self.springs.compliance.max())

    def _mixed_side(self, r: Array) -> Array:
        side = np.zeros(2 * r.size)
        side[1::2] = r / self._balance
        return side

    def _mixed_solution(self, my: Array) -> Array:
        return my[1::2].copy()

    def _mixed_inertia(self, spread: Array) -> Inertia:
        n = self.c.size
        least, most = self._mixed(spread, -1), self._mixed(spread, 1)
        if not (is_finite(least.diagonal) and is_finite(most.diagonal)):
            return Inertia(0, n, 0)
        low = max(0, count_below_zero(least.diagonal, least.off_diagonal, closed=False) - n)
        high = min(n, count_below_zero(most.diagonal, most.off_diagonal, closed=True) - n)
        return Inertia(low, high - low, n - high)


class DifferenceFactor:
    """L U of a `DifferenceForm`, by its entries or in the mixed form."""

    def __init__(self, matrix: DifferenceForm) -> None:
        self.matrix = matrix
        self._mixed = matrix.springs.summing_hurts
        self._factor: TridiagonalFactor = (matrix._mixed() if self._mixed else matrix.summed).factor()

    def solve(self, r: Array) -> Array:
        """y with A y = r."""
        if not self._mixed:
            return self._factor.solve(r)
        return self.matrix._mixed_solution(self._factor.solve(self.matrix._mixed_side(r)))

    def solve_transposed(self, r: Array) -> Array:
        """y with A^T y = r: the same, A being symmetric."""
        return self.solve(r)

    def sign(self) -> int:
        """Sign of the determinant: that of the number of negative eigenvalues."""
        known = self.inertia()
        return 0 if known.unclear else 1 - 2 * (known.negative % 2)

    def inertia(self) -> Inertia:
        """Signs of the eigenvalues of A."""
        return self.matrix.inertia()
