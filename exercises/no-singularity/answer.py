# rodlab exercise: no-singularity
import numpy as np


def linearisation(K, n):
    """The matrix of -(K psi')' at the joints 1, ..., n, an array of shape (n, n)."""
    # YOUR CODE HERE
    raise NotImplementedError


def smallest(K, n):
    """Its smallest eigenvalue."""
    # YOUR CODE HERE
    raise NotImplementedError


def bound(K_min, n):
    """The smallest eigenvalue of the softest rod with K >= K_min."""
    # YOUR CODE HERE
    raise NotImplementedError
