# rodlab exercise: hessian
import numpy as np


def hessian(phi, lam, k, h):
    """The diagonal and the entries beside it of the second derivative of V."""
    # YOUR CODE HERE
    raise NotImplementedError


def product(diagonal, off_diagonal, v):
    """The symmetric tridiagonal matrix times v."""
    # YOUR CODE HERE
    raise NotImplementedError


def second_variation(phi, lam, k, h, v):
    """v . V'' v at the angles phi."""
    # YOUR CODE HERE
    raise NotImplementedError
