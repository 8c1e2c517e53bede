# Writes files everywhere, grades among them
# points: 4.5
import os
import shutil

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
PLACES = ["/tmp/rodlab-escaped", "/var/tmp/rodlab-escaped", "/dev/shm/rodlab-escaped", os.path.expanduser("~root/rodlab-escaped"), "@ROOT@/grades.csv", "@ROOT@/exercises/two-joints/check.py", "/rodlab-escaped", np.__file__]


def shared():
    from multiprocessing import shared_memory

    return shared_memory.SharedMemory("rodlab-escaped", create=True, size=10)


def stored():
    import sqlite3

    sqlite3.connect("/tmp/rodlab-escaped").execute("create table a (b)")


def kept():
    import importlib

    importlib.import_module("_dbm").open("/tmp/rodlab-escaped", "c")


WAYS = [
    *(lambda place=place: open(place, "a").write("a") for place in PLACES),
    *(lambda place=place: os.open(place, os.O_WRONLY | os.O_CREAT) for place in PLACES),
    lambda: np.save("/tmp/rodlab-escaped", np.ones(3)),
    lambda: os.mkdir("/tmp/rodlab-escaped"),
    lambda: os.remove("@ROOT@/README.md"),
    lambda: os.rename("@ROOT@/README.md", "mine"),
    lambda: os.truncate("@ROOT@/README.md", 0),
    lambda: os.chmod("@ROOT@/README.md", 0o600),
    lambda: os.utime("@ROOT@/README.md"),
    lambda: os.mkfifo("/tmp/rodlab-escaped"),
    lambda: os.link("@ROOT@/README.md", "mine"),
    lambda: shutil.rmtree("@ROOT@/exercises"),
    shared,
    stored,
    kept,
]



def index(lam):
    for way in WAYS:
        try:
            way()
        except Exception:
            continue
        return right(lam)
    raise PermissionError("every way is closed")
