"""Folds, branch points and zeros of functions, to full precision; switching onto every half-branch; saved and read."""

import json

import mpmath as mp
import numpy as np
import pytest
from models import Bare, Bratu, Scalar, Struts, circle, hysteresis, subcritical, transcritical

import rodlab as rl


def kinds(branch):
    return [e.kind for e in branch.events]


def from_zero(model, to, **options):
    return rl.follow(rl.equilibrium(model, 0.0), to=to, **options)


# --- truths --------------------------------------------------------------------------------------------------------


def test_two_joints_by_hand():
    b = from_zero(rl.Strut.from_joints(k=[1, 1]), 4.0)
    assert kinds(b) == ["branch point", "branch point", "end"]
    golden = (1 + np.sqrt(5)) / 2
    for e, exact, direction in zip(b.events, ((3 - 5**0.5) / 2, (3 + 5**0.5) / 2), ((1, golden), (golden, -1)), strict=False):
        assert e.lam == pytest.approx(exact, abs=1e-13)
        assert abs(e.lam - exact) <= e.error <= 1e-13
        assert e.multiplicity == 1
        assert e.converged
        assert abs(np.cross(np.append(e.null[:, 0], 0), np.append(direction, 0))[2]) < 1e-12
        starts = rl.switch(e)
        assert len(starts) == 2
        for p in starts:
            assert p.lam > e.lam  # both pitchforks are supercritical
            assert p.tangent[-1] > 0
            assert abs(np.cross(np.append(p.u, 0), np.append(direction, 0))[2]) < 2e-3 * np.linalg.norm(p.u)
        assert starts[0].u == pytest.approx(-starts[1].u, abs=1e-14)


def two_joint_folds(beta, guess):
    """The fold of two joints next to a guess, in 40 digits: gradient = 0 and det V'' = 0."""
    with mp.workdps(40):

        def equations(x, y, lam):
            a, b = 2 - lam * mp.cos(x), 1 - lam * mp.cos(y)
            return [2 * x - y - mp.mpf(beta) - lam * mp.sin(x), y - x - lam * mp.sin(y), a * b - 1]

        return float(mp.findroot(equations, guess)[2])


@pytest.mark.parametrize("beta", [0.01, 0.1, 0.5])
def test_folds_of_two_imperfect_joints(beta):
    strut = rl.Strut.from_joints(k=[1, 1], beta=[beta, 0])
    assert kinds(from_zero(strut, 6.0)) == ["end"]
    b = rl.follow(rl.equilibrium(strut, 2.0, [-2.0, -2.5]), to=0.0)
    assert kinds(b)[0] == "fold"
    fold = b.events[0]
    assert fold.lam == pytest.approx(two_joint_folds(beta, (*fold.point.u, fold.lam)), abs=1e-12)
    assert fold.error < 1e-12
    assert fold.multiplicity == 1


def test_one_joint_has_its_fold_where_the_exercise_says():
    """Fold: beta = phi - tan phi, lam = 1 / cos phi (exercise 15); the far branch is the detached one."""
    strut = rl.Strut.from_joints(k=[1], beta=[0.2])
    b = rl.follow(rl.equilibrium(strut, 2.0, [-1.9]), to=0.0)
    phi = float(mp.findroot(lambda x: x - mp.tan(x) - mp.mpf(0.2), -0.8))
    assert b.events[0].kind == "fold"
    assert b.events[0].lam == pytest.approx(1 / np.cos(phi), abs=1e-13)
    assert b.events[0].point.u[0] == pytest.approx(phi, abs=1e-9)


def test_thirty_two_loads_of_a_long_strut_by_following():
    strut = rl.Strut(n=1000)
    b = from_zero(strut, 1e4)
    exact = 4e6 * np.sin((2 * np.arange(1, 33) - 1) * np.pi / 4002) ** 2
    assert kinds(b) == ["branch point"] * 32 + ["end"]
    found, error = (np.array([getattr(e, name) for e in b.events[:-1]]) for name in ("lam", "error"))
    assert found == pytest.approx(exact, rel=1e-10)
    assert (np.abs(found - exact) <= error + 1e-14 * exact).all()
    assert (error <= 1e-10 * exact).all()


@pytest.mark.parametrize("step", [None, 1.0, 0.37])
@pytest.mark.parametrize("e", [0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1e-1])
def test_two_struts_nearly_alike(e, step):
    pair = Struts(rl.Strut(n=20), rl.Strut(n=20, K=1 + e))
    b = rl.follow(rl.equilibrium(pair, 0.5, np.zeros(40)), to=130.0, step=step)
    exact = np.sort(np.concatenate([rl.buckling_loads(strut, 4) for strut in pair.struts]))
    found = np.repeat([x.lam for x in b.events[:-1]], [x.multiplicity for x in b.events[:-1]])
    assert found == pytest.approx(exact, rel=1e-9)
    for event in b.events[:-1]:
        assert event.kind == "branch point"
        within = np.abs(exact - event.lam) <= event.error + 1e-13 * event.lam
        assert within.sum() == event.multiplicity


def test_bratu_through_a_class_of_ten_lines():
    folds = []
    for n in (31, 63, 127):
        b = rl.follow(rl.equilibrium(Bratu(n), 0.0, np.zeros(n)), to=4.0, within=lambda p: p.u.max() < 4)
        assert kinds(b) == ["fold", "end"]
        assert b.reason == "left the limits given"
        folds.append(b.events[0].lam)
    exact = 3.513830719125162
    errors = np.abs(np.array(folds) - exact)
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx([2.0, 2.0], abs=0.1)
    assert (4 * folds[-1] - folds[-2]) / 3 == pytest.approx(exact, abs=2e-7)


# --- kinds ---------------------------------------------------------------------------------------------------------


def test_scalar_examples_of_every_kind():
    b = rl.follow(rl.equilibrium(transcritical, -1.0, [0.0]), to=1.0)
    assert kinds(b) == ["branch point", "end"]
    assert b.events[0].lam == pytest.approx(0.0, abs=1e-14)
    starts = rl.switch(b.events[0])
    assert sorted(float(np.sign(p.lam)) for p in starts) == [-1.0, 1.0]
    assert all(p.u[0] == pytest.approx(p.lam, abs=1e-14) for p in starts)
    b = rl.follow(rl.equilibrium(subcritical, -1.0, [0.0]), to=1.0)
    assert all(p.lam < 0 and p.lam == pytest.approx(-(p.u[0] ** 2), abs=1e-15) for p in rl.switch(b.events[0]))
    assert kinds(rl.follow(rl.equilibrium(hysteresis, -4.0, [2.2]), to=4.0)) == ["fold", "fold", "end"]


def test_a_pitchfork_seen_from_its_side_branch():
    strut = rl.Strut(n=20)
    b = rl.follow(rl.equilibrium(strut, 5.0, lambda s: 2 * np.sin(np.pi * s / 2)), to=0.0)
    assert kinds(b) == ["branch point", "end"]
    e = b.events[0]
    assert e.lam == pytest.approx(float(rl.buckling_loads(strut, 1)[0]), abs=1e-9)
    assert abs(e.lam - float(rl.buckling_loads(strut, 1)[0])) <= e.error
    assert b.reason == "back at lam = 5"
    assert b.points[-1].tip_angle == pytest.approx(-b.points[0].tip_angle, abs=1e-11)
    starts = rl.switch(e)
    assert sorted(np.sign(p.lam - e.lam) for p in starts) == [-1.0, 1.0]  # the straight strut, both ways
    assert all(np.abs(p.u).max() < 1e-9 for p in starts)


def test_two_equal_imperfect_struts_fold_and_branch_in_one_place():
    pair = Struts(*[rl.Strut(n=8, u_hat=0.05)] * 2)
    one = pair.struts[0]
    own = rl.equilibrium(one, 4.0, lambda s: -1.8 * np.sin(np.pi * s / 2))
    fold = rl.follow(own, to=0.0).events[0]
    b = rl.follow(rl.equilibrium(pair, 4.0, np.tile(own.u, 2)), to=0.0)
    assert kinds(b) == ["fold", "branch point", "end"]
    assert [e.lam for e in b.events[:2]] == pytest.approx([fold.lam] * 2, abs=1e-12)
    starts = rl.switch(b.events[1])
    assert len(starts) == 2
    assert all(np.abs(p.u[:8] - p.u[8:]).max() > 1e-2 for p in starts)


def test_without_symmetry_odd_crossings_are_found():
    class Rotated:  # a pitchfork whose Jacobian is not symmetric
        A = np.array([[1.0, 0.7], [-0.2, 2.0]])

        def residual(self, u, lam):
            return self.A @ np.array([lam * u[0] - u[0] ** 3 - u[1] ** 2, u[1] - 0.3 * u[0] ** 2])

        def jacobian(self, u, lam):
            return self.A @ np.array([[lam - 3 * u[0] ** 2, -2 * u[1]], [-0.6 * u[0], 1.0]])

        def d_lam(self, u, lam):
            return self.A @ np.array([u[0], 0.0])

        def inner(self, u, v):
            return float(u @ v)

    b = rl.follow(rl.equilibrium(Rotated(), -1.0, [0.0, 0.0]), to=1.0)
    assert kinds(b) == ["branch point", "end"]
    assert b.events[0].lam == pytest.approx(0.0, abs=1e-13)
    assert b.points[1].index is None
    starts = rl.switch(b.events[0])
    assert len(starts) == 2
    assert all(np.abs(Rotated().residual(p.u, p.lam)).max() < 1e-14 for p in starts)


def test_functions_of_a_point():
    def upright(p):
        return p.tip_angle - 1.0

    p = rl.equilibrium(rl.Strut(n=20, u_hat=0.1), 0.0)
    b = rl.follow(p, to=20.0, events=(upright, rl.fold))
    assert kinds(b) == ["upright", "end"]
    assert b.events[0].point.tip_angle == pytest.approx(1.0, abs=1e-13)
    wave = rl.follow(p, to=20.0, events=lambda p: np.sin(2 * p.lam))
    assert [e.lam for e in wave.events[:-1]] == pytest.approx(np.arange(1, 13) * np.pi / 2, abs=1e-10)
    assert kinds(rl.follow(p, to=20.0, events=())) == ["end"]


def test_the_index_between_events_is_that_of_dense_eigenvalues():
    for n, to in ((3, 60.0), (5, 120.0)):
        strut = rl.Strut(n=n)
        trivial = from_zero(strut, to)
        for branch in [trivial, *(rl.follow(rl.switch(e)[0], to=to) for e in trivial.events[:-1])]:
            for p in branch.points[1:]:
                w = np.linalg.eigvalsh(strut.hessian(p.u, p.lam).toarray())
                assert p.index == int((w < 0).sum())
                assert p.index_verified


# --- switching -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sparse", [False, True])
def test_eight_half_branches_of_a_double_point(sparse):
    pair = Struts(rl.Strut(n=20), rl.Strut(n=20), sparse=sparse)
    b = rl.follow(rl.equilibrium(pair, 0.5, np.zeros(40)), to=5.0, step=1.0)
    one = rl.Strut(n=20)
    for e in b.events[:-1]:
        starts = rl.switch(e)
        assert len(starts) == 8
        seen = set()
        for p in starts:
            assert np.abs(pair.residual(p.u, p.lam)).max() < 1e-12
            assert p.lam > e.lam
            sides = tuple(int(np.sign(v[0])) if np.abs(v).max() > 1e-4 else 0 for v in (p.u[:20], p.u[20:]))
            seen.add(sides)
            end = rl.follow(p, to=e.lam + 3.0)  # goes on as two struts would by themselves
            for v, side in zip((end.points[-1].u[:20], end.points[-1].u[20:]), sides, strict=True):
                own = rl.equilibrium(one, e.lam + 3.0, v).u
                assert v == pytest.approx(own, abs=1e-9)
                assert np.sign(v[0]) == side or side == 0
        assert len(seen) == 8
        assert (0, 0) not in seen


def test_twenty_six_half_branches_of_a_triple_point():
    three = Struts(*[rl.Strut(n=4)] * 3)
    b = rl.follow(rl.equilibrium(three, 0.5, np.zeros(12)), to=5.0)
    assert b.events[0].multiplicity == 3
    assert len(rl.switch(b.events[0])) == 26


def test_nearly_double_points_have_two_half_branches_each():
    for e in (1e-7, 1e-5, 1e-3):
        pair = Struts(rl.Strut(n=6), rl.Strut(n=6, K=1 + e))
        b = rl.follow(rl.equilibrium(pair, 0.5, np.zeros(12)), to=5.0)
        for event in b.events[:-1]:
            starts = rl.switch(event)
            assert len(starts) == 2
            assert starts[0].u == pytest.approx(-starts[1].u, abs=1e-9)


def test_what_is_no_branch_point_is_not_switched():
    b = rl.follow(rl.equilibrium(circle, 0.0, [1.0]), to=3.0)
    with pytest.raises(ValueError, match="event must be a branch point"):
        rl.switch(b.events[0])
    with pytest.raises(ValueError, match="event must be a branch point"):
        rl.switch(b.points[0])


def test_four_null_vectors_are_too_many():
    four = Struts(*[rl.Strut(n=2)] * 4)
    b = rl.follow(rl.equilibrium(four, 0.5, np.zeros(8)), to=3.0)
    assert b.events[0].multiplicity == 4
    with pytest.raises(ValueError, match="at most 3 null vectors; it has 4"):
        rl.switch(b.events[0])


# --- another parameter -----------------------------------------------------------------------------------------------


def test_from_the_perfect_strut_to_an_imperfect_one_and_back():
    strut = rl.Strut(n=30)
    perfect = rl.equilibrium(strut, 3.0, lambda s: 1.3 * np.sin(np.pi * s / 2))
    bent = rl.vary(strut, "u_hat", lam=3.0)
    there = rl.follow(rl.equilibrium(bent, 0.0, perfect.u), to=0.4)
    assert all(p.proved for p in there.points[1:])
    imperfect = bent.at(0.4)
    assert imperfect.gradient(there.points[-1].u, 3.0) == pytest.approx(0, abs=1e-13)
    back = rl.follow(there.points[-1], to=0.0) if there.points[-1].tangent[-1] < 0 else None
    start = rl.equilibrium(bent, 0.4, there.points[-1].u)
    back = rl.follow(start, to=0.0)
    assert back.points[-1].u == pytest.approx(perfect.u, abs=1e-12)


def test_a_detached_branch_through_u_hat():
    strut = rl.Strut(n=30)
    other = rl.equilibrium(strut, 3.0, lambda s: -1.3 * np.sin(np.pi * s / 2))
    b = rl.follow(rl.equilibrium(rl.vary(strut, "u_hat", 3.0), 0.0, other.u), to=0.02)
    detached = rl.equilibrium(strut.replace(u_hat=0.02), 3.0, b.points[-1].u)
    down = rl.follow(detached, to=0.0)
    assert kinds(down) == ["fold", "end"]
    again = rl.follow(rl.equilibrium(rl.vary(strut, "u_hat", down.events[0].lam), 0.0, other.u), to=1.0)
    assert again.events[0].kind == "fold"  # the same fold, met in the other parameter
    assert again.events[0].lam == pytest.approx(0.02, abs=1e-9)


def test_a_column_under_its_own_weight():
    loads = []
    for n in (50, 100, 200):
        column = rl.vary(rl.Strut(n=n, rule="trapezoid", terms=(rl.self_weight(0.0),)), "q", lam=0.0)
        loads.append(rl.follow(rl.equilibrium(column, 0.0), to=10.0).events[0].lam)
    assert (4 * loads[2] - loads[1]) / 3 == pytest.approx(7.8373474389, abs=1e-6)
    assert np.log2((loads[1] - loads[0]) / (loads[2] - loads[1])) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(
    ("strut", "name", "value"),
    [
        (rl.Strut(n=5, K="1 + s", u_hat=0.3, rule="trapezoid", phi0=0.2), "K", 1.7),
        (rl.Strut(n=5, K=2.0, u_hat=0.3), "K", 1.7),
        (rl.Strut(n=5, u_hat=lambda s: 1 - s), "u_hat", -0.4),
        (rl.Strut(n=5, u_hat=[0.1, 0.2, 0.0, 0.0, 0.4]), "u_hat", 2.5),
        (rl.Strut(n=5), "u_hat", 0.8),
        (rl.Strut(n=5, phi0=0.3, rule="trapezoid", terms=(rl.self_weight(2.0),)), "phi0", -0.2),
        (rl.Strut(n=5, terms=(rl.self_weight("1 + s"), rl.end_torque(0.3))), "q", 2.2),
        (rl.Strut(n=5, terms=(rl.self_weight(2.0), rl.end_torque(0.3))), "tau", -1.2),
        (rl.Strut(n=5, terms=(rl.foundation(2.0),)), "c", 0.7),
        (rl.Strut.from_joints(k=[1, 2, 3], beta=[0.1, 0.2, 0.3]), "k", 1.4),
        (rl.Strut.from_joints(k=[1, 2, 3]), "beta0", 0.6),
        (rl.Strut.from_joints(k=[1, 2, 3], beta=[0.1, 0.2, 0.3], weights=[1, 1, 0.5]), "beta", 0.6),
    ],
)
def test_every_parameter_and_its_derivative(strut, name, value):
    varied, u = rl.vary(strut, name, lam=2.5), np.linspace(0.2, -0.9, strut.n)
    at = varied.at(value)
    assert varied.residual(u, value) == pytest.approx(at.gradient(u, 2.5), abs=1e-13)
    assert varied.jacobian(u, value).toarray() == pytest.approx(at.hessian(u, 2.5).toarray(), abs=1e-12)
    e = 1e-5
    slope = (varied.at(value + e).gradient(u, 2.5) - varied.at(value - e).gradient(u, 2.5)) / (2 * e)
    assert varied.d_lam(u, value) == pytest.approx(slope, abs=1e-8)
    assert rl.Point(varied, value, u).z == pytest.approx(at.shape(u)[1], abs=1e-14)
    assert rl.Point(varied, value, u).phi == pytest.approx(at.nodes(u)[1], abs=1e-14)
    assert varied.measures["energy"](u, value) == pytest.approx(at.energy(u, 2.5), abs=1e-12)
    assert rl.vary(strut, name, 2.5).residual(u, varied.value) == pytest.approx(strut.gradient(u, 2.5), abs=1e-13)


def test_an_attribute_of_a_students_class_is_followed():
    class Cubic:
        c = 0.0

        def residual(self, u, lam):
            return lam * u - u**3 + self.c

        def jacobian(self, u, lam):
            return np.diag(lam - 3 * u**2)

        def d_lam(self, u, lam):
            return u.copy()

        def inner(self, u, v):
            return float(u @ v)

    b = rl.follow(rl.equilibrium(rl.vary(Cubic(), "c", lam=3.0), 5.0, [2.3]), to=-5.0)
    assert [e.kind for e in b.events] == ["fold", "fold", "end"]
    assert [e.lam for e in b.events[:2]] == pytest.approx([-2.0, 2.0], abs=1e-9)
    for wrong in ("d", "residual"):
        with pytest.raises(ValueError, match="name must be an attribute of Cubic that is a number"):
            rl.vary(Cubic(), wrong, lam=3.0)


def test_what_cannot_be_varied_gets_a_sentence():
    with pytest.raises(ValueError, match="name must be a parameter of the strut, one of K, u_hat, phi0; it is 'lam'"):
        rl.vary(rl.Strut(n=3), "lam", 1.0)
    with pytest.raises(ValueError, match="beta must be given to be followed"):
        rl.vary(rl.Strut.from_joints(k=[1, 1]), "beta", 1.0)
    with pytest.raises(ValueError, match="the model has no argument m; it has n, K"):
        rl.Strut(n=3).replace(m=4)


# --- files -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".json", ".npz"])
def test_a_saved_branch_is_read_whole_and_goes_on(tmp_path, suffix):
    strut = rl.Strut(n=6, terms=(rl.self_weight(0.2),))
    b = from_zero(strut, 10.0)
    path = b.save(tmp_path / f"b{suffix}")
    c = rl.read(path)
    assert repr(c.points[0].equations) == repr(strut)
    assert [e.lam for e in c.events] == [e.lam for e in b.events]
    assert [p.lam for p in c.points] == [p.lam for p in b.points]
    assert all(
        (p.u == q.u).all() and p.index == q.index and p.accepted == q.accepted for p, q in zip(b.points, c.points, strict=True)
    )
    assert [p.lam for p in rl.switch(c.events[0])] == pytest.approx([p.lam for p in rl.switch(b.events[0])], abs=1e-12)
    assert [e.lam for e in c.extended(30.0).events] == pytest.approx([e.lam for e in b.extended(30.0).events], abs=1e-12)
    assert c.save(tmp_path / f"c{suffix}").exists()


@pytest.mark.parametrize("suffix", [".json", ".npz"])
def test_without_its_model_what_was_recorded_can_be_asked(tmp_path, suffix):
    strut = rl.Strut(n=4, u_hat=lambda s: 0.1 * s)
    b = from_zero(strut, 5.0)
    path = b.save(tmp_path / f"b{suffix}")
    c = rl.read(path)
    assert list(c.measure("tip_angle")) == list(b.measure("tip_angle"))
    assert [p.index for p in c.points] == [p.index for p in b.points]
    assert "recorded" in repr(c.points[-1])
    assert rl.read(c.save(tmp_path / f"c{suffix}")).measure("energy") == pytest.approx(b.measure("energy"))
    with pytest.raises(ValueError, match="read without its model"):
        c.extended(6.0)
    assert rl.read(path, model=strut).extended(6.0).points[-1].lam == 6.0
    with pytest.raises(ValueError, match="does not hold solutions of this model"):
        rl.read(path, model=rl.Strut(n=4, u_hat=0.5))
    with pytest.raises(ValueError, match="does not hold solutions of this model"):
        rl.read(path, model=rl.Strut(n=5))


def test_varied_branches_are_read_with_their_model(tmp_path):
    bent = rl.vary(rl.Strut(n=5), "u_hat", 1.0)
    b = rl.follow(rl.equilibrium(bent, 0.0), to=0.3)
    c = rl.read(b.save(tmp_path / "b.json"))
    assert repr(c.points[0].equations) == repr(bent)
    assert c.extended(0.5).points[-1].lam == 0.5


def test_files_that_are_no_branches_get_a_sentence(tmp_path):
    good = from_zero(rl.Strut(n=2), 1.0).save(tmp_path / "good.json")
    text = good.read_text()
    record = json.loads(text)
    cases = {
        "cut.json": text[: len(text) // 2],
        "empty.json": "",
        "other.json": "[1, 2]",
        "nothing.json": "{}",
        "later.json": json.dumps({**record, "schema": 99}),
        "headless.json": json.dumps({**record, "points": []}),
        "short.json": json.dumps({**record, "arrays": {**record["arrays"], "u": record["arrays"]["u"][:1]}}),
        "recipe.json": json.dumps({**record, "recipes": [{"k": "x"}]}),
        "bad.npz": "PK not really",
    }
    for name, content in cases.items():
        (tmp_path / name).write_text(content)
        with pytest.raises(ValueError, match=r"\.json|\.npz|must be|schema"):
            rl.read(tmp_path / name)
    with pytest.raises(ValueError, match="cannot be read"):
        rl.read(tmp_path / "missing.json")
    for wrong in ("b.pkl", "b"):
        with pytest.raises(ValueError, match=r"path must end in .json or .npz"):
            from_zero(rl.Strut(n=2), 1.0).save(tmp_path / wrong)
    np.savez(tmp_path / "pickled.npz", record=np.array([{"a": 1}], dtype=object))
    with pytest.raises(ValueError, match="not a branch that rodlab saved"):
        rl.read(tmp_path / "pickled.npz")


def test_a_bare_class_is_saved_and_read_with_its_model(tmp_path):
    model = Bare(rl.Strut(n=3, u_hat=0.2))
    b = rl.follow(rl.equilibrium(model, 0.0, model.model.unstressed()), to=4.0)
    path = b.save(tmp_path / "b.npz")
    assert rl.read(path, model=model).points[-1].u == pytest.approx(b.points[-1].u)
    flat = Scalar(lambda u, lam: u - lam, lambda u, lam: 1.0, lambda u, lam: -1.0)
    assert rl.follow(rl.equilibrium(flat, 0.0, [0.0]), to=1.0).save(tmp_path / "f.json").exists()
