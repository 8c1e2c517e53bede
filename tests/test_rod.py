"""The collocated rod against the exact elastica, published tables, the strut, and an independent finer mesh."""

import functools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import ellipj, ellipk

import rodlab as rl
from rodlab.mechanics.resolution import companion_of
from rodlab.numerics.slack import form, largest

FOLD = 2.56242639743  # of the rod with u_hat = 0.01, from AUTO and from 40-digit shooting


def load(mode, ratio=1.0):
    return ratio * ((2 * mode - 1) * np.pi / 2) ** 2


def guess(exact):
    """The shape in double precision, by scipy's Jacobi functions."""
    k, w = float(exact._known["k"]), np.sqrt(exact.lam / exact.K)
    return lambda s: 2 * np.arcsin(k * ellipj(w * s, k * k)[0])


@functools.cache
def trivial():
    return rl.follow(rl.equilibrium(rl.Rod(), 0.0), to=load(3, 1.2))


@functools.cache
def branch(mode, ratio):
    return rl.follow(rl.switch(trivial().events[mode - 1])[0], to=load(mode, ratio))


# --- the elastica ------------------------------------------------------------------------------------------------


def test_elastica_in_timoshenko_and_gere():
    """alpha in degrees against P / P_cr [Theory of Elastic Stability, 2.7]."""
    table = {20: 1.015, 40: 1.064, 60: 1.152, 80: 1.294, 100: 1.518, 120: 1.885, 140: 2.542, 160: 4.030, 176: 9.116}
    for alpha, printed in table.items():
        ratio = (ellipk(np.sin(np.radians(alpha) / 2) ** 2) / (np.pi / 2)) ** 2
        assert abs(ratio - printed) < 6e-4
        exact = rl.elastica(load(1, ratio))
        assert np.degrees(exact.tip_angle) == pytest.approx(alpha, abs=1e-9)
        assert rl.equilibrium(rl.Rod(), load(1, ratio), guess(exact)).tip_angle == pytest.approx(np.radians(alpha), rel=1e-12)


@pytest.mark.parametrize(("lam", "mode"), [(5.0, 1), (60.0, 2), (75.0, 3), (400.0, 2)])
def test_elastica_against_integration(lam, mode):
    from scipy.integrate import solve_ivp

    e = rl.elastica(lam, mode)
    run = solve_ivp(
        lambda s, y: [y[1], -lam * np.sin(y[0]), np.sin(y[0]), np.cos(y[0]), y[1] ** 2 / 2 + lam * np.cos(y[0])],
        (0, 1), [0, e.curvature, 0, 0, 0], rtol=1e-13, atol=1e-13, method="DOP853", dense_output=True,
    )  # fmt: skip
    _, phi, x, z = e(np.linspace(0, 1, 5))
    assert np.abs(run.sol(np.linspace(0, 1, 5))[[0, 2, 3]] - [phi, x, z]).max() < 1e-8
    assert abs(run.y[4, -1] - e.energy) < 1e-7
    assert (phi[-1], x[-1], z[-1]) == pytest.approx((e.tip_angle, e.deflection, e.height), abs=1e-15)
    assert e.moment == e.curvature == e.measure("moment")
    assert (e.s[-1], e.phi[-1], e.x[-1], e.z[-1]) == pytest.approx((1.0, e.tip_angle, e.deflection, e.height), abs=1e-15)


def test_elastica_near_its_load_and_far_from_it():
    for eps in (1e-3, 1e-6, 1e-9):
        e = rl.elastica(load(1) * (1 + eps))
        assert e.tip_angle == pytest.approx(np.sqrt(8 * eps), rel=2 * eps + 1e-6 / eps * 1e-9)
        assert e.condition == pytest.approx(1 / (2 * eps), rel=0.01)
    far = rl.elastica(1e6)
    assert far.tip_angle == pytest.approx(np.pi, abs=1e-15)
    assert far.height == pytest.approx(2 / 1000 - 1, abs=1e-15)
    assert far.error < 1e-15
    assert rl.elastica(10.0, K=2.0).tip_angle == rl.elastica(5.0).tip_angle
    for wrong in ({"lam": 2.0}, {"lam": 20.0, "mode": 2}, {"lam": 5.0, "K": -1.0}, {"lam": 5.0, "mode": 0}, {"lam": 1e9}):
        with pytest.raises(ValueError, match=r"lam must|K must|mode must"):
            rl.elastica(**wrong)


# --- the rod against it ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", [1, 2, 3])
@pytest.mark.parametrize("ratio", [1.001, 1.01, 1.1, 1.5, 2.0, 4.0, 10.0, 30.0])
def test_twelve_digits(mode, ratio):
    exact = rl.elastica(load(mode, ratio), mode)
    p = rl.equilibrium(rl.Rod(), exact.lam, guess(exact))
    found = [p.tip_angle, p.height, p.energy, p.measure("curvature"), p.x[-1], p.z[-1]]
    true = [exact.tip_angle, exact.height, exact.energy, exact.curvature, exact.deflection, exact.height]
    assert found == pytest.approx(true, rel=1e-12)
    assert abs(p.tip_angle - exact.tip_angle) <= p.error
    assert (p.index, p.index_verified) == (mode - 1, True)
    assert rl.conjugate_points(p).size == mode - 1


def test_followed_to_where_the_critical_eigenvalue_is_exponentially_small():
    p = branch(1, 100.0).points[-1]
    exact = rl.elastica(p.lam)
    assert abs(p.tip_angle - exact.tip_angle) <= min(p.error, 100 * 2.3e-16 * (1 + exact.condition) * np.pi)
    p = branch(2, 30.0).points[-1]
    assert p.tip_angle == pytest.approx(rl.elastica(p.lam, 2).tip_angle, rel=1e-11)


@pytest.mark.parametrize("mode", [1, 2, 3])
def test_a_hundred_times_the_load_to_what_the_condition_leaves(mode):
    exact = rl.elastica(load(mode, 100.0), mode)
    rod = rl.Rod(mesh=60, degree=8)
    p = rl.equilibrium(rod, exact.lam, exact(rod.grid.places[1:]).phi)
    condition = 1 + p.measure("condition")
    assert condition > (1e3 if mode > 1 else 0)  # of the tip; that of the inner layers is 1e12
    assert abs(p.tip_angle - exact.tip_angle) <= 100 * np.finfo(float).eps * condition * abs(exact.tip_angle)
    assert p.height == pytest.approx(exact.height, abs=1e-10)  # of this mesh
    assert p.index_verified == (mode == 1)  # the critical eigenvalue is exponentially small, and said to be


@pytest.mark.parametrize("mode", [1, 2, 3])
def test_branches_from_branch_points(mode):
    event = trivial().events[mode - 1]
    assert event.kind == "branch point"
    assert abs(event.lam - load(mode)) <= event.error < 1e-9
    b = branch(mode, 2.0)
    assert b.completed
    p = b.points[-1]
    exact = rl.elastica(p.lam, mode)
    assert abs(p.tip_angle) == pytest.approx(abs(exact.tip_angle), rel=1e-12)
    assert p.index == mode - 1


def test_between_mesh_points_it_is_as_good():
    exact = rl.elastica(10.0)
    p = rl.equilibrium(rl.Rod(), 10.0, guess(exact))
    s = np.linspace(0, 1, 41)
    for own, true in zip(p(s), exact(s), strict=True):
        assert np.abs(own - true).max() < 1e-11
    with pytest.raises(ValueError, match="s must lie between"):
        p(1.5)


# --- meshes, layers, folds ---------------------------------------------------------------------------------------


def test_layers_at_extreme_loads():
    p = rl.equilibrium(rl.Rod(u_hat=1.0), -1e6)  # cold: phi = sinh(1000 s) / (1000 cosh(1000)) but for phi^3 / 6
    assert p.tip_angle == pytest.approx(1e-3 * (1 + 1e-6 / 24), rel=1e-11)
    assert (p.index, p.index_verified) == (0, True)
    assert p.equations.grid.N < 100
    assert np.diff(p.equations.mesh).min() < 0.01 < 0.05 < np.diff(p.equations.mesh).max()
    b = branch(1, 1e6 / load(1))
    p = b.points[-1]
    assert p.lam == pytest.approx(1e6, rel=1e-15)
    assert (p.tip_angle, p.height) == pytest.approx((np.pi, -0.998), abs=1e-13)
    assert p.equations.grid.N < 100
    down = rl.equilibrium(p.equations, p.lam, p.u)  # without the tangent that points up
    back = rl.follow(down, to=3.0)  # and on the way back the mesh is coarsened
    assert back.points[-1].equations.grid.N < p.equations.grid.N / 2
    assert back.points[-1].tip_angle == pytest.approx(rl.elastica(3.0).tip_angle, rel=1e-11)


def test_breaks_are_mesh_points_whatever_the_mesh_does():
    rod = rl.Rod(K="Piecewise((1, s < 1/3), (1000, True))", u_hat=lambda s: np.where(s < 0.71, 0.1, -0.2))
    b = rl.follow(rl.equilibrium(rod, 0.0), to=200.0)
    assert len({p.equations.grid.N for p in b.points}) > 1
    assert all(np.isin([1 / 3, 0.71], p.equations.mesh).all() for p in b.points)


def test_jump_of_a_million_keeps_load_and_tip():
    """PEERS.md, 3: a mesh that adapts and loses the jump has 2.96139 and 1.99482."""
    rod = rl.Rod(K="Piecewise((1, s < 1/2), (1e6, True))")
    b = rl.follow(rl.equilibrium(rod, 0.0), to=6.0)
    assert abs(b.events[0].lam - rl.buckling_loads(rod, 1)[0]) <= b.events[0].error < 1e-5
    assert rl.buckling_loads(rod, 1)[0] == pytest.approx(2.960695, abs=1e-6)
    p = rl.follow(rl.switch(b.events[0])[0], to=6.0).points[-1]
    fine = rl.equilibrium(rl.Rod(K=rod.arguments["K"], mesh=40, degree=12), p.lam, lambda s: p(s).phi)
    assert abs(p.tip_angle - fine.tip_angle) <= p.error + fine.error < 1e-9


@pytest.mark.parametrize("step", [None, 0.1, 1.0, 2.0, 5.0])
def test_imperfect_rod_does_not_jump(step):
    rod = rl.Rod(u_hat=0.01)
    b = rl.follow(rl.equilibrium(rod, 0.0), to=30.0, step=step)
    assert [e.kind for e in b.events] == ["end"]
    assert b.points[-1].tip_angle == pytest.approx(3.10996055648184, abs=1e-12)
    detached = rl.equilibrium(rod, 5.0, lambda s: -2 * np.sin(np.pi * s / 2))
    b = rl.follow(detached, to=0.0, step=step)
    assert [e.kind for e in b.events] == ["fold", "end"]
    assert b.events[0].lam == pytest.approx(FOLD, abs=6e-12)
    assert b.events[0].error < 1e-11
    assert {p.index for p in b.points} == {0, 1}


def test_error_estimates_of_random_problems():
    """Never below the true error; at most 100 times it, or 1e-13 times the condition, in 95 of 100."""
    rng = np.random.default_rng(4)
    fair = total = 0
    for i in range(200):
        rod = _random_rod(rng)
        lam = float(rng.choice([rng.uniform(-500, 0), rng.uniform(0, 30), rng.uniform(0, 3)]))
        amplitude = float(rng.uniform(-2, 2))
        try:
            p = rl.equilibrium(rod, lam, lambda s, a=amplitude: a * np.sin(np.pi * s / 2))
        except rl.NoConvergence:
            continue
        known = p.equations
        finer = np.union1d(np.union1d(known.mesh, (known.mesh[1:] + known.mesh[:-1]) / 2), np.linspace(0, 1, 9))
        fine = rl.equilibrium(known.on(finer, 16), lam, lambda s, p=p: p(s).phi)
        off = abs(p.tip_angle - fine.tip_angle)
        if not np.isfinite(p.error) or off > 0.1:
            continue
        assert off <= p.error + fine.error, (i, rod, lam)
        v = known.hessian(p.u, lam).solve(np.append(np.zeros(p.u.size - 1), 1.0))
        total += 1
        fair += p.error <= 100 * off or p.error <= 1e-13 * (1 + np.abs(v).sum())
    assert total > 150
    assert fair >= 0.95 * total


def _random_rod(rng):
    jump = float(rng.uniform(0.1, 0.9))
    K = [1.0, "1 + s", "exp(2*s)", "1.5 + cos(7*s)", f"Piecewise((1, s < {jump!r}), ({10 ** rng.uniform(-2, 2)!r}, True))"]
    K += [lambda s: np.where(s < jump, 1.0, 3.0 + s)]
    u_hat = [0.01, 0.5, "s - s**2", lambda s: np.cos(9 * s), f"Piecewise((1, s < {jump!r}), (-1, True))"]
    mesh = rng.choice([0, 0, 0, 3, 8, 20])
    return rl.Rod(
        K=K[rng.integers(len(K))], u_hat=u_hat[rng.integers(len(u_hat))], phi0=float(rng.choice([0.0, 0.3])),
        degree=int(rng.integers(2 if mesh else 4, 9)), mesh=int(mesh) or None, tol=float(10 ** rng.uniform(-11, -6)),
    )  # fmt: skip


# --- derivatives and bounds ------------------------------------------------------------------------------------------

MODELS = [
    rl.Rod(mesh=3, degree=4),
    rl.Rod(K="1 + s", u_hat="sin(3*s)", phi0=0.2, mesh=2, degree=5),
    rl.Rod(K="Piecewise((1, s < 1/3), (9, True))", u_hat=0.4, terms=(rl.end_torque(0.3),), mesh=2, degree=3),
]


@given(st.sampled_from(MODELS), st.integers(0, 2**31), st.floats(-50, 50))
def test_gradient_and_hessian_are_derivatives_of_the_energy(rod, seed, lam):
    u = np.random.default_rng(seed).uniform(-3, 3, rod.size)
    by_complex_step = [rod.energy(u + 1e-30j * e, lam).imag / 1e-30 for e in np.eye(rod.size)]
    scale = 1 + np.abs(u).max() * np.abs(rod.hessian(u, lam).toarray()).max()
    assert np.allclose(rod.gradient(u, lam), by_complex_step, atol=1e-13 * scale, rtol=0)
    assert np.allclose(rod.residual_wide(u, lam), by_complex_step, atol=1e-13 * scale, rtol=0)
    differences = [(rod.gradient(u + 1e-6 * e, lam) - rod.gradient(u - 1e-6 * e, lam)) / 2e-6 for e in np.eye(rod.size)]
    assert np.allclose(rod.hessian(u, lam).toarray(), differences, atol=1e-7 * scale)
    assert np.allclose(rod.d_lam(u, lam), rod.gradient(u, lam + 0.5) - rod.gradient(u, lam - 0.5), atol=1e-12 * scale)


@given(st.sampled_from(MODELS[:2]), st.integers(0, 2**31), st.floats(-50, 50), st.floats(1e-3, 1.0))
def test_bounds_for_proofs(rod, seed, lam, reach):
    rng = np.random.default_rng(seed)
    u, du, dlam = rng.uniform(-3, 3, rod.size), rng.uniform(-reach, reach, rod.size), float(rng.uniform(-reach, reach))
    d, c = rod.lipschitz(u, lam)(np.abs(rod.seen(du)), abs(dlam))
    change = rod.hessian(u + du, lam + dlam).toarray() - rod.hessian(u, lam).toarray()
    for _ in range(5):
        x = rng.standard_normal(rod.size)
        assert abs(x @ change @ x) <= form(d, x) * (1 + 1e-9) + 1e-12
    assert np.abs(np.linalg.eigvalsh(change)).max() <= largest(d) * (1 + 1e-9) + 1e-12
    assert (np.abs(rod.d_lam(u + du, lam) - rod.d_lam(u, lam)) <= c * (1 + 1e-9) + 1e-12).all()
    a, b = rod.embedding(lam)
    w, J = rng.standard_normal(rod.size), rod.hessian(u, lam).toarray()
    most = max(np.abs(w).max(), np.abs(rod.seen(w)).max())
    assert most**2 <= (a * (w @ J @ w) + b * (w @ w)) * (1 + 1e-9)


@pytest.mark.parametrize("name", ["u_hat", "K", "phi0", "tau"])
def test_other_parameters_in_the_loads_place(name):
    rod = rl.Rod(K="1 + s", u_hat=0.1, terms=(rl.end_torque(0.2),))
    varied = rl.vary(rod, name, lam=3.0)
    p = rl.equilibrium(varied, varied.value)
    m, v, e = p.equations, varied.value, 1e-5
    differences = (m.residual(p.u, v + e) - m.residual(p.u, v - e)) / (2 * e)
    assert np.allclose(m.d_lam(p.u, v), differences, atol=1e-8)
    b = rl.follow(p, to=v + 0.5)
    direct = rl.equilibrium(varied.at(v + 0.5), 3.0, lambda s: b.points[-1](s).phi)
    assert b.points[-1].tip_angle == pytest.approx(direct.tip_angle, abs=1e-11)
    assert b.points[-1].error < 1e-10


# --- the strut on its way here -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("rule", "order"), [("end", 1), ("trapezoid", 2)])
def test_the_strut_converges_to_the_rod(rule, order):
    """Load, tip angle and fold, with the theoretical order; each stage of Richardson's extrapolation gains one, or two."""
    sizes = (32, 64, 128, 256)
    exact, tip = rl.buckling_loads(rl.Rod(), 1)[0], rl.elastica(5.0).tip_angle
    loads = [rl.buckling_loads(rl.Strut(n=n, rule=rule), 1)[0] for n in sizes]
    tips = [rl.equilibrium(rl.Strut(n=n, rule=rule), 5.0, lambda s: 2.1 * np.sin(np.pi * s / 2)).tip_angle for n in sizes]
    folds = [_fold(rl.Strut(n=n, u_hat=0.01, rule=rule)) for n in sizes]
    for column, limit in ((loads, exact), (tips, tip), (folds, FOLD)):
        errors, power = np.array(column) - limit, order
        for _ in range(2):
            observed = np.log2(np.abs(errors[-2] / errors[-1]))
            assert abs(observed - power) < 0.1
            errors = (2**power * errors[1:] - errors[:-1]) / (2**power - 1)
            power += order
    assert {rl.equilibrium(rl.Strut(n=n, rule=rule), 30.0).index for n in sizes} == {rl.equilibrium(rl.Rod(), 30.0).index}


def _fold(strut):
    p = rl.equilibrium(strut, 5.0, lambda s: -2 * np.sin(np.pi * s / 2))
    return next(e.lam for e in rl.follow(p, to=0.0).events if e.kind == "fold")


# --- loads ---------------------------------------------------------------------------------------------------------


def _mpmath_loads(equation, starts):
    import mpmath as mp

    with mp.workdps(40):
        return [mp.findroot(equation, mp.mpf(float(x))) for x in starts]


def test_loads_of_sturm_and_liouville():
    import mpmath as mp

    b = rl.buckling(rl.Rod(K="(1 + s)**2"), 5)
    w = _mpmath_loads(lambda w: mp.sin(w * mp.log(2)) - 2 * w * mp.cos(w * mp.log(2)), np.sqrt(b.loads - 0.25))
    _agree(b, [x * x + mp.mpf(1) / 4 for x in w])
    b = rl.buckling(rl.Rod(K="1 + s"), 5)  # w = a J0(2 sqrt(lam (1+s))) + b Y0(...)

    def bessel(lam):
        c = 2 * mp.sqrt(lam)
        low, high = c, c * mp.sqrt(2)
        return mp.besselj(0, low) * mp.bessely(1, high) - mp.bessely(0, low) * mp.besselj(1, high)

    _agree(b, _mpmath_loads(bessel, b.loads))
    b = rl.buckling(rl.Rod(K="exp(s)"), 5)  # t = exp(-s/2), w = t (a J1(2 sqrt(lam) t) + b Y1(...)), w' ~ J0

    def exponential(lam):
        c = 2 * mp.sqrt(lam)
        low, high = c, c * mp.exp(mp.mpf(-1) / 2)
        return mp.besselj(1, low) * mp.bessely(0, high) - mp.bessely(1, low) * mp.besselj(0, high)

    _agree(b, _mpmath_loads(exponential, b.loads))


def _agree(b, exact):
    for x, error, true in zip(b.loads, b.error, exact, strict=True):
        assert abs(x - true) <= error
        assert error <= 1e-11 * true


@pytest.mark.parametrize("ratio", [1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6])
def test_loads_across_a_jump(ratio):
    import mpmath as mp

    b = rl.buckling(rl.Rod(K=f"Piecewise((1, s < 1/2), ({ratio!r}, True))"), 5)
    r = mp.mpf(ratio)

    def matched(lam):
        a, c = mp.sqrt(lam) / 2, mp.sqrt(lam / r) / 2
        return mp.cos(a) * mp.cos(c) - mp.sqrt(r) * mp.sin(a) * mp.sin(c)

    _agree(b, _mpmath_loads(matched, b.loads))


def test_a_stiff_short_end_piece_hides_nothing():
    """Springs over eleven decades: a solve with their sums would be wrong by more than the bound."""
    import mpmath as mp

    for a, r in ((0.99997, 1e6), (0.99, 1e6), (0.01, 1e-6)):
        b = rl.buckling(rl.Rod(K=f"Piecewise((1, s < {a}), ({r!r}, True))"), 3)
        place, ratio = mp.mpf(a), mp.mpf(r)

        def matched(lam, place=place, ratio=ratio):
            left, right = mp.sqrt(lam) * place, mp.sqrt(lam / ratio) * (1 - place)
            return mp.cos(left) * mp.cos(right) - mp.sqrt(ratio) * mp.sin(left) * mp.sin(right)

        _agree(b, _mpmath_loads(matched, b.loads))
    jumps = "Piecewise((1000.0, s<0.11756603353271704), (0.001, s<0.5330448875865971), (0.933205, s<0.9999984899757172), (1000.0, True))"
    rod = rl.Rod(K=jumps)
    assert rl.buckling_loads(rod, [2])[0] == pytest.approx(rl.buckling_loads(rod, 3)[1], rel=1e-12)


def test_all_loads_below_a_million():
    b = rl.buckling(rl.Rod(), 318)
    exact = load(np.arange(1, 319))
    assert (np.abs(b.loads - exact) <= b.error).all()
    assert (b.error <= 1e-11 * exact).all()
    assert b.loads[-1] < 1e6 < load(319)


def test_branch_points_on_the_way_to_ten_thousand():
    b = rl.follow(rl.equilibrium(rl.Rod(), 0.0), to=1e4)
    found = np.array([e.lam for e in b.events if e.kind == "branch point"])
    errors = np.array([e.error for e in b.events if e.kind == "branch point"])
    exact = load(np.arange(1, 33))
    assert found.size == 32
    assert (np.abs(found - exact) <= errors).all()
    assert (errors <= 1e-9 * exact).all()


def test_modes_of_a_rod():
    b = rl.buckling(rl.Rod(), 3)
    for j, mode in enumerate(b.modes):
        assert np.abs(mode - (-1.0) ** 0 * np.sin((2 * j + 1) * np.pi / 2 * b.s)).max() < 1e-9


# --- files, faults --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", ["json", "npz"])
def test_a_branch_of_many_meshes_is_kept(tmp_path, suffix):
    b = rl.follow(rl.equilibrium(rl.Rod(u_hat="0.1*s"), 0.0), to=60.0)
    assert len({p.equations.grid.N for p in b.points}) > 1
    again = rl.read(b.save(tmp_path / f"b.{suffix}"))
    assert [p.tip_angle for p in again.points] == [p.tip_angle for p in b.points]
    assert again.at(10.0)[0].tip_angle == pytest.approx(b.at(10.0)[0].tip_angle, abs=1e-13)
    assert again.extended(70.0).completed
    own = rl.Rod(u_hat=lambda s: 0.1 * s)  # no recipe: the model is given, the meshes are in the file
    assert rl.read(tmp_path / f"b.{suffix}", model=own).points[-1].error < 1e-10


def test_bare_steps_promise_nothing():
    start = rl.switch(trivial().events[0])[0]
    points = []
    for p in rl.branch(start, step=1.0, bare=True):
        points.append(p)
        if p.lam > 20:
            break
    assert not any(p.proved or p.checked for p in points)
    assert points[-1].tip_angle == pytest.approx(rl.elastica(points[-1].lam).tip_angle, abs=1e-6)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"K": -1.0}, "K must be positive"), ({"K": [1.0, 2.0]}, "K of a rod must be"), ({"K": "1 - 2*s"}, "K must be positive"),
        ({"u_hat": np.nan}, "u_hat must be"), ({"phi0": "x"}, "phi0 must be"), ({"breaks": (0.0,)}, "breaks must lie"),
        ({"breaks": "x"}, "breaks must be"), ({"degree": 0}, "degree must be"), ({"degree": 99}, "degree must be"),
        ({"mesh": 0}, "mesh must be"), ({"mesh": [0, 0.5]}, "mesh must be"), ({"mesh": [0, 0.5, 0.4, 1]}, "mesh must be"),
        ({"tol": 0.0}, "tol must be"), ({"terms": (3,)}, "terms must be"), ({"ends": ("free", "welded")}, "ends must be"),
        ({"K": lambda s: 1 / (s - 0.5)}, "K must be"), ({"mesh": "x"}, "mesh must be"),
    ],
)  # fmt: skip
def test_what_is_no_rod_is_said_in_one_sentence(arguments, said):
    with pytest.raises(ValueError, match=said) as error:
        rl.Rod(**arguments)
    assert "\n" not in str(error.value)


def test_wrong_guesses_and_states():
    rod = rl.Rod(mesh=4, degree=2)
    for call in (
        lambda: rl.equilibrium(rod, 1.0, [1.0]),
        lambda: rod.gradient(np.zeros(3), 1.0),
        lambda: rod.energy(np.full(8, np.nan), 1.0),
    ):
        with pytest.raises(ValueError, match=r"must have shape|must be finite"):
            call()
    with pytest.raises(ValueError, match="straight"):
        rl.buckling(rl.Rod(u_hat=0.1))
    with pytest.raises(ValueError, match="uniform rod"):
        rl.invariants(rl.equilibrium(rl.Rod(K="1 + s"), 1.0))
    with pytest.raises(ValueError, match="strut or rod"):
        rl.conjugate_points(rl.equilibrium(rl.Strut(n=3, terms=(rl.foundation(1.0),)), 1.0))


def test_a_mesh_too_coarse_does_not_pass_for_one_that_serves():
    p = rl.equilibrium(rl.Rod(mesh=2, degree=2), 1e4)
    assert not p.index_verified
    assert p.error == np.inf or p.error == 0.0
    p = rl.equilibrium(rl.Rod(mesh=2, degree=1), 5.0, lambda s: 2 * s)
    assert p.error > abs(p.tip_angle - rl.elastica(5.0).tip_angle) > 1e-3
    assert companion_of(p.equations, p.u, 5.0).rod.degree == 2


@pytest.mark.parametrize("lam", [-1e8, -1e7, -1e4, 5.0, 300.0, 1e5])
@pytest.mark.parametrize("n", [1, 2, 300, 3000])
def test_conjugate_points_neither_overflow_nor_vanish(n, lam):
    """Found by the study of stability: a field that grows by more than 300 decades left zeros behind it."""
    p = rl.equilibrium(rl.Strut(n=n), lam)
    assert rl.conjugate_points(p).size == p.index


@pytest.mark.parametrize("K", [1.0, "1 + s", "Piecewise((1, s < 0.5), (1e6, True))"])
@pytest.mark.parametrize("lam", [-1e6, -1e4, 5.0, 40.0, 1e3])
def test_conjugate_points_of_a_rod_whose_mesh_does_not_resolve_the_field(K, lam):
    p = rl.equilibrium(rl.Rod(K=K), lam)
    assert rl.conjugate_points(p).size == p.index
    assert p.index_verified


def test_angles_below_the_normal_floats_have_an_error():
    p = rl.equilibrium(rl.Strut(n=1, u_hat=5e-324), 0.5)
    assert 5e-324 <= p.error < 1e-320
    assert rl.equilibrium(rl.Strut(n=10, K=1e-310, u_hat=1.0), 1e-310).error == np.inf
