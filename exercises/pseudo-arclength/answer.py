# rodlab exercise: pseudo-arclength
import numpy as np


def tangent(phi, lam, previous):
    """The unit tangent of the curve of equilibria that goes on in the direction previous."""
    # YOUR CODE HERE
    raise NotImplementedError


def step(phi, lam, beta, t, length):
    """The next point (phi, lam)."""
    # YOUR CODE HERE
    raise NotImplementedError


def branch(phi, lam, beta, direction, length, count):
    """The start and count more points of the branch, one a row."""
    # YOUR CODE HERE
    raise NotImplementedError
