# rodlab exercise: shear-buckling
import numpy as np


def buckles(j, A_1, A_3):
    """True if mode j has a positive load."""
    # YOUR CODE HERE
    raise NotImplementedError


def load(j, A_1, A_3):
    """The smallest positive load of mode j, a number; only asked for where there is one."""
    # YOUR CODE HERE
    raise NotImplementedError


def least_stiffness(j):
    """The smallest A_3 for which an unshearable rod has a load of mode j, a number."""
    # YOUR CODE HERE
    raise NotImplementedError
