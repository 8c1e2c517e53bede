# rodlab exercise: darboux
import numpy as np


def strain(d, d_prime):
    """The components u_i = u . d_i, shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def darboux(d, d_prime):
    """The vector u in the fixed frame, shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def derivative(d, u):
    """The derivatives d_i', one a row, shape (3, 3)."""
    # YOUR CODE HERE
    raise NotImplementedError
