"""Equilibria before and after buckling: the straight strut and its buckled shapes, found by Newton's method."""

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.mechanics.buckling import Buckling
from rodlab.mechanics.strut import Strut

FIRST = 1.02  # load of the first buckled guess over the buckling load
RATIO = 1.2  # greatest ratio of one load to the next on the way up
GROWTH = 1.5  # greatest ratio of their excess over the buckling load


@dataclass(frozen=True)
class Found:
    """An equilibrium, the branch it is on ("straight", "mode 1", ...) and the run time of finding it."""

    branch: str
    point: Point
    seconds: float


def straight(strut: Strut, load: float) -> Found:
    """The straight equilibrium."""
    start = time.perf_counter()
    point = equilibrium(strut, load)
    return Found("straight", point, time.perf_counter() - start)


def buckled(buckling: Buckling, mode: int, loads: Sequence[float]) -> Iterator[Found]:
    """The shape that buckled in a mode, at ascending loads above the mode's own; each grown from the last.

    The first guess is the mode with the amplitude of its expansion, lam = lam_j (1 + alpha^2 / 8 + ...).
    Raises `NoConvergence` when Newton's method leaves the branch, told by the sign changes of the angle.
    """
    strut, own = buckling.strut, float(buckling.loads[buckling.numbers.index(mode)])
    guess, load = math.sqrt(8 * (FIRST - 1)) * buckling.modes[buckling.numbers.index(mode)], FIRST * own
    for target in loads:
        start = time.perf_counter()
        if not target > own:
            raise ValueError(f"loads must be above the load of mode {mode}, {own:g}; one is {target:g}")
        while True:
            last, load = load, min(target, load * RATIO, own + GROWTH * (load - own))
            if load < RATIO * own:
                guess = guess * math.sqrt((load - own) / (last - own))
            point = equilibrium(strut, load, guess)
            if sign_changes(point.u) != mode - 1 or abs(point.tip_angle) < 1e-3:
                raise NoConvergence(f"the branch of mode {mode} was lost at load {load:g}", point.newton)
            guess = point.u
            if load == target:
                break
        yield Found(f"mode {mode}", point, time.perf_counter() - start)


def sign_changes(phi: np.ndarray) -> int:
    """How often the angle changes its sign along the strut.

    >>> sign_changes(np.array([0.1, 0.0, -0.2, -0.1, 0.3]))
    2
    """
    signs = np.sign(phi)
    signs = signs[signs != 0]
    return int(np.count_nonzero(signs[1:] != signs[:-1]))
