"""A branch as curves to draw: cut where it is singular, one piece for each index, smooth between its points."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rodlab.analysis.follow import Branch
from rodlab.numerics.arrays import Array

FINE = 12  # parts of a step that are drawn


@dataclass(frozen=True, eq=False)
class Piece:
    """Loads and values of a measure along a part of a branch on which the index does not change; None where it is unknown."""

    lam: Array
    value: Array
    index: int | None

    @property
    def stable(self) -> bool:
        """True for index 0."""
        return self.index == 0


def pieces(branch: Branch, measure: str) -> list[Piece]:
    """The pieces of a branch, in order."""
    last = len(branch.points) - 1
    cuts = sorted({0.0, float(last), *(e.where for e in branch.events if e.kind in ("fold", "branch point"))})
    found: list[Piece] = []
    for start, stop in pairwise(cuts):
        if stop - start < 1e-9:
            continue
        middle = branch.along((start + stop) / 2)
        index = middle.index if middle.index_verified else None
        lam, value = (np.array(column) for column in zip(*_samples(branch, measure, start, stop), strict=True))
        if found and found[-1].index == index:
            before = found.pop()
            lam, value = np.append(before.lam, lam[1:]), np.append(before.value, value[1:])
        found.append(Piece(lam, value, index))
    return found


def _samples(branch: Branch, measure: str, start: float, stop: float) -> Iterator[tuple[float, float]]:
    inner = np.arange(np.floor(start * FINE) + 1, np.ceil(stop * FINE)) / FINE
    for where in [start, *inner, stop]:
        p = branch.along(float(where))
        yield p.lam, p.measure(measure)
