"""Loads and ends: closed forms, gradients of every term, indices under constraints, shear, one's own term through every verb."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import null_space
from scipy.special import ellipe, ellipk

import rodlab as rl
from rodlab.lab.agreement import agreement
from rodlab.lab.scene import scene

ENDS = [(foot, top) for foot in ("clamped", "hinged", "guided", "free") for top in ("clamped", "hinged", "guided", "free")]
PI2 = np.pi**2


def root(f, near):
    return float(mp.findroot(f, near))


def tan_root(near):
    """tan x = x."""
    return root(lambda x: mp.sin(x) - x * mp.cos(x), near)


# --- closed forms --------------------------------------------------------------------------------------------------------

LOADS = {
    ("clamped", "clamped"): (4 * PI2, (2 * tan_root(4.5)) ** 2, 16 * PI2),
    ("clamped", "hinged"): (tan_root(4.5) ** 2, tan_root(7.7) ** 2),
    ("hinged", "clamped"): (tan_root(4.5) ** 2, tan_root(7.7) ** 2),
    ("hinged", "hinged"): (PI2, 4 * PI2, 9 * PI2),
    ("clamped", "guided"): (PI2, 4 * PI2),
    ("guided", "clamped"): (PI2, 4 * PI2),
    ("hinged", "guided"): (PI2 / 4, 9 * PI2 / 4),
    ("free", "clamped"): (PI2 / 4, 9 * PI2 / 4),
    ("guided", "free"): (PI2 / 4, 9 * PI2 / 4),
}


@pytest.mark.parametrize("ends", LOADS)
def test_loads_of_every_pair_of_ends(ends):
    known = np.array(LOADS[ends])
    b = rl.buckling(rl.Rod(ends=ends), len(known))
    assert b.loads == pytest.approx(known, rel=1e-12)
    assert (np.abs(b.loads - known) <= b.error + 1e-15 * known).all()
    assert (b.error < 5e-11 * known).all()
    struts = [rl.buckling_loads(rl.Strut(n=n, rule="trapezoid", ends=ends), len(known)) for n in (100, 200)]
    assert (4 * struts[1] - struts[0]) / 3 == pytest.approx(known, rel=1e-5)


def test_the_numbers_of_the_books():
    assert rl.buckling_loads(rl.Rod(ends=("clamped", "clamped")), 2) == pytest.approx([39.4784176044, 80.7629142257], rel=1e-11)
    assert rl.buckling_loads(rl.Rod(ends=("clamped", "hinged")), 1) == pytest.approx([20.1907285564], rel=1e-11)
    column = rl.vary(rl.Rod(terms=rl.self_weight(1.0)), "q", lam=0.0)
    assert rl.buckling_loads(column, 1) == pytest.approx([7.8373474389], rel=1e-11)


def test_heavy_column_by_bessel():
    """Greenhill: J_{-1/3}(2 sqrt(q) / 3) = 0."""
    known = [root(lambda q: mp.besselj(-mp.mpf(1) / 3, 2 * mp.sqrt(q) / 3), near) for near in (7.8, 56.0, 148.5)]
    b = rl.buckling(rl.vary(rl.Rod(terms=rl.self_weight(1.0)), "q", lam=0.0), 3)
    assert b.loads == pytest.approx(known, rel=1e-12)
    assert (np.abs(b.loads - known) <= b.error + 1e-14).all()
    branch = rl.follow(rl.equilibrium(rl.vary(rl.Rod(terms=rl.self_weight(1.0)), "q", lam=0.0), 0.0), to=60.0)
    met = [e for e in branch.events if e.kind == "branch point"]
    assert [e.lam for e in met] == pytest.approx(known[:2], rel=1e-10)
    assert all(abs(e.lam - q) <= e.error + 1e-13 for e, q in zip(met, known, strict=False))


def test_winkler_foundation_between_hinges():
    """lam_j = (j pi)^2 + c / (j pi)^2: the first mode has two half-waves where c is above 4 pi^4."""
    waves = (np.pi * np.arange(1, 6)) ** 2
    known = np.sort(waves + 500 / waves)[:3]
    b = rl.buckling(rl.Rod(terms=rl.foundation(500.0), ends=("hinged", "hinged")), 3)
    assert b.loads == pytest.approx(known, rel=1e-12)
    s, mode = b.s, b.modes[0]
    assert np.abs(mode - np.cos(2 * np.pi * s) * np.sign(mode[0])).max() < 1e-9


@pytest.mark.parametrize("model", [rl.Rod, rl.Strut])
@pytest.mark.parametrize("tau", [0.3, -2.5, 40.0])
def test_end_torque_exactly(model, tau):
    """[N 2.6] N = 0, m = tau: phi' = u_hat + tau / K, one equilibrium for every tau."""
    p = rl.equilibrium(model(u_hat=0.5, K=2.0, terms=rl.end_torque(tau)), 0.0)
    assert p.phi == pytest.approx((0.5 + tau / 2) * p.s, abs=1e-13 * (1 + abs(tau)))
    assert p.index == 0
    if model is rl.Strut:
        assert rl.uniqueness(p.equations, 0.0)


def test_a_dead_force_in_any_direction_turns_the_clamp():
    """A force of size P at an angle, on an upright clamp, is a load P on a clamp turned back by that angle."""
    P, angle = 3.0, 0.7
    tilted = rl.equilibrium(rl.Rod(terms=rl.end_force(-P * np.sin(angle)), phi0=0.4), P * np.cos(angle))
    turned = rl.equilibrium(rl.Rod(phi0=0.4 - angle), P, lambda s: tilted(s).phi - angle)
    assert tilted.tip_angle - angle == pytest.approx(turned.tip_angle, abs=1e-12)


@pytest.mark.parametrize("shortening", [0.1, 0.5, 1.2])
def test_clamped_clamped_in_a_vice(shortening):
    """Four quarters of the cantilever: load 16 K(m)^2, shortening 2 - 2 E(m) / K(m)."""
    m = float(mp.findroot(lambda m: 2 - 2 * mp.ellipe(m) / mp.ellipk(m) - shortening, (0.02, 0.95), solver="anderson", tol=1e-25))
    load, widest = 16 * ellipk(m) ** 2, 2 * np.arcsin(np.sqrt(m))
    held = rl.vary(rl.Rod(ends=("clamped", "clamped")), "shortening")
    p = rl.equilibrium(held, shortening, lambda s: widest * np.sin(2 * np.pi * s))
    assert p.measure("load") == pytest.approx(load, rel=1e-12)
    assert 1 - p.height == pytest.approx(shortening, abs=1e-13)
    assert (p.x[-1], p.phi[-1]) == (pytest.approx(0, abs=1e-13), pytest.approx(0, abs=1e-13))
    assert (p.index, p.index_verified) == (int(shortening > 1), True)
    assert np.abs(p(0.25).phi) == pytest.approx(widest, abs=1e-11)
    assert 2 - 2 * ellipe(m) / ellipk(m) == pytest.approx(shortening, abs=1e-14)


def test_following_the_shortening_brings_the_load_up_to_the_figure_of_eight():
    """Where the ends meet, d = 1, the closed elastica can be cut anywhere: a branch of one shortening, the force only turns."""
    held = rl.vary(rl.Strut(n=80, rule="trapezoid", ends=("clamped", "clamped")), "shortening")
    b = rl.follow(rl.equilibrium(held, 0.05, lambda s: 0.5 * np.sin(2 * np.pi * s)), to=1.2)
    loads = np.array([p.measure("load") for p in b.points])
    assert (np.diff(loads) > 0).all()
    assert all(p.index_verified and p.index == int(p.lam > 1) for p in b.points)
    (met,) = [e for e in b.events if e.kind == "branch point"]
    assert met.lam == pytest.approx(1.0, abs=1e-9)
    m = float(mp.findroot(lambda m: 2 * mp.ellipe(m) - mp.ellipk(m), (0.7, 0.9), solver="anderson"))
    assert met.point.measure("load") == pytest.approx(16 * ellipk(m) ** 2, rel=1e-3)  # of the rod; this strut has 80 joints


# --- gradients ----------------------------------------------------------------------------------------------------------

TERMS = {
    "self_weight": rl.self_weight("1 + s"),
    "foundation": rl.foundation(3.0),
    "end_torque": rl.end_torque(0.3),
    "end_force": rl.end_force(0.7),
    "shearable": rl.shearable(A1=5.0, extension="0.1*(1 + s)"),
    "potential": rl.potential("sin(z) + x*z + x**3"),
}
MODELS = {
    "end": lambda **more: rl.Strut(n=5, u_hat=0.2, phi0=0.1, **more),
    "trapezoid": lambda **more: rl.Strut(n=5, K="1 + s", u_hat=0.2, rule="trapezoid", phi0=0.1, **more),
    "rod": lambda **more: rl.Rod(K="1 + s", u_hat=0.2, phi0=0.1, mesh=2, degree=3, **more),
}


@pytest.mark.parametrize("kind", MODELS)
@pytest.mark.parametrize("name", TERMS)
@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10**6), lam=st.floats(-20, 20))
def test_the_gradient_of_every_term_is_that_of_its_energy(kind, name, seed, lam):
    """By complex step, to rounding; the Hessian by differences of the gradient."""
    model = MODELS[kind](terms=TERMS[name])
    phi = np.random.default_rng(seed).normal(size=model.start().size)
    steps = np.eye(phi.size)
    slopes = [np.imag(model.energy(phi + 1e-30j * d, lam)) / 1e-30 for d in steps]
    size = 1 + abs(lam) + np.abs(model.hessian(phi, lam).toarray()).max()
    assert model.gradient(phi, lam) == pytest.approx(slopes, abs=1e-13 * size)
    change = [(model.gradient(phi + 1e-5 * d, lam) - model.gradient(phi - 1e-5 * d, lam)) / 2e-5 for d in steps]
    assert model.hessian(phi, lam).toarray() == pytest.approx(np.array(change), abs=1e-8 * size**2)


PAIRS = [(name, ends) for name in ("none", "foundation", "self_weight") for ends in ENDS]
PAIRS += [("shearable", ends) for ends in (("clamped", "free"), ("clamped", "clamped"))]  # the rest are derived from the same


@pytest.mark.parametrize(("name", "ends"), PAIRS)
@pytest.mark.parametrize("kind", MODELS)
def test_the_equations_of_every_pair_of_ends(kind, name, ends):
    """Jacobian and d_lam against differences, solves, and the index against the form projected on the constraints."""
    terms = () if name == "none" else TERMS[name]
    model = MODELS[kind](terms=terms, ends=ends)
    rng = np.random.default_rng(3)
    u = model.start(lambda s: 0.3 + s)
    u, lam, e = u + 0.3 * rng.normal(size=u.size), 1.7, 1e-6
    J = model.jacobian(u, lam)
    dense = J.toarray()
    change = [(model.residual(u + e * d, lam) - model.residual(u - e * d, lam)) / (2 * e) for d in np.eye(u.size)]
    assert dense == pytest.approx(np.array(change).T, abs=1e-7)
    by_load = (model.residual(u, lam + e) - model.residual(u, lam - e)) / (2 * e)
    assert model.d_lam(u, lam) == pytest.approx(by_load, abs=1e-8)
    assert J @ u == pytest.approx(dense @ u, abs=1e-12)
    if not J.nullity:
        b = rng.normal(size=u.size)
        assert dense @ J.solve(b) == pytest.approx(b, abs=1e-8)
    if hasattr(model, "unknowns") and J.index_verified:
        c = model.constraints
        assert J.index == (np.linalg.eigvalsh(dense) < 0).sum() - c  # of the bordered matrix
        if name != "shearable":  # there the border has a block of its own
            Z = null_space(dense[:c, c:]) if c else np.eye(u.size)
            assert J.index == (np.linalg.eigvalsh(Z.T @ dense[c:, c:] @ Z) < 0).sum()


@pytest.mark.parametrize("ends", [("clamped", "hinged"), ("hinged", "hinged"), ("free", "clamped"), ("guided", "hinged")])
@pytest.mark.parametrize("name", ["K", "u_hat", "c", "shortening"])
@pytest.mark.parametrize("kind", MODELS)
def test_anything_can_stand_in_the_loads_place(kind, name, ends):
    model = MODELS[kind](terms=TERMS["foundation"], ends=ends)
    varied = rl.vary(model, name) if name == "shortening" else rl.vary(model, name, lam=1.3)
    u = varied.start(lambda s: 0.3 + s)
    value, e = 0.8, 1e-5
    by_value = (varied.residual(u, value + e) - varied.residual(u, value - e)) / (2 * e)
    assert varied.d_lam(u, value) == pytest.approx(by_value, abs=1e-7)
    change = [(varied.residual(u + e * d, value) - varied.residual(u - e * d, value)) / (2 * e) for d in np.eye(u.size)]
    assert varied.jacobian(u, value).toarray() == pytest.approx(np.array(change).T, abs=1e-6)


def test_offset_and_turned_tops_are_kept():
    for model in (rl.Rod, rl.Strut):
        p = rl.equilibrium(model(ends=("clamped", "clamped"), phi1=0.3, offset=0.2), 5.0)
        assert (p.x[-1], p.phi[-1]) == (pytest.approx(0.2, abs=1e-12), pytest.approx(0.3, abs=1e-12))
        moved = rl.follow(rl.equilibrium(rl.vary(model(ends=("clamped", "hinged")), "offset", lam=5.0), 0.0), to=0.4)
        assert moved.points[-1].x[-1] == pytest.approx(0.4, abs=1e-12)
        turned = rl.follow(rl.equilibrium(rl.vary(model(ends=("clamped", "guided")), "phi1", lam=2.0), 0.0), to=-1.0)
        assert turned.points[-1].phi[-1] == pytest.approx(-1.0, abs=1e-12)


def test_reactions_balance():
    """Statics: at the foot the moment holds the end's couple and force; energy's change is the load's work."""
    p = rl.equilibrium(rl.Rod(u_hat=0.8, ends=("clamped", "hinged")), 4.0)
    assert p.measure("moment") == pytest.approx(-p.measure("N1") * p.height + 4.0 * 0, abs=1e-10) or p.x[-1] == pytest.approx(0)
    near = [rl.equilibrium(p.equations, 4.0 + e, p.u).energy for e in (-1e-4, 1e-4)]
    assert (near[1] - near[0]) / 2e-4 == pytest.approx(p.height, abs=1e-7)  # dV/dlam = height


# --- indices --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", [rl.Strut(n=40, u_hat=0.1), rl.Rod(u_hat=0.1)])
def test_what_snaps_under_weights_does_not_in_a_vice(model):
    """Beyond the fold of the detached branch: index 1 under the dead load, 0 under the shortening; both by bordered matrices."""
    b = rl.follow(rl.equilibrium(model, 4.0, lambda s: -2 * s), to=0.0)
    (fold,) = [e for e in b.events if e.kind == "fold"]
    beyond = [p for p in b.points if p.index == 1]
    assert len(beyond) > 3
    for p in beyond:
        found = rl.indices(p)
        assert (found.dead_load.negative, found.shortening.negative) == (1, 0)
        assert found.dead_load.verified
        assert found.shortening.verified
        own = p.equations
        H = own.hessian(p.u, p.lam).toarray()
        g = own.d_lam(p.u, p.lam)  # the change of z(1) with the angles
        bordered = np.block([[np.zeros((1, 1)), g[None]], [g[:, None], H]])
        assert (np.linalg.eigvalsh(bordered) < 0).sum() - 1 == 0
    assert fold.lam < 4.0


def test_a_clamped_hinged_rod_by_one_and_by_two_constraints():
    """Its load rises to 1.1396 times the buckling load and falls: unstable from there under weights, not in a vice."""
    model = rl.Rod(ends=("clamped", "hinged"))
    straight = rl.follow(rl.equilibrium(model, 0.0), to=22.0)
    b = rl.follow(rl.switch(straight.events[0])[0], to=28.0)
    (fold,) = [e for e in b.events if e.kind == "fold"]
    assert fold.lam / straight.events[0].lam == pytest.approx(1.13961, abs=1e-5)
    after = [rl.indices(p) for p in b.points if p.index == 1]
    assert after
    assert {(found.dead_load.negative, found.shortening.negative) for found in after} == {(1, 0)}
    known = [rl.indices(p) for p in b.at(22.5)]  # one before the fold, one beyond
    assert [(k.dead_load.negative, k.shortening.negative) for k in known] == [(0, 0), (1, 0)]
    assert all(part.verified for k in known for part in k)
    vice = rl.follow(
        rl.equilibrium(rl.vary(model, "shortening"), 1 - b.points[-1].height, lambda s: b.points[-1](s).phi), to=0.05
    )
    assert max(p.measure("load") for p in vice.points) <= fold.lam + 1e-9
    assert {p.index for p in vice.points} == {0}  # no fold in the shortening


def test_clamped_clamped_by_one_and_by_two_constraints():
    """A curved rod between clamps has a fold in the load, none in the shortening: between them the two indices differ."""
    model = rl.Strut(n=60, rule="trapezoid", u_hat="0.6*cos(2*pi*s)", ends=("clamped", "clamped"))
    top = 48.0
    start = rl.equilibrium(model, top, lambda s: -1.2 * np.sin(2 * np.pi * s))
    b = rl.follow(start, to=0.0)
    seen = set()
    for p in b.points:
        found = rl.indices(p)
        J = p.equations.jacobian(p.u, p.lam).toarray()
        c = p.equations.constraints
        assert found.dead_load.negative == (np.linalg.eigvalsh(J) < 0).sum() - c
        g = p.equations.d_lam(p.u, p.lam)
        J2 = np.block([[np.zeros((1, 1)), g[None]], [g[:, None], J]])
        if found.shortening.verified:
            assert found.shortening.negative == (np.linalg.eigvalsh(J2) < 0).sum() - c - 1
            seen.add((found.dead_load.negative, found.shortening.negative))
    assert (1, 0) in seen
    assert (0, 0) in seen


# --- shear and extension ---------------------------------------------------------------------------------------------------


def test_both_loads_of_an_extensible_rod():
    """P (1 - P / 50) = pi^2 / 4: it buckles, and is straight again before it would be crushed."""
    known = np.array([root(lambda P: P * (1 - P / 50) - mp.pi**2 / 4, near) for near in (2.6, 47.4)])
    assert [each.load for each in rl.shear_loads(np.inf, 50.0)] == pytest.approx(known, rel=1e-14)
    rod = rl.Rod(terms=rl.shearable(A3=50.0))
    b = rl.buckling(rod, 2)
    assert b.loads == pytest.approx(known, rel=1e-12)
    assert (np.abs(b.loads - known) <= b.error + 1e-14).all()
    branch = rl.follow(rl.equilibrium(rod, 0.0), to=49.0)
    met = [e for e in branch.events if e.kind == "branch point"]
    assert [e.lam for e in met] == pytest.approx(known, rel=1e-10)
    assert [p.index for p in (branch.at(x)[0] for x in (1.0, 20.0, 48.5))] == [0, 1, 0]
    with pytest.raises(ValueError, match="modes must be at most 2, the number of loads below 50, which crushes the rod; it is 3"):
        rl.buckling(rod, 3)
    with pytest.raises(ValueError, match="modes must be at most 0"):
        rl.buckling(rl.Rod(terms=rl.shearable(A3=9.0)), 1)


def test_equal_stiffnesses_leave_eulers_loads():
    assert rl.buckling_loads(rl.Rod(terms=rl.shearable(A1=30.0, A3=30.0)), 1) == pytest.approx([PI2 / 4], rel=1e-12)


@pytest.mark.parametrize("model", [rl.Rod, lambda **more: rl.Strut(n=400, rule="trapezoid", **more)])
def test_a_sheared_rod_by_its_three_strains(model):
    """phi, v1, v3 with all their energy, minimised at once, against the reduced form."""
    A1, A3, lam, K = 8.0, 20.0, 3.0, 1.0
    p = rl.equilibrium(model(terms=rl.shearable(A1=A1, A3=A3)), lam, lambda s: 1.2 * s)
    v1, v3 = lam * np.sin(p.phi) / A1, 1 - lam * np.cos(p.phi) / A3
    s = np.linspace(0, 1, 4001)
    phi = p(s).phi
    v1, v3 = lam * np.sin(phi) / A1, 1 - lam * np.cos(phi) / A3
    z = np.trapezoid(v3 * np.cos(phi) - v1 * np.sin(phi), s)
    x = np.trapezoid(v3 * np.sin(phi) + v1 * np.cos(phi), s)
    assert (p.x[-1], p.z[-1]) == (pytest.approx(x, abs=2e-6), pytest.approx(z, abs=2e-6))
    assert p.height == pytest.approx(p.z[-1], abs=1e-12)
    stored = np.trapezoid(K * np.gradient(phi, s) ** 2 / 2 + A1 * v1**2 / 2 + A3 * (v3 - 1) ** 2 / 2, s)
    assert p.energy == pytest.approx(stored + lam * z, abs=1e-5)


def test_restabilisation():
    """A3 = 12: straight again from 8.53 on, beside the buckled rod that stays; what leaves there is unstable."""
    rod = rl.Rod(terms=rl.shearable(A3=12.0))
    known = rl.buckling_loads(rod, 2)
    straight = rl.follow(rl.equilibrium(rod, 0.0), to=11.5)
    first, second = [e for e in straight.events if e.kind == "branch point"]
    assert [first.lam, second.lam] == pytest.approx(known, rel=1e-9)
    assert [straight.at(x)[0].index for x in (3.0, 6.0, 9.0)] == [0, 1, 0]
    buckled = rl.follow(rl.switch(first)[0], to=11.5)
    assert [e.kind for e in buckled.events] == ["fold", "end"]  # it begins backwards
    assert buckled.points[-1].index == 0
    leaving = rl.follow(rl.switch(second)[0], to=11.5)
    assert {p.index for p in leaving.points} == {1}
    assert all(min(1 - p.lam * np.cos(p.phi) / 12.0) > 0 for p in leaving.points)  # v3 > 0: admissible


# --- agreement -------------------------------------------------------------------------------------------------------------


def test_strut_and_rod_agree_at_the_rules_order():
    """The table of README, for every term and every end: within a twentieth of 1 and of 2."""
    cases = scene("agreement").asks["agreement"]["case"]
    asked = {name for case in cases for name in case["model"].get("terms", {})}
    assert asked >= {"self_weight", "foundation", "end_torque", "end_force", "potential", "shearable"}
    for case in agreement(cases, [50, 100, 200, 400]):
        for rule, order in (("end", 1), ("trapezoid", 2)):
            known = case.observed[rule]
            assert known.order == pytest.approx(order, abs=0.05), (case.name, case.ask, rule)
            assert known.clear, (case.name, case.ask, rule)
        assert case.error < 1e-9 * max(1.0, abs(case.truth))


# --- one's own term ---------------------------------------------------------------------------------------------------------


def wind(link):
    """Five lines in a notebook: a wind along x, stronger higher up."""
    return -link.p * link.h * link.w * link.x * (1 + link.z)


@pytest.mark.parametrize("ends", [("clamped", "free"), ("clamped", "hinged")])
@pytest.mark.parametrize("model", [rl.Rod, lambda **more: rl.Strut(n=40, rule="trapezoid", **more)])
def test_a_term_of_ones_own_goes_through_every_verb(model, ends, tmp_path):
    own = model(terms=(rl.term(wind, p=0.5),), ends=ends)
    p = rl.equilibrium(own, 1.0)
    assert p.index == 0
    assert np.isfinite([p.error, p.energy, p.height, p.x[-1]]).all()
    b = rl.follow(p, to=2.0)
    assert b.points[-1].lam == 2.0
    path = b.save(tmp_path / "b.npz")
    assert rl.read(path, model=own).points[-1].tip_angle == b.points[-1].tip_angle
    varied = rl.follow(rl.equilibrium(rl.vary(own, "p", lam=1.0), 0.5, lambda s: p(s).phi), to=0.0)
    assert np.abs(varied.points[-1].phi).max() < 1e-9  # no wind, no bending
    assert rl.indices(p).dead_load.negative == 0
    assert rl.diagram(own, lam=(0.0, 2.0)).count(1.0) >= 1
    assert "x" in str(own.derivation())


def test_strut_and_rod_have_the_same_wind():
    values = [
        rl.equilibrium(model(terms=(rl.term(wind, p=0.5),)), 1.0).tip_angle
        for model in (rl.Rod, lambda **m: rl.Strut(n=400, rule="trapezoid", **m))
    ]
    assert values[0] == pytest.approx(values[1], abs=1e-5)


# --- bad input ----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: rl.Strut(ends=("clamped", "welded")), "ends must be two of 'clamped', 'hinged', 'guided', 'free', the foot first"),
        (lambda: rl.Rod(ends="clamped"), "ends must be two of"),
        (lambda: rl.Rod(phi1=0.3), "phi1 must be zero where the top is free, whose angle is not held; it is 0.3"),
        (lambda: rl.Rod(ends=("clamped", "guided"), offset=0.2), "offset must be zero unless both ends hold the place; it is 0.2"),
        (lambda: rl.Rod(ends=("clamped", "hinged"), terms=rl.end_force(1.0)), "N1 must not be given where the top is hinged"),
        (lambda: rl.Rod(ends=("clamped", "clamped"), terms=rl.end_torque(1.0)), "tau must not be given where the top is clamped"),
        (lambda: rl.vary(rl.Rod(), "shortening", lam=1.0), "lam must not be given with the shortening"),
        (lambda: rl.vary(rl.Rod(), "u_hat"), "lam must be given where u_hat is followed"),
        (lambda: rl.vary(rl.Rod(ends=("clamped", "hinged")), "phi1", lam=1.0), "phi1 must be held by the ends to be followed"),
        (lambda: rl.Rod(ends=("guided", "guided"), terms=rl.end_force(0.7)), "N1 must have something to act against"),
        (lambda: rl.shearable(A1=-1.0), "A1 must be a positive number, or infinite; it is -1.0"),
        (lambda: rl.potential("y"), "U: 'y' is not an expression in x and z: y is not known"),
        (lambda: rl.potential(3), "U must be an expression in x and z as a string; it is 3"),
        (lambda: rl.koiter(rl.Strut(n=3, ends=("clamped", "clamped"))), "strut must be clamped at the foot and free at the top"),
        (lambda: rl.all_equilibria(rl.Strut(n=3, ends=("hinged", "hinged")), 1.0), "strut must be clamped at the foot"),
        (lambda: rl.buckling(rl.vary(rl.Rod(), "shortening"), 1), "model must be a Strut or a Rod, or one varied in a parameter"),
        (lambda: rl.Rod(terms=(rl.shearable(A3=5.0), rl.self_weight(1.0))), "a rod that shears or extends bears no load on its length"),
    ],
)  # fmt: skip
def test_bad_ends_and_terms_get_one_sentence(make, says):
    with pytest.raises(ValueError, match=says):
        make()


def test_recipes_make_the_same_model_again():
    from rodlab.mechanics.recipe import build

    for model in (
        rl.Strut(n=5, ends=("hinged", "clamped"), phi1=0.1, terms=rl.potential("z**2")),
        rl.Rod(ends=("clamped", "hinged"), offset=0.1, terms=(rl.shearable(A3=30.0),)),
        rl.vary(rl.Rod(ends=("clamped", "clamped")), "shortening"),
        rl.vary(rl.Strut(n=5, ends=("clamped", "hinged")), "offset", lam=2.0),
        rl.Strut.from_joints(k=[1, 2, 1], ends=("clamped", "hinged")),
    ):
        again = build(model.recipe)
        assert repr(again) == repr(model)
        u = model.start(lambda s: 0.3 * s)
        assert np.array_equal(again.residual(u, 0.2), model.residual(u, 0.2))


# --- what an adversary found --------------------------------------------------------------------------------------------------


def test_a_floating_rod_carries_a_force_by_its_foundation():
    """c times the integral of x is the force across, exactly at equilibrium."""
    for model in (rl.Rod, lambda **more: rl.Strut(n=200, rule="trapezoid", **more)):
        p = rl.equilibrium(model(ends=("free", "free"), terms=(rl.foundation(200.0), rl.end_force(3.0))), 1.0)
        s = np.linspace(0, 1, 4001)
        assert 200 * np.trapezoid(p(s).x, s) == pytest.approx(3.0, abs=2e-3)
    assert 200 * float(
        p.equations.joints.h * p.equations.joints.w @ p.x[1:] + p.equations.joints.h * 0.5 * p.x[0]
    ) == pytest.approx(3)


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("n", [1, 2, 3])
def test_a_joint_or_two_between_any_ends(n, ends):
    """Solved, with an index that is never below zero; or a sentence where the ends leave nothing to move."""
    try:
        strut = rl.Strut(n=n, ends=ends)
    except ValueError as error:
        assert "more joints are needed" in str(error)
        assert n == 1
        return
    p = rl.equilibrium(strut, 1.0)
    assert p.index >= 0
    found = rl.indices(p)
    for known in found:
        assert min(known) >= 0


def test_a_heavy_rod_upside_down():
    """A foot that slides and cannot turn, a top that is clamped: as clamped and guided, the weight counted from the foot."""
    loads = [
        rl.buckling_loads(rl.Rod(ends=ends, terms=rl.self_weight(2.0)), 2)
        for ends in (("guided", "clamped"), ("clamped", "guided"))
    ]
    assert loads[0] == pytest.approx(loads[1], rel=1e-12)


@pytest.mark.parametrize(("mesh", "degree", "more"), [(1, 4, {"phi1": 0.7}), (2, 2, {"phi1": 2.0}), (3, 3, {"phi1": -1.0})])
@pytest.mark.parametrize("top", ["clamped", "guided"])
def test_the_error_is_not_that_of_a_given_angle(mesh, degree, more, top):
    model = rl.Rod(u_hat=1.0, ends=("clamped", top), mesh=mesh, degree=degree, **more)
    p = rl.equilibrium(model, 8.0)
    truth = rl.equilibrium(model.replace(mesh=None, degree=8), 8.0, lambda s: p(s).phi)
    if mesh == 1:
        off = abs(p.measure("tau") - truth.measure("tau"))
    else:
        inner = p.u[-model.grid.N * degree :][degree - 1 : -1 : degree]
        off = max(abs(a - truth(s).phi) for a, s in zip(inner, model.mesh[1:-1], strict=True))
    assert p.error >= 0.9 * off
    assert p.error < 1e3 * off + 1e-9


def test_a_straight_state_says_that_its_shortening_constrains_nothing():
    """Reached with angles of 1e-16 to 1e-106: a border of rounding is none."""
    for ends in (("clamped", "free"), ("hinged", "hinged")):
        found = rl.indices(rl.equilibrium(rl.Rod(ends=ends), 15.0, lambda s: 0.01 * np.sin(3 * s)))
        assert not found.shortening.verified


def test_loads_of_stiff_heavy_struts_are_refined_or_bisected():
    strut = rl.Strut(n=5, rule="trapezoid", K=[1000, 1000, 1000, 1, 1], terms=(rl.self_weight(1.0),))
    H, W = strut.hessian(np.zeros(5), 0.0).toarray(), np.diag(strut.joints.h * strut.joints.w)
    from scipy.linalg import eigh

    b = rl.buckling(strut, 5)
    assert b.loads == pytest.approx(eigh(H, W, eigvals_only=True), rel=1e-10)
    assert (b.error < 1e-9 * b.loads).all()


def test_a_rod_that_was_used_before_is_as_good_as_a_new_one():
    """Nothing computed for other equations is kept: errors, shapes and indices of a varied rod."""

    def made():
        return rl.Rod(ends=("clamped", "hinged"), u_hat=1.0, K="1+s", mesh=6)

    used = made()
    assert rl.equilibrium(used, 2.0).error < 1e-9
    for name, value in (("offset", 0.2), ("u_hat", 0.3), ("K", 1.7), ("shortening", 0.2)):
        lam = {} if name == "shortening" else {"lam": 2.0}
        p, q = (rl.equilibrium(rl.vary(model, name, **lam), value) for model in (used, made()))
        assert p(0.37).phi == pytest.approx(q(0.37).phi, abs=1e-9)
        assert p.error < 1e-9
        if name == "shortening":
            assert rl.indices(p).dead_load.verified


@pytest.mark.parametrize("model", [rl.Rod, lambda **more: rl.Strut(n=30, rule="trapezoid", **more)])
def test_folds_of_a_held_model_are_followed_in_another_parameter(model):
    held = model(ends=("clamped", "hinged"), u_hat=0.02)
    b = rl.follow(rl.equilibrium(held, 0.0), to=24.0)
    fold = next(e for e in b.events if e.kind == "fold")
    moved = rl.follow(rl.folds(fold, "u_hat"), to=fold.lam - 0.05)
    own = float(moved.points[-1].measure("u_hat"))
    again = rl.follow(rl.equilibrium(held.replace(u_hat=own), 0.0), to=24.0)
    other = next(e for e in again.events if e.kind == "fold")
    assert moved.points[-1].lam == pytest.approx(other.lam, rel=1e-8)
    assert abs(own) > 0.02


def test_a_followed_model_stays_followed_when_it_is_replaced():
    vice = rl.vary(rl.Strut(n=20, ends=("clamped", "clamped")), "shortening").replace(K=2.0)
    assert rl.equilibrium(vice, 0.3, lambda s: np.sin(2 * np.pi * s)).height == pytest.approx(0.7, abs=1e-12)


def test_several_potentials_are_kept_in_a_recipe():
    from rodlab.mechanics.recipe import build

    model = rl.Strut(n=3, terms=(rl.potential("z"), rl.potential("x")))
    assert build(model.recipe).terms == model.terms


def test_models_travel_to_other_processes():
    import pickle

    for model in (
        rl.Rod(K="1 + s", ends=("clamped", "hinged"), terms=(rl.potential("z"),)),
        rl.Strut(n=5, terms=(rl.self_weight("1 + s"), rl.end_force(0.2))),
    ):
        again = pickle.loads(pickle.dumps(model))
        assert repr(again) == repr(model)
        assert rl.equilibrium(again, 1.0).height == rl.equilibrium(model, 1.0).height


def load_on_x(link):
    return link.lam * link.x * link.h


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: rl.Rod(terms=rl.term(load_on_x)), "the loads lam and N1 must act through the angles"),
        (lambda: rl.Strut(terms=rl.term(lambda link: 1 / 0 * link.h)), "must return a SymPy expression of the link: division by zero"),
        (lambda: rl.Strut(terms=rl.term(wind, K=1.0)), "the parameter K of wind is already that of the model"),
        (lambda: rl.Strut(terms=rl.term(wind, tau=1.0)), "the parameter tau of wind is the couple on the end"),
        (lambda: rl.shearable(A1="5"), "A1 must be a positive number, or infinite; it is '5'"),
        (lambda: rl.shearable(A1=5.0, shear=0.1), "A1 must not be given with shear, its inverse"),
        (lambda: rl.shearable(extension=-1.0), "extension must not be negative; it is -1.0"),
        (lambda: rl.Rod(ends=("clamped", "hinged")).replace(foo=1), "the model has no argument foo; it has K, u_hat"),
        (lambda: rl.steepest_descent(rl.Strut(n=4, ends=("clamped", "hinged")), 1.0), "HeldStrut is held by constraints"),
    ],
)  # fmt: skip
def test_misuse_gets_one_sentence(make, says):
    with pytest.raises(ValueError, match=says):
        make()
