# rodlab exercise: two-joints
import numpy as np


def hessian(phi, lam):
    """The second derivative of V at phi = (phi_1, phi_2), an array of shape (2, 2)."""
    # YOUR CODE HERE
    raise NotImplementedError


def branch_points():
    """The two loads at which the straight strut is singular, ascending."""
    # YOUR CODE HERE
    raise NotImplementedError


def modes():
    """The null vectors at these loads, one a row, of any length."""
    # YOUR CODE HERE
    raise NotImplementedError


def index(lam):
    """The number of negative eigenvalues of the second derivative at phi = 0."""
    # YOUR CODE HERE
    raise NotImplementedError
