"""An exercise: questions, each a function to write; what its values must satisfy; the classic mistakes, each with a hint.

question -> calls drawn from a seed -> values -> properties: measured and allowed -> points
                                              -> mistakes:   which wrong answer are these values?
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rodlab.grading.values import Kind


@dataclass(frozen=True)
class Call:
    """One call of an answer: its arguments and its value, read as the question's kind."""

    arguments: tuple[Any, ...]
    value: Any
    kind: Kind

    def off(self, other: Any) -> float:
        """Relative distance of the value from another one."""
        return float(self.kind.distance(self.value, other))


@dataclass(frozen=True)
class Property:
    """What must hold: a sentence, the number that measures it over all calls, and how large that may be."""

    says: str
    measure: Callable[[Sequence[Call]], float]
    allowed: float
    points: float = 1.0

    def measured(self, calls: Sequence[Call]) -> float:
        """The number; NaN, which is never allowed, where the values do not even let it be computed."""
        with np.errstate(all="ignore"):
            try:
                return float(self.measure(calls))
            except Exception:  # noqa: BLE001 the values may be anything
                return float("nan")


@dataclass(frozen=True)
class Mistake:
    """A classic mistake: `like` gives what one who makes it returns, or `when` recognises it in the values.

    `like(*arguments)` may have another shape than the right answer has. `hint` says where to look, not what to write.
    """

    name: str
    hint: str
    like: Callable[..., Any] | None = None
    when: Callable[[Sequence[tuple[tuple[Any, ...], Any]]], bool] | None = None
    within: float = 1e-6

    def explains(self, kind: Kind, given: Sequence[tuple[tuple[Any, ...], Any]]) -> bool:
        """True if all values, as they came, are those of this mistake."""
        with np.errstate(all="ignore"):
            try:
                if self.when is not None:
                    return bool(self.when(given))
                return all(self._near(kind, arguments, value) for arguments, value in given)
            except Exception:  # noqa: BLE001 the values may be anything
                return False

    def _near(self, kind: Kind, arguments: tuple[Any, ...], value: Any) -> bool:
        other = self.like(*arguments) if self.like is not None else None
        free = getattr(kind, "loose", kind)  # a mistake may have another shape
        return bool(free.distance(free.read(value, arguments), other) <= self.within)


@dataclass(frozen=True, kw_only=True)
class Question:
    """One function to write.

    Parameters
    ----------
    name : the function's name
    calls : `calls(draw)` gives the arguments of each call, drawn by a numpy Generator
    returns : the kind of its values
    properties : what the values must satisfy
    mistakes : classic mistakes, the first that explains the values is named
    hint : what `rl.hint` says
    seconds : wall-clock time for all calls
    """

    name: str
    calls: Callable[[np.random.Generator], Iterable[tuple[Any, ...]]]
    returns: Kind
    properties: tuple[Property, ...]
    mistakes: tuple[Mistake, ...] = ()
    hint: str = ""
    seconds: float = 10.0

    @property
    def points(self) -> float:
        """Points of all its properties."""
        return sum(p.points for p in self.properties)


@dataclass(frozen=True, kw_only=True)
class Exercise:
    """An exercise: a title, the section of the notes it belongs to, its questions, and modules that its answers import.

    `name` is given when it is loaded: that of its folder.
    """

    title: str
    source: str
    questions: tuple[Question, ...]
    imports: tuple[str, ...] = ("numpy",)
    name: str = field(default="")

    @property
    def points(self) -> float:
        """Points of all its questions."""
        return sum(q.points for q in self.questions)


def faulty(exercise: Exercise) -> str | None:
    """What a teacher forgot, in one sentence; None if nothing."""
    for each, kind, what in ((exercise.questions, Question, "questions"), (exercise.imports, str, "imports")):
        if not isinstance(each, tuple | list) or not all(isinstance(one, kind) for one in each):
            return f"{what} must be a tuple of {kind.__name__}, such as (a,) for one; it is {each!r:.60}"
    names = [question.name for question in exercise.questions]
    if not names or len(set(names)) < len(names):
        return f"questions must be at least one, of different names; they are {names}"
    return next(filter(None, map(_faulty_question, exercise.questions)), None)


def _faulty_question(question: Question) -> str | None:
    name = question.name
    if not isinstance(name, str) or not name.isidentifier():
        return f"a question's name must be that of a function; it is {name!r:.60}"
    if not callable(question.calls):
        return f"{name}: calls must be a function of a Generator; it is {question.calls!r:.60}"
    if isinstance(question.returns, type) or not all(hasattr(question.returns, method) for method in ("read", "distance")):
        return f"{name}: returns must be a kind of value, such as Number(); it is {question.returns!r:.60}"
    for each, kind, what in ((question.properties, Property, "properties"), (question.mistakes, Mistake, "mistakes")):
        if not isinstance(each, tuple | list) or not all(isinstance(one, kind) for one in each):
            return f"{name}: {what} must be a tuple of {kind.__name__}, such as (a,) for one; it is {each!r:.60}"
    if not question.properties:
        return f"{name}: properties must be at least one; there is none"
    for one in question.properties:
        for what, value, least in (("points", one.points, 1e-9), ("allowed", one.allowed, 0.0)):
            if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value < math.inf:
                return f'{name}: {what} of the property "{one.says}" must be a positive number; it is {value!r:.60}'
    for mistake in question.mistakes:
        if not callable(mistake.like) and not callable(mistake.when):
            return f'{name}: the mistake "{mistake.name}" must have a function like or when'
    return None
