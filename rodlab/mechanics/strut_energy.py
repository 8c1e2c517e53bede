"""The energy of a strut, summed over its links by the kernel that SymPy derived, and its derivatives [N 2.7]."""

from functools import cached_property
from typing import Any

import numpy as np

from rodlab.mechanics import bounds, strut_ends
from rodlab.mechanics.assembly import balance, difference_form, full
from rodlab.mechanics.joints import Joints
from rodlab.mechanics.kernels import Kernel, kernel
from rodlab.mechanics.places import Places
from rodlab.mechanics.terms import Term
from rodlab.numerics.anchored import Anchored
from rodlab.numerics.arrays import EPS, Array, number, vector
from rodlab.numerics.difference import DifferenceForm, Springs
from rodlab.numerics.full import Full
from rodlab.numerics.tridiagonal import Tridiagonal


class StrutEnergy:
    """The part of a `Strut` that knows its energy."""

    joints: Joints
    springs: Springs
    terms: tuple[Term, ...]
    loaded: tuple[Term, ...]
    _unloaded: tuple[Term, ...]
    parameters: dict[str, Any]
    at_foot: dict[str, float]
    x0: float
    last_foot: "tuple[float, strut_ends.Foot] | None"

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.joints.n

    def __copy__(self) -> Any:
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        return other

    def __getstate__(self) -> dict[str, Any]:
        """Without the kernels, which may have been compiled here: they are found or derived again."""
        return {name: value for name, value in self.__dict__.items() if name not in ("_with_load", "_without_load")}

    def kernel(self, lam: float = 1.0) -> Kernel:
        """The compiled derivatives of one link's energy; at lam = 0 the load does not occur in it."""
        return self._with_load if lam else self._without_load

    @cached_property
    def _with_load(self) -> Kernel:
        return kernel(self.loaded, weighted=self.joints.weights is not None)

    @cached_property
    def _without_load(self) -> Kernel:
        return self._with_load if self.terms else kernel(self._unloaded, weighted=self.joints.weights is not None)

    def energy(self, phi: Any, lam: float) -> Any:
        """V(phi; lam): a float, or complex for complex angles. `ValueError` unless phi (n,) and lam are finite."""
        phi, lam = self._state(phi, lam)
        link, below = self.kernel(lam), self.below(phi)
        places = self.places.of(phi, self.x0) if link.places else ()
        e = link.energy(below, phi, *places, lam, **self.given(link))
        V = np.sum(e) + strut_ends.foot(self, lam).energy
        return complex(V) if np.iscomplexobj(V) else float(V)

    def gradient(self, phi: Any, lam: float) -> Array:
        """dV/dphi, shape (n,): the balance of moments on each link. `ValueError` unless phi (n,) and lam are finite."""
        return self.residual(*self._state(phi, lam))

    def hessian(self, phi: Any, lam: float) -> DifferenceForm | Tridiagonal | Anchored | Full:
        """d2V/dphi2: `.diagonal`, `.off_diagonal`, `.toarray()`, `.index`, `.solve(b)`; symmetric.

        Tridiagonal; with forces that change with the place (a foundation) full, but known by O(n) numbers
        (`rodlab.numerics.anchored`).
        """
        return self.jacobian(*self._state(phi, lam))

    def d_lam(self, phi: Any, lam: float) -> Array:
        """d(gradient)/dlam, shape (n,)."""
        phi, lam = self._state(phi, lam)
        link = self.kernel()
        m, f = link.moments_lam(self.below(phi), phi, lam, **self.given(link))
        return balance(m, f, phi)

    # --- the equations F(u, lam) = 0 that a solver sees -------------------------------------------------------

    def residual(self, u: Array, lam: float) -> Array:
        """The gradient, of arguments that are not looked at."""
        link = self.kernel(lam)
        given = self.given(link)
        m, f = link.moments(self.below(u), u, lam, **given)
        g = balance(m, f, u)
        if link.places:
            g += self.places.moments(u, *link.forces(*self.places.of(u, self.x0), **given))
        return g

    def jacobian(self, u: Array, lam: float) -> DifferenceForm | Tridiagonal | Anchored | Full:
        """The Hessian, of arguments that are not looked at."""
        link = self.kernel(lam)
        given = self.given(link)
        k, c_above, c_below = link.stiffness(self.below(u), u, lam, **given)
        c, spread = full(c_above, self.n), 0.0
        if np.ndim(c_below) or c_below:
            c[:-1] += full(c_below, self.n)[1:]
        if link.places:
            forces = link.forces(*self.places.of(u, self.x0), **given)
            c += self.places.softening(u, *forces)
            spread = 2 * self.n * EPS * float(self.places.size(*forces).max())  # of their cumulative sums
        local = difference_form(self.springs if k is self.joints.k else full(k, self.n), c, spread)
        return self.places.anchored(local, u, *link.hardening(*self.places.of(u, self.x0), **given)) if link.hardens else local

    def second_variation(self, u: Array, lam: float) -> DifferenceForm | Tridiagonal | Anchored | Full:
        """The Hessian, whose negative eigenvalues are the index."""
        return self.jacobian(u, lam)

    # --- bounds for proofs: see `rodlab.mechanics.bounds` ------------------------------------------------------------------

    def lipschitz(self, u: Array, lam: float) -> bounds.Bound:
        """How far Jacobian and d_lam may be from those at (u, lam) near by; see `rodlab.mechanics.bounds`."""
        return bounds.lipschitz(self, u, lam)

    def embedding(self, lam: float) -> tuple[float, float]:
        """(a, b) with max |w|^2 <= a w.Jw + b w.w for the Jacobian J at any angles and this load."""
        return bounds.embedding(self, lam)

    def rounding(self, phi: Array, lam: float, v: Array) -> float:
        """Bound on |v . (computed gradient - exact gradient)|: how far rounding moves a functional of the solution."""
        return bounds.rounding(self, phi, lam, v)

    @cached_property
    def carried(self) -> Array | None:
        """Bound on the moments of the dead forces of terms, shape (n,); None where no term uses the place."""
        link, zero = self.kernel(), np.zeros(self.n)
        return self.places.size(*link.forces(zero, zero, **self.given(link))) if link.places and not link.hardens else None

    # --- what is given at its ends, and what that brings about: see `rodlab.mechanics.strut_ends` -----------------------

    def acting(self, u: Array, lam: float) -> "tuple[StrutEnergy, Array, float]":
        """The clamped strut whose state this is, its angles, and the load on it: itself."""
        return self, u, lam

    def boundary(self, name: str, u: Array, lam: float) -> float:
        """dV/d(name) of a boundary value: lam, N1, tau, phi0 or x0."""
        return strut_ends.boundary(self, name, u, lam)

    def column(self, name: str, u: Array, lam: float) -> Array:
        """d(gradient)/d(name) of a boundary value, shape (n,)."""
        return strut_ends.column(self, name, u, lam)

    def second(self, one: str, other: str, u: Array, lam: float) -> float:
        """d2V/d(one) d(other) of two boundary values."""
        return strut_ends.second(self, one, other, u, lam)

    # --- small parts ----------------------------------------------------------------------------------------------

    @cached_property
    def places(self) -> Places:
        return Places(self.joints)

    def _state(self, phi: Any, lam: Any) -> tuple[Array, float]:
        return vector("phi", phi, self.n, complex_too=True), number("lam", lam)

    def below(self, phi: Array) -> Array:
        """phi_{i-1}: the angle under each joint, shape (n,)."""
        below = np.empty_like(phi)
        below[0] = self.joints.phi0
        below[1:] = phi[:-1]
        return below

    def given(self, link: Kernel) -> dict[str, Any]:
        """The parameters that a kernel asks for."""
        return {name: self.parameters[name] for name in link.parameters}
