"""A strut's equilibria as orbits of a map [N 2.7]: the gradient, read from the free end down to the clamp.

    M_i = M_{i+1} + P_i sin(phi_i),   M_{n+1} = 0         P_i = lam h w_i + what dead weights add
    phi_{i-1} = phi_i - beta_i - (M_i + tau) / k_i

With equal joints this is the standard map of r = lam h / k. Every equilibrium is the orbit of its tip angle a = phi_n, and a
is a root of one scalar function: phi_0(a) = phi0 up to whole turns. As phi_0(a + 2 pi) = phi_0(a) + 2 pi, the angles of one turn
are all there is to search. The derivative psi_i = d(phi_i)/da counts the index: k_i psi_{i-1} / psi_i are the pivots of
the Hessian from the free end, so that its negative eigenvalues are the changes of sign in psi_n = 1, ..., psi_0 [Sturm].
"""

from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array
from rodlab.numerics.balls import Balls

SPARE = 64  # binary digits beyond those that the map may lose
MOST = 4096
CUTS = (-3.0123456789, -2.7301234567, -1.3456789012)  # where the circle of tip angles may be cut: nothing suggests these
KNOWN = ("self_weight", "end_torque")


class Floats:
    """Arithmetic of floats and arrays of them, in place of balls."""

    def number(self, x: float) -> Any:
        return x

    def sin_cos(self, x: Any) -> tuple[Any, Any]:
        return np.sin(x), np.cos(x)


class Recurrence:
    """The map of a strut at a load, in any arithmetic; angles are listed from the tip to the clamp.

    Raises `ValueError` for terms that make more than one unknown of it (a foundation, one of your own).

    >>> strut = Strut.from_joints(k=[1.0, 1.0])
    >>> phi, psi = Recurrence(strut, 3.0, Floats()).thin(0.0)
    >>> [float(x) for x in phi], [float(x) for x in psi]     # the straight strut: two changes of sign, index 2
    ([0.0, 0.0, 0.0], [1.0, -2.0, 1.0])
    """

    def __init__(self, strut: Strut, lam: float, numbers: Balls | Floats) -> None:
        for term in strut.terms:
            if term.energy is not None or term.name not in KNOWN:
                raise ValueError(f"the terms must be {' or '.join(KNOWN)} to find all equilibria; one is {term!r}")
        joints, number = strut.joints, numbers.number
        lift, n = number(lam) * number(joints.h), joints.n
        self.numbers: Any = numbers
        self.n = n
        self.P = [lift * number(w) + (number(N) if N else 0) for w, N in _from_tip(joints.w, _dead(strut))]
        self.k = [number(k) for (k,) in _from_tip(joints.k)]
        self.beta = [number(beta) if beta else 0 for (beta,) in _from_tip(joints.beta)]
        tau = float(strut.parameters.get("tau", 0.0))
        self.tau = number(tau) if tau else 0
        self.phi0 = number(joints.phi0)
        self.odd = not (tau or joints.curved or joints.phi0)

    def orbit(self, a: Any) -> Iterator[tuple[Any, Any]]:
        """phi_i and psi_i one after the other, i = n .. 0, at a number a or at an array of them."""
        phi, psi, M, dM = a, a * 0 + 1, self.tau, 0
        yield phi, psi
        for P, k, beta in zip(self.P, self.k, self.beta, strict=True):
            s, c = self.numbers.sin_cos(phi)
            M, dM = M + P * s, dM + P * (c * psi)
            phi, psi = phi - beta - M / k, psi - dM / k
            yield phi, psi

    def end(self, a: Any) -> tuple[Any, Any]:
        """phi_0 and psi_0, the rest forgotten."""
        return deque(self.orbit(a), maxlen=1)[0]

    def thin(self, a: Any) -> tuple[Sequence[Any], Sequence[Any]]:
        """All phi and all psi."""
        angles, slopes = zip(*self.orbit(a), strict=True)
        return angles, slopes

    def wide(self, box: Any, a: Any, angles: Sequence[Any], slopes: Sequence[Any]) -> tuple[list[Any], list[Any]]:
        """Enclosures of phi and psi over a box, by way of the second derivative and the values at its number a.

        Each is the narrower of two: by the map itself, and by the mean value theorem from a.
        """
        radius, off = self.numbers.radius, box - a
        phi, psi, chi = box, a * 0 + 1, a * 0
        M, dM, ddM = self.tau, a * 0, a * 0
        all_phi, all_psi = [phi], [psi]
        for P, k, beta, phi_a, psi_a in zip(self.P, self.k, self.beta, angles[1:], slopes[1:], strict=True):
            s, c = self.numbers.sin_cos(phi)
            M, dM, ddM = M + P * s, dM + P * (c * psi), ddM + P * (c * chi - s * psi * psi)
            phi, psi, chi = phi - beta - M / k, psi - dM / k, chi - ddM / k
            other = psi_a + chi * off
            if radius(other) < radius(psi):
                psi = other
            other = phi_a + psi * off
            if radius(other) < radius(phi):
                phi = other
            all_phi.append(phi)
            all_psi.append(psi)
        return all_phi, all_psi


def bits(strut: Strut, lam: float) -> float:
    """How many binary digits a small change of the tip angle may gain on the way to the clamp; infinite beyond floats.

    >>> round(bits(Strut(n=8), 256.0)), round(bits(Strut(n=100), 130.0))
    (20, 16)
    """
    own = Recurrence(strut, lam, Floats())
    with np.errstate(all="ignore"):
        half = np.sqrt(np.abs(np.array(own.P)) / np.array(own.k)) / 2
        gained = 2 * float(np.log2(half + np.hypot(1.0, half)).sum())
    return gained if np.isfinite(gained) else np.inf


def precision(strut: Strut, lam: float) -> int:
    """Binary digits in which a proof computes: for the growth of psi, and for angles of any size.

    Raises `ArithmeticError` where more would be needed than is sensible.
    """
    own = Recurrence(strut, lam, Floats())
    with np.errstate(all="ignore"):
        moments = abs(float(strut.parameters.get("tau", 0.0))) + np.abs(own.P).sum()
        turned = abs(strut.joints.phi0) + np.abs(strut.joints.beta).sum() + moments * (1 / strut.joints.k).sum()
        needed = SPARE + 2 * bits(strut, lam) + np.log2(strut.n * (1 + turned))
    if not needed <= MOST:
        raise ArithmeticError(f"the equilibria at lam = {lam:g} cannot be told apart in {MOST} binary digits, of {strut!r:.80}")
    return int(needed)


def index_of(signs: Sequence[int]) -> int | None:
    """Changes of sign in psi_n, ..., psi_0; None where they are unknown. A zero between opposite signs counts as one change.

    >>> index_of([1, -1, 0, 1]), index_of([1, 0, 1])
    (2, None)
    """
    changes, i = 0, 1
    while i < len(signs):
        if signs[i] == 0:
            if i + 1 == len(signs) or signs[i - 1] * signs[i + 1] >= 0:
                return None
            i += 1
            changes += 1
        else:
            changes += signs[i] != signs[i - 1]
        i += 1
    return changes


def _dead(strut: Strut) -> Array:
    """Weight that each link carries."""
    if "q" not in strut.parameters:
        return np.zeros(strut.n)
    return strut.places.carried(strut.parameters["q"] * strut.joints.h * strut.joints.w)


def _from_tip(*arrays: Array) -> Iterator[tuple[float, ...]]:
    for values in zip(*(array[::-1] for array in arrays), strict=True):
        yield tuple(float(x) for x in values)
