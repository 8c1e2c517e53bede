# More files and folders in its own folder than are allowed, and one too large
# points: 4.5
import os

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

def many():
    for i in range(1000):
        open(f"file{i}", "w").close()


def deep():
    path = "."
    for _ in range(1000):
        path += "/d"
        os.mkdir(path)


def large():
    import signal

    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    with open("large", "wb") as file:
        for _ in range(100):
            file.write(b"x" * 10**6)


WAYS = [large, deep, many]



def index(lam):
    for way in WAYS:
        try:
            way()
        except Exception:
            continue
        return right(lam)
    raise PermissionError("every way is closed")
