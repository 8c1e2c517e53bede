"""One equilibrium: the unknowns at a load, and answers computed when they are asked for."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from rodlab.analysis.equations import Equations
from rodlab.analysis.newton import NewtonStep
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.factor import factor, solve
from rodlab.numerics.inertia import Inertia


class Shape(NamedTuple):
    """Arclength, angle and place along one shape: arrays of one length."""

    s: Array
    phi: Array
    x: Array
    z: Array


@dataclass(frozen=True, eq=False, repr=False)
class Point:
    """A solution u of F(u, lam) = 0. What its equations cannot answer raises `AttributeError` in one sentence."""

    equations: Equations
    lam: float
    u: Array
    newton: tuple[NewtonStep, ...] = ()
    remaining: float = field(default=0.0)

    def __repr__(self) -> str:
        tip = f", tip_angle={self.tip_angle:.6g}" if "tip_angle" in getattr(self.equations, "measures", {}) else ""
        index = f"{self.index}" if self.index_verified else f"{self.index} (not verified)"
        return f"Point(lam={self.lam:.6g}{tip}, index={index}, error={self.error:.1e})"

    # --- measures and shape --------------------------------------------------------------------------------------

    def measure(self, name: str) -> float:
        """The measure `name` of the equations at this point."""
        known = getattr(self.equations, "measures", {})
        if name not in known:
            raise AttributeError(f"{type(self.equations).__name__} has no measure {name}; it has {sorted(known)}")
        return float(known[name](self.u, self.lam))

    @property
    def tip_angle(self) -> float:
        """Angle of the free end, radians."""
        return self.measure("tip_angle")

    @property
    def height(self) -> float:
        """z of the free end; dV/dlam along a branch."""
        return self.measure("height")

    @property
    def energy(self) -> float:
        """V(u; lam)."""
        return self.measure("energy")

    @cached_property
    def _shape(self) -> Shape:
        if not hasattr(self.equations, "nodes") or not hasattr(self.equations, "shape"):
            raise AttributeError(f"{type(self.equations).__name__} has no shape: it defines no nodes(u) and shape(u)")
        return Shape(*self.equations.nodes(self.u), *self.equations.shape(self.u))

    @property
    def s(self) -> Array:
        """Arclength of the shape's nodes, the clamp first."""
        return self._shape.s

    @property
    def phi(self) -> Array:
        """Angles at `s`."""
        return self._shape.phi

    @property
    def x(self) -> Array:
        """Lateral place at `s`."""
        return self._shape.x

    @property
    def z(self) -> Array:
        """Height at `s`."""
        return self._shape.z

    def __call__(self, s: Any) -> Shape:
        """The shape at arclengths s, linear between the nodes; raises `ValueError` outside of the rod."""
        s = np.asarray(s, dtype=np.float64)
        own = self._shape
        if not ((s >= own.s[0]) & (s <= own.s[-1])).all():
            raise ValueError(f"s must lie between {own.s[0]:g} and {own.s[-1]:g}; it is {s!r:.60}")
        return Shape(s, *(np.interp(s, own.s, values) for values in own[1:]))

    # --- index -----------------------------------------------------------------------------------------------------

    @cached_property
    def inertia(self) -> Inertia | None:
        """Signs of the eigenvalues of the second variation; None where there is none (no symmetric Jacobian)."""
        second = getattr(self.equations, "second_variation", self.equations.jacobian)
        matrix = second(self.u, self.lam)
        if not hasattr(matrix, "inertia"):
            return factor(matrix).inertia()
        bound = getattr(self.equations, "curvature_bound", None)
        change = np.inf if bound is None else bound(self.lam)
        if not np.isfinite(change):  # unknown: its own size stands for how fast the matrix can change
            change = float(np.abs(matrix.diagonal).max())
        known: Inertia = matrix.inertia(2 * self.remaining_angle * change)
        return known

    @property
    def index(self) -> int | None:
        """Number of certainly negative eigenvalues of the second variation: 0 is stable. None if there is none."""
        return None if self.inertia is None else self.inertia.negative

    @property
    def nullity(self) -> int | None:
        """Number of eigenvalues that cannot be told from zero."""
        return None if self.inertia is None else self.inertia.unclear

    @property
    def index_verified(self) -> bool:
        """True when every eigenvalue's sign is certain."""
        return self.inertia is not None and self.inertia.verified

    # --- error -----------------------------------------------------------------------------------------------------

    @property
    def remaining_angle(self) -> float:
        """What Newton left undone, as a change of any one unknown, with rounding of the unknowns themselves."""
        return self.remaining + EPS * float(np.abs(self.u).max(initial=0.0))

    @cached_property
    def error(self) -> float:
        """Bound on the error of the tip angle (the last unknown) against the exact solution of these equations.

        Sum of what Newton left, of rounding of u, and of rounding of the residual carried to the tip by the adjoint
        v = J^{-T} e_n. Without the member `rounding` the last part is taken from eps |J| |u|. Infinite where J is
        singular and the residual not exactly zero: no error is then known.
        """
        unit = np.zeros_like(self.u)
        unit[-1] = 1.0
        J = self.equations.jacobian(self.u, self.lam)
        with np.errstate(all="ignore"):
            v = solve(J, unit) if hasattr(J, "solve") else factor(J).solve_transposed(unit)
            if not np.isfinite(v).all():
                v = np.full_like(unit, np.finfo(float).max)
            own = getattr(self.equations, "rounding", None)
            if own is not None:
                rounding = float(own(self.u, self.lam, v))
            else:
                rounding = float(
                    4 * EPS * np.abs(v) @ (abs(J) @ np.abs(self.u) + np.abs(self.equations.residual(self.u, self.lam)))
                )
        return self.remaining + EPS * abs(float(self.u[-1])) + (rounding if np.isfinite(rounding) else np.inf)
