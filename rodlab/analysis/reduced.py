"""The equations near a branch point reduced to its null vectors [Lyapunov and Schmidt; Golubitsky and Schaeffer 1985].

    F(u, lam) + Psi b = 0,    Phi^T W (u - u*) = xi                 u and b as functions of xi (p,) and mu = lam - lam*

    [ J      Psi ] [du]   [-F - Psi b          ]
    [ Phi^T W  0 ] [db] = [xi - Phi^T W (u-u*)]                   nonsingular where J is singular

Solutions near by are those of the p algebraic bifurcation equations b(xi, mu) = 0. Their Taylor polynomial of third order is
fitted in units (rho, mu_0) in which all branches that leave are of size one; its roots are the directions of the branches.
"""

from itertools import combinations_with_replacement
from typing import Any

import numpy as np

from rodlab.analysis.curve import Curve
from rodlab.analysis.newton import NoConvergence
from rodlab.numerics.arrays import Array
from rodlab.numerics.bordered import Bordered
from rodlab.numerics.factor import factor
from rodlab.numerics.nullspace import NearNull

DEGREE = 3


class Reduced:
    """b(xi, mu) at a singular point y* with null vectors `null`, solved with one bordered matrix."""

    def __init__(self, curve: Curve, y: Array, null: NearNull) -> None:
        self.curve, self.y = curve, y
        self.p = null.right.shape[1]
        size = np.array([float(curve.equations.inner(v, v)) for v in null.right.T]) ** 0.5
        self.Phi = _orthonormal(curve, null.right / size)
        self.Psi = null.left
        rows = np.column_stack([self._row(v) for v in self.Phi.T])
        J = curve.jacobian(y)
        self.rows = rows
        self.matrix = Bordered(J, factor(J), B=self.Psi * self._scale(J), C=rows, D=np.zeros((self.p, self.p)))
        self.weight = self._scale(J)

    def _row(self, v: Array) -> Array:
        return self.curve.row(np.append(v, 0.0))[:-1]

    def _scale(self, J: Any) -> float:
        return float(np.max(abs(J) @ np.ones(self.y.size - 1))) or 1.0

    def at(self, xi: Array, mu: float) -> tuple[Array, Array]:
        """(y, b): the point of these coordinates and what is left of the equations there.

        Raises `NoConvergence` where the chord corrections do not shrink by a third each.
        """
        u, lam = self.y[:-1] + self.Phi @ xi, float(self.y[-1]) + mu
        b, last = np.zeros(self.p), np.inf
        for _ in range(30):
            F = np.asarray(self.curve.equations.residual(u, lam))
            if not np.isfinite(F).all():
                break
            du, db = self.matrix.solve_once(-F - self.weight * (self.Psi @ b), xi - self.rows.T @ (u - self.y[:-1]))
            size = self.curve.norm(np.append(du, 0.0))
            if not np.isfinite(size) or (size > last / 3 and size > 1e-13 * (1 + self.curve.norm(np.append(u, 0.0)))):
                break
            u, b = u + du, b + db
            if size <= 1e-15 * (1 + self.curve.norm(np.append(u, 0.0))) or (size > last / 3):
                return np.append(u, lam), b
            last = size
        raise NoConvergence("the reduced equations do not converge this far from the branch point", ())

    def coordinates(self, y: Array) -> tuple[Array, float]:
        """xi and mu of a point."""
        return np.asarray(self.rows.T @ (y[:-1] - self.y[:-1])), float(y[-1] - self.y[-1])


class Polynomial:
    """b in the units x = xi / rho, m = mu / mu_0, divided by its size: the polynomial of degree 3 that fits it best."""

    def __init__(self, reduced: Reduced, rho: float, mu0: float) -> None:
        self.p, self.rho, self.mu0 = reduced.p, rho, mu0
        self.powers = [
            c for degree in range(DEGREE + 1) for c in combinations_with_replacement(range(self.p + 1), degree)
        ]  # monomials as lists of variables
        rng = np.random.default_rng(2)
        samples = rng.uniform(-1.2, 1.2, (2 * len(self.powers), self.p + 1))
        values = np.array([reduced.at(rho * s[:-1], mu0 * float(s[-1]))[1] for s in samples])
        A = self._monomials(samples)
        self.coefficients, *_ = np.linalg.lstsq(A, values, rcond=None)
        self.size = float(np.abs(values).max()) or 1.0
        self.misfit = float(np.abs(A @ self.coefficients - values).max()) / self.size
        self.coefficients /= self.size

    def __call__(self, xm: Array) -> Array:
        """Values (k, p) at points (k, p + 1)."""
        return np.asarray(self._monomials(xm) @ self.coefficients)

    def jacobian(self, xm: Array) -> Array:
        """Derivatives (k, p, p + 1) at points (k, p + 1)."""
        return np.asarray(np.einsum("kvc,cb->kbv", self._slopes(xm), self.coefficients))

    def _monomials(self, xm: Array) -> Array:
        return np.column_stack([np.prod(xm[:, list(c)], axis=1) for c in self.powers])

    def _slopes(self, xm: Array) -> Array:
        out = np.zeros((xm.shape[0], self.p + 1, len(self.powers)))
        for j, c in enumerate(self.powers):
            for v in set(c):
                rest = list(c)
                rest.remove(v)
                out[:, v, j] = c.count(v) * np.prod(xm[:, rest], axis=1)
        return out

    def roots_on_sphere(self, starts: int) -> Array:
        """Points with b = 0 and |x| = 1, each once, shape (k, p + 1): Newton's method from many starts."""
        xm = self._starts(starts)
        for _ in range(40):
            x = xm[:, :-1]
            value = np.column_stack([self(xm), (np.sum(x * x, axis=1) - 1) / 2])
            slope = np.concatenate([self.jacobian(xm), np.column_stack([x, np.zeros(len(xm))])[:, None, :]], axis=1)
            slope += 1e-14 * np.eye(self.p + 1)
            with np.errstate(all="ignore"):
                step = np.linalg.solve(slope, value[:, :, None])[:, :, 0]
                size = np.abs(step).max(axis=1, keepdims=True)
                xm = np.nan_to_num(xm - step * np.minimum(1.0, 0.5 / np.maximum(size, 1e-300)))
        good = (np.abs(self(xm)).max(axis=1) < 1e-9) & (np.abs(np.sum(xm[:, :-1] ** 2, axis=1) - 1) < 1e-9)
        return _distinct(xm[good & (np.abs(xm[:, -1]) < 30)])

    def isolated(self, roots: Array) -> bool:
        """False where roots lie on curves of roots: a continuous symmetry, or terms of higher order decide."""
        for J, xm in zip(self.jacobian(roots), roots, strict=True):
            s = np.linalg.svd(np.vstack([J, np.append(xm[:-1], 0.0)]), compute_uv=False)
            if s[-1] < 1e-5 * s[0]:
                return False
        return True

    def _starts(self, count: int) -> Array:
        rng = np.random.default_rng(3)
        x = rng.standard_normal((count, self.p))
        x[: 2 * self.p] = np.vstack([np.eye(self.p), -np.eye(self.p)])
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        levels = np.concatenate([np.zeros((count, 1)), rng.uniform(-2, 2, (count, 1))])
        return np.hstack([np.vstack([x, x]), levels])

    @property
    def turns(self) -> bool:
        """True when the load itself enters at first order: a fold in the same place."""
        return bool(np.abs(self.coefficients[self.powers.index((self.p,))]).max() > 1e-3)

    @property
    def rates(self) -> tuple[Array, Array]:
        """Change of db/dx, (p, p), before and after the branch point: how the p eigenvalues cross as the load grows."""
        before, here, after = (self.jacobian(np.append(np.zeros(self.p), m)[None])[0][:, :-1] for m in (-1.0, 0.0, 1.0))
        return here - before, after - here


def _distinct(points: Array) -> Array:
    kept: list[Array] = []
    for point in points:
        if all(np.abs(point - other).max() > 1e-5 for other in kept):
            kept.append(point)
    return np.array(kept).reshape(len(kept), points.shape[1])


def _orthonormal(curve: Curve, V: Array) -> Array:
    """Gram and Schmidt in the scalar product of the equations."""
    columns: list[Array] = []
    for v in V.T:
        for w in columns:
            v = v - float(curve.equations.inner(w, v)) * w  # noqa: PLW2901
        columns.append(v / float(curve.equations.inner(v, v)) ** 0.5)
    return np.column_stack(columns)
