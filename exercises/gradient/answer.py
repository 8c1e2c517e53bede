# rodlab exercise: gradient
import numpy as np


def energy(phi, lam, k, beta, h):
    """V at the angles phi_1, ..., phi_n (radians), a number."""
    # YOUR CODE HERE
    raise NotImplementedError


def gradient(phi, lam, k, beta, h):
    """dV/dphi_i for i = 1, ..., n, an array of shape (n,)."""
    # YOUR CODE HERE
    raise NotImplementedError
