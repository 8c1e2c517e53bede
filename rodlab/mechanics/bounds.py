"""How far the derivatives of the strut's energy can change near by, and what rounding does to its gradient.

The load's part of the Hessian is -lam h w cos(phi) on the diagonal, and the cosine changes by at most |dphi| (|sin phi| +
|dphi| / 2): little where the strut is nearly straight. This lets a step of a continuation be proved (`rodlab.analysis.proof`).
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics.assembly import balance, full
from rodlab.numerics.arrays import EPS, Array

if TYPE_CHECKING:
    from rodlab.mechanics.strut_energy import StrutEnergy

KNOWN = ("bending", "bending_with_rest", "end_load", "end_torque", "end_force", "self_weight")
Bound = Callable[[Any, float], tuple[Any, Any]]  # (du, dlam) -> (d, c)


def unknown(_du: Any, _dlam: float) -> tuple[Any, Any]:
    """No bound."""
    return np.inf, np.inf


def lipschitz(strut: "StrutEnergy", u: Array, lam: float) -> Bound:
    """Bounds on the change of Jacobian and d_lam, as a function of how far angles (entrywise) and load are from (u, lam).

    It returns a diagonal d with -d <= J' - J <= d, and a bound on the entries of the change of d_lam; shapes (n,), convex in
    the distances. Infinite for a foundation or a term of one's own.
    """
    if any(term.energy is not None or term.name not in KNOWN for term in strut.loaded):
        return unknown
    hw = strut.joints.h if strut.joints.weights is None else strut.joints.h * strut.joints.weights
    sine, cosine, carried = np.abs(np.sin(u)), np.abs(np.cos(u)), strut.carried
    aside = abs(strut.parameters.get("N1", 0.0))

    def bound(du: Array | float, dlam: float) -> tuple[Array, Array]:
        hwdu = hw * du
        half = np.asarray(du) / 2
        d = (sine + half) * (abs(lam) * hwdu)
        d += hw * dlam
        if aside:
            d += (cosine + half) * (aside * hwdu)
        if carried is not None:
            d += 2 * du * carried
        return d, (cosine + half) * hwdu

    return bound


def embedding(strut: "StrutEnergy", lam: float) -> tuple[float, float]:
    """(a, b) with max |w|^2 <= a w.Jw + b w.w for the Jacobian J at any angles and this load.

    w_i is a sum of its differences: w_i^2 <= sum(1/k) w.D^T k D w (Cauchy and Schwarz), and J = D^T k D - C.
    """
    a = strut.springs.total_compliance
    softest = (abs(lam) + abs(strut.parameters.get("N1", 0.0))) * strut.joints.h * strut.joints.most_weight
    if strut.carried is not None:
        softest += float(strut.carried.max())
    return a, a * softest


def rounding(strut: "StrutEnergy", phi: Array, lam: float, v: Array) -> float:
    """Bound on |v . (computed gradient - exact gradient)|.

    The moments enter as differences, so their relative rounding counts with the variation of v, not with n.
    """
    link = strut.kernel(lam)
    given = strut.given(link)
    below = strut.below(phi)
    m, f = link.moments(below, phi, lam, **given)
    size = np.abs(m) + 2 * strut.joints.k * np.abs(phi - below)
    moments = np.abs(np.diff(v, prepend=0.0)) @ size
    loads = np.abs(v) @ (2 * np.abs(full(f, strut.n)) + np.abs(balance(m, f, phi)))
    if link.places:
        N = link.forces(*strut.places.of(phi), **given)
        loads += strut.n * float(np.abs(v) @ strut.places.size(*N))
    return float(4 * EPS * (moments + loads))
