"""Gauss's points on [0, 1] and the polynomials that are collocated at them [Hairer, Norsett and Wanner, II.7].

    c (m,), b (m,)           Gauss's points and weights: sum_c b_c f(c) is exact for polynomials of degree 2m - 1
    nodes (m+1,)             Lobatto's points, 0 and 1 among them: a polynomial of degree m is its values there
    E, D (m, m+1)            its value and its derivative at Gauss's points
    A (m, m)                 A_ab = integral of b's Lagrange polynomial up to c_a: the Runge-Kutta matrix of Gauss's method

Everything is computed in numpy's longest float and rounded once, so that the rows of D sum to zero as far as doubles can.
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from rodlab.numerics.arrays import Array, whole

Wide = Any  # an array of np.longdouble, which mypy's numpy does not tell from others
MOST = 64  # degree


@dataclass(frozen=True, eq=False)
class Basis:
    """Polynomials of one degree between Lobatto's nodes, seen at Gauss's points; made by `basis(degree)`."""

    degree: int
    wide_c: Wide
    wide_b: Wide
    wide_nodes: Wide
    wide_values: Wide
    wide_slopes: Wide

    @cached_property
    def c(self) -> Array:
        """Gauss's points."""
        return _double(self.wide_c)

    @cached_property
    def b(self) -> Array:
        """Gauss's weights, of sum 1."""
        return _double(self.wide_b)

    @cached_property
    def nodes(self) -> Array:
        """Lobatto's points."""
        return _double(self.wide_nodes)

    @cached_property
    def E(self) -> Array:
        """Values at Gauss's points."""
        return _double(self.wide_values)

    @cached_property
    def D(self) -> Array:
        """Derivatives at Gauss's points."""
        return _double(self.wide_slopes)

    @cached_property
    def weights(self) -> Array:
        """Integrals of the nodes' Lagrange polynomials, all positive: Lobatto's weights."""
        return _double(self.wide_b @ self.wide_values)

    @cached_property
    def to_nodes(self) -> Array:
        """Integrals of the Lagrange polynomials at Gauss's points from 0 to the nodes, shape (m+1, m)."""
        return _double(_integrated(self.wide_c, self.wide_nodes, self.wide_c, self.wide_b))

    @cached_property
    def wide_A(self) -> Wide:
        """The Runge-Kutta matrix of Gauss's method, in the longest float."""
        return _integrated(self.wide_c, self.wide_c, self.wide_c, self.wide_b)

    @cached_property
    def A(self) -> Array:
        """The Runge-Kutta matrix of Gauss's method."""
        return _double(self.wide_A)

    def at(self, x: Any) -> tuple[Array, Array]:
        """Matrices that take nodal values to values and derivatives at x, shape (len(x), m+1)."""
        E, D = lagrange(self.wide_nodes, np.asarray(x, dtype=np.longdouble))
        return _double(E), _double(D)


@cache
def basis(degree: int) -> Basis:
    """The basis of a degree from 1 to 64.

    >>> basis(2).nodes, basis(1).D
    (array([0. , 0.5, 1. ]), array([[-1.,  1.]]))
    >>> g = basis(3); bool(abs(g.b @ g.c**5 - 1/6) < 1e-16)
    True
    """
    degree = whole("degree", degree, least=1)
    if degree > MOST:
        raise ValueError(f"degree must be at most {MOST}; it is {degree}")
    c, b = _gauss(degree)
    nodes = _lobatto(degree)
    return Basis(degree, c, b, nodes, *lagrange(nodes, c))


def lagrange(nodes: Wide, x: Wide) -> tuple[Wide, Wide]:
    """Values and derivatives at x of the Lagrange polynomials on `nodes`, shapes (len(x), len(nodes))."""
    gaps = nodes[:, None] - nodes
    np.fill_diagonal(gaps, 1.0)
    off = x[:, None] - nodes
    hit = off == 0  # a place that is a node: no quotient there
    off[hit] = 1.0
    parts = off[:, None, :] / gaps  # (x - nodes_k) / (nodes_j - nodes_k), one where k = j
    index = np.arange(len(nodes))
    parts[:, index, index] = 1.0
    E = np.prod(parts, axis=2)
    D = E * ((1 / off).sum(axis=1, keepdims=True) - 1 / off)
    for i in np.flatnonzero(hit.any(axis=1)):
        E[i], D[i] = _at_node(nodes, int(np.flatnonzero(hit[i])[0]))
    return E, D


def _at_node(nodes: Wide, j: int) -> tuple[Wide, Wide]:
    """The same at node j."""
    E = np.zeros(len(nodes), dtype=nodes.dtype)
    E[j] = 1.0
    gaps = nodes[:, None] - nodes
    np.fill_diagonal(gaps, 1.0)
    scale = np.prod(gaps, axis=1)
    with np.errstate(divide="ignore"):
        D = scale[j] / (scale * (nodes[j] - nodes))
    D[j] = 0.0
    D[j] = -D.sum()
    return E, D


def _gauss(m: int) -> tuple[Wide, Wide]:
    x = np.asarray(np.polynomial.legendre.leggauss(m)[0], dtype=np.longdouble)
    for _ in range(3):  # Newton's method on P_m from the rounded roots
        p, dp = _legendre(m, x)
        x -= p / dp
    w = 2 / ((1 - x * x) * _legendre(m, x)[1] ** 2)
    return (1 + x) / 2, w / 2


def _lobatto(m: int) -> Wide:
    """The ends and the zeros of P_m'."""
    series = np.zeros(m + 1)
    series[m] = 1
    roots = np.polynomial.legendre.legroots(np.polynomial.legendre.legder(series)) if m > 1 else np.array([])
    x = np.asarray(np.sort(roots.real), dtype=np.longdouble)
    for _ in range(3):  # (1 - x^2) P'' = 2 x P' - m (m + 1) P
        p, dp = _legendre(m, x)
        x -= dp * (1 - x * x) / (2 * x * dp - m * (m + 1) * p)
    return (1 + np.concatenate([[-1], x, [1]]).astype(np.longdouble)) / 2


def _legendre(m: int, x: Wide) -> tuple[Wide, Wide]:
    """P_m and its derivative."""
    before, p = np.ones_like(x), x.copy()
    for k in range(1, m):
        before, p = p, ((2 * k + 1) * x * p - k * before) / (k + 1)
    return p, m * (before - x * p) / (1 - x * x)


def _integrated(points: Wide, ends: Wide, c: Wide, b: Wide) -> Wide:
    """Integrals from 0 to the ends of the Lagrange polynomials on `points`, exact by Gauss's rule."""
    return np.array([end * (b @ lagrange(points, end * c)[0]) for end in ends])


def _double(wide: Wide) -> Array:
    return np.asarray(wide, dtype=np.float64)
