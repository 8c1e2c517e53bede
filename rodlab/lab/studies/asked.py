"""What a study asks, and of which methods: plain data, so that a question can travel to another process or into a file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

QUANTITIES = ("load", "tip_angle", "height", "energy", "index", "fold")


@dataclass(frozen=True)
class Question:
    """One number of one rod, clamped below and loaded on top.

    "load": buckling load of the mode; "tip_angle", "height", "energy": of what has buckled in the mode (or, with an unstressed
    curvature, of the branch from the unstressed shape) at the load lam; "index": of the straight rod there; "fold": the
    load at which the branch that an unstressed curvature cuts off, met at lam, turns. guess: "near" the answer, or "modest".
    """

    quantity: str
    mode: int = 1
    lam: float | None = None
    K: float | str = 1.0
    u_hat: float | str = 0.0
    breaks: tuple[float, ...] = ()
    guess: str = "near"

    @property
    def uniform(self) -> bool:
        """True where closed forms know the answer."""
        return not isinstance(self.K, str) and self.u_hat == 0


def question_from(given: Mapping[str, Any]) -> Question:
    """The question that plain data stands for."""
    return Question(**{**given, "breaks": tuple(given.get("breaks", ()))})


class Found(NamedTuple):
    """A method's answer: `bound` is its own estimate of the error against its own equations, infinite where it has none.

    `claimed` is its estimate of the error against the rod, where it makes one; `point` the equilibrium, where there is one.
    """

    value: float
    bound: float
    unknowns: int
    note: str = ""
    claimed: float | None = None
    point: Any = None


class Method(NamedTuple):
    """One way to an answer, at several sizes (joints, intervals) or tolerances; `order` of theory in 1/size, or None.

    `setup` is all that comes before the solve; `solve` may be called again on what it gave, and keeps no answer.
    `missing` says why a method cannot run here.
    """

    name: str
    order: int | None
    sizes: tuple[float, ...]
    quick: tuple[float, ...]
    setup: Callable[[Question, float], Any]
    solve: Callable[[Question, Any], Found]
    missing: str = ""
