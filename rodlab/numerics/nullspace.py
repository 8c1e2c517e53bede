"""The eigenvectors of a matrix that belong to its eigenvalues nearest zero, by inverse iteration with a block.

    A X = V,  V <- orthonormal basis of X,  H = V^T A V        symmetric A: Ritz values mu, errors squared in those of V

A factor whose zero pivots are perturbed serves: the solution is then large along the null vectors, as it should be. For a
matrix that is not symmetric the left and right singular vectors of the smallest singular values, by A^T A.
"""

from typing import Any, NamedTuple

import numpy as np

from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.factor import Factor, factor


class NearNull(NamedTuple):
    """Values (p,) by size, right vectors (n, p) and left ones, orthonormal; for symmetric A both are eigenvectors."""

    values: Array
    right: Array
    left: Array


def near_null(matrix: Any, p: int, *, symmetric: bool, start: Array | None = None, sweeps: int = 8) -> NearNull:
    """The p eigenvalues of least size of a symmetric matrix and their vectors, else the p least singular values.

    >>> A = np.diag([3.0, 1e-9, -2.0, 5.0])
    >>> near_null(A, 1, symmetric=True).values.round(12)
    array([1.e-09])
    """
    known, n = factor(matrix), matrix.shape[0]
    width = min(n, p + 2)
    V = np.linalg.qr(_start(n, width) if start is None else np.column_stack([start, _start(n, width)])[:, :width])[0]
    return _symmetric(matrix, known, V, p, sweeps) if symmetric else _singular(known, V, p, sweeps)


def quadratic(matrix: Any, x: Array) -> tuple[float, float]:
    """x . A x and a bound on its rounding; a structured matrix may know it better than by its entries."""
    if hasattr(matrix, "quadratic"):
        value, rounding = matrix.quadratic(x)
        return float(value), float(rounding)
    size = float(np.abs(x) @ (abs(matrix) @ np.abs(x)))
    return float(x @ (matrix @ x)), 4 * EPS * size


def _start(n: int, width: int) -> Array:
    """Columns with something of every mode: no symmetry, no zeros."""
    i = np.arange(1.0, n + 1)
    return np.column_stack([np.sin((j + 1) * 1.7 * i) + np.cos((0.3 + j) * i * 3.1 / n) for j in range(width)])


def _solved(solve: Any, V: Array) -> Array:
    with np.errstate(all="ignore"):
        X = np.column_stack([solve(v) for v in V.T])
        size = np.abs(X).max(axis=0)
        X = X / np.where((size > 0) & np.isfinite(size), size, 1.0)
    return np.linalg.qr(np.nan_to_num(X, nan=0.0, posinf=0.0, neginf=0.0))[0]


def _symmetric(matrix: Any, known: Factor, V: Array, p: int, sweeps: int) -> NearNull:
    last = np.full(p, np.inf)
    for _ in range(sweeps):
        V = _solved(known.solve, V)
        H = V.T @ np.column_stack([matrix @ v for v in V.T])
        w, Z = np.linalg.eigh((H + H.T) / 2)
        order = np.argsort(np.abs(w))
        V, w = V @ Z[:, order], w[order]
        if (np.abs(w[:p] - last) <= 1e-12 * np.abs(w[: p + 1]).max()).all():
            break
        last = w[:p]
    return NearNull(w[:p], V[:, :p], V[:, :p])


def _singular(known: Factor, V: Array, p: int, sweeps: int) -> NearNull:
    U = V
    for _ in range(sweeps):
        U = _solved(known.solve_transposed, V)
        V = _solved(known.solve, U)
    with np.errstate(all="ignore"):
        X = np.column_stack([known.solve(u) for u in U.T])
    inverse = V.T @ np.nan_to_num(X, posinf=1e300, neginf=-1e300)
    P, s, Q = np.linalg.svd(inverse)
    with np.errstate(divide="ignore"):
        values = 1 / s
    return NearNull(values[:p], (V @ P)[:, :p], (U @ Q.T)[:, :p])
