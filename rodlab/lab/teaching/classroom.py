"""A class graded: every submission in parallel, each in its own process, kept when it is finished, and summed up.

    rodlab check --class DIR --out OUT
        OUT/grades.csv                        a row for each student and exercise
        OUT/students.csv                      a row for each student: points of every exercise
        OUT/gradescope/STUDENT/EXERCISE.json  Gradescope's results.json
        OUT/mistakes.png                      the mistakes of the class in one picture
        OUT/cells.sqlite, OUT/class.json      what a killed run goes on from, and its seed

Only this process writes, and each file whole. Times are in none of them: killed and resumed, they are the same.
"""

import hashlib
import json
import secrets
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from rodlab.files import swept, write_whole
from rodlab.grading.grade import check_seed
from rodlab.grading.sandbox import Limits
from rodlab.lab.store import as_csv
from rodlab.lab.studies.journal import Journal
from rodlab.lab.studies.provenance import fingerprint
from rodlab.lab.teaching.course import check_sources, exercise, home, names
from rodlab.lab.teaching.gradescope import of_report, results
from rodlab.lab.teaching.submissions import LONGEST, Submission, read, submissions

COLUMNS = ("student", "exercise", "score", "max_score", "percent", "status", "mistakes", "message")
MOST = 8  # files of one student for one exercise
Watch = Callable[[int, int], None]


@dataclass(frozen=True)
class Paper:
    """A submission as it is kept: known again by its text."""

    submission: Submission

    @cached_property
    def key(self) -> str:  # as it was before it was judged: what is changed meanwhile is judged again
        """Student, exercise and what was handed in."""
        named = hashlib.sha256()
        for path in self.submission.paths[: MOST + 1]:
            named.update(_start(path))
        return json.dumps(
            [self.submission.student, self.submission.exercise, *(p.name for p in self.submission.paths), named.hexdigest()]
        )


@dataclass(frozen=True)
class Class:
    """The graded class: one record a submission, sorted by student and exercise."""

    records: tuple[dict[str, Any], ...]
    seed: int
    fresh: int  # graded in this run; the others were known

    @property
    def students(self) -> list[str]:
        """Everyone who handed in something."""
        return sorted({record["student"] for record in self.records})

    def write(self, out: Path) -> list[Path]:
        """Write tables, Gradescope's files and the picture, each whole."""
        from rodlab.lab.picture import png
        from rodlab.lab.teaching.class_picture import class_picture

        written = [write_whole(out / "grades.csv", as_csv(COLUMNS, [[_safe(r[name]) for name in COLUMNS] for r in self.records]))]
        written.append(write_whole(out / "students.csv", self._by_student()))
        for record in self.records:
            if record["exercise"]:
                path = out / "gradescope" / record["student"] / f"{record['exercise']}.json"
                write_whole(path, results(record))
                swept(path.parent)
        written.append(write_whole(out / "mistakes.png", png(class_picture(self.records))))
        return written

    def _by_student(self) -> str:
        asked = sorted({r["exercise"] for r in self.records if r["exercise"]})
        points = {(r["student"], r["exercise"]): r["percent"] for r in self.records}
        rows = []
        for student in self.students:
            own = [points.get((student, name)) for name in asked]
            rows.append([_safe(student), *own, sum(x or 0.0 for x in own) / max(len(asked), 1)])
        return as_csv(("student", *asked, "percent of all"), rows)


def grade_class(
    folder: Path, out: Path, *, only: str | None = None, course: Path | None = None, seed: int | None = None, jobs: int = 2,
    limits: Limits | None = None, watch: Watch | None = None,
) -> Class:  # fmt: skip
    """Grade every submission in a folder, going on where a killed run stopped.

    Parameters
    ----------
    folder : the submissions, a folder (or a file) for each student
    out : where to write, and what to go on from
    only : one exercise, also for files that name none
    course : a folder of exercises other than the course's
    seed : of the fresh parameters; None draws one, and keeps it in `out`
    jobs : submissions at a time
    watch : told (done, in all)
    """
    if only is not None:
        exercise(only, course)
    check_seed(seed)
    if jobs < 1:
        raise ValueError(f"jobs must be at least 1; it is {jobs}")
    papers = [Paper(found) for found in submissions(folder, names(course), only)]
    if not papers:
        raise ValueError(f"class must be a folder with .py or .ipynb files of students; there are none in {folder}")
    seed = _seed(out, seed)
    records: dict[int, dict[str, Any]] = {}
    with Journal(out, _fingerprint(course, seed), {"seed": seed, "folder": str(folder)}) as journal:
        swept(out)
        records |= journal.known(papers)
        known = len(records)
        todo = [i for i in range(len(papers)) if i not in records]
        if watch:
            watch(known, len(papers))
        with ThreadPoolExecutor(max_workers=jobs) as pool:
            running: dict[Future[dict[str, Any]], int] = {
                pool.submit(_record, papers[i].submission, course, seed, limits): i for i in todo
            }
            try:
                for done in as_completed(running):
                    records[running[done]] = done.result()
                    if done.result()["status"] != "not judged":  # for a fault of ours it is tried again
                        journal.keep(papers[running[done]], done.result())
                    if watch:
                        watch(len(records), len(papers))
            finally:
                for waiting in running:
                    waiting.cancel()
    return Class(tuple(records[i] for i in sorted(records)), seed, len(todo))


def _record(submission: Submission, course: Path | None, seed: int, limits: Limits | None) -> dict[str, Any]:
    """One submission judged, as plain data; whatever happens to it is a row of its own."""
    try:
        asked = exercise(submission.exercise, course)
    except ValueError:
        files = ", ".join(path.name for path in submission.paths)
        linked = all(path.is_symlink() for path in submission.paths)
        why = "links are not followed" if linked else "for which exercise is this? Its first line should say so"
        return _row(submission, 0.0, 0.0, "not judged", f"{files}: {why}")
    try:
        if len(submission.paths) > MOST:
            raise ValueError(f"for one exercise at most {MOST} files are read; here are {len(submission.paths)}")
        sources = [read(path) for path in submission.paths]
    except ValueError as why:
        return _row(submission, 0.0, asked.points, "not readable", str(why))
    try:
        report = check_sources(asked, sources, seed=seed, limits=limits)
    except Exception as why:  # noqa: BLE001 a fault of a check is this row's alone
        return _row(submission, 0.0, asked.points, "not judged", f"the check failed: {type(why).__name__}: {why}")
    said = of_report(report)
    states = {item.status for item in report.items}
    worst = next((s for s in ("lost", "mistake", "wrong", "unanswered") if s in states), "right")
    message = next((item.sentence for item in report.items if item.status == worst and worst != "right"), "")
    return {**_row(submission, report.score, report.max_score, worst, message), **said, "mistakes": "; ".join(report.mistakes)}


def _row(submission: Submission, score: float, most: float, status: str, message: str) -> dict[str, Any]:
    percent = 100.0 * score / most if most else 0.0
    student, message = (
        text.encode("utf-8", "backslashreplace").decode() for text in (submission.student, message)
    )  # of any bytes
    return {
        "student": student, "exercise": submission.exercise, "score": score, "max_score": most, "percent": percent,
        "status": status, "mistakes": "", "message": message, "hints": [message] if message else [], "items": [],
    }  # fmt: skip


def _start(path: Path) -> bytes:
    """A file as far as it would be read; of what cannot be read, nothing."""
    try:
        if path.is_symlink() or not path.is_file():
            return b""
        with path.open("rb") as file:
            return file.read(max(LONGEST.values()) + 1)
    except OSError:
        return b""


def _seed(out: Path, seed: int | None) -> int:
    """The seed of this class: as given, as it was when this began, or a new one."""
    path = out / "class.json"
    try:
        before = int(json.loads(path.read_text(encoding="utf-8"))["seed"])
    except FileNotFoundError:
        before = None
    except (OSError, ValueError, KeyError, TypeError):
        raise ValueError(f"{path} cannot be read; remove it to begin anew, or name another folder") from None
    if seed is None:
        seed = secrets.randbelow(2**31) if before is None else before
    if seed != before:
        write_whole(path, json.dumps({"seed": seed}) + "\n")
    return seed


def _fingerprint(course: Path | None, seed: int) -> str:
    """What a grade depends on besides the submission: the code, the checks, the seed."""
    named = hashlib.sha256(f"{fingerprint()} {seed}".encode())
    for path in sorted((course or home()).glob("*/check.py")):
        named.update(path.read_bytes())
    return named.hexdigest()[:16]


def _safe(value: Any) -> Any:
    """Text that a spreadsheet does not take for a formula."""
    return f"'{value}" if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t", "\r")) else value
