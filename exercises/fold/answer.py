# rodlab exercise: fold
import numpy as np
from scipy.optimize import root


def nearest(A):
    """The eigenvalue of A nearest to zero."""
    # YOUR CODE HERE
    raise NotImplementedError


def extended(f, J, z, v, lam):
    """f, J v and v.v - 1, one after the other."""
    # YOUR CODE HERE
    raise NotImplementedError


def fold(f, J, z, lam):
    """z and lam of the fold near the given ones."""
    # YOUR CODE HERE
    raise NotImplementedError
