# rodlab exercise: force-balance
import numpy as np


def places(phi, h):
    """The places of the ends of links 0, ..., n: x and z, two arrays of shape (n + 1,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def multipliers(n, lam):
    """The multipliers nu and mu at an equilibrium, two arrays of shape (n + 1,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def moment_balance(phi, nu, mu, k, beta, h):
    """dL/dphi_i for i = 1, ..., n, an array of shape (n,)."""
    # YOUR CODE HERE
    raise NotImplementedError
