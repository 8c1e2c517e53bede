"""The gallery of loads and ends: every scene runs, and what its `about` claims holds."""

import json

import matplotlib.image
import numpy as np
import pytest
from matplotlib.figure import Figure

from rodlab.cli import main
from rodlab.lab.running import answers_of, pictures, run_scene
from rodlab.lab.scene import run, scene
from rodlab.lab.shapes_picture import of_states, shapes_picture, states

NAMES = (
    "self-weight", "foundation", "end-torque", "end-force", "potential", "shearable", "clamped-hinged", "guided", "offset",
    "shortening", "dead-or-rigid",
)  # fmt: skip


@pytest.fixture(scope="module")
def ran():
    """Every scene's branches, followed once."""
    return {name: list(run(scene(name))) for name in NAMES}


def events(shown, kind):
    return [e.lam for s in shown for e in s.branch.events if e.kind == kind]


@pytest.mark.parametrize("name", NAMES)
def test_every_scene_arrives_and_is_drawn(ran, name):
    shown, chosen = ran[name], scene(name)
    assert all(s.branch.completed for s in shown)
    drawn = pictures(chosen, shown, answers_of(chosen))
    assert set(drawn) == {"diagram", "shapes"}
    found = states(shown, chosen.draw["shapes"])
    figure = shapes_picture(found, both=bool(chosen.draw.get("indices")))
    assert isinstance(figure, Figure)
    assert len([axes for axes in figure.axes if axes.get_visible()]) == len(found)


def test_what_the_scenes_claim(ran):
    assert events(ran["self-weight"], "branch point")[0] == pytest.approx(7.8373, abs=1e-4)
    assert events(ran["foundation"], "branch point")[:2] == pytest.approx([52.14, 52.35], abs=0.1)  # 50 joints
    arc = ran["end-torque"][0].branch
    assert all(p.tip_angle == pytest.approx(p.lam, abs=1e-12) and p.index == 0 for p in arc.points)
    assert len(events(ran["end-force"], "fold")) == 2
    assert len(events(ran["potential"], "fold")) == 2
    assert events(ran["shearable"], "branch point")[:2] == pytest.approx([3.472, 8.528], abs=1e-3)
    (buckles, *_), (turns, *_) = (events(ran["clamped-hinged"], kind) for kind in ("branch point", "fold"))
    assert (buckles, turns / buckles) == (pytest.approx(20.19, abs=0.01), pytest.approx(1.14, abs=0.001))
    assert events(ran["guided"], "branch point")[0] == pytest.approx(np.pi**2, abs=0.01)
    assert events(ran["offset"], "fold") == pytest.approx([0.2677], abs=1e-4)
    d = ran["shortening"][0].branch
    assert d.points[-1].measure("load") > 2 * d.points[0].measure("load")
    beyond = of_states(states(ran["dead-or-rigid"], [{"at": 4.0}]), both=True)
    assert [(s["dead_load"], s["shortening"]) for s in beyond] == [(0, 0), (1, 0)]
    both = of_states(states(ran["clamped-hinged"], scene("clamped-hinged").draw["shapes"]), both=True)
    assert [(s["dead_load"], s["shortening"]) for s in both] == [(0, 0), (1, 0)] * 2


def test_a_scene_on_the_command_line_writes_its_shapes(tmp_path, capsys):
    assert main(["run", "end-torque", "--out", str(tmp_path), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert [s["at"] for s in said["shapes"]] == [1.0, 2.5, 4.5, 6.0]
    assert matplotlib.image.imread(tmp_path / "shapes.png").shape[0] > 200


def test_points_of_a_shortening_carry_their_load(capsys):
    answer, _, complete = run_scene("shortening", None)
    assert complete
    point = answer["branches"][0]["points"][-1]
    assert point["load"] > 40
    assert point["shortening"] == pytest.approx(point["lam"], abs=1e-12)


@pytest.mark.parametrize(
    ("draw", "says"),
    [
        ("y = \"width\"", "takes y, one of tip_angle, height, energy, load, shortening, N1, tau, phi0"),
        ("shapes = 3", "shapes must be a list of tables of at"),
        ("shapes = [{of = \"arc\"}]", "shapes must be a list of tables of at"),
        ("shapes = [{of = \"bow\", at = 1.0}]", "of must be the name of a branch, one of arc; it is 'bow'"),
        ("shapes = [{at = 99.0}]", "at must be a value that the branch passes; arc does not pass 99"),
    ],
)  # fmt: skip
def test_bad_drawings_get_one_sentence(tmp_path, draw, says):
    text = f'[model]\nn = 5\n[[follow]]\nname = "arc"\nto = 1.0\n[draw]\n{draw}\n'
    (tmp_path / "own.toml").write_text(text)
    with pytest.raises(ValueError, match=says):
        run_scene(str(tmp_path / "own.toml"), tmp_path)


def test_every_scene_of_the_house_can_be_read():
    for name in (*NAMES, "agreement"):
        assert scene(name).about
