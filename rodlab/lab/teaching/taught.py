"""An exercise in one file: the teacher's, from which the students' folder is made.

\"\"\"statement\"\"\"          -> README.md, and the notebook's first cell
# %% answer            -> answer.py and answer.ipynb, without what stands between ### BEGIN SOLUTION and ### END SOLUTION
# %% checks            -> check.py
# %% proofs            -> stays: for each classic mistake the edit of the answer that makes it, which the tests try

python -m rodlab.lab.teaching.taught exercises/teacher/*.py       makes the folders beside `teacher`
"""

import ast
import json
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rodlab.files import write_whole

CELL = re.compile(r"^# %% (answer|checks|proofs)[ \t]*\n", re.MULTILINE)
SOLUTION = re.compile(r"^([ \t]*)### BEGIN SOLUTION[ \t]*\n.*?^[ \t]*### END SOLUTION[ \t]*\n", re.MULTILINE | re.DOTALL)
STUB = "# YOUR CODE HERE\nraise NotImplementedError\n"


@dataclass(frozen=True)
class Taught:
    """A teacher's file, taken apart."""

    name: str
    statement: str
    reference: str  # the answer with its solutions
    checks: str
    proofs: str

    @property
    def title(self) -> str:
        """The statement's first line."""
        return self.statement.splitlines()[0].lstrip("# ")

    @property
    def stub(self) -> str:
        """The answer without its solutions."""
        return SOLUTION.sub(lambda found: "".join(f"{found[1]}{line}\n" for line in STUB.splitlines()), self.reference)

    def mistaken(self) -> dict[str, str]:
        """For each classic mistake, "question: name", the answer of one who makes it."""
        found: dict[str, Any] = {}
        exec(self.proofs, found)  # noqa: S102 the teacher's own
        return {name: _edited(self.reference, edits, f"{self.name}, {name}") for name, edits in found["PROOFS"].items()}


def _edited(text: str, edits: Any, what: str) -> str:
    for old, new in [edits] if isinstance(edits[0], str) else edits:
        if text.count(old) != 1:
            raise ValueError(f"{what}: {old!r} must be in the answer once; it is there {text.count(old)} times")
        text = text.replace(old, new)
    return text


def taught(path: Path) -> Taught:
    """A teacher's file, taken apart; `ValueError` in one sentence if it is not one."""
    try:
        text = path.read_text(encoding="utf-8-sig")
        statement = ast.get_docstring(ast.parse(text))
    except OSError as error:
        raise ValueError(f"{path} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise ValueError(f"{path} must be a text in UTF-8; it is not") from None
    except SyntaxError as error:
        raise ValueError(f"{path} must be Python: {error.msg} (line {error.lineno})") from None
    parts = CELL.split(text)
    cells = dict(zip(parts[1::2], parts[2::2], strict=True))
    missing = [name for name in ("answer", "checks", "proofs") if name not in cells]
    if not statement or missing:
        raise ValueError(
            f"{path} must have a docstring and the cells # %% answer, checks, proofs; it lacks {missing or 'the first'}"
        )
    if len(parts) > 7:
        raise ValueError(f"{path} must have each of its cells once; they are {', '.join(parts[1::2])}")
    found = Taught(path.stem, statement, *(cells[name].strip() + "\n" for name in ("answer", "checks", "proofs")))
    _marked(path, found)
    return found


def _marked(path: Path, found: Taught) -> None:
    """Refuse marks without their other half, and whatever they would leave of a solution to the students."""
    marks = re.findall(r"(BEGIN|END) SOLUTION", found.reference)
    if not marks:
        raise ValueError(f"{path} must mark its solutions by ### BEGIN SOLUTION and ### END SOLUTION; it has no such mark")
    if marks != ["BEGIN", "END"] * (len(marks) // 2) or "SOLUTION" in found.stub or "SOLUTION" in found.checks:
        raise ValueError(f"{path} must close each ### BEGIN SOLUTION by ### END SOLUTION; it has {', '.join(marks)}")
    try:
        ast.parse(found.stub)
    except SyntaxError as error:
        raise ValueError(f"{path} must be Python also without its solutions: {error.msg}") from None


def folder_of(found: Taught) -> dict[str, str]:
    """The students' folder, file by file."""
    foot = (
        f"\n\n## Check it\n\nWrite your answer in `answer.py` (then `rodlab check exercises/{found.name}`) or in the notebook "
        f'`answer.ipynb` (its last cell is `rl.check("{found.name}", globals())`). A first hint: `rl.hint("{found.name}")`.\n'
    )
    plain = found.title.replace("\\", "\\\\").replace('"', "'")  # in a docstring
    return {
        "README.md": found.statement + foot,
        "answer.py": f"# rodlab exercise: {found.name}\n{found.stub}",
        "answer.ipynb": notebook(found, found.stub),
        "check.py": f'"""Checks of the exercise "{plain}"; made from the teacher\'s file."""\n\n{found.checks}',
    }


def notebook(found: Taught, answer: str, kind: str = "") -> str:
    """A notebook of the statement, an answer and its check; for "nbgrader" or "otter" with what these look for."""
    code = f"# rodlab exercise: {found.name}\n{answer}"
    check = f'import rodlab as rl\n\nrl.check("{found.name}", globals())'
    graded = f'import rodlab as rl\n\nassert rl.check("{found.name}", globals()).passed'
    statement = ("markdown", "statement", found.statement)
    match kind:
        case "nbgrader":
            cells = [statement, ("code", "answer", code, "solution"), ("code", "check", graded, "grade")]
        case "otter":
            code = code.replace("### BEGIN SOLUTION", "# BEGIN SOLUTION").replace("### END SOLUTION", "# END SOLUTION")
            begin = f"# BEGIN QUESTION\nname: {found.name}\npoints: 1"
            marks = ("# BEGIN SOLUTION", "# END SOLUTION", "# BEGIN TESTS", "# END TESTS", "# END QUESTION")
            raw = [
                ("raw", f"mark-{i}", text) for i, text in enumerate(("# ASSIGNMENT CONFIG\nexport_cell: false", begin, *marks))
            ]
            answer_cell, test_cell = ("code", "answer", code), ("code", "check", graded)
            cells = [raw[0], raw[1], statement, raw[2], answer_cell, raw[3], raw[4], test_cell, raw[5], raw[6]]
        case _:
            cells = [statement, ("code", "answer", code), ("code", "check", check)]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    content = {"cells": [_cell(found.name, *cell) for cell in cells], "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _cell(exercise: str, kind: str, name: str, text: str, mark: str = "") -> dict[str, Any]:
    """A cell; a mark is nbgrader's."""
    lines = text.rstrip("\n").splitlines(keepends=True)
    cell: dict[str, Any] = {"cell_type": kind, "id": f"{exercise}-{name}"[-64:], "metadata": {}, "source": lines}
    if kind == "code":
        cell |= {"execution_count": None, "outputs": []}
    if mark:
        graded = mark == "grade"
        cell["metadata"]["nbgrader"] = {
            "grade": graded, "solution": not graded, "locked": graded, "task": False, "schema_version": 3,
            "grade_id": f"{exercise}-{name}", **({"points": 1} if graded else {}),
        }  # fmt: skip
    return cell


def make(path: Path, out: Path | None = None) -> list[Path]:
    """Write the students' folder of a teacher's file, beside the teacher's tree or in `out`."""
    found = taught(path)
    folder = (out or path.resolve().parents[1]) / found.name
    return [write_whole(folder / name, text) for name, text in folder_of(found).items()]


def make_graded(path: Path, kind: str, out: Path | None = None) -> list[Path]:
    """Write the teacher's notebook, with solutions and the marks of "nbgrader" or "otter", to `out`/source/NAME/NAME.ipynb."""
    found = taught(path)
    folder = (out or Path()) / "source" / found.name
    return [write_whole(folder / f"{found.name}.ipynb", notebook(found, found.reference, kind))]


def index(teacher: Path) -> str:
    """The exercises of a teacher's tree in the order of the notes: a README for the folder of folders."""
    rows = []
    for path in sorted(teacher.glob("*.py")):
        found = taught(path)
        source = re.search(r'source="([^"]*)"', found.checks)
        functions = ", ".join(
            f"`{node.name}`" for node in ast.parse(found.stub).body if isinstance(node, ast.FunctionDef) and _open(node)
        )
        rows.append((source[1] if source else "", f"[{found.name}]({found.name}/README.md)", found.title, functions))
    lines = [f"| {' | '.join(row)} |" for row in sorted(rows)]
    head = "| notes | exercise | about | write |\n|---|---|---|---|"
    foot = (
        "Answers are checked by `rodlab check FOLDER`, in a notebook by `rl.check(NAME, globals())`. Solutions are in `teacher`."
    )
    return f"# {len(rows)} exercises that check themselves\n\n{head}\n" + "\n".join(lines) + f"\n\n{foot}\n"


def _open(function: ast.FunctionDef) -> bool:
    """True if it is still to be written."""
    return any(isinstance(node, ast.Raise) for node in function.body)


if __name__ == "__main__":
    for given in map(Path, sys.argv[1:]):
        make(given)
    for teacher in {Path(given).resolve().parent for given in sys.argv[1:]}:
        write_whole(teacher.parent / "README.md", index(teacher))
