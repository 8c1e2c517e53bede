"""How far the derivatives of a collocated rod's energy can change near by, and what rounding does to its gradient.

The load's part of the second variation is -E^T diag(h b lam cos phi) E: it changes through the angles that are seen at Gauss's
points, and by a matrix of the same form (`rodlab.numerics.slack`). As for the strut (`bounds`) this lets steps be proved.
"""

from typing import TYPE_CHECKING

import numpy as np

from rodlab.mechanics import rod_places
from rodlab.mechanics.bounds import Bound, unknown
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.collocation import Grid
from rodlab.numerics.slack import Slack

if TYPE_CHECKING:
    from rodlab.mechanics.rod import Rod

KNOWN = ("bending", "bending_with_rest", "end_load", "end_torque", "end_force", "self_weight")
WIDE = float(np.finfo(np.longdouble).eps)


def lipschitz(rod: "Rod", u: Array, lam: float) -> Bound:
    """Bounds on the change of Jacobian and d_lam, as a function of how far the angles at Gauss's points and the load move."""
    if any(term.energy is not None or term.name not in KNOWN for term in rod.loaded):
        return unknown
    grid = rod.grid
    angle, _ = rod.at_gauss(u)
    sine, cosine = np.abs(np.sin(angle)), np.abs(np.cos(angle))
    E, hb, carried = np.abs(grid.E), grid.hb, dead(rod)

    def bound(moved: Array | float, dlam: float) -> tuple[Slack, Array]:
        half = np.asarray(moved) / 2
        d = hb * (abs(lam) * moved * (sine + half) + dlam + moved * carried)
        return Slack(grid, d), Grid.gathered((hb * (moved * (cosine + half))) @ E)

    return bound


def embedding(rod: "Rod", lam: float) -> tuple[float, float]:
    """(a, b) with max |w|^2 <= a w.Jw + b w.w over nodes and Gauss's points, for the Jacobian J at any angles and this load.

    w there is the integral of w', a sum over Gauss's points with weights alpha: by Cauchy and Schwarz its square is at most
    sum(alpha^2 / (h b K)) times the bending part of w.Jw.
    """
    a, softest = rod.compliance
    return a, a * (abs(lam) + float(np.max(dead(rod)))) * softest


def dead(rod: "Rod") -> Array | float:
    """Size of the dead forces besides the load that are carried at Gauss's points: N1, and weight."""
    W = rod.kernel()
    carried: Array | float = abs(rod.parameters.get("N1", 0.0))
    if W.places and not W.hardens:
        none = np.zeros_like(rod.grid.s)
        carried = carried + sum(np.abs(Q) for Q in rod_places.forces(rod, none, rod.grid))
    return carried


def compliance(rod: "Rod") -> tuple[float, float]:
    """(a, c): the a above, and the largest entry of the diagonal that bounds the load's part of the Jacobian per unit of load."""
    grid, B = rod.grid, rod.grid.basis
    K = np.broadcast_to(rod.parameters["K"], grid.s.shape)
    weights = np.vstack([B.to_nodes[1:], B.A]) ** 2 / B.b
    inside = ((grid.h[:, None] / K)[:, None, :] * weights).sum(axis=2)
    before = np.append(0.0, np.cumsum((grid.hb / K).sum(axis=1))[:-1])
    size = np.abs(grid.E)
    softest = Grid.gathered((grid.hb * size.sum(axis=1)) @ size)
    return float((before[:, None] + inside).max()), float(softest.max())


def rounding(rod: "Rod", u: Array, lam: float, v: Array, eps: float = EPS) -> float:
    """Bound on |v . (computed gradient - exact gradient)| for arithmetic of this precision."""
    grid = rod.grid
    Y = grid.nodal(u, rod.phi0)
    m, f = rod.moments(u, lam)
    k, _, _ = rod.stiffness(u, lam)
    V = grid.nodal(v, 0.0)
    values, slopes = grid.at_gauss(V)
    differences = np.abs(Y[:, 1:] - Y[:, :1]) @ np.abs(grid.slope) / grid.h[:, None]
    moments = np.abs(slopes) * (np.abs(m) + np.abs(k) * differences)
    loads = np.abs(values) * np.abs(f)
    return float((4 + rod.degree) * eps * np.sum(grid.hb * (moments + 2 * loads)))


def sizes(rod: "Rod", u: Array, lam: float) -> Array:
    """Sum of the sizes of what is added up to each entry of the gradient, (N m,)."""
    grid = rod.grid
    m, f = rod.moments(u, lam)
    G = (grid.b * np.abs(m)) @ np.abs(grid.D) + (grid.hb * np.abs(f)) @ np.abs(grid.E)
    return Grid.gathered(np.asarray(G))
