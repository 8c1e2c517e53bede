"""Truths of rods: closed forms, and one root of one function of one unknown.

    loads    K piecewise constant: w = R cos(psi), K w' = -R sqrt(K lam) sin(psi) at s = 1 - x. psi is 0 at the free end, grows by
             sqrt(lam/K) a unit of length, keeps sqrt(K) tan(psi) across a jump, and is (j - 1/2) pi at the clamp for load j
    layer    lam < 0, bent at the free end alone: K phi'^2 / 2 + lam cos(phi) = const, and phi = phi' = 0 far below, so that
             phi' = 2 sqrt(|lam|/K) sin(phi/2);   phi'(1) = u_hat gives   tip = 2 asin(u_hat sqrt(K/|lam|) / 2)
             a clamp at finite distance adds less than 16 exp(-2 sqrt(|lam|/K)) of that

psi (Prufer's angle) rises with lam, so that bisection finds the load of this number and no other [N 2.8.1].
"""

from collections.abc import Sequence
from typing import Any

import mpmath as mp

LEAST_RATE = 7.0  # of the decay of a layer: exp(-14) of it reaches the clamp and comes back


def rod_load(K: Sequence[float], edges: Sequence[float], j: int, digits: int = 60) -> Any:
    """Load j of the straight rod with stiffness K[i] between edges[i] and edges[i+1], from 0 to 1; mpf.

    >>> mp.nstr(rod_load([1.0], [0, 1], 1), 12)                # (pi/2)^2
    '2.46740110027'
    """
    with mp.workdps(digits):
        aim = (j - mp.mpf(1) / 2) * mp.pi
        low, high = (aim**2 * mp.mpf(bound) for bound in (min(K), max(K)))  # of uniform rods, softer and stiffer
        if low == high:
            return low
        low, high = mp.log(low) - 1, mp.log(high) + 1
        while high - low > mp.mpf(10) ** -28:
            middle = (low + high) / 2
            low, high = (low, middle) if prufer_angle(K, edges, mp.exp(middle)) > aim else (middle, high)
        return mp.exp((low + high) / 2)


def prufer_angle(K: Sequence[float], edges: Sequence[float], lam: Any) -> Any:
    """psi at the clamp."""
    psi, last = mp.mpf(0), mp.mpf(K[-1])
    for own, below, above in reversed(list(zip(K, edges, edges[1:], strict=False))):
        stiffness = mp.mpf(own)
        turns = mp.pi * mp.nint(psi / mp.pi)
        psi = turns + mp.atan(mp.tan(psi - turns) * mp.sqrt(last / stiffness))
        psi += mp.sqrt(lam / stiffness) * (mp.mpf(above) - mp.mpf(below))
        last = stiffness
    return psi


def layer_tip(u_hat: float, lam: float, K: float = 1.0, digits: int = 40) -> tuple[Any, float]:
    """(tip angle, how far the clamp may move it) of the rod that a load lam < 0 holds straight but for a layer at its end."""
    with mp.workdps(digits):
        rate = mp.sqrt(-mp.mpf(lam) / mp.mpf(K))
        if rate < LEAST_RATE:
            most = -(LEAST_RATE**2) * K
            raise ValueError(f"lam must be at most {most:g} for a layer that does not reach the clamp; it is {lam!r}")
        half = mp.mpf(u_hat) / (2 * rate)
        if abs(half) > 1:
            raise ValueError(
                f"u_hat must be at most 2 sqrt(|lam|/K) = {float(2 * rate):g} for a layer at the end; it is {u_hat!r}"
            )
        tip = 2 * mp.asin(half)
        return tip, float(16 * mp.exp(-2 * rate) * abs(tip))
