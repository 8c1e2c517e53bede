"""Are the derivatives those of the residual? Asked once before a branch is followed, where a wrong one would cost an evening.

    J v            against   (F(u + e v, lam) - F(u - e v, lam)) / 2e
    F_lam          against   (F(u, lam + e) - F(u, lam - e)) / 2e

Differences of two lengths say how far they themselves can be trusted.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from rodlab.analysis.equations import Equations, jacobian
from rodlab.numerics.arrays import EPS, Array

WRONG = 1e-4  # relative difference that no rounding explains


def central(f: Callable[[float], Any], e: float) -> Any:
    """f'(0) of a number or array by central differences of the lengths e and 2 e: of fourth order.

    >>> round(float(central(np.exp, 1e-3)), 12)
    1.0
    """
    wide, close = ((f(x) - f(-x)) / (2 * x) for x in (2 * e, e))
    return (4 * close - wide) / 3


def check_derivatives(model: Equations, u: Array, lam: float) -> None:
    """Raise `ValueError` in a sentence when `jacobian` or `d_lam` is not the derivative of `residual` near (u, lam).

    >>> class Wrong:
    ...     def residual(self, u, lam): return u**2 - lam
    ...     def jacobian(self, u, lam): return np.diag(u)
    ...     def d_lam(self, u, lam): return -np.ones_like(u)
    ...     def inner(self, u, v): return u @ v
    >>> check_derivatives(Wrong(), np.array([1.0]), 1.0)
    Traceback (most recent call last):
    ValueError: jacobian of Wrong is not the derivative of residual in u: along a random direction entry 0 is ...
    """
    rng = np.random.default_rng(1)
    near = u + 0.05 * (1 + np.abs(u)) * rng.uniform(-1, 1, u.size)  # beside u, where wrong derivatives may agree by symmetry
    for at in (near, u):
        with np.errstate(all="ignore"):
            try:
                finite = bool(np.isfinite(np.asarray(model.residual(at, lam))).all())
            except (ValueError, ArithmeticError):
                finite = False
        if finite:
            size = 1 + np.abs(at)  # angles beside forces: each is moved by a part of its own size
            _check(model, at, lam, size / size.max(initial=1.0) * rng.uniform(-1, 1, u.size))
            return


def _check(model: Equations, u: Array, lam: float, v: Array) -> None:
    name = type(model).__name__
    J = jacobian(model, u, lam)
    if getattr(J, "shape", None) != (u.size, u.size):
        raise ValueError(f"jacobian of {name} must have shape {(u.size, u.size)}; it has {getattr(J, 'shape', type(J).__name__)}")
    f = np.asarray(model.d_lam(u, lam))
    if f.shape != u.shape:
        raise ValueError(f"d_lam of {name} must have the shape of u, {u.shape}; it has {f.shape}")
    length = 1e-5 * (1 + float(np.abs(u).max(initial=0.0)))
    wrong = _wrong(lambda e: model.residual(u + e * v, lam), np.asarray(J @ v), length)
    if wrong:
        transposed = hasattr(J, "T") and not _wrong(lambda e: model.residual(u + e * v, lam), np.asarray(J.T @ v), length)
        hint = "; its transpose is" if transposed else ""
        raise ValueError(f"jacobian of {name} is not the derivative of residual in u{hint}: along a random direction {wrong}")
    wrong = _wrong(lambda e: model.residual(u, lam + e), f, 1e-5 * (1 + abs(lam)))
    if wrong:
        raise ValueError(f"d_lam of {name} is not the derivative of residual in lam: {wrong}")


def _wrong(F: Callable[[float], Any], given: Array, e: float) -> str:
    """What is wrong with the given derivative, empty if nothing is."""
    with np.errstate(all="ignore"):
        wide, close = ((np.asarray(F(x)) - np.asarray(F(-x))) / (2 * x) for x in (e, e / 2))
        noise = 8 * EPS * np.abs(np.asarray(F(e))) / e
    trust = 4 * np.abs(wide - close) + noise + WRONG * max(1e-300, float(np.abs(close).max(initial=0.0)))
    off = np.abs(given - close)
    if not np.isfinite(close).all() or (off <= trust).all():
        return ""
    i = int(np.argmax(off - trust))
    return f"entry {i} is {given[i]:.6g}, differences of residual give {close[i]:.6g}"
