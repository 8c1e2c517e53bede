"""What `rodlab check` and `rodlab exercises` are asked, and their answers as data and as text."""

import argparse
import os
import secrets
import time
from pathlib import Path
from typing import Any

from rodlab.files import write_whole
from rodlab.lab.table import table
from rodlab.lab.teaching.classroom import Watch, grade_class
from rodlab.lab.teaching.course import check_paths, exercise, home, names
from rodlab.lab.teaching.gradescope import of_report, results, unreadable
from rodlab.lab.teaching.submissions import answers_in, named
from rodlab.lab.teaching.tally import summary

Answered = tuple[dict[str, Any], str, int]


def check_one(chosen: argparse.Namespace, what: Path) -> Answered:
    """One answer judged, and Gradescope's file written."""
    _only_of_a_class(chosen)
    course = _course(chosen)
    try:
        return _judged(chosen, what, course)
    except (ValueError, OSError) as error:
        why = ValueError(f"{what} cannot be read: {error.strerror}") if isinstance(error, OSError) else error
        if chosen.gradescope:  # who handed it in waits for a word
            points = exercise(chosen.exercise, course).points if chosen.exercise in names(course) else 0.0
            write_whole(Path(chosen.gradescope), unreadable(str(why), points))
        raise why from None


def _judged(chosen: argparse.Namespace, what: Path, course: Path | None) -> Answered:
    if not what.exists() and str(what) in names(course):  # a name alone; what is missing elsewhere is missing
        what = (course or home()) / what
    paths = answers_in(what)
    for path in paths:
        if not path.is_file():
            raise ValueError(f"ANSWER must be an exercise's folder or a file; there is no {path}")
    name = chosen.exercise or next(filter(None, (named(path, names(course)) for path in paths)), None)
    if name is None:
        raise ValueError(
            f'{what} does not say which exercise it answers; give --exercise, or begin it with "# rodlab exercise: NAME"'
        )
    seed = secrets.randbelow(2**31) if chosen.gradescope and chosen.seed is None else chosen.seed
    start = time.perf_counter()
    report = check_paths(exercise(name, course), paths, seed=seed)
    said, written = of_report(report), []
    if chosen.gradescope:
        write_whole(Path(chosen.gradescope), results(said, time.perf_counter() - start))
        written = [chosen.gradescope]
    return {**said, "files": written}, f"{report}\n  ({report.protections})", 0 if report.passed else 1


def check_class(chosen: argparse.Namespace, watch: Watch) -> Answered:
    """A class graded and written."""
    if chosen.what is not None or chosen.gradescope is not None:
        raise ValueError("--class grades a folder: an ANSWER or --gradescope must not be given as well")
    out = Path(chosen.out or "rodlab-class")
    found = grade_class(
        Path(chosen.folder), out, only=chosen.exercise, course=_course(chosen), seed=chosen.seed, jobs=_jobs(chosen), watch=watch,
    )  # fmt: skip
    written = [str(path) for path in found.write(out)]
    columns, rows = summary(found.records)
    title = f"{len(found.records)} submissions of {len(found.students)} students"
    text = "\n".join([table(title, columns, rows), *(f"  {path}" for path in written)])
    kept = [{key: value for key, value in record.items() if key not in ("items", "hints", "title")} for record in found.records]
    return {"submissions": kept, "seed": found.seed, "graded_now": found.fresh, "files": written}, text, 0


def listed(chosen: argparse.Namespace) -> tuple[dict[str, Any], str]:
    """The exercises of the course."""
    needed = "an ANSWER or --class" if chosen.verb == "check" else "--make"
    for name in ("exercise", "gradescope", "seed", "jobs", "out", "notebooks"):
        if getattr(chosen, name, None) is not None:
            raise ValueError(f"--{name} must be given with {needed}")
    course = _course(chosen)
    known = [exercise(name, course) for name in names(course)]
    rows: list[list[Any]] = [[e.name, e.source, f"{e.points:g}", e.title] for e in known]
    width = max(len(row[0]) for row in rows)
    text = "\n".join(f"{name:{width}}  [{source}]  {title}" for name, source, _, title in rows)
    said = [{"name": e.name, "title": e.title, "source": e.source, "points": e.points} for e in known]
    where = course or home()
    text += f"\n\nthey are in {where}; rodlab check FOLDER checks the answer in one"
    return {"exercises": said, "folder": str(where)}, text


def made(chosen: argparse.Namespace) -> tuple[dict[str, Any], str]:
    """Folders made from teachers' files."""
    from rodlab.lab.teaching.taught import make, make_graded

    out = Path(chosen.out) if chosen.out else None
    written: list[Path] = []
    for given in map(Path, chosen.make):
        if not given.is_file():
            raise ValueError(f"--make must name teachers' files; there is no {given}")
        written += make_graded(given, chosen.notebooks, out) if chosen.notebooks else make(given, out)
    return {"files": [str(path) for path in written]}, "\n".join(map(str, written))


def _course(chosen: argparse.Namespace) -> Path | None:
    if chosen.exercises is None:
        return None
    course = Path(chosen.exercises)
    if not names(course):
        raise ValueError(f"--exercises must be a folder of exercises, each a folder with a check.py; {course} has none")
    return course


def _jobs(chosen: argparse.Namespace) -> int:
    return os.cpu_count() or 1 if chosen.jobs is None else int(chosen.jobs)


def _only_of_a_class(chosen: argparse.Namespace) -> None:
    for name in ("out", "jobs"):
        if getattr(chosen, name) is not None:
            raise ValueError(f"--{name} must be given with --class only; it is {getattr(chosen, name)!r}")
