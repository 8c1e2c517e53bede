# rodlab exercise: constitutive-law
import numpy as np


def density(u, v, K, A, u_hat, v_hat):
    """The strain energy of the rod per length, a number."""
    # YOUR CODE HERE
    raise NotImplementedError


def strains(m, n, K, A, u_hat, v_hat):
    """The strains u and v, one a row, that have the moment m and the force n."""
    # YOUR CODE HERE
    raise NotImplementedError


def unstressed(C):
    """The dimension of the set of strains without stress: 0 if there is one only."""
    # YOUR CODE HERE
    raise NotImplementedError
