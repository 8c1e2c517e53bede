"""The formulas that one would first write, and why each fails: beside ours in the stability study.

They are right on paper, and here as plain as on paper. What each loses is not found by looking at its answer.
"""

from typing import Any

import numpy as np
from scipy.linalg import eigh_tridiagonal

from rodlab.lab.studies.judge import NeverEndsError
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array


def load_from_entries(k: Array, hw: Array, j: int) -> float:
    """Load j as eigenvalue j of W^{-1/2} (D^T k D) W^{-1/2} by its entries (LAPACK's bisection).

    The diagonal holds k_i + k_{i+1}: the sum rounds off what a soft spring says beside a stiff one, and at n = 10^6 what all of
    them say. The error is eps times the largest entry, whatever the load.
    """
    with np.errstate(over="ignore"):
        d = (k + np.append(k[1:], 0.0)) / hw
        e = -k[1:] / np.sqrt(hw[:-1] * hw[1:])
    return float(eigh_tridiagonal(d, e, eigvals_only=True, select="i", select_range=(j - 1, j - 1), check_finite=False)[0])


def by_blocks(A: Any, b: Array, c: Array, d: float, f: Array, g: float) -> tuple[Array, float]:
    """Solution (x, y) of [[A, b], [c, d]] by elimination of the block A: two solves, y, then x.

    At a fold A is singular though the whole is not: both solves are huge, and what is wanted is their difference.
    """
    v, w = np.linalg.solve(A, b), np.linalg.solve(A, f)
    y = (g - c @ w) / (d - c @ v)
    return w - v * y, float(y)


def determinant(d: Array, e: Array) -> float:
    """det of a tridiagonal matrix, by its three-term recurrence; its sign tells an odd index from an even one.

    It grows or shrinks like the n-th power of the entries: out of the range of floats at n of a few hundred.
    """
    before, now = 1.0, float(d[0])
    with np.errstate(all="ignore"):
        for own, beside in zip(d[1:], e, strict=True):
            before, now = now, own * now - beside * beside * before
    return float(now)


def by_pivots(d: Array, e: Array, b: Array) -> Array:
    """x with T x = b by L D L^T as it stands, from the free end down to the clamp: no exchange of rows.

    A pivot can be zero though T is not singular; nearly zero, it multiplies rounding by its inverse, in silence.
    """
    n, d, b = d.size, d.copy(), b.copy()
    for i in range(n - 2, -1, -1):
        if d[i + 1] == 0:
            raise ZeroDivisionError(f"pivot {i + 2} of {n} is exactly zero")
        d[i] -= e[i] ** 2 / d[i + 1]
        b[i] -= e[i] * b[i + 1] / d[i + 1]
    x = np.empty(n)
    x[0] = b[0] / d[0]
    for i in range(1, n):
        x[i] = (b[i] - e[i - 1] * x[i - 1]) / d[i]
    return x


def newton_by_residual(strut: Strut, lam: float, tolerance: float, most: int) -> float:
    """Tip angle by Newton's method that stops when no entry of the residual is above `tolerance`.

    The residual's scale is that of k and its rounding is k times that of phi: where k is large the test is never satisfied,
    where k is small it is satisfied by any shape.
    """
    phi = strut.unstressed()
    for _ in range(most):
        F = strut.gradient(phi, lam)
        if np.abs(F).max() <= tolerance:
            return float(phi[-1])
        phi = phi - strut.hessian(phi, lam).solve(F)
    least = float(np.abs(strut.gradient(phi, lam)).max())
    raise NeverEndsError(f"after {most} steps the residual is still {least:.1e}, above {tolerance:g}", float(phi[-1]))


def sampled_springs(jump: float, at: float, n: int, where: str) -> Array:
    """Springs k_i = K(s_i) n, K = 1 below `at` and `jump` above, s_i the joint ("joint") or the middle of its link ("middle").

    A link across the jump is all soft or all stiff: the jump moves by up to a link, and the order falls to one.
    """
    s = (np.arange(1, n + 1) - (0.5 if where == "middle" else 0.0)) / n
    return np.where(s < at, 1.0, jump) * n


def conjugate_points_from_clamp(k: Array, c: Array) -> float:
    """Sign changes of the field that leaves the clamp, w_0 = 0 and w_1 = 1, marched to the free end: the index, one might think.

    It is that of a rod held at both ends, too small by one wherever the last moment has the wrong sign. And the march, not
    rescaled, leaves the range of floats: then NaN.
    """
    below, w, changes = 0.0, 1.0, 0
    with np.errstate(all="ignore"):
        for i in range(k.size - 1):
            above = ((k[i] + k[i + 1] - c[i]) * w - k[i] * below) / k[i + 1]
            changes += above * w < 0
            below, w = w, above
    return float(changes) if np.isfinite(w) else float(w)


def negative_eigenvalues(A: Array) -> int:
    """Index as the number of computed eigenvalues below zero, with no margin.

    Each is off by eps times the norm of the matrix: the sign of one that is smaller is that of its rounding.
    """
    return int((np.linalg.eigvalsh(A) < 0).sum())
