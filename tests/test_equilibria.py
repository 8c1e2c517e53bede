"""All equilibria of a strut: counts against independent searches, certificates against dense eigenvalues, faults."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rodlab as rl
from rodlab.lab.standard_map import orbit, parameter, portrait
from rodlab.mechanics.enumerate import cover
from rodlab.mechanics.krawczyk import krawczyk
from rodlab.numerics.balls import balls


def brute_force(strut, lam, samples=40_001):
    """Equilibria by shooting from the clamp, sampled finely and polished by dense Newton: another unknown, another code.

    u_1 in its compact range; the residual at the free end changes sign, or has an extremum, between samples.
    """
    j = strut.joints
    n, P = j.n, lam * j.h * j.w
    most = (np.abs(P).sum() + 1) / j.k[0]

    def end(first):
        phi, m = j.phi0 + j.beta[0] + first, j.k[0] * first
        slope, dm = np.ones_like(first), np.full_like(first, j.k[0])
        angles = [phi]
        for i in range(n):
            m, dm = m - P[i] * np.sin(phi), dm - P[i] * np.cos(phi) * slope
            if i + 1 < n:
                phi, slope = phi + j.beta[i + 1] + m / j.k[i + 1], slope + dm / j.k[i + 1]
                angles.append(phi)
        return m, dm, np.array(angles)

    x = np.linspace(-most, most, samples)
    value, rate, _ = end(x)
    changes = np.flatnonzero(value[:-1] * value[1:] <= 0)
    turns = np.flatnonzero((rate[:-1] * rate[1:] <= 0) & (value[:-1] * value[1:] > 0))
    starts = [x[changes], x[changes + 1], x[turns], x[turns + 1], (x[turns] + x[turns + 1]) / 2]
    found = []
    for start in end(np.concatenate(starts))[2].T:
        phi = start
        for _ in range(30):
            step = np.linalg.solve(strut.hessian(phi, lam).toarray(), strut.gradient(phi, lam))
            phi = phi - step
            if np.abs(step).max() < 1e-12 or np.abs(step).max() > 100:
                break
        if np.abs(strut.gradient(phi, lam)).max() < 1e-9 * (1 + abs(lam)) and not any(
            np.abs(phi - other).max() < 1e-7 for other in found
        ):
            found.append(phi)
    return np.array(found).reshape(-1, n)


def dense_indices(strut, lam, angles):
    return [int((np.linalg.eigvalsh(strut.hessian(phi, lam).toarray()) < 0).sum()) for phi in angles]


CASES = [
    (1, 30.0),
    (2, 20.0),
    (2, 60.0),
    (3, 50.0),
    (3, 90.0),
    (5, 60.0),
    (5, 100.0),
    (5, 138.0),
    (8, 100.0),
    (8, 150.0),
    (10, 130.0),
]


@pytest.mark.parametrize(("n", "lam"), CASES)
def test_counts_and_indices_equal_an_independent_brute_force(n, lam):
    strut = rl.Strut(n=n)
    found = rl.all_equilibria(strut, lam)
    assert found.certified
    assert found.index_sum == 1
    other = brute_force(strut, lam, 400_001 if n > 5 else 40_001)
    assert len(found) == len(other)
    ours = np.array([p.u for p in found])
    for phi, index in zip(other, dense_indices(strut, lam, other), strict=True):
        i = int(np.abs(ours - phi).max(axis=1).argmin())
        assert np.abs(ours[i] - phi).max() < 1e-7
        assert found.points[i].index == index


@settings(max_examples=25, deadline=None)
@given(
    st.integers(1, 4), st.floats(-60, 60), st.lists(st.floats(0.2, 3.0), min_size=4, max_size=4),
    st.lists(st.floats(-2, 2), min_size=4, max_size=4), st.floats(-3, 3),
)  # fmt: skip
def test_any_joints(n, lam, k, beta, beta0):
    strut = rl.Strut.from_joints(k=np.array(k[:n]) * n, beta=beta[:n], h=1 / n, beta0=beta0)
    found = rl.all_equilibria(strut, lam)
    if not found.certified:
        assert "degenerate" in found.reason
        return
    assert found.index_sum == 1
    assert [p.index for p in found] == dense_indices(strut, lam, [p.u for p in found])
    assert all(np.abs(strut.gradient(p.u, lam)).max() < 1e-11 * (1 + abs(lam)) for p in found)
    assert len(found) >= len(brute_force(strut, lam))


def test_every_point_is_a_point():
    strut = rl.Strut(n=5)
    found = rl.all_equilibria(strut, 60.0)
    assert len(found) == 19
    for p in found:
        again = rl.equilibrium(strut, 60.0, p.u)
        assert np.abs(again.u - p.u).max() <= 1e-13 * (1 + np.abs(p.u).max())
        assert p.index_verified
        assert p.index == again.index
        assert p.error < 1e-12
    energies = [p.energy for p in found]
    assert all(b >= a - 1e-9 for a, b in itertools.pairwise(energies))


def test_the_continuum_count_for_a_long_strut():
    found = rl.all_equilibria(rl.Strut(n=100), 130.0)
    assert found.certified
    assert len(found) == 9
    assert sorted(p.index for p in found) == [0, 0, 1, 1, 2, 2, 3, 3, 4]
    assert all(found.connected)


def test_thousands():
    found = rl.all_equilibria(rl.Strut(n=8), 256.0)
    assert found.certified
    assert len(found) == 4813
    assert found.index_sum == 1
    assert sum(p.index == 0 for p in found) > 300
    assert sum(abs(p.tip_angle) > np.pi for p in found) > 0.9 * len(found)
    assert len(rl.all_equilibria(rl.Strut(n=8), 256.0, certify=False)) == 4813


@pytest.mark.parametrize("name", ["end", "trapezoid"])
def test_the_two_arithmetics_agree(name):
    strut = rl.Strut(n=4, rule=name, K="1+s", u_hat=0.3, terms=(rl.self_weight(2.0), rl.end_torque(0.4)))
    one, two = (rl.all_equilibria(strut, 70.0, engine=engine) for engine in ("flint", "mpmath"))
    assert one.certified
    assert two.certified
    assert "flint" in one.method
    assert "mpmath" in two.method
    assert len(one) == len(two) > 3
    for p, q in zip(one, two, strict=True):
        assert np.abs(p.u - q.u).max() <= 4e-16 * (1 + np.abs(p.u).max())
        assert p.index == q.index


def test_convexity_and_the_enumeration_agree():
    strut = rl.Strut(n=6, u_hat=2.0)
    for lam in (0.0, -2.0, 2.0):
        assert rl.uniqueness(strut, lam)
        found = rl.all_equilibria(strut, lam)
        assert len(found) == 1
        assert found.certified
        assert found.points[0].u == pytest.approx(rl.equilibrium(strut, lam).u, abs=1e-14)


# --- degenerate loads ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("n", "lam"), [(1, 1.0), (10, 100.0)])
def test_a_branch_point_is_not_certified(n, lam):
    found = rl.all_equilibria(rl.Strut(n=n), lam)
    assert not found.certified
    assert "degenerate" in found.reason
    straight = [p for p in found if not p.u.any()]
    assert len(straight) == 1
    assert straight[0].nullity >= 1
    assert found.index_sum is None
    near = rl.all_equilibria(rl.Strut(n=n), lam * (1 + 1e-6))
    assert near.certified
    assert near.index_sum == 1


def test_a_fold_is_not_certified_and_its_sides_are():
    strut = rl.Strut.from_joints(k=[1, 1], beta=[0.1, 0])
    lam = 0.478960114169
    assert [len(rl.all_equilibria(strut, lam + d)) for d in (-1e-6, 1e-6)] == [1, 3]
    at = rl.follow(rl.equilibrium(strut, 2.0, [-1.5, -2.3]), to=0.0).events[0].lam
    found = rl.all_equilibria(strut, at)
    assert not found.certified
    assert len(found) == 2


# --- long struts -------------------------------------------------------------------------------------------------------


def test_samples_and_krawczyk_where_boxes_do_not_suffice():
    strut = rl.Strut(n=60)
    found = rl.all_equilibria(strut, 130.0, most=20)
    assert not found.certified
    assert "boxes did not suffice" in found.reason
    assert "Krawczyk" in found.method
    assert len(found) == 9
    assert all(p.index_verified for p in found)
    assert [p.index for p in found] == [p.index for p in rl.all_equilibria(strut, 130.0)]


def test_krawczyk_says_yes_only_next_to_an_equilibrium():
    strut = rl.Strut(n=300, u_hat=0.2)
    p = rl.equilibrium(strut, 20.0)
    proof = krawczyk(strut, 20.0, p.u)
    assert proof is not None
    assert proof.index == p.index
    assert proof.radius < 1e-12
    assert krawczyk(strut, 20.0, p.u + 0.3) is None
    moved = krawczyk(strut, 20.0, p.u + 1e-5)
    assert moved is not None
    assert 1e-5 <= moved.radius < 1e-3
    assert krawczyk(rl.Strut(n=1), 1.0, np.zeros(1)) is None  # degenerate


def test_too_many_are_refused_in_a_sentence():
    with pytest.raises(rl.NoConvergence, match="too many equilibria"):
        rl.all_equilibria(rl.Strut(n=40), 3000.0, most=50)


# --- the map, the arithmetic, faults --------------------------------------------------------------------------------------


def test_equilibria_are_orbits_of_the_standard_map():
    strut = rl.Strut(n=7)
    r = parameter(strut, 90.0)
    for p in rl.all_equilibria(strut, 90.0):
        phi, turn = orbit(p)
        after = turn - r * np.sin(phi)
        assert np.abs(np.exp(1j * after[:-1]) - np.exp(1j * turn[1:])).max() < 1e-10
        assert abs(np.exp(1j * after[-1]) - 1) < 1e-10
    assert portrait(r, orbits=10, steps=20)[0].shape == (10, 20)
    with pytest.raises(ValueError, match="equal straight joints"):
        parameter(rl.Strut(n=3, K="1+s"), 1.0)


def test_mirror_images():
    found = rl.all_equilibria(rl.Strut(n=5), 60.0)
    for i, p in enumerate(found):
        j = found.images[i]
        assert np.array_equal(found.points[j].u, -p.u)
        assert found.symmetry(i) == ("symmetric" if i == j else "mirror pair")
    bent = rl.all_equilibria(rl.Strut(n=5, u_hat=0.1), 60.0)
    assert set(bent.images) == {None}
    assert bent.symmetry(0) == "none"


def test_parasites_are_those_that_no_branch_leads_to():
    found = rl.all_equilibria(rl.Strut(n=5), 60.0)
    assert sum(found.connected) == 7
    assert {found.standing(i) for i in range(len(found))} == {"connected", "parasite"}
    bent = rl.all_equilibria(rl.Strut(n=50, u_hat=0.01), 10.0)
    assert [bent.standing(i) for i in range(3)].count("detached") == 2


@pytest.mark.parametrize("engine", ["flint", "mpmath"])
def test_enclosures(engine):
    with balls(80, engine) as numbers:
        third = numbers.number(1.0) / numbers.number(3.0)
        assert 0 < numbers.radius(third) < 1e-20
        assert numbers.sign(third * 3 - 1) == 0
        assert numbers.sign(third) == 1
        assert numbers.sign(-third) == -1
        box = numbers.hull(numbers.number(1.0), numbers.number(2.0))
        s, c = numbers.sin_cos(box)
        assert numbers.holds(s, numbers.number(np.sin(1.5)))
        assert numbers.holds(c, numbers.number(np.cos(1.9)))
        assert numbers.holds(box, numbers.middle(box))
        assert not numbers.holds(numbers.middle(box), box)
        assert numbers.floor(box + 0.25) is None
        assert numbers.floor(third + 7) == 7
        assert numbers.has_integer(box)
        assert not numbers.has_integer(third)
        assert numbers.value(numbers.meet(box, numbers.number(2.5, 1.0))) == pytest.approx(1.75)
        assert numbers.sign(numbers.two_pi - 6.283185307179586) == 1


def test_precision_is_given_back():
    import flint
    import mpmath

    before = flint.ctx.prec, mpmath.iv.prec, mpmath.mp.prec
    for engine in ("flint", "mpmath"):
        with pytest.raises(RuntimeError), balls(200, engine):
            raise RuntimeError
    assert (flint.ctx.prec, mpmath.iv.prec, mpmath.mp.prec) == before


def test_what_the_map_does_not_know_is_refused():
    for bad, words in (
        (lambda: rl.all_equilibria(rl.Strut(n=3, terms=(rl.foundation(1.0),)), 1.0), "foundation"),
        (lambda: rl.all_equilibria(rl.Rod(), 1.0), "strut must be a Strut"),
        (lambda: rl.all_equilibria(rl.Strut(n=3), float("nan")), "lam must"),
        (lambda: rl.all_equilibria(rl.Strut(n=3), 1.0, engine="arb"), "engine must"),
        (lambda: rl.all_equilibria(rl.Strut(n=3), 1.0, most=0), "most must"),
    ):
        with pytest.raises(ValueError, match=words):
            bad()


def test_the_cost_of_a_cover_follows_the_equilibria():
    """Boxes a root: bounded while the roots grow by a factor of fifty."""
    per_root = [cover(rl.Strut(n=8), lam, most=10**6) for lam in (150.0, 200.0, 256.0)]
    assert [len(c.roots) for c in per_root] == sorted(len(c.roots) for c in per_root)
    assert all(c.boxes < 6 * len(c.roots) + 400 for c in per_root)


# --- what two adversaries found --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("strut", "lam", "count"),
    [
        (rl.Strut(n=50, phi0=3.0), 0.1, 1),
        (rl.Strut(n=10, u_hat=30.0), 0.1, 1),
        (rl.Strut(n=10, terms=(rl.end_torque(10.0),)), 0.1, 1),
        (rl.Strut(n=10, u_hat=1e4), 0.0, 1),
        (rl.Strut(n=3, u_hat=1e6), 20.0, 7),
        (rl.Strut(n=2, phi0=-3.0123456789), 1e-30, 1),
        (rl.Strut(n=2, phi0=-3.0123456789), 0.0, 1),
        (rl.Strut(n=1), 1e4, 6367),
    ],
)
def test_large_angles_and_the_seam_are_certified(strut, lam, count):
    found = rl.all_equilibria(strut, lam)
    assert found.certified, found.reason
    assert len(found) == count


def test_angles_that_floats_cannot_hold_are_not_certified():
    assert rl.all_equilibria(rl.Strut(n=3, phi0=100.0), 20.0).certified
    found = rl.all_equilibria(rl.Strut(n=3, phi0=1e12), 20.0)
    assert not found.certified
    assert "floats hold angles" in found.reason
    assert max(p.remaining for p in found) > 1e-5


@pytest.mark.parametrize(("n", "lam"), [(1, 1e7), (2, 1e5), (3, 1e3), (10, 1e300), (100, -1e300), (50, 5000.0)])
def test_too_many_is_said_at_once(n, lam):
    with pytest.raises(ArithmeticError, match="told apart"):
        rl.all_equilibria(rl.Strut(n=n), lam)


def test_boxes_are_not_overrun():
    strut = rl.Strut(n=10)
    near = float(rl.buckling_loads(strut, 1)[0])
    assert "boxes did not suffice" in rl.all_equilibria(strut, near * 1.5, most=2).reason


def test_threads_do_not_disturb_each_other():
    from concurrent.futures import ThreadPoolExecutor

    cases = [(10, 100.5), (3, 20.0), (30, 200.0), (8, 130.0)] * 3
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda case: rl.all_equilibria(rl.Strut(n=case[0]), case[1]), cases))
    assert all(one.certified for one in found)
