# rodlab exercise: hamiltonian
import numpy as np


def H(phi, m, N1, N3, K, u_hat):
    """The Hamiltonian, a number."""
    # YOUR CODE HERE
    raise NotImplementedError


def field(phi, m, N1, N3, K, u_hat):
    """(phi', m'), an array of shape (2,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def drift(phi, m, N1, N3, K, u_hat, steps):
    """H at s = 1 less H at s = 0 along steps of the classical Runge-Kutta method, a number."""
    # YOUR CODE HERE
    raise NotImplementedError
