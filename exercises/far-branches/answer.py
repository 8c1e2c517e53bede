# rodlab exercise: far-branches
import numpy as np
from scipy.optimize import brentq


def folds(m):
    """The first m folds with phi > 0, rows (phi, lam)."""
    # YOUR CODE HERE
    raise NotImplementedError


def equilibria(lam):
    """All roots of phi - lam sin(phi), ascending."""
    # YOUR CODE HERE
    raise NotImplementedError


def stable(lam):
    """The number of equilibria with a positive second derivative."""
    # YOUR CODE HERE
    raise NotImplementedError
