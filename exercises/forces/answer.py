# rodlab exercise: forces
import numpy as np


def body(N1, N3, phi):
    """The components (n1, n3) along d_1 and d_3 of the force with the components N1, N3 along e_1 and e_3."""
    # YOUR CODE HERE
    raise NotImplementedError


def fixed(n1, n3, phi):
    """The components (N1, N3) along e_1 and e_3 of the force with the components n1, n3 along d_1 and d_3."""
    # YOUR CODE HERE
    raise NotImplementedError


def rates(n1, n3, kappa):
    """(n1', n3', m') at an equilibrium of curvature kappa."""
    # YOUR CODE HERE
    raise NotImplementedError
