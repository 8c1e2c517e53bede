"""Submissions: the Python in a script or a notebook, the exercise it is for, and all those of a class in a folder.

    DIR/STUDENT/EXERCISE/answer.py    DIR/STUDENT/EXERCISE.ipynb    DIR/STUDENT.py (with its header, or --exercise)

Links are not followed: one could point at the solutions.
"""

import ast
import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

HEADER = re.compile(r"^#\s*rodlab exercise:\s*([\w-]+)\s*$", re.MULTILINE)
LONGEST = 2**20  # bytes
SUFFIXES = (".py", ".ipynb")


@dataclass(frozen=True)
class Submission:
    """What one student hands in for one exercise; of a script and a notebook the better one counts."""

    student: str
    exercise: str
    paths: tuple[Path, ...]


def read(path: Path) -> str:
    """The Python of a submission: a .py file, or the code cells of a notebook without its magic lines."""
    try:
        if path.is_symlink():
            raise ValueError(f"{path} must be a file; it is a link")
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


def named(path: Path, known: Iterable[str]) -> str | None:
    """The exercise that a submission says it is for, or that its file or folder is named after; None if neither."""
    known = set(known)
    try:
        found = HEADER.search(read(path))
    except ValueError:
        found = None
    return next((name for name in (found and found[1], path.stem, path.parent.name) if name in known), None)


def answers_in(path: Path) -> list[Path]:
    """The files of one submission: a file itself, or a folder's answer.py and answer.ipynb, or its only file of that kind."""
    if path.is_dir():
        there = sorted(file for file in path.iterdir() if file.suffix in SUFFIXES and file.name != "check.py")
        found = [file for file in there if file.stem == "answer"] or there
        if len(found) not in (1, 2) or (len(found) == 2 and found[0].stem != found[1].stem):
            raise ValueError(f"{path} must hold an answer.py or an answer.ipynb; it holds {len(there)} such files of other names")
        return found[::-1]  # the script first
    if path.suffix not in SUFFIXES:
        raise ValueError(f"a submission must be a .py or .ipynb file, or the folder of one; it is {path}")
    return [path]


def submissions(folder: Path, known: Iterable[str], only: str | None = None) -> list[Submission]:
    """All submissions of a class, sorted; `only` takes files that name no exercise for this one and leaves out the others.

    What is for no exercise of the course comes with the exercise "": it is not lost.
    """
    if not folder.is_dir():
        raise ValueError(f"class must be a folder of submissions; it is {folder}")
    known, found = set(known), dict[tuple[str, str], list[Path]]()
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder)
        if path.suffix not in SUFFIXES or path.name == "check.py" or any(part.startswith((".", "__")) for part in inside.parts):
            continue
        student = inside.parts[0] if len(inside.parts) > 1 else path.stem
        exercise = named(path, known) or only or ""
        if path.is_file() and (only is None or exercise == only):
            found.setdefault((student, exercise), []).append(path)
    return [Submission(student, exercise, tuple(paths)) for (student, exercise), paths in sorted(found.items())]
