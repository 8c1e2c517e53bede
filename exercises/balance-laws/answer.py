# rodlab exercise: balance-laws
import numpy as np


def force_rate(n, u):
    """n_i', shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def moment_rate(n, m, u, v):
    """m_i', shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def invariants(n, m):
    """Two numbers that do not depend on s."""
    # YOUR CODE HERE
    raise NotImplementedError
