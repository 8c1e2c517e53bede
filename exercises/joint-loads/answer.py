# rodlab exercise: joint-loads
import numpy as np


def hessian(n, lam, last):
    """The second derivative of V on the straight strut, with the weight `last` on the last link."""
    # YOUR CODE HERE
    raise NotImplementedError


def loads(n):
    """The buckling loads with all weights 1, ascending."""
    # YOUR CODE HERE
    raise NotImplementedError


def loads_half(n):
    """The buckling loads with the last weight 1/2, ascending."""
    # YOUR CODE HERE
    raise NotImplementedError
