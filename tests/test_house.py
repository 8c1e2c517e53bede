"""The public face, the house and the README are what they say."""

import importlib
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import rodlab
from rodlab import files
from rodlab.lab import store
from rodlab.mechanics.expression import Expression
from rodlab.mechanics.profile import Profile
from rodlab.numerics.quadrature import integrals

ROOT = Path(__file__).parents[1]
FENCE = re.compile(r"```(?:sh|python)\n(.*?)```", re.DOTALL)


def test_every_public_name_is_there_and_documented():
    assert sorted(rodlab._HOME) == sorted(rodlab.__all__)
    for name in rodlab.__all__:
        value = getattr(rodlab, name)
        assert value.__doc__
        assert importlib.import_module(f"rodlab.{rodlab._HOME[name]}").__dict__[name] is value
    assert set(rodlab.__all__) <= set(dir(rodlab))
    with pytest.raises(AttributeError, match="module 'rodlab' has no attribute 'Beam'"):
        _ = rodlab.Beam


def test_imports_only_go_down():
    done = subprocess.run(
        [shutil.which("lint-imports", path=str(Path(sys.executable).parent))],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout


def test_the_map_of_the_house_is_true():
    text = (ROOT / "README.md").read_text()
    house = text[text.index("## The house") :]
    for path in (ROOT / "rodlab").rglob("*.py"):
        if path.stem not in ("__init__", "__main__"):
            assert re.search(rf"\b{path.stem}\b", house), f"{path.stem} is not on the map"


def test_the_python_of_the_readme_runs():
    for block in FENCE.findall((ROOT / "README.md").read_text()):
        if "import rodlab" in block:
            exec(compile(block, "README.md", "exec"), {})


def test_the_commands_of_the_readme_are_those_of_ci():
    readme, ci = (ROOT / "README.md").read_text(), (ROOT / ".ci/run").read_text()
    command = re.search(r"<!-- test command -->\n+```sh\n(.*?)\n```", readme, re.DOTALL)
    assert command
    assert "pytest" in command[1]
    assert "<!-- test command -->" in ci


# --- expressions, profiles, integrals ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1 + 2*s", 2.0), ("-s**2 + 1", 0.75), ("2**-1", 0.5), ("(1 + s)/2", 0.75), ("pi*s", np.pi / 2),
        ("exp(s)", np.exp(0.5)), ("log(1 + s)", np.log(1.5)), ("sqrt(s)", np.sqrt(0.5)), ("sin(s) + cos(s)*tan(s)", 2 * np.sin(0.5)),
        ("Piecewise((1, s < 0.5), (2, True))", 2.0), ("Piecewise((1, s <= 0.5), (2, True))", 1.0), (" 1e-3 ", 1e-3),
        ("1 + Piecewise((s, s < 1/4), (2*s, s < 3/4), (0, True))", 2.0),
    ],
)  # fmt: skip
def test_expressions(text, value):
    f = Expression(text)
    assert f(np.array(0.5)) == pytest.approx(value, rel=1e-15)
    assert f(np.full((2, 3), 0.5)).shape == (2, 3)


@pytest.mark.parametrize(
    "text",
    [
        "", "s.real", "s[0]", "lambda s: s", "f(s)", "s if s else 1", "s and 1", "s < 1", "True", "'a'", "1j", "s // 2", "s % 2", "x",
        "exp(s, s)", "exp(x=s)", "exp", "exp()", "Piecewise()", "Piecewise((1, s < 2))", "Piecewise((1, True), (2, True))",
        "Piecewise((1, s > 0.5), (2, True))", "Piecewise((1, s < s), (2, True))", "Piecewise((1, s < 0.5), (1, s < 0.2), (2, True))",
        "open('x')", "(1).__class__", "[1]", "{}", "s; s", "s = 1", "1 +", "s\n+1", "__import__('os')", "f'{s}'", "*s", "(s := 1)",
        "-" * 5000 + "1",
    ],
)  # fmt: skip
def test_what_is_no_expression_is_refused(text):
    with pytest.raises(ValueError, match="is not an expression in s"):
        Expression(text)


def test_breaks_are_read_from_the_expression():
    assert Expression("Piecewise((1, s < 1/2), (2, s < 0.75), (3, True)) + Piecewise((1, s <= 1/2), (0, True))").breaks == (
        0.5,
        0.75,
    )


def test_integrals_meet_closed_forms():
    edges = np.linspace(0, 1, 7)
    assert integrals(lambda s: 1 / (1 + s), edges) == pytest.approx(np.diff(np.log1p(edges)), rel=1e-15)
    assert integrals(lambda s: 1 / (1e-4 + s**2), edges) == pytest.approx(np.diff(np.arctan(edges / 1e-2) / 1e-2), rel=1e-13)
    many = np.linspace(0, 1, 100_001)
    assert integrals(np.cos, many).sum() == pytest.approx(np.sin(1), rel=1e-14)
    jump = integrals(lambda s: np.where(s < 1 / np.pi, 0.0, 1.0), edges)  # undeclared, yet found
    assert jump.sum() == pytest.approx(1 - 1 / np.pi, rel=1e-14)


@pytest.mark.parametrize(
    "K", ["1 - s", "(1 - s)**2", "s", "Piecewise((0.3 - s, s < 0.3), (s - 0.3, True))", lambda s: abs(s - 0.5)]
)
def test_a_rod_that_is_infinitely_soft_somewhere_is_refused(K):
    for n in (2, 10, 101):
        with pytest.raises(ValueError, match="K must be"):
            rodlab.Strut(n=n, K=K, rule="trapezoid")


def test_a_function_that_changes_its_argument_changes_nothing_else():
    strut = rodlab.Strut(n=2, K=lambda s: s.__iadd__(1), u_hat="s")
    assert strut.joints.beta == pytest.approx([0.25, 0.5])


def test_many_pieces():
    pieces = ", ".join(f"({i}, s < {i}/100)" for i in range(1, 100))
    assert Expression(f"Piecewise({pieces}, (100, True))")(np.array([0.005, 0.505, 0.995])) == pytest.approx([1, 51, 100])


def test_profiles_take_what_the_readme_says():
    s = np.array([0.5, 1.0])
    for given in (2.0, [2.0, 2.0], lambda s: 2 + 0 * s, "2", lambda s: 2):
        assert Profile("K", given).at(s) == pytest.approx([2, 2])
        assert Profile("K", given).over(np.array([0.0, 0.5, 1.0])) == pytest.approx([1, 1])
        assert Profile("K", given).compliance_over(np.array([0.0, 0.5, 1.0])) == pytest.approx([0.25, 0.25])


# --- the lab --------------------------------------------------------------------------------------------------------------


def test_files_are_whole_or_absent(tmp_path):
    path = files.write_whole(tmp_path / "a" / "b.txt", "content")
    assert path.read_text() == "content"
    assert [p.name for p in path.parent.iterdir()] == ["b.txt"]
    with pytest.raises(ValueError, match=r"b\.txt.* cannot be written"):
        files.write_whole(path / "c", "content")
    assert path.read_text() == "content"


def test_a_failing_disk_leaves_the_old_file(tmp_path, monkeypatch):
    path = files.write_whole(tmp_path / "b.txt", "old")

    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.os, "fsync", full)
    with pytest.raises(ValueError, match="cannot be written: No space left on device"):
        files.write_whole(path, "new")
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["b.txt"]


def test_json_is_json_at_full_precision():
    text = store.as_json({"a": np.array([0.1, np.nan]), "b": np.float64(1 / 3), "c": [np.int64(3), np.inf], "d": (True, None)})
    assert json.loads(text) == {"a": [0.1, None], "b": 1 / 3, "c": [3, None], "d": [True, None]}


def test_csv_is_tidy():
    assert store.as_csv(["n", "load"], [[np.int64(2), 1 / 3], [3, None]]) == f"n,load\n2,{1 / 3!r}\n3,\n"
