# rodlab exercise: newton
import numpy as np


def newton(f, J, z, steps):
    """All iterates, one a row."""
    # YOUR CODE HERE
    raise NotImplementedError


def order(errors):
    """The order of convergence from the last three errors."""
    # YOUR CODE HERE
    raise NotImplementedError


def ratio(m):
    """The ratio of successive errors of Newton's method at an m-fold root."""
    # YOUR CODE HERE
    raise NotImplementedError
