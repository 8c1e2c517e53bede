"""The shape of a rod and what is measured on it: angles, places, moments."""

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics import rod_ends
from rodlab.mechanics.mirror import mirror
from rodlab.mechanics.profile import Profile
from rodlab.mechanics.rod_energy import RodEnergy
from rodlab.numerics.arrays import Array, vector

if TYPE_CHECKING:
    from rodlab.mechanics.limit import Limit


class RodShape(RodEnergy):
    """The part of a `Rod` that knows its shapes."""

    curved: bool
    profiles: dict[str, Profile]

    def unstressed(self) -> Array:
        """phi0 + the integral of u_hat [N 2.6]: the equilibrium without load and terms."""
        u_hat = np.broadcast_to(self.parameters["u_hat"], self.grid.s.shape)
        return np.asarray(self.phi0 + self.grid.antiderivative(u_hat))

    @property
    def is_straight(self) -> bool:
        """True when phi = 0 is an equilibrium at every load."""
        if self.curved or self.phi0:
            return False
        zero = np.zeros(self.size)
        return not (self.residual(zero, 0.0).any() or self.residual(zero, 1.0).any())

    @cached_property
    def symmetries(self) -> tuple[Callable[[Array], Array], ...]:
        """Maps of the unknowns that take equilibria to equilibria: the mirror image, where the energy is the same for it."""
        return mirror(self, self.size)

    def height(self, u: Array) -> float:
        """z of the tip."""
        angle, _ = self.grid.at_gauss(self.grid.nodal(u, self.phi0))
        return float(np.sum(self.grid.hb * np.cos(angle)))

    def moment(self, u: Array, lam: float) -> float:
        """m(0), the moment in the clamp: what balances the moments of all loads, of order 2m as the angles are."""
        return -float(self.tested(u, lam, self.grid)[0, 0])

    def curvature(self, u: Array, lam: float) -> float:
        """phi'(0), from the moment in the clamp."""
        W = self.kernel(lam)
        s = np.zeros(1)
        given = {name: self.profiles[name].at(s) for name in W.parameters}
        foot = np.full(1, self.phi0)
        m0, k = W.moments(s, foot, lam, **given)[0], W.stiffness(s, foot, lam, **given)[0]
        return float(np.squeeze((self.moment(u, lam) - m0) / k))

    def shape(self, u: Any) -> tuple[Array, Array]:
        """x, z of the nodes, from the clamp (0, 0) to the tip."""
        angle, _ = self.grid.at_gauss(self.grid.nodal(vector("phi", u, self.size), self.phi0))
        x, z = (self.grid.antiderivative(f(angle)) for f in (np.sin, np.cos))
        return np.append(0.0, x), np.append(0.0, z)

    def reached(self, u: Array, lam: float) -> tuple[Array, Array]:
        """x, z of the nodes under a load, by which the rod may be sheared and extended."""
        x, z = (self.grid.antiderivative(slope) for slope in rod_ends.reach(self, u, lam))
        return np.append(self.x0, x + self.x0), np.append(0.0, z)

    def nodes(self, u: Array) -> tuple[Array, Array]:
        """s and phi of the nodes, the clamp first."""
        return self.grid.places, np.append(self.phi0, u)

    def derivation(self) -> "Limit":
        """SymPy's limit of the link: density, Euler and Lagrange's equation, first-order system; LaTeX in a notebook."""
        from rodlab.mechanics.limit import limit

        return limit(self.loaded)
