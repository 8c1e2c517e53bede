"""The course's exercises: where they are, how an answer to one is read, and the check and the hint of a notebook.

An exercise is a folder with a `check.py`; its name is the folder's. The checker is always the course's own, never one that
lies beside an answer.
"""

import ast
import importlib.util
import json
import re
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from rodlab.grading.directly import Directly
from rodlab.grading.exercise import Exercise
from rodlab.grading.grade import Report, grade
from rodlab.grading.sandbox import Limits, Sandbox

PACKAGE = Path(__file__).resolve().parents[1]
HEADER = re.compile(r"^#\s*rodlab exercise:\s*([\w-]+)\s*$", re.MULTILINE)
LONGEST = 2**20  # bytes of a submission


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
    if name not in known:
        from difflib import get_close_matches

        near = get_close_matches(name, known, 3) or known[:3]
        raise ValueError(f"exercise must be one of the course's {len(known)}, such as {', '.join(near)}; it is {name!r}")
    return _loaded((course or home()) / name / "check.py")


@cache
def _loaded(path: Path) -> Exercise:
    """The exercise of a checker, with its folder's name."""
    spec = importlib.util.spec_from_file_location(f"rodlab_check_{path.parent.name.replace('-', '_')}", path)
    if spec is None or spec.loader is None:
        raise ValueError(f"{path} cannot be loaded")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found = getattr(module, "exercise", None)
    if not isinstance(found, Exercise):
        raise ValueError(f"{path} must name its Exercise exercise; it is {found!r:.60}")
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
        return check_source(asked, read(Path(answer)), seed=seed)
    return grade(asked, Directly(_functions(asked, answer)), seed=seed)


def check_source(asked: Exercise, source: str, *, seed: int | None = None, limits: Limits | None = None) -> Report:
    """Judge the text of a submission, in a process of its own."""
    with Sandbox(source, limits, asked.imports) as answer:
        return grade(asked, answer, seed=seed)


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


def read(path: Path) -> str:
    """The Python of a submission: a .py file, or the code cells of a notebook without its magic lines."""
    try:
        if path.stat().st_size > LONGEST:
            raise ValueError(f"{path} must be a submission of at most {LONGEST} bytes; it has {path.stat().st_size}")
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ValueError(f"{path} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise ValueError(f"{path} must be a text in UTF-8; it is not") from None
    return _cells(path, text) if path.suffix == ".ipynb" else text


def _cells(path: Path, text: str) -> str:
    try:
        cells = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
        sources = ["".join(cell["source"]) for cell in cells]
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ValueError(f"{path} must be a notebook; it cannot be read as one") from None
    kept = ["\n".join(line for line in text.splitlines() if not line.lstrip().startswith(("%", "!"))) for text in sources]
    return "\n\n".join(text for text in kept if not _only_checks(text))


def _only_checks(text: str) -> bool:
    """True for a cell that imports rodlab or calls it, which is not part of an answer."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return bool(tree.body) and all(_of_rodlab(node) for node in tree.body)


def _of_rodlab(node: ast.stmt) -> bool:
    match node:
        case ast.Import(names=[ast.alias(name="rodlab")]):
            return True
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="rl"), attr="check" | "hint"))):
            return True
    return False


def named(path: Path, source: str) -> str | None:
    """The exercise that a submission says it is for, or that its file or folder is named after; None if neither."""
    if found := HEADER.search(source):
        return found[1]
    known = set(names())
    return next((name for name in (path.stem, path.parent.name) if name in known), None)
