"""Do strut and rod agree at the rule's order, for every term and every end? [N 2.8: the limit of the discrete strut]

One question a case: a measure of an equilibrium, or a buckling load; asked of struts of more and more joints by each rule, and of
the rod for the truth, whose error is said. Order 1 is right for "end", 2 for "trapezoid".
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rodlab.analysis.equilibrium import equilibrium
from rodlab.lab.table import table
from rodlab.mechanics.buckling import buckling
from rodlab.mechanics.expression import Expression
from rodlab.mechanics.joints import RULES
from rodlab.mechanics.recipe import build
from rodlab.numerics.arrays import EPS, number, whole
from rodlab.numerics.orders import Observed, observed_order

ORDERS = dict(zip(RULES, (1, 2), strict=True))
SIZES = (50, 100, 200, 400, 800)
DEGREE = 10  # of the rod that is taken for the truth; another of degree 6 tells its error
OPTIONS = ("name", "model", "ask", "at", "guess")


@dataclass(frozen=True)
class Case:
    """A question with its answer by the rod, the rod's error, and by each rule the struts' distances from it."""

    name: str
    ask: str
    truth: float
    error: float
    sizes: tuple[int, ...]
    distances: dict[str, tuple[float, ...]]
    observed: dict[str, Observed]

    def holds(self, rule: str, within: float = 0.1) -> bool:
        """True where the observed order is the rule's to a tenth."""
        order = self.observed[rule].order
        return order is not None and abs(order - ORDERS[rule]) <= within


def agreement(cases: Sequence[Mapping[str, Any]], sizes: Sequence[int] = SIZES) -> list[Case]:
    """The cases answered. A case: name, model (a recipe without model and n), ask, "buckling load" or a measure of the
    equilibrium `at` a value of what is followed, from `guess`, an expression in s.

    >>> found = agreement([{"name": "a", "model": {"ends": ["clamped", "hinged"], "K": "1+s"}, "ask": "buckling load"}])
    >>> [round(found[0].observed[rule].order, 1) for rule in ("end", "trapezoid")]
    [1.0, 2.0]
    """
    joints = tuple(whole("joints", n, least=4) for n in sizes)
    return [_case(dict(case), joints) for case in cases]


def _case(case: dict[str, Any], sizes: tuple[int, ...]) -> Case:
    wrong = sorted(set(case) - set(OPTIONS))
    if wrong or not {"name", "model", "ask"} <= set(case):
        said = f"{wrong[0]} is none of these" if wrong else "name, model and ask are needed"
        raise ValueError(f"a case takes {', '.join(OPTIONS)}; {said}")
    ask, recipe = _question(case), dict(case["model"])
    truth, error = ask(build({"model": "rod", "degree": DEGREE, **recipe}))
    error += 2 * abs(ask(build({"model": "rod", **recipe}))[0] - truth)
    told = {rule: [ask(build({"n": n, "rule": rule, **recipe})) for n in sizes] for rule in RULES}
    distances = {rule: tuple(abs(value - truth) for value, _ in found) for rule, found in told.items()}
    observed = {
        rule: observed_order(sizes, distances[rule], [error + own for _, own in found], ORDERS[rule])
        for rule, found in told.items()
    }
    said = str(case["ask"]) + (f" at {float(case['at']):g}" if "at" in case else "")
    return Case(str(case["name"]), said, truth, error, sizes, distances, observed)


def _question(case: Mapping[str, Any]) -> Callable[[Any], tuple[float, float]]:
    """What is asked of a model: (answer, its rounding)."""
    if case["ask"] == "buckling load":

        def load(model: Any) -> tuple[float, float]:
            b = buckling(model, 1)
            return float(b.loads[0]), float(b.error[0])

        return load
    at, guess, measure = number("at", case.get("at", 0.0)), case.get("guess"), str(case["ask"])

    def measured(model: Any) -> tuple[float, float]:
        p = equilibrium(model, at, None if guess is None else Expression(str(guess)))
        value = p.measure(measure)
        return value, 64 * EPS * max(1.0, abs(value))

    return measured


def agreement_table(cases: Sequence[Case]) -> str:
    """Every term and every end in one table."""
    rows = []
    for case in cases:
        row = [case.name, case.ask, f"{case.truth:.10g}", f"{case.error:.0e}"]
        for rule in RULES:
            known = case.observed[rule]
            told = "-" if known.order is None else f"{known.order:.3f}"
            row += [f"{case.distances[rule][-1]:.1e}", told + ("" if known.clear else " ?")]
        rows.append(row)
    n = cases[0].sizes[-1]
    columns = ["case", "asked", "rod", "error", *(part for rule in RULES for part in (f"{rule}, n = {n}", "order"))]
    return table("Struts against the rod: distance and observed order", columns, rows)


def of_agreement(cases: Sequence[Case]) -> list[dict[str, Any]]:
    """The same as plain data."""
    return [
        {"name": case.name, "ask": case.ask, "rod": case.truth, "error": case.error, "joints": list(case.sizes)}
        | {rule: {"distance": list(case.distances[rule]), "order": case.observed[rule].order} for rule in RULES}
        for case in cases
    ]
