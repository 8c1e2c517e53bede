"""What an answer must return: how it is read from plain data, and how far two values of it are apart.

kind.read(value, arguments)           the value, or `Wrong` with a sentence that says what is expected
kind.distance(value, other)           relative distance of two read values, the second the one to compare with
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import mpmath
import numpy as np

from rodlab.grading.formula import Formula, Unreadable
from rodlab.grading.plain import Written


class Wrong(Exception):
    """A value that is not of the kind that was asked for; the text completes the sentence "f returns"."""


class Kind(Protocol):
    """What a question's values are."""

    def read(self, value: Any, arguments: tuple[Any, ...]) -> Any:
        """The value as this kind has it; raises `Wrong`."""

    def distance(self, value: Any, other: Any) -> float:
        """How far they are apart, relative to the size of `other`."""


class Number:
    """One real number, or one whole number.

    >>> Number().read(2, ()), Number().distance(2.0, 4.0)
    (2.0, 0.5)
    >>> Number().read([1.0], ())
    Traceback (most recent call last):
    rodlab.grading.values.Wrong: [1.0]; one number is expected
    """

    def __init__(self, *, whole: bool = False) -> None:
        self.whole = whole
        self.says = "one whole number" if whole else "one number"

    def read(self, value: Any, arguments: tuple[Any, ...]) -> float:  # noqa: ARG002 the protocol's
        if isinstance(value, np.ndarray) and value.shape == ():
            value = value.item()
        if isinstance(value, Written):
            value = _evaluated(value)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise Wrong(f"{shown(value)}; {self.says} is expected")
        if self.whole and value != np.floor(value):
            raise Wrong(f"{shown(value)}; {self.says} is expected")
        try:
            return float(value)
        except OverflowError:
            raise Wrong(f"a number too large for double precision; {self.says} is expected") from None

    def distance(self, value: Any, other: Any) -> float:
        return relative(np.array([float(value)]), np.array([float(other)]))


class Array:
    """An array of real numbers of a shape: a tuple, or a function of the arguments; None takes any.

    >>> Array((2,)).read([1, 2], ())
    array([1., 2.])
    >>> Array(lambda phi: (phi.size, phi.size)).read(np.eye(3), (np.zeros(2),))
    Traceback (most recent call last):
    rodlab.grading.values.Wrong: an array of shape (3, 3); an array of shape (2, 2) is expected
    """

    def __init__(self, shape: tuple[int, ...] | Callable[..., tuple[int, ...]] | None = None) -> None:
        self.shape = shape

    @property
    def loose(self) -> "Array":
        """The same without a shape."""
        return Array()

    def read(self, value: Any, arguments: tuple[Any, ...]) -> Any:
        shape = self.shape(*arguments) if callable(self.shape) else self.shape
        says = "an array of real numbers is expected" if shape is None else f"an array of shape {shape} is expected"
        try:
            array = np.asarray(_numbers(value), dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            raise Wrong(f"{shown(value)}; {says}") from None
        if shape is not None and array.shape != tuple(shape):
            raise Wrong(f"an array of shape {array.shape}; {says}")
        return array

    def distance(self, value: Any, other: Any) -> float:
        value, other = np.asarray(value, dtype=np.float64), np.asarray(other, dtype=np.float64)
        return relative(value, other) if value.shape == other.shape else np.inf


class Parts:
    """A fixed number of values, each of its kind: what `return a, b` gives.

    >>> Parts(Number(), Array((2,))).read([1, [2, 3]], ())
    (1.0, array([2., 3.]))
    """

    def __init__(self, *kinds: Kind) -> None:
        self.kinds = kinds

    @property
    def loose(self) -> "Parts":
        """The same without shapes."""
        return Parts(*(getattr(kind, "loose", kind) for kind in self.kinds))

    def read(self, value: Any, arguments: tuple[Any, ...]) -> tuple[Any, ...]:
        if isinstance(value, np.ndarray):
            value = list(value)
        if not isinstance(value, list) or len(value) != len(self.kinds):
            raise Wrong(f"{shown(value)}; {len(self.kinds)} values are expected")
        return tuple(kind.read(x, arguments) for kind, x in zip(self.kinds, value, strict=True))

    def distance(self, value: Any, other: Any) -> float:
        if len(value) != len(other):
            return np.inf
        return max(kind.distance(x, y) for kind, x, y in zip(self.kinds, value, other, strict=True))


class Symbolic:
    """An expression in variables, each with the interval that it is sampled in; SymPy's, or as text.

    >>> half = Symbolic({"x": (0, 1)})
    >>> half.distance(half.read("2*sin(x)*cos(x)", ()), half.read("sin(2*x)", ())) < 1e-30
    True
    """

    def __init__(self, variables: Mapping[str, tuple[float, float]] | None = None, samples: int = 8) -> None:
        self.variables, self.samples = dict(variables or {}), samples

    def read(self, value: Any, arguments: tuple[Any, ...]) -> Formula:  # noqa: ARG002 the protocol's
        if isinstance(value, Formula):
            return value
        text = value.text if isinstance(value, Written) else value
        if isinstance(text, bool) or not isinstance(text, str | int | float):
            raise Wrong(f"{shown(value)}; an expression (SymPy's, or as text) is expected")
        try:
            return Formula(str(text), tuple(self.variables))
        except Unreadable as why:
            raise Wrong(f"no expression that can be read: {why}") from None

    def distance(self, value: Any, other: Any) -> float:
        draw, far = np.random.default_rng(7), 0.0
        value, other = self.read(value, ()), self.read(other, ())
        for _ in range(self.samples):
            point = {name: float(draw.uniform(*between)) for name, between in self.variables.items()}
            try:
                a, b = value.at(point), other.at(point)
            except Unreadable:
                return np.nan
            far = max(far, float(mpmath.fabs(a - b) / mpmath.fabs(b)) if b != 0 else float(mpmath.fabs(a)))
        return far


class Text:
    """One of several words."""

    def __init__(self, *choices: str) -> None:
        self.choices = choices

    def read(self, value: Any, arguments: tuple[Any, ...]) -> str:  # noqa: ARG002 the protocol's
        if not isinstance(value, str) or value.strip().lower() not in self.choices:
            raise Wrong(f"{shown(value)}; one of {', '.join(self.choices)} is expected")
        return value.strip().lower()

    def distance(self, value: Any, other: Any) -> float:
        return float(value != other)


class Truth:
    """True or False."""

    def read(self, value: Any, arguments: tuple[Any, ...]) -> bool:  # noqa: ARG002 the protocol's
        if not isinstance(value, bool):
            raise Wrong(f"{shown(value)}; True or False is expected")
        return value

    def distance(self, value: Any, other: Any) -> float:
        return float(value != other)


def relative(value: Any, other: Any) -> float:
    """Largest difference over the largest entry of `other`; absolute where that is zero."""
    if value.size == 0:
        return 0.0
    with np.errstate(all="ignore"):
        size, off = float(np.max(np.abs(other))), float(np.max(np.abs(value - other)))
        return off / size if size > 0 else off


def shown(value: Any, most: int = 60) -> str:
    """A value in a sentence."""
    if value is None:
        return "nothing (None): is there a return?"
    if isinstance(value, np.ndarray):
        return f"an array {'of complex numbers, ' if value.dtype.kind == 'c' else ''}of shape {value.shape}"
    text = repr(value) if not isinstance(value, dict) else "a dictionary"
    text = "".join(c if c.isprintable() else "?" for c in text)
    return text if len(text) <= most else text[: most - 3] + "..."


def _numbers(value: Any) -> Any:
    """Nested lists of numbers, expressions in them evaluated; raises TypeError for what is no number."""
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        return value
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_numbers(x) for x in value]
    if isinstance(value, Written):
        return _evaluated(value)
    if isinstance(value, int | float) and not isinstance(value, bool):
        return value
    raise TypeError


def _evaluated(value: Written) -> float:
    try:
        return float(Formula(value.text, ()).at({}))
    except (Unreadable, TypeError):
        raise Wrong(f"{shown(value)}; a number is expected") from None
