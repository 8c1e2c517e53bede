"""Arrays of numbers, and the sentences said when they are not what was asked for."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
EPS = float(np.finfo(np.float64).eps)
TINY = float(np.finfo(np.float64).tiny)
LEAST = float(np.finfo(np.float64).smallest_subnormal)


def is_finite(values: Array) -> bool:
    """True when no entry is NaN or infinite; one pass over the usual, finite array.

    >>> is_finite(np.array([1.0, 2.0])), is_finite(np.array([1.0, np.nan]))
    (True, False)
    """
    if values.dtype.kind != "f" or not values.size:
        return bool(np.isfinite(values).all())
    return math.isfinite(values.max()) and math.isfinite(values.min())  # a NaN is both


def number(name: str, value: Any, *, above: float | None = None) -> float:
    """The float that `value` is, or one sentence that names it.

    >>> number("lam", 5)
    5.0
    >>> number("h", 0, above=0.0)
    Traceback (most recent call last):
    ValueError: h must be a finite number above 0; it is 0
    """
    allowed = "a finite number" if above is None else f"a finite number above {above:g}"
    message = f"{name} must be {allowed}; it is {value!r}"
    if isinstance(value, (bool, np.bool_, str, bytes, complex, np.complexfloating)):
        raise ValueError(message)
    try:
        x = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(message) from None
    if not math.isfinite(x) or (above is not None and not x > above):
        raise ValueError(message)
    return x


def whole(name: str, value: Any, *, least: int) -> int:
    """The int that `value` is, at least `least`, or one sentence that names it.

    >>> whole("n", 10, least=1)
    10
    >>> whole("n", 0, least=1)
    Traceback (most recent call last):
    ValueError: n must be a whole number, at least 1; it is 0
    """
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)) or value < least:
        raise ValueError(f"{name} must be a whole number, at least {least}; it is {value!r}")
    return int(value)


def vector(name: str, values: Any, size: int | None = None, *, complex_too: bool = False) -> Array:
    """The finite float vector that `values` is, of shape (size,), or one sentence that names it.

    Complex vectors pass where `complex_too`, so that derivatives can be checked by a complex step.

    >>> vector("phi", [0.1, 0.2], 2)
    array([0.1, 0.2])
    >>> vector("phi", [0.1, 0.2, 0.3], 2)
    Traceback (most recent call last):
    ValueError: phi must have shape (2,); it has shape (3,)
    """
    try:
        x = np.asarray(values)
        if x.dtype.kind == "c" and not complex_too:
            raise ValueError(f"{name} must be real; it is complex")
        if x.dtype.kind != "c":
            x = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        if "must be real" in str(error):
            raise
        raise ValueError(f"{name} must be an array of numbers; it is {values!r:.60}") from None
    if x.ndim != 1 or (size is not None and x.size != size):
        wanted = "one dimension" if size is None else f"shape ({size},)"
        raise ValueError(f"{name} must have {wanted}; it has shape {x.shape}")
    if not is_finite(x):
        bad = int(np.flatnonzero(~np.isfinite(x))[0])
        raise ValueError(f"{name} must be finite; entry {bad} is {x[bad]}")
    return x
