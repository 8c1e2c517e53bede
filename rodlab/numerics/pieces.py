"""Where a function is smooth: the pieces between its jumps and kinks, found by splitting until a polynomial serves.

On every sixteenth of the whole the Chebyshev coefficients of 17 samples (unless another degree is asked for) must fall off to a
part `tail` of the function's size, or it is halved. A piece that had to be halved to nothing holds a jump or a kink: a break, to
be a point of every mesh. What is narrower than the distance of the samples, a hundredth of the whole, may be missed: declare it.
"""

from collections.abc import Callable
from functools import cache

import numpy as np

from rodlab.numerics.arrays import Array

DEGREE = 16
LOOKS = 16  # equal parts that are looked at
TAIL = 1e-7
NARROW = 2.0**-40  # width of a piece that holds a break
POLE = 1e8  # what grows to so many times its usual size has no bound
SMALL = 2.0**-24  # width below which what is rough is told from what is steep


def smooth_pieces(f: Callable[[Array], Array], edges: Array, tail: float = TAIL, degree: int = DEGREE) -> tuple[Array, Array]:
    """(edges of the pieces, breaks found) of a function of an array on edges[0] <= s <= edges[-1].

    >>> pieces, breaks = smooth_pieces(lambda s: np.where(s < 0.3, 1.0, 2.0 + s), np.array([0.0, 1.0]))
    >>> breaks, pieces
    (array([0.3]), array([0. , 0.3, 1. ]))
    """
    looks = np.linspace(edges[0], edges[-1], LOOKS + 1)
    breaks = np.array([])
    for _ in range(3):
        cuts = np.union1d(edges, breaks)
        rough, pieces = _split(f, np.union1d(cuts, looks), tail, degree)
        found = np.array([_last_bit(f, s) for s in _centres(rough)])
        found = found[np.abs(found[:, None] - cuts).min(axis=1) > 8 * NARROW] if found.size else found
        if not found.size:
            break
        breaks = np.union1d(breaks, found)
    halved = np.setdiff1d(pieces, np.union1d(cuts, looks))
    beside = np.diff(pieces, append=np.inf)[np.searchsorted(pieces, halved)]
    return np.union1d(cuts, halved[beside > SMALL]), breaks  # finer still is only what is left around a break


def _split(f: Callable[[Array], Array], cuts: Array, tail: float, degree: int) -> tuple[Array, Array]:
    """Middles of the narrowest rough pieces, and the edges of the smooth ones."""
    x, to_coefficients = _chebyshev(degree)
    left, right = cuts[:-1], cuts[1:]
    edges, rough = [cuts], list[Array]()
    largest = float(np.median(np.abs(f((left + right) / 2)))) or 1.0
    while left.size:
        h = right - left
        inside = np.maximum(1e-13 * h, 2 * np.spacing(np.maximum(np.abs(left), np.abs(right))))
        s = np.clip(left[:, None] + h[:, None] * x, (left + inside)[:, None], (right - inside)[:, None])
        values = f(s)
        last = np.abs(values @ to_coefficients.T)[:, -3:].max(axis=1)
        bad = last > tail * np.abs(values).max(axis=1)
        narrow = h <= NARROW
        rough.append(((left + right) / 2)[bad & narrow])
        if np.abs(values[bad & narrow]).max(initial=0.0) > POLE * largest:
            raise ValueError(f"it has a pole near s = {float(rough[-1][0]):.6g}")
        left, right = left[bad & ~narrow], right[bad & ~narrow]
        middle = (left + right) / 2
        edges.append(middle)
        left, right = np.append(left, middle), np.append(middle, right)
        if left.size > 20_000:
            raise ValueError("it is rough everywhere")
    return np.concatenate(rough), np.unique(np.concatenate(edges))


def _last_bit(f: Callable[[Array], Array], s: float) -> float:
    """The first float of the right side of a jump next to s."""
    low, high = s - 2 * NARROW, s + 2 * NARROW
    left, right = (float(value) for value in f(np.array([low, high])))
    while True:
        middle = (low + high) / 2
        if not low < middle < high:
            return high
        value = float(f(np.array([middle]))[0])
        low, high = (middle, high) if abs(value - left) < abs(value - right) else (low, middle)


def _centres(rough: Array) -> Array:
    """One place for each cluster of rough pieces."""
    if not rough.size:
        return rough
    rough = np.sort(rough)
    groups = np.split(rough, np.flatnonzero(np.diff(rough) > 8 * NARROW) + 1)
    return np.array([float(group.mean()) for group in groups])


@cache
def _chebyshev(degree: int) -> tuple[Array, Array]:
    """Points on [0, 1], ends among them, and the matrix from values there to Chebyshev coefficients."""
    angle = np.pi * np.arange(degree + 1) / degree
    return (1 - np.cos(angle)) / 2, np.linalg.inv(np.cos(np.outer(np.pi - angle, np.arange(degree + 1))))
