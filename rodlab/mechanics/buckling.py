"""Buckling loads of a straight strut or rod: where its second variation is singular [N 2.7, 2.8.1].

At phi = 0 the second variation is D^T k D - lam h W, so that the loads are squared singular values of the bidiagonal matrix
k^{1/2} D (h W)^{-1/2}: found from its entries, never from the summed tridiagonal one, each keeps its relative accuracy
whatever n and the ratio of stiffnesses. Uniform strut, K = 1:

    lam_j = 4 n^2 sin^2((2j-1) pi / (2 (2n+1)))  (end)      4 n^2 sin^2((2j-1) pi / (4n))  (trapezoid)

With terms or other ends, and in another parameter than the load (`vary`), see `rodlab.mechanics.straight`.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rodlab.mechanics.loads import rod_loads
from rodlab.mechanics.rod import Rod
from rodlab.mechanics.straight import Load, straight_loads
from rodlab.mechanics.strut import Strut
from rodlab.mechanics.varied import VariedStrut
from rodlab.mechanics.varied_rod import VariedRod
from rodlab.numerics.arrays import Array, whole
from rodlab.numerics.bidiagonal import relative_error, right_vector, singular_value

MOST = 2000  # modes of a rod


@dataclass(frozen=True, eq=False)
class Buckling:
    """Loads of the modes `numbers`, ascending, shape (m,), with bounds `error` on their absolute error.

    Of a strut the error is against the exact loads of its springs (of the discrete model, not of its limit), of a rod
    against those of its differential equation. With terms or other ends it is an estimate from above.
    """

    model: Any
    numbers: tuple[int, ...]
    loads: Array
    error: Array

    @cached_property
    def modes(self) -> Array:
        """Mode shapes (m, k) at `s`, largest entry 1 in size, first entry positive; computed when asked for, with no error."""
        model = self.model
        if is_plain(model):
            if isinstance(model, Strut):
                return np.array([mode_shape(model, float(load)) for load in self.loads])
            return np.array([found.grid.value(found.grid.nodal(found.mode[1:], 0.0), self.s) for found in self._found])
        return np.array([scaled(self._angles(found)) for found in self._found])

    @cached_property
    def s(self) -> Array:
        """Arclength of the modes' entries: a strut's joints, or a rod's nodes for the last of its modes."""
        if hasattr(self.model, "mesh"):
            return np.asarray((self._found[-1] if is_plain(self.model) else self._found[-1].model).grid.places[1:])
        return np.asarray(getattr(self.model, "strut", self.model).joints.s)

    @cached_property
    def _found(self) -> list[Any]:
        return list((rod_loads if is_plain(self.model) else straight_loads)(self.model, self.numbers))

    def _angles(self, found: Load) -> Array:
        """The angles of a mode at `s`."""
        model, w = found.model, found.mode
        angles: Array = model.angles(w) if hasattr(model, "angles") else w
        if not hasattr(model, "grid"):
            return angles
        foot = w[model.unknowns.index("phi0")] if "phi0" in getattr(model, "unknowns", ()) else 0.0
        return np.asarray(model.grid.value(model.grid.nodal(angles, foot), self.s))


def buckling(model: Any, modes: int | Sequence[int] = 3) -> Buckling:
    """The first `modes` buckling loads of a strut or rod, or those of the mode numbers given; O(n) a mode.

    A model varied in another parameter has its critical values: `buckling(vary(column, "q", lam=0.0))`. With terms the first
    may be negative; where the rod extends they are those between none and the load that would crush it, and every second one
    straightens it (a rod that shears more easily than it extends also buckles when pulled: `shear_loads`).
    Raises `ValueError` unless the model is straight and has so many modes.

    >>> b = buckling(Strut.from_joints(k=[1, 1]), 2)
    >>> b.loads, b.modes.round(3)
    (array([0.38196601, 2.61803399]), array([[ 0.618,  1.   ],
           [ 1.   , -0.618]]))
    >>> b = buckling(Rod(K="(1 + s)**2"), 1)
    >>> b.loads.round(9), bool(b.error[0] < 1e-11)
    (array([3.83637692]), True)
    """
    numbers = mode_numbers(model, modes)
    found = list(buckling_each(model, numbers))
    loads, error = (np.array(column) for column in zip(*found, strict=True))
    return Buckling(model, numbers, loads, error)


def buckling_loads(model: Any, modes: int | Sequence[int] = 3) -> Array:
    """The loads of `buckling`.

    >>> buckling_loads(Strut(n=1000), 3).round(4)
    array([ 2.4649, 22.1844, 61.6231])
    """
    return buckling(model, modes).loads


def mode_numbers(model: Any, modes: Any) -> tuple[int, ...]:
    """The mode numbers asked for, ascending, checked against the model."""
    if not isinstance(model, (Strut, Rod, VariedStrut, VariedRod)) or "lam" in getattr(model, "unknowns", ()):
        raise ValueError(f"model must be a Strut or a Rod, or one varied in a parameter at a load; it is {model!r:.60}")
    if not model.is_straight:
        raise ValueError("model must be straight to buckle: phi0, u_hat and every rest angle zero, no term that bends it")
    asked = range(1, whole("modes", modes, least=1) + 1) if np.ndim(modes) == 0 else modes
    numbers = tuple(sorted({whole("a mode number", j, least=1) for j in asked}))
    if not numbers:
        raise ValueError("modes must name at least one mode; it is empty")
    own, struts = getattr(model, "strut", model), not hasattr(model, "mesh")
    most = own.n + ("phi0" in getattr(model, "unknowns", ())) if isinstance(own, Strut) else MOST
    if numbers[-1] > most:
        limit = f"n = {most}, the number of joints" if struts else f"{most}"
        raise ValueError(f"modes must be at most {limit}; it is {numbers[-1]}")
    return numbers


def is_plain(model: Any) -> bool:
    """True for a strut or rod, clamped and free under no other load, whose loads keep their relative accuracy whatever K."""
    return isinstance(model, (Strut, Rod)) and not model.terms and not hasattr(model, "unknowns")


def buckling_each(model: Any, numbers: Sequence[int]) -> Iterator[tuple[float, float]]:
    """(load, error) of each mode number in turn, as they are found."""
    if not is_plain(model) or isinstance(model, Rod):
        found = rod_loads(model, numbers) if is_plain(model) else straight_loads(model, numbers)
        yield from ((each.load, each.error) for each in found)
        return
    with np.errstate(over="ignore"):
        a, b = bidiagonal(model)
    if not float(a.max()) < 1e153:
        raise ValueError(f"k / (h w), the size of the loads, must stay below 1e306; k reaches {model.joints.k.max():g}")
    for j in numbers:
        load = singular_value(a, b, j) ** 2
        yield load, relative_error(model.n) * load


def bidiagonal(strut: Strut) -> tuple[Array, Array]:
    """Diagonal and subdiagonal of k^{1/2} D (h W)^{-1/2}; signs do not matter to singular values."""
    hw = strut.joints.h * strut.joints.w
    k = strut.joints.k
    return np.sqrt(k / hw), -np.sqrt(k[1:] / hw[:-1])


def mode_shape(strut: Strut, load: float) -> Array:
    """The shape (n,) of a strut without terms that buckles at a load, largest entry 1, first entry positive."""
    return scaled(right_vector(*bidiagonal(strut), np.sqrt(load)) / np.sqrt(strut.joints.h * strut.joints.w))


def scaled(phi: Array) -> Array:
    """The same with its largest entry 1 in size and the first that is not zero positive."""
    first = phi[np.flatnonzero(np.abs(phi) > 1e-12 * np.abs(phi).max())[:1]]
    return np.asarray(phi / (np.sign(first) * np.abs(phi).max())) if first.size else phi
