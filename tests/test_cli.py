"""The command line as a person or a checker meets it: exit codes, JSON, one sentence instead of a traceback."""

import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

import rodlab
from rodlab import cli


def run(*arguments, code=0):
    done = subprocess.run([sys.executable, "-m", "rodlab", *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stderr
    assert "Traceback" not in done.stderr
    return done


def test_alone_it_says_what_it_is_and_what_to_try(capsys):
    assert cli.main([]) == 0
    out = capsys.readouterr().out
    assert "a teaching laboratory for elastic rods" in out
    commands = [line.strip() for line in out.splitlines() if line.startswith("  rodlab ")]
    assert len(commands) == 5


def test_buckling_as_json(capsys):
    assert cli.main(["buckling", "-n", "1000", "--modes", "3", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["schema"] == 1
    assert answer["rodlab"] == rodlab.__version__
    assert answer["seconds"] > 0
    exact = [4e6 * np.sin((2 * j - 1) * np.pi / 4002) ** 2 for j in (1, 2, 3)]
    assert answer["loads"] == pytest.approx(exact, rel=1e-13)
    assert (np.abs(np.array(answer["loads"]) - exact) <= np.array(answer["error"]) + 1e-13 * np.array(exact)).all()


def test_buckling_of_a_rod_that_jumps(capsys):
    K = "Piecewise((1, s < 1/2), (1000, True))"
    assert cli.main(["buckling", "-n", "401", "--rule", "trapezoid", "--K", K, "--modes", "1", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["loads"][0] == pytest.approx(2.96015, rel=1e-4)


def test_buckling_for_a_person(capsys):
    assert cli.main(["buckling", "--K", "2", "-n", "10"]) == 0
    out = capsys.readouterr().out
    assert "mode" in out
    assert "error at most" in out
    assert out.count("\n") == 6


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["-n", "0"], "n must be a whole number, at least 1; it is 0"),
        (["-n", "-3"], "n must be a whole number"),
        (["-n", "many"], "argument -n: invalid int value: 'many'"),
        (["--K", "-1"], "K must be a finite number above 0; it is -1.0"),
        (["--K", "nan"], "K must be a finite number"),
        (["--K", "1e400"], "K must be a finite number"),
        (["--K", "__import__('os').getcwd()"], "is not an expression in s"),
        (["--K", "s - 1/2"], "K must be positive"),
        (["--K", "9**9**9**9"], "K must be finite"),
        (["--K", "(" * 500], "is not an expression in s"),
        (["--modes", "0"], "modes must be a whole number, at least 1"),
        (["--modes", "11", "-n", "10"], "modes must be at most n = 10"),
        (["--rule", "middle"], "rule must be one of 'end', 'trapezoid'"),
        (["--breaks", "2"], "breaks must lie between 0 and 1"),
        (["--breaks", "x"], "invalid float value"),
        (["--model", "beam"], "invalid choice: 'beam'"),
        (["-n", "9" * 30], "rodlab buckling: "),
        (["--no-such-option"], "unrecognized arguments"),
    ],
)
def test_bad_usage_is_code_2_and_one_sentence(arguments, says, capsys):
    try:
        code = cli.main(["buckling", *arguments])
    except SystemExit as stop:  # argparse
        code = stop.code
    seen = capsys.readouterr()
    assert code == 2
    assert says in seen.err
    assert seen.out == ""
    assert "Traceback" not in seen.err


def test_fewer_joints_than_three_have_fewer_loads(capsys):
    assert cli.main(["buckling", "-n", "2", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["loads"]) == 2


def test_json_alone(capsys):
    assert cli.main(["--json"]) == 0
    assert "rodlab tour" in str(json.loads(capsys.readouterr().out)["welcome"])


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_disk_is_said():
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "rodlab", "buckling", "-n", "3"], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    assert "cannot be written" in done.stderr


def test_an_unknown_verb_is_code_2():
    assert "invalid choice" in run("bend", code=2).stderr


def test_no_convergence_is_code_3(monkeypatch, capsys):
    def buckling(_):
        raise rodlab.NoConvergence("Newton did not converge: a reason", ())

    monkeypatch.setattr(cli, "buckling", buckling)
    assert cli.main(["buckling"]) == 3
    assert capsys.readouterr().err == "rodlab buckling: Newton did not converge: a reason\n"


def test_an_interrupt_ends_quietly(monkeypatch, capsys):
    def buckling(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "buckling", buckling)
    assert cli.main(["buckling"]) == 130
    assert "interrupted" in capsys.readouterr().err


@pytest.mark.skipif(os.name != "posix", reason="pipes of a POSIX shell")
def test_a_closed_pipe_is_no_error():
    done = subprocess.run(
        f"{sys.executable} -m rodlab buckling -n 2000 --modes 800 --json | head -1",
        shell=True,
        capture_output=True,
        text=True,
        check=False,
    )
    assert "Traceback" not in done.stderr


# --- imports on demand -----------------------------------------------------------------------------------------------


def imported_by(code):
    script = f"import sys\n{code}\nprint(*sorted({{name.split('.')[0] for name in sys.modules}}), file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(done.stderr.split())


HEAVY = {"numpy", "scipy", "sympy", "matplotlib"}


def test_import_rodlab_brings_nothing_heavy():
    assert not imported_by("import rodlab; dir(rodlab)") & HEAVY


def test_help_brings_nothing_heavy():
    assert not imported_by("import rodlab.cli\ntry: rodlab.cli.main(['--help'])\nexcept SystemExit: pass") & HEAVY


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
def test_buckling_never_imports_sympy_or_matplotlib(rule):
    for K in ("1", "1 + s"):
        seen = imported_by(f"import rodlab.cli; rodlab.cli.main(['buckling', '--rule', '{rule}', '--K', '{K}'])")
        assert "numpy" in seen
        assert not seen & {"sympy", "matplotlib", "tqdm"}


def test_equilibria_never_import_sympy():
    code = "import rodlab as rl; p = rl.equilibrium(rl.Strut(n=9, u_hat='s', rule='trapezoid'), 5.0); p.index, p.error, p.x"
    assert not imported_by(code) & {"sympy", "matplotlib"}


# --- the tour ------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def toured(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tour")
    return folder, run("tour", "--out", str(folder / "new" / "folder")).stdout, folder / "new" / "folder"


def test_the_tour_tells_and_writes(toured):
    _, out, folder = toured
    names = {path.name for path in folder.iterdir()}
    assert names == {"loads.png", "shapes.png", "loads.csv", "equilibria.csv", "tour.json"}
    assert (folder / "loads.png").read_bytes().startswith(b"\x89PNG")
    assert 'rule "trapezoid"' in out
    assert "rod, exact" in out


def test_the_numbers_of_the_tour_are_true(toured):
    answer = json.loads((toured[2] / "tour.json").read_text())
    for entry in answer["loads"]:
        if entry["order"] is not None and entry["n"] >= 64:
            assert entry["order"] == pytest.approx({"end": 1, "trapezoid": 2}[entry["rule"]], abs=0.1)
    for entry in answer["extrapolated"]:
        assert entry["error"] <= entry["estimate"] < 1e-8
        assert entry["limit"] == pytest.approx(((2 * entry["mode"] - 1) * np.pi / 2) ** 2, rel=1e-15)
    indices = {}
    for entry in answer["equilibria"]:
        assert entry["index_verified"]
        indices.setdefault(round(entry["lam"], 6), []).append((entry["branch"], entry["index"]))
    assert list(indices.values()) == [
        [("straight", 0)],
        [("straight", 1), ("mode 1", 0)],
        [("straight", 1), ("mode 1", 0)],
        [("straight", 2), ("mode 1", 0), ("mode 2", 1)],
    ]


def test_the_tour_says_where_it_cannot_write(tmp_path):
    (tmp_path / "file").write_text("mine")
    assert "cannot be written" in run("tour", "--out", str(tmp_path / "file"), code=2).stderr
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_a_killed_tour_leaves_no_broken_file(tmp_path, toured):
    """Old files stay whole until new ones are: killed at any moment, each is either."""
    for name in ("tour.json", "loads.png"):
        (tmp_path / name).write_bytes((toured[2] / name).read_bytes())
    for delay in (0.6, 1.2, 1.8):
        process = subprocess.Popen(
            [sys.executable, "-m", "rodlab", "tour", "--out", str(tmp_path)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        try:
            process.wait(delay)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.wait()
        assert json.loads((tmp_path / "tour.json").read_text())["schema"] == 1
        assert (tmp_path / "loads.png").read_bytes()[-8:] == b"IEND\xaeB`\x82"
