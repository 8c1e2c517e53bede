# rodlab exercise: accurate-loads
import numpy as np


def factor(k, h):
    """A bidiagonal B with B^T B = A, an array of shape (n, n)."""
    # YOUR CODE HERE
    raise NotImplementedError


def smallest_load(k, h):
    """The first buckling load to nearly all digits."""
    # YOUR CODE HERE
    raise NotImplementedError
