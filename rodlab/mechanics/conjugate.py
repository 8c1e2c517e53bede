"""Conjugate points: where the Jacobi field that leaves the free end vanishes; as many as the index [N 2.7; Jacobi; Morse 1934].

    (K w')' + lam cos(phi) w = 0,   w(1) = 1,  K w'(1) = 0          downwards from the free end

Each zero of w in (0, 1) is a conjugate point. (Started at the clamp, w(0) = 0, the same count is that of a rod held at both
ends: too small by one wherever the last moment has the wrong sign.) The field is marched through the second variation,
condensed to mesh points or the strut's own, and rescaled at every step, lest it overflow or vanish at lam = -1e8.
"""

from typing import Any

import numpy as np

from rodlab.mechanics.rod import Rod
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array
from rodlab.numerics.collocated import Collocated
from rodlab.numerics.difference import DifferenceForm
from rodlab.numerics.tridiagonal import Tridiagonal


def conjugate_points(p: Any) -> Array:
    """Arclengths of the conjugate points of an equilibrium of a strut or rod, ascending; their number is its index.

    They are placed between neighbouring nodes by a line: good to the square of the nodes' distance, without an estimate.
    Raises `ValueError` for another model, or a strut whose Hessian is full.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> conjugate_points(equilibrium(Rod(), 30.0)).round(6)      # straight: w = cos(sqrt(lam) (1 - s)), zeros at odd quarters
    array([0.139639, 0.713214])
    """
    model, matrix = p.equations, None
    if isinstance(model, (Strut, Rod)) and not hasattr(model, "unknowns"):
        matrix = model.hessian(p.u, p.lam)
    if not isinstance(matrix, (DifferenceForm, Tridiagonal, Collocated)):
        raise ValueError(
            f"p must be an equilibrium of a strut or rod whose second variation is local; its model is {model!r:.60}"
        )
    if isinstance(matrix, Collocated):
        return _of_rod(matrix, model.grid.places)
    d, e, s = matrix.diagonal, np.append(-model.joints.k[0], matrix.off_diagonal), np.append(0.0, model.joints.s)
    return _zeros(np.stack([s[:-1], s[1:]], axis=1), _field(d, e))


def _of_rod(matrix: Collocated, places: Array) -> Array:
    """Zeros at mesh points and between them, by the nodes of each interval.

    An interval that by itself is stable, its ends held, has one where its ends differ in sign and none else: where a mesh is
    too coarse for the field, as for a layer that nothing in the solution asks to be resolved, its nodes are not asked.
    """
    known = matrix.condensed()
    inner = matrix.blocks[:, 1:-1, 1:-1]
    stable = (np.linalg.eigvalsh(inner) > 0).all(axis=1)
    coupling = known.S[:, 0, 1]
    ends = _field(known.diagonal, np.where(stable, -np.abs(coupling), coupling))
    nodes = np.arange(matrix.N)[:, None] * matrix.m + np.arange(matrix.m + 1)
    s = places[nodes]
    w = np.concatenate([ends[:, :1], -(known.F @ ends[:, :, None])[:, :, 0], ends[:, 1:]], axis=1)
    line = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * (s - s[:, :1]) / (s[:, -1:] - s[:, :1])
    changes = (np.diff(np.sign(w), axis=1) != 0).sum(axis=1)
    asked = stable & (changes != (ends[:, 0] * ends[:, 1] < 0))
    return _zeros(s, np.where(asked[:, None], line, w))


def _field(d: Array, e: Array) -> Array:
    """w at both ends of each interval, (N, 2), from rows e_i w_{i-1} + d_i w_i + e_{i+1} w_{i+1} = 0, from the last up.

    Only ratios of neighbours matter: each pair is scaled by its larger, so that none is lost to overflow or underflow.
    """
    w = np.empty((d.size, 2))
    here, above = 1.0, 0.0
    for i in range(d.size - 1, -1, -1):
        below = -(d[i] * here + above) / e[i]
        size = max(abs(below), abs(here))
        w[i] = below / size, here / size
        here, above = w[i, 0], e[i] * w[i, 1]
    return w


def _zeros(s: Array, w: Array) -> Array:
    """Where a field known at s (N, m) of each interval changes its sign, by lines; a zero at the clamp itself is none."""
    sign = np.sign(w)
    i, j = np.nonzero((sign[:, :-1] * sign[:, 1:] < 0) | ((sign[:, 1:] == 0) & (s[:, 1:] < s[-1, -1])))
    below, above = w[i, j], w[i, j + 1]
    return np.asarray(s[i, j] + (s[i, j + 1] - s[i, j]) * (below / (below - above)))
