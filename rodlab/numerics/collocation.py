"""Piecewise polynomials of degree m on a mesh, seen at Gauss's points: what boundary values are collocated with [N 2.8.2].

    0 = s_0 < s_1 < ... < s_N = 1      mesh, h_i = s_i - s_{i-1}
    Y (N, m+1)                         values of the polynomials at the nodes of each interval; neighbours share their ends
    Y E^T, Y D^T / h                   values and derivatives at Gauss's points, (N, m)

For the equations of an energy W(y', y) the stationary point of the energy by Gauss's rule,

    V = sum_i h_i sum_c b_c W(y'_c, y_c),

*is* the solution of Gauss collocation of y' = ..., (W_y')' = W_y as a first-order system [Hairer, Lubich and Wanner, Geometric
Numerical Integration, VI.6.2; Marsden and West 2001, 2.2]: of order 2m at mesh points, symmetric, with an index.
Degree 1 is the difference scheme of the notes, with the load at the middle of each link.
"""

from functools import cache, cached_property
from typing import Any

import numpy as np

from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.collocated import Collocated, Layout, layout
from rodlab.numerics.gauss import Basis, basis


class Grid:
    """The polynomials of one degree on one mesh; `wide` computes in numpy's longest float.

    >>> grid = Grid(np.array([0.0, 0.5, 1.0]), 2)
    >>> Y = grid.nodal(grid.places[1:] ** 2, 0.0)
    >>> y, slope = grid.at_gauss(Y)
    >>> np.allclose(slope, 2 * grid.s), round(float(np.sum(grid.hb * y)), 12)
    (True, 0.333333333333)
    """

    def __init__(self, mesh: Array, degree: int, *, wide: bool = False) -> None:
        self.mesh, self.degree = mesh, degree
        self.basis: Basis = basis(degree)
        B, kind = self.basis, np.longdouble if wide else np.float64
        self.kind: Any = kind
        self.h = np.diff(np.asarray(mesh, dtype=kind))
        parts: tuple[Any, Any, Any] = (B.wide_b, B.wide_values, B.wide_slopes) if wide else (B.b, B.E, B.D)
        self.b, self.E, self.D = parts
        self.hb = self.h[:, None] * self.b
        self.slope = np.ascontiguousarray(self.D[:, 1:].T)  # of differences to the first node: constants have none

    @cached_property
    def A(self) -> Any:
        """The Runge-Kutta matrix of Gauss's method."""
        return self.basis.wide_A if self.kind is np.longdouble else self.basis.A

    @property
    def N(self) -> int:
        """Number of intervals."""
        return self.mesh.size - 1

    @cached_property
    def wide(self) -> "Grid":
        """The same in the longest float."""
        return Grid(self.mesh, self.degree, wide=True)

    @cached_property
    def s(self) -> Array:
        """Arclength of Gauss's points, (N, m)."""
        return np.asarray(self.mesh[:-1, None] + np.diff(self.mesh)[:, None] * self.basis.c)

    @cached_property
    def places(self) -> Array:
        """Arclength of all nodes, the clamp first, (N m + 1,)."""
        inner = self.mesh[:-1, None] + np.diff(self.mesh)[:, None] * self.basis.nodes[1:]
        inner[:, -1] = self.mesh[1:]
        return np.append(self.mesh[0], inner.ravel())

    @cached_property
    def weights(self) -> Array:
        """Integrals of the nodes' polynomials, the clamp's left out: (N m,)."""
        return self.gathered(np.diff(self.mesh)[:, None] * self.basis.weights)

    @cached_property
    def layout(self) -> Layout:
        return layout(self.N, self.degree)

    # --- values ------------------------------------------------------------------------------------------------

    def nodal(self, u: Array, first: float) -> Array:
        """Unknowns (N m,) and the value at the clamp as nodal values (N, m+1)."""
        m = self.degree
        Y = np.empty((u.size // m, m + 1), dtype=np.result_type(u, self.kind))
        Y[:, 1:] = u.reshape(-1, m)
        Y[0, 0] = first
        Y[1:, 0] = Y[:-1, -1]
        return Y

    def at_gauss(self, Y: Array) -> tuple[Array, Array]:
        """Values and derivatives at Gauss's points."""
        return Y @ self.E.T, ((Y[:, 1:] - Y[:, :1]) @ self.slope) / self.h[:, None]

    def seen(self, u: Array) -> Array:
        """Values at Gauss's points of a direction u (N m,), zero at the clamp."""
        return np.asarray(self.nodal(u, 0.0) @ self.E.T)

    @cached_property
    def reach(self) -> Array:
        """Factors (m,) by which a weight at one of Gauss's points enters the norm of E^T diag(weights) E, at most."""
        size = np.abs(self.E)
        return np.asarray(2 * size.sum(axis=1) * size.sum(axis=0).max())

    def onto(self, Y: Array, other: "Grid") -> Array:
        """The piecewise polynomial at the nodes of another grid, the clamp's left out."""
        s = other.places[1:]
        if other.mesh is self.mesh:
            return np.asarray(Y @ _between(self.degree, other.degree).T)[:, 1:].ravel()
        return self.value(Y, s)

    def value(self, Y: Array, s: Array) -> Array:
        """The piecewise polynomial at any s (k,)."""
        i = np.clip(np.searchsorted(self.mesh, s, side="left") - 1, 0, self.N - 1)
        x = (s - self.mesh[i]) / (self.mesh[i + 1] - self.mesh[i])
        return np.asarray(np.einsum("kj,kj->k", self.basis.at(x)[0], Y[i]))

    def antiderivative(self, f: Array) -> Array:
        """Integral from the clamp to every node, the clamp's left out, of a function known at Gauss's points (N, m)."""
        h = np.diff(self.mesh)[:, None]
        inner = h * (f @ self.basis.to_nodes.T)[:, 1:]
        before = np.append(0.0, np.cumsum(inner[:-1, -1]))
        return (before[:, None] + inner).ravel()

    @cached_property
    def cumulative(self) -> Array:
        """Integrals from the clamp to all Gauss's points of a function known there, (N m, N m)."""
        N, m = self.hb.shape
        J = np.broadcast_to(np.tril(np.ones((N, N)), -1)[:, None, :, None] * self.hb, (N, m, N, m)).copy()
        i = np.arange(N)
        J[i, :, i, :] = self.h[:, None, None] * self.A
        return J.reshape(N * m, N * m)

    @cached_property
    def all_seen(self) -> Array:
        """Values at all Gauss's points from those at all nodes, the clamp's first, (N m, N m + 1)."""
        N, m = self.hb.shape
        S = np.zeros((N, m, N * m + 1))
        for i in range(N):
            S[i, :, i * m : i * m + m + 1] = self.E
        return S.reshape(N * m, -1)

    # --- the equations -------------------------------------------------------------------------------------------

    def tested(self, m: Any, f: Any) -> Array:
        """Derivatives (N, m+1) of the sums V_i in the nodal values: m = W_y', f = W_y at Gauss's points."""
        G = (self.b * m) @ self.D
        if np.ndim(f) or f:
            G += (self.hb * f) @ self.E
        return np.asarray(G)

    @staticmethod
    def gathered(G: Array) -> Array:
        """Contributions (N, m+1) of the intervals to their nodes, summed, the clamp's left out: (N m,)."""
        return Collocated.gathered(G)

    @cached_property
    def _products(self) -> tuple[Array, Array, Array]:
        m, E, D = self.degree, self.E, self.D
        EE, DD = ((F[:, :, None] * F[:, None, :]).reshape(m, -1) for F in (E, D))
        ED = (E[:, :, None] * D[:, None, :] + D[:, :, None] * E[:, None, :]).reshape(m, -1)
        return DD, ED, EE

    def stiff(self, k: Any) -> Array:
        """The part of the second variation's blocks from W_y'y', (N, (m+1)^2)."""
        return np.asarray(np.broadcast_to(self.b * k / self.h[:, None], (self.N, self.degree)) @ self._products[0])

    def soft(self, values: Array) -> Array:
        """E^T diag(values) E as blocks (N, m+1, m+1)."""
        n = self.degree + 1
        return np.asarray(values @ self._products[2]).reshape(-1, n, n)

    def second(self, stiff: Array, mixed: Any, soft: Any) -> Collocated:
        """The second variation: `stiff`, and the parts from W_y'y and W_yy at Gauss's points."""
        blocks = stiff + (self.hb * soft) @ self._products[2] if np.ndim(soft) or soft else stiff.copy()
        if np.ndim(mixed) or mixed:
            blocks += np.broadcast_to(self.b * mixed, (self.N, self.degree)) @ self._products[1]
        n = self.degree + 1
        return Collocated(blocks.reshape(-1, n, n), self.layout)

    def quadratic(self, k: Any, mixed: Any, soft: Any, x: Array) -> tuple[float, float]:
        """x . A x of the second variation with these coefficients, and a bound on its rounding: no stiffness cancels."""
        Y = self.nodal(x, 0.0)
        value, slope = self.at_gauss(Y)
        bending, rest = self.hb * k * slope**2, self.hb * (2 * mixed * slope * value + soft * value**2)
        spread = (np.abs(Y[:, 1:] - Y[:, :1]) @ np.abs(self.slope) + np.abs(Y).max(axis=1, keepdims=True)) / self.h[:, None]
        lost = 2 * np.sum(np.abs(self.hb * k * slope) * spread) + 8 * self.degree * (np.abs(bending) + np.abs(rest)).sum()
        return float(np.sum(bending + rest)), float(EPS * lost)


@cache
def _between(degree: int, other: int) -> Array:
    """From nodal values of one degree to those of another on the same interval, (other+1, degree+1)."""
    return basis(degree).at(basis(other).wide_nodes)[0]
