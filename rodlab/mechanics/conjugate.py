"""Conjugate points: where the Jacobi field that leaves the free end vanishes; as many as the index [N 2.7; Jacobi; Morse 1934].

    (K w')' + lam cos(phi) w = 0,   w(1) = 1,  K w'(1) = 0          downwards from the free end

Each zero of w in (0, 1) is a conjugate point. (Started at the clamp, w(0) = 0, the same count is that of a rod held at both
ends: too small by one wherever the last moment has the wrong sign.) The field is marched through the second variation,
condensed to mesh points or the strut's own, and rescaled as it goes, lest it overflow at lam = -1e8.
"""

from typing import Any

import numpy as np

from rodlab.mechanics.rod import Rod
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array
from rodlab.numerics.collocated import Collocated
from rodlab.numerics.full import Full

BIG = 1e150


def conjugate_points(p: Any) -> Array:
    """Arclengths of the conjugate points of an equilibrium of a strut or rod, ascending; their number is its index.

    They are placed between neighbouring nodes by a line: good to the square of the nodes' distance, without an estimate.
    Raises `ValueError` for another model, or a strut whose Hessian is full.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> conjugate_points(equilibrium(Rod(), 30.0)).round(6)      # straight: w = cos(sqrt(lam) (1 - s)), zeros at odd quarters
    array([0.139639, 0.713214])
    """
    model, matrix = p.equations, None
    if isinstance(model, (Strut, Rod)):
        matrix = model.hessian(p.u, p.lam)
    if matrix is None or isinstance(matrix, Full):
        raise ValueError(
            f"p must be an equilibrium of a strut or rod whose second variation is local; its model is {model!r:.60}"
        )
    if isinstance(matrix, Collocated):
        known = matrix.condensed()
        w = _field(known.diagonal, known.S[:, 0, 1])
        ends = np.stack([w[:-1], w[1:]], axis=1)
        inner = -(known.F @ ends[:, :, None])[:, :, 0]
        return _zeros(model.grid.places, np.append(w[0], np.concatenate([inner, ends[:, 1:]], axis=1).ravel()))
    d, e = matrix.diagonal, np.append(-model.joints.k[0], matrix.off_diagonal)
    return _zeros(np.append(0.0, model.joints.s), _field(d, e))


def _field(d: Array, e: Array) -> Array:
    """w at the clamp and the mesh points, (N+1,), from rows e_i w_{i-1} + d_i w_i + e_{i+1} w_{i+1} = 0, from the last up.

    Only ratios of neighbours matter: where it has grown out of range it is scaled back.
    """
    w = np.zeros(d.size + 1)
    w[-1] = 1.0
    above = 0.0
    for i in range(d.size, 0, -1):
        w[i - 1] = -(d[i - 1] * w[i] + above) / e[i - 1]
        if abs(w[i - 1]) > BIG:
            w[i - 1 :] /= abs(w[i - 1])
        above = e[i - 1] * w[i]
    return w


def _zeros(s: Array, w: Array) -> Array:
    """Where a field known at s changes its sign, by lines between neighbours; a zero at the clamp itself is none."""
    i = np.flatnonzero((w[:-1] * w[1:] < 0) | ((w[1:] == 0) & (s[1:] < s[-1])))
    return np.asarray(s[i] + (s[i + 1] - s[i]) * w[i] / (w[i] - w[i + 1]))
