# rodlab exercise: one-joint
import numpy as np
from scipy.optimize import brentq


def load(phi, beta):
    """The load at which phi (radians) is an equilibrium."""
    # YOUR CODE HERE
    raise NotImplementedError


def hessian(phi, beta):
    """The second derivative of V at this equilibrium."""
    # YOUR CODE HERE
    raise NotImplementedError


def coefficients():
    """a and b in lam = 1 + a phi^2 + b phi^4 + ..."""
    # YOUR CODE HERE
    raise NotImplementedError


def buckled(lam):
    """The angle between 0 and pi that is an equilibrium at lam > 1 when beta = 0."""
    # YOUR CODE HERE
    raise NotImplementedError
