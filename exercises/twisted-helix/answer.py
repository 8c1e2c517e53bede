# rodlab exercise: twisted-helix
import numpy as np


def force(kappa, tau, u3, K1, K3):
    """(n_nu, n_b, n_t), shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def axial_force(kappa, tau, u3, K1, K3):
    """The force along the axis, a number."""
    # YOUR CODE HERE
    raise NotImplementedError


def axial_moment(kappa, tau, u3, K1, K3):
    """The component of the moment along the axis, a number."""
    # YOUR CODE HERE
    raise NotImplementedError
