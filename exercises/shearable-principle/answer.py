# rodlab exercise: shearable-principle
import sympy as sp

K, A_1, A_3, u, u_hat, v_1, v_3 = sp.symbols("K A_1 A_3 u u_hat v_1 v_3")
v_1_hat, v_3_hat, phi, lam = sp.symbols("v_1_hat v_3_hat phi lam")


def density():
    """W: what a unit of length stores, and its part of the load's potential."""
    # YOUR CODE HERE
    raise NotImplementedError


def strains():
    """v_1 and v_3 at an equilibrium, in terms of phi."""
    # YOUR CODE HERE
    raise NotImplementedError


def moment_rate():
    """m' at an equilibrium, in terms of phi, without v_1 and v_3."""
    # YOUR CODE HERE
    raise NotImplementedError
