"""The other methods and the peers of the work-precision study: right to their orders, and open about what they miss."""

import importlib.util
import math
import shutil

import numpy as np
import pytest

import rodlab as rl
from rodlab.lab.studies import other_methods as others
from rodlab.lab.studies import peers
from rodlab.lab.studies.asked import Question
from rodlab.mechanics import elastica

OTHERS = {method.name: method for method in others.other_methods()}
PEERS = {method.name: method for method in peers.peers()}
BVP, IVP, AUTO = PEERS
ALL = OTHERS | PEERS
MODE_1, MODE_2 = Question("tip_angle"), Question("tip_angle", mode=2)
# sizes whose last two show the order: fine enough for theory, above rounding
ORDERS = {
    "collocation of (phi, m), degree 1": (64, 128),
    "collocation of (phi, m), degree 2": (16, 32),
    "collocation of (phi, m), degree 4": (8, 16),
    'strut, shooting, "end"': (256, 1024),
    'strut, shooting, "trapezoid"': (256, 1024),
    'strut, steepest descent, "end"': (16, 32),
    'strut, steepest descent, "trapezoid"': (8, 16),
    AUTO: (5, 10),
}
NEEDS_AUTO = pytest.mark.skipif(bool(peers.auto_missing()), reason=peers.auto_missing() or "AUTO is here")


def each(names):
    return [pytest.param(name, marks=NEEDS_AUTO) if name == AUTO else name for name in names]


def answer(name, question, size):
    method = ALL[name]
    return method.solve(question, method.setup(question, size))


def error(name, question, size):
    exact = rl.elastica(question.lam or 2 * ((2 * question.mode - 1) * np.pi / 2) ** 2, question.mode)
    found = answer(name, question, size)
    assert not found.note.startswith(("refused", "wrong")), found
    return abs(found.value - exact.tip_angle)


# --- right -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", each(ORDERS))
def test_order(name):
    coarse, fine = ORDERS[name]
    errors = [error(name, MODE_1, size) for size in (coarse, fine)]
    assert errors[1] > 1e-14
    assert abs(math.log(errors[0] / errors[1]) / math.log(fine / coarse) - ALL[name].order) < 0.1


def test_every_order_is_tested():
    assert {name for name, method in ALL.items() if method.order} == set(ORDERS)


@pytest.mark.parametrize("question", [MODE_1, MODE_2, Question("tip_angle", lam=2.6)], ids=["1", "2", "near"])
@pytest.mark.parametrize("name", [BVP, IVP])
def test_tolerances(name, question):
    for tol in PEERS[name].sizes[:9]:
        assert error(name, question, tol) < 10 * tol


def test_elliptic_functions_are_exact_and_not_remembered():
    (name,) = [name for name in OTHERS if name.startswith("elliptic")]
    for question in (MODE_1, MODE_2):
        found = answer(name, question, 0.0)
        assert error(name, question, 0.0) <= found.bound
        assert elastica._modulus.cache_info().hits <= 1  # of the yardstick here, none of the method's
        before = elastica._modulus.cache_info().misses
        assert answer(name, question, 0.0).value == found.value
        assert elastica._modulus.cache_info().misses == before == 1


@pytest.mark.parametrize("name", [name for name in OTHERS if "shooting" in name])
@pytest.mark.parametrize("question", [MODE_1, MODE_2, Question("tip_angle", mode=2, lam=60.0), Question("tip_angle", lam=60.0)])
def test_shooting_is_newtons_root_within_its_bound(name, question):
    found = answer(name, question, 60)
    asked = others.posed(question)
    strut = rl.Strut(n=60, rule=name.split('"')[1])
    shape = rl.elastica(asked.lam, asked.mode)
    p = rl.equilibrium(strut, asked.lam, shape(strut.joints.s).phi)
    assert not found.note
    assert abs(found.value - p.tip_angle) <= found.bound + p.error
    assert found.bound < 1e-10


@pytest.mark.parametrize("name", each(ALL))
def test_only_the_load_by_the_stiffness_counts(name):
    size = ALL[name].sizes[1] if len(ALL[name].sizes) > 1 else 0.0
    thrice = Question("tip_angle", lam=15.0, K=3.0)
    assert answer(name, thrice, size).value == pytest.approx(answer(name, Question("tip_angle", lam=5.0), size).value, abs=1e-12)


# --- open about what they miss ---------------------------------------------------------------------------------------


def test_collocation_says_where_it_lands():
    far = Question("tip_angle", lam=25.0)
    assert answer("collocation of (phi, m), degree 4", far, 2).note == "wrong: landed on mode 2"
    lost = answer("collocation of (phi, m), degree 4", far, 8)
    assert lost.note.startswith("refused: collocation did not converge")
    assert math.isnan(lost.value)


def test_shooting_tells_a_parasite():
    found = answer('strut, shooting, "end"', Question("tip_angle", lam=1000.0), 4)
    assert found.note == "wrong: lost mode 1: 3 by the zeros of phi, index 1"


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
def test_descent_knows_minima_only(rule):
    assert answer(f'strut, steepest descent, "{rule}"', MODE_2, 8).note.startswith("refused: steepest descent goes to minima")


def test_solve_bvp_falls_to_zero_silently_but_we_say_so():
    method = PEERS[BVP]
    given = method.setup(MODE_1, 1e-6)
    found = method.solve(MODE_1, given._replace(guess=0.01 * given.guess))
    assert abs(found.value) < 1e-6
    assert found.note == "wrong: fell to the trivial solution phi = 0, with status 0"


def test_solve_bvp_runs_out_of_mesh():
    assert answer(BVP, MODE_1, 1e-12).note == "refused: The maximum number of mesh nodes is exceeded."


def test_shooting_by_scipy_says_where_it_lands():
    assert answer(IVP, Question("tip_angle", lam=25.0), 1e-6).note == "wrong: landed on mode 2"


@pytest.mark.parametrize("name", ALL)
def test_other_questions_are_refused(name):
    size = ALL[name].sizes[0]
    with pytest.raises(ValueError, match="above the buckling load"):
        ALL[name].setup(Question("tip_angle", lam=2.4), size)
    for question in (Question("load"), Question("tip_angle", K="1 + s", lam=5.0), Question("tip_angle", u_hat=0.1, lam=5.0)):
        with pytest.raises(ValueError, match="uniform straight rod only"):
            ALL[name].setup(question, size)


# --- AUTO ------------------------------------------------------------------------------------------------------------


@NEEDS_AUTO
def test_auto_leaves_nothing_behind(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    method = PEERS[AUTO]
    given = method.setup(MODE_2, 20)
    found, folder = method.solve(MODE_2, given), given[1].folder
    assert found == method.solve(MODE_2, given)._replace(note=found.note)
    assert found.note.startswith("AUTO's own time")
    assert abs(found.value - rl.elastica(4.5 * np.pi**2, 2).tip_angle) < 1e-9
    assert folder.exists()
    del given
    assert not folder.exists()
    assert not list(tmp_path.iterdir())


@NEEDS_AUTO
def test_auto_says_when_it_does_not_arrive():
    program = peers.Auto()
    with pytest.raises(ArithmeticError, match="not at the load asked for"):
        program.follow(2.6, peers.AutoSettings(10))  # its first step goes beyond 2.6, and it looks for no stop there
    program.close()
    assert not program.folder.exists()


@NEEDS_AUTO
def test_auto_says_when_its_program_fails():
    method = PEERS[AUTO]
    asked, program, settings = method.setup(MODE_1, 10)
    found = method.solve(MODE_1, (asked, program, settings._replace(ncol=0)))
    assert found.note.startswith("refused: AUTO")
    assert math.isnan(found.value)


def test_a_missing_peer_says_so(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: object())
    assert peers.peers()[-1].missing == "AUTO: left out, gfortran is not installed (apt-get install gfortran)"
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    missing = peers.peers()[-1]
    assert missing.missing == "AUTO: left out, bifpy is not installed (pip install bifpy, and gfortran)"
    with pytest.raises(RuntimeError, match="pip install bifpy"):
        missing.setup(MODE_1, 5)
    assert not any(method.missing for method in peers.peers()[:-1])
