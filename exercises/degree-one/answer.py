# rodlab exercise: degree-one
import numpy as np
from scipy.optimize import root


def residual(phi, m, lam, K, u_hat):
    """The equations at the middle of each interval, an array of shape (2, n)."""
    # YOUR CODE HERE
    raise NotImplementedError


def eliminated(phi, lam):
    """The scheme in phi only at the inner points, for K = 1 and u_hat = 0, an array of shape (n - 1,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def solve(lam, K, u_hat, n):
    """phi and m at s_0, ..., s_n, two arrays of shape (n + 1,)."""

    # YOUR CODE HERE
    raise NotImplementedError
