"""One method's answers to one question, coarse to fine, and what they say together: order, floor, limit, growth of cost."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from rodlab.lab.studies.asked import Question
from rodlab.lab.studies.every import method_named
from rodlab.lab.studies.methods import powers_apart
from rodlab.mechanics.expression import Expression
from rodlab.numerics.arrays import EPS
from rodlab.numerics.orders import Growth, Limit, Observed, growth, observed_order, richardson

STAGES = 3  # of Richardson's extrapolation that are shown
EXTRAPOLATED = ("strut, end", "strut, trapezoid")  # in several stages: all powers of their errors are known
COSTS = ("solve", "peak_bytes")  # whose growth is told
COUNTED = "index"  # the quantity that is a whole number


@dataclass(frozen=True)
class Series:
    """Answers (m,) of a method at sizes (m,); those of cells that failed are kept apart."""

    question: Question
    method: str
    sizes: tuple[float, ...]
    results: tuple[Mapping[str, Any], ...]

    @property
    def good(self) -> list[tuple[float, Mapping[str, Any]]]:
        """Sizes and answers, of what was answered."""
        return [(n, found) for n, found in zip(self.sizes, self.results, strict=True) if "failed" not in found]

    @property
    def failed(self) -> list[tuple[float, str]]:
        """Sizes and sentences, of what was not."""
        return [(n, found["failed"]) for n, found in zip(self.sizes, self.results, strict=True) if "failed" in found]

    def column(self, name: str) -> list[Any]:
        """One entry of every answer."""
        return [found[name] for _, found in self.good]

    @cached_property
    def order(self) -> int | None:
        """Of theory."""
        return method_named(self.method).order

    @cached_property
    def noise(self) -> list[float]:
        """What of each error is not the method's: rounding, as the method bounds it, and the error of the truth."""
        rounding = [bound if math.isfinite(bound) else 0.0 for bound in self.column("bound")]
        truths = zip(self.column("truth_error"), self.column("truth"), strict=True)
        return [r + e + EPS * abs(v) for r, (e, v) in zip(rounding, truths, strict=True)]

    @cached_property
    def observed(self) -> Observed:
        """The order and the floor that the errors show."""
        sizes = [n for n, _ in self.good]
        if self.order is None or self.question.quantity == COUNTED or len(sizes) < 2:
            return Observed(None, None, (None,) * len(sizes), None, None, None, None)
        return observed_order(sizes, self.column("error"), self.noise, powers_apart(self.method))

    @cached_property
    def _scheme(self) -> tuple[Limit, list[list[float]]]:
        rounding = max(r - e for r, e in zip(self.noise, self.column("truth_error"), strict=True))
        sizes, values, order = [n for n, _ in self.good], self.column("value"), self.order or 1
        stages = None if self.method in EXTRAPOLATED else 1
        if not self.expands:
            change = abs(values[-1] - values[-2]) * max(1.0, 1 / ((sizes[-1] / sizes[-2]) ** order - 1))
            return Limit(values[-1], 2 * change + rounding, 0), [values]
        return richardson(sizes, values, order, powers_apart(self.method), rounding, stages)

    @cached_property
    def expands(self) -> bool:
        """True where the error is a series of powers: a strut's K and u_hat jump at joints, if at all; a rod's at mesh points."""
        if not self.method.startswith("strut"):
            return True
        given = [Expression(f) for f in (self.question.K, self.question.u_hat) if isinstance(f, str)]
        jumps = {b for f in given for b in f.breaks} | set(self.question.breaks)
        return all(abs(b * n - round(b * n)) < 1e-9 for b in jumps for n, _ in self.good)

    @property
    def limit(self) -> Limit | None:
        """Richardson's limit with its estimate, or the last value where errors have no expansion; None of what has no order."""
        told = self.order is not None and self.question.quantity != COUNTED and len(self.good) > 1
        return self._scheme[0] if told else None

    @cached_property
    def extrapolated(self) -> "list[Series]":
        """The columns of Richardson's scheme as methods of their own, each at the cost of all it is made of."""
        if self.limit is None or self.method not in EXTRAPOLATED:
            return []
        return [self._stage(k, column) for k, column in enumerate(self._scheme[1][1 : STAGES + 1], start=1)]

    def _stage(self, k: int, column: Sequence[float]) -> "Series":
        found = []
        for i, value in enumerate(column):
            used = [answer for _, answer in self.good[i : i + k + 1]]
            last = used[-1]
            cost = {name: sum(a["cost"][name] for a in used) for name in ("setup", "solve", "median")}
            peaks = [a["cost"]["peak_bytes"] for a in used]
            cost["peak_bytes"] = None if None in peaks else max(peaks)
            bound = 2 ** (k + 1) * max(a["bound"] for a in used)  # of a first stage three times, of later ones hardly more
            error = abs(value - last["truth"])
            found.append({**last, "value": value, "error": error, "bound": bound, "claimed": None, "cost": cost})
        sizes = tuple(n for n, _ in self.good[k:])
        theory = (self.order or 0) + k * powers_apart(self.method)  # one power of the error is gone a stage
        return Extrapolated(self.question, f"{self.method}, Richardson {k}", sizes, tuple(found), theory)

    @cached_property
    def settled_from(self) -> float | None:
        """Of a whole number: the size from which it is the limit's."""
        wrong = [i for i, error in enumerate(self.column("error")) if error]
        first = wrong[-1] + 1 if wrong else 0
        return self.good[first][0] if first < len(self.good) else None

    @property
    def growth(self) -> dict[str, float | None]:
        """How the cost grows with the number of unknowns: seconds of a solve, and peak memory."""
        told: dict[str, float | None] = {}
        for what in COSTS:
            known: dict[float, float] = {}
            for _, found in self.good:
                cost = found["cost"].get(what)
                if cost:
                    known[found["unknowns"]] = min(cost, known.get(found["unknowns"], math.inf))
            told |= growth_of(known, what)
        return told

    @property
    def floor(self) -> str:
        """Where the errors stop falling, and why; empty where they do not."""
        level, since = self.observed.floor, self.observed.floor_from
        if level is None or since is None:
            return ""
        value = max(abs(v) for v in self.column("value"))
        noise, truth = max(self.noise[since:]), max(self.column("truth_error")[since:])
        said = f"{level:.0e} from {self.good[since][0]:g}"
        if level <= 2 * truth:
            return f"{said}: error of the truth"
        if level <= noise or level <= 4 * EPS * value:
            return f"{said}: rounding, at most {noise:.0e}"
        return f"{said}: more than rounding, at most {noise:.0e}"


@dataclass(frozen=True)
class Extrapolated(Series):
    """A column of Richardson's scheme, with its order of theory. Its limit is that of the whole scheme, told with the strut."""

    theory: int = 0

    @property
    def order(self) -> int:
        """Of theory."""
        return self.theory

    @property
    def limit(self) -> None:
        """None: it is told with the strut."""
        return


def growth_of(costs: Mapping[float, float | None], what: str) -> dict[str, float | None]:
    """Exponent of a cost in the size, its uncertainty and the size it holds from, by names that end in `what`; costs by size."""
    known = {n: cost for n, cost in sorted(costs.items()) if cost}
    grown = growth(list(known), list(known.values())) if known else Growth(None, None, None)
    return {f"{name}_{what}": value for name, value in grown._asdict().items()}


def exponent(cost: Mapping[str, Any], what: str) -> str:
    """How a cost grows, for a table; empty where overhead hides it."""
    found, uncertainty = cost[f"exponent_{what}"], cost[f"uncertainty_{what}"]
    return "" if found is None else f"n^{found:.2f} +- {uncertainty:.2f}"
