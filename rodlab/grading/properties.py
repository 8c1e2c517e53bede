"""Properties that answers are tested by, rather than by stored answers.

Each function gives a `Property` of a question's calls: a sentence, a measured number, and how large it may be.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rodlab.grading.exercise import Call, Property

STEP = 1e-30  # of complex steps: no difference is taken, so none cancels


def equals(
    truth: Callable[..., Any], allowed: float = 1e-10, *, says: str = "equals what the formula gives", points: float = 1.0
) -> Property:
    """The value is that of `truth(*arguments)`, up to a relative distance."""
    return Property(says, lambda calls: _largest(call.off(truth(*call.arguments)) for call in calls), allowed, points)


def holds(says: str, off: Callable[..., float], allowed: float, points: float = 1.0) -> Property:
    """Any property of one call: `off(value, *arguments)` is how far it is from holding."""
    return Property(says, lambda calls: _largest(off(call.value, *call.arguments) for call in calls), allowed, points)


def together(says: str, off: Callable[[Sequence[Call]], float], allowed: float, points: float = 1.0) -> Property:
    """Any property of all calls together."""
    return Property(says, off, allowed, points)


def symmetric(allowed: float = 1e-12, points: float = 1.0) -> Property:
    """A matrix is its own transpose."""
    return holds("is symmetric", lambda A, *_: float(np.max(np.abs(A - A.T)) / np.max(np.abs(A))), allowed, points)


def banded(width: int = 1, points: float = 1.0) -> Property:
    """Entries further than `width` from the diagonal vanish, and those next to it do not."""

    def off(A: Any, *_: Any) -> float:
        i, j = np.indices(A.shape)
        if A.shape[0] > 1 and not np.all(np.abs(np.diag(A, 1)) > 0):
            return float("nan")
        return float(np.max(np.abs(A[np.abs(i - j) > width]), initial=0.0) / np.max(np.abs(A)))

    return holds("is tridiagonal" if width == 1 else f"has bandwidth {width}", off, 0.0, points)


def gradient_of(energy: Callable[..., Any], allowed: float = 1e-10, points: float = 1.0) -> Property:
    """The value is the gradient of an energy with respect to its first argument: against complex steps."""
    return jacobian_of(energy, allowed, says="is the energy's gradient (complex steps)", points=points)


def jacobian_of(
    field: Callable[..., Any],
    allowed: float = 1e-10,
    *,
    says: str = "is the gradient's derivative (complex steps)",
    points: float = 1.0,
) -> Property:
    """The value is the matrix of derivatives of a field with respect to its first argument: against complex steps."""

    def off(value: Any, x: Any, *rest: Any) -> float:
        true = complex_jacobian(field, x, *rest)
        return float(np.max(np.abs(value - true)) / np.max(np.abs(true)))

    return holds(says, off, allowed, points)


def observed_order(
    says: str,
    sizes: Callable[..., float],
    errors: Callable[..., float],
    expected: float,
    within: float = 0.1,
    points: float = 1.0,
) -> Property:
    """The order of errors against sizes, by the slope through the calls; `sizes` and `errors` are of (value, *arguments)."""

    def off(calls: Sequence[Call]) -> float:
        x = np.log([sizes(call.value, *call.arguments) for call in calls])
        y = np.log([errors(call.value, *call.arguments) for call in calls])
        return float(abs(np.polyfit(x, y, 1)[0] - expected))

    return Property(says, off, within, points)


def complex_step(function: Callable[..., Any], x: Any, *rest: Any) -> Any:
    """The gradient of a real function that numpy can also evaluate at complex x, to rounding.

    >>> complex_step(lambda x: x @ x, np.array([1.0, 2.0]))
    array([2., 4.])
    """
    x = np.asarray(x, dtype=np.float64)
    return np.array([np.imag(function(x + 1j * STEP * e, *rest)) / STEP for e in np.eye(x.size)])


def complex_jacobian(field: Callable[..., Any], x: Any, *rest: Any) -> Any:
    """The matrix of derivatives dF_i/dx_j, likewise.

    >>> complex_jacobian(lambda x: np.array([x[0] * x[1], x[1]]), np.array([1.0, 2.0]))
    array([[2., 1.],
           [0., 1.]])
    """
    return complex_step(field, x, *rest).T


def _largest(numbers: Any) -> float:
    found = [float(x) for x in numbers]
    return float("nan") if not found or any(np.isnan(x) for x in found) else max(found)
