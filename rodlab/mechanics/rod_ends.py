"""The rod as a function of what is given at its ends: its energy's derivatives in the boundary values, as `strut_ends` has them.

lam and N1, tau, phi0 and x0; the foot's own node, which the unknowns leave out, counts here.
"""

from typing import TYPE_CHECKING

import numpy as np

from rodlab.mechanics import rod_places
from rodlab.mechanics.strut_ends import FORCES
from rodlab.numerics.arrays import Array
from rodlab.numerics.collocation import Grid

if TYPE_CHECKING:
    from rodlab.mechanics.rod_energy import RodEnergy


def reach(rod: "RodEnergy", u: Array, lam: float) -> tuple[Array, Array]:
    """x', z' at Gauss's points, (N, m) each."""
    W = rod.kernel()
    angle, slope = rod.at_gauss(u)
    dx, dz = W.reach(slope, angle, lam, **rod.given(W))
    return np.broadcast_to(dx, angle.shape), np.broadcast_to(dz, angle.shape)


def boundary(rod: "RodEnergy", name: str, u: Array, lam: float) -> float:
    """dV/d(name) of a boundary value."""
    if name in FORCES:
        dx, dz = reach(rod, u, lam)
        return float(np.sum(rod.grid.hb * dz)) if name == "lam" else -float(np.sum(rod.grid.hb * dx)) - rod.x0
    if name == "tau":
        return -float(u[-1])
    if name == "phi0":
        return float(rod.tested(u, lam, rod.grid)[0, 0]) - float(rod.parameters.get("tau", 0.0))
    W, grid = rod.kernel(), rod.grid
    angle, _ = rod.at_gauss(u)
    X, _ = W.forces(*rod_places.places(rod, angle, grid), **rod.given(W))
    return float(np.sum(grid.hb * X)) - float(rod.parameters.get("N1", 0.0))


def column(rod: "RodEnergy", name: str, u: Array, lam: float) -> Array:
    """d(gradient)/d(name), shape (N m,)."""
    if name in FORCES:
        return Grid.gathered(rod.by_nodes(name, u, lam))
    if name == "tau":
        out = np.zeros(u.size)
        out[-1] = -1.0
        return out
    if name == "phi0":
        local, rest = rod.local(u, lam), rod.hardening(u)
        out = np.zeros(u.size) if rest is None else rest[1:, 0].copy()
        out[: rod.grid.degree] += local.blocks[0, 1:, 0]
        return out
    return rod_places.by_foot(rod, rod.at_gauss(u)[0])[1:]


def second(rod: "RodEnergy", one: str, other: str, u: Array, lam: float) -> float:
    """d2V/d(one) d(other) of two boundary values."""
    pair = {one, other}
    if "tau" in pair or pair == {"x0", "lam"}:
        return 0.0
    if pair == {"x0", "N1"}:
        return -1.0
    W, grid = rod.kernel(), rod.grid
    angle, slope = rod.at_gauss(u)
    if pair <= set(FORCES) and not W.yields:
        return 0.0
    if pair <= set(FORCES):
        which = len(pair - {"lam"}) + (one == other == "N1")
        return float(np.sum(grid.hb * W.yielding(slope, angle, lam, **rod.given(W))[which]))
    if pair & set(FORCES):
        return float(rod.by_nodes("lam" if "lam" in pair else "N1", u, lam)[0, 0])
    if pair == {"x0"}:
        xx = W.hardening(*rod_places.places(rod, angle, grid), **rod.given(W))[0]
        return float(np.sum(grid.hb * xx))
    if pair == {"x0", "phi0"}:
        return float(rod_places.by_foot(rod, angle)[0])
    rest = rod.hardening(u)
    return float(rod.local(u, lam).foot) + (0.0 if rest is None else float(rest[0, 0]))
