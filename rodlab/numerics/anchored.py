"""The second variation of a strut whose energy is quadratic in the places of its joints: full, known by O(n) numbers.

    A = L + sum_kl J_k^T diag(C_kl) J_l,      xi^k = J_k y:   xi^k_i - xi^k_{i-1} = lower^k_i y_{i-1} + upper^k_i y_i

with xi_0 = y_0 = 0, k = 1..c, and L = D^T diag(s) D - diag(p) a `DifferenceForm`, or a `Tridiagonal`. The springs' moments m, the
changes of place xi and the forces nu that hold them are taken as unknowns beside y:

    [ -1/s   D             ] [m ]   [0]
    [ D^T   -p   0    Q^T  ] [y ] = [r]      P the difference, P xi = Q y the recurrence
    [        0   C   -P^T  ] [xi]   [0]
    [        Q  -P    0    ] [nu]   [0]

a band when ordered joint by joint, whose inertia is that of A and one negative eigenvalue for each m and nu [Haynsworth 1968]. It
is solved by LAPACK (dgbtrf, partial pivoting), and counted by `rodlab.numerics.elimination`. O(n) all of it.
"""

from functools import cached_property

import numpy as np
from scipy.linalg import lapack

from rodlab.numerics.anchored_band import Band
from rodlab.numerics.arrays import EPS, TINY, Array, is_finite, vector
from rodlab.numerics.difference import DifferenceForm
from rodlab.numerics.factor import dense_inertia
from rodlab.numerics.inertia import Inertia, Symmetric, sign_of_pivots
from rodlab.numerics.tridiagonal import Tridiagonal

DENSE = 500  # order up to which eigenvalues are computed where elimination leaves the index open


class Anchored(Symmetric):
    """L + J^T C J with `lower`, `upper` (c, n) and `stiffness` (c, c, n), symmetric in its first two axes; c = 1 or 2.

    >>> from rodlab.numerics.difference import Springs
    >>> one = np.ones((1, 3))
    >>> A = Anchored(DifferenceForm(Springs(np.ones(3)), np.zeros(3)), 0 * one, one, np.ones((1, 1, 3)))
    >>> A.toarray()
    array([[5., 1., 1.],
           [1., 4., 0.],
           [1., 0., 2.]])
    >>> A.solve(np.array([7.0, 5.0, 3.0])).round(12), A.index, A.index_verified
    (array([1., 1., 1.]), 0, True)
    """

    def __init__(self, local: DifferenceForm | Tridiagonal, lower: Array, upper: Array, stiffness: Array) -> None:
        n, c = local.shape[0], np.shape(lower)[0]
        self.local = local
        self.lower, self.upper, self.stiffness = (np.asarray(part, dtype=np.float64) for part in (lower, upper, stiffness))
        for name, shape in (("lower", (c, n)), ("upper", (c, n)), ("stiffness", (c, c, n))):
            part = getattr(self, name)
            if part.shape != shape:
                raise ValueError(f"{name} must have shape {shape}; it has shape {part.shape}")
            if not is_finite(part):
                raise ValueError(f"{name} must be finite; it has a NaN or infinite entry")

    @property
    def shape(self) -> tuple[int, int]:
        """(n, n)."""
        return self.local.shape

    # --- entries: (i, j) of J^T C J is reach_i . pull_j for i < j ---------------------------------------------------

    @cached_property
    def _reach(self) -> Array:
        """How far a unit of y_i moves the joints above i, (c, n)."""
        reach = self.upper.copy()
        reach[:, :-1] += self.lower[:, 1:]
        return reach

    @cached_property
    def _above(self) -> Array:
        """Stiffness of all joints above i, summed, (c, c, n)."""
        total = np.cumsum(self.stiffness[..., ::-1], axis=-1)[..., ::-1]
        return np.append(total[..., 1:], np.zeros((*total.shape[:2], 1)), axis=-1)

    @cached_property
    def _pull(self) -> Array:
        """Forces on all joints at and above j where y_j = 1, summed, (c, n)."""
        return _times(self.stiffness, self.upper) + _times(self._above, self._reach)

    @property
    def diagonal(self) -> Array:
        """Entries (i, i), shape (n,)."""
        both = self.upper * _times(self.stiffness, self.upper) + self._reach * _times(self._above, self._reach)
        return np.asarray(self.local.diagonal + both.sum(axis=0))

    @property
    def off_diagonal(self) -> Array:
        """Entries (i, i+1), shape (n-1,); the matrix has others."""
        return np.asarray(self.local.off_diagonal + (self._reach[:, :-1] * self._pull[:, 1:]).sum(axis=0))

    def toarray(self) -> Array:
        """The dense matrix, shape (n, n)."""
        beside = np.triu(self._reach.T @ self._pull, 2)
        tridiagonal = Tridiagonal.of(self.diagonal, self.off_diagonal)
        return np.asarray(tridiagonal.toarray() + beside + beside.T)

    def __abs__(self) -> "Anchored":
        """A matrix whose entries are at least the absolute values of these."""
        return Anchored(abs(self.local), np.abs(self.lower), np.abs(self.upper), np.abs(self.stiffness))

    def __matmul__(self, y: Array) -> Array:
        held = np.cumsum(_times(self.stiffness, _moved(self.lower, self.upper, y))[:, ::-1], axis=-1)[:, ::-1]
        out = self.local @ y + (self.upper * held).sum(axis=0)
        out[:-1] += (self.lower[:, 1:] * held[:, 1:]).sum(axis=0)
        return np.asarray(out)

    def quadratic(self, y: Array) -> tuple[float, float]:
        """y . A y = y . L y + sum xi . C xi, and a bound on its rounding."""
        n = y.size
        if isinstance(self.local, DifferenceForm):
            value, rounding = self.local.quadratic(y)
        else:
            value = float(y @ (self.local @ y))
            rounding = (n + 8) * EPS * float(np.abs(y) @ (abs(self.local) @ np.abs(y)))
        xi, most = _moved(self.lower, self.upper, y), _moved(np.abs(self.lower), np.abs(self.upper), np.abs(y))
        forces, share = _times(self.stiffness, xi), (n + 8) * EPS
        rounding += 2 * share * float(np.sum(most * _times(np.abs(self.stiffness), np.abs(xi) + share * most)))
        return value + float(np.sum(xi * forces)), rounding

    def shifted(self, mu: Array | float) -> "Anchored":
        """A + mu I, or A + diag(mu)."""
        return Anchored(self.local.shifted(mu), self.lower, self.upper, self.stiffness)

    def largest_change(self, other: "Anchored") -> float:
        """Twice an estimate of the 2-norm of the difference, by the power method."""
        x, size = np.cos(np.arange(self.shape[0]) ** 1.5) + 1.0, 0.0
        for _ in range(8):
            x = x / (float(np.sqrt(x @ x)) or 1.0)
            x = self @ x - other @ x
            size = max(size, float(np.sqrt(x @ x)))
        return 2 * size

    # --- solving ----------------------------------------------------------------------------------------------------

    def solve(self, b: Array) -> Array:
        """y with A y = b, linear in n."""
        return self.factor().solve(vector("b", b, self.shape[0]))

    def solve_fully(self, b: Array) -> Array:
        """The same with the moments as unknowns and refined: no sum of springs, and a residual of each unknown's own size."""
        return AnchoredFactor(self, Band(self, springs=True)).solve_fully(vector("b", b, self.shape[0]))

    def factor(self) -> "AnchoredFactor":
        """L U with partial pivoting, for many right-hand sides; with the moments as unknowns where summing the springs hurts."""
        springs = isinstance(self.local, DifferenceForm) and self.local.springs.summing_hurts
        return AnchoredFactor(self, Band(self, springs=springs))

    # --- index ------------------------------------------------------------------------------------------------------

    def inertia(self, slack: Array | float = 0.0) -> Inertia:
        """Signs of the eigenvalues of every symmetric matrix within diag(slack), and rounding, of this one."""
        n, spread = self.shape[0], np.broadcast_to(slack, self.shape[:1]).astype(np.float64)
        if isinstance(self.local, DifferenceForm):
            spread += 4 * EPS * np.abs(self.local.c) + self.local.spread
        band = Band(self, springs=True)
        most = min(n, max(0, band.count(spread, 1) - band.added))
        least = most and min(most, max(0, band.count(spread, -1) - band.added))
        known = Inertia(least, most - least, n - most)
        if known.unclear and n <= DENSE:
            dense = dense_inertia(self.toarray(), float(spread.max()))
            if dense is not None and dense.unclear < known.unclear:
                return dense
        return known

    def index_within(self, slack: Array | float) -> int | None:
        """The index that all symmetric matrices within diag(slack) of this one share; None where they do not, or may not."""
        known = self.inertia(slack)
        return None if known.unclear else known.negative


def _moved(lower: Array, upper: Array, y: Array) -> Array:
    """The changes of place J y, (c, n)."""
    steps = upper * y
    steps[:, 1:] += lower[:, 1:] * y[:-1]
    return np.asarray(np.cumsum(steps, axis=-1))


def _times(stiffness: Array, xi: Array) -> Array:
    """The forces C xi, (c, n)."""
    return np.asarray(np.einsum("kln,ln->kn", stiffness, xi))


class AnchoredFactor:
    """P K = L U of the band (dgbtrf). Zero pivots are replaced by eps times the largest entry."""

    def __init__(self, matrix: Anchored, band: Band) -> None:
        self.matrix, self.band = matrix, band
        self.lu, self.order, info = band.factored()
        if info > 0:
            pivots = self.lu[2 * band.width]
            largest = max(float(np.abs(entry.values).max()) for entry in band.entries)
            pivots[pivots == 0] = EPS * largest or TINY

    def _solved(self, side: Array) -> Array:
        b = self.band.width
        return np.asarray(lapack.dgbtrs(self.lu, b, b, side.ravel(), self.order)[0]).reshape(side.shape)

    def _side(self, b: Array) -> Array:
        side = np.zeros((self.band.n, self.band.p))
        side[:, self.band.y] = b / self.band.a
        return side

    def solve(self, b: Array, /) -> Array:
        """y with A y = b."""
        return self._solved(self._side(b))[:, self.band.y].copy()

    def solve_fully(self, b: Array, /) -> Array:
        """The same, refined with the residual of all unknowns."""
        side = self._side(b)
        x = self._solved(side)
        for _ in range(2):
            x += self._solved(side - self.band @ x)
        return x[:, self.band.y].copy()

    def solve_transposed(self, b: Array, /) -> Array:
        """The same: A is symmetric."""
        return self.solve(b)

    def sign(self) -> int:
        """Sign of the determinant; 0 where A is singular to working precision."""
        exchanges = int(np.count_nonzero(self.order != np.arange(self.order.size)))
        return sign_of_pivots(self.lu[2 * self.band.width], exchanges + self.band.added)

    def inertia(self) -> Inertia:
        """Signs of the eigenvalues of A."""
        return self.matrix.inertia()
