"""Integrals of a function over many intervals at once, each to full relative accuracy.

Gauss-Legendre with 8 points against 16: where they agree to rounding the interval is done, where not it is halved. Smooth
integrands never halve; a jump nobody declared costs fifty halvings of the one interval that holds it.
"""

from collections.abc import Callable

import numpy as np

from rodlab.numerics.arrays import EPS, Array

DEPTH = 60
CHUNK = 1 << 15  # intervals at once: bounds the memory, and keeps it in the cache


def gauss(points: int) -> tuple[Array, Array]:
    """Gauss-Legendre nodes and weights on [0, 1].

    >>> x, w = gauss(2); bool(abs(w @ x**3 - 1/4) < 1e-15)
    True
    """
    x, w = np.polynomial.legendre.leggauss(points)
    return (x + 1) / 2, w / 2


def integrals(f: Callable[[Array], Array], edges: Array) -> Array:
    """Integral of f over [edges[i], edges[i+1]] for every i, shape (len(edges) - 1,).

    f takes and returns an array of any shape. Raises `ValueError` where f is not integrable to rounding.

    >>> bool(np.allclose(integrals(np.exp, np.array([0.0, 1.0])), np.e - 1, rtol=1e-15, atol=0))
    True
    """
    if edges.size - 1 > CHUNK:
        starts = range(0, edges.size - 1, CHUNK)
        return np.concatenate([integrals(f, edges[i : i + CHUNK + 1]) for i in starts])
    total = np.zeros(edges.size - 1)
    left, right, home = edges[:-1], edges[1:], np.arange(edges.size - 1)
    for _ in range(DEPTH):
        coarse, _ = _rule(f, left, right, 8)
        fine, size = _rule(f, left, right, 16)
        whole = total + np.bincount(home, np.abs(fine), total.size)
        done = (np.abs(fine - coarse) <= 16 * EPS * size) | (np.abs(fine - coarse) <= EPS / 4 * whole[home])
        total += np.bincount(home[done], fine[done], total.size)
        if done.all():
            return total
        left, right, home = left[~done], right[~done], home[~done]
        middle = (left + right) / 2
        left, right, home = np.append(left, middle), np.append(middle, right), np.append(home, home)
        if left.size > 100 * edges.size + 10_000:
            break
    raise ValueError(f"the function could not be integrated to rounding near s = {float(left[0]):.6g}")


def _rule(f: Callable[[Array], Array], left: Array, right: Array, points: int) -> tuple[Array, Array]:
    """The Gauss sums over all intervals, and the same sums of |f|."""
    x, w = gauss(points)
    h = right - left
    values = f(left[:, None] + h[:, None] * x)
    return h * (values @ w), h * (np.abs(values) @ w)
