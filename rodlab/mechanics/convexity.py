"""A certificate of uniqueness by convexity [N 2.6]: while V is strictly convex it has one critical point.

    V''(phi) = D^T k D - lam h W diag(cos phi) >= D^T k D - |lam| h W    for every phi,

so that one inertia, of the matrix on the right, proves that an equilibrium is the only one whatever the rest angles.
For 0 <= lam it holds up to the first buckling load of the straight strut.
"""

from dataclasses import dataclass

import numpy as np

from rodlab.mechanics.ends import refuse_held
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import EPS, number
from rodlab.numerics.difference import DifferenceForm

LINEAR = ("end_torque",)
HANGING = ("self_weight",)


@dataclass(frozen=True)
class Uniqueness:
    """Whether the equilibrium is proved to be the only one, and why or why not."""

    certified: bool
    reason: str

    def __bool__(self) -> bool:
        return self.certified


def uniqueness(strut: Strut, lam: float) -> Uniqueness:
    """Is the equilibrium at this load certainly the only one? O(n). "Not certified" does not mean that there are more.

    >>> bool(uniqueness(Strut(n=10, u_hat=3.0), 2.0)), bool(uniqueness(Strut(n=10, u_hat=3.0), 3.0))
    (True, False)
    """
    if not isinstance(strut, Strut):
        raise ValueError(f"strut must be a Strut; it is {strut!r:.60}")
    refuse_held("strut", strut)
    lam = number("lam", lam)
    softest = abs(lam) * strut.joints.h * strut.joints.w
    for term in strut.terms:
        if term.name == "end_force":
            softest = softest + abs(strut.parameters["N1"]) * strut.joints.h * strut.joints.w
        elif term.name in HANGING and term.energy is None:
            q = np.abs(strut.parameters["q"]) * strut.joints.h * strut.joints.w
            softest = softest + strut.places.carried(q)
        elif not (term.name in LINEAR and term.energy is None):
            return Uniqueness(False, f"no bound is known for the term {term.name}")
    known = DifferenceForm(strut.springs, softest).inertia((8 * EPS) * softest)
    if known.negative + known.unclear == 0:
        return Uniqueness(True, f"V is strictly convex: V'' is positive definite at every phi for |load| <= {abs(lam):g}")
    return Uniqueness(False, f"V need not be convex at load {lam:g}: the straight strut has buckled by {abs(lam):g}")
