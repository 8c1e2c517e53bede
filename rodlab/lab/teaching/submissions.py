"""Submissions: the Python in a script or a notebook, the exercise it is for, and all those of a class in a folder.

    DIR/STUDENT/EXERCISE/answer.py    DIR/STUDENT/EXERCISE.ipynb    DIR/STUDENT.py (with its header, or --exercise)

Links are not followed: one could point at the solutions.
"""

import ast
import json
import re
import stat
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

HEADER = re.compile(r"^#\s*rodlab exercise:\s*([\w-]+)\s*$", re.MULTILINE)
LONGEST = {".py": 2**20, ".ipynb": 2**25}  # bytes; a notebook may have pictures in it
SUFFIXES = (".py", ".ipynb")
FACES = ("check", "hint")
MAGIC = re.compile(r"\s*([%!?]|[\w.]+\?+\s*$|[\w., ]+=\s*[%!])")  # %time, !ls, ?f, f?, files = !ls
CELL_MAGIC = re.compile(r"\s*%%(\w*)")
AROUND_PYTHON = ("time", "timeit", "capture", "prun")


@dataclass(frozen=True)
class Submission:
    """What one student hands in for one exercise; of a script and a notebook the better one counts."""

    student: str
    exercise: str
    paths: tuple[Path, ...]


def read(path: Path) -> str:
    """The Python of a submission: a .py file, or the code cells of a notebook without its magic lines."""
    most = LONGEST.get(path.suffix, LONGEST[".py"])
    try:
        if path.is_symlink():
            raise ValueError(f"{path.name} must be a file; it is a link")
        there = path.stat()
        if not stat.S_ISREG(there.st_mode):  # a pipe would be waited for, a device may have no end
            raise ValueError(f"{path.name} must be a file; it is none")
        if there.st_size > most:
            raise ValueError(f"{path.name} must be a submission of at most {most} bytes; it has {there.st_size}")
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ValueError(f"{path.name} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise ValueError(f"{path.name} must be a text in UTF-8; it is not") from None
    return _cells(path, text) if path.suffix == ".ipynb" else text


def _cells(path: Path, text: str) -> str:
    try:
        cells = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
        sources = ["".join(cell["source"]) for cell in cells]
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ValueError(f"{path.name} must be a notebook; it cannot be read as one") from None
    return "\n\n".join(filter(None, _without_checks([_without_magic(source) for source in sources])))


def _without_magic(text: str) -> str:
    """A cell that is Python as it is; else without what only IPython understands."""
    if _tree(text).body:
        return text
    cell = CELL_MAGIC.match(text)
    if cell is not None and cell[1] not in AROUND_PYTHON:
        return ""  # of another language
    return "\n".join(line for line in text.splitlines() if not MAGIC.match(line))


def _without_checks(cells: list[str]) -> list[str]:
    """The cells without the statements that import rodlab for its check and hint, or call these: no part of an answer."""
    trees = [_tree(text) for text in cells]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    own = {"rl"} | {
        a.asname or a.name for node in nodes if isinstance(node, ast.Import) for a in node.names if a.name == "rodlab"
    }
    for node in nodes:
        if (
            isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Name)
            and node.value.id in own
            and node.attr not in FACES
        ):
            return cells  # an answer that needs more of rodlab is told that it is not there
    found = set[str]()  # names of reports
    return [
        _without(text, [node for node in tree.body if _checks(node, own, found)]) for text, tree in zip(cells, trees, strict=True)
    ]


def _checks(node: ast.stmt, own: set[str], found: set[str]) -> bool:
    """True for a statement that is about a check; the names that it gives are added to `found`."""
    match node:
        case ast.Import(names=[ast.alias(name="rodlab")]):
            return True
        case ast.ImportFrom(module="rodlab", names=given) if all(alias.name in FACES for alias in given):
            found |= {alias.asname or alias.name for alias in given}
            return True
        case ast.Expr() | ast.Assign() | ast.Assert():
            inside = list(ast.walk(node))
            names = {n.id for n in inside if isinstance(n, ast.Name)}
            faces = [n.value for n in inside if isinstance(n, ast.Attribute) and n.attr in FACES]
            if names & found or any(isinstance(n, ast.Name) and n.id in own for n in faces):
                found |= {n.id for n in inside if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
                return True
    return False


def _without(text: str, nodes: list[ast.stmt]) -> str:
    gone = {line for node in nodes for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)}
    return "\n".join(line for number, line in enumerate(text.split("\n"), 1) if number not in gone) if gone else text


def _tree(text: str) -> ast.Module:
    """A cell's statements; none if it is not Python."""
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])


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
        try:
            files = [file for file in path.iterdir() if file.suffix in SUFFIXES and not file.name.startswith(".")]
        except OSError as error:
            raise ValueError(f"{path} cannot be read: {error.strerror or error}") from None
        there = sorted(file for file in files if file.name != "check.py")
        found = [file for file in there if file.stem == "answer"] or there
        if len(found) not in (1, 2) or (len(found) == 2 and found[0].stem != found[1].stem):
            held = f"{len(there)} such files of other names" if there else "no .py or .ipynb file"
            raise ValueError(f"{path} must hold an answer.py or an answer.ipynb; it holds {held}")
        return found[::-1]  # the script first
    if path.suffix not in SUFFIXES:
        raise ValueError(f"a submission must be a .py or .ipynb file, or the folder of one; it is {path}")
    return [path]


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except OSError:  # in a folder that may not be entered
        return False


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
        if not _is_folder(path) and (only is None or exercise == only):
            found.setdefault((student, exercise), []).append(path)
    for path in sorted(folder.iterdir()):
        if path.is_symlink() and _is_folder(path):  # of a student, who must have a row
            found.setdefault((path.name, only or ""), []).append(path)
    return [Submission(student, exercise, tuple(paths)) for (student, exercise), paths in sorted(found.items())]
