# Other shapes and types of numbers than were asked for
# points: 0, by its values alone
import numpy as np


def hessian(phi, lam):
    return np.zeros((2, 2, 1)) if lam > 1 else np.array([[1 + 1j, 0], [0, 1]])


def branch_points():
    return np.array(["a", None, {}], dtype=object)


def modes():
    return [[1.0], [1.0, 2.0]]


def index(lam):
    return [0, 1, 2] if lam > 1 else True
