# rodlab exercise: predictor
import numpy as np


def slope(phi, lam):
    """d phi/d lam of one joint."""
    # YOUR CODE HERE
    raise NotImplementedError


def tangent(J, f_lam, z, lam):
    """dz/dlam along the branch."""
    # YOUR CODE HERE
    raise NotImplementedError


def predict(J, f_lam, z, lam, target):
    """The first guess at the load target."""
    # YOUR CODE HERE
    raise NotImplementedError
