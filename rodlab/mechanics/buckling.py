"""Buckling loads of a straight strut or rod: where its second variation is singular [N 2.7, 2.8.1].

At phi = 0 the second variation is D^T k D - lam h W, so that the loads are squared singular values of the bidiagonal matrix
k^{1/2} D (h W)^{-1/2}: found from its entries, never from the summed tridiagonal one, each keeps its relative accuracy
whatever n and the ratio of stiffnesses. Uniform strut, K = 1:

    lam_j = 4 n^2 sin^2((2j-1) pi / (2 (2n+1)))  (end)      4 n^2 sin^2((2j-1) pi / (4n))  (trapezoid)

With terms the second variation is D^T k D - C - lam h W, and the loads are bracketed by its inertia, in the mixed form.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rodlab.mechanics.loads import rod_loads
from rodlab.mechanics.rod import Rod
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import EPS, Array, whole
from rodlab.numerics.bidiagonal import relative_error, right_vector, singular_value
from rodlab.numerics.difference import DifferenceForm
from rodlab.numerics.full import Full

MOST = 2000  # modes of a rod


@dataclass(frozen=True, eq=False)
class Buckling:
    """Loads of the modes `numbers`, ascending, shape (m,), with bounds `error` on their absolute error.

    Of a strut the error is against the exact loads of its springs (of the discrete model, not of its limit), of a rod
    against those of its differential equation.
    """

    model: "Strut | Rod"
    numbers: tuple[int, ...]
    loads: Array
    error: Array

    @cached_property
    def modes(self) -> Array:
        """Mode shapes (m, k) at `s`, largest entry 1 in size, first entry positive; computed when asked for, with no error."""
        model = self.model
        if isinstance(model, Strut):
            return np.array([mode_shape(model, float(load)) for load in self.loads])
        return np.array([found.grid.value(found.grid.nodal(found.mode[1:], 0.0), self.s) for found in self._found])

    @cached_property
    def s(self) -> Array:
        """Arclength of the modes' entries: a strut's joints, or a rod's nodes for the last of its modes."""
        return self.model.joints.s if isinstance(self.model, Strut) else self._found[-1].grid.places[1:]

    @cached_property
    def _found(self) -> list[Any]:
        return list(rod_loads(self.model, self.numbers)) if isinstance(self.model, Rod) else []


def buckling(model: "Strut | Rod", modes: int | Sequence[int] = 3) -> Buckling:
    """The first `modes` buckling loads of a strut or rod, or those of the mode numbers given; O(n) a mode.

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


def buckling_loads(model: "Strut | Rod", modes: int | Sequence[int] = 3) -> Array:
    """The loads of `buckling`.

    >>> buckling_loads(Strut(n=1000), 3).round(4)
    array([ 2.4649, 22.1844, 61.6231])
    """
    return buckling(model, modes).loads


def mode_numbers(model: Any, modes: Any) -> tuple[int, ...]:
    """The mode numbers asked for, ascending, checked against the model."""
    if not isinstance(model, (Strut, Rod)):
        raise ValueError(f"model must be a Strut or a Rod; it is {model!r:.60}")
    if not model.is_straight:
        raise ValueError("model must be straight to buckle: phi0, u_hat and every rest angle zero, no term that bends it")
    if isinstance(model, Rod) and model.terms:
        raise ValueError(f"model must have no terms, if it is a rod, for its loads; it has {model.terms!r:.60}")
    asked = range(1, whole("modes", modes, least=1) + 1) if np.ndim(modes) == 0 else modes
    numbers = tuple(sorted({whole("a mode number", j, least=1) for j in asked}))
    if not numbers:
        raise ValueError("modes must name at least one mode; it is empty")
    most = model.n if isinstance(model, Strut) else MOST
    if numbers[-1] > most:
        limit = f"n = {most}, the number of joints" if isinstance(model, Strut) else f"{most}"
        raise ValueError(f"modes must be at most {limit}; it is {numbers[-1]}")
    return numbers


def buckling_each(model: "Strut | Rod", numbers: Sequence[int]) -> Iterator[tuple[float, float]]:
    """(load, error) of each mode number in turn, as they are found."""
    if isinstance(model, Rod):
        yield from ((found.load, found.error) for found in rod_loads(model, numbers))
        return
    if model.terms:
        yield from _loads_with_terms(model, numbers)
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
    """The shape (n,) that buckles at a load, largest entry 1, first entry positive."""
    hw = strut.joints.h * strut.joints.w
    if strut.terms:
        factor = strut.hessian(np.zeros(strut.n), load).factor()
        phi = np.sin(np.arange(1.0, strut.n + 1))
        for _ in range(4):
            phi = factor.solve(hw * phi)
            phi /= np.abs(phi).max()
    else:
        phi = right_vector(*bidiagonal(strut), np.sqrt(load)) / np.sqrt(hw)
    first = phi[np.flatnonzero(phi)[0]]
    return np.asarray(phi / (np.sign(first) * np.abs(phi).max()))


def _loads_with_terms(strut: Strut, numbers: Sequence[int]) -> Iterator[tuple[float, float]]:
    """Loads bracketed by the index of the second variation at phi = 0, which rises by one at each."""
    hw = strut.joints.h * strut.joints.w
    unloaded, loaded = strut.hessian(np.zeros(strut.n), 0.0), strut.hessian(np.zeros(strut.n), 1.0)
    if isinstance(unloaded, DifferenceForm) and isinstance(loaded, DifferenceForm):
        change, size = loaded.c - unloaded.c, np.abs(unloaded.c) + hw
    else:
        change, size = unloaded.diagonal - loaded.diagonal, np.abs(unloaded.diagonal) + hw
    if np.abs(change - hw).max() > 1e-9 * size.max():
        raise ValueError("a term of the strut takes part in the load; its buckling loads are not those of a load on the tip")
    if isinstance(unloaded, Full):
        scale = 1 / np.sqrt(hw)
        w = np.linalg.eigvalsh(scale[:, None] * unloaded.toarray() * scale)
        bound = 4 * strut.n * EPS * float(np.abs(w).max())
        yield from ((float(w[j - 1]), bound) for j in numbers)
        return
    if not isinstance(unloaded, DifferenceForm):
        raise ValueError("the terms of the strut turn its springs negative; it has no buckling loads to bracket")
    reach = float((np.abs(unloaded.diagonal).max() + 2 * strut.springs.k.max()) / hw.min())

    def below(load: float) -> tuple[int, int]:
        """Loads certainly below this one, and those that may be."""
        known = DifferenceForm(strut.springs, unloaded.c + load * hw, unloaded.spread).inertia()
        return known.negative, known.negative + known.unclear

    for j in numbers:
        yield _bracketed(below, j, reach, relative_error(strut.n))


def _bracketed(below: Callable[[float], tuple[int, int]], j: int, reach: float, precision: float) -> tuple[float, float]:
    """Load j and a bound on its error: certainly not below `low`, certainly below `high`, by bisection from both sides."""
    low, high = -reach, reach
    while high - low > precision * max(abs(low), abs(high)) / 8:
        middle = (low + high) / 2
        if not low < middle < high:
            break
        sure, maybe = below(middle)
        if maybe < j:
            low = middle
        elif sure >= j:
            high = middle
        else:  # neither: the load is too near to tell; the two ends are now searched apart
            low = _last(lambda load: below(load)[1] < j, low, middle, precision)
            high = -_last(lambda load: below(-load)[0] >= j, -high, -middle, precision)
            break
    load = (low + high) / 2
    return load, (high - low) / 2 + precision * abs(load)


def _last(holds: Callable[[float], bool], low: float, high: float, precision: float) -> float:
    """A number at which `holds`, true at `low` and false at `high`, next to where it ceases to."""
    while high - low > precision * max(abs(low), abs(high)) / 8:
        middle = low + (high - low) / 2
        if not low < middle < high:
            break
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
