"""Gauss collocation of a first-order boundary value problem y' = f(s, y) with linear conditions at both ends [N 2.8.2].

    Y_a = y_i + h sum_b A_ab f(c_b, Y_b),   y_{i+1} = y_i + h sum_b b_b f(c_b, Y_b)        on each interval: Gauss's method
    L y(0) = l,   R y(1) = r                                                               d conditions for d unknowns

Newton's method, the stages Y condensed: (I - h A x J) dY = ... is solved interval by interval, which leaves
dy_{i+1} = G_i dy_i + g_i.
What couples the mesh points is almost block diagonal [Ascher, Mattheij and Russell, 7.2]:

    [ L          ]
    [ G_1 -I     ]       a band of d below and above each block, factored by LAPACK with partial pivoting (dgbsv):
    [    G_2 -I  ]       stable for growing and decaying solutions alike, which a march is not
    [          R ]

Order 2m at mesh points. Integrals of y' = f that are quadratic in y are kept exactly, others are not.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_banded

from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.gauss import basis


@dataclass(frozen=True, eq=False)
class System:
    """f(s, y) and df/dy of arrays s (k,), y (d, k), as scipy's solve_bvp has them: (d, k) and (d, d, k)."""

    f: Callable[[Array, Array], Array]
    df: Callable[[Array, Array], Array]


def collocate(
    system: System, left: tuple[Array, Array], right: tuple[Array, Array], mesh: Array, degree: int, guess: Array, limit: int = 50
) -> Array:  # fmt: skip
    """y at the mesh points, (d, N+1), from a guess there. left, right: (L, l) and (R, r). Raises `ArithmeticError`.

    >>> linear = System(lambda s, y: np.stack([y[1], -y[0]]), lambda s, y: np.array([[0 * s, 1 + 0 * s], [-1 + 0 * s, 0 * s]]))
    >>> zero, one = (np.array([[1.0, 0.0]]), np.array([0.0])), (np.array([[1.0, 0.0]]), np.array([np.sin(1.0)]))
    >>> y = collocate(linear, zero, one, np.linspace(0, 1, 5), 4, np.zeros((2, 5)))
    >>> bool(abs(y[1, 0] - 1) < 1e-12)
    True
    """
    B, h = basis(degree), np.diff(mesh)
    y = np.array(guess, dtype=np.float64)
    stages = y[:, :-1, None] + np.diff(y, axis=1)[:, :, None] * B.c
    last = np.inf
    for _ in range(limit):
        stages, G, g = _condensed(system, mesh, h, degree, y, stages)
        if not (np.isfinite(G).all() and np.isfinite(g).all()):
            raise ArithmeticError("collocation left the numbers that a float can hold; a nearer guess is needed")
        step = _almost_block(left, right, G, g, y)
        y = y + step
        stages = stages + (step[:, :-1, None] * (1 - B.c) + step[:, 1:, None] * B.c)
        size = float(np.abs(step).max())
        if not np.isfinite(size):
            break
        if size <= 8 * EPS * float(np.abs(y).max()) or (size < 1e-9 * float(np.abs(y).max()) and size >= last / 2):
            return y
        last = size
    raise ArithmeticError(f"collocation did not converge in {limit} corrections; the last was {size:.2g}")


def _condensed(
    system: System, mesh: Array, h: Array, degree: int, y: Array, stages: Array
) -> tuple[Array, Array, Array]:  # fmt: skip
    """Stages in balance with the left ends (d, N, m), and the map to the right ends: G (N, d, d), g (N, d)."""
    B, (d, N, m) = basis(degree), stages.shape
    s = (mesh[:-1, None] + h[:, None] * B.c).ravel()
    for _ in range(3):
        f = np.asarray(system.f(s, stages.reshape(d, -1))).reshape(d, N, m)
        J = np.asarray(system.df(s, stages.reshape(d, -1))).reshape(d, d, N, m)
        missed = stages - y[:, :-1, None] - h[:, None] * np.einsum("ab,dnb->dna", B.A, f)
        matrix = np.eye(d * m) - np.einsum("n,ab,denb->nadbe", h, B.A, J).reshape(N, d * m, d * m)
        right = np.concatenate([-missed.transpose(1, 2, 0).reshape(N, d * m, 1), np.tile(np.eye(d), (N, m, 1))], axis=2)
        solved = np.linalg.solve(matrix, right).reshape(N, m, d, 1 + d)
        stages = stages + solved[..., 0].transpose(2, 0, 1)
    f = np.asarray(system.f(s, stages.reshape(d, -1))).reshape(d, N, m)
    ends = y[:, :-1] + h * (f @ B.b)
    G = np.eye(d) + np.einsum("n,b,denb,nbek->ndk", h, B.b, J, solved[..., 1:])
    return stages, G, (ends - y[:, 1:]).T


def _almost_block(left: tuple[Array, Array], right: tuple[Array, Array], G: Array, g: Array, y: Array) -> Array:
    """The corrections (d, N+1) of the mesh points."""
    N, d = g.shape
    (L, low), (R, high) = left, right
    top, order = low.size, (N + 1) * d
    rows = np.zeros((order, 3 * d))  # row k, columns from that of its block's first unknown
    known = np.zeros(order)
    rows[:top, :d], known[:top] = L, low - L @ y[:, 0]
    inner = slice(top, top + N * d)
    rows[inner, :d], rows[inner, d : 2 * d], known[inner] = G.reshape(-1, d), np.tile(-np.eye(d), (N, 1)), -g.ravel()
    rows[order - high.size :, :d], known[order - high.size :] = R, high - R @ y[:, -1]
    first = np.concatenate([np.zeros(top), np.repeat(np.arange(N) * d, d), np.full(high.size, N * d)]).astype(int)
    wide = 2 * d
    row, column = np.arange(order)[:, None], first[:, None] + np.arange(2 * d)
    held = (column < order) & (np.abs(row - column) <= wide)
    band = np.zeros((2 * wide + 1, order))
    band[(wide + row - column)[held], column[held]] = rows[:, : 2 * d][held]
    return np.asarray(solve_banded((wide, wide), band, known)).reshape(N + 1, d).T
