# rodlab exercise: two-joints-imperfect
import numpy as np

LAM = (3 + np.sqrt(5) * np.array([-1, 1])) / 2  # loads at which the straight strut is singular


def reduced(beta, j):
    """The component along v_j = (., 1) of the force that the rest angles exert on the straight strut."""
    # YOUR CODE HERE
    raise NotImplementedError


def ineffective(j):
    """The ratio beta_1/beta_2 for which it is zero."""
    # YOUR CODE HERE
    raise NotImplementedError


def equilibrium(beta, lam):
    """The angles (phi_1, phi_2) of the equilibrium at a load below lam_1."""
    # YOUR CODE HERE
    raise NotImplementedError
