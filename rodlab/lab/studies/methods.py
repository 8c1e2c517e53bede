"""The house's methods for any question: the strut by its two rules, the rod by collocation, on a given mesh or one that adapts.

strut, end          order 1, errors in powers of h       strut, trapezoid    order 2, of h^2       size: n joints
rod, degree m       order 2m at mesh points                                                        size: N intervals
rod, adapted        the error asked for                                                            size: 1/tol
"""

import math
from functools import partial
from typing import Any

import numpy as np

from rodlab.analysis.equilibrium import equilibrium
from rodlab.lab.studies.asked import Found, Method, Question
from rodlab.lab.studies.reference import load_of, truth, turning
from rodlab.mechanics.buckling import buckling_each, mode_numbers
from rodlab.mechanics.joints import RULES
from rodlab.mechanics.loads import mesh_load
from rodlab.mechanics.rod import HIGHEST, Rod
from rodlab.mechanics.rod_bounds import WIDE
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import EPS, number, whole

ORDER = {"end": 1, "trapezoid": 2}
JOINTS = tuple(2**i for i in range(2, 18))
INTERVALS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 128, 256, 512)
TOLERANCES = tuple(10.0**-i for i in range(2, 13))


def house_method(name: str) -> Method:
    """A method by its name. `ValueError`, in one sentence, for a name that is none.

    >>> house_method("rod, degree 3").order
    6
    """
    kind, _, which = name.partition(", ")
    if kind == "strut" and which in RULES:
        return Method(name, ORDER[which], JOINTS, JOINTS[2:14:2], partial(_strut, which), _solved)
    if name == "rod, adapted":
        return Method(name, None, TOLERANCES, TOLERANCES[::3], _adapted, _solved)
    word, _, degree = which.partition(" ")
    if kind == "rod" and word == "degree" and degree.isdecimal() and 1 <= int(degree) <= HIGHEST:
        return Method(name, 2 * int(degree), INTERVALS, INTERVALS[1:10:2], partial(_rod, int(degree)), _solved)
    known = [*(f"strut, {rule}" for rule in RULES), f"rod, degree 1 .. {HIGHEST}", "rod, adapted"]
    raise ValueError(f"a method must be one of {'; '.join(known)}; it is {name!r:.60}")


def powers_apart(name: str) -> int:
    """How far apart the powers of 1/size in a method's error are."""
    return 1 if name.startswith("strut, ") and "end" in name.replace('"', "").split(", ") else 2


def _strut(rule: str, question: Question, size: float) -> Any:
    n = whole("n", int(size), least=1)
    return _ready(question, Strut(n=n, K=question.K, u_hat=question.u_hat, rule=rule, breaks=question.breaks))


def _rod(degree: int, question: Question, size: float) -> Any:
    N = whole("intervals", int(size), least=1)
    return _ready(question, Rod(K=question.K, u_hat=question.u_hat, breaks=question.breaks, degree=degree, mesh=N))


def _adapted(question: Question, size: float) -> Any:
    tol = number("tol", size, above=0.0)
    return _ready(question, Rod(K=question.K, u_hat=question.u_hat, breaks=question.breaks, tol=tol))


def _ready(question: Question, model: Any) -> Any:
    """The model, and a guess of its shape where one is needed."""
    if question.quantity not in ("tip_angle", "height", "energy"):
        return model, None
    if question.guess == "near":
        return model, truth(question).shape
    wave = (2 * question.mode - 1) * math.pi / 2
    return model, lambda s: 2 * np.sin(wave * s)


def _solved(question: Question, ready: Any) -> Found:
    model, guess = ready
    if question.quantity == "load":
        load, bound = _load(model, question.mode)
        return Found(load, bound, unknowns(model))
    if question.quantity == "fold":
        event = turning(question, model)
        return Found(event.lam, event.error, int(event.point.u.size), point=event.point)
    p = equilibrium(model, load_of(question), guess)
    size = int(p.u.size)
    if question.quantity == "index":
        note = "" if p.index_verified else "the index is not verified"
        return Found(float(p.index or 0), 0.0 if p.index_verified else math.inf, size, note)
    return Found(p.measure(question.quantity), math.nan, size, point=p)


def _load(model: Strut | Rod, mode: int) -> tuple[float, float]:
    if isinstance(model, Rod) and not model.adapts:
        return mesh_load(model, mode)
    return next(buckling_each(model, mode_numbers(model, [mode])))


def unknowns(model: Strut | Rod) -> int:
    """Numbers solved for."""
    return model.n if isinstance(model, Strut) else model.size


def _elsewhere(question: Question, p: Any) -> bool:
    """True where a shape is nearer to another equilibrium, the straight one perhaps, than to the one that is asked for."""
    shape = truth(question).shape
    if shape is None:
        return False
    known = np.asarray(shape(p.s))
    return bool(np.abs(p.phi - known).max() > 0.5 * np.abs(known).max())


def estimates(question: Question, found: Found) -> Found:
    """An answer with the errors that its point knows; apart from the solve, as they take time of their own.

    Rounding of the tip angle is bounded by the adjoint; that of height and energy is estimated from it and from their terms.
    """
    p = found.point
    if p is None or not isinstance(p.equations, Strut | Rod):
        return found
    if question.quantity == "fold":
        own = 4 * EPS * abs(found.value)
        return found if isinstance(p.equations, Strut) else found._replace(bound=own, claimed=found.bound)
    if _elsewhere(question, p):
        return found._replace(note="wrong: another equilibrium, far from the shape asked for")
    struts = isinstance(p.equations, Strut)
    angle = p.error if struts else abs(p.tip_angle) * (EPS + WIDE * p.measure("condition"))
    rounding = {"tip_angle": angle, "height": angle + 4 * EPS, "energy": 4 * EPS * (abs(found.value) + 2 * abs(p.lam))}
    claimed = p.error if question.quantity == "tip_angle" and not struts else None
    return found._replace(bound=rounding[question.quantity], claimed=claimed)
