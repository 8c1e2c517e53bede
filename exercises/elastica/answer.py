# rodlab exercise: elastica
import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk


def load(alpha):
    """The load of the first buckled branch at the tip angle alpha (radians)."""
    # YOUR CODE HERE
    raise NotImplementedError


def tip(alpha):
    """The place x, z of the tip at the tip angle alpha."""
    # YOUR CODE HERE
    raise NotImplementedError


def tip_angle(lam):
    """The positive tip angle (radians) at the load lam."""
    # YOUR CODE HERE
    raise NotImplementedError
