"""Truths of struts in more digits than a float has: what the answers of the stability study are held against.

    count      of D^T k D - diag(c), from the free end up:  r_i = c_i + r',  r' = k_i r_i / (k_i - r_i)
               as many negative eigenvalues as joints with r_i > k_i [N 2.7; Sturm], in whole numbers of 2^-bits
    loads      bisection of counts with c = lam h w;  4 n^2 sin^2(...) where the strut is uniform
    angles     Newton's method in mpmath, or in pairs of floats for many joints (`rodlab.lab.studies.pairs`)

Floats given are taken as exact numbers. No matrix of the house is used, but for the solves that steer `refined`: its residual,
evaluated in pairs, decides, and the last correction says how far it may still be off.
"""

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, log2
from operator import add
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np

from rodlab.lab.studies.pairs import Pair, sine_and_cosine
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array

FINE = 84  # binary digits of a load: 25 decimal ones


class Exact(NamedTuple):
    """Angles of the exact solution, their cosines, the size of the last correction, and the residual (n,) at the angles given."""

    angles: Any
    cosines: Any
    step: float
    residual: Array


# --- counts and loads of struts -----------------------------------------------------------------------------------


def exact_index(diagonal: Any, off_diagonal: Any) -> tuple[int, int]:
    """(negative, zero) eigenvalues of a tridiagonal matrix of floats, exactly: Sturm's sequence in fractions.

    >>> exact_index([1.0, 0.0], [-1.0])
    (1, 0)
    """
    d, e = [Fraction(float(x)) for x in diagonal], [Fraction(float(x)) for x in off_diagonal]
    minors = [Fraction(1), d[0]]
    for i in range(1, len(d)):
        minors.append(d[i] * minors[-1] - e[i - 1] ** 2 * minors[-2])
    negative, last = 0, 1
    for minor in minors[1:]:  # a zero takes the sign opposite to the minor before it, if it is followed by another
        sign = (minor > 0) - (minor < 0) or -last
        negative += sign != last
        last = sign
    return (negative - 1, 1) if minors[-1] == 0 else (negative, 0)


def exact_loads(k: Any, hw: Any, numbers: Sequence[int], digits: int = 50) -> list[Any]:
    """Buckling loads of springs k and weights hw (floats, taken as exact), mpf with 25 digits, by bisection of counts.

    >>> mp.nstr(exact_loads([1, 1], [1, 1], [1])[0], 15)                      # (3 - sqrt 5) / 2
    '0.381966011250105'
    """
    k, hw = np.asarray(k, dtype=np.float64), np.asarray(hw, dtype=np.float64)
    scale = 2.0 ** round(log2(k.max()))
    k = k / scale
    least = 1 / float(hw @ np.cumsum(1 / k))  # one over the trace of the inverse
    most = float(np.max(2 * (k + np.append(k[1:], 0.0)) / hw))
    bits = _bits(digits, [k.min(), least * hw.min(), least])
    K, W = _whole(k, bits), _whole(hw, bits)
    loads = []
    for j in numbers:
        low, high = _whole([least / 2, 2 * most], bits)
        while (high - low) << FINE > high:
            middle = _between(low, high)
            if _count(K, [middle * w >> bits for w in W]) >= j:
                high = middle
            else:
                low = middle
        loads.append(_real(low + high, bits + 1, scale, digits))
    return loads


def exact_count(k: Any, c: Any, digits: int = 50) -> int:
    """Number of negative eigenvalues of D^T k D - diag(c); k floats, c floats, mpf or a `Pair`."""
    parts = [c.high, c.low] if isinstance(c, Pair) else [np.asarray(c) if isinstance(c[0], float) else c]
    bits = _bits(digits, [min(k), min((abs(x) for x in parts[0] if x), default=1)])
    columns = [_whole(part, bits) for part in parts]
    return _count(_whole(np.asarray(k), bits), columns[0] if len(columns) == 1 else list(map(add, *columns)))


def uniform_load(n: int, rule: str, j: int, digits: int = 50) -> Any:
    """4 n^2 sin^2((2j-1) pi / (2 (2n+1))) by the rule "end", 4 n^2 sin^2((2j-1) pi / (4n)) by "trapezoid"; K = 1."""
    with mp.workdps(digits):
        angle = (2 * j - 1) * mp.pi / (2 * (2 * n + 1) if rule == "end" else 4 * n)
        return 4 * mp.mpf(n) ** 2 * mp.sin(angle) ** 2


def uniform_count(n: int, rule: str, lam: float, digits: int = 50) -> int:
    """Number of buckling loads of the uniform strut below lam; K = 1."""
    with mp.workdps(digits):
        low, high = 0, n  # how many are below: at least, at most
        while low < high:
            j = (low + high + 1) // 2
            low, high = (j, high) if uniform_load(n, rule, j, digits) < mp.mpf(lam) else (low, j - 1)
        return low


def _count(k: Sequence[int], c: Sequence[int]) -> int:
    """Joints with r_i > k_i, from the free end up; all in units of 2^-bits."""
    count = r = 0
    for own, pressed in zip(reversed(k), reversed(c), strict=True):
        r += pressed
        if r > own:
            count += 1
        r = own * r // (own - r) if r != own else own << 4096
    return count


def _bits(digits: int, sizes: Sequence[Any]) -> int:
    """Binary places at which the least of these sizes has so many digits."""
    return ceil(digits * log2(10)) - min(int(mp.floor(mp.log(mp.mpf(float(size)), 2))) for size in sizes)


def _whole(x: Any, bits: int) -> list[int]:
    """Numbers as whole multiples of 2^-bits."""
    if not isinstance(x, np.ndarray):
        return [int(mp.ldexp(value, bits)) for value in x]
    mantissa, exponent = np.frexp(x)
    shifts = (exponent + (bits - 53)).tolist()
    return [m << e if e >= 0 else m >> -e for m, e in zip(np.ldexp(mantissa, 53).astype(np.int64).tolist(), shifts, strict=True)]


def _between(low: int, high: int) -> int:
    """Halfway: of the exponents while they differ, of the numbers then."""
    apart = high.bit_length() - low.bit_length()
    return low << (apart // 2) if apart > 2 else (low + high) // 2


def _real(x: int, bits: int, scale: float, digits: int) -> Any:
    with mp.workdps(digits):
        return mp.mpf(x) / mp.mpf(2) ** bits * mp.mpf(scale)


# --- equilibria of struts --------------------------------------------------------------------------------------------


def exact_tip(strut: Strut, phi: Any, lam: float, digits: int = 40) -> Any:
    """Tip angle of the exact solution next to phi: Newton's method in `digits` on the strut's own floats."""
    return exact_angles(strut, phi, lam, digits).angles[-1]


def exact_angles(strut: Strut, phi: Any, lam: float, digits: int = 40) -> Exact:
    """All angles of it, mpf."""
    with mp.workdps(digits):
        j = strut.joints
        n, load = j.n, mp.mpf(lam) * mp.mpf(j.h)
        k, beta, w = ([mp.mpf(float(x)) for x in a] for a in (j.k, j.beta, j.w))
        u, residual = [mp.mpf(float(x)) for x in phi], None
        nothing = mp.mpf(10) ** (4 - digits) * max(map(abs, u))  # an exact solution that is zero is never reached
        for _ in range(60):
            a = [mp.mpf(j.phi0), *u[:-1]]
            m = [k[i] * (u[i] - a[i] - beta[i]) for i in range(n)] + [mp.mpf(0)]
            cos, sin = zip(*map(mp.cos_sin, u), strict=True)
            F = [m[i] - m[i + 1] - load * w[i] * sin[i] for i in range(n)]
            residual = [float(x) for x in F] if residual is None else residual
            if not any(F):
                return Exact(u, cos, 0.0, np.zeros(n))
            d = [k[i] + (k[i + 1] if i + 1 < n else 0) - load * w[i] * cos[i] for i in range(n)]
            step = _solved(d, k, F)
            u = [x - s for x, s in zip(u, step, strict=True)]
            size, most = max(map(abs, step)), max(map(abs, u))
            if size <= max(mp.mpf(10) ** (16 - digits) * most, nothing):
                return Exact(u, list(map(mp.cos, u)), float(size), np.array(residual))
        raise ArithmeticError(f"Newton's method in {digits} digits finds no solution next to these angles at lam = {lam:g}")


def _solved(d: list[Any], k: list[Any], F: list[Any]) -> list[Any]:
    """Elimination from the clamp up with diagonal d and -k_{i+1} beside it."""
    n, F = len(d), list(F)
    for i in range(1, n):
        q = -k[i] / d[i - 1]
        d[i], F[i] = d[i] + q * k[i], F[i] - q * F[i - 1]
    step = [mp.mpf(0)] * n
    for i in reversed(range(n)):
        step[i] = (F[i] + (k[i + 1] * step[i + 1] if i + 1 < n else 0)) / d[i]
    return step


def refined(strut: Strut, phi: Array, lam: float, enough: float) -> Exact:
    """All angles of it, a `Pair`: residuals in pairs, solves in floats, until the correction of every angle is below `enough`."""
    j = strut.joints
    load, beta, w = Pair.of(np.asarray(lam)) * j.h, j.beta, j.w
    u, residual, last = Pair.of(phi), None, np.inf
    for _ in range(12):
        sin, cos = sine_and_cosine(u)
        m = (u - u.before(j.phi0) - beta) * j.k
        F = m - m.after() - sin * load * w
        residual = F.high if residual is None else residual
        step = strut.hessian(u.high, lam).solve_fully(F.high)
        u, size = u - step, float(np.abs(step).max())
        if size <= enough:
            return Exact(u, cos, size, residual)
        if not size < last / 4:
            break
        last = size
    raise ArithmeticError(f"corrections in pairs stop shrinking at {size:.1e}: no truth is known at lam = {lam:g}")


def pressed(strut: Strut, exact: Exact, lam: float) -> Any:
    """c = lam h w cos(phi) of the second variation D^T k D - diag(c) at the exact angles, a `Pair` or mpf."""
    j = strut.joints
    if isinstance(exact.cosines, Pair):
        return exact.cosines * (Pair.of(np.asarray(lam)) * j.h) * j.w
    with mp.workdps(50):
        return [mp.mpf(lam) * mp.mpf(j.h) * mp.mpf(float(w)) * cos for w, cos in zip(j.w, exact.cosines, strict=True)]


def times(lam: float, hw: Array) -> list[Any]:
    """lam h w, exactly."""
    with mp.workdps(50):
        return [mp.mpf(lam) * mp.mpf(float(x)) for x in hw]


def beside(load: Any, off: float) -> float:
    """load (1 + off), rounded once."""
    with mp.workdps(50):
        return float(load * (1 + mp.mpf(off)))


def many(*parts: float) -> Any:
    """The sum of floats in 60 digits."""
    with mp.workdps(60):
        return mp.fsum(mp.mpf(float(x)) for x in parts)
