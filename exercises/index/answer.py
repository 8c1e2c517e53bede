# rodlab exercise: index
import numpy as np


def below(diagonal, off_diagonal, x):
    """The number of eigenvalues less than x."""
    # YOUR CODE HERE
    raise NotImplementedError


def index(diagonal, off_diagonal):
    """The number of negative eigenvalues."""
    # YOUR CODE HERE
    raise NotImplementedError


def eigenvalue(diagonal, off_diagonal, j):
    """The j-th smallest eigenvalue (j = 1 is the smallest)."""
    # YOUR CODE HERE
    raise NotImplementedError
