# rodlab exercise: order-study
import numpy as np


def orders(n, errors):
    """Observed orders, an array shorter by one."""
    # YOUR CODE HERE
    raise NotImplementedError


def extrapolated(n, values, p):
    """Richardson's extrapolation of each pair of neighbours, an array shorter by one."""
    # YOUR CODE HERE
    raise NotImplementedError


def trusted(n, errors, p, within):
    """The number of errors before rounding takes over."""
    # YOUR CODE HERE
    raise NotImplementedError
