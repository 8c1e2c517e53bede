"""The four faces of the checker, and a class: notebook, command line, pytest, Gradescope; killed, resumed, broken."""

import csv
import json
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from classes import ROOT, write_class

import rodlab as rl
from rodlab.cli import main
from rodlab.grading.sandbox import Limits
from rodlab.lab.class_picture import class_picture
from rodlab.lab.classroom import grade_class
from rodlab.lab.course import exercise
from rodlab.lab.submissions import read, submissions
from rodlab.lab.taught import make, taught

TWO = taught(ROOT / "exercises" / "teacher" / "two-joints.py")
PAIR = ("gradient", "two-joints")
QUICK = Limits(seconds=1.0, total=5.0)


def rows_of(path):
    return list(csv.DictReader(path.read_text().splitlines()))


@pytest.fixture
def right(tmp_path):
    path = tmp_path / "two-joints" / "answer.py"
    path.parent.mkdir()
    path.write_text(TWO.reference)
    return path


# --- a notebook --------------------------------------------------------------------------------------------------------------


def test_a_notebook_checks_functions_a_dictionary_a_module_or_a_file(right):
    names = {}
    exec(TWO.reference, names)
    assert rl.check("two-joints", names).passed
    assert rl.check("two-joints", SimpleNamespace(**{key: names[key] for key in ("hessian", "branch_points", "modes", "index")}))
    assert rl.check("two-joints", right, seed=4).percent == 100
    one = rl.check("two-joints", names["hessian"])
    assert (one.score, one.max_score) == (2.0, 6.0)
    assert not one


def test_a_report_is_a_page_and_a_text():
    report = rl.check("two-joints", {"hessian": lambda phi, lam: "<script>"})
    assert "<script>" not in report._repr_html_()
    assert "an array of shape (2, 2) is expected" in str(report)
    assert rl.hint("two-joints", "index").startswith("index: ")
    assert repr(rl.hint("two-joints")) == str(rl.hint("two-joints"))


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: rl.check("two-joint", {}), r"exercise must be one of the course's \d+, such as two-joints.*it is 'two-joint'"),
        (lambda: rl.check("two-joints", 3), r"answer must be functions named hessian, branch_points.*it is 3"),
        (lambda: rl.check("two-joints", "nowhere.py"), r"nowhere.py cannot be read: No such file"),
        (lambda: rl.check("two-joints", "answer.txt"), r"a submission must be a .py or .ipynb file"),
        (lambda: rl.hint("two-joints", "energy"), r"question must be one of hessian, .*; it is 'energy'"),
    ],
)
def test_what_cannot_be_checked_is_said_in_a_sentence(call, sentence):
    with pytest.raises(ValueError, match=sentence):
        call()


def test_an_answer_cannot_change_what_it_is_asked_with():
    def hessian(phi, lam):
        phi *= 0.0
        return [[2 - lam, -1], [-1, 1 - lam]]

    report = rl.check("two-joints", {"hessian": hessian})
    assert report.items[0].passed
    assert not report.items[1].passed


# --- the command line --------------------------------------------------------------------------------------------------------


def test_the_command_line_judges_and_says_by_its_exit_code(right, capsys):
    assert main(["check", str(right.parent)]) == 0
    assert "6 of 6 points" in capsys.readouterr().out
    right.write_text(TWO.mistaken()["hessian: missing end joint"])
    assert main(["check", str(right), "--seed", "3", "--json"]) == 1
    said = json.loads(capsys.readouterr().out)
    assert said["verb"] == "check"
    assert said["mistakes"] == ["hessian: missing end joint"]
    assert {item["hidden"] for item in said["items"]} == {False, True}
    assert main(["check"]) == 0
    assert "two-joints" in capsys.readouterr().out
    assert main(["exercises", "--json"]) == 0
    assert {"name": "two-joints", "title": "Two joints", "source": "N 2.7", "points": 6.0} in json.loads(capsys.readouterr().out)[
        "exercises"
    ]


def test_the_stub_of_the_course_is_checked_by_its_folder(capsys):
    assert main(["check", str(ROOT / "exercises" / "two-joints")]) == 1
    assert "0 of 6 points" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["nothing.py"], "there is no nothing.py"),
        (["{}/answer.txt"], "a submission must be a .py or .ipynb file"),
        (["{}/two"], "it holds 2 such files of other names"),
        (["{}", "--exercise", "two"], "exercise must be one of the course's"),
        (["{}"], "does not say which exercise it answers"),
        (["{}", "--jobs", "2"], "--jobs must be given with --class only"),
        (["{}", "--exercises", "{}"], "--exercises must be a folder of exercises"),
        (["--class", "{}/none"], "class must be a folder of submissions"),
        (["--class", "{}", "--gradescope", "x.json"], "an ANSWER or --gradescope must not be given as well"),
        (["--class", "{}/empty", "--out", "{}/out"], "there are none in"),
        (["--class", "{}", "--out", "{}/out", "--jobs", "0"], "jobs must be at least 1"),
        (["{}/big.py", "--exercise", "two-joints"], "must be a submission of at most 1048576 bytes"),
        (["{}/latin.py", "--exercise", "two-joints"], "must be a text in UTF-8"),
        (["{}/link.py", "--exercise", "two-joints"], "must be a file; it is a link"),
        (["{}/bad.ipynb", "--exercise", "two-joints"], "must be a notebook"),
    ],
)
def test_bad_input_is_one_sentence_and_exit_code_2(arguments, sentence, tmp_path, capsys):
    (tmp_path / "answer.py").write_text("x = 1")
    (tmp_path / "answer.txt").write_text("x = 1")
    (tmp_path / "big.py").write_text("#" * 2**21)
    (tmp_path / "latin.py").write_bytes(b"# \xe9\xff")
    (tmp_path / "bad.ipynb").write_text("[1, 2]")
    (tmp_path / "link.py").symlink_to(ROOT / "exercises" / "teacher" / "two-joints.py")
    (tmp_path / "empty").mkdir()
    (tmp_path / "two").mkdir()
    for name in ("a.py", "b.py"):
        (tmp_path / "two" / name).write_text("x = 1")
    assert main(["check", *(text.replace("{}", str(tmp_path)) for text in arguments)]) == 2
    said = capsys.readouterr()
    assert sentence in said.err
    assert said.out == ""


def test_gradescope_gets_its_file_with_hidden_tests_on_fresh_parameters(right, tmp_path, capsys):
    out = tmp_path / "results.json"
    right.write_text(TWO.mistaken()["index: sign of the determinant"])
    assert main(["check", str(right), "--gradescope", str(out)]) == 1
    capsys.readouterr()
    found = json.loads(out.read_text())
    assert set(found) == {"score", "output", "output_format", "stdout_visibility", "execution_time", "tests"}
    assert found["score"] == pytest.approx(sum(test["score"] for test in found["tests"]))
    assert sum(test["max_score"] for test in found["tests"]) == pytest.approx(6.0)
    assert [test["visibility"] for test in found["tests"]] == ["visible"] * 6 + ["hidden"] * 6
    assert {test["status"] for test in found["tests"]} == {"passed", "failed"}
    assert "Two negative eigenvalues have a positive product" in found["output"]


def test_gradescope_is_told_of_a_submission_that_cannot_be_read(tmp_path, capsys):
    (tmp_path / "mine.py").write_bytes(b"\xff")
    out = tmp_path / "results.json"
    assert main(["check", str(tmp_path), "--exercise", "two-joints", "--gradescope", str(out)]) == 2
    assert "must be a text in UTF-8" in capsys.readouterr().err
    found = json.loads(out.read_text())
    assert (found["score"], found["tests"][0]["max_score"]) == (0.0, 6.0)
    assert "must be a text in UTF-8" in found["output"]


# --- pytest ------------------------------------------------------------------------------------------------------------------


def test_pytest_collects_answers_when_asked(right):
    right.write_text(TWO.mistaken()["hessian: missing end joint"])
    run = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(right.parent)]
    plain = subprocess.run(run, capture_output=True, text=True, check=False, cwd=right.parent)
    assert "no tests ran" in plain.stdout
    asked = subprocess.run([*run, "--exercises"], capture_output=True, text=True, check=False, cwd=right.parent)
    assert "1 failed, 5 passed" in asked.stdout, asked.stdout + asked.stderr
    assert "How many springs act on the last link?" in asked.stdout


# --- submissions -------------------------------------------------------------------------------------------------------------


def test_a_notebook_is_read_without_its_magic_and_its_checks(tmp_path):
    cells = [
        ["%matplotlib inline\n", "import numpy as np\n", "!ls\n", "x = 1"],
        ["import rodlab as rl\n", "rl.check('two-joints', globals())"],
    ]
    content = {"cells": [{"cell_type": "code", "source": cell} for cell in cells] + [{"cell_type": "markdown", "source": "text"}]}
    path = tmp_path / "two-joints.ipynb"
    path.write_text(json.dumps(content))
    assert read(path) == "import numpy as np\nx = 1"


def test_the_better_of_a_script_and_a_notebook_counts(tmp_path, capsys):
    folder = tmp_path / "two-joints"
    shutil.copytree(ROOT / "exercises" / "two-joints", folder)
    cells = json.loads((folder / "answer.ipynb").read_text())
    cells["cells"][1]["source"] = TWO.reference.splitlines(keepends=True)
    (folder / "answer.ipynb").write_text(json.dumps(cells))
    assert main(["check", str(folder)]) == 0
    assert "6 of 6" in capsys.readouterr().out


def test_submissions_are_found_by_student_and_exercise(tmp_path):
    for place in (
        "ann/two-joints/answer.py",
        "ann/gradient.ipynb",
        "ben.py",
        "ben/notes.py",
        "ben/.hidden/answer.py",
        "ben/two-joints/check.py",
    ):
        (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / place).write_text("# rodlab exercise: gradient\n" if place == "ben.py" else "x = 1\n")
    (tmp_path / "eve").mkdir()
    (tmp_path / "eve" / "two-joints.py").symlink_to(ROOT / "exercises" / "teacher" / "two-joints.py")
    found = {(s.student, s.exercise) for s in submissions(tmp_path, PAIR)}
    assert found == {("ann", "two-joints"), ("ann", "gradient"), ("ben", "gradient"), ("ben", ""), ("eve", "two-joints")}
    assert {s.student for s in submissions(tmp_path, PAIR, "two-joints")} == {"ann", "ben", "eve"}
    graded = grade_class(tmp_path, tmp_path / "out", seed=1, jobs=2, limits=QUICK)
    eve = next(r for r in graded.records if r["student"] == "eve")
    assert (eve["score"], eve["status"]) == (0.0, "not readable")
    assert "it is a link" in eve["message"]


# --- a class -----------------------------------------------------------------------------------------------------------------


def test_a_broken_submission_affects_no_other(tmp_path):
    kinds = write_class(tmp_path / "all", 20, exercises=PAIR, broken=5)
    write_class(tmp_path / "good", 20, exercises=PAIR, broken=5)
    for (student, name), kind in kinds.items():
        if kind == "broken":
            shutil.rmtree(tmp_path / "good" / student / name)
    both = [grade_class(tmp_path / which, tmp_path / f"out-{which}", seed=9, jobs=2, limits=QUICK) for which in ("all", "good")]
    for graded, which in zip(both, ("all", "good"), strict=True):
        graded.write(tmp_path / f"out-{which}")
    everyone, good = (rows_of(tmp_path / f"out-{which}" / "grades.csv") for which in ("all", "good"))
    assert [row for row in everyone if kinds[row["student"], row["exercise"]] != "broken"] == good
    for row in everyone:
        kind = kinds[row["student"], row["exercise"]]
        assert (float(row["percent"]) == 100.0) == (kind == "right")
        assert bool(row["mistakes"]) == (kind == "mistake")
        if kind in ("broken", "stub"):
            assert float(row["score"]) == 0.0
            assert row["message"]


def kept_in(path):
    """How many grades a running grader has kept."""
    try:
        with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True, timeout=5)) as file:
            return file.execute("SELECT count(*) FROM cells").fetchone()[0]
    except sqlite3.Error:
        return 0


def test_killed_and_resumed_a_class_has_the_same_files(tmp_path):
    write_class(tmp_path / "class", 24, exercises=PAIR, broken=2, seed=3)
    command = [
        sys.executable,
        "-m",
        "rodlab",
        "check",
        "--class",
        str(tmp_path / "class"),
        "--seed",
        "5",
        "--jobs",
        "2",
        "--json",
        "--out",
    ]
    whole = subprocess.run([*command, str(tmp_path / "whole")], capture_output=True, text=True, check=True)
    assert json.loads(whole.stdout)["graded_now"] == 24
    for kept in (3, 9):  # killed twice, when so many are kept
        process = subprocess.Popen([*command, str(tmp_path / "killed")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and kept_in(tmp_path / "killed" / "cells.sqlite") < kept:
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert not (tmp_path / "killed" / "grades.csv").exists()
    resumed = json.loads(subprocess.run([*command, str(tmp_path / "killed")], capture_output=True, text=True, check=True).stdout)
    assert 0 < resumed["graded_now"] < 24
    files = sorted(
        path.relative_to(tmp_path / "whole")
        for path in (tmp_path / "whole").rglob("*")
        if path.suffix in (".csv", ".json", ".png")
    )
    assert Path("mistakes.png") in files
    for path in files:
        assert (tmp_path / "whole" / path).read_bytes() == (tmp_path / "killed" / path).read_bytes(), path
    again = json.loads(subprocess.run([*command, str(tmp_path / "killed")], capture_output=True, text=True, check=True).stdout)
    assert again["graded_now"] == 0


def test_a_changed_submission_is_graded_again_and_the_seed_is_kept(tmp_path):
    write_class(tmp_path / "class", 4, exercises=PAIR)
    first = grade_class(tmp_path / "class", tmp_path / "out", limits=QUICK)
    changed = tmp_path / "class" / "student-000" / "gradient" / "answer.py"
    changed.write_text(changed.read_text() + "\n# again\n")
    second = grade_class(tmp_path / "class", tmp_path / "out", limits=QUICK)
    assert (second.seed, second.fresh) == (first.seed, 1)
    assert grade_class(tmp_path / "class", tmp_path / "out", seed=first.seed + 1, limits=QUICK).fresh == 4


def test_names_are_no_formulas_of_a_spreadsheet(tmp_path):
    path = tmp_path / "class" / "=HYPERLINK(1)" / "two-joints.py"
    path.parent.mkdir(parents=True)
    path.write_text(TWO.stub)
    graded = grade_class(tmp_path / "class", tmp_path / "out", limits=QUICK)
    graded.write(tmp_path / "out")
    assert rows_of(tmp_path / "out" / "grades.csv")[0]["student"] == "'=HYPERLINK(1)"
    assert rows_of(tmp_path / "out" / "students.csv")[0]["student"] == "'=HYPERLINK(1)"


def test_a_check_that_fails_is_said_and_stops_nothing(tmp_path, monkeypatch):
    write_class(tmp_path / "class", 2, exercises=PAIR)
    monkeypatch.setattr("rodlab.lab.classroom.check_paths", lambda *_, **__: 1 / 0)
    graded = grade_class(tmp_path / "class", tmp_path / "out")
    assert {r["status"] for r in graded.records} == {"not judged"}
    assert all("the check failed: ZeroDivisionError" in r["message"] for r in graded.records)


def test_the_picture_counts_what_became_of_each_exercise():
    records = [
        {"exercise": "a", "status": status, "mistakes": mistakes}
        for status, mistakes in [
            ("right", ""),
            ("mistake", "f: sign"),
            ("mistake", "f: sign; g: half"),
            ("not readable", ""),
            ("wrong", ""),
        ]
    ]
    left, right = class_picture(records).axes
    widths = [bar.get_width() for bar in left.patches]
    assert widths == [1, 2, 1, 0, 1]
    assert [label.get_text() for label in right.get_yticklabels()] == ["a, f: sign", "a, g: half"]
    assert (
        class_picture([{"exercise": "a", "status": "right", "mistakes": ""}]).axes[1].texts[0].get_text() == "none was recognised"
    )


# --- a teacher ---------------------------------------------------------------------------------------------------------------

OWN = '''r"""# Twice

**Write** `twice(x)`, two times $x$.
"""

# %% answer
def twice(x):
    """Two times x."""
    ### BEGIN SOLUTION
    return x + x
    ### END SOLUTION


# %% checks
from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals
from rodlab.grading.values import Number

exercise = Exercise(
    title="Twice",
    source="mine",
    questions=(
        Question(
            name="twice",
            calls=lambda draw: [(draw.normal(),)],
            returns=Number(),
            properties=(equals(lambda x: 2 * x),),
            mistakes=(Mistake("square", "Is 2 times 3 nine?", lambda x: x * x),),
            hint="Add.",
        ),
    ),
)

# %% proofs
PROOFS = {"twice: square": ("x + x", "x * x")}
'''


def test_a_teacher_adds_an_exercise_in_one_file(tmp_path, capsys):
    source = tmp_path / "teacher" / "twice.py"
    source.parent.mkdir()
    source.write_text(OWN)
    assert main(["exercises", "--make", str(source)]) == 0
    folder = tmp_path / "twice"
    assert sorted(path.name for path in folder.iterdir()) == ["README.md", "answer.ipynb", "answer.py", "check.py"]
    assert "x + x" not in "".join(path.read_text() for path in folder.iterdir())
    own = ["--exercises", str(tmp_path)]
    assert main(["check", str(folder), *own]) == 1
    (folder / "answer.py").write_text(taught(source).mistaken()["twice: square"])
    assert main(["check", str(folder), *own]) == 1
    assert "Is 2 times 3 nine?" in capsys.readouterr().out
    (folder / "answer.py").write_text(taught(source).reference)
    assert main(["check", str(folder), *own]) == 0
    assert main(["exercises", *own]) == 0
    assert "twice  [mine]  Twice" in capsys.readouterr().out


def test_nbgrader_and_otter_get_notebooks_with_their_marks(tmp_path, capsys):
    source = str(ROOT / "exercises" / "teacher" / "two-joints.py")
    for kind in ("nbgrader", "otter"):
        assert main(["exercises", "--make", source, "--notebooks", kind, "--out", str(tmp_path / kind)]) == 0
    capsys.readouterr()
    nbgrader, otter = (
        json.loads((tmp_path / kind / "source" / "two-joints" / "two-joints.ipynb").read_text())["cells"]
        for kind in ("nbgrader", "otter")
    )
    marks = [cell["metadata"].get("nbgrader", {}) for cell in nbgrader]
    assert [(m.get("solution"), m.get("grade")) for m in marks] == [(None, None), (True, False), (False, True)]
    assert "    ### BEGIN SOLUTION\n" in nbgrader[1]["source"]
    assert "    # BEGIN SOLUTION\n" in otter[4]["source"]  # what `otter assign` looks for
    assert [cell["source"][0].split("\n")[0] for cell in otter if cell["cell_type"] == "raw"] == [
        "# ASSIGNMENT CONFIG", "# BEGIN QUESTION", "# BEGIN SOLUTION", "# END SOLUTION", "# BEGIN TESTS", "# END TESTS", "# END QUESTION",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("x = 1\n", "must have a docstring and the cells"),
        (OWN.replace("# %% proofs", "# %% prove"), "must have a docstring and the cells"),
        (OWN.replace("### BEGIN", "### START"), "must mark its solutions"),
    ],
)
def test_a_teachers_file_that_is_none_is_said(text, sentence, tmp_path):
    path = tmp_path / "teacher" / "twice.py"
    path.parent.mkdir()
    path.write_text(text)
    with pytest.raises(ValueError, match=sentence):
        make(path)


def test_an_edit_that_does_not_apply_is_said(tmp_path):
    path = tmp_path / "twice.py"
    path.write_text(OWN.replace('("x + x", "x * x")', '("x - x", "x * x")'))
    with pytest.raises(ValueError, match=r"'x - x' must be in the answer once; it is there 0 times"):
        taught(path).mistaken()


def test_solutions_are_not_in_what_is_installed():
    """The wheel leaves the teacher's tree out; a build is tried by hand, its rule is read here."""
    rule = (ROOT / "pyproject.toml").read_text()
    assert 'exclude = ["exercises/teacher"]' in rule
    assert np.all(
        ["SOLUTION" not in path.read_text() for path in (ROOT / "exercises").glob("*/*.*") if path.parent.name != "teacher"]
    )
    assert exercise("two-joints").points == 6.0
