# rodlab exercise: hamiltonian-space
import numpy as np
from scipy.integrate import solve_ivp


def H(m, n, K, u_hat):
    """The Hamiltonian, a number."""
    # YOUR CODE HERE
    raise NotImplementedError


def transported(m, n, K, u_hat, s):
    """The moment and the force at arclength s, one a row, from those at 0."""

    # YOUR CODE HERE
    raise NotImplementedError


def planar(phi, moment, N1, N3):
    """The moment and the force of a planar rod along its directors, one a row."""
    # YOUR CODE HERE
    raise NotImplementedError
