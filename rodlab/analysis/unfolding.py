"""Folds and branch points followed in two parameters: curves in the plane of the load and a parameter beta.

    folds            F(u, lam, beta) = 0,  F_u v = 0,  v.v = n                      [Moore and Spence 1980]
                     unknowns (u, v, beta), followed in the load; where the load turns, two folds meet in a cusp
    branch points    F + eps v_0 = 0,  F_u v = 0,  v.v = n,  psi.F_lam = 0           [Moore 1980]
                     unknowns (u, v, lam, eps), followed in beta; where eps stays zero so does the branch point

Both are Equations, so that all verbs work on them. A model with a mesh stays on that of the event. Symmetric Jacobians: psi = v.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.sparse import block_array, csr_array

from rodlab.analysis.curve import Curve
from rodlab.analysis.derivatives import central
from rodlab.analysis.equations import jacobian
from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.events import Event
from rodlab.analysis.point import Point
from rodlab.analysis.vary import Family
from rodlab.numerics.arrays import Array

STEP = 1e-3  # of angles, for third derivatives
DENSE = 200  # unknowns up to which matrices are full


class _Unfolded:
    """What both systems share: the model's derivatives at a state, those beyond the Jacobian by differences of fourth order."""

    def __init__(self, event: Event, name: str) -> None:
        self.model, self.name = event.point.equations, name
        self.family = Family(self.model, name)
        self.n = event.point.u.size
        assert event.null is not None
        v = event.null[:, 0]
        self.v0 = v * (self.n / float(v @ v)) ** 0.5
        y = np.append(event.point.u, event.lam)
        if not Curve(self.model).symmetric(y):
            raise ValueError(
                f"the model must have a symmetric Jacobian to follow its {event.kind}s; that of {self.model!r:.60} is not"
            )

    def _F(self, u: Array, lam: float, beta: float) -> Array:
        return np.asarray(self.family.at(beta).residual(u, lam))

    def _J(self, u: Array, lam: float, beta: float) -> Any:
        return jacobian(self.family.at(beta), u, lam)

    def _F_lam(self, u: Array, lam: float, beta: float) -> Array:
        return np.asarray(self.family.at(beta).d_lam(u, lam), dtype=np.float64)

    def _curving(self, u: Array, v: Array, lam: float, beta: float) -> Any:
        """d(J v)/du = dJ in the direction v, as J is the derivative of a gradient."""
        e = STEP / float(np.abs(v).max())
        return central(lambda x: _matrix(self._J(u + x * v, lam, beta)), e)

    def _rate(self, function: Any, at: float) -> Any:
        """Derivative of a function of one number."""
        return central(lambda x: function(at + x), STEP * max(1.0, abs(at)))

    def _own(self, place: Callable[[Array, float], tuple[float, float]]) -> dict[str, Any]:
        """The model's measures, of unknowns whose load and parameter `place` tells."""

        def measured(name: str, U: Array, x: float) -> float:
            lam, beta = place(U, x)
            return float(self.family.at(beta).measures[name](U[: self.n], lam))

        return {name: partial(measured, name) for name in getattr(self.model, "measures", {})}

    def inner(self, a: Array, b: Array) -> float:
        """That of the model for u, with a tenth of that of v, and the numbers."""
        n = self.n
        return (
            self.model.inner(a[:n], b[:n]) + 0.01 * self.model.inner(a[n : 2 * n], b[n : 2 * n]) + float(a[2 * n :] @ b[2 * n :])
        )

    def start(self, guess: Any) -> Array:
        """The unknowns as given."""
        return np.array(guess, dtype=np.float64)


class Folds(_Unfolded):
    """The curve of folds through one of them; u: (u, v, beta), shape (2 n + 1,). Made by `folds`."""

    def residual(self, U: Array, lam: float) -> Array:
        """F, F_u v and the length of v."""
        u, v, beta = U[: self.n], U[self.n : -1], float(U[-1])
        return np.concatenate([self._F(u, lam, beta), self._J(u, lam, beta) @ v, [(v @ v - self.n) / 2]])

    def jacobian(self, U: Array, lam: float) -> Any:
        """By blocks."""
        u, v, beta = U[: self.n], U[self.n : -1], float(U[-1])
        J, none = _matrix(self._J(u, lam, beta)), np.zeros((1, self.n))
        rate = self._rate(lambda x: self._J(u, lam, x) @ v, beta)
        return _blocks(
            [[J, None, self.family.d_value(u, lam, beta)[:, None]],
             [self._curving(u, v, lam, beta), J, rate[:, None]],
             [none, v[None], np.zeros((1, 1))]]
        )  # fmt: skip

    def d_lam(self, U: Array, lam: float) -> Array:
        """dF/dlam and that of F_u v."""
        u, v, beta = U[: self.n], U[self.n : -1], float(U[-1])
        return np.concatenate([self._F_lam(u, lam, beta), self._rate(lambda x: self._J(u, x, beta) @ v, lam), [0.0]])

    @property
    def measures(self) -> dict[str, Any]:
        """The parameter, and the model's measures at the fold."""
        own = self._own(lambda U, lam: (lam, float(U[-1])))
        return {**own, self.name: lambda U, _: float(U[-1])}


class BranchPoints(_Unfolded):
    """The curve of branch points through one of them; u: (u, v, lam, eps), shape (2 n + 2,). Made by `branch_points`."""

    def residual(self, U: Array, beta: float) -> Array:
        """F, F_u v, the length of v and v.F_lam."""
        u, v, lam, eps = self._parts(U)
        F = self._F(u, lam, beta) + eps * self.v0
        rest = [(v @ v - self.n) / 2, v @ self._F_lam(u, lam, beta)]
        return np.concatenate([F, self._J(u, lam, beta) @ v, rest])

    def jacobian(self, U: Array, beta: float) -> Any:
        """By blocks."""
        u, v, lam, _ = self._parts(U)
        J, F_lam = _matrix(self._J(u, lam, beta)), self._F_lam(u, lam, beta)
        J_lam_v = self._rate(lambda x: self._J(u, x, beta) @ v, lam)
        twice = self._rate(lambda x: v @ self._F_lam(u, x, beta), lam)
        none, zero = np.zeros((1, self.n)), np.zeros((1, 1))
        return _blocks(
            [[J, None, F_lam[:, None], self.v0[:, None]],
             [self._curving(u, v, lam, beta), J, J_lam_v[:, None], np.zeros((self.n, 1))],
             [none, v[None], zero, zero],
             [J_lam_v[None], F_lam[None], np.full((1, 1), twice), zero]]
        )  # fmt: skip

    def d_lam(self, U: Array, beta: float) -> Array:
        """Derivatives in the parameter."""
        u, v, lam, _ = self._parts(U)
        rate = self._rate(lambda x: np.append(self._J(u, lam, x) @ v, [0.0, v @ self._F_lam(u, lam, x)]), beta)
        return np.concatenate([self.family.d_value(u, lam, beta), rate])

    @property
    def measures(self) -> dict[str, Any]:
        """The load, how far the branch point is broken, and the model's measures."""
        own = self._own(lambda U, beta: (float(U[-2]), beta))
        return {**own, "load": lambda U, _: float(U[-2]), "broken": lambda U, _: float(U[-1])}

    def _parts(self, U: Array) -> tuple[Array, Array, float, float]:
        return U[: self.n], U[self.n : -2], float(U[-2]), float(U[-1])


def folds(event: Event, name: str) -> Point:
    """The point on the curve of folds in the plane of the load and the parameter `name`, at a fold that was met.

    Follow it in the load, `follow(folds(e, "u_hat"), to=...)`; `measure("u_hat")` is the parameter, a fold of this curve a cusp.
    Raises `ValueError` unless the event is a fold of a model with that parameter and a symmetric Jacobian.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.analysis.follow import follow
    >>> from rodlab.mechanics.strut import Strut
    >>> one = Strut.from_joints(k=[1.0], beta=[0.1])                          # beta = phi - tan phi, lam = 1 / cos phi
    >>> b = follow(equilibrium(one, 2.0, [-1.8]), to=0.0)
    >>> curve = follow(folds(b.events[0], "beta"), to=0.5, max_points=30)
    >>> [e.kind for e in curve.events], round(curve.events[0].lam, 6)
    (['fold', 'end'], 1.0)
    """
    _checked(event, "fold")
    equations = Folds(event, name)
    return equilibrium(equations, event.lam, np.concatenate([event.point.u, equations.v0, [equations.family.value]]))


def branch_points(event: Event, name: str) -> Point:
    """The point on the curve of branch points in the plane of the parameter `name` and the load, at one that was followed.

    Follow it in the parameter: `measure("load")` is its load, `measure("broken")` what the equations lack for a branch point:
    zero where the parameter keeps the symmetry, of a higher power in it where it is ineffective.
    Raises `ValueError` unless the event is a branch point with one null vector.
    """
    _checked(event, "branch point")
    equations = BranchPoints(event, name)
    return equilibrium(equations, equations.family.value, np.concatenate([event.point.u, equations.v0, [event.lam, 0.0]]))


def _checked(event: Event, kind: str) -> None:
    if not isinstance(event, Event) or event.kind != kind or event.null is None or event.multiplicity != 1:
        raise ValueError(f"event must be a {kind} of one null vector that was followed; it is {event!r:.80}")


def _matrix(J: Any) -> Any:
    """A numpy array or a scipy sparse one."""
    dense = J.toarray() if hasattr(J, "toarray") else np.asarray(J)
    return dense if dense.shape[0] <= DENSE else csr_array(dense)


def _blocks(rows: list[list[Any]]) -> Any:
    n = rows[0][0].shape[0]
    if n > DENSE:
        return block_array(rows, format="csc")
    return np.block([[np.zeros((n, n)) if block is None else block for block in row] for row in rows])
