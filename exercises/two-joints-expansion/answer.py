# rodlab exercise: two-joints-expansion
import numpy as np
from scipy.optimize import root


def branch_load(j):
    """The load at which branch j leaves the straight strut."""
    return (3 + (-1) ** j * np.sqrt(5)) / 2


def coefficient(j):
    """c_j in lam = lam_j + c_j eps^2 + ..."""
    # YOUR CODE HERE
    raise NotImplementedError


def shape(j):
    """a_j and b_j in phi_1 = a_j eps + b_j eps^3 + ..."""
    # YOUR CODE HERE
    raise NotImplementedError


def state(j, eps):
    """phi_1 and lam of the equilibrium on branch j that has phi_2 = eps."""

    # YOUR CODE HERE
    raise NotImplementedError
