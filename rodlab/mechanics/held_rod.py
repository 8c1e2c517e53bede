"""The rod between other ends than clamped and free: `rodlab.mechanics.held` on a collocated rod, with its mesh."""

from collections.abc import Sequence
from copy import copy
from typing import Any

import numpy as np

from rodlab.mechanics import resolution, rod_bounds
from rodlab.mechanics.ends import CANTILEVER, checked_ends, held_arguments, reactions_of
from rodlab.mechanics.held import Held
from rodlab.mechanics.recipe import rod_recipe_of, said_of_rod
from rodlab.mechanics.rod import Rod
from rodlab.mechanics.terms import Term
from rodlab.mechanics.varied_rod import VariedRod
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.collocated import Collocated
from rodlab.numerics.collocation import Grid


class HeldRod(Held, Rod):  # type: ignore[misc]  # what no bound is known for is None
    """A rod whose ends are held otherwise; made by `Rod(..., ends=...)`. Unknowns u: its reactions, then the angles at its nodes.

    >>> Rod(ends=("clamped", "clamped"))
    Rod(K=1.0, u_hat=0.0, ends=('clamped', 'clamped'))
    """

    def __init__(
        self,
        K: Any = 1.0,
        u_hat: Any = 0.0,
        phi0: float = 0.0,
        breaks: Sequence[float] = (),
        degree: int = 6,
        mesh: Any = None,
        tol: float = 1e-10,
        terms: Sequence[Term] = (),
        ends: tuple[str, str] = CANTILEVER,
        phi1: float = 0.0,
        offset: float = 0.0,
    ) -> None:
        ends = checked_ends(ends)
        super().__init__(K, u_hat, phi0, breaks, degree, mesh, tol, terms)
        base = Rod(K, u_hat, phi0, breaks, degree, mesh, tol, (*self.terms, *reactions_of(ends, self.terms)))
        self._hold(base, ends, phi1, offset)
        self.arguments |= held_arguments(ends, phi1, offset)

    @classmethod
    def around(cls, rod: Rod, ends: tuple[str, str]) -> "HeldRod":
        """A rod that is clamped and free, with a place for reactions."""
        held = object.__new__(cls)
        held.__dict__.update(rod.fresh().__dict__)
        held._hold(rod.fresh(), ends, 0.0, 0.0)
        held.arguments = {**rod.arguments, **held_arguments(ends, 0.0, 0.0)}
        return held

    def at(self, value: float) -> Rod:
        """The rod with this value of what is followed."""
        if self._varied is not None:
            return VariedRod(Rod.replace(self), self.follows, 0.0).at(value)
        return Rod.replace(self, **{self.follows: value})

    def sharing(self, value: float) -> "HeldRod":
        """The model with this value of what is followed, under any load, on the same mesh."""
        other: HeldRod = super().sharing(value)
        other.parameters, other.profiles, other.curved = other.base.parameters, other.base.profiles, other.base.curved
        return other

    def __repr__(self) -> str:
        return self._said(f"Rod({said_of_rod(self.arguments, self.terms)}")

    @property
    def recipe(self) -> dict[str, Any] | None:
        """What to write into a file so that `rodlab.mechanics.recipe.build` makes this rod, on this mesh; None for functions."""
        recipe = rod_recipe_of(self.arguments, self.terms)
        return self._recipe(None if recipe is None else {**recipe, "points": self.mesh.tolist()})

    # --- its mesh --------------------------------------------------------------------------------------------------------

    def on(self, mesh: Array, degree: int | None = None) -> "HeldRod":
        """The same on another mesh, or with another degree."""
        other = super().on(mesh, degree)
        assert isinstance(other, HeldRod)
        other.base, other._last = self.base.on(mesh, degree), None
        if self._varied is not None:
            other._varied = copy(self._varied)
            other._varied.rod, other._varied._last = other.base, None
        return other

    def moved(self, other: Any, u: Array, *, direction: bool = False) -> Array:
        """Unknowns of the same rod on another mesh, or a direction among them, on this one."""
        if other.grid is self.grid:
            return u
        reactions, phi = other.split(u)
        foot = reactions.get("phi0", 0.0 if direction else other.foot_at(u))
        angles = other.grid.onto(other.grid.nodal(phi, foot), self.grid)
        return np.append(u[: len(self.unknowns)], angles)

    def foot_at(self, u: Array) -> float:  # noqa: ARG002
        """The angle of the foot where it is given."""
        return float(self.base.phi0)

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.grid.N * self.degree + len(self.unknowns)

    @property
    def freedom(self) -> int:
        """Number of eigenvalues of the second variation on the directions that keep what is given."""
        return self.size - 2 * self.constraints

    def at_mesh(self, i: int) -> int:
        """The place in u of the angle at the upper end of interval i, or of reaction -1 - i."""
        return len(self.unknowns) + (i + 1) * self.degree - 1 if i >= 0 else -1 - i

    def observed(self, u: Array) -> int:
        """Which angle a point's error is of, by its interval: the last; where that is held the largest other, or the couple."""
        if "tau" not in self.unknowns:
            return self.grid.N - 1
        inner = self.angles(u)[self.degree - 1 : -1 : self.degree]
        return int(np.abs(inner).argmax()) if inner.size else -1 - self.unknowns.index("tau")

    # --- the cantilever's parts, at the unknowns u -------------------------------------------------------------------------

    def residual_wide(self, u: Array, lam: float) -> Array:
        """The residual, the angles' part computed in numpy's longest float."""
        model, phi, load = self.acting(u, lam)
        return np.append(self._rows(model, phi, load, lam), model.residual_wide(phi, load))

    def tested(self, u: Array, lam: float, grid: Grid) -> Array:
        """What each interval contributes to the gradient at its nodes, (N, m+1)."""
        model, phi, load = self.acting(u, lam)
        return np.asarray(model.tested(phi, load, grid))

    def stiffness(self, u: Array, lam: float) -> tuple[Any, Any, Any]:
        """As the cantilever's."""
        model, phi, load = self.acting(u, lam)
        parts: tuple[Any, Any, Any] = model.stiffness(phi, load)
        return parts

    def local(self, u: Array, lam: float) -> Collocated:
        """The second variation of the cantilever with all forces as they are."""
        model, phi, load = self.acting(u, lam)
        matrix: Collocated = model.local(phi, load)
        return matrix

    def sizes(self, u: Array, lam: float) -> Array:
        """Sum of the sizes of what is added up to each entry of the residual."""
        model, phi, load = self.acting(u, lam)
        return np.append(np.ones(len(self.unknowns)), model.sizes(phi, load))

    def rounding(self, u: Array, value: float, v: Array, eps: float = EPS) -> float:
        """Bound on |v . (computed residual - exact)|."""
        model, phi, lam = self.acting(u, value)
        m = len(self.unknowns)
        return float(rod_bounds.rounding(model, phi, lam, v[m:], eps)) + 8 * EPS * float(np.abs(v[:m]).sum())

    # --- shape -------------------------------------------------------------------------------------------------------------

    def nodes(self, u: Array) -> tuple[Array, Array]:
        """s and phi of the nodes, the foot first."""
        reactions, phi = self.split(u)
        return self.grid.places, np.append(reactions.get("phi0", self.foot_at(u)), phi)

    def reached(self, u: Array, lam: float) -> tuple[Array, Array]:
        """x, z of the nodes."""
        model, phi, load = self.acting(u, lam)
        x, z = model.reached(phi, load)
        return x, z

    def between(self, u: Array, lam: float, s: Array) -> tuple[Array, Array, Array]:
        """phi, x, z at any arclengths s (k,)."""
        fine, v = resolution.corrected(self, u, lam)
        model, phi, load = fine.acting(v, lam)
        return resolution.between(model, phi, load, s)
