# rodlab exercise: constant-strain
import numpy as np


def residual(u, n, m):
    """u x n and u x m + e_3 x n, shape (6,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def moment(u, mu, nu):
    """The moment that balances n = nu u, shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError


def strain(K, u_hat, mu, nu):
    """The constant strain, shape (3,)."""
    # YOUR CODE HERE
    raise NotImplementedError
