"""Further solutions at one load by dividing out those that are known."""

import numpy as np
import pytest
from models import Bare, Bratu, Scalar, Struts

import rodlab as rl
from rodlab.analysis.deflation import Runs, deflation


def tips(points):
    return sorted(round(float(p.u[-1]), 6) for p in points)


def main(model, lam):
    return rl.follow(rl.equilibrium(model, 0.0), to=lam).points[-1]


class Counted(rl.Strut):
    """A strut that counts its matrices, each of which is solved with once but for the search of null vectors."""

    solves = 0

    def jacobian(self, u, lam):
        self.solves += 1
        return super().jacobian(u, lam)


# --- the step ------------------------------------------------------------------------------------------------------


def test_the_deflated_step_is_newtons_step_for_the_product():
    """Against G' by differences of G = M F, solved densely."""
    strut, lam, rng = rl.Strut(n=5, u_hat=0.3), 7.0, np.random.default_rng(0)
    known = [rl.equilibrium(strut, lam, bend * strut.joints.s) for bend in (2.0, -2.0, 0.0)]
    runs = Runs(strut, lam, 100, known)

    def G(u):
        M = np.prod([1 / strut.inner(u - p.u, u - p.u) + 1 for p in known])
        return M * strut.gradient(u, lam)

    for _ in range(20):
        u, e = rng.uniform(-2, 2, 5), 1e-6
        slopes = np.column_stack([(G(u + e * d) - G(u - e * d)) / (2 * e) for d in np.eye(5)])
        s = strut.hessian(u, lam).solve(-strut.gradient(u, lam))
        assert np.linalg.solve(slopes, -G(u)) == pytest.approx(s / runs._slope(u, s), rel=1e-5, abs=1e-5)


def test_next_to_a_known_solution_newtons_step_is_turned_round():
    strut = rl.Strut(n=5)
    known = rl.equilibrium(strut, 7.0, 2 * strut.joints.s)
    beside = known.u + 1e-4 * strut.joints.s
    s = strut.hessian(beside, 7.0).solve(-strut.gradient(beside, 7.0))
    assert 1 / Runs(strut, 7.0, 100, [known])._slope(beside, s) == pytest.approx(-1, abs=1e-3)
    assert Runs(strut, 7.0, 100, [known])._slope(known.u, s) == np.inf


# --- what is found ---------------------------------------------------------------------------------------------------


def test_the_detached_branch_is_found_from_the_main_one_alone():
    strut = Counted(n=50, u_hat=0.01)
    known = main(strut, 10.0)
    strut.solves = 0
    found = deflation(strut, 10.0, known=[known])
    assert strut.solves < 60 * 100
    assert [p.index for p in [known, *found]] == [0, 1, 0]
    assert all(p.index_verified and p.error < 1e-13 for p in found)
    assert known.tip_angle > 2.8
    assert abs(found[0].tip_angle) < 1e-3
    assert found[1].tip_angle < -2.8
    detached = rl.follow(found[1], to=0.0)
    assert [e.kind for e in detached.events] == ["fold", "end"]
    assert detached.at(10.0)[-1].u == pytest.approx(found[0].u, abs=1e-12)
    strut.solves = 0
    found = deflation(strut, 10.0, known=[known], most=2)
    assert sum(len(p.newton) for p in found) <= strut.solves < 1000  # runs in vain between the two are in neither history


def test_all_five_of_two_joints():
    """By hand: 3 / lam_1 and 3 / lam_2 above 1, so 0 and +-1, +-2; the modes' shapes have one sign, or two."""
    strut = rl.Strut.from_joints(k=[1, 1])
    found = deflation(strut, 3.0)
    assert [p.index for p in sorted(found, key=lambda p: p.u[-1])] == [0, 1, 2, 1, 0]
    u = np.array([p.u for p in sorted(found, key=lambda p: p.u[-1])])
    assert u == pytest.approx(-u[::-1], abs=1e-12)
    assert np.sign(u[3:]).tolist() == [[-1, 1], [1, 1]]
    assert tips(deflation(strut, 3.0, known=[[0.0, 0.0]])) == tips(p for p in found if p.u.any())


@pytest.mark.parametrize(("lam", "count"), [(1.0, 1), (10.0, 3), (30.0, 5)])
def test_a_uniform_strut_has_two_more_with_every_load_passed(lam, count):
    found = deflation(rl.Strut(n=50), lam)
    assert sorted(p.index for p in found) == sorted([count // 2, *[j for j in range(count // 2) for _ in (1, -1)]])
    assert tips(found) == [-x for x in reversed(tips(found))]


def test_a_rod_on_meshes_of_its_own():
    rod = rl.Rod(u_hat=0.01)
    known = main(rod, 10.0)
    found = deflation(rod, 10.0, known=[known])
    assert [p.index for p in [known, *found]] == [0, 1, 0]
    assert found[1].tip_angle == pytest.approx(
        rl.equilibrium(rod, 10.0, lambda s: -2.8 * np.sin(np.pi * s / 2)).tip_angle, abs=1e-12
    )
    assert all(p.error < 1e-10 for p in found)
    assert tips(deflation(rod, 10.0, guesses=[lambda s: s, None])) == tips([known, *found])
    straight = rl.Rod()
    bent = rl.equilibrium(straight, 10.0, lambda s: 2.8 * np.sin(np.pi * s / 2))
    found = deflation(straight, 10.0, known=[np.zeros(straight.size), bent], limit=20)  # an array on the mesh of the model
    assert [p.tip_angle for p in found] == pytest.approx([-bent.tip_angle], abs=1e-12)


def test_a_rod_of_many_modes_is_searched_on_a_mesh_that_shows_them():
    found = deflation(rl.Rod(), 300.0, most=4)
    assert [p.index for p in found][:2] == [6, 5]
    assert all(p.error < 1e-10 for p in found)


@pytest.mark.parametrize("lam", [-1.0, -0.3, 0.0, 0.2, 0.38, 0.39, 2.0])
def test_every_root_of_a_cubic(lam):
    cubic = Scalar(lambda u, lam: u**3 - u - lam, lambda u, lam: 3 * u * u - 1, lambda u, lam: -1.0)
    roots = [float(x.real) for x in np.roots([1, 0, -1, -lam]) if abs(x.imag) < 1e-9]
    for guess in (0.0, 3.0, -0.5):
        found = deflation(cubic, lam, guesses=[[guess]])
        assert tips(found) == pytest.approx(sorted(roots), abs=1e-6)
        assert all(abs(p.u[0] - min(roots, key=lambda x, p=p: abs(x - p.u[0]))) <= p.error + 1e-15 for p in found)


def test_the_two_solutions_of_bratu_and_the_nine_of_two_struts():
    model = Bratu(30)
    found = deflation(model, 1.0, guesses=[np.zeros(30)])  # runs that overflow arrive nowhere
    assert [round(p.u.max(), 1) for p in found][:2] == [0.1, 4.1]
    assert all(np.abs(model.residual(p.u, 1.0)).max() < 1e-9 * np.exp(p.u.max()) for p in found)
    for two in (Struts(*[rl.Strut(n=5)] * 2), Struts(*[rl.Strut(n=5)] * 2, sparse=True)):
        found = deflation(two, 5.0, guesses=[np.zeros(10)], most=9)
        assert sorted(p.index for p in found) == [0] * 4 + [1] * 4 + [2]
    bare = deflation(Bare(rl.Strut(n=5)), 5.0, known=[np.zeros(5)], guesses=[np.zeros(5)])
    assert tips(bare) == tips(deflation(rl.Strut(n=5), 5.0, known=[np.zeros(5)]))


class Rotated:
    """(u^2 - 1, v - u) with the second row first: no index, roots (1, 1) and (-1, -1)."""

    def residual(self, u, lam):
        return np.array([u[1] - u[0], u[0] ** 2 - lam])

    def jacobian(self, u, lam):
        return np.array([[-1.0, 1.0], [2 * u[0], 0.0]])

    def d_lam(self, u, lam):
        return np.array([0.0, -1.0])

    def inner(self, u, v):
        return u @ v


def test_equations_without_an_index():
    assert tips(deflation(Rotated(), 1.0, guesses=[[0.3, 0.2]])) == [-1.0, 1.0]


# --- nothing to be found ------------------------------------------------------------------------------------------------


def test_none_is_found_where_none_is():
    strut = rl.Strut(n=10)
    assert deflation(strut, 1.0, known=[np.zeros(10)]) == []  # below the first load the straight one is alone [N 2.6]
    assert deflation(strut, 1.0, known=[strut.start()], guesses=[]) == []
    assert deflation(Scalar(lambda u, lam: u * u + 1, lambda u, lam: 2 * u, lambda u, lam: 0.0), 0.0, guesses=[[0.3]]) == []


def test_a_triple_root_is_one():
    strut = rl.Strut(n=20)
    e = rl.follow(rl.equilibrium(strut, 0.0), to=5.0).events[0]
    assert deflation(strut, e.lam, known=[e.point]) == []
    assert len(deflation(strut, e.lam, guesses=[lambda s: 0.1 * s, None])) == 1


def test_next_to_branch_points_and_folds():
    strut = rl.Strut(n=20)
    load = rl.buckling_loads(strut, 1)[0] * (1 + 1e-6)
    found = deflation(strut, load)
    assert [p.index for p in found] == [1, 0, 0]
    assert found[1].u == pytest.approx(-found[2].u, abs=1e-9)
    bent = rl.Strut(n=20, u_hat=0.01)
    fold = rl.follow(rl.equilibrium(bent, 5.0, lambda s: -2 * np.sin(np.pi * s / 2)), to=0.0).events[0]
    assert tips(deflation(bent, fold.lam, known=[fold.point])) == [round(main(bent, fold.lam).tip_angle, 6)]


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"known": [np.zeros(9)]}, r"known\[0\] must have shape \(10,\)"),
        ({"known": [None]}, r"known\[0\] must"),
        ({"known": [np.zeros(10), np.ones(10)]}, r"known\[1\] must be a solution of this Strut at lam = 5; it is Point"),
        (
            {"known": [rl.equilibrium(rl.Strut(n=10), 4.0)]},
            r"known\[0\] must be a solution of this Strut at lam = 5; it is Point\(lam=4",
        ),
        ({"known": [rl.equilibrium(rl.Rod(), 5.0)]}, r"known\[0\] must be a solution of this Strut"),
        ({"known": 3}, "known and guesses must be lists"),
        ({"guesses": None}, "known and guesses must be lists"),
        ({"guesses": [np.zeros(3)]}, r"guess must have shape \(10,\)"),
        ({"most": 0}, "most must be a whole number, at least 1; it is 0"),
        ({"limit": 0}, "limit must be a whole number, at least 1; it is 0"),
    ],
)
def test_what_is_wrong_is_said(wrong, says):
    with pytest.raises(ValueError, match=says):
        deflation(rl.Strut(n=10), 5.0, **wrong)
    with pytest.raises(ValueError, match="lam must be a finite number"):
        deflation(rl.Strut(n=10), np.inf)
