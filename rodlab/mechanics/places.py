"""Where the joints are, and what forces on them do to the angles.

    x_i = sum_{j <= i} A_ij sin(phi_j) + x from the clamp's link,   z_i the same with cos
    A_ij = h own_i (i = j),  h w_j (i > j)       own_i = w_n w_i, own_n = w_n: a link takes w_n of its upper angle

With forces (X_i, Z_i) = (e_x, e_z) on the joints, N = A^T (X, Z) is what the links above carry [N 2.8, discrete force
balance]: the moment on link i is cos(phi_i) N_x - sin(phi_i) N_z. Cumulative sums make all of it O(n).
"""

from typing import Any

import numpy as np

from rodlab.mechanics.joints import Joints
from rodlab.numerics.anchored import Anchored
from rodlab.numerics.arrays import Array
from rodlab.numerics.full import Full

FEW = 100  # joints up to which a matrix that couples all of them is written out


class Places:
    """The places of a strut's joints as functions of its angles.

    >>> x, z = Places(Joints(np.ones(2), np.zeros(2), h=0.5)).of(np.array([0.0, np.pi / 2]))
    >>> x, z.round(15)
    (array([0. , 0.5]), array([0.5, 0.5]))
    """

    def __init__(self, joints: Joints) -> None:
        self.h, self.phi0, self.w = joints.h, joints.phi0, joints.w
        self.theta = joints.last_weight
        self.own = self.theta * self.w
        self.own[-1] = self.w[-1]

    def of(self, phi: Array, x0: float = 0.0) -> tuple[Array, Array]:
        """x, z of the joints 1..n, the foot at (x0, 0)."""
        x, z = self._sum(np.sin(phi), np.sin(self.phi0)), self._sum(np.cos(phi), np.cos(self.phi0))
        return (x + x0 if x0 else x), z

    def along(self, reach: Array, first: float) -> Array:
        """Places of the joints 1..n where link i reaches so far, (n,), and the foot's link `first`."""
        steps = self.theta * reach
        steps[-1] = reach[-1]
        steps[0] += first
        steps[1:] += (1 - self.theta) * reach[:-1]
        return np.asarray(np.cumsum(steps))

    @property
    def by_foot(self) -> tuple[float, float]:
        """How x and z of all joints change with the angle of the foot."""
        first = self.h * (1 - self.theta)
        return float(first * np.cos(self.phi0)), float(-first * np.sin(self.phi0))

    def _sum(self, values: Array, clamp: Any) -> Array:
        steps = self.own * values
        if self.theta != 1:
            steps[0] += (1 - self.theta) * clamp
            steps[1:] += (1 - self.theta) * self.w[:-1] * values[:-1]
        return np.asarray(self.h * np.cumsum(steps))

    def carried(self, force: Any) -> Array:
        """N = A^T force, shape (n,)."""
        force = np.broadcast_to(force, self.w.shape)
        above = np.cumsum(force[::-1])[::-1] - force
        return np.asarray(self.h * (self.own * force + self.w * above))

    def moments(self, phi: Array, X: Any, Z: Any) -> Array:
        """Moments of the forces on the links."""
        return np.asarray(np.cos(phi) * self.carried(X) - np.sin(phi) * self.carried(Z))

    def softening(self, phi: Array, X: Any, Z: Any) -> Array:
        """What dead forces take from the diagonal of the Hessian."""
        return np.asarray(np.sin(phi) * self.carried(X) + np.cos(phi) * self.carried(Z))

    def anchored(self, local: Any, phi: Array, xx: Any, xz: Any, zz: Any) -> Anchored | Full:
        """The Hessian `local` and J^T diag(e'') J, of forces that change with the place; without z where none change with it.

        For few joints written out, which is then quicker.
        """
        used = 1 if all(np.ndim(e) == 0 and e == 0 for e in (xz, zz)) else 2
        turn = np.stack([np.cos(phi), -np.sin(phi)])[:used]
        lower = np.zeros_like(turn)
        lower[:, 1:] = self.h * (1 - self.theta) * self.w[:-1] * turn[:, :-1]
        stiffness = np.empty((used, used, phi.size))
        for (k, m), e in {(0, 0): xx, (0, 1): xz, (1, 0): xz, (1, 1): zz}.items():
            if max(k, m) < used:
                stiffness[k, m] = e
        matrix = Anchored(local, lower, self.h * self.own * turn, stiffness)
        return Full(matrix.toarray()) if phi.size <= FEW else matrix

    def size(self, X: Any, Z: Any) -> Array:
        """Bound on the moments of the forces, shape (n,)."""
        return self.carried(np.abs(X)) + self.carried(np.abs(Z))
