"""From a rod's properties to its joints: spring constants, rest angles and weights, by one of two rules.

    "end"        k_i = K(i h) / h                      beta_i = u_hat(i h) h           w_i = 1               order 1
    "trapezoid"  1 / k_i = integral of 1/K over link   beta_i = integral of u_hat      w_i = 1, w_n = 1/2    order 2

h = 1/n, joint i at s = i h. The first is that of the notes [N 2.8]; the second stays second order across jumps.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rodlab.mechanics.profile import Profile
from rodlab.numerics.arrays import Array, number, vector, whole

RULES = ("end", "trapezoid")


@dataclass(frozen=True)
class Joints:
    """Springs k (n,) with rest angles beta (n,) between links of length h; `weights` None where all are 1."""

    k: Array
    beta: Array
    h: float
    phi0: float = 0.0
    weights: Array | None = None
    length: float | None = None

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.k.size

    @property
    def s(self) -> Array:
        """Arclength of the joints 1..n, shape (n,); the last is the length exactly."""
        return np.arange(1.0, self.n + 1) * (self.n * self.h if self.length is None else self.length) / self.n

    @property
    def w(self) -> Array:
        """Weights (n,) of the links' angles in the height."""
        return np.ones(self.n) if self.weights is None else self.weights

    @property
    def most_weight(self) -> float:
        """The largest weight."""
        return 1.0 if self.weights is None else float(self.weights.max())

    @property
    def last_weight(self) -> float:
        """w_n; the clamp's link has the weight 1 - w_n."""
        return 1.0 if self.weights is None else float(self.weights[-1])

    @property
    def curved(self) -> bool:
        """True when some rest angle is not zero."""
        return bool(self.beta.any())


def sample(n: int, K: Profile, u_hat: Profile, rule: str, phi0: float) -> Joints:
    """The joints of a rod of length 1 by a rule."""
    if rule == "trapezoid":
        edges = np.arange(n + 1) / n
        weights = np.ones(n)
        weights[-1] = 0.5
        k = 1 / K.compliance_over(edges) if K.constant is None else np.full(n, K.constant * n)
        return Joints(k, u_hat.over(edges), 1 / n, phi0, weights, 1.0)
    s = np.arange(1, n + 1) / n
    return Joints(K.positive(K.at(s), s) * n, u_hat.at(s) / n, 1 / n, phi0, length=1.0)


def by_rule(n: Any, K: Any, u_hat: Any, rule: str, phi0: Any, breaks: Sequence[Any]) -> Joints:
    """The same from what a user gives, checked.

    >>> by_rule(2, 1.0, 0.0, "end", 0.0, ()).k
    array([2., 2.])
    """
    n = whole("n", n, least=1)
    if rule not in RULES:
        raise ValueError(f"rule must be one of {', '.join(map(repr, RULES))}; it is {rule!r}")
    at = tuple(float(b) for b in vector("breaks", np.atleast_1d(np.asarray(breaks))))
    if any(not 0 < b < 1 for b in at):
        raise ValueError(f"breaks must lie between 0 and 1; they are {breaks!r}")
    stiffness = Profile("K", K, at)
    if stiffness.constant is not None:
        number("K", K, above=0.0)
    with np.errstate(over="ignore"):
        joints = sample(n, stiffness, Profile("u_hat", u_hat, at), rule, number("phi0", phi0))
    if not (np.isfinite(joints.k).all() and joints.k.min() > 0):
        raise ValueError(f"K must give springs k_i = K n that a float can hold; the largest is {joints.k.max():g}")
    return joints


def given(k: Any, beta: Any, h: Any, beta0: Any, weights: Any) -> Joints:
    """Joints given one by one, checked."""
    k = vector("k", k).copy()
    if k.size == 0 or not k.min() > 0:
        raise ValueError(f"k must hold one positive spring constant a joint; it is {k}")
    w = None if weights is None else vector("weights", weights, k.size).copy()
    if w is not None and not w.min() > 0:
        raise ValueError(f"weights must be positive; entry {int(w.argmin())} is {w.min():g}")
    if w is not None and (w == 1).all():
        w = None
    rest = np.zeros(k.size) if beta is None else vector("beta", beta, k.size).copy()
    return Joints(k, rest, number("h", h, above=0.0), number("beta0", beta0), w)
