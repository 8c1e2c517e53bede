# rodlab exercise: imperfect-strut
import numpy as np
from scipy.integrate import quad


def delta(f, eps, j):
    """The imperfection's component along mode j."""
    # YOUR CODE HERE
    raise NotImplementedError


def amplitudes(lam, j, delta):
    """The real roots of the reduced equation, ascending."""
    # YOUR CODE HERE
    raise NotImplementedError


def at_buckling(j, delta):
    """The amplitude at lam = lam_j."""
    # YOUR CODE HERE
    raise NotImplementedError


def fold(j, delta):
    """The load and the amplitude of the fold."""
    # YOUR CODE HERE
    raise NotImplementedError
