"""A pitchfork and its imperfection: the cusp of folds, its two-thirds law, and rounding as an imperfection of its own.

    fold of the branch that is cut off       lam - lam_1 ~ beta^(2/3)
    tip angle at the load of the pitchfork    phi_n ~ beta^(1/3)

The cube root is why symmetry breaks numerically: an imperfection of the size of rounding, 1e-16, bends a strut at lam_1 by 1e-5
radians, and which side it buckles to beyond is decided by the last bit.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.events import Event
from rodlab.analysis.follow import Branch, follow
from rodlab.analysis.imperfection import Imperfection, imperfection
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.unfolding import folds
from rodlab.analysis.vary import vary
from rodlab.lab.branches import detached, mode_point
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array

OFF = tuple(10.0**-k for k in range(1, 8))  # loads of folds above lam_1
SMALL = tuple(10.0**-k for k in range(1, 17))  # imperfections down to rounding


@dataclass(frozen=True, eq=False)
class Breaking:
    """The pitchfork `event` and what the imperfection `name` does to it.

    curve: folds in the plane of load and imperfection, through the cusp. off, beta: loads of folds above lam_1, and their
    imperfections; exponent: slopes between them, of log off against log beta. tips: tip angles at lam_1, one for each of `small`.
    """

    event: Event
    imperfection: Imperfection
    curve: Branch
    off: Array
    beta: Array
    small: Array
    tips: Array

    @property
    def exponent(self) -> Array:
        """2/3 in the limit."""
        return np.asarray(np.diff(np.log(self.off)) / np.diff(np.log(self.beta)))

    @property
    def root(self) -> Array:
        """Slopes of log tips against log small: 1/3 in the limit, down to rounding."""
        return np.asarray(np.diff(np.log(self.tips)) / np.diff(np.log(self.small)))


def breaking(strut: Strut, name: str = "u_hat", most: float = 0.1, off: Sequence[float] = OFF) -> Breaking:
    """The first pitchfork of a straight strut broken by a parameter of it, from the value `most` down to rounding.

    >>> b = breaking(Strut(n=10), off=(1e-3, 1e-4))
    >>> b.exponent.round(3), b.root[4:8].round(3)
    (array([0.667]), array([0.333, 0.333, 0.333, 0.333]))
    """
    vary(strut, name, 0.0)  # a name that the strut does not have is said at once
    event = mode_point(strut, 1)
    law = imperfection(event, name)
    bent = strut.replace(**{name: most})
    cut = follow(detached(bent, 4 * event.lam), to=0.0)
    fold = next((e for e in cut.events if e.kind == "fold"), None)
    if fold is None:
        raise NoConvergence(f"the branch that {name} = {most:g} cuts off has no fold: {cut.reason}", ())
    curve = follow(folds(fold, name), to=0.0)
    inside = np.array([x for x in off if event.lam + x < fold.lam])
    beta = np.array([max(abs(p.measure(name)) for p in curve.at(event.lam + x)) for x in inside])
    small = np.array([x for x in SMALL if x <= most])
    tips = np.array([abs(_tip(strut, name, x, law, event)) for x in small])
    return Breaking(event, law, curve, inside, beta, small, tips)


def _tip(strut: Strut, name: str, beta: float, law: Imperfection, event: Event) -> float:
    """The tip angle at the load of the pitchfork."""
    assert event.null is not None
    v = event.null[:, 0] / strut.inner(event.null[:, 0], event.null[:, 0]) ** 0.5
    return equilibrium(strut.replace(**{name: beta}), event.lam, abs(law.amplitude(beta)) * v).tip_angle
