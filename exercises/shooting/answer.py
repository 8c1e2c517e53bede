# rodlab exercise: shooting
import numpy as np
from scipy.optimize import brentq


def angles(first, n, lam):
    """phi_1, ..., phi_n from phi_0 = 0 and phi_1 = first."""
    # YOUR CODE HERE
    raise NotImplementedError


def residual(first, n, lam):
    """phi_{n+1} - phi_n: zero in equilibrium."""
    # YOUR CODE HERE
    raise NotImplementedError


def equilibria(n, lam):
    """All equilibria, one a row, in ascending order of phi_1."""
    # YOUR CODE HERE
    raise NotImplementedError
