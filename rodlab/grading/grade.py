"""An answer judged: every question asked, every property measured, every classic mistake named; points, and why.

grade(exercise, answer, seed) -> Report: items, each one property of one question, with measured and allowed
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

import numpy as np

from rodlab.grading.exercise import Call, Exercise, Question
from rodlab.grading.sandbox import Stopped
from rodlab.grading.values import Wrong

VISIBLE = 0  # the seed that students see


class Answer(Protocol):
    """What can be asked for the values of its functions: a `Sandbox`, or `Directly` a namespace."""

    @property
    def protections(self) -> str:
        """What it is held by."""

    def ask(self, name: str, calls: Sequence[tuple[Any, ...]], seconds: float | None = None) -> list[Any]:
        """The values for each tuple of arguments; raises `Stopped`."""


@dataclass(frozen=True)
class Item:
    """One property of one question: what was measured, what is allowed, the points, and why not all of them."""

    question: str
    says: str
    score: float
    max_score: float
    measured: float | None
    allowed: float | None
    message: str
    mistake: str = ""
    hint: str = ""
    status: str = ""  # right, mistake, wrong, unanswered, lost
    hidden: bool = False

    @property
    def passed(self) -> bool:
        """True if it has all its points."""
        return self.status == "right"

    @property
    def sentence(self) -> str:
        """The item in one line."""
        hint = f" {self.hint}" if self.hint else ""
        said = f" Classic mistake: {self.mistake}.{hint}" if self.mistake else hint
        return f"{self.question} {self.message}.{said}"


@dataclass(frozen=True)
class Report:
    """All items of an answer to an exercise."""

    exercise: str
    title: str
    items: tuple[Item, ...]
    seed: int
    protections: str

    @property
    def score(self) -> float:
        """Points."""
        return float(sum(item.score for item in self.items))

    @property
    def max_score(self) -> float:
        """Points there are."""
        return float(sum(item.max_score for item in self.items))

    @property
    def percent(self) -> float:
        """Points of a hundred."""
        return 100.0 * self.score / self.max_score

    @property
    def passed(self) -> bool:
        """True if every item has all its points."""
        return all(item.passed for item in self.items)

    @property
    def mistakes(self) -> tuple[str, ...]:
        """The classic mistakes by name, "question: name"."""
        return tuple(dict.fromkeys(f"{item.question}: {item.mistake}" for item in self.items if item.mistake))

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        lines = [f"{self.exercise}: {self.score:g} of {self.max_score:g} points ({self.percent:.0f} %)"]
        for score, most, text in self._lines():
            lines.append(f"  {'ok' if score == most else '--'}  {score:g}/{most:g}  {text}")
        for mistake, hint in dict.fromkeys((item.mistake, item.hint) for item in self.items if item.hint):
            lines.append(f"  hint ({mistake}): {hint}" if mistake else f"  hint: {hint}")
        return "\n".join(lines)

    __repr__ = __str__

    def _lines(self) -> list[tuple[float, float, str]]:
        """Score, points and text; what failed as one whole in one line."""
        lines: dict[str, tuple[float, float]] = {}
        for item in self.items:
            text = f"{item.question} {item.message}{' (fresh parameters)' if item.hidden else ''}"
            score, most = lines.get(text, (0.0, 0.0))
            lines[text] = (score + item.score, most + item.max_score)
        return [(score, most, text) for text, (score, most) in lines.items()]

    def _repr_html_(self) -> str:
        from html import escape

        rows = "".join(
            f"<tr><td>{'&#10003;' if score == most else '&#10007;'}</td><td>{score:g}/{most:g}</td>"
            f"<td style='text-align:left'>{escape(text)}</td></tr>"
            for score, most, text in self._lines()
        )
        hints = "".join(
            f"<p><b>{escape(mistake)}</b>: {escape(hint)}</p>" if mistake else f"<p>{escape(hint)}</p>"
            for mistake, hint in dict.fromkeys((i.mistake, i.hint) for i in self.items if i.hint)
        )
        return f"<b>{escape(self.title)}</b>: {self.score:g} of {self.max_score:g} points<table>{rows}</table>{hints}"


def grade(exercise: Exercise, answer: Answer, *, seed: int | None = None) -> Report:
    """Judge an answer; with a seed, also by the same check on fresh parameters, each part for half of the points.

    >>> from rodlab.grading.directly import Directly
    >>> from rodlab.grading.exercise import Exercise, Mistake, Question
    >>> from rodlab.grading.properties import equals
    >>> from rodlab.grading.values import Number
    >>> twice = Question(name="twice", calls=lambda draw: [(draw.normal(),)], returns=Number(),
    ...     properties=(equals(lambda x: 2 * x),), mistakes=(Mistake("sign", "Which way does it point?", lambda x: -2 * x),))
    >>> exercise = Exercise(title="Twice", source="none", questions=(twice,))
    >>> grade(exercise, Directly({"twice": lambda x: x + x})).percent
    100.0
    >>> grade(exercise, Directly({"twice": lambda x: -x - x})).mistakes
    ('twice: sign',)
    """
    check_seed(seed)
    parts = [(VISIBLE, False)] if seed is None else [(VISIBLE, False), (seed, True)]
    items: list[Item] = []
    for start, hidden in parts:
        for number, question in enumerate(exercise.questions):
            draw = np.random.default_rng([start, number, int(hidden)])
            items += _asked(question, answer, draw, hidden=hidden, share=1.0 / len(parts))
    return Report(exercise.name, exercise.title, tuple(items), VISIBLE if seed is None else seed, answer.protections)


def check_seed(seed: int | None) -> None:
    """`ValueError` in one sentence for what cannot seed fresh parameters."""
    if seed is not None and (not hasattr(seed, "__index__") or seed < 0):
        raise ValueError(f"seed must be a whole number of at least 0; it is {seed!r}")


def _asked(question: Question, answer: Answer, draw: np.random.Generator, *, hidden: bool, share: float) -> list[Item]:
    """The items of one question."""
    calls = _calls(question, draw)
    failed = partial(_failed, question, share, hidden)
    try:
        values = answer.ask(question.name, calls, question.seconds)
    except Stopped as why:
        return failed(str(why), "unanswered" if why.unanswered else "lost")
    given = list(zip(calls, values, strict=True))
    try:
        read = [Call(a, question.returns.read(value, a), question.returns) for a, value in given]
    except Wrong as why:
        return failed(f"returns {why}", *_recognised(question, given))
    measured = [p.measured(read) for p in question.properties]
    right = [m <= p.allowed for m, p in zip(measured, question.properties, strict=True)]
    status, mistake, hint = ("right", "", "") if all(right) else _recognised(question, given)
    items = []
    for p, m, well in zip(question.properties, measured, right, strict=True):
        said = f"{p.says}: {_number(m)} measured, {p.allowed:.1e} allowed" if well else _not(p.says, m, p.allowed)
        state = ("right", "", "") if well else (status, mistake, hint)
        points = share * p.points
        items.append(
            Item(question.name, p.says, points * well, points, _finite(m), p.allowed, said, state[1], state[2], state[0], hidden)
        )
    return items


def _calls(question: Question, draw: np.random.Generator) -> list[tuple[Any, ...]]:
    """The arguments of each call; `ValueError` in one sentence for a question that has none."""
    try:
        calls = list(question.calls(draw))
    except Exception as error:
        raise ValueError(f"the calls of {question.name} cannot be drawn: {type(error).__name__}: {error}") from error
    if not calls or not all(isinstance(given, tuple) for given in calls):
        said = f"such as {calls[0]!r:.60}" if calls else "none"
        raise ValueError(f"the calls of {question.name} must be tuples of arguments, at least one; they are {said}")
    return calls


def _recognised(question: Question, given: list[tuple[tuple[Any, ...], Any]]) -> tuple[str, str, str]:
    """Status, name and hint of the first classic mistake that explains the values."""
    for mistake in question.mistakes:
        if mistake.explains(question.returns, given):
            return "mistake", mistake.name, mistake.hint
    return "wrong", "", ""


def _failed(
    question: Question, share: float, hidden: bool, message: str, status: str, mistake: str = "", hint: str = ""
) -> list[Item]:
    """The items of a question of which nothing could be measured."""
    return [
        Item(question.name, p.says, 0.0, share * p.points, None, p.allowed, message, mistake, hint, status, hidden)
        for p in question.properties
    ]


def _not(says: str, measured: float, allowed: float) -> str:
    return f'fails "{says}": {_number(measured)} measured, {allowed:.1e} allowed'


def _number(x: float) -> str:
    return "no number" if np.isnan(x) else f"{x:.1e}"


def _finite(x: float) -> float | None:
    return float(x) if np.isfinite(x) else None
