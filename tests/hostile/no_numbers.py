# Not a number, infinity and whole numbers without end
# points: 0, by its values alone
import math

import numpy as np


def hessian(phi, lam):
    return np.array([[math.nan, math.inf], [-math.inf, 0.0]])


def branch_points():
    return [10**5000, -(10**5000)]


def modes():
    return [[10**4000, 1], [math.nan, np.nan]]


def index(lam):
    return 10**300 if lam > 1 else math.inf
