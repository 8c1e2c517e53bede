"""The standard map [Chirikov 1979] that a strut of equal joints is: its phase portrait, and where the equilibria lie on it.

    p_{i+1} = p_i - r sin(phi_i),   phi_{i+1} = phi_i + p_{i+1}          r = lam h / k,  p_i = phi_i - phi_{i-1}

An equilibrium is an orbit of n steps from phi_0 = 0 to p_{n+1} = 0. For small r orbits are the curves of a pendulum; as r grows
chaos spreads, and with it the number of equilibria.
"""

import numpy as np

from rodlab.analysis.point import Point
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array


def parameter(strut: Strut, lam: float) -> float:
    """r of a strut at a load. `ValueError` unless its joints are equal and straight, with no terms.

    >>> parameter(Strut(n=5), 60.0)
    2.4
    """
    joints = strut.joints
    if joints.curved or strut.terms or np.ptp(joints.k) > 1e-12 * joints.k[0] or joints.weights is not None:
        raise ValueError(f"strut must have equal straight joints and equal weights to be a standard map; it is {strut!r}")
    return float(lam * joints.h / joints.k[0])


def portrait(r: float, orbits: int = 60, steps: int = 500) -> tuple[Array, Array]:
    """Orbits of the map from a line across and a line along it: phi and p in (-pi, pi], shape (orbits, steps)."""
    half = orbits // 2
    phi = np.append(np.full(half, 1e-3), np.linspace(-np.pi, np.pi, orbits - half))
    p = np.append(np.linspace(-np.pi, np.pi, half), np.full(orbits - half, 1e-3))
    all_phi, all_p = np.empty((2, orbits, steps))
    for i in range(steps):
        all_phi[:, i], all_p[:, i] = phi, p
        p = p - r * np.sin(phi)
        phi = phi + p
    return wrapped(all_phi), wrapped(all_p)


def orbit(p: Point) -> tuple[Array, Array]:
    """phi_i and p_i of an equilibrium, i = 1 .. n, and the last p_{n+1} = 0 with phi_n, in (-pi, pi]."""
    phi = p.phi
    return wrapped(phi[1:]), wrapped(np.diff(phi))


def wrapped(x: Array) -> Array:
    """Angles in (-pi, pi].

    >>> wrapped(np.array([0.5, 2 * np.pi, -np.pi])).round(12)
    array([0.5       , 0.        , 3.14159265])
    """
    return np.asarray(np.pi - (np.pi - x) % (2 * np.pi))
