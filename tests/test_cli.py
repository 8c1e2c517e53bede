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
from rodlab.lab.studies.study import KINDS

LOADS = (  # scenes that have tests of their own
    "foundation", "end-torque", "end-force", "potential", "shearable", "clamped-hinged", "guided", "offset", "shortening",
    "dead-or-rigid", "agreement",
)  # fmt: skip


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


# --- branches and scenes -------------------------------------------------------------------------------------------------


def test_follow_as_json(capsys):
    assert cli.main(["follow", "-n", "50", "--u-hat", "0.01", "--to", "30", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["schema"] == 1
    assert answer["end"] == "lam = 30 reached"
    assert set(answer["points"][0]) >= {"lam", "tip_angle", "height", "energy", "index", "accepted", "error"}
    assert answer["points"][0]["lam"] == 0.0
    assert answer["points"][-1]["lam"] == 30.0
    upper = rodlab.equilibrium(rodlab.Strut(n=50, u_hat=0.01), 30.0, lambda s: 3.1 * np.sin(np.pi * s / 2) ** 0.3)
    assert answer["points"][-1]["tip_angle"] == pytest.approx(upper.tip_angle, abs=1e-12)
    assert all(p["index"] == 0 and p["accepted"] in ("given", "proved") for p in answer["points"])
    assert [set(e) >= {"kind", "lam", "error"} for e in answer["events"]] == [True]


def test_follow_a_mode_from_its_branch_point(capsys):
    assert cli.main(["follow", "-n", "1000", "--mode", "2", "--to", "40", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["points"][0]["lam"] == pytest.approx(22.2, abs=0.1)
    assert {p["index"] for p in answer["points"]} == {1}
    assert answer["points"][-1]["lam"] == 40.0


def test_follow_a_detached_branch_for_a_person(capsys, tmp_path):
    out = tmp_path / "b.json"
    arguments = ["follow", "-n", "50", "--u-hat", "0.01", "--from", "10", "--guess=-3*sin(pi*s/2)", "--to", "0"]
    assert cli.main([*arguments, "--step", "0.5", "--out", str(out)]) == 0
    text = capsys.readouterr().out
    assert "fold" in text
    assert "back at lam = 10" in text
    b = rodlab.read(out)
    assert b.events[0].lam == pytest.approx(2.51235753616, abs=1e-10)


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (["--to", "nan"], 2, "to must be a finite number; it is nan"),
        (["--to", "5", "--from", "inf"], 2, "from must be a finite number"),
        (["--to", "0"], 2, "to must differ from the load of p"),
        (["--to", "5", "--step", "-1"], 2, "step must be a finite number above 0"),
        (["--to", "5", "--mode", "0"], 2, "a mode number must be a whole number, at least 1"),
        (["--to", "5", "--mode", "200"], 2, "modes must be at most n = 100"),
        (["--to", "5", "--mode", "3"], 2, "to must be above the load of mode 3"),
        (["--to", "5", "--mode", "1", "--u-hat", "0.1"], 2, "model must be straight to buckle"),
        (["--to", "5", "--mode", "1", "--guess", "s"], 2, "guess must not be given with mode"),
        (["--to", "5", "--guess", "import os"], 2, "is not an expression in s"),
        (["--to", "5", "--u-hat", "x"], 2, "is not an expression in s"),
        (["--to", "5", "--max-points", "0"], 2, "max_points must be a whole number, at least 1"),
        (["--to", "5", "--mode", "1", "--from", "1"], 2, "from must not be given with mode"),
        (["--to", "5", "--out", "b.pkl"], 2, "path must end in .json or .npz"),
        ([], 2, "--to"),
    ],
)
def test_follow_says_what_is_wrong(arguments, code, says, capsys):
    try:
        found = cli.main(["follow", *arguments])
    except SystemExit as stop:
        found = stop.code
    seen = capsys.readouterr()
    assert found == code
    assert says in seen.err
    assert "Traceback" not in seen.err


def test_scenes_are_listed(capsys):
    assert cli.main(["scenes"]) == 0
    out = capsys.readouterr().out
    assert "imperfect " in out
    assert cli.main(["scenes", "--json"]) == 0
    names = [s["name"] for s in json.loads(capsys.readouterr().out)["scenes"]]
    assert {"strut", "imperfect", "two-joints", "bend", "self-weight"} <= set(names)


def scene_names():
    from rodlab.lab.scene import scenes

    return [s.name for s in scenes()]


TRUTHS = {
    "two-joints": [("branch point", (3 - 5**0.5) / 2, 1e-12), ("branch point", (3 + 5**0.5) / 2, 1e-12)],
    "self-weight": [("branch point", 7.8373474, 1e-4)],
    "stiffness-jump": [("branch point", 2.96015, 1e-4)],
    "bend": [("fold", -0.1438649097, 1e-9), ("fold", 0.1438649097, 1e-9)],
    "many-loads": [("branch point", 4e6 * np.sin((2 * j - 1) * np.pi / 4002) ** 2, 1e-8) for j in range(1, 33)],
}


@pytest.mark.parametrize(
    "name", [name for name in scene_names() if name not in (*KINDS, *LOADS)]
)  # these have tests of their own
def test_every_scene_of_the_house_runs(name, tmp_path, capsys):
    assert cli.main(["run", name, "--out", str(tmp_path), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert all(b["completed"] for b in answer["branches"])
    assert {path.name for path in tmp_path.iterdir()} == {path.split("/")[-1] for path in answer["files"]}
    assert json.loads((tmp_path / "scene.json").read_text())["scene"] == name
    assert any(path.suffix == ".png" for path in tmp_path.iterdir()) == (name != "many-loads")
    asked = set(answer) & {"diagram", "equilibria", "breaking"}
    assert bool(answer["branches"]) != bool(asked)
    if asked:
        return
    found = [(e["kind"], e["lam"]) for e in answer["branches"][0]["events"] if e["kind"] != "end"]
    for (kind, lam), (wanted, exact, within) in zip(found, TRUTHS[name], strict=True) if name in TRUTHS else ():
        assert kind == wanted
        assert lam == pytest.approx(exact, abs=within)
    assert len(rodlab.read(tmp_path / "branch-1.json").points) == len(answer["branches"][0]["points"])


def test_a_scene_of_ones_own(tmp_path, capsys):
    mine = tmp_path / "mine.toml"
    mine.write_text('[model]\nn = 4\nu_hat = "s"\n[[follow]]\nto = 3\nstep = 0.5\nevents = []\nwithin = {tip_angle = [0, 0.9]}\n')
    assert cli.main(["run", str(mine)]) == 0
    assert "branch 1" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[model", "is not TOML"),
        ("", "a scene needs a [model] table"),
        ("[model]\nn = 3", "a scene needs at least one [[follow]] table"),
        ("[model]\nn = 3\n[[follow]]\nfrom = 1", "to is missing"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\nuntil = 2", "until is none of these"),
        ("[model]\nn = 3\n[[follow]]\nto = 'x'", "to must be a finite number"),
        ("[model]\nm = 3\n[[follow]]\nto = 1", "a model must be made of"),
        ("[model]\nn = 3\nterms = {wind = {p = 1}}\n[[follow]]\nto = 1", "terms must be among"),
        ("[model]\nn = 3\nterms = {self_weight = {p = 1}}\n[[follow]]\nto = 1", "terms.self_weight has the wrong parameters"),
        ("[model]\nn = 3\nlam = 2\n[[follow]]\nto = 1", "lam must be given in a model only with vary"),
        ("[model]\nn = 3\nvary = 'K'\n[[follow]]\nto = 1", "lam must be given where K is followed"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\nevents = ['hopf']", "events must be a list of"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\nevents = 'fold'", "events must be a list of"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\nwithin = 3", "within must be a table"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\nwithin = {tip_angle = 3}", "within must map measures to (low, high)"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\n[draw]\ny = 'foo'", "[draw] takes y, one of tip_angle"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\nswitch = -1", "switch must be a whole number"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\n[draw]\nx = 'lam'", "[draw] takes y"),
        ("[model]\nn = 3\n[[follow]]\nto = 1\n[colour]\nx = 1", "colour is none of these"),
        ("model = 3\n[[follow]]\nto = 1", "a scene needs a [model] table"),
        ("[model]\nn = 3\n[diagram]\nfrom = 1", "to must be a finite number"),
        ("[model]\nn = 3\n[diagram]\nto = 1\nup = 2", "[diagram] takes from, to, detached; up is none of these"),
        ("diagram = 3\n[model]\nn = 3", "[diagram] takes from, to, detached; 3 is none of these"),
        ("[model]\nn = 3\n[equilibria]\nlam = 1\nn = 3", "n must be a list"),
        ("[model]\nmodel = 'rod'\n[equilibria]\nlam = 1", "[equilibria] asks of a strut"),
        ("[model]\nn = 3\nu_hat = 1.0\n[breaking]\n", "[breaking] asks of a straight strut"),
        ("[model]\nn = 3\n[breaking]\nparameter = 'q'", "name must be a parameter of the strut"),
    ],
)
def test_a_wrong_scene_gets_a_sentence(text, says, tmp_path, capsys):
    (tmp_path / "mine.toml").write_text(text)
    assert cli.main(["run", str(tmp_path / "mine.toml"), "--out", str(tmp_path / "out")]) == 2
    seen = capsys.readouterr()
    assert says in seen.err
    assert not (tmp_path / "out").exists()


def test_a_scene_that_is_not_there(capsys):
    assert cli.main(["run", "nowhere"]) == 2
    assert "scene must be one of agreement, bend" in capsys.readouterr().err
    assert cli.main(["run", "nowhere.toml"]) == 2
    assert "cannot be read" in capsys.readouterr().err


# --- diagrams and equilibria ------------------------------------------------------------------------------------------


def test_equilibria_as_json(capsys):
    assert cli.main(["equilibria", "-n", "5", "--lam", "60", "--certify", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["certified"] is True
    assert answer["index_sum"] == 1
    assert answer["count"] == len(answer["equilibria"]) == 19
    strut = rodlab.Strut(n=5)
    for one in answer["equilibria"]:
        assert np.abs(strut.gradient(one["phi"], 60.0)).max() < 1e-12
        assert strut.hessian(one["phi"], 60.0).index == one["index"]
        assert strut.energy(one["phi"], 60.0) == one["energy"]
    assert [one["standing"] for one in answer["equilibria"]].count("parasite") == 12


def test_equilibria_for_a_person(capsys, tmp_path):
    assert cli.main(["equilibria", "--lam", "60", "--out", str(tmp_path / "map.svg")]) == 0
    out = capsys.readouterr().out
    assert "19 in all: 8 of index 0" in out
    assert "12 are not: parasites of the discretisation" in out
    assert "certified: one turn" in out
    assert (tmp_path / "map.svg").read_text().startswith("<?xml")
    assert cli.main(["equilibria", "-n", "8", "--lam", "200", "--no-certify", "--no-connected"]) == 0
    out = capsys.readouterr().out
    assert "not certified: nothing was proved" in out
    assert "(the first 40 of" in out


def test_certify_is_a_check_that_may_fail(capsys):
    assert cli.main(["equilibria", "-n", "10", "--lam", "100"]) == 0
    assert "not certified: 1 degenerate:" in capsys.readouterr().out
    assert cli.main(["equilibria", "-n", "10", "--lam", "100", "--certify", "--json"]) == 1
    seen = capsys.readouterr()
    assert json.loads(seen.out)["certified"] is False
    assert "not certified" in seen.err


def test_a_diagram_as_json(capsys, tmp_path):
    out = tmp_path / "d.png"
    assert cli.main(["diagram", "-n", "20", "--to", "70", "--json", "--out", str(out)]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["complete"] is True
    assert [b["images"] for b in answer["branches"]] == [1, 2, 2, 2]
    assert [row["solutions"] for row in answer["counts"]] == [1, 3, 5, 7]
    kinds = [row["kind"] for row in answer["table"]]
    assert kinds.count("supercritical pitchfork") == 3
    assert kinds.count("end") == 4
    assert out.read_bytes()[:4] == b"\x89PNG"


def test_a_diagram_for_a_person(capsys):
    assert cli.main(["diagram", "-n", "5", "--to", "50", "--detached"]) == 0
    out = capsys.readouterr().out
    assert "supercritical pitchfork" in out
    assert "not connected to the start: the branches 4, 5, 6" in out
    assert "mirror images, counted and not listed" in out


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["equilibria", "--lam", "nan"], "lam must be a finite number"),
        (["equilibria", "-n", "0", "--lam", "1"], "n must be a whole number"),
        (["equilibria", "--lam", "1", "--out", "map.gif"], "out must end in .png, .pdf, .svg"),
        (["equilibria", "--lam", "1", "--u-hat", "0.1", "--out", "map.png"], "standard map"),
        (["diagram", "--to", "-1"], "low < high"),
        (["diagram", "--to", "3", "--out", "d"], "out must end in"),
        (["diagram", "--to", "3", "--K", "import os"], "K"),
    ],
)
def test_wrong_questions_get_a_sentence(arguments, says, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert cli.main(arguments) == 2
    assert says in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_follow_never_imports_sympy_or_matplotlib():
    seen = imported_by("import rodlab.cli; rodlab.cli.main(['follow', '-n', '10', '--u-hat', '0.1', '--to', '5'])")
    assert not seen & {"sympy", "matplotlib", "tqdm"}


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


@pytest.mark.parametrize("verb", ["['diagram', '-n', '3', '--to', '5']", "['equilibria', '--lam', '60']"])
def test_without_a_picture_nothing_draws(verb):
    seen = imported_by(f"import rodlab.cli; rodlab.cli.main({verb})")
    assert "numpy" in seen
    assert not seen & {"sympy", "matplotlib"}


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
    data = {"loads.csv", "routes.csv", "equilibria.csv", "branches.csv", "tour.json"}
    assert names == {"diagram.png", "loads.png", "routes.png", "shapes.png"} | data
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
    branches = {entry["branch"]: entry for entry in answer["branches"]}
    assert list(branches) == ["straight", "mode 1", "mode 2", "mode 3", "imperfect", "detached"]
    assert "fold 2.8966" in branches["detached"]["events"]
    for entry in branches.values():
        assert entry["proved"] + entry["checked"] >= entry["points"] - 1
        assert entry["proved"] >= 2 * entry["checked"] or entry["branch"] == "straight"
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


def test_the_rod_on_the_command_line(capsys):
    assert cli.main(["buckling", "--model", "rod", "--K", "(1+s)**2", "--modes", "2", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["model"] == "rod"
    assert answer["loads"][0] == pytest.approx(3.836376917668575, rel=1e-12)
    assert all(error < 1e-11 for error in answer["error"])
    assert cli.main(["follow", "--model", "rod", "--u-hat", "0.01", "--to", "4", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["points"][-1]["lam"] == 4.0
    assert answer["points"][-1]["error"] < 1e-9
    assert cli.main(["follow", "--model", "rod", "--mode", "1", "--to", "5", "--mesh", "6", "--degree", "8"]) == 0
    assert "2.190662" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--model", "rod", "-n", "10"], "n must not be given for a rod"),
        (["--degree", "3"], "degree must not be given for a strut"),
        (["--model", "rod", "--degree", "0"], "degree must be"),
        (["--model", "rod", "--mesh", "-1"], "mesh must be"),
        (["--model", "rod", "--tol", "0"], "tol must be"),
        (["--model", "rod", "--K", "s - 2"], "K must be positive"),
        (["--model", "rod", "--K", "foo"], "K: 'foo' is not an expression"),
    ],
)
def test_wrong_options_of_a_rod(capsys, options, said):
    assert cli.main(["buckling", *options]) == 2
    assert said in capsys.readouterr().err


# --- ends and loads ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "loads", "within"),
    [
        (["--ends", "clamped,clamped"], [4 * np.pi**2, 80.7629142257], 1e-4),
        (["--model", "rod", "--ends", "clamped, hinged"], [20.1907285564, 59.6795159441], 1e-9),
        (["--model", "rod", "--ends", "hinged,hinged", "--K", "2"], [2 * np.pi**2, 8 * np.pi**2], 1e-9),
        (["--model", "rod", "--ends", "clamped,free"], [np.pi**2 / 4, 9 * np.pi**2 / 4], 1e-9),
        (["--model", "rod", "--term", "shearable A3=50 A1=inf"], [25 - (625 - 12.5 * np.pi**2) ** 0.5], 1e-9),
        (["--model", "rod", "--ends", "hinged,hinged", "--term", "foundation c=5"], [np.pi**2 + 5 / np.pi**2], 1e-9),
        (["--term", "potential U=7.8373474*z"], [0.0], 0.03),
    ],
)
def test_buckling_between_ends_and_under_loads(options, loads, within, capsys):
    assert cli.main(["buckling", *options, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["loads"][: len(loads)]
    assert found == pytest.approx(loads, rel=within, abs=within)


def test_the_answer_says_ends_and_terms(capsys):
    arguments = ["buckling", "-n", "50", "--ends", "clamped,hinged", "--term", "self_weight q=-2", "--term", "foundation c=1 + s"]
    assert cli.main([*arguments, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    recipe = {name: answer[name] for name in ("n", "ends", "terms")}
    assert recipe == {"n": 50, "ends": ["clamped", "hinged"], "terms": {"self_weight": {"q": -2.0}, "foundation": {"c": "1 + s"}}}
    strut = rodlab.Strut(n=50, ends=("clamped", "hinged"), terms=(rodlab.self_weight(-2.0), rodlab.foundation("1 + s")))
    assert answer["loads"] == rodlab.buckling_loads(strut, 3).tolist()
    assert cli.main(arguments) == 0
    said = capsys.readouterr().out
    for part in ("ends=('clamped', 'hinged')", "self_weight(q=-2.0)", "foundation(c='1 + s')"):
        assert part in said


def test_an_expression_with_comparisons_is_one_value(capsys):
    K = "foundation c=Piecewise((1, s <= 1/2), (3, True))"
    assert cli.main(["buckling", "-n", "20", "--term", K, "--modes", "1", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["terms"] == {"foundation": {"c": "Piecewise((1, s <= 1/2), (3, True))"}}


def test_without_a_number_of_modes_there_are_as_many_as_there_are(capsys):
    for options, count in ((["-n", "3", "--ends", "clamped,clamped"], 1), (["--term", "shearable A3=50"], 2)):
        assert cli.main(["buckling", *options, "--json"]) == 0
        answer = json.loads(capsys.readouterr().out)
        assert len(answer["loads"]) == len(answer["error"]) == count
        assert answer["modes"] == list(range(1, count + 1))
        assert cli.main(["buckling", *options, "--modes", "3"]) == 2
        assert f"modes must be at most {count}" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "begins"),
    [
        (["--model", "rod", "--ends", "clamped,hinged", "--to", "22"], 20.1907285564),
        (["-n", "20", "--term", "self_weight q=10", "--to", "1"], -1.2048531879),  # the load of the first mode is a pull
        (
            ["-n", "20", "--term", "shearable A3=50", "--mode", "2", "--to", "48"],
            47.5306912311,
        ),  # the last below the crushing one
        (["-n", "20", "--ends", "clamped,clamped", "--mode", "2", "--to", "85"], 79.5439725425),
    ],
)
def test_follow_a_mode_between_ends_and_under_loads(options, begins, capsys):
    assert cli.main(["follow", "--mode", "1", *options, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["completed"]
    assert answer["points"][0]["lam"] == pytest.approx(begins, abs=0.2)
    assert answer["points"][-1]["lam"] == float(options[-1])


def test_a_diagram_between_ends(capsys, tmp_path):
    out = tmp_path / "d.svg"
    assert cli.main(["diagram", "-n", "8", "--ends", "clamped,hinged", "--to", "20", "--json", "--out", str(out)]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["ends"] == ["clamped", "hinged"]
    assert [row["kind"] for row in answer["table"]].count("supercritical pitchfork") == 1
    assert out.exists()


def test_equilibria_under_loads(capsys):
    terms = ["--term", "self_weight q=2", "--term", "end_torque tau=0.3"]
    assert cli.main(["equilibria", "--lam", "10", *terms, "--certify", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["terms"] == {"self_weight": {"q": 2.0}, "end_torque": {"tau": 0.3}}
    strut = rodlab.Strut(n=5, terms=(rodlab.self_weight(2.0), rodlab.end_torque(0.3)))
    assert len(answer["equilibria"]) == len(rodlab.all_equilibria(strut, 10.0))


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (
            ["buckling", "--ends", "clamped"],
            "ends must be two of 'clamped', 'hinged', 'guided', 'free', the foot first; they are",
        ),
        (["buckling", "--ends", "clamped,welded"], "they are ['clamped', 'welded']"),
        (["buckling", "--ends", ""], "ends must be two of"),
        (["buckling", "--term", ""], "term must be a name and its parameters, such as"),
        (["buckling", "--term", "self_weight"], "it is 'self_weight'"),
        (["buckling", "--term", "self_weight 2"], "it is 'self_weight 2'"),
        (["buckling", "--term", "self_weight q="], "it is 'self_weight q='"),
        (["buckling", "--term", "self_weight(q=2)"], "it is 'self_weight(q=2)'"),
        (["buckling", "--term", "self_weight q=2 q=3"], "term must give each parameter once"),
        (["buckling", "--term", "self_weight q=2", "--term", "self_weight q=3"], "self_weight is given twice"),
        (["buckling", "--term", "wind p=2"], "terms must be among self_weight, foundation"),
        (["buckling", "--term", "self_weight p=2"], "it takes q"),
        (["buckling", "--term", "self_weight q=nan"], "q must be a finite number; it is nan"),
        (["buckling", "--term", "foundation c=inf"], "c must be a finite number; it is inf"),
        (["buckling", "--term", "foundation c=__import__('os').getcwd()"], "is not an expression in s"),
        (["buckling", "--term", "end_force N1=s"], "N1 must be a finite number; it is 's'"),
        (["buckling", "--term", "shearable A3=s"], "A3 must be a positive number, or infinite; it is 's'"),
        (["buckling", "--term", "potential U=q"], "is not an expression in x and z"),
        (["buckling", "--term", "potential U=2"], "U must be an expression in x and z"),
        (["buckling", "--term", "end_force N1=0.5"], "model must be straight to buckle"),
        (["buckling", "-n", "2", "--ends", "hinged,clamped"], "modes must be at most 0, the number of loads"),
        (["follow", "--to", "5", "--ends", "clamped,hinged", "--term", "end_force N1=1"], "there it is a reaction"),
        (["follow", "--to", "5", "-n", "9", "--mode", "1", "--ends", "hinged,free"], "mode must be one that has a load"),
        (["diagram", "--to", "5", "--term", "wind p=2"], "terms must be among"),
        (["equilibria", "--lam", "5", "--term", "foundation c=1"], "the terms must be self_weight or end_torque"),
    ],
)
def test_wrong_ends_and_terms_get_a_sentence(arguments, says, capsys):
    assert cli.main(arguments) == 2
    seen = capsys.readouterr()
    assert says in seen.err
    assert seen.err.count("\n") == 1
    assert seen.out == ""
