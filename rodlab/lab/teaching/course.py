"""The course's exercises: where they are, and the check and the hint of a notebook.

An exercise is a folder with a `check.py`; its name is the folder's. The checker is always the course's own, never one that
lies beside an answer.
"""

import importlib.util
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from rodlab.grading.directly import Directly
from rodlab.grading.exercise import Exercise, faulty
from rodlab.grading.grade import Report, grade
from rodlab.grading.sandbox import Limits, Sandbox
from rodlab.lab.teaching.submissions import answers_in, read

PACKAGE = Path(__file__).resolve().parents[2]


def home() -> Path:
    """The folder of the exercises: in an installed rodlab its own, in a checkout that beside the package."""
    for folder in (PACKAGE / "exercises", PACKAGE.parent / "exercises"):
        if folder.is_dir():
            return folder
    raise ValueError("this installation of rodlab has no exercises; install it from its wheel or a checkout")


def names(course: Path | None = None) -> list[str]:
    """The exercises by name."""
    return sorted(path.parent.name for path in (course or home()).glob("*/check.py"))


def exercise(name: str, course: Path | None = None) -> Exercise:
    """An exercise by its name; `ValueError` in one sentence if there is none of it."""
    known = names(course)
    if not isinstance(name, str) or name not in known:
        from difflib import get_close_matches

        near = get_close_matches(str(name), known, 3) or known[:3]
        raise ValueError(f"exercise must be one of the course's {len(known)}, such as {', '.join(near)}; it is {name!r}")
    return _loaded((course or home()) / name / "check.py")


@cache
def _loaded(path: Path) -> Exercise:
    """The exercise of a checker, with its folder's name."""
    spec = importlib.util.spec_from_file_location(f"rodlab_check_{path.parent.name.replace('-', '_')}", path)
    if spec is None or spec.loader is None:
        raise ValueError(f"{path} cannot be loaded")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
        where = f" (line {lines[-1]})" if lines else ""
        raise ValueError(f"{path} cannot be loaded: it raises {type(error).__name__}: {error}{where}") from error
    found = getattr(module, "exercise", None)
    if not isinstance(found, Exercise):
        raise ValueError(f"{path} must name its Exercise exercise; it is {found!r:.60}")
    if fault := faulty(found):
        raise ValueError(f"{path}: {fault}")
    return replace(found, name=path.parent.name)


def check(name: str, answer: Any = None, *, seed: int | None = None) -> Report:
    """Judge an answer to an exercise.

    Parameters
    ----------
    name : the exercise, `rodlab check` lists them
    answer : the function, where the exercise asks for one; a dictionary of them by name (`globals()` will do), a module or
        any object that has them; or the path of an `answer.py` or a notebook, which then runs in a process of its own
    seed : also check on fresh parameters, drawn from it

    Returns
    -------
    The items with measured and allowed errors, points and hints; true if all are right. `ValueError` for an unknown exercise.

    >>> check("two-joints", {}).score
    0.0
    """
    asked = exercise(name)
    if isinstance(answer, str | Path):
        return check_paths(asked, answers_in(Path(answer)), seed=seed)
    return grade(asked, Directly(_functions(asked, answer)), seed=seed)


def check_source(asked: Exercise, source: str, *, seed: int | None = None, limits: Limits | None = None) -> Report:
    """Judge the text of a submission, in a process of its own."""
    with Sandbox(source, limits, asked.imports) as answer:
        return grade(asked, answer, seed=seed)


def check_paths(asked: Exercise, paths: Sequence[Path], *, seed: int | None = None, limits: Limits | None = None) -> Report:
    """Judge the files of one submission; of a script and a notebook the better one counts."""
    return check_sources(asked, [read(path) for path in paths], seed=seed, limits=limits)


def check_sources(asked: Exercise, sources: Sequence[str], *, seed: int | None = None, limits: Limits | None = None) -> Report:
    """Judge the texts of one submission; the best one counts, the first of equals."""
    reports = [check_source(asked, source, seed=seed, limits=limits) for source in sources]
    return max(reports, key=lambda report: report.score)


def _functions(asked: Exercise, answer: Any) -> Mapping[str, Any]:
    """The answer's functions by the names of the questions."""
    questions = [question.name for question in asked.questions]
    if isinstance(answer, Mapping):
        return answer
    if answer is None:
        return {}
    if isinstance(answer, ModuleType) or any(hasattr(answer, name) for name in questions):
        return {name: getattr(answer, name) for name in questions if hasattr(answer, name)}
    if callable(answer) and len(questions) == 1:
        return {questions[0]: answer}
    if callable(answer) and getattr(answer, "__name__", None) in questions:
        return {answer.__name__: answer}
    wanted = ", ".join(questions)
    raise ValueError(
        f"answer must be functions named {wanted} (a dictionary, a module, globals()) or a path; it is {answer!r:.60}"
    )


class Hint(str):
    """A text that shows itself without quotation marks."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


def hint(name: str, question: str | None = None) -> Hint:
    """What to think of first: the hint of one question of an exercise, or of all. After a check, the report says more.

    >>> "second derivative" in hint("two-joints")
    True
    """
    asked = exercise(name)
    known = [q.name for q in asked.questions]
    if question is not None and question not in known:
        raise ValueError(f"question must be one of {', '.join(known)}; it is {question!r}")
    return Hint("\n".join(f"{q.name}: {q.hint}" for q in asked.questions if question in (None, q.name)))
