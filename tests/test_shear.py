"""The rod that shears and stretches: what SymPy derives, the loads in closed form, and the index of V itself for all ends."""

import itertools
from functools import cache
from math import inf, pi

import mpmath as mp
import numpy as np
import pytest
import scipy.linalg
import scipy.optimize
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.polynomial import legendre
from sympy import Derivative, Eq, Function, Rational, Symbol, cos, diff, sin
from sympy.calculus.euler import euler_equations

from rodlab.mechanics.limit import limit
from rodlab.mechanics.shear import StraightLoad, shear_loads, shearable_principle
from rodlab.mechanics.terms import BENDING_WITH_REST, END_LOAD

p, phi, v1, v3, lam, N1, K, u_hat, A1, A3 = sympy.symbols("p phi v1 v3 lam N1 K u_hat A1 A3", real=True)
s, load, delta = Symbol("s", real=True), Symbol("lambda", real=True), Symbol("delta", real=True)
along = {x: Function(x.name)(s) for x in (phi, v1, v3, K, u_hat, A1, A3)}
rod = shearable_principle()


def same(left, right):
    return sympy.simplify((left - right).doit()) == 0


# --- what is derived ------------------------------------------------------------------------------------------------------


def test_principle_is_the_exercise_of_the_notes():
    x_rate, z_rate = v1 * cos(phi) + v3 * sin(phi), v3 * cos(phi) - v1 * sin(phi)
    by_hand = K * (p - u_hat) ** 2 / 2 + A1 * v1**2 / 2 + A3 * (v3 - 1) ** 2 / 2 + lam * z_rate - N1 * x_rate
    assert same(rod.density, by_hand)
    assert same(rod.principle, by_hand.subs({p: Derivative(along[phi], s), lam: load, **along}, simultaneous=True))


def test_strains_are_the_forces_over_their_stiffnesses():
    n1, n3 = lam * sin(phi) + N1 * cos(phi), N1 * sin(phi) - lam * cos(phi)
    assert same(rod.strains[v1], n1 / A1)
    assert same(rod.strains[v3], 1 + n3 / A3)
    assert [same(force, n) for force, n in zip(rod.forces.values(), (n1, n3), strict=True)] == [True, True]
    assert sympy.hessian(rod.density, (v1, v3)) == sympy.diag(A1, A3)  # strictly convex: the strains are a minimum


def test_reduced_density_is_the_principle_with_the_strains_put_in():
    n1, n3 = rod.forces.values()
    assert same(rod.reduced, rod.density.subs(rod.strains))
    assert same(rod.reduced, K * (p - u_hat) ** 2 / 2 + lam * cos(phi) - N1 * sin(phi) - (n1**2 / A1 + n3**2 / A3) / 2)
    rigid = limit((BENDING_WITH_REST, END_LOAD))
    assert same(rod.reduced.subs({N1: 0, A1: sympy.oo, A3: sympy.oo}), rigid.density.subs(rigid.p, p))


def test_the_tip_is_where_the_energy_says():
    """W_lam = z' and W_N1 = -x', as for the whole principle."""
    for force in (lam, N1):
        assert same(rod.reduced.diff(force), rod.density.diff(force).subs(rod.strains))


def test_euler_and_lagrange_before_and_after_eliminating_the_strains():
    angle, shear, stretch = (along[x] for x in (phi, v1, v3))
    whole, *_ = euler_equations(rod.principle, [angle, shear, stretch], s)
    strains = {along[x]: value.subs({lam: load, **along}, simultaneous=True) for x, value in rod.strains.items()}
    assert same(rod.euler_lagrange.lhs, -whole.lhs.subs(strains))
    assert same(rod.natural.lhs, (along[K] * (angle.diff(s) - along[u_hat])).subs(s, 1))


def test_forces_and_moments_balance_as_in_the_notes():
    n1, n3 = Function("n1")(s), Function("n3")(s)
    angle, shear, stretch = (along[x] for x in (phi, v1, v3))
    moment = along[K] * (angle.diff(s) - along[u_hat])
    for found, left, right in zip(
        rod.balance, (n1, n3, moment), (-n3 * angle.diff(s), n1 * angle.diff(s), n3 * shear - n1 * stretch), strict=True
    ):
        assert same(found.lhs, diff(left, s))
        assert same(found.rhs, right)
    known = dict(zip((n1, n3), (e.subs({lam: load, **along}) for e in rod.forces.values()), strict=True))
    assert all(same(e.lhs.subs(known), e.rhs.subs(known)) for e in rod.balance[:2])  # so N1 and lam are constants


def test_linearised_at_the_straight_rod():
    w, x = Function("w")(s), Function("x")(s)
    assert same(rod.linearised.lhs, K * w.diff(s, 2) + load * (1 - delta * load) * w)
    moments, place = rod.held
    assert same(moments.lhs, K * w.diff(s, 2) + (load * w + N1) * (1 - delta * load))
    assert same(place.lhs - place.rhs, x.diff(s) - (1 - delta * load) * w - N1 / A1)
    small = -rod.reduced.diff(phi, 2).subs({phi: 0, N1: 0})
    assert same(small, (lam * (1 - delta * lam)).subs(delta, 1 / A3 - 1 / A1))


def test_the_size_of_the_force_is_constant():
    """It is that of its parts in the fixed frame."""
    n1, n3 = rod.forces.values()
    assert same(n1**2 + n3**2, lam**2 + N1**2)


def test_it_shows_itself():
    assert [name for name, _ in rod.rows if name] == [
        "V", "v1", "v3", "W", "Euler-Lagrange", "free end", "forces", "moments", "straight", "tip held",
    ]  # fmt: skip
    assert str(rod) == repr(rod)
    assert "Euler-Lagrange" in str(rod)
    assert rod._repr_latex_().startswith(r"$\displaystyle \begin{aligned}")
    assert r"\delta \lambda" in rod._repr_latex_()
    assert all(isinstance(value, (sympy.Expr, Eq)) for _, value in rod.rows)
    assert shearable_principle() is rod


# --- loads in closed form -------------------------------------------------------------------------------------------------


def exact(A1, A3, P_E):
    """Both roots in 60 digits, with 1/A3 - 1/A1 exact; none where they do not exist."""
    with mp.workdps(400):
        d, P_E = 1 / mp.mpf(A3) - 1 / mp.mpf(A1), mp.mpf(P_E)
        if d == 0:
            return d, [P_E]
        left = 1 - 4 * d * P_E
        return d, [] if left <= 0 else sorted([2 * P_E / (1 + mp.sqrt(left)), (1 + mp.sqrt(left)) / (2 * d)])


def close(found, value, rel=1e-14):
    return abs(mp.mpf(found) - value) <= rel * abs(value)


def test_extension_alone():
    """A1 infinite, A3 = 50: (1 -+ sqrt(1 - 0.02 pi^2)) / 0.04 for the first mode, no load for the second."""
    first, second = shear_loads(inf, 50)
    with mp.workdps(40):
        root = mp.sqrt(1 - mp.pi**2 / 50)
        assert close(first.load, 25 * (1 - root))
        assert close(second.load, 25 * (1 + root))
    assert (first.load, second.load) == (pytest.approx(2.602903201834774, rel=1e-14), pytest.approx(47.39709679816523, rel=1e-14))
    assert [(x.admissible, x.meaning) for x in (first, second)] == [(True, "buckles"), (True, "straight again")]
    assert shear_loads(inf, 50, modes=2) == [first, second]


@pytest.mark.parametrize("A", [1.0, 3, 1e5, inf])
def test_equal_stiffnesses_have_eulers_loads(A):
    found = shear_loads(A, A, K=2.0, modes=3)
    assert [x.load for x in found] == [2.0 * ((2 * j - 1) * pi / 2) ** 2 for j in (1, 2, 3)]
    assert [x.admissible for x in found] == [x.load < A for x in found]
    assert {x.meaning for x in found} == {"buckles"}


def test_a_soft_rod_shortens_and_never_buckles():
    assert shear_loads(inf, pi**2 * (1 - 1e-12)) == []
    assert len(shear_loads(inf, pi**2 * (1 + 1e-12))) == 2
    assert shear_loads(inf, 1.0, [0.25]) == []  # a double root: nothing changes sign


def test_shear_alone():
    """Haringx's column, P (1 + P / A1) = P_E: below Euler's load, and buckling in tension beyond -A1."""
    assert shear_loads(2.0, inf, [4.0]) == [StraightLoad(-4.0, True, "buckles in tension"), StraightLoad(2.0, True, "buckles")]
    assert shear_loads(2.0, inf, [0.0]) == [StraightLoad(-2.0, True, "buckles in tension")]
    assert shear_loads(2.0, 2.0, [0.0]) == []
    assert shear_loads(inf, 2.0, [0.0]) == [StraightLoad(2.0, False, "straight again")]


def test_where_the_rod_is_stiff_nothing_is_lost():
    first, second = shear_loads(inf, 1e30)
    assert first.load == pytest.approx(pi**2 / 4, rel=1e-15)
    assert second == (pytest.approx(1e30, rel=1e-15), True, "straight again")  # v3 = 2.5e-30 there
    assert [x.admissible for x in shear_loads(1e-9, inf, [1e30])] == [True, True]
    near = shear_loads(1.0, 1.0 + 2**-40, [1.0])
    assert close(near[0].load, exact(1.0, 1.0 + 2**-40, 1.0)[1][0])


stiffness = st.one_of(st.floats(-6, 6).map(lambda x: 10.0**x), st.just(inf))
loads = st.floats(-6, 6).map(lambda x: 10.0**x)


@given(stiffness, stiffness, loads)
def test_loads_solve_their_equation(A1, A3, P_E):
    d, roots = exact(A1, A3, P_E)
    with mp.workdps(400):
        left = abs(1 - 4 * d * mp.mpf(P_E))
        assume(left > 1e-12)
        found = shear_loads(A1, A3, [P_E])
        assert len(found) == len(roots)
        for one, root in zip(found, roots, strict=True):
            P = mp.mpf(one.load)
            assert close(P, root, 1e-14 / min(1, mp.sqrt(left)))  # at a double root the loads are as sensitive as this
            assert abs(P * (1 - d * P) - P_E) <= 1e-14 * (P_E + abs(P * (1 - 2 * d * P)))  # up to the rounding of P
            assert one.admissible == (1 - root / mp.mpf(A3) > 0)
        assert [x.meaning for x in found] == (
            ["buckles"] if d == 0 else ["buckles", "straight again"] if d > 0 else ["buckles in tension", "buckles"]
        )[: len(found)]


@given(stiffness, stiffness, loads, st.floats(1e-6, 0.1))
def test_second_variation_changes_sign_as_said(A1, A3, P_E, step):
    """K q^2 - P (1 - delta P), the second variation of a mode, just inside and just outside of each load."""
    d, _ = exact(A1, A3, P_E)
    with mp.workdps(400):
        found = shear_loads(A1, A3, [P_E])
        loads = [mp.mpf(x.load) for x in found]
        assume(len(loads) < 2 or abs(loads[1] - loads[0]) > 2 * step * max(map(abs, loads)))
        for P, one in zip(loads, found, strict=True):
            before, after = (P_E - x * (1 - d * x) for x in (P * (1 - step), P * (1 + step)))
            assert (before > 0) == (one.meaning != "straight again")
            assert (after > 0) == (one.meaning == "straight again")


@given(stiffness, stiffness, st.lists(loads, max_size=4))
def test_loads_ascend(A1, A3, euler):
    found = shear_loads(A1, A3, euler)
    assert found == sorted(found)
    assert sorted(found) == sorted(itertools.chain(*(shear_loads(A1, A3, [P_E]) for P_E in euler)))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"A1": 0}, "A1 must be a finite number above 0; it is 0"), ({"A3": -1.0}, "A3 must be a finite number above 0; it is -1.0"),
        ({"A1": 1e200}, "A1 must lie between 1e-150 and 1e\\+150, or be math.inf; it is 1e\\+200"),
        ({"A3": float("nan")}, "A3 must be"), ({"A1": -inf}, "A1 must be"), ({"A3": "1"}, "A3 must be"), ({"A1": [inf]}, "A1 must be"),
        ({"K": 0.0}, "K must be a finite number above 0"), ({"modes": 0}, "modes must be a whole number, at least 1; it is 0"),
        ({"euler": [1.0, -2.0]}, "euler must lie between 0 and 1e\\+150; entry 1 is -2.0"), ({"euler": 3.0}, "euler must have one dim"),
        ({"euler": [inf]}, "euler must be finite"), ({"K": 1e160}, "euler must lie between"),
    ],
)  # fmt: skip
def test_what_is_no_rod_is_refused(given, said):
    with pytest.raises(ValueError, match=said):
        shear_loads(**({"A1": 1.0, "A3": 2.0} | given))


# --- the index of V itself, for all ends ----------------------------------------------------------------------------------

DEGREE = 24
GAUSS, WEIGHTS = legendre.leggauss(DEGREE + 4)
W = legendre.legvander(GAUSS, DEGREE)
SLOPE = 2 * np.column_stack([legendre.legval(GAUSS, legendre.legder(e)) for e in np.eye(DEGREE + 1)])
FOOT, TIP = legendre.legvander(np.array([-1.0, 1.0]), DEGREE)
ENDS = {  # is phi = 0 at the foot, at the tip, and is x = 0 at the tip
    "clamped-free": (True, False, False),
    "hinged-guided": (False, True, False),
    "clamped-guided": (True, True, False),
    "hinged-hinged": (False, False, True),
    "clamped-clamped": (True, True, True),
    "clamped-hinged": (True, False, True),
}


@cache
def free_directions(ends, stretch):
    """Basis of the (phi, v1) that the ends admit; x' = v1 + v3 phi, and v3 adds a positive square of its own."""
    nothing, mean = np.zeros(DEGREE + 1), WEIGHTS @ W / 2
    rows = [np.r_[FOOT, nothing], np.r_[TIP, nothing], np.r_[stretch * mean, mean]]
    chosen = [row for row, kept in zip(rows, ENDS[ends], strict=True) if kept]
    return scipy.linalg.null_space(np.array(chosen))


def index(ends, A1, A3, P):
    """Negative eigenvalues of the second variation of V in phi and v1, K = 1: half of phi'^2 + A1 v1^2 - P (v3 phi^2 + 2 v1 phi)."""
    stretch, half = 1 - P / A3, WEIGHTS[:, None] / 2
    squares, slopes = W.T @ (half * W), SLOPE.T @ (half * SLOPE)
    whole = np.block([[slopes - P * stretch * squares, -P * squares], [-P * squares, A1 * squares]])
    Z = free_directions(ends, stretch)
    return int((scipy.linalg.eigvalsh(Z.T @ whole @ Z) < 0).sum())


EULER = {
    "clamped-free": [((2 * j - 1) * pi / 2) ** 2 for j in range(1, 5)],
    "hinged-guided": [((2 * j - 1) * pi / 2) ** 2 for j in range(1, 5)],
    "clamped-guided": [(j * pi) ** 2 for j in range(1, 5)],
    "hinged-hinged": [(j * pi) ** 2 for j in range(5)],
}


@pytest.mark.parametrize("ends", EULER)
@pytest.mark.parametrize(("A1", "A3"), [(30.0, 1e3), (5.0, 1e6), (200.0, 30.0), (1e6, 60.0), (80.0, 80.0), (15.0, 14.0)])
def test_index_of_the_principle_is_the_count_of_loads(ends, A1, A3):
    """Where N1 = 0 the loads count the negative squares of V, in compression as far as v3 > 0, and in tension."""
    known = shear_loads(A1, A3, EULER[ends])
    least = max((x.load for x in shear_loads(A1, A3, [EULER[ends][-1]])[:1] if x.load < 0), default=-100.0)
    most = min([x.load for x in shear_loads(A1, A3, [EULER[ends][-1]]) if x.meaning == "buckles"] + [A3])
    for P in np.linspace(least, most, 98)[1:-1]:
        passed = [x for x in known if min(P, 0) < x.load < max(P, 0)]
        count = sum(-1 if x.meaning == "straight again" else 1 for x in passed)
        assert index(ends, A1, A3, P) == count, P


def critical(ends, A1, A3, between):
    """The load in between at which the index changes, by bisection."""
    low, high = between
    first = index(ends, A1, A3, low)
    assert index(ends, A1, A3, high) != first
    while abs(high - low) > 1e-11 * abs(high):
        middle = (low + high) / 2
        low, high = (middle, high) if index(ends, A1, A3, middle) == first else (low, middle)
    return (low + high) / 2


def coupled(A1, A3, part):
    """f(P) = sin(a) / a (1 - delta P) - v3 cos(a), a = part q: no force-free mode."""
    d = 1 / A3 - 1 / A1

    def f(P):
        a = part * np.sqrt(P * (1 - d * P))
        return np.sin(a) / a * (1 - d * P) - (1 - P / A3) * np.cos(a)

    return f


def test_clamped_clamped_has_eulers_form_for_every_other_mode():
    A1, A3 = 60.0, 1e3
    first, third = (x.load for x in shear_loads(A1, A3, [4 * pi**2, 16 * pi**2]) if x.load > 0)
    assert critical("clamped-clamped", A1, A3, (first - 2, first + 2)) == pytest.approx(first, rel=1e-9)
    second = scipy.optimize.brentq(coupled(A1, A3, 0.5), first + 0.1, third - 0.1)
    assert first < critical("clamped-clamped", A1, A3, (first + 0.1, third - 0.1)) == pytest.approx(second, rel=1e-9)
    plain = next(x.load for x in shear_loads(A1, A3, [80.76291]) if x.load > 0)
    assert second < 0.95 * plain  # tan(q/2) = q/2 no longer holds


def test_clamped_clamped_in_tension_first_moves_out_of_line():
    """The first load in tension is one whose N1 is not zero, nearer than that of P_E = 4 pi^2."""
    A1, A3 = 10.0, 1e6
    of_euler = shear_loads(A1, A3, [4 * pi**2])[0].load
    found = critical("clamped-clamped", A1, A3, (-A1, of_euler + 0.5))
    assert of_euler + 0.5 < found < -A1
    assert coupled(A1, A3, 0.5)(found) == pytest.approx(0, abs=1e-8)


@pytest.mark.parametrize(("A1", "A3"), [(60.0, 1e3), (1e3, 100.0)])
def test_clamped_hinged_never_has_eulers_form(A1, A3):
    plain = next(x.load for x in shear_loads(A1, A3, [20.190728556426629]) if x.load > 0)
    lowest = next(x.load for x in shear_loads(A1, A3, [pi**2]) if x.load > 0)
    found = critical("clamped-hinged", A1, A3, (lowest, plain))
    assert found == pytest.approx(scipy.optimize.brentq(coupled(A1, A3, 1.0), lowest, plain), rel=1e-9)
    assert found < plain * (1 - 1e-3)


@pytest.mark.parametrize(("ends", "euler"), [("clamped-hinged", 20.190728556426629), ("clamped-clamped", 80.762911429)])
def test_without_shear_every_rod_has_its_own_euler_loads(ends, euler):
    A1, A3 = 1e9, 500.0
    P = shear_loads(inf, A3, [euler])[0].load
    assert critical(ends, A1, A3, (0.9 * P, 1.1 * P)) == pytest.approx(P, rel=1e-6)


def test_all_sections_of_a_hinged_rod_turn_at_once():
    """At P = 1/delta < 0 the index rises though no section bends: q = 0."""
    A1, A3 = 12.0, 300.0
    (load,) = shear_loads(A1, A3, [0.0])
    assert load.load == pytest.approx(-float(1 / (Rational(1, 12) - Rational(1, 300))), rel=1e-15)
    assert critical("hinged-hinged", A1, A3, (0.9 * load.load, 1.1 * load.load)) == pytest.approx(load.load, rel=1e-9)
