"""The distinguished diagram: dlam dheight = -du.V'' du along branches, and the index read off it at folds."""

import numpy as np
import pytest
from models import Bratu, Struts, hysteresis

import rodlab as rl
from rodlab.analysis.distinguished import _derivative, distinguished

STRUT, BENT, ROD, BENT_ROD = rl.Strut(n=50), rl.Strut(n=50, u_hat=0.01), rl.Rod(), rl.Rod(u_hat=0.01)
JOINTS = rl.Strut.from_joints(k=[1, 1])
HEAVY = rl.Strut(n=50, u_hat=0.01, terms=(rl.self_weight(3.0),))


def from_zero(model, to, **options):
    return rl.follow(rl.equilibrium(model, 0.0), to=to, **options)


def mode(model, j, to):
    """The branch of mode j: from its buckling load."""
    straight = from_zero(model, 1.01 * rl.buckling_loads(model, j)[-1])
    return rl.follow(rl.switch(straight.events[j - 1])[0], to=to)


def detached(model, lam, guess):
    return rl.follow(rl.equilibrium(model, lam, guess), to=0.0)


BRANCHES = {
    "straight": lambda: from_zero(STRUT, 70.0),
    "mode 1": lambda: mode(STRUT, 1, 100.0),
    "mode 2": lambda: mode(STRUT, 2, 100.0),
    "mode 3": lambda: mode(STRUT, 3, 150.0),
    "imperfect": lambda: from_zero(BENT, 30.0),
    "two joints, 1": lambda: mode(JOINTS, 1, 6.0),
    "two joints, 2": lambda: mode(JOINTS, 2, 6.0),
    "rod, 1": lambda: mode(ROD, 1, 40.0),
    "rod, 2": lambda: mode(ROD, 2, 60.0),
    "imperfect rod": lambda: from_zero(BENT_ROD, 30.0),
    "heavy": lambda: from_zero(HEAVY, 30.0),
    "upwards": lambda: from_zero(BENT, -50.0),
    "trapezoid": lambda: from_zero(rl.Strut(n=20, K="1 + s", u_hat="sin(5*s)", rule="trapezoid", phi0=0.4), 40.0),
    "long": lambda: from_zero(rl.Strut(n=2000, u_hat=0.01), 5.0),
}
FOLDED = {  # from here to the load 0, and the folds on the way
    "strut": (BENT, 5.0, lambda s: -2 * np.sin(np.pi * s / 2), [2.51235753616]),
    "strut, mode 2": (BENT, 40.0, lambda s: 1.5 * np.sin(3 * np.pi * s / 2), None),
    "rod": (BENT_ROD, 5.0, lambda s: -2 * np.sin(np.pi * s / 2), [2.56242639743]),
    "two joints": (rl.Strut.from_joints(k=[1, 1], beta=[0.1, 0]), 2.0, [-2.0, -2.5], None),
    "heavy": (HEAVY, 10.0, lambda s: -2 * np.sin(np.pi * s / 2), None),
    "on a foundation": (rl.Strut(n=20, u_hat=0.01, terms=(rl.foundation(200.0),)), 30.0, None, None),
}


def holds(d):
    assert (d.mismatch <= d.error).all()
    assert np.median(d.error) < 1e-9


@pytest.mark.parametrize("name", BRANCHES)
def test_the_height_falls_as_the_second_variation_says(name):
    b = BRANCHES[name]()
    d = distinguished(b)
    points = [p for p in b.points if p.tangent is not None]
    assert d.lam.tolist() == [p.lam for p in points]
    assert d.value.tolist() == [p.height for p in points]
    holds(d)
    stable = np.array([p.index_verified and p.index == 0 for p in points])
    assert (d.curvature[stable] >= 0).all()
    assert d.folds == ()


def test_a_stable_branch_falls():
    """Index 0 at every point of these: the height does not rise anywhere in between."""
    for name in ("imperfect", "imperfect rod", "heavy", "mode 1", "rod, 1", "two joints, 1"):
        b = BRANCHES[name]()
        assert {p.index for p in b.points} == {0}
        assert (np.diff(b.measure("height")) < 0).all()


@pytest.mark.parametrize("name", FOLDED)
def test_the_index_beyond_a_fold_is_read_off_the_picture(name):
    model, lam, guess, loads = FOLDED[name]
    b = rl.follow(rl.equilibrium(model, lam, guess), to=0.0, max_points=150) if guess is not None else from_zero(model, lam)
    d = distinguished(b)
    holds(d)
    folds = [e for e in b.events if e.kind == "fold"]
    assert [fold.lam for fold in d.folds] == [e.lam for e in folds]
    assert loads is None or [fold.lam for fold in d.folds] == pytest.approx(loads, abs=1e-10)
    for fold, e in zip(d.folds, folds, strict=True):
        assert fold.predicted in (-1, 1)
        assert fold.predicted == fold.found
        sharing = [other for other in b.events if int(other.where) == int(e.where)]
        if len(sharing) == 1:  # the branch's own points, on whose indices the continuation insists
            before, after = b.points[int(e.where)], b.points[int(e.where) + 1]
            assert fold.predicted == after.index - before.index


def test_a_branch_followed_the_other_way_turns_its_signs():
    there = detached(BENT, 5.0, lambda s: -2 * np.sin(np.pi * s / 2))
    end = there.points[-1]
    back = rl.follow(rl.equilibrium(BENT, end.lam, end.u), to=0.0)
    assert [fold.predicted for fold in distinguished(there).folds] == [1]
    assert [(fold.predicted, fold.found) for fold in distinguished(back).folds] == [(-1, -1)]


def test_the_picture_of_one_joint_by_hand():
    """height = cos(phi), lam = (phi - beta) / sin(phi): rate / dlam = dheight / dlam."""
    b = from_zero(rl.Strut.from_joints(k=[1.0], beta=[0.2]), 5.0)
    d = distinguished(b)
    phi = np.array([p.tip_angle for p in b.points if p.tangent is not None])
    dlam = 1 / np.sin(phi) - (phi - 0.2) * np.cos(phi) / np.sin(phi) ** 2
    length = np.sqrt(1 + dlam**2)
    assert d.value == pytest.approx(np.cos(phi), abs=1e-15)
    assert d.rate == pytest.approx(-np.sin(phi) / length, rel=1e-9)
    assert d.curvature == pytest.approx(dlam * np.sin(phi) / length**2, rel=1e-9)


class Pushed:
    """V = (u^2 - 1)^2 / 4 + lam u, whose measure is u: two folds at 2 / sqrt(27)."""

    def __init__(self):
        self.measures = {
            "u": lambda u, _: float(u[0]),
            "half": lambda u, _: float(u[0]) / 2,
            "load": lambda u, lam: float(u[0]) + lam,
        }

    def residual(self, u, lam):
        return u**3 - u + lam

    def jacobian(self, u, lam):
        return np.diag(3 * u**2 - 1)

    def d_lam(self, u, lam):
        return np.ones_like(u)

    def inner(self, u, v):
        return u @ v


def test_a_student_brings_a_measure_of_another_name():
    b = rl.follow(rl.equilibrium(Pushed(), -2.0, [1.5]), to=2.0)
    d = distinguished(b, "u")
    assert (d.mismatch <= d.error).all()
    assert [(fold.predicted, fold.found) for fold in d.folds] == [(1, 1), (-1, -1)]
    assert [abs(fold.lam) for fold in d.folds] == pytest.approx([2 / np.sqrt(27)] * 2, abs=1e-12)


def test_a_measure_that_is_not_the_loads_conjugate_is_refused():
    pushed = rl.follow(rl.equilibrium(Pushed(), -2.0, [1.5]), to=-1.0)
    bent = from_zero(BENT, 3.0)
    varied = rl.follow(rl.equilibrium(rl.vary(rl.Strut(n=5), "u_hat", lam=1.0), 0.0), to=0.5)
    for b, measure, says in (
        (pushed, "half", "measure must have d_lam for its gradient; half of Pushed has not: .* is .*, that by d_lam"),
        (pushed, "load", "measure must not depend on the load itself; load of Pushed does"),
        (pushed, "height", r"measure must be one of those of Pushed, \['half', 'load', 'u'\]; it is 'height'"),
        (bent, "energy", "measure must have d_lam for its gradient; energy of Strut has not"),
        (bent, "tip_angle", "measure must have d_lam for its gradient; tip_angle of Strut has not"),
        (varied, "height", "measure must have d_lam for its gradient; height of VariedStrut has not"),
        (rl.follow(rl.equilibrium(hysteresis, -4.0, [2.2]), to=4.0), "height", r"those of Scalar, \[\]; it is 'height'"),
        (rl.follow(rl.equilibrium(Bratu(5), 0.0, np.zeros(5)), to=1.0), "height", "measure must be one of"),
        (bent.points, "height", "branch must be a Branch"),
        (rl.Branch(bent.points[:1], bent.events), "height", "branch must have points with tangents; of its 1 none has one"),
    ):
        with pytest.raises(ValueError, match=says):
            distinguished(b, measure)


def test_a_branch_read_from_a_file(tmp_path):
    b = detached(BENT, 5.0, lambda s: -2 * np.sin(np.pi * s / 2))
    read = rl.read(b.save(tmp_path / "b.json"))
    assert distinguished(read).folds == distinguished(b).folds
    assert distinguished(read).rate == pytest.approx(distinguished(b).rate, rel=1e-12)


class TwoHeights(Struts):
    @property
    def measures(self):
        return {"height": lambda u, _: sum(strut.height(v) for strut, v in self.parts(u))}


def test_a_branch_point_in_the_place_of_a_fold_adds_its_own():
    """Two equal imperfect struts side by side, bent alike: both eigenvalues cross, the picture tells the fold's."""
    bent = rl.Strut(n=10, u_hat=0.1)
    half = rl.equilibrium(bent, 6.0, lambda s: -2 * s).u
    b = rl.follow(rl.equilibrium(TwoHeights(bent, bent), 6.0, np.append(half, half)), to=0.0)
    assert [e.kind for e in b.events[:2]] == ["fold", "branch point"]
    assert [(fold.predicted, fold.found) for fold in distinguished(b).folds] == [(1, 2)]


@pytest.mark.parametrize(
    ("f", "exact"), [(np.sin, 1.0), (np.exp, 1.0), (lambda x: np.sin(7 * x + 1), 7 * np.cos(1.0)), (lambda _: 3.0, 0.0)]
)
def test_differences_know_their_error(f, exact):
    rate, off = _derivative(f, 0.2, 4 * np.finfo(float).eps)
    assert abs(rate - exact) <= off < 1e-11
