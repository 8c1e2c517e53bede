"""One method's answer to one question at one size, with its error and its cost: the cell of convergence and of work-precision."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from rodlab.lab.studies.asked import Found, question_from
from rodlab.lab.studies.costs import spent
from rodlab.lab.studies.every import method_named
from rodlab.lab.studies.methods import estimates
from rodlab.lab.studies.reference import truth

DRAWN = 65  # places of a stored shape


def one(
    question: Mapping[str, Any], method: str, size: float, repeats: int = 1, memory: bool = False, shape: bool = False
) -> dict[str, Any]:
    """Value, truth, error, the method's bound and claim, unknowns, and what it cost."""
    asked, known = question_from(question), method_named(method)
    if known.missing:
        raise ValueError(known.missing)
    true = truth(asked)
    found, cost = spent(lambda: known.setup(asked, size), lambda ready: known.solve(asked, ready), repeats, memory=memory)
    if not math.isfinite(found.value):
        return {"failed": found.note, "cost": cost}
    found = estimates(asked, found)
    if found.note.startswith("wrong"):
        return {"failed": found.note, "cost": cost}
    answer = {
        "value": float(found.value), "truth": true.value, "truth_error": true.error, "source": true.source,
        "error": abs(float(found.value) - true.value), "bound": float(found.bound), "claimed": found.claimed,
        "unknowns": int(found.unknowns), "note": found.note, "cost": cost,
    }  # fmt: skip
    return {**answer, "shape": _shape(found)} if shape and found.point is not None else answer


def _shape(found: Found) -> dict[str, list[float]]:
    """s, phi, x, z at no more places than are drawn."""
    p = found.point
    own = p if p.s.size <= DRAWN else p(np.linspace(0, 1, DRAWN) * p.s[-1])
    return {name: [float(value) for value in getattr(own, name)] for name in ("s", "phi", "x", "z")}
