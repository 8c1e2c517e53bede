"""What an imperfection does to a pitchfork: the reduced equation with a parameter beta [Koiter 1945; Peterson and Manning 2009].

    rate (lam - lam_0) A - rate c_2 A^3 + strength beta = 0       A = <v, u - u_0>,  v = null vector of norm 1, psi the left one
    strength = psi.F_beta,   rate = d(psi.F_u v)/dlam along the followed branch,   c_2 of Koiter's expansion

    at lam_0      A = (strength beta / (rate c_2))^(1/3)
    fold          lam - lam_0 = 3 c_2 (strength beta / (2 rate c_2))^(2/3)       the cusp in the plane of lam and beta

An imperfection of strength zero is *ineffective*: the branch point stays to first order.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rodlab.analysis.curve import Curve
from rodlab.analysis.events import Event
from rodlab.analysis.expansion import expansion
from rodlab.analysis.vary import Family
from rodlab.numerics.arrays import EPS
from rodlab.numerics.nullspace import near_null

STEP = 1e-4  # of loads, for the rate


@dataclass(frozen=True)
class Imperfection:
    """The numbers of the reduced equation at a branch point, and the error of `strength`, which decides `ineffective`."""

    name: str
    lam: float
    strength: float
    error: float
    rate: float
    c2: float

    def __repr__(self) -> str:
        said = "ineffective" if self.ineffective else f"strength {self.strength:.6g}"
        return f"Imperfection({self.name!r} at lam = {self.lam:.9g}: {said})"

    @property
    def ineffective(self) -> bool:
        """True where the strength cannot be told from zero."""
        return abs(self.strength) <= self.error

    def fold(self, beta: float) -> float:
        """The load of the fold, to lowest order in beta: the cusp's two-thirds law."""
        return self.lam + 3 * self.c2 * float(np.cbrt((self.strength * beta / (2 * self.rate * self.c2)) ** 2))

    def amplitude(self, beta: float) -> float:
        """A at the load of the branch point, to lowest order in beta: its cube root."""
        return float(np.cbrt(self.strength * beta / (self.rate * self.c2)))


def imperfection(event: Event, name: str, model: Any = None) -> Imperfection:
    """How the parameter `name` breaks a pitchfork: its strength there, and the cusp that it unfolds to.

    model: whose parameter it is, perfect at the value zero; that of the event unless given, so that a profile of your own can be
    tried on a branch point of the straight strut: `imperfection(e, "u_hat", strut.replace(u_hat=lambda s: ...))`.
    Raises `ValueError` for a name that the model does not have, or a branch point of several null vectors.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.analysis.follow import follow
    >>> from rodlab.mechanics.strut import Strut
    >>> straight = Strut.from_joints(k=[1, 1])
    >>> e = follow(equilibrium(straight, 0.0), to=1.0).events[0]
    >>> golden = (1 + 5**0.5) / 2
    >>> imperfection(e, "beta", Strut.from_joints(k=[1, 1], beta=[1 - golden, 1]))
    Imperfection('beta' at lam = 0.381966011: ineffective)
    """
    if not isinstance(event, Event) or event.kind != "branch point" or event.multiplicity != 1 or event.null is None:
        raise ValueError(f"event must be a branch point of one null vector; it is {event!r:.80}")
    own = event.point.equations
    if hasattr(model, "on_points"):
        model = model.on_points(getattr(own, "mesh", ()))
    family = Family(own if model is None else model, name)
    curve = Curve(own)
    y = np.append(event.point.u, event.lam)
    null = near_null(curve.jacobian(y), 1, symmetric=curve.symmetric(y), start=event.null)
    v = null.right[:, 0] / float(own.inner(null.right[:, 0], null.right[:, 0])) ** 0.5
    psi = null.left[:, 0]
    push = family.d_value(event.point.u, event.lam, 0.0)
    t = event.point.tangent if event.point.tangent is not None else np.append(np.zeros_like(v), 1.0)
    step = STEP * (abs(event.lam) or 1.0) * t / t[-1]
    change = (curve.jacobian(y + step) @ v - curve.jacobian(y - step) @ v) / (2 * step[-1])
    size = float(np.abs(psi) @ np.abs(push))
    return Imperfection(
        name,
        event.lam,
        float(psi @ push),
        1e3 * EPS * size + 1e-12 * size,
        float(psi @ change),
        float(expansion(event, 2).load[2]),
    )
