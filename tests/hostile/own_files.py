# Writes a few files of its own, which it may; the answers are right
# points: 6
import os
import tempfile

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

def index(lam):
    with open("mine.txt", "w") as file:
        file.write(str(right(lam)))
    os.replace("mine.txt", "yours.txt")
    with tempfile.NamedTemporaryFile() as file:
        file.write(b"a")
    os.makedirs("folder", exist_ok=True)
    with open("yours.txt") as file:
        return int(file.read())
