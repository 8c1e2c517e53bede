# rodlab exercise: end-torque
import numpy as np
from scipy.integrate import quad


def angle(s, K, u_hat, tau):
    """phi at the arclengths s (shape (k,)), radians, an array of shape (k,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def torque(tip, K, u_hat):
    """The end torque that turns the end to the angle tip (radians), a number."""
    # YOUR CODE HERE
    raise NotImplementedError


def excess(slope, K, u_hat, tau):
    """By how much the energy of phi + eta, eta' = slope, exceeds that of the equilibrium phi, a number."""
    # YOUR CODE HERE
    raise NotImplementedError
