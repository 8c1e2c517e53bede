"""From the links to the strut: what the kernels give for each link, put together over all of them.

gradient_i = m_i - m_{i+1} + f_i             the moments m in the joints, the net moments f on the links
Hessian    = D^T diag(k) D - diag(c)         their couplings k, and the rests c
"""

from typing import Any

import numpy as np

from rodlab.numerics.arrays import Array
from rodlab.numerics.difference import DifferenceForm, Springs
from rodlab.numerics.tridiagonal import Tridiagonal


def balance(m: Any, f: Any, like: Array) -> Array:
    """m_i - m_{i+1} + f_i, shape (n,): the moments first, whose difference rounding hardly touches."""
    g = np.empty_like(like)
    g[:] = m
    if np.ndim(m):
        g[:-1] -= m[1:]
    else:
        g[:-1] -= m
    g += f
    return g


def full(value: Any, n: int) -> Array:
    """The value as an array (n,) of its own."""
    return np.array(np.broadcast_to(value, n), dtype=np.float64)


def difference_form(springs: Springs | Array, c: Array, spread: float) -> DifferenceForm | Tridiagonal:
    """By its factors where the coupling is that of springs, else by its entries; c is known to `spread`."""
    if isinstance(springs, Springs):
        return DifferenceForm(springs, c, spread)
    if springs.min() > 0:
        return DifferenceForm(Springs(springs), c, spread)
    diagonal = springs - c
    diagonal[:-1] += springs[1:]
    return Tridiagonal(diagonal, -springs[1:])
