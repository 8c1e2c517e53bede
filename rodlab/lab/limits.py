"""The tour's two small studies: buckling loads as n grows, and three routes to one tip angle, strut, rod and elastica.

Questions, methods and what their answers say together are those of the study of convergence; here they are asked at once.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from rodlab.lab.studies.asked import Question
from rodlab.lab.studies.measured import one
from rodlab.lab.studies.series import Series
from rodlab.mechanics.joints import RULES

DEGREES = (1, 2, 3, 4)


def measured(question: Question, method: str, sizes: Sequence[int]) -> Series:
    """A method's answers at ascending sizes.

    >>> found = measured(Question("load"), "strut, trapezoid", (8, 16, 32))
    >>> round(found.observed.order, 2), bool(abs(found.limit.value - 2.4674011003) <= found.limit.estimate)
    (2.0, True)
    """
    return Series(question, method, tuple(sizes), tuple(one(vars(question), method, n) for n in sizes))


def loads_against_n(sizes: Sequence[int], modes: Sequence[int]) -> Iterator[Series]:
    """The loads of some modes by both rules."""
    yield from (measured(Question("load", mode), f"strut, {rule}", sizes) for rule in RULES for mode in modes)


def routes(lam: float, joints: Sequence[int], intervals: Sequence[int]) -> Iterator[Series]:
    """The tip angle of the first mode by every method: struts of so many joints, rods of so many intervals."""
    question = Question("tip_angle", lam=lam)
    yield from (measured(question, f"strut, {rule}", joints) for rule in RULES)
    yield from (measured(question, f"rod, degree {degree}", intervals) for degree in DEGREES)


def rule_of(series: Series) -> str:
    """Of a strut's series."""
    return series.method.partition(", ")[2]


def rows_of_loads(every: Sequence[Series]) -> list[dict[str, Any]]:
    """One load a row."""
    return [
        {
            "rule": rule_of(series), "mode": series.question.mode, "n": n, "load": found["value"], "bound": found["bound"],
            "limit": found["truth"], "seconds": found["cost"]["solve"], "order": order, "error": found["error"],
        }
        for series in every
        for (n, found), order in zip(series.good, series.observed.local, strict=True)
    ]  # fmt: skip


def rows_of_limits(every: Sequence[Series]) -> list[dict[str, Any]]:
    """The extrapolated limit of each mode and rule, with its estimate and its true error."""
    rows = []
    for series in every:
        limit, truth = series.limit, series.column("truth")[0]
        if limit is not None:
            told = {"rule": rule_of(series), "mode": series.question.mode, "load": limit.value, "estimate": limit.estimate}
            rows.append({**told, "limit": truth, "error": abs(limit.value - truth)})
    return rows


def rows_of_routes(every: Sequence[Series]) -> list[dict[str, Any]]:
    """One tip angle a row; `estimate` is the method's own, of a strut against its own equations, not the limit."""
    return [
        {
            "method": series.method, "order": series.order, "unknowns": found["unknowns"], "tip_angle": found["value"],
            "estimate": found["bound"] if found["claimed"] is None else found["claimed"], "error": found["error"],
            "seconds": found["cost"]["solve"], "observed": order,
        }
        for series in every
        for (_, found), order in zip(series.good, series.observed.local, strict=True)
    ]  # fmt: skip
