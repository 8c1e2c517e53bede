"""The band of an `Anchored` matrix: moments, places and forces beside the angles, joint by joint."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.linalg import lapack

from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.difference import DifferenceForm
from rodlab.numerics.elimination import counted_by_elimination

if TYPE_CHECKING:
    from rodlab.numerics.anchored import Anchored


class Entry(NamedTuple):
    """Entries ((i, row), (i - lag, column)) of the band, and their mirror images: one a joint i, the first `lag` unused."""

    row: int
    column: int
    lag: int
    values: Array


class Band:
    """The matrix of all unknowns, in units that give its entries one size: y as it is, m in a, xi in d, nu in a / d.

    A joint's unknowns are m (with `springs`, if there are any), nu, y, xi, in this order: p of them. Divided by a.
    """

    def __init__(self, matrix: "Anchored", *, springs: bool) -> None:
        self.matrix, local = matrix, matrix.local
        self.form = local if springs and isinstance(local, DifferenceForm) else None
        c, self.n = matrix.lower.shape
        self.y = (self.form is not None) + c  # what comes before y adds a negative eigenvalue each
        self.p, self.added = self.y + 1 + c, self.y * self.n
        self.a, self.d = self._units()
        self.entries = list(self._entries(c))
        self.width = max(abs(e.lag * self.p + e.row - e.column) for e in self.entries)

    def _units(self) -> tuple[float, float]:
        """Powers of two, so that nothing is rounded."""
        matrix, local = self.matrix, self.matrix.local
        if isinstance(local, DifferenceForm):
            soft = float(np.abs(local.c).mean()) / float(local.springs.compliance.mean())
            a = max(np.sqrt(soft), 1 / local.springs.total_compliance)
        else:
            a = float(np.abs(local.diagonal).mean() + np.abs(local.off_diagonal).sum() / self.n)
        a = _power_of_two(a)
        step = float(np.maximum(np.abs(matrix.lower), np.abs(matrix.upper)).mean())
        stiff = float(np.abs(matrix.stiffness).mean())
        d = step * self.n
        if stiff > 0 and step > 0:
            d = min(d, (a * step / stiff) ** (1 / 3))
        return a, _power_of_two(d)

    def _entries(self, c: int) -> Iterator[Entry]:
        matrix, local, one, y = self.matrix, self.matrix.local, np.ones(self.n), self.y
        if self.form is not None:
            yield Entry(0, 0, 0, -self.a * self.form.springs.compliance)
            yield Entry(0, y, 0, one)
            yield Entry(0, y, 1, -one)
            yield Entry(y, y, 0, -self.form.c / self.a)
        else:
            yield Entry(y, y, 0, local.diagonal / self.a)
            yield Entry(y, y, 1, np.append(0.0, local.off_diagonal / self.a))
        for k in range(c):
            nu, xi = y - c + k, y + 1 + k
            yield Entry(nu, y, 0, matrix.upper[k] / self.d)
            yield Entry(nu, y, 1, matrix.lower[k] / self.d)
            yield Entry(nu, xi, 0, -one)
            yield Entry(nu, xi, 1, one)
            for m in range(k + 1):
                yield Entry(xi, y + 1 + m, 0, (self.d / self.a * self.d) * matrix.stiffness[k, m])

    def __matmul__(self, x: Array) -> Array:
        """The product with x (n, p)."""
        out = np.zeros_like(x)
        for row, column, lag, values in self.entries:
            here, there = slice(lag, None), slice(None, self.n - lag)
            out[here, row] += values[here] * x[there, column]
            if lag or row != column:
                out[there, column] += values[here] * x[here, row]
        return out

    def factored(self) -> tuple[Array, Any, int]:
        """L U and the exchanges of LAPACK's dgbtrf, and where its first zero pivot is."""
        b = self.width
        band = np.zeros((self.n, self.p, 3 * b + 1))
        for row, column, lag, values in self.entries:
            here, there, below = slice(lag, None), slice(None, self.n - lag), lag * self.p + row - column
            band[there, column, 2 * b + below] = values[here]
            band[here, row, 2 * b - below] = values[here]
        lu, order, info = lapack.dgbtrf(band.reshape(-1, 3 * b + 1).T, b, b, overwrite_ab=1)
        return lu, order, info

    def blocks(self) -> tuple[Array, Array]:
        """Of the joints themselves, and of each with the one below it (the first with none): both (n, p, p)."""
        S, B = np.zeros((2, self.n, self.p, self.p))
        for row, column, lag, values in self.entries:
            if lag:
                B[1:, row, column] = values[1:]
            else:
                S[:, row, column] = S[:, column, row] = values
        return S, B

    def count(self, spread: Array, side: int) -> int:
        """Negative eigenvalues with `spread` taken from the diagonal of A, at most (side 1), or added, at least (side -1)."""
        S, B = self.blocks()
        S[:, self.y, self.y] -= side / self.a * spread
        if self.form is not None:
            S[:, 0, 0] -= side * 2 * EPS * self.a * self.form.springs.compliance
        return counted_by_elimination(S, B, side)


def _power_of_two(x: float) -> float:
    return float(2.0 ** np.round(np.log2(x))) if 0 < x < np.inf else 1.0
