# rodlab exercise: helix
import numpy as np


def curvature_and_torsion(u):
    """(kappa, tau)."""
    # YOUR CODE HERE
    raise NotImplementedError


def radius_and_pitch(u):
    """(radius, pitch)."""
    # YOUR CODE HERE
    raise NotImplementedError


def centreline(u, s):
    """r(s), shape (len(s), 3)."""
    # YOUR CODE HERE
    raise NotImplementedError
