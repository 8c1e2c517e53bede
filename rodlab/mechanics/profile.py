"""A property along the rod: a number, one number a joint, a function of s, or an expression in s.

A strut asks it in one of two ways [rule of DESIGN 1.1]: its value at the joints, or its integral over each link, which stays
accurate where the property jumps.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from rodlab.mechanics.expression import Expression
from rodlab.numerics.arrays import Array, is_finite, number, vector
from rodlab.numerics.quadrature import integrals


class Profile:
    """The property `name`, as given by the user, on 0 <= s <= length.

    >>> K = Profile("K", "1 + s")
    >>> K.at(np.array([0.0, 1.0]))
    array([1., 2.])
    >>> Profile("K", [1.0, 3.0]).over(np.array([0.0, 0.5, 1.0]))    # one value a link
    array([0.5, 1.5])
    """

    def __init__(self, name: str, given: Any, breaks: tuple[float, ...] = ()) -> None:
        self.name, self.given = name, given
        self.constant: float | None = None
        self.values: Array | None = None
        self.function: Callable[[Array], Any] | None = None
        if isinstance(given, str):
            try:
                self.function = Expression(given)
            except ValueError as error:
                raise ValueError(f"{name}: {error}") from None
            breaks += self.function.breaks
        elif callable(given):
            self.function = given
        elif np.ndim(given) == 0:
            self.constant = number(name, given)
        else:
            self.values = vector(name, given).copy()
        self.breaks = breaks

    def at(self, s: Array) -> Array:
        """Values at s, shape of s."""
        if self.constant is not None:
            return np.full(s.shape, self.constant)
        if self.values is not None:
            return vector(self.name, self.values, s.size)
        return self._evaluate(s)

    def over(self, edges: Array) -> Array:
        """Integral over each link [edges[i], edges[i+1]]."""
        if self.function is None:
            return self.at(edges[1:]) * np.diff(edges)
        return self._integrals(self._evaluate, edges)

    def compliance_over(self, edges: Array) -> Array:
        """Integral of 1 / value over each link; the value must be positive."""
        if self.function is None:
            return np.asarray(np.diff(edges) / self.positive(self.at(edges[1:]), edges[1:]))
        return self._integrals(lambda s: 1.0 / self.positive(self._evaluate(s), s), edges)

    def positive(self, values: Array, s: Array) -> Array:
        """The values, or one sentence about the first that is not positive."""
        if not values.min() > 0:
            i = int(values.argmin())
            raise ValueError(f"{self.name} must be positive; it is {values.flat[i]:g} at s = {s.flat[i]:g}")
        return values

    def _evaluate(self, s: Array) -> Array:
        assert self.function is not None
        try:
            values = np.asarray(self.function(s.copy()))
            if values.dtype.kind == "c":
                raise TypeError("it returned complex numbers")
            values = np.asarray(values, dtype=np.float64)
        except (TypeError, ValueError, ArithmeticError, AttributeError) as error:
            raise ValueError(f"{self.name} must be a function of an array s; it failed with: {error}") from error
        if values.ndim == 0:
            values = np.full(s.shape, float(values))
        if values.shape != s.shape:
            raise ValueError(f"{self.name} must return the shape of s, {s.shape}; it returned {values.shape}")
        if not is_finite(values):
            bad = float(s.flat[int(np.flatnonzero(~np.isfinite(values))[0])])
            raise ValueError(f"{self.name} must be finite; it is not at s = {bad:g}")
        return values

    def _integrals(self, f: Callable[[Array], Array], edges: Array) -> Array:
        inside = [b for b in self.breaks if edges[0] < b < edges[-1]]
        cuts = np.union1d(edges, inside)
        home = np.searchsorted(edges, cuts[:-1], side="right") - 1
        try:
            return np.asarray(np.bincount(home, integrals(f, cuts), edges.size - 1), dtype=np.float64)
        except ValueError as error:
            if self.name in str(error):
                raise
            raise ValueError(f"{self.name} must be smooth between its breaks and computed in double precision: {error}") from None
