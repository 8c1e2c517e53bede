# rodlab exercise: zero-load
import numpy as np
from scipy.integrate import quad


def angle(s, u_hat, phi_0):
    """phi at the arclengths s (shape (k,)), radians, an array of shape (k,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def tip(u_hat, phi_0):
    """The place (x, z) of the end s = 1."""
    # YOUR CODE HERE
    raise NotImplementedError


def centre(c, phi_0):
    """The centre (x, z) of the circle that a rod of constant curvature c is part of."""
    # YOUR CODE HERE
    raise NotImplementedError
