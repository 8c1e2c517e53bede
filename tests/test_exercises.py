"""Every exercise: the reference has all points, the stub none and a sentence, each classic mistake its own hint."""

import ast
import json
from pathlib import Path

import numpy as np
import pytest

from rodlab.grading.values import Text, Truth
from rodlab.lab.teaching import course
from rodlab.lab.teaching.taught import folder_of, index, taught

ROOT = Path(__file__).parents[1]
TEACHER = sorted((ROOT / "exercises" / "teacher").glob("*.py"))
FILES = {path.stem: path for path in TEACHER}


def test_the_course_is_whole():
    assert len(FILES) >= 24
    assert course.names() == sorted(FILES)
    assert (ROOT / "exercises" / "README.md").read_text() == index(ROOT / "exercises" / "teacher")
    mistakes = sum(len(q.mistakes) for name in FILES for q in course.exercise(name).questions)
    said = (ROOT / "README.md").read_text()
    assert f"{len(FILES)} exercises: references" in said
    assert f"{mistakes} mistakes" in said


def judged(name, source, seed=None):
    """The submission's functions asked in this process: quick, and the same values as those of a process apart."""
    names = {"__name__": "answer"}
    exec(compile(source, "answer.py", "exec"), names)
    return course.check(name, names, seed=seed)


@pytest.mark.parametrize("name", FILES)
def test_the_folder_is_the_teachers_file_without_its_solutions(name):
    found = taught(FILES[name])
    for file, text in folder_of(found).items():
        assert (ROOT / "exercises" / name / file).read_text() == text, f"run: python -m rodlab.lab.teaching.taught {FILES[name]}"
    assert "SOLUTION" not in found.stub
    cells = json.loads(folder_of(found)["answer.ipynb"])["cells"]
    assert [cell["cell_type"] for cell in cells] == ["markdown", "code", "code"]


@pytest.mark.parametrize("name", FILES)
def test_the_reference_has_all_points_in_a_process_of_its_own(name):
    report = course.check_source(course.exercise(name), taught(FILES[name]).reference, seed=20261122)
    assert report.percent == 100.0, str(report)
    assert report.passed


@pytest.mark.parametrize("name", FILES)
def test_the_reference_holds_for_other_parameters(name):
    for seed in range(1, 4):
        report = judged(name, taught(FILES[name]).reference, seed)
        assert report.passed, f"seed {seed}: {report}"


@pytest.mark.parametrize("name", FILES)
def test_the_stub_has_no_points_and_says_so(name):
    report = judged(name, taught(FILES[name]).stub)
    assert report.score == 0.0
    assert {item.status for item in report.items} == {"unanswered"}
    assert all("is not answered yet" in item.sentence for item in report.items)


@pytest.mark.parametrize("name", FILES)
def test_the_students_notebook_runs_as_it_is(name):
    cells = json.loads((ROOT / "exercises" / name / "answer.ipynb").read_text())["cells"]
    names = {"__name__": "notebook"}
    for cell in cells[1:]:
        exec("".join(cell["source"]), names)


TRIVIAL = {
    "zero": lambda *_: 0, "one": lambda *_: 1, "its first argument": lambda *given: given[0] if given else 0,
    "its last argument": lambda *given: given[-1] if given else 0, "zeros like its first argument": lambda *given: 0 * np.asarray(given[0]),
    "the identity": lambda *given: np.eye(min(np.size(given[0]), 20)), "two zeros": lambda *_: (0, 0), "three ones": lambda *_: (1, 1, 1),
    "True": lambda *_: True, "nothing": lambda *_: None, "no number": lambda *_: float("nan"), "a pair of ones": lambda *_: (1.0, 1.0),
}  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_answers_without_thought_are_not_worth_half(name):
    for said, answer in TRIVIAL.items():
        report = course.check(name, {q.name: answer for q in course.exercise(name).questions}, seed=2)
        assert report.percent < 34.0, f"{said}: {report}"


def spoiled(value, by):
    """The same shape, and `by` in the place of every number."""
    if isinstance(value, list | tuple):
        return [spoiled(x, by) for x in value]
    if isinstance(value, np.ndarray):
        return np.full(value.shape, by)
    return value if isinstance(value, bool | str) else by


@pytest.mark.parametrize("by", [float("nan"), float("inf")])
@pytest.mark.parametrize("name", FILES)
def test_answers_of_no_number_have_no_points(name, by):
    names = {"__name__": "answer"}
    exec(taught(FILES[name]).reference, names)
    for question in course.exercise(name).questions:
        answer = {question.name: lambda *given, f=names[question.name]: spoiled(f(*given), by)}
        items = [item for item in course.check(name, answer, seed=2).items if item.question == question.name]
        kept = [item for item in items if item.passed]
        assert not kept or isinstance(question.returns, Truth | Text), f"{question.name} {kept[0].message}"


@pytest.mark.parametrize("name", FILES)
def test_each_classic_mistake_has_its_own_hint(name):
    exercise = course.exercise(name)
    known = {f"{q.name}: {m.name}": m.hint for q in exercise.questions for m in q.mistakes}
    tried = taught(FILES[name]).mistaken()
    assert set(tried) == set(known), "every mistake of the checks is proved, and no other"
    assert len(known) >= 3
    assert len(set(known.values())) == len(known), "each has its own hint"
    for mistake, source in tried.items():
        report = judged(name, source, seed=3)
        assert report.score < report.max_score, f"{mistake} has all points"
        assert mistake in report.mistakes, f"{mistake} is not recognised:\n{report}"
        assert known[mistake] in str(report)


@pytest.mark.parametrize("name", FILES)
def test_statement_and_checks_are_whole(name):
    found = taught(FILES[name])
    exercise = course.exercise(name)
    functions = {node.name for node in ast.parse(found.reference).body if isinstance(node, ast.FunctionDef)}
    for question in exercise.questions:
        assert question.name in functions
        assert f"`{question.name}(" in found.statement, f"the statement does not say what {question.name} is"
        assert question.hint
        assert question.points > 0
    assert found.statement.startswith(f"# {exercise.title}\n")
    assert exercise.source
