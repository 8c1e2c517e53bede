# rodlab exercise: convexity
import numpy as np
from scipy.integrate import solve_ivp


def bound(K):
    """The load below which convexity shows uniqueness, a number."""
    # YOUR CODE HERE
    raise NotImplementedError


def second_variation(phi, lam, K):
    """The matrix of Q for links of constant angle and stiffness, an array of shape (n, n)."""
    # YOUR CODE HERE
    raise NotImplementedError


def end_moment(slope, lam, K):
    """The moment K phi' at s = 1 of the solution that leaves phi = 0 with phi' = slope, a number."""
    # YOUR CODE HERE
    raise NotImplementedError
