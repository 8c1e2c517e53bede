# rodlab exercise: rigid-motion
import numpy as np
from scipy.linalg import expm


def turn(R, u, h):
    """R at the end of a piece, shape (3, 3)."""
    # YOUR CODE HERE
    raise NotImplementedError


def advance(R, u, v, h):
    """r(h) - r(0) in the fixed frame, shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def rod(u, v, h, r0, R0):
    """The places of the ends of all pieces, shape (n + 1, 3)."""
    # YOUR CODE HERE
    raise NotImplementedError
