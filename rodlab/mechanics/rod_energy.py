"""The energy of a rod on its mesh, by Gauss's rule, and its derivatives: what Newton's method and the index are made of.

V = sum_i h_i sum_c b_c W(phi'_c, phi_c, x_c, z_c; lam); its gradient is that of `numerics.collocation` and the moments of forces.
"""

from functools import cached_property, partial
from typing import Any

import numpy as np

from rodlab.mechanics import rod_ends, rod_places
from rodlab.mechanics.kernels import density
from rodlab.mechanics.terms import Term
from rodlab.numerics.arrays import Array, number, vector
from rodlab.numerics.collocated import Collocated
from rodlab.numerics.collocation import Grid
from rodlab.numerics.full import Full


class RodEnergy:
    """The part of a `Rod` that knows its energy."""

    grid: Grid
    phi0: float
    x0: float
    terms: tuple[Term, ...]
    loaded: tuple[Term, ...]
    _unloaded: tuple[Term, ...]
    parameters: dict[str, Any]
    _last_state: tuple[Array, Array, Array] | None
    _last_hardening: tuple[Array, Array] | None

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.grid.N * self.grid.degree

    def __copy__(self) -> Any:
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        return other

    def __getstate__(self) -> dict[str, Any]:
        """Without the kernels, which may have been compiled here: they are found or derived again."""
        return {name: value for name, value in self.__dict__.items() if name not in ("_with_load", "_without_load")}

    def kernel(self, lam: float = 1.0) -> Any:
        """The compiled derivatives of the density; at lam = 0 the load does not occur in it."""
        return self._with_load if lam else self._without_load

    @cached_property
    def _with_load(self) -> Any:
        return density(self.loaded)

    @cached_property
    def _without_load(self) -> Any:
        return self._with_load if self.terms else density(self._unloaded)

    def given(self, kernel: Any) -> dict[str, Any]:
        """The parameters that a kernel asks for."""
        return {name: self.parameters[name] for name in kernel.parameters}

    def energy(self, phi: Any, lam: float) -> float:
        """V(phi; lam) by Gauss's rule. `ValueError` unless phi (N m,) and lam are finite."""
        u, lam = self._state(phi, lam)
        W, grid = self.kernel(lam), self.grid
        angle, slope = grid.at_gauss(grid.nodal(u, self.phi0))
        places = rod_places.places(self, angle, grid) if W.places else ()
        V = np.sum(grid.hb * W.energy(slope, angle, *places, lam, **self.given(W)))
        return complex(V) if np.iscomplexobj(V) else float(V)  # type: ignore[return-value]

    def gradient(self, phi: Any, lam: float) -> Array:
        """dV/dphi, shape (N m,). `ValueError` unless phi (N m,) and lam are finite."""
        return self.residual(*self._state(phi, lam))

    def hessian(self, phi: Any, lam: float) -> Collocated | Full:
        """d2V/dphi2: `.toarray()`, `.index`, `.solve(b)`; symmetric, of overlapping blocks.

        Full where forces change with the place (a foundation): then a solve costs O((N m)^3).
        """
        return self.jacobian(*self._state(phi, lam))

    def d_lam(self, phi: Array, lam: float) -> Array:
        """d(gradient)/dlam, shape (N m,), of arguments that are not looked at."""
        return self.by("lam", phi, lam)

    # --- the equations F(u, lam) = 0 that a solver sees ---------------------------------------------------------

    def residual(self, u: Array, lam: float) -> Array:
        """The gradient, of arguments that are not looked at."""
        return Grid.gathered(self.tested(u, lam, self.grid))

    def residual_wide(self, u: Array, lam: float) -> Array:
        """The same computed in numpy's longest float, and rounded once: 11 bits more where the machine has them."""
        return np.asarray(Grid.gathered(self.tested(u, lam, self.grid.wide)), dtype=np.float64)

    def tested(self, u: Array, lam: float, grid: Grid) -> Array:
        """What each interval contributes to the gradient at its nodes, (N, m+1)."""
        return grid.tested(*self.moments(u, lam, grid))

    def moments(self, u: Array, lam: float, grid: Grid | None = None) -> tuple[Any, Any]:
        """W_phi' and the moment on a unit of length at Gauss's points: W_phi, and what forces on the places do."""
        W = self.kernel(lam)
        own = grid is None or grid is self.grid
        angle, slope = self.at_gauss(u) if own else grid.at_gauss(grid.nodal(u, self.phi0))  # type: ignore[union-attr]
        m, f = W.moments(slope, angle, lam, **self.given(W))
        if W.places:
            Q1, Q3 = rod_places.forces(self, angle, self.grid if grid is None else grid)
            f = f + np.cos(angle) * Q1 - np.sin(angle) * Q3
        return m, f

    def stiffness(self, u: Array, lam: float) -> tuple[Any, Any, Any]:
        """W_phi'phi', W_phi'phi and the change of the moment above with the angle, the forces as they are."""
        W = self.kernel(lam)
        angle, slope = self.at_gauss(u)
        k, mixed, soft = W.stiffness(slope, angle, lam, **self.given(W))
        if W.places:
            Q1, Q3 = rod_places.forces(self, angle, self.grid)
            soft = soft - np.sin(angle) * Q1 - np.cos(angle) * Q3
        return k, mixed, soft

    def local(self, u: Array, lam: float) -> Collocated:
        """The second variation with the forces of terms as they are: all of it but for a foundation."""
        k, mixed, soft = self.stiffness(u, lam)
        matrix = self.grid.second(self._stiff if k is self.parameters["K"] else self.grid.stiff(k), mixed, soft)
        matrix.parts = partial(self.grid.quadratic, k, mixed, soft)
        return matrix

    def hardening(self, u: Array) -> Array | None:
        """The rest of it over all nodes, the foot's first: (N m + 1, N m + 1); None where no force changes with the place.

        Kept for the last u that was asked for: the border of other ends asks for its first column too.
        """
        if not self.kernel().hardens:
            return None
        angle, _ = self.at_gauss(u)
        if self._last_hardening is None or self._last_hardening[0] is not angle:
            self._last_hardening = angle, rod_places.hardening(self, angle)
        return self._last_hardening[1]

    def jacobian(self, u: Array, lam: float) -> Collocated | Full:
        """The Hessian, of arguments that are not looked at."""
        local, rest = self.local(u, lam), self.hardening(u)
        return local if rest is None else Full(local.toarray() + rest[1:, 1:])

    @cached_property
    def _stiff(self) -> Array:
        return self.grid.stiff(self.parameters["K"])

    def by(self, name: str, u: Array, lam: float, unit: Any = 1.0) -> Array:
        """The derivative of the gradient in the load, or in a parameter that grows like `unit`, a number or (N, m)."""
        return Grid.gathered(self.by_nodes(name, u, lam, unit))

    def by_nodes(self, name: str, u: Array, lam: float, unit: Any = 1.0) -> Array:
        """The same as what each interval contributes at its nodes, (N, m+1)."""
        W, grid = self.kernel(), self.grid
        angle, slope = self.at_gauss(u)
        given = self.given(W)
        m, f = getattr(W, f"moments_{name}")(slope, angle, lam, **given)
        f = f * unit
        if W.places and hasattr(W, f"forces_{name}"):
            changes = getattr(W, f"forces_{name}")(*rod_places.places(self, angle, grid), **given)
            Q1, Q3 = (rod_places.carried(change * unit, grid) for change in changes)
            f = f + np.cos(angle) * Q1 - np.sin(angle) * Q3
        return grid.tested(np.broadcast_to(m * unit, angle.shape), f)

    def boundary(self, name: str, u: Array, lam: float) -> float:
        """dV/d(name) of a boundary value: lam, N1, tau, phi0 or x0."""
        return rod_ends.boundary(self, name, u, lam)

    def column(self, name: str, u: Array, lam: float) -> Array:
        """d(gradient)/d(name) of a boundary value, shape (N m,)."""
        return rod_ends.column(self, name, u, lam)

    def second(self, one: str, other: str, u: Array, lam: float) -> float:
        """d2V/d(one) d(other) of two boundary values."""
        return rod_ends.second(self, one, other, u, lam)

    def at_gauss(self, u: Array) -> tuple[Array, Array]:
        """Angles and their derivatives at Gauss's points, (N, m) each; kept for the last u that was asked for."""
        last = self._last_state
        if last is not None and last[0].size == u.size and (last[0] == u).all():
            return last[1], last[2]
        angle, slope = self.grid.at_gauss(self.grid.nodal(u, self.phi0))
        self._last_state = (u.copy(), angle, slope)
        return angle, slope

    def _state(self, phi: Any, lam: Any) -> tuple[Array, float]:
        return vector("phi", phi, self.size, complex_too=True), number("lam", lam)
