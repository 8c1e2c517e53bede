"""The signs of the eigenvalues of a symmetric matrix, as far as rounding lets them be known."""

from abc import ABC, abstractmethod
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rodlab.numerics.arrays import EPS, Array


class Inertia(NamedTuple):
    """How many eigenvalues are certainly negative, of unknown sign, and certainly positive.

    `unclear` counts the eigenvalues that rounding cannot tell from zero. By Loewner's order and
    Weyl's monotonicity, A - E <= A_exact <= A + E gives
    index(A + E) <= index(A_exact) <= index(A - E): `negative` and `negative + unclear`.

    >>> Inertia(1, 0, 4).verified
    True
    """

    negative: int
    unclear: int
    positive: int

    @property
    def verified(self) -> bool:
        """True when every sign is certain."""
        return self.unclear == 0


class Symmetric(ABC):
    """A symmetric matrix that solves and knows the signs of its eigenvalues."""

    @abstractmethod
    def solve(self, b: Array) -> Array:
        """x with A x = b."""

    def solve_fully(self, b: Array) -> Array:
        """x with A x = b, to all the accuracy that the matrix's own data allow."""
        return self.solve(b)

    @abstractmethod
    def inertia(self, slack: Array | float = 0.0) -> Inertia:
        """Signs of the eigenvalues of every symmetric matrix within diag(slack), and rounding, of this one."""

    @cached_property
    def _inertia(self) -> Inertia:
        return self.inertia()

    @property
    def index(self) -> int:
        """Number of certainly negative eigenvalues (the Morse index where `index_verified`)."""
        return self._inertia.negative

    @property
    def nullity(self) -> int:
        """Number of eigenvalues that rounding cannot tell from zero."""
        return self._inertia.unclear

    @property
    def index_verified(self) -> bool:
        """True when no eigenvalue is too near zero to know its sign."""
        return self._inertia.verified


def sign_of_pivots(pivots: Array, exchanges: int) -> int:
    """Sign of a product, zero where its least factor is lost in the rounding of the largest.

    >>> sign_of_pivots(np.array([2.0, -1.0]), exchanges=1)
    1
    """
    size = np.abs(pivots)
    if size.min(initial=1.0) <= pivots.size * EPS * size.max(initial=0.0):
        return 0
    return -1 if (np.count_nonzero(pivots < 0) + exchanges) % 2 else 1
