"""Imperfections: strength, ineffective ones, the cusp and its exponents, folds and branch points in two parameters."""

import numpy as np
import pytest

import rodlab as rl
from rodlab.lab.breaking import breaking

GOLDEN = (1 + 5**0.5) / 2


def pitchforks(model, to):
    return [e for e in rl.follow(rl.equilibrium(model, 0.0), to=to).events if e.kind == "branch point"]


# --- strength [exercises 15, 19, 31] ---------------------------------------------------------------------------------


def test_ineffective_imperfections_of_two_joints():
    """beta_1 = -0.618 beta_2 at lam_1, beta_1 = 1.618 beta_2 at lam_2."""
    one, two = pitchforks(rl.Strut.from_joints(k=[1, 1]), 3.0)
    for beta, ineffective in (([1 - GOLDEN, 1], (True, False)), ([GOLDEN, 1], (False, True)), ([1, 0], (False, False))):
        model = rl.Strut.from_joints(k=[1, 1], beta=beta)
        assert tuple(rl.imperfection(e, "beta", model).ineffective for e in (one, two)) == ineffective


def test_the_reduced_equation_of_the_rod():
    """At lam_j the amplitude (16 delta / lam_j)^(1/3), the fold at lam_j + 1.5 lam_j^(1/3) delta^(2/3), delta = <eps f, psi_j'>."""
    eps = 1e-3
    for j, event in enumerate(pitchforks(rl.Rod(), 25.0), start=1):
        q = (2 * j - 1) * np.pi / 2
        law = rl.imperfection(event, "u_hat", rl.Rod(u_hat=f"cos({2 * j - 1}*pi*s/2)"))
        lam, delta = q * q, eps * q / 2
        assert abs(law.amplitude(eps)) * 2**0.5 == pytest.approx((16 * delta / lam) ** (1 / 3), rel=1e-8)
        assert law.fold(eps) == pytest.approx(lam + 1.5 * lam ** (1 / 3) * delta ** (2 / 3), rel=1e-8)
        assert rl.imperfection(event, "u_hat", rl.Rod(u_hat=f"cos({2 * j + 1}*pi*s/2)")).ineffective


def test_an_ineffective_imperfection_leaves_a_corner(tmp_path):
    """The difference of branches at lam_1 is O(eps) for an ineffective shape, O(eps^(1/3)) else [Peterson and Manning 2009]."""
    lam = float(rl.buckling_loads(rl.Rod(), 1)[0])
    tips = {}
    for f in ("cos(3*pi*s/2)", "cos(pi*s/2)"):
        for eps in (1e-2, 1e-3):
            rod = rl.Rod(u_hat=f"{eps}*{f}")
            tips[f, eps] = abs(rl.follow(rl.equilibrium(rod, 0.0), to=lam).points[-1].tip_angle)
    slope = {f: np.log10(tips[f, 1e-2] / tips[f, 1e-3]) for f in ("cos(3*pi*s/2)", "cos(pi*s/2)")}
    assert slope["cos(3*pi*s/2)"] == pytest.approx(1.0, abs=0.02)
    assert slope["cos(pi*s/2)"] == pytest.approx(1 / 3, abs=0.01)


def test_any_model_with_a_parameter():
    class Bent:
        c = 0.0

        def residual(self, u, lam):
            return u**3 - lam * u - self.c

        def jacobian(self, u, lam):
            return np.diag(3 * u**2 - lam)

        def d_lam(self, u, lam):
            return -u

        def inner(self, u, v):
            return float(u @ v)

    event = rl.follow(rl.equilibrium(Bent(), -1.0, [0.0]), to=1.0).events[0]
    law = rl.imperfection(event, "c")
    assert law.fold(0.01) == pytest.approx(3 * (0.01 / 2) ** (2 / 3), rel=1e-9)  # 4 lam^3 = 27 c^2
    with pytest.raises(ValueError, match="name must be an attribute"):
        rl.imperfection(event, "d")
    with pytest.raises(ValueError, match="event must be a branch point"):
        rl.imperfection(None, "c")


# --- folds and branch points in two parameters --------------------------------------------------------------------


def fold_of(model, lam, guess):
    b = rl.follow(rl.equilibrium(model, lam, guess), to=0.0)
    return next(e for e in b.events if e.kind == "fold")


def test_the_folds_of_one_joint():
    """beta = phi - tan phi, lam = 1 / cos phi [exercise 15]: along the whole curve, and its cusp at (1, 0)."""
    event = fold_of(rl.Strut.from_joints(k=[1.0], beta=[0.1]), 2.0, [-1.8])
    curve = rl.follow(rl.folds(event, "beta"), to=0.5)
    for p in curve.points:
        phi = p.tip_angle
        assert p.lam == pytest.approx(1 / np.cos(phi), rel=1e-12)
        assert 0.1 * p.measure("beta") == pytest.approx(phi - np.tan(phi), abs=1e-12)
    assert [e.kind for e in curve.events] == ["fold", "end"]
    assert curve.events[0].lam == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("strut", [rl.Strut(n=50), rl.Strut(n=12, rule="trapezoid", K="2-s")])
def test_the_exponents_of_the_cusp(strut):
    b = breaking(strut)
    assert b.exponent[1:] == pytest.approx(2 / 3, abs=0.01)
    assert b.exponent[-1] == pytest.approx(2 / 3, abs=1e-5)
    assert b.root[1:] == pytest.approx(1 / 3, abs=0.01)
    assert b.root[-1] == pytest.approx(1 / 3, abs=1e-4)  # down to an imperfection of 1e-16
    law = [b.imperfection.fold(float(x)) - b.event.lam for x in b.beta]
    assert law[-1] == pytest.approx(b.off[-1], rel=1e-6)
    assert [e.kind for e in b.curve.events] == ["fold", "end"]
    assert b.curve.events[0].lam == pytest.approx(b.event.lam, rel=1e-10)


def test_folds_of_a_large_strut_and_a_rod():
    own = lambda s: -3 * np.sin(np.pi * s / 2)  # noqa: E731
    rod = fold_of(rl.Rod(u_hat=0.02), 10.0, own)
    curve = rl.follow(rl.folds(rod, "u_hat"), to=2.55)
    event = fold_of(rl.Rod(u_hat=curve.points[-1].measure("u_hat")), 10.0, own)
    assert event.lam == pytest.approx(2.55, rel=1e-9)
    strut = fold_of(rl.Strut(n=300, u_hat=0.02), 10.0, own)
    curve = rl.follow(rl.folds(strut, "u_hat"), to=strut.lam - 0.03)
    again = fold_of(rl.Strut(n=300, u_hat=curve.points[-1].measure("u_hat")), 10.0, own)
    assert again.lam == pytest.approx(strut.lam - 0.03, rel=1e-10)


def test_branch_points_in_two_parameters():
    """Stiffness keeps the symmetry: the branch point stays, at K times its load. Curvature breaks it."""
    event = pitchforks(rl.Strut(n=20), 5.0)[0]
    stays = rl.follow(rl.branch_points(event, "K"), to=2.0)
    assert stays.points[-1].measure("load") == pytest.approx(2 * event.lam, rel=1e-12)
    assert np.abs(stays.measure("broken")).max() < 1e-12
    broken = rl.follow(rl.branch_points(event, "u_hat"), to=0.01)
    assert abs(broken.points[-1].measure("broken")) > 1e-4
    for bad in (None, event.point):
        with pytest.raises(ValueError, match="event must be a"):
            rl.folds(bad, "beta")
    with pytest.raises(ValueError, match="event must be a branch point"):
        rl.branch_points(fold_of(rl.Strut(n=5, u_hat=0.1), 10.0, lambda s: -3 * s), "u_hat")


# --- symmetry broken by numbers -----------------------------------------------------------------------------------


def test_the_last_bit_chooses_the_side():
    """Steepest descent from the straight strut beyond its load, pushed by one part in 1e16: two mirror images."""
    strut = rl.Strut(n=4)
    v = np.sin(np.pi * np.arange(1, 5) / 8)
    right, left = (rl.equilibrium(strut, 4.0, guess=rl.steepest_descent(strut, 4.0, s * 1e-16 * v)[0].u) for s in (1, -1))
    assert right.index == left.index == 0
    assert right.u == pytest.approx(-left.u, abs=1e-12)
    assert abs(right.tip_angle) > 1.0


def test_detached_branches_by_deflation_and_through_u_hat():
    """Both ways lead to the same stable state that the imperfection cut off."""
    bent = rl.Strut(n=50, u_hat=0.01)
    main = rl.follow(rl.equilibrium(bent, 0.0), to=10.0).points[-1]
    found = rl.deflation(bent, 10.0, known=[main])
    straight = rl.Strut(n=50)
    buckled = rl.follow(rl.switch(pitchforks(straight, 5.0)[0])[1], to=10.0).points[-1]
    through = rl.follow(rl.equilibrium(rl.vary(straight, "u_hat", lam=10.0), 0.0, buckled.u), to=0.01).points[-1]
    assert min(np.abs(p.u - through.u).max() for p in found) < 1e-10
    assert len(found) == 2
    assert {p.index for p in found} == {0, 1}
