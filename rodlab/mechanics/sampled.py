"""All equilibria of a strut as far as samples show them: the scalar function of the tip angle, in floats.

phi_0(a) is sampled until Hermite's cubics predict the values between, then every whole turn between neighbours is bracketed,
also at the extrema of the cubics. Complete if nothing happens between samples: no proof, but fast, and for long struts all
that can be had. Cost: samples times n.
"""

from math import log2

import numpy as np

from rodlab.mechanics.recurrence import CUTS, Floats, Recurrence, bits
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array

FIRST = 2049
FINE = 1e-3  # error of a cubic half-way between its samples, radians
ROUNDS = 60
MANY, MOST = 100_000, 1_000_000  # equilibria, and angles of all of them
COARSE = 1_000_000  # samples times n, to see whether there are too many
FROM_STRAIGHT = 1e-9  # tip angle beside the straight strut that a straight one is searched from


def sampled(strut: Strut, lam: float, *, most: int = 1_000_000) -> list[Array] | None:
    """Angles (n,) of every equilibrium that samples show, about; None where `most` samples do not resolve the function.

    >>> [phi.round(2).tolist() for phi in sampled(Strut.from_joints(k=[1.0, 1.0]), 3.0)]
    [[0.0, 0.0], [-0.99, 0.53], [0.99, -0.53], [2.45, 2.97], [-2.45, -2.97]]
    """
    if too_many(strut, lam):
        return None
    map_ = Recurrence(strut, lam, Floats())
    low, high = (FROM_STRAIGHT, np.pi) if map_.odd else (CUTS[0], CUTS[0] + 2 * np.pi)
    a = np.linspace(low, high, FIRST)
    with np.errstate(all="ignore"):
        return _found(map_, a, most)


def _found(map_: Recurrence, a: Array, most: int) -> list[Array] | None:
    G, slope = _values(map_, a)
    while True:
        middle = (a[:-1] + a[1:]) / 2
        at, rate = _values(map_, middle)
        cubic = (G[:-1] + G[1:]) / 2 + np.diff(a) * (slope[:-1] - slope[1:]) / 8
        new = (np.abs(at - cubic) > FINE) & (middle > a[:-1]) & (middle < a[1:])
        if not new.any():
            break
        if a.size + new.sum() > most or not np.isfinite(at).all():
            return None
        a, G, slope = _merged((a, G, slope), (middle[new], at[new], rate[new]))
    a, G = _with_extrema(map_, a, G, slope)
    many = float(np.abs(np.diff(np.floor(G / (2 * np.pi)))).sum())
    if many > MANY or many * map_.n > MOST:
        return None
    tips, turns = _roots(map_, a, G)
    angles = np.array(map_.thin(tips)[0][-2::-1]).T - 2 * np.pi * turns[:, None]
    if not map_.odd:
        return list(angles)
    return [np.zeros(map_.n), *(side * phi for phi in angles for side in (1.0, -1.0))]


def too_many(strut: Strut, lam: float) -> bool:
    """True when even a coarse sample shows more equilibria than can be listed, or floats cannot follow the function at all."""
    if bits(strut, lam) <= log2(MANY):  # phi_0 does not turn more often than its slope allows
        return False
    map_ = Recurrence(strut, lam, Floats())
    with np.errstate(all="ignore"):
        phi, _ = map_.end(np.linspace(CUTS[0], CUTS[0] + 2 * np.pi, COARSE // strut.n + FIRST))
        turns = np.abs(np.diff(np.floor(phi / (2 * np.pi)))).sum()
    return not turns <= MANY


def _values(map_: Recurrence, a: Array) -> tuple[Array, Array]:
    phi, psi = map_.end(a)
    return phi - map_.phi0, psi


def _merged(old: tuple[Array, ...], new: tuple[Array, ...]) -> tuple[Array, ...]:
    order = np.argsort(np.append(old[0], new[0]), kind="stable")
    return tuple(np.append(x, y)[order] for x, y in zip(old, new, strict=True))


def _with_extrema(map_: Recurrence, a: Array, G: Array, slope: Array) -> tuple[Array, Array]:
    """The samples with those next to the extrema between them, where the slope changes sign."""
    i = np.flatnonzero(slope[:-1] * slope[1:] < 0)
    low, high, rising = a[i], a[i + 1], slope[i] > 0
    for _ in range(ROUNDS):
        middle = (low + high) / 2
        left = (_values(map_, middle)[1] > 0) == rising
        low, high = np.where(left, middle, low), np.where(left, high, middle)
    both = _merged((a, G), (low, _values(map_, low)[0]))
    return both[0], both[1]


def _roots(map_: Recurrence, a: Array, G: Array) -> tuple[Array, Array]:
    """Tip angles at which phi_0 is a whole turn from the clamp, and how many turns, by bisection of every bracket."""
    whole = np.floor(G / (2 * np.pi)).astype(int)
    brackets = [
        (a[i], a[i + 1], j)
        for i in np.flatnonzero(np.diff(whole))
        for j in range(min(whole[i], whole[i + 1]) + 1, max(whole[i], whole[i + 1]) + 1)
    ]
    low, high, turns = (np.array(column) for column in zip(*brackets, strict=True)) if brackets else np.zeros((3, 0))
    rising = _values(map_, high)[0] > 2 * np.pi * turns
    for _ in range(ROUNDS):
        middle = (low + high) / 2
        right = (_values(map_, middle)[0] > 2 * np.pi * turns) == rising
        low, high = np.where(right, low, middle), np.where(right, middle, high)
    return (low + high) / 2, turns
