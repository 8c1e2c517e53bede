# rodlab exercise: one-joint-imperfect
import numpy as np
from scipy.optimize import brentq


def angle(lam, beta):
    """The equilibrium angle at lam on the branch that starts at phi = beta without load."""
    # YOUR CODE HERE
    raise NotImplementedError


def fold(beta):
    """phi and lam of the fold of the detached branch."""
    # YOUR CODE HERE
    raise NotImplementedError


def leading(beta):
    """Leading terms: the angle at lam = 1, and the load of the fold."""
    # YOUR CODE HERE
    raise NotImplementedError
