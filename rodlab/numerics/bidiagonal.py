"""Singular values of a lower bidiagonal matrix, each to high relative accuracy, any few of them.

    B = diag(a) + diag(b, -1)        a (n,), b (n-1,)

The Golub-Kahan form, symmetric tridiagonal of order 2 n with zeros on the diagonal and a_1, b_1, a_2, ... beside
it, has the eigenvalues +-sigma_j. Entries off by a relative eps move each sigma_j by a relative (2 n - 1) eps at
most [Demmel and Kahan 1990], however small it is, and bisection (dstebz) commits no larger error provided that it is
not told to stop early: a tolerance of zero means ulp times the norm to LAPACK, and costs the small ones
their digits, so it is twice the underflow threshold.
"""

import numpy as np
from scipy.linalg import lapack

from rodlab.numerics.arrays import EPS, TINY, Array
from rodlab.numerics.tridiagonal import Tridiagonal

WIDEST = 1e-70  # bisection squares the entries: below the fourth root of the underflow threshold it loses the smallest


def golub_kahan(a: Array, b: Array) -> Array:
    """Off-diagonal of the Golub-Kahan form, shape (2 n - 1,)."""
    e = np.empty(2 * a.size - 1)
    e[0::2], e[1::2] = a, b
    return e


def singular_value(a: Array, b: Array, j: int) -> float:
    """The j-th smallest singular value, j = 1..n, to a relative error of 2 n eps; O(n).

    Raises `ValueError` for entries that span more than 70 decades.

    >>> round(singular_value(np.ones(2), -np.ones(1), 1) ** 2, 15)        # (3 - sqrt 5) / 2
    0.381966011250105
    """
    n = a.size
    if n == 1:
        return abs(float(a[0]))
    e = golub_kahan(a, b)
    size = np.abs(e)
    scale = 2.0 ** np.round(np.log2(size.max()))
    if size.min() < WIDEST * size.max():
        raise ValueError(
            f"the entries must not span more than {-np.log10(WIDEST):.0f} decades; they lie in {size.min():g}..{size.max():g}"
        )
    e /= scale
    found, w, *_, info = lapack.dstebz(np.zeros(2 * n), e, 2, 0.0, 0.0, n + j, n + j, 2 * TINY, "B")
    if info != 0 or found != 1:
        raise ArithmeticError(f"dstebz found {found} values for mode {j} of {n} (info {info})")
    return float(w[0] * scale)


def right_vector(a: Array, b: Array, sigma: float) -> Array:
    """Unit right singular vector of B for the singular value `sigma`, by inverse iteration; O(n)."""
    n = a.size
    factor = Tridiagonal(np.full(2 * n, -sigma), golub_kahan(a, b)).factor()
    x = np.sin(np.arange(1.0, 2 * n + 1))  # any start with a component along every vector
    for _ in range(3):
        x = factor.solve(x)
        x /= np.abs(x).max()
    v = x[1::2]  # the chain is u_1, v_1, u_2, v_2, ...
    return np.asarray(v / np.sqrt(v @ v))


def relative_error(n: int) -> float:
    """Bound on the relative error of a *squared* singular value of order n: 4 n eps.

    The worst case of the argument above, rounding of the entries and bisection together, is twice that; it would need
    every rounding to be the largest and of the worst sign. Tested against 50 digits, errors stay a hundred times below.
    """
    return 4 * n * EPS
