"""Newton's method, steepest descent, points and their errors; equations that are no rods."""

import numpy as np
import pytest
from conftest import struts
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

import rodlab as rl
from rodlab.lab.studies.truths import exact_tip


class TwoStruts:
    """A student's class: two uncoupled equal struts, four methods and nothing else."""

    def __init__(self, n, sparse=False):
        self.one, self.n, self.sparse = rl.Strut(n=n), n, sparse

    def residual(self, u, lam):
        return np.concatenate([self.one.gradient(half, lam) for half in np.split(u, 2)])

    def jacobian(self, u, lam):
        H = [self.one.hessian(half, lam).toarray() for half in np.split(u, 2)]
        dense = np.block([[H[0], np.zeros((self.n, self.n))], [np.zeros((self.n, self.n)), H[1]]])
        return csr_array(dense) if self.sparse else dense

    def d_lam(self, u, lam):
        return np.concatenate([self.one.d_lam(half, lam) for half in np.split(u, 2)])

    def inner(self, u, v):
        return u @ v / self.n


class Rotation:
    """Not a gradient: no index."""

    def residual(self, u, lam):
        return np.array([u[0] + u[1] - lam, u[1] - u[0]])

    def jacobian(self, u, lam):
        return np.array([[1.0, 1.0], [-1.0, 1.0]])

    def d_lam(self, u, lam):
        return np.array([-1.0, 0.0])

    def inner(self, u, v):
        return u @ v


@pytest.mark.parametrize("sparse", [False, True])
def test_a_students_class_works_as_it_is(sparse):
    model = TwoStruts(4, sparse)
    assert isinstance(model, rl.Equations)
    s = np.arange(1, 5) / 4
    p = rl.equilibrium(model, 5.0, np.concatenate([2 * s, -2 * s]))
    alone = rl.equilibrium(model.one, 5.0, 2 * s)
    assert p.u == pytest.approx(np.concatenate([alone.u, -alone.u]), abs=1e-12)
    assert (p.index, p.nullity, p.index_verified) == (0, 0, True)
    assert rl.equilibrium(model, 5.0, np.zeros(8)).index == 2
    assert p.error < 1e-12
    with pytest.raises(AttributeError, match="TwoStruts has no measure tip_angle"):
        _ = p.tip_angle
    with pytest.raises(AttributeError, match="TwoStruts has no shape"):
        _ = p.x
    with pytest.raises(ValueError, match="guess must be given: TwoStruts has no state to start from"):
        rl.equilibrium(model, 5.0)


def test_without_symmetry_there_is_no_index():
    p = rl.equilibrium(Rotation(), 2.0, [0.0, 0.0])
    assert p.u == pytest.approx([1, 1])
    assert (p.index, p.nullity, p.index_verified) == (None, None, False)


def test_convergence_is_quadratic():
    """step_{k+1} = C step_k^2: the exponent, from the history alone."""
    strut = rl.Strut(n=50)
    p = rl.equilibrium(strut, 5.0, lambda s: 2 * np.sin(np.pi * s / 2))
    logs = np.log([entry.step for entry in p.newton])[1:4]
    assert (logs[2] - logs[1]) / (logs[1] - logs[0]) == pytest.approx(2, abs=0.25)
    assert all(entry.damping == 1 for entry in p.newton)
    residuals = [entry.residual for entry in p.newton]
    assert residuals[-1] < 1e-8 * residuals[0]


def test_arctan_needs_damping():
    """Newton's method for arctan diverges from 2 and converges damped."""
    run = rl.Newton(np.arctan, lambda u: np.diag(1 / (1 + u**2)), lambda v: float(np.abs(v).max()))
    root = run.solve(np.array([10.0]))
    assert root.u == pytest.approx([0.0], abs=1e-15)
    assert min(entry.damping for entry in root.history) < 1


def test_no_root_is_said_with_the_history():
    run = rl.Newton(lambda u: u**2 + 1, lambda u: np.diag(2 * u), lambda v: float(np.abs(v).max()))
    with pytest.raises(rl.NoConvergence, match="Newton did not converge") as caught:
        run.solve(np.array([3.0]))
    assert len(caught.value.history) > 2
    assert caught.value.history[0].residual == 10


class Parabola:
    """(u - 1)^2 + gap = 0: no root for gap > 0, a double one for gap = 0."""

    def __init__(self, gap):
        self.gap = gap

    def residual(self, u, lam):
        return (u - 1) ** 2 + self.gap

    def jacobian(self, u, lam):
        return np.diag(2 * (u - 1))

    def d_lam(self, u, lam):
        return np.zeros_like(u)

    def inner(self, u, v):
        return u @ v


@pytest.mark.parametrize("gap", [1e-20, 1e-17, 1e-15, 1e-13, 1e-8, 1.0])
def test_just_beyond_a_fold_there_is_no_root(gap):
    """Steps get as small as sqrt(gap) and stop there: that is no convergence, or not a verified index."""
    for guess in (1.5, 2.0, -3.0):
        try:
            p = rl.equilibrium(Parabola(gap), 0.0, [guess])
        except rl.NoConvergence:
            continue
        assert not p.index_verified
        assert p.error == np.inf


@pytest.mark.parametrize("relative", [1e-15, 1e-12, 1e-9])
@pytest.mark.parametrize("terms", [(), (rl.self_weight(0.0),)])
def test_one_joint_just_below_its_fold(terms, relative):
    """beta = 0.1: the fold is at phi - tan(phi) = beta, lam = 1 / cos(phi); below it the root is not there."""
    from scipy.optimize import brentq

    phi = brentq(lambda x: x - np.tan(x) - 0.1, -1.4, -0.1, xtol=1e-15)
    lam = (1 - relative) / np.cos(phi)
    strut = rl.Strut.from_joints(k=[1.0], beta=[0.1], terms=terms)
    for guess in phi + np.linspace(-1e-3, 1e-3, 7):
        try:
            p = rl.equilibrium(strut, lam, [guess])
        except rl.NoConvergence:
            continue
        assert p.tip_angle > 0 or not p.index_verified  # downhill to the other branch, or here and said to be unknown


class WithEnergy(TwoStruts):
    """The same with its energy: then a way downhill exists, for every kind of matrix."""

    @property
    def measures(self):
        return {"energy": lambda u, lam: sum(self.one.energy(half, lam) for half in np.split(u, 2))}


@pytest.mark.parametrize("sparse", [False, True])
def test_downhill_takes_every_kind_of_matrix(sparse):
    model, rng = WithEnergy(3, sparse), np.random.default_rng(0)
    for _ in range(20):
        p = rl.equilibrium(model, 30.0, rng.uniform(-3, 3, 6))
        assert np.abs(model.residual(p.u, 30.0)).max() < 1e-11


def test_the_limit_is_a_number_of_solves():
    with pytest.raises(rl.NoConvergence):
        rl.equilibrium(Parabola(1.0), 0.0, [3.0], limit=5)
    with pytest.raises(ValueError, match="limit must be a whole number, at least 1; it is 0"):
        rl.equilibrium(Parabola(1.0), 0.0, [3.0], limit=0)


def test_a_residual_that_is_not_finite_at_first_is_said():
    run = rl.Newton(np.log, lambda u: np.diag(1 / u), lambda v: float(np.abs(v).max()))
    with pytest.raises(rl.NoConvergence, match="not finite"):
        run.solve(np.array([-1.0]))


def test_steps_out_of_the_domain_are_cut():
    run = rl.Newton(np.log, lambda u: np.diag(1 / u), lambda v: float(np.abs(v).max()))
    assert run.solve(np.array([30.0])).u == pytest.approx([1.0])


@pytest.mark.parametrize("lam", [1.0, 5.0, 30.0, 200.0, -30.0, -1000.0, 1e5])
def test_every_guess_leads_to_an_equilibrium(lam):
    """Where Newton's method fails from far away the way down the energy finds a minimum: no failure in 150."""
    rng = np.random.default_rng(5)
    for n in (1, 2, 7, 60):
        for u_hat in (0.0, 3.0):
            strut = rl.Strut(n=n, u_hat=u_hat)
            for _ in range(4):
                p = rl.equilibrium(strut, lam, rng.uniform(-3, 3, n))
                scale = strut.joints.k.max() * max(1.0, np.abs(p.u).max()) + abs(lam)
                assert np.abs(strut.gradient(p.u, lam)).max() <= 1e-11 * scale


def test_steepest_descent_reaches_the_minimum_and_needs_n_squared_steps():
    """[N 2.7]: from anywhere to a minimum, slowly. Doubling n costs four times the steps; Newton's method does not mind."""
    counts = []
    for n in (4, 8, 16):
        strut = rl.Strut(n=n)
        p, history = rl.steepest_descent(strut, 5.0, 0.1 * strut.joints.s)
        newton = rl.equilibrium(strut, 5.0, p.u)
        assert p.index == 0
        assert abs(p.tip_angle - newton.tip_angle) <= p.error < 1e-6
        assert (np.diff([entry.energy for entry in history]) < 1e-14).all()
        assert len(newton.newton) <= 4
        counts.append(len(history))
    assert np.diff(np.log2(counts)) == pytest.approx(2, abs=0.4)


def test_steepest_descent_leaves_a_saddle():
    """The straight strut above lam_1 is a saddle: Newton's method stays, steepest descent from beside it leaves."""
    strut = rl.Strut(n=4)
    beside = 1e-3 * strut.joints.s
    assert rl.equilibrium(strut, 5.0, beside).index == 1
    p, _ = rl.steepest_descent(strut, 5.0, beside)
    assert p.index == 0
    assert p.tip_angle > 2


def test_steepest_descent_says_what_it_lacks_or_misses():
    with pytest.raises(ValueError, match="TwoStruts has no measure 'energy'"):
        rl.steepest_descent(TwoStruts(3), 1.0, np.ones(6))
    with pytest.raises(rl.NoConvergence, match="has not arrived after 50 steps") as caught:
        rl.steepest_descent(rl.Strut(n=30), 5.0, np.ones(30), limit=50)
    assert len(caught.value.history) == 50


# --- the error of a point -------------------------------------------------------------------------------------------


@settings(max_examples=80)
@given(struts(terms=False), st.floats(-60, 60), st.integers(0, 3))
def test_the_error_of_a_point_holds_and_is_not_idle(strut, lam, bend):
    """Against the exact solution of the same equations in 40 digits."""
    try:
        p = rl.equilibrium(strut, lam, bend * np.sin(np.pi * strut.joints.s / 2))
    except rl.NoConvergence:
        raise AssertionError("a strut of few joints was not solved") from None
    if not p.index_verified:
        return
    off = abs(float(exact_tip(strut, p.u, lam) - p.tip_angle))
    assert off <= p.error
    condition = np.abs(np.linalg.inv(strut.hessian(p.u, lam).toarray())).max() * strut.joints.k.max() + 1
    assert p.error <= 1e-13 * condition * max(1.0, abs(p.tip_angle)) * strut.n


@pytest.mark.parametrize(
    ("k", "lam", "guess"),
    [
        ([1e-6, 1, 1e-6, 1e6, 10], 1.3962032142259697e-07, 1e-6 * np.ones(5)),
        ([1e-6, 1e3, 1e5, 1e2, 1e6], 2.5999999941665365e-07, np.ones(5)),
        ([1e5, 1e-4, 0.1], 4.998749990081875e-05, np.ones(3)),
        ([1e-4, 10, 1e-6], 9.899009493293802e-07, np.ones(3)),
        ([1] * 11, 0.0163795 * (1 - 1e-9), 3 * np.cos(np.arange(11))),
    ],
)
def test_the_error_holds_for_springs_that_sums_do_not_hold(k, lam, guess):
    """Springs over decades and loads a hair below the first: the adjoint is solved in the mixed form."""
    strut = rl.Strut.from_joints(k=k)
    p = rl.equilibrium(strut, lam, guess)
    assert abs(float(exact_tip(strut, p.u, lam, 60) - p.tip_angle)) <= p.error


@settings(max_examples=60)
@given(st.lists(st.floats(-5, 5), min_size=1, max_size=7), st.floats(-9, -3), st.booleans(), st.integers(0, 2))
def test_the_error_holds_near_the_first_load(exponents, distance, above, bend):
    k = 10.0 ** np.array(exponents)
    strut = rl.Strut.from_joints(k=k)
    lam = rl.buckling_loads(strut, 1)[0] * (1 + (10.0**distance if above else -(10.0**distance)))
    try:
        p = rl.equilibrium(strut, lam, bend * np.cos(np.arange(k.size)))
    except rl.NoConvergence:
        return
    if np.isfinite(p.error):
        assert abs(float(exact_tip(strut, p.u, lam, 60) - p.tip_angle)) <= p.error


@pytest.mark.parametrize("beta", [1e-9, 1e-8, -3e-9])
def test_one_joint_at_its_load_with_a_tiny_rest_angle(beta):
    """phi = (6 beta)^(1/3) + ...: the Hessian at the start is exactly zero, and the way downhill ends."""
    p = rl.equilibrium(rl.Strut.from_joints(k=[1.0], beta=[beta]), 1.0)
    assert p.tip_angle == pytest.approx(np.cbrt(6 * beta), rel=1e-4)
    assert p.index == 0


class Cube:
    """(u - 1)^3 = lam, written out: cancellation makes its residual noisy near the triple root."""

    def residual(self, u, lam):
        return u**3 - 3 * u**2 + 3 * u - 1 - lam

    def jacobian(self, u, lam):
        return (3 * u**2 - 6 * u + 3).reshape(1, 1).tolist()

    def d_lam(self, u, lam):
        return -np.ones_like(u)

    def inner(self, u, v):
        return u @ v


def test_the_error_of_a_noisy_class_is_not_idle():
    p = rl.equilibrium(Cube(), 1e-6, [2.0])
    assert abs(p.u[0] - 1.01) <= p.error < 1e-9
    assert p.index_verified
    p = rl.equilibrium(Cube(), 0.0, [2.0])
    assert not p.index_verified
    assert p.error == np.inf


class Shapeless(Cube):
    def residual(self, u, lam):
        return np.zeros(2)


class Negative(Cube):
    def inner(self, u, v):
        return -(u @ v)


@pytest.mark.parametrize(
    ("model", "says"),
    [
        (Shapeless(), r"residual must return the shape of u, \(1,\); it returned \(2,\)"),
        (Negative(), r"inner\(v, v\) must not be negative"),
        (Cube, "is a class, not an object"),
        (5, "lacks residual, jacobian, d_lam, inner"),
    ],
)
def test_what_is_no_model_is_said(model, says):
    with pytest.raises(ValueError, match=says):
        rl.equilibrium(model, 1.0, [2.0])


def test_points_and_failures_travel_between_processes():
    import pickle

    p = rl.equilibrium(rl.Strut(n=3), 5.0, [0.5, 1.0, 1.5])
    p.tip_angle, p.error, p.index  # noqa: B018  what was asked for may be cached
    assert pickle.loads(pickle.dumps(p)).tip_angle == p.tip_angle
    failure = pickle.loads(pickle.dumps(rl.NoConvergence("why", (1,))))
    assert (str(failure), failure.history) == ("why", (1,))


def test_a_point_reaches_its_own_ends():
    for n in (49, 98, 103, 187):
        assert rl.equilibrium(rl.Strut(n=n), 1.0)(1.0).z == pytest.approx(1.0)


@pytest.mark.parametrize("n", [10**3, 10**4])
def test_the_error_of_a_long_strut(n):
    strut = rl.Strut(n=n)
    p = rl.equilibrium(strut, 5.0, lambda s: 2 * np.sin(np.pi * s / 2))
    assert abs(float(exact_tip(strut, p.u, 5.0) - p.tip_angle)) <= p.error <= 1e-13


def test_a_point_answers_when_asked():
    strut = rl.Strut(n=100, rule="trapezoid", phi0=0.1)
    p = rl.equilibrium(strut, 5.0, guess=lambda s: 2 * s)
    assert p.s.shape == p.phi.shape == p.x.shape == p.z.shape == (101,)
    assert (p.phi[0], p.x[0], p.z[0]) == (0.1, 0, 0)
    assert p.phi[-1] == p.tip_angle == p.u[-1]
    assert p.z[-1] == pytest.approx(p.height, abs=1e-14)
    assert p.energy == strut.energy(p.u, 5.0)
    half = p([0.25, 0.255])
    assert half.phi[0] == p.phi[25]
    assert half.x[1] == pytest.approx((p.x[25] + p.x[26]) / 2)
    assert (p.index, p.nullity, p.index_verified) == (0, 0, True)
    assert p.error < 1e-13
    with pytest.raises(ValueError, match="s must lie between 0 and 1"):
        p(1.1)
    assert repr(p).startswith("Point(lam=5, tip_angle=")


def test_guesses_are_angles_or_functions_and_are_not_changed():
    strut = rl.Strut(n=5)
    guess = np.full(5, 0.3)
    rl.equilibrium(strut, 5.0, guess)
    assert (guess == 0.3).all()
    with pytest.raises(ValueError, match=r"guess must have shape \(5,\)"):
        rl.equilibrium(strut, 5.0, [0.0])
    with pytest.raises(ValueError, match="lam must be a finite number; it is nan"):
        rl.equilibrium(strut, np.nan)
    with pytest.raises(ValueError, match="guess must be finite"):
        rl.equilibrium(strut, 5.0, [np.nan] * 5)
