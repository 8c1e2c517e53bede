"""Meshes on [0, 1]: uniform between breaks, and equidistributed by an estimate of the error [Ascher, Mattheij, Russell, 9.1].

An interval i with error e_i of order q, cut into n_i, leaves n_i e_i n_i^{-q}. The fewest intervals for a sum of errors below
`aim` have n_i = c e_i^{1/q}, c^{q-1} = sum_i e_i^{1/q} / aim. A mesh is built with this density; breaks stay points of it.
"""

import itertools
from collections.abc import Sequence

import numpy as np

from rodlab.numerics.arrays import Array, vector, whole

MOST = 4_000  # intervals of a mesh that is made
GIVEN = 100_000  # of one that is given
CUT = 8.0  # most parts of an interval at once, and the most that are merged
RATIO = 6.0  # of densities of neighbours


def given_mesh(mesh: object, breaks: Array) -> Array:
    """The mesh of so many intervals, or of these points, with every break a point of it; `ValueError` for what is none."""
    if np.ndim(mesh) == 0:  # type: ignore[arg-type]
        n = whole("mesh", mesh, least=1)
        if n > GIVEN:
            raise ValueError(f"mesh must have at most {GIVEN} intervals; it is {str(n)[:20]}")
        return spread_out(n, breaks)
    points = vector("mesh", mesh)
    if points.size < 2 or points[0] != 0 or points[-1] != 1 or not (np.diff(points) > 0).all():
        raise ValueError(f"mesh must be a number of intervals or ascending points from 0 to 1; it is {mesh!r:.60}")
    return np.union1d(points, breaks)


def spread_out(n: int, breaks: Array) -> Array:
    """About n intervals, of equal length between the breaks, at least one in each piece.

    >>> spread_out(4, np.array([0.5]))
    array([0.  , 0.25, 0.5 , 0.75, 1.  ])
    """
    cuts = np.concatenate([[0.0], breaks, [1.0]])
    parts = [np.linspace(a, b, max(1, round(n * (b - a))) + 1)[:-1] for a, b in itertools.pairwise(cuts)]
    return np.append(np.concatenate(parts), 1.0)


def halved(mesh: Array) -> Array:
    """Every interval in two.

    >>> halved(np.array([0.0, 0.5, 1.0]))
    array([0.  , 0.25, 0.5 , 0.75, 1.  ])
    """
    return np.union1d(mesh, (mesh[1:] + mesh[:-1]) / 2)


def equidistributed(mesh: Array, errors: Array, aim: float, order: int, breaks: Array) -> Array:
    """A mesh on which the errors (N,) of the intervals of `mesh`, each of this order, sum to about `aim`.

    Coarser where they allow it, finer where they ask for it, by at most a factor of 8 at a time, and of about 4000 intervals
    at most, whatever they ask for.

    >>> equidistributed(np.array([0.0, 0.5, 1.0]), np.array([1e-4, 1e-12]), 1e-6, 4, np.array([])).round(2)
    array([0.  , 0.1 , 0.19, 0.29, 0.39, 0.49, 1.  ])
    """
    root = np.maximum(errors, 1e-300) ** (1 / order)
    parts = (float(root.sum()) / aim) ** (1 / (order - 1)) * root
    parts = _smoothed(np.clip(parts, 1 / CUT, CUT) / np.diff(mesh)) * np.diff(mesh)
    parts *= min(1.0, MOST / float(parts.sum()))
    cuts = np.concatenate([[0.0], breaks, [1.0]])
    reached = np.append(0.0, np.cumsum(parts))
    points = [np.array([0.0])]
    for a, b in itertools.pairwise(cuts):
        low, high = np.interp([a, b], mesh, reached)
        n = max(1, int(np.ceil(high - low - 1e-9)))
        inner = np.interp(low + (high - low) * np.arange(1, n) / n, reached, mesh)
        points.append(np.append(inner, b))
    return np.concatenate(points)


def _smoothed(density: Array) -> Array:
    """The density raised where a neighbour's is more than RATIO times as high."""
    out: Sequence[float] = density.tolist()
    values = list(out)
    for i in range(1, len(values)):
        values[i] = max(values[i], values[i - 1] / RATIO)
    for i in range(len(values) - 2, -1, -1):
        values[i] = max(values[i], values[i + 1] / RATIO)
    return np.array(values)
