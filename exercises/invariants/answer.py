# rodlab exercise: invariants
import numpy as np


def field(y, K, u_hat):
    """The derivatives of n_1, n_3, m, an array of shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def integrals(y, K, u_hat):
    """H and C."""
    # YOUR CODE HERE
    raise NotImplementedError


def march(y, K, u_hat, n):
    """The midpoint rule from s = 0 to 1, an array of shape (n + 1, 3)."""
    # YOUR CODE HERE
    raise NotImplementedError
