"""How much a symmetric matrix may change: -S <= A' - A <= S in the sense of quadratic forms.

S is a diagonal, a number or an array, or what a change at Gauss's points makes of it, E^T diag(values) E + level, which a
diagonal could only bound from far above.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.numerics.arrays import Array

if TYPE_CHECKING:
    from rodlab.numerics.collocation import Grid


@dataclass(frozen=True, eq=False)
class Slack:
    """E^T diag(values) E + level, the values (N, m) at Gauss's points of a grid, not negative."""

    grid: "Grid"
    values: Array
    level: float = 0.0

    def __mul__(self, factor: float) -> "Slack":
        return replace(self, values=factor * self.values, level=factor * self.level)

    __rmul__ = __mul__

    def __add__(self, level: float) -> "Slack":
        return replace(self, level=self.level + level)

    @property
    def largest(self) -> float:
        """A bound on its norm."""
        return float((self.values * self.grid.reach).max()) + self.level

    def form(self, x: Array) -> float:
        """x . S x."""
        seen = self.grid.seen(x)
        return float(np.sum(self.values * seen * seen)) + self.level * float(x @ x)


def largest(slack: Any) -> float:
    """A bound on the norm of a slack.

    >>> largest(np.array([1.0, 2.0])), largest(0.5)
    (2.0, 0.5)
    """
    return slack.largest if isinstance(slack, Slack) else float(np.max(slack))


def form(slack: Any, x: Array) -> float:
    """x . S x.

    >>> form(np.array([1.0, 2.0]), np.array([1.0, 1.0]))
    3.0
    """
    return slack.form(x) if isinstance(slack, Slack) else float(np.sum(slack * x * x))
