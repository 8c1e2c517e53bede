# rodlab exercise: tridiagonal-solve
import numpy as np


def pivots(diagonal, off_diagonal):
    """The diagonal that elimination from the top leaves."""
    # YOUR CODE HERE
    raise NotImplementedError


def solve(diagonal, off_diagonal, right):
    """x of A x = right."""
    # YOUR CODE HERE
    raise NotImplementedError


def determinant(diagonal, off_diagonal):
    """The sign of the determinant, and the logarithm of its absolute value."""
    # YOUR CODE HERE
    raise NotImplementedError
