"""One equilibrium of a strut proved to exist and to be alone near by, at any n: Krawczyk's test [1969] in the maximum norm.

    |C F| + r |C| |P| (|sin phi| + r / 2) r < r      =>  one equilibrium within r of phi, its index that of C

with C the inverse of the Hessian at phi, exact within the balls. It is Green's function of the strut,

    C_ij = chi_min(i,j) psi_max(i,j) / psi_0     chi from the clamp (chi_0 = 0, k_1 chi_1 = 1), psi from the free end (psi_n = 1)

so that C times a vector costs O(n).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rodlab.mechanics.enumerate import Root
from rodlab.mechanics.recurrence import Recurrence, index_of, precision
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array
from rodlab.numerics.balls import Balls, balls

LEAST = 1e-18  # radius, where the residual is exactly zero


def krawczyk(strut: Strut, lam: float, phi: Array, engine: str | None = None) -> Root | None:
    """The equilibrium next to the angles phi (n,), within a radius, and its index; None where the test fails.

    >>> import numpy as np
    >>> root = krawczyk(Strut.from_joints(k=[1.0, 1.0]), 3.0, np.array([0.986, -0.5295]))
    >>> root.index, 1e-5 < root.radius < 1e-2
    (1, True)
    """
    with balls(precision(strut, lam), engine) as numbers:
        return _tested(Recurrence(strut, lam, numbers), numbers, phi)


def _tested(map_: Recurrence, numbers: Balls, phi: Array) -> Root | None:
    P, k, beta = map_.P[::-1], map_.k[::-1], map_.beta[::-1]
    n, angles = map_.n, [map_.phi0, *(numbers.number(float(x)) for x in phi)]
    sines, cosines = zip(*(numbers.sin_cos(x) for x in angles[1:]), strict=True)
    m = [k[i] * (angles[i + 1] - angles[i] - beta[i]) - map_.tau for i in range(n)]
    F = [m[i] - (m[i + 1] if i + 1 < n else 0) - P[i] * sines[i] for i in range(n)]
    soft = [P[i] * cosines[i] for i in range(n)]
    chi, psi = _from_clamp(k, soft, numbers), _from_free_end(k, soft, numbers)
    signs = [numbers.sign(x) for x in reversed(psi)]
    index = index_of(signs)
    if not signs[-1] or index is None:
        return None
    step = _largest(_green(chi, psi, F), numbers)
    r = max(2 * step, LEAST)
    change = [abs(P[i]) * (abs(sines[i]) + numbers.number(r / 2)) for i in range(n)]
    size = _largest(_green([abs(x) for x in chi], [abs(x) for x in psi], change), numbers)
    return Root(phi, r, index) if step + r * size * r < r * (1 - 1e-9) and r * size < 1 else None


def _from_clamp(k: Sequence[Any], soft: Sequence[Any], numbers: Balls) -> list[Any]:
    """chi_1 .. chi_n."""
    x, dm, chi = numbers.number(0.0), numbers.number(1.0), []
    for i in range(len(k)):
        x = x + dm / k[i]
        dm = dm - soft[i] * x
        chi.append(x)
    return chi


def _from_free_end(k: Sequence[Any], soft: Sequence[Any], numbers: Balls) -> list[Any]:
    """psi_0 .. psi_n."""
    x, dM, psi = numbers.number(1.0), numbers.number(0.0), [numbers.number(1.0)]
    for i in reversed(range(len(k))):
        dM = dM + soft[i] * x
        x = x - dM / k[i]
        psi.append(x)
    return psi[::-1]


def _green(chi: Sequence[Any], psi: Sequence[Any], w: Sequence[Any]) -> list[Any]:
    """C w, the clamp's row left out."""
    n, below, above = len(w), 0, 0
    lower, upper = [], []
    for i in range(n):
        below = below + chi[i] * w[i]
        lower.append(psi[i + 1] * below)
    for i in reversed(range(n)):
        upper.append(chi[i] * above)
        above = above + psi[i + 1] * w[i]
    return [(a + b) / psi[0] for a, b in zip(lower, reversed(upper), strict=True)]


def _largest(values: Sequence[Any], numbers: Balls) -> float:
    """Bound on the largest size; infinite where one is not known."""
    sizes = np.array([(abs(numbers.value(x)) + numbers.radius(x)) * (1 + 1e-9) for x in values])
    return float(sizes.max()) if np.isfinite(sizes).all() else np.inf
