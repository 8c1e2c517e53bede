# Native code by ctypes
# points: 4.5
import ctypes

import numpy as np


def hessian(phi, lam):
    first, second = np.cos(phi)
    return np.array([[2 - lam * first, -1.0], [-1.0, 1 - lam * second]])


def branch_points():
    root = np.sqrt(5)
    return [(3 - root) / 2, (3 + root) / 2]


def modes():
    return [[1.0, 2 - lam] for lam in branch_points()]


def right(lam):
    return int(np.sum(np.linalg.eigvalsh(hessian(np.zeros(2), lam)) < 0))
WAYS = [
    lambda: ctypes.string_at(0),
    lambda: ctypes.CDLL(None).getpid(),
    lambda: ctypes.pythonapi.Py_Exit,
    lambda: ctypes.CDLL("libc.so.6"),
    lambda: ctypes.c_int.from_address(id(1)),
]



def index(lam):
    for way in WAYS:
        try:
            way()
        except Exception:
            continue
        return right(lam)
    raise PermissionError("every way is closed")
