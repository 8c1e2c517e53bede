"""Where the points of a collocated rod are, and what forces on them do to its angles.

    x_ic = x_i + h_i sum_d A_cd sin(phi_id)         Gauss's points c of interval i; x_{i+1} the same with b
    Q_id = sum_c A_cd W_ic / b_d + sum_{k > i} W_k    what forces W = h b X on all points above leave to be carried at one

the adjoint of the first, which is again Gauss's collocation of Q' = -X, Q(1) = 0 [Hager 2000; Sanz-Serna 2016]: x, z and the
forces are as accurate as the angles. The moment on a point is cos(phi) Q1 - sin(phi) Q3, as for a strut (`places`).
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.numerics.arrays import Array
from rodlab.numerics.collocation import Grid

if TYPE_CHECKING:
    from rodlab.mechanics.rod_energy import RodEnergy

MOST = 3000  # unknowns of a rod whose terms couple all angles


def places(rod: "RodEnergy", angle: Array, grid: Grid) -> tuple[Array, Array]:
    """x, z at Gauss's points, (N, m) each."""
    return _summed(np.sin(angle), grid) + rod.x0, _summed(np.cos(angle), grid)


def _summed(slope: Array, grid: Grid) -> Array:
    h = grid.h[:, None]
    steps = h * (slope @ grid.A.T)
    ends = np.cumsum(np.sum(grid.hb * slope, axis=1))
    steps[1:] += ends[:-1, None]
    return np.asarray(steps)


def carried(force: Any, grid: Grid) -> Array:
    """Q (N, m) of forces a unit of length at Gauss's points."""
    W = grid.hb * force
    below = np.cumsum(W.sum(axis=1)[::-1])[::-1]
    Q = (W @ grid.A) / grid.b
    Q[:-1] += below[1:, None]
    return np.asarray(Q)


def forces(rod: "RodEnergy", angle: Array, grid: Grid) -> tuple[Array, Array]:
    """Q1, Q3 at Gauss's points: what the terms of the place leave to be carried."""
    W = rod.kernel()
    X, Z = W.forces(*places(rod, angle, grid), **rod.given(W))
    return carried(X, grid), carried(Z, grid)


def hardening(rod: "RodEnergy", angle: Array) -> Array:
    """The part of the second variation from forces that change with the place, over all nodes: (N m + 1, N m + 1)."""
    grid, W = rod.grid, rod.kernel()
    if rod.size > MOST:
        raise ValueError(f"a rod whose terms couple all angles must have at most {MOST} unknowns; on this mesh it has {rod.size}")
    stiffness = W.hardening(*places(rod, angle, grid), **rod.given(W))
    xx, xz, zz = (np.broadcast_to(grid.hb * part, angle.shape).ravel()[:, None] for part in stiffness)
    J, seen = grid.cumulative, grid.all_seen
    Jx, Jz = ((J * turn.ravel()) @ seen for turn in (np.cos(angle), -np.sin(angle)))
    if not (xz.any() or zz.any()):
        return np.asarray(Jx.T @ (xx * Jx))
    mixed = Jx.T @ (xz * Jz)
    return np.asarray(Jx.T @ (xx * Jx) + Jz.T @ (zz * Jz) + mixed + mixed.T)


def by_foot(rod: "RodEnergy", angle: Array) -> Array:
    """How the gradient changes with x0, the foot's place, over all nodes: (N m + 1,)."""
    grid, W = rod.grid, rod.kernel()
    xx, xz, _ = W.hardening(*places(rod, angle, grid), **rod.given(W))
    moment = np.cos(angle) * carried(xx, grid) - np.sin(angle) * carried(xz, grid)
    return np.asarray((grid.hb * moment).ravel() @ grid.all_seen)
