"""Integrals of a function over many intervals at once, to rounding where its samples show the function.

Clenshaw and Curtis's rule with 17 points against its own 9: where they agree to rounding the interval is done, where not it is
halved. Smooth integrands hardly ever halve. The ends of an interval belong to the rule, a hair inside it, so that
a jump nobody declared cannot hide between an end and the first node: it costs fifty halvings of the interval that holds it.
What is narrower than the distance of the nodes, a tenth of the interval, may be missed: declare it as breaks.
"""

from collections.abc import Callable
from functools import cache

import numpy as np

from rodlab.numerics.arrays import EPS, Array

DEPTH = 60
CHUNK = 1 << 15  # intervals at once: bounds the memory, and keeps it in the cache
INSIDE = 1e-13  # how far inside the ends are taken, relative to the interval


@cache
def clenshaw_curtis(n: int) -> tuple[Array, Array]:
    """n + 1 nodes and weights on [0, 1], n even, the ends among the nodes; every second node is that of n / 2.

    >>> x, w = clenshaw_curtis(8); bool(abs(w @ x**7 - 1/8) < 1e-15)
    True
    """
    angle = np.pi * np.arange(n + 1) / n
    j = np.arange(1, n // 2 + 1)
    b = np.where(j == n // 2, 1.0, 2.0) / (4 * j**2 - 1)
    w = (1 - np.cos(2 * np.outer(angle, j)) @ b) / n
    w[[0, -1]] /= 2
    return (1 - np.cos(angle)) / 2, w


def integrals(f: Callable[[Array], Array], edges: Array) -> Array:
    """Integral of f over [edges[i], edges[i+1]] for every i, shape (len(edges) - 1,).

    f takes and returns an array of any shape. Raises `ValueError` where f is not integrable to rounding.

    >>> bool(np.allclose(integrals(np.exp, np.array([0.0, 1.0])), np.e - 1, rtol=1e-15, atol=0))
    True
    """
    if edges.size - 1 > CHUNK:
        starts = range(0, edges.size - 1, CHUNK)
        return np.concatenate([integrals(f, edges[i : i + CHUNK + 1]) for i in starts])
    total, lost, size = np.zeros(edges.size - 1), np.zeros(edges.size - 1), np.full(edges.size - 1, np.inf)
    left, right, home = edges[:-1], edges[1:], np.arange(edges.size - 1)
    for _ in range(DEPTH):
        fine, coarse, absolute = _rules(f, left, right)
        size = np.minimum(size, np.abs(total) + np.bincount(home, absolute, total.size))  # a pole seems larger at first
        off = np.abs(fine - coarse)
        done = (off <= 16 * EPS * absolute) | (off <= EPS / 4 * size[home])
        tiny = right - left <= 16 * EPS * np.abs(right)  # the last interval around a jump, or a pole
        lost += np.bincount(home[tiny], absolute[tiny], total.size)
        done |= tiny
        total += np.bincount(home[done], fine[done], total.size)
        if (lost > 1e-12 * np.abs(total) + 1e-300).any() and done.all():
            break
        if done.all():
            return total
        left, right, home = left[~done], right[~done], home[~done]
        middle = (left + right) / 2
        left, right, home = np.append(left, middle), np.append(middle, right), np.append(home, home)
        if left.size > 100 * edges.size + 10_000:
            break
    raise ValueError(f"the function could not be integrated to rounding near s = {float(left[0]):.6g}")


def _rules(f: Callable[[Array], Array], left: Array, right: Array) -> tuple[Array, Array, Array]:
    """The sums of 17 and of 9 points over all intervals, and that of |f|."""
    x, w = clenshaw_curtis(16)
    h = right - left
    inside = np.maximum(INSIDE * h, 2 * np.spacing(np.maximum(np.abs(left), np.abs(right))))
    s = np.clip(left[:, None] + h[:, None] * x, (left + inside)[:, None], (right - inside)[:, None])
    values = f(s)
    return h * (values @ w), h * (values[:, ::2] @ clenshaw_curtis(8)[1]), h * (np.abs(values) @ w)
