"""The truth beside an answer: exact where a closed form is known, else a rod collocated to twelve digits, with its error.

load        ((2j-1) pi/2)^2 K                              or Sturm and Liouville's problem, with its bound
tip angle, height, energy        the exact elastica        or a rod of degree 10, against one of degree 14
index       loads below lam                                or the rod's, if it is verified
fold                                                       the rod's, degree 10 against 14
"""

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.events import fold
from rodlab.analysis.follow import follow
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.lab.branches import mode_starts
from rodlab.lab.studies.asked import Question
from rodlab.mechanics.buckling import buckling_each
from rodlab.mechanics.elastica import elastica
from rodlab.mechanics.rod import Rod
from rodlab.numerics.arrays import EPS

DEGREE, MORE = 10, 4
TOL = 1e-12
PLACES = 65  # of a shape that a guess is made of


class Truth(NamedTuple):
    """Value, bound or estimate of its error, where it is from, and phi(s) where there is a shape."""

    value: float
    error: float
    source: str
    shape: Callable[[Any], Any] | None = None


def exact_load(mode: int, K: float = 1.0) -> float:
    """((2j - 1) pi / 2)^2 K, the load of the uniform rod [N 2.8.1].

    >>> exact_load(1)
    2.4674011002723395
    """
    return ((2 * mode - 1) * math.pi / 2) ** 2 * K


def loads_below(lam: float, K: float = 1.0) -> int:
    """How many loads of the uniform rod are below lam: the index of the straight one.

    >>> loads_below(300.0), loads_below(1.0)
    (6, 0)
    """
    most = 2 + int(math.sqrt(max(lam, 0.0) / K) / math.pi)
    return sum(exact_load(j, K) < lam for j in range(1, most + 1))


@lru_cache(maxsize=32)
def truth(question: Question) -> Truth:
    """What is true. Raises `ValueError` for a question that has no answer, `NoConvergence` where none could be computed."""
    if question.quantity == "load":
        return _load(question)
    if question.quantity == "index":
        return _index(question)
    if question.quantity == "fold":
        return _fold(question)
    return _elastica(question) if question.uniform else _state(question)


def rod(question: Question, degree: int = DEGREE) -> Rod:
    """The rod asked about, on a mesh that adapts."""
    return Rod(K=question.K, u_hat=question.u_hat, breaks=question.breaks, degree=degree, tol=TOL)


def _load(question: Question) -> Truth:
    if question.uniform:
        load = exact_load(question.mode, float(question.K))
        return Truth(load, 4 * EPS * load, "closed form")
    ((load, error),) = buckling_each(rod(question), (question.mode,))
    return Truth(load, error, "Sturm and Liouville's problem, collocated")


def _index(question: Question) -> Truth:
    lam = load_of(question)
    if question.uniform:
        return Truth(float(loads_below(lam, float(question.K))), 0.0, "loads below lam")
    p = equilibrium(rod(question), lam)
    if not p.index_verified:
        raise NoConvergence(f"the index of {p.equations!r} at {lam:g} could not be verified", ())
    return Truth(float(p.index or 0), 0.0, "the rod's second variation")


def _elastica(question: Question) -> Truth:
    exact, s = elastica(load_of(question), question.mode, float(question.K)), np.linspace(0, 1, PLACES)
    value = exact.measure(question.quantity)
    return Truth(value, exact.error + 2 * EPS * abs(value), "exact elastica", CubicSpline(s, exact(s).phi))


def _state(question: Question) -> Truth:
    coarse = bent(question, rod(question))
    fine = equilibrium(rod(question, DEGREE + MORE), coarse.lam, lambda s: coarse(s).phi)
    value, s = fine.measure(question.quantity), np.linspace(0, 1, PLACES)
    error = 2 * abs(value - coarse.measure(question.quantity)) + 8 * EPS * abs(value)
    error = max(error, fine.error) if question.quantity == "tip_angle" else error
    return Truth(value, error, f"rod of degree {DEGREE + MORE}, mesh adapted", CubicSpline(s, fine(s).phi))


def _fold(question: Question) -> Truth:
    coarse, fine = (turning(question, rod(question, degree)) for degree in (DEGREE, DEGREE + MORE))
    error = max(coarse.error, fine.error, 2 * abs(coarse.lam - fine.lam))
    return Truth(fine.lam, error, f"rod of degree {DEGREE + MORE}, mesh adapted")


def load_of(question: Question) -> float:
    """The load, which every quantity but a buckling load needs."""
    if question.lam is None:
        raise ValueError(f"lam must be given for {question.quantity}; it is missing")
    return question.lam


def bent(question: Question, model: Any) -> Point:
    """The model's equilibrium on the branch asked for, followed there from its branch point or from the unstressed shape."""
    lam = load_of(question)
    if model.is_straight:
        branch = follow(mode_starts(model, question.mode)[0], to=lam)
    else:
        branch = follow(equilibrium(model, 0.0), to=lam)
    if branch.points[-1].lam != lam:
        raise NoConvergence(f"the branch of {model!r} could not be followed to {lam:g}: {branch.reason}", ())
    return branch.points[-1]


def turning(question: Question, model: Any) -> Any:
    """The fold of the branch that the unstressed curvature cuts off, followed down from the load lam."""
    lam = load_of(question)
    for side in (-1, 1):  # bent against its curvature, whichever way that goes
        start = equilibrium(model, lam, lambda s, side=side: 2 * side * np.sin(np.pi * s / 2))
        branch = follow(start, to=0.0, events=fold)
        found = [event for event in branch.events if event.kind == "fold"]
        if found:
            return found[0]
    raise NoConvergence(f"no fold of {model!r} was met below {lam:g}: {branch.reason}", ())
