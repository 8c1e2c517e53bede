"""Buckling loads: closed forms, high precision, limits and bounds that hold."""

import mpmath as mp
import numpy as np
import pytest

import rodlab as rl
from rodlab.lab.studies.truths import exact_loads
from rodlab.numerics.arrays import EPS


def uniform(n, rule, j):
    """4 n^2 sin^2(...), in 40 digits."""
    with mp.workdps(40):
        n = mp.mpf(n)
        angle = (2 * j - 1) * mp.pi / (2 * (2 * n + 1) if rule == "end" else 4 * n)
        return 4 * n * n * mp.sin(angle) ** 2


def assert_good(buckling, exact, tolerance):
    """Within the tolerance, within its own bound, and the bound not idle."""
    n = buckling.model.n
    for load, error, truth in zip(buckling.loads, buckling.error, exact, strict=True):
        off = float(abs(mp.mpf(float(load)) - truth))
        assert off <= tolerance * float(truth)
        assert off <= error
        assert error <= max(1000 * off, 4 * n * EPS * float(truth) * (1 + 1e-12))


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
@pytest.mark.parametrize(("n", "tolerance"), [(1, 1e-15), (2, 1e-15), (10, 1e-13), (1000, 1e-13), (10**6, 1e-11)])
def test_loads_of_the_straight_uniform_strut(n, rule, tolerance):
    numbers = sorted({1, min(2, n), min(3, n), n})
    assert_good(rl.buckling(rl.Strut(n=n, rule=rule), numbers), [uniform(n, rule, j) for j in numbers], tolerance)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("n", "tolerance"), [(3, 1e-13), (40, 1e-13), (300, 1e-13)])
def test_random_stiffnesses_over_12_decades(n, tolerance, seed):
    k = 10.0 ** np.random.default_rng(seed).uniform(-6, 6, n)
    strut = rl.Strut.from_joints(k=k, h=1.0)
    numbers = sorted({1, 2, 3, n})
    assert_good(rl.buckling(strut, numbers), exact_loads(k, np.ones(n), numbers), tolerance)


def test_a_thousand_random_springs_over_12_decades():
    k = 10.0 ** np.random.default_rng(11).uniform(-6, 6, 1000)
    strut = rl.Strut.from_joints(k=k, h=1e-3)
    assert_good(rl.buckling(strut, [1, 2, 1000]), exact_loads(k, np.full(1000, 1e-3), [1, 2, 1000]), 1e-13)


def test_all_modes_at_once():
    strut = rl.Strut(n=60)
    assert_good(rl.buckling(strut, 60), [uniform(60, "end", j) for j in range(1, 61)], 1e-13)


def test_two_joints():
    b = rl.buckling(rl.Strut.from_joints(k=[1, 1]), 2)
    assert b.loads == pytest.approx([(3 - np.sqrt(5)) / 2, (3 + np.sqrt(5)) / 2], rel=1e-14, abs=0)
    golden = (1 + np.sqrt(5)) / 2
    assert b.modes[0] == pytest.approx([1 / golden, 1])
    assert b.modes[1] == pytest.approx([1, -1 / golden])


@pytest.mark.parametrize("n", [1, 2, 3, 50, 2000])
def test_modes_are_null_vectors(n):
    strut = rl.Strut(n=n, K="exp(s)", rule="trapezoid")
    b = rl.buckling(strut, min(n, 5))
    for load, mode in zip(b.loads, b.modes, strict=True):
        residual = strut.hessian(np.zeros(n), load) @ mode
        assert np.abs(residual).max() <= 1e-12 * strut.joints.k.max()
        assert mode[0] > 0
        assert np.abs(mode).max() == 1


def test_modes_of_the_trapezoid_are_those_of_the_rod():
    n = 400
    s = np.arange(1, n + 1) / n
    modes = rl.buckling(rl.Strut(n=n, rule="trapezoid"), 3).modes
    assert modes == pytest.approx(np.sin(np.outer([1, 3, 5], np.pi * s / 2)), abs=1e-12)


def orders(load, sizes):
    errors = [abs(load(n)) for n in sizes]
    return np.diff(np.log2(errors)) * -1


@pytest.mark.parametrize(("rule", "order"), [("end", 1), ("trapezoid", 2)])
@pytest.mark.parametrize("j", [1, 2, 3])
def test_order_against_euler(rule, order, j):
    limit = ((2 * j - 1) * np.pi / 2) ** 2
    seen = orders(lambda n: rl.buckling_loads(rl.Strut(n=n, rule=rule), [j])[0] - limit, [64 * j, 128 * j, 256 * j])
    assert seen == pytest.approx(order, abs=0.1)


def test_order_for_a_tapered_rod():
    """K = (1+s)^2: lam_1 = w^2 + 1/4 with tan(w ln 2) = 2 w.

    The end rule is of order 2 here, by chance: its two errors of order h, from sampling K at the upper end of a link
    and from the weight of the last, are h/2 (K phi'^2 (0) - 2 lam phi(1)^2) together, and w^2 = 2 w^2 / 2.
    """
    w = float(mp.findroot(lambda w: mp.tan(w * mp.log(2)) - 2 * w, 1.89))
    limit = w * w + 0.25
    assert limit == pytest.approx(3.836377, abs=1e-6)
    for rule in ("end", "trapezoid"):
        seen = orders(lambda n, r=rule: rl.buckling_loads(rl.Strut(n=n, K="(1+s)**2", rule=r), 1)[0] - limit, [128, 256, 512])
        assert seen == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("K", ["exp(s)", "2 - s"])
def test_order_for_other_tapers(K):
    fine = [rl.buckling_loads(rl.Strut(n=n, K=K, rule="trapezoid"), 1)[0] for n in (2000, 4000)]
    limit = fine[1] + (fine[1] - fine[0]) / 3
    for rule, order in (("end", 1), ("trapezoid", 2)):
        seen = orders(lambda n, r=rule: rl.buckling_loads(rl.Strut(n=n, K=K, rule=r), 1)[0] - limit, [64, 128, 256])
        assert seen == pytest.approx(order, abs=0.1)


def test_compliance_keeps_its_order_across_a_jump_and_sampling_does_not():
    """K = 1 below 1/2 and 1000 above: tan(q/2) tan(r/2) = 1/sqrt(1000), q = sqrt(lam), r = q/sqrt(1000)."""
    root = np.sqrt(1000.0)
    limit = float(mp.findroot(lambda q: mp.tan(q / 2) * mp.tan(q / 2 / root) - 1 / root, 1.72) ** 2)
    K = "Piecewise((1, s < 1/2), (1000, True))"
    errors = {rule: abs(rl.buckling_loads(rl.Strut(n=401, K=K, rule=rule), 1)[0] / limit - 1) for rule in ("end", "trapezoid")}
    assert errors["trapezoid"] < 5e-6
    assert errors["end"] > 100 * errors["trapezoid"]
    assert rl.buckling_loads(rl.Strut(n=802, K=K, rule="trapezoid"), 1)[0] == pytest.approx(limit, rel=1e-6)


def test_the_column_under_its_own_weight():
    """q L^3 / EI = 7.8373474389 [Greenhill]: a column of that weight carries no further load, at order 2."""
    seen = orders(
        lambda n: rl.buckling_loads(rl.Strut(n=n, rule="trapezoid", terms=(rl.self_weight(7.8373474389),)), 1)[0],
        [50, 100, 200],
    )
    assert seen == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("terms", [(rl.self_weight(0.0),), (rl.foundation(0.0),)])
def test_terms_of_size_zero_change_no_load(terms):
    plain, with_terms = rl.buckling(rl.Strut(n=30), 3), rl.buckling(rl.Strut(n=30, terms=terms), 3)
    assert with_terms.loads == pytest.approx(plain.loads, rel=1e-12)
    assert (np.abs(with_terms.loads - plain.loads) <= with_terms.error).all()
    assert with_terms.modes == pytest.approx(plain.modes, abs=1e-9)


def test_heavy_columns_against_high_precision():
    """Self-weight: loads bracketed by inertia agree with LAPACK's generalised eigenvalues in their bounds."""
    from scipy.linalg import eigh

    for q in (-20.0, 3.0, 30.0):
        strut = rl.Strut(n=40, K="1 + s", rule="trapezoid", terms=(rl.self_weight(q),))
        H = strut.hessian(np.zeros(40), 0.0).toarray()
        w = eigh(H, np.diag(strut.joints.h * strut.joints.w), eigvals_only=True)[:4]
        b = rl.buckling(strut, 4)
        assert b.loads == pytest.approx(w, abs=1e-9)
        assert (b.error < 1e-9).all()


def pressing(link):
    return -link.lam * link.h * link.b**2


def test_a_term_that_takes_part_in_the_load():
    """V'' = A - lam (h + 2 h) where the load bends each link besides: a third of Euler's loads."""
    plain, b = rl.buckling_loads(rl.Strut(n=10), 3), rl.buckling(rl.Strut(n=10, terms=(rl.term(pressing),)), 3)
    assert b.loads == pytest.approx(plain / 3, rel=1e-12)
    assert (b.error < 1e-11 * b.loads).all()


def test_springs_at_the_ends_of_the_floats():
    """Scaled before bisection squares them; what spans more than 140 decades is refused."""
    for size in (1e-300, 1e-200, 1e200, 1e300):
        assert rl.buckling_loads(rl.Strut.from_joints(k=[size, size]), 2) == pytest.approx(
            [size * (3 - np.sqrt(5)) / 2, size * (3 + np.sqrt(5)) / 2], rel=1e-14
        )
    with pytest.raises(ValueError, match="must not span more than 70 decades"):
        rl.buckling_loads(rl.Strut.from_joints(k=[1e-100, 1e100]), 2)
    mode = rl.buckling(rl.Strut.from_joints(k=[1e60, 1e-60]), 2).modes
    assert np.isfinite(mode).all()


@pytest.mark.parametrize(
    ("arguments", "modes", "says"),
    [
        ({"u_hat": 0.1}, 1, "model must be straight to buckle"),
        ({"phi0": 0.1}, 1, "model must be straight to buckle"),
        ({"terms": (rl.end_torque(0.1),)}, 1, "model must be straight to buckle"),
        ({}, 6, "modes must be at most n = 5, the number of joints; it is 6"),
        ({}, 0, "modes must be a whole number, at least 1; it is 0"),
        ({}, 1.5, "modes must be a whole number"),
        ({}, [], "modes must name at least one mode"),
        ({}, [0], "a mode number must be a whole number, at least 1; it is 0"),
    ],
)
def test_what_cannot_buckle_is_said(arguments, modes, says):
    with pytest.raises(ValueError, match=says):
        rl.buckling(rl.Strut(n=5, **arguments), modes)


def test_only_a_strut_buckles():
    with pytest.raises(ValueError, match="model must be a Strut"):
        rl.buckling("strut")


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
@pytest.mark.parametrize("u_hat", [0.0, 5.0])
def test_uniqueness_is_certified_up_to_the_first_load(rule, u_hat):
    for n in (1, 10, 1000):
        strut = rl.Strut(n=n, u_hat=u_hat, rule=rule)
        first = rl.buckling_loads(rl.Strut(n=n, rule=rule), 1)[0]
        for lam in (0.0, 0.999999 * first, -0.999999 * first):
            assert rl.uniqueness(strut, lam)
        verdict = rl.uniqueness(strut, 1.000001 * first)
        assert not verdict
        assert "need not be convex" in verdict.reason


def test_uniqueness_with_terms():
    assert rl.uniqueness(rl.Strut(n=50, terms=(rl.end_torque(3.0),)), 2.0)
    assert rl.uniqueness(rl.Strut(n=50, terms=(rl.self_weight(7.0),)), 0.0)
    assert not rl.uniqueness(rl.Strut(n=50, terms=(rl.self_weight(8.0),)), 0.0)
    assert "no bound is known for the term foundation" in rl.uniqueness(rl.Strut(n=5, terms=(rl.foundation(1.0),)), 0.0).reason


def test_uniqueness_is_true_where_certified():
    """Below lam_1 Newton's method from anywhere finds the one equilibrium."""
    rng = np.random.default_rng(0)
    strut = rl.Strut(n=6, u_hat=2.0)
    one = rl.equilibrium(strut, 2.0)
    assert rl.uniqueness(strut, 2.0)
    for _ in range(20):
        assert rl.equilibrium(strut, 2.0, rng.uniform(-6, 6, 6)).tip_angle == pytest.approx(one.tip_angle, abs=1e-12)
