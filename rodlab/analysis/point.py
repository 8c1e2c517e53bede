"""One equilibrium: the unknowns at a load, and answers computed when they are asked for."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from rodlab.analysis.equations import Equations, jacobian, second_variation
from rodlab.analysis.newton import NewtonStep
from rodlab.numerics.arrays import EPS, LEAST, Array
from rodlab.numerics.factor import factor, inertia_of, largest_change
from rodlab.numerics.inertia import Inertia, Symmetric


class Shape(NamedTuple):
    """Arclength, angle and place along one shape: arrays of one length."""

    s: Array
    phi: Array
    x: Array
    z: Array


@dataclass(frozen=True, eq=False, repr=False)
class Point:
    """A solution u of F(u, lam) = 0; on a branch it knows its unit `tangent` (du, dlam), shape (n + 1,).

    What its equations cannot answer raises `AttributeError` in one sentence.

    >>> from rodlab.mechanics.strut import Strut
    >>> p = Point(Strut(n=2), 1.0, np.zeros(2))
    >>> p.tip_angle, p.height, p.index, p.index_verified, p.x
    (0.0, 1.0, 0, True, array([0., 0., 0.]))
    """

    equations: Equations
    lam: float
    u: Array
    newton: tuple[NewtonStep, ...] = ()
    remaining: float = field(default=0.0)
    tangent: Array | None = None
    accepted: str = ""
    known_inertia: Inertia | None = None
    recorded: Mapping[str, float] | None = None

    @property
    def proved(self) -> bool:
        """True when the step to this point was proved to stay on its branch."""
        return self.accepted == "proved"

    @property
    def checked(self) -> bool:
        """True when the step to this point was checked, by every test short of a proof."""
        return self.accepted == "checked"

    def __repr__(self) -> str:
        tip = f", tip_angle={self.tip_angle:.6g}" if "tip_angle" in getattr(self.equations, "measures", {}) else ""
        if self.recorded is not None:
            return f"Point(lam={self.lam:.6g}, index={self.index}, recorded)"
        index = f"{self.index}" if self.index_verified else f"{self.index} (not verified)"
        return f"Point(lam={self.lam:.6g}{tip}, index={index}, error={self.error:.1e})"

    # --- measures and shape --------------------------------------------------------------------------------------

    def measure(self, name: str) -> float:
        """The measure `name` of the equations at this point."""
        known = getattr(self.equations, "measures", {})
        if self.recorded is not None and name in self.recorded and name not in known:
            return self.recorded[name]
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
        if hasattr(self.equations, "shape_at"):
            return Shape(*self.equations.shape_at(self.u, self.lam))
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
        """The shape at arclengths s, between the nodes linear or as the model knows it; `ValueError` outside of the rod."""
        s = np.asarray(s, dtype=np.float64)
        own = self._shape
        between = getattr(self.equations, "between", None)
        if not ((s >= own.s[0]) & (s <= own.s[-1])).all():
            raise ValueError(f"s must lie between {own.s[0]:g} and {own.s[-1]:g}; it is {s!r:.60}")
        if between is not None:
            return Shape(s, *(values.reshape(s.shape) for values in between(self.u, self.lam, s.ravel())))
        return Shape(s, *(np.interp(s, own.s, values) for values in own[1:]))

    # --- index -----------------------------------------------------------------------------------------------------

    @cached_property
    def inertia(self) -> Inertia | None:
        """Signs of the eigenvalues of the second variation; None where there is none (no symmetric Jacobian)."""
        if self.known_inertia is not None:  # shown for every solution near by, the exact one among them
            return self.known_inertia
        own = getattr(self.equations, "inertia", None)
        if own is not None:
            known: Inertia = own(self.u, self.lam)
            return known
        matrix = second_variation(self.equations, self.u, self.lam)
        bound = getattr(self.equations, "lipschitz", None)
        off = 2 * self.remaining_angle
        slack = np.inf if bound is None or not np.isfinite(off) else float(np.max(bound(self.u, self.lam)(off, 0.0)[0]))
        if not np.isfinite(slack):
            slack = off * self._lipschitz_seen(matrix)
        if not np.isfinite(slack):
            return Inertia(0, self.u.size, 0)
        return inertia_of(matrix, slack)

    def _lipschitz_seen(self, matrix: Any) -> float:
        """Change of the second variation a short way off, per unit of angle: where no bound is known, ten times that."""
        step = max(1e-6, 2 * self.remaining_angle) * np.where(np.arange(self.u.size) % 3, 1.0, -1.0)
        moved = [second_variation(self.equations, self.u + side * step, self.lam) for side in (1, -1)]
        return 10 * max(largest_change(other, matrix) for other in moved) / float(np.abs(step).max())

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

    @cached_property
    def remaining_angle(self) -> float:
        """What Newton left undone, as a change of any one unknown, with rounding of the unknowns themselves.

        Where the model does not know its rounding, also what the noise of its residual does to the unknowns.
        """
        left = self.remaining + EPS * float(np.abs(self.u).max(initial=0.0))
        if hasattr(self.equations, "rounding"):
            return left
        J = jacobian(self.equations, self.u, self.lam)
        with np.errstate(all="ignore"):
            return left + float(np.abs(factor(J).solve(self._noise)).max())

    @cached_property
    def error(self) -> float:
        """Estimate from above of the error of the tip angle (the last unknown), against the exact solution.

        Where the tip's angle is held, of the largest other one; a model says by `observed` which of its unknowns that is.

        Sum of what Newton left, of rounding of u, and of the residual and the bound on its rounding, carried to the tip
        by the adjoint v = J^{-T} e_n: of first order in these. Without the member `rounding` that bound is an
        estimate: eps |J| |u|, and how far from linear the residual is over a few units of rounding. Infinite where the index
        could not be verified, so that J may be singular and no error is known, unless the residual is exactly zero.
        A model with a mesh tells its error by its own member `error`, that of the mesh included.
        """
        own = getattr(self.equations, "error", None)
        if own is not None:
            return float(own(self.u, self.lam)) if self.index_verified else np.inf
        of = getattr(self.equations, "observed", None)
        which = -1 if of is None else int(of(self.u))
        unit = np.zeros_like(self.u)
        unit[which] = 1.0
        J, F = jacobian(self.equations, self.u, self.lam), np.asarray(self.equations.residual(self.u, self.lam))
        with np.errstate(all="ignore"):
            try:
                v = J.solve_fully(unit) if isinstance(J, Symmetric) else factor(J).solve_transposed(unit)
            except ValueError:  # its entries leave the range of floats
                return np.inf
            if not np.isfinite(v).all():
                v = np.full_like(unit, np.finfo(float).max)
            own = getattr(self.equations, "rounding", None)
            rounding = float(own(self.u, self.lam, v) if own is not None else np.abs(v) @ self._noise)
            rounding += 2 * abs(float(v @ F))  # what the residual still asks for, doubled for what is not linear
            if self.u.any():
                rounding += 4 * LEAST * (1 + float(np.abs(v).sum()))  # below TINY rounding is no longer relative
        total = self.remaining + EPS * abs(float(self.u[which])) + (rounding if np.isfinite(rounding) else np.inf)
        return total if total == 0 or self.inertia is None or self.inertia.verified else np.inf

    @cached_property
    def _noise(self) -> Array:
        """Rounding of the residual, entry by entry: eps |J| |u|, and how far from linear it is over a few units of rounding."""
        J, rng = jacobian(self.equations, self.u, self.lam), np.random.default_rng(0)
        F = np.asarray(self.equations.residual(self.u, self.lam))
        noise = EPS * (abs(J) @ np.abs(self.u) + np.abs(F))
        for _ in range(8):
            step = self.u * (1 + 1e4 * EPS * rng.uniform(-1, 1, self.u.size)) - self.u
            noise = np.maximum(noise, np.abs(np.asarray(self.equations.residual(self.u + step, self.lam)) - F - J @ step))
        return np.asarray(4 * noise)
