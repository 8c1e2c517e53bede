# rodlab exercise: rod-loads
import numpy as np


def loads(K, count):
    """The first buckling loads, an array of shape (count,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def mode(j, s):
    """psi_j at the arclengths s, up to a factor."""
    # YOUR CODE HERE
    raise NotImplementedError


def index(lam, K):
    """The number of negative eigenvalues at phi = 0."""
    # YOUR CODE HERE
    raise NotImplementedError


def equilibria(lam, K):
    """The number of equilibria at lam: the straight one and the bent ones."""
    # YOUR CODE HERE
    raise NotImplementedError
