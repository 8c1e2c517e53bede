"""Koiter's expansion against closed forms, an identity, and branches followed in a hundred digits."""

import time
from functools import cache

import mpmath as mp
import numpy as np
import pytest
import sympy
from sympy import Rational, cos, pi, sin, sqrt, symbols

import rodlab as rl
from rodlab.mechanics.koiter import koiter, rational

eps = symbols("epsilon", real=True)
known = cache(koiter)  # several tests look at the same


def exact_joints(strut):
    """(k, h w) as rationals, from what the strut holds."""
    j = strut.joints
    return [rational(k) for k in j.k], [rational(j.h) * rational(w) for w in j.w]


def numbers(values, digits=40):
    return [mp.mpf(sympy.N(x, digits)) for x in values]


def branch(strut, tip, near):
    """(lam, angles) of the equilibrium with this tip angle: shooting down the links from the tip, V' typed once more by hand."""
    k, hw = (numbers(values, 110) for values in exact_joints(strut))

    def angles(lam):
        phi, m = [tip], mp.mpf(0)
        for ki, hwi in zip(reversed(k), reversed(hw), strict=True):
            m += lam * hwi * mp.sin(phi[-1])
            phi.append(phi[-1] - m / ki)
        return phi[::-1]

    lam = mp.findroot(lambda lam: angles(lam)[0], (near, near * (1 + tip**2)), tol=1e-180)
    return lam, angles(lam)[1:]


def fitted(strut, near, terms=8):
    """Coefficients of lam(eps) in eps^2, from as many points of the branch."""
    tips = [mp.mpf(i) / 10**4 for i in range(1, terms + 1)]
    loads = [branch(strut, tip, near)[0] for tip in tips]
    return list(mp.lu_solve(mp.matrix([[tip ** (2 * m) for m in range(terms)] for tip in tips]), mp.matrix(loads)))


THREE = rl.Strut(n=3)
STRUTS = [
    rl.Strut(n=1, K=0.3),
    rl.Strut(n=2, rule="trapezoid"),
    THREE,
    rl.Strut(n=3, rule="trapezoid"),
    rl.Strut(n=4, K="1 + s"),
    rl.Strut(n=4, K="Piecewise((1, s < 1/2), (20, True))", rule="trapezoid"),
    rl.Strut.from_joints(k=[1, 2, 3], h=0.1, weights=[3, 0.7, 2]),
    rl.Strut(n=5),
]
EVERY_MODE = [pytest.param(strut, mode, id=f"{strut}-{mode}") for strut in STRUTS for mode in range(1, strut.n + 1)]


# --- truths ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("k", "h"), [(1, 1), (0.7, 0.3)])
def test_one_joint(k, h):
    """lam = k eps / (h sin eps) [N 2.7]."""
    found = koiter(rl.Strut.from_joints(k=[k], h=h), order=10)
    truth = rational(k) / rational(h) * (eps / sin(eps)).series(eps, 0, 11).removeO()
    assert sympy.expand(found.load - truth) == 0
    assert found.angles == (eps,)


@pytest.mark.parametrize(("mode", "sign"), [(1, -1), (2, 1)])
def test_two_joints(mode, sign):
    """lam_j = (3 -+ sqrt 5)/2, modes (1, 1.618) and (1.618, -1), lam = lam_j + (1/2 -+ 1/sqrt 5) eps^2 [N 2.7]."""
    found = koiter(rl.Strut.from_joints(k=[1, 1]), mode)
    root = sign * sqrt(5)
    assert sympy.simplify(found.coefficients[0] - (3 + root) / 2) == 0
    assert sympy.simplify(found.coefficients[2] - (Rational(1, 2) + 1 / root)) == 0
    assert sympy.simplify(found.angles[0].coeff(eps, 1) + (1 + root) / 2) == 0
    assert found.angles[1] == eps
    assert list(found.coefficients) == [0, 2, 4]
    assert found.load == sympy.Add(*(c * eps**m for m, c in found.coefficients.items()))


@pytest.mark.parametrize(("rule", "half"), [("end", 7), ("trapezoid", 6)])
@pytest.mark.parametrize("mode", [1, 2, 3])
def test_the_load_of_a_uniform_strut_is_a_square_of_a_sine(rule, half, mode):
    value = koiter(rl.Strut(n=3, rule=rule), mode, order=2).value
    assert sympy.simplify((value - 36 * sin((2 * mode - 1) * pi / (2 * half)) ** 2).rewrite(cos)).equals(0)
    assert value.has(sin) == (rule == "end")  # the others are 18 and 18 -+ 9 sqrt 3


@pytest.mark.parametrize(
    ("n", "value"),
    [(2, 8 - 4 * sqrt(2)), (4, 64 * sin(pi / 16) ** 2), (5, 50 * (1 - cos(pi / 10))), (6, 72 * (1 - cos(pi / 12)))],
)
def test_the_rule_of_second_order_has_the_curvature_of_the_elastica(n, value):
    """lam = lam_1 (1 + eps^2/8 + ...) at every n above 1, as sum w v^4 is 3/4 of sum w v^2 for a sampled sine."""
    found = koiter(rl.Strut(n=n, rule="trapezoid"), order=2)
    assert sympy.expand(found.value - value) == 0
    assert sympy.expand(8 * found.coefficients[2] - value) == 0


def test_the_middle_mode_of_three_joints_is_one_joint():
    """phi_2 = 0, so that the last link is a strut of one joint with half a weight: lam = 18 eps / sin eps."""
    found = koiter(rl.Strut(n=3, rule="trapezoid"), 2)
    assert found.angles == (-eps, 0, eps)
    assert found.load == sympy.expand(18 * (eps / sin(eps)).series(eps, 0, 5).removeO())
    assert "phi_2 = 0 + ..." in str(found)


@pytest.mark.parametrize(("strut", "mode"), EVERY_MODE)
def test_the_first_coefficient_is_a_mean_of_the_mode(strut, mode):
    """lam_2 = lam_j sum w v^4 / (6 sum w v^2), in 30 digits; lam_j is that of `buckling`."""
    found = known(strut, mode)
    with mp.workdps(40):
        v = numbers([phi.coeff(eps, 1) for phi in found.angles])
        w = numbers(exact_joints(strut)[1])
        lam, lam_2 = numbers([found.coefficients[0], found.coefficients[2]])
        means = [mp.fsum(wi * vi**power for wi, vi in zip(w, v, strict=True)) for power in (4, 2)]
        assert mp.almosteq(lam_2, lam * means[0] / (6 * means[1]), rel_eps=mp.mpf(10) ** -30)
    assert float(lam) == pytest.approx(rl.buckling_loads(strut, strut.n)[mode - 1], rel=1e-13)


@pytest.mark.parametrize(("strut", "mode"), [case for case in EVERY_MODE if case.values[0].n <= 4])
def test_coefficients_are_those_of_the_branch(strut, mode):
    found = known(strut, mode)
    with mp.workdps(100):
        own = numbers(found.coefficients.values(), 60)
        for mine, truth in zip(own, fitted(strut, own[0]), strict=False):
            assert abs(mine - truth) <= mp.mpf(10) ** -22 * own[0]


@pytest.mark.parametrize("order", [2, 4, 6])
def test_load_and_angles_have_their_order(order):
    """Against the branch, at eps and eps/2: errors O(eps^(order + 2)) and O(eps^(order + 3))."""
    found = koiter(THREE, order=order)
    errors = []
    with mp.workdps(100):
        for tip in (mp.mpf(1) / 50, mp.mpf(1) / 100):
            lam, angles = branch(THREE, tip, *numbers([found.value], 60))
            at = {eps: sympy.Float(tip, 90)}
            own = numbers([x.subs(at) for x in (found.load, *found.angles)], 60)
            errors.append([abs(own[0] - lam), max(abs(a - b) for a, b in zip(own[1:], angles, strict=True))])
        rates = [float(mp.log(coarse / fine, 2)) for coarse, fine in zip(*errors, strict=True)]
    assert rates == pytest.approx([order + 2, order + 3], abs=0.01)


# --- properties --------------------------------------------------------------------------------------------------


WITH_TERMS = [
    rl.Strut(n=2, terms=(rl.self_weight(0.3),)),
    rl.Strut(n=2, rule="trapezoid", terms=(rl.foundation("1 + s"),)),
    rl.Strut(n=2, terms=(rl.end_torque(0.0),)),
]


@pytest.mark.parametrize("strut", [*STRUTS, *WITH_TERMS], ids=repr)
def test_what_is_left_of_the_gradient_is_of_the_next_order(strut):
    """V' is odd: after eps^5 the first power left is eps^7."""
    for mode in range(1, strut.n + 1):
        assert known(strut, mode).residual_order() == 7


@pytest.mark.parametrize(("order", "left"), [(2, 5), (3, 5), (5, 7), (8, 11)])
def test_orders_odd_and_even(order, left):
    found = koiter(rl.Strut(n=2), 2, order)
    assert found.residual_order() == left
    assert found.load.as_poly(eps).degree() == left - 3
    assert [phi.as_poly(eps).degree() for phi in found.angles] == [left - 2, 1]


@pytest.mark.parametrize("strut", WITH_TERMS, ids=repr)
def test_the_closed_forms_solve_the_numeric_gradient(strut):
    """Another way to the residual: floats, and the kernel of every term."""
    found = known(strut, 1)
    residuals = []
    for tip in (0.2, 0.1):
        phi, lam = ([float(x.subs(eps, tip)) for x in found.angles], float(found.load.subs(eps, tip)))
        residuals.append(np.abs(strut.gradient(phi, lam)).max())
    assert np.log2(residuals[0] / residuals[1]) == pytest.approx(7, abs=0.1)
    assert float(found.value) == pytest.approx(rl.buckling_loads(strut, 1)[0], rel=1e-12)


@pytest.mark.parametrize("K", [0.1, 1 / 3, 7.3e5])
def test_the_stiffness_is_a_unit_of_load(K):
    one, other = known(THREE, 2), koiter(rl.Strut(n=3, K=K), 2)
    for power, coefficient in one.coefficients.items():
        assert sympy.expand(rational(K) * coefficient - other.coefficients[power]) == 0
    assert one.angles == other.angles


def test_modes_that_are_conjugate_share_their_polynomials():
    """lam_1, lam_2, lam_3 are the roots of one cubic: one formula for three branches."""
    first, *others = (known(THREE, mode) for mode in (1, 2, 3))
    assert "epsilon**2*(2*lambda_1**2/63 - 2*lambda_1/7 + 9/14)" in str(first)
    for other in others:
        assert first.minimal.all_coeffs() == other.minimal.all_coeffs()
        shown = str(other).replace(str(other.root), str(first.root))
        assert shown.splitlines()[:-1] == str(first).splitlines()[:-1]
        assert other.coefficients[2] != first.coefficients[2]


def test_a_spring_with_an_even_moment_buckles_to_one_side():
    """V' = eps + 3 g eps^2 - lam sin eps."""
    found = koiter(rl.Strut.from_joints(k=[1], terms=(rl.term(lambda link: link.g * link.b**3, g=0.5),)))
    truth = ((eps + 3 * eps**2 / 2) / sin(eps)).series(eps, 0, 5).removeO()
    assert sympy.expand(found.load - truth) == 0
    assert list(found.coefficients) == [0, 1, 2, 3, 4]
    assert found.residual_order() == 6


def test_functions_of_ones_own_and_their_floats():
    def own(link):
        return 0.1 * sympy.log(1 + link.b**2 / link.g)

    found = koiter(rl.Strut.from_joints(k=[1], terms=(rl.term(own, g=0.2),)))
    moment = sympy.diff(sympy.log(1 + 5 * eps**2) / 10, eps)
    assert sympy.expand(found.load - ((eps + moment) / sin(eps)).series(eps, 0, 5).removeO()) == 0
    linear = rl.term(lambda link: -link.lam * link.h * (sympy.cos(link.b) + link.b**2 / 2))
    nothing = koiter(rl.Strut.from_joints(k=[1], terms=(linear,)))
    assert nothing.coefficients == {0: 1, 2: 0, 4: 0}
    assert nothing.residual_order() == 12


# --- shown, fast, and refused ---------------------------------------------------------------------------------------


def test_it_shows_itself():
    found = known(THREE, 2)
    assert str(found) == repr(found)
    assert [line.split(" = ")[0] for line in str(found).splitlines()] == ["lambda", "phi_1", "phi_2", "phi_3", "lambda_2"]
    assert str(found).endswith("lambda_2 = 36*sin(3*pi/14)**2")
    assert r"\lambda_{2} &= 36 \sin^{2}" in found._repr_latex_()
    assert found._repr_latex_().startswith(r"$\displaystyle \begin{aligned} \lambda &= \lambda_{2} + \epsilon^{2}")
    assert "CRootOf" in str(koiter(rl.Strut(n=3, K="1 + s"), order=2))
    assert "+ -" not in "".join(f"{x}{x._repr_latex_()}" for x in (koiter(rl.Strut.from_joints(k=[1, 1])), found))


@pytest.mark.parametrize(("n", "mode", "seconds"), [(3, 3, 2), (6, 6, 5)])
def test_it_is_fast(n, mode, seconds):
    started = time.process_time()
    koiter(rl.Strut(n=n), mode)
    assert time.process_time() - started < seconds


def test_floats_are_the_rationals_they_are_meant_to_be():
    for p in range(-30, 31):
        for q in range(1, 60):
            assert rational(p / q) == Rational(p, q)
    for x in (0.1, 123.456, 1e300, 2.5e-300, 3 * 1.1, 1 - 0.9, np.float64(1) / 3 * 7):
        assert rational(x) == Rational(f"{x:.14g}") or 3 * rational(x) == 7
    for x in (np.pi, 5e-324, 1.7e308, np.exp(-20)):
        assert float(rational(x)) == pytest.approx(x, rel=5e-16)


def own(energy, n=1, **parameters):
    return rl.Strut.from_joints(k=[1.0] * n, terms=(rl.term(energy, **parameters),))


def apart(link):
    """Takes the second spring away and puts one on the second link alone."""
    return link.c * link.b**2 / 2 - link.g * (link.b - link.a) ** 2 / 2


@pytest.mark.parametrize(
    ("strut", "arguments", "says"),
    [
        (rl.Rod(), {}, r"strut must be a Strut; it is Rod\("),
        (rl.Strut(n=7), {}, r"n must be at most 6 for closed forms; it is 7 \(rl.expansion has the numbers for every n\)"),
        (rl.Strut(n=2), {"mode": 0}, "mode must be a whole number, at least 1; it is 0"),
        (rl.Strut(n=2), {"mode": 3}, "mode must be at most 2, the number of buckling loads; it is 3"),
        (rl.Strut(n=2), {"order": 1}, "order must be a whole number, at least 2; it is 1"),
        (rl.Strut(n=2), {"order": 4.0}, "order must be a whole number, at least 2; it is 4.0"),
        (rl.Strut(n=2, u_hat=0.1), {}, "strut must be straight to buckle: phi0, u_hat and every rest angle zero"),
        (rl.Strut(n=2, phi0=0.1), {}, "strut must be straight"),
        (rl.Strut(n=2, terms=(rl.end_torque(1.0),)), {}, "strut must be straight"),
        (own(lambda link: (1 + link.p) * link.b - link.b, p=1e-17), {}, "strut must be straight"),  # straight in floats alone
        (
            own(lambda link: sympy.pi * link.b**4),
            {},
            "terms must have a Taylor series at phi = 0 with rational coefficients; pi has",
        ),
        (own(lambda link: sympy.cos(sqrt(2) * link.b)), {}, r"Taylor series .* sqrt\(2\) has none"),
        (own(lambda link: sympy.Piecewise((link.b**4, link.b > 0), (0, True))), {}, "terms must have a Taylor series"),
        (own(lambda link: sympy.pi * link.b**2), {}, r"terms must have rational second derivatives at phi = 0; V'' is Matrix"),
        (own(apart, 2, c=[0.0, 1.0], g=[0.0, 1.0]), {}, r"a simple buckling load; lam = 1.00000, that of mode 1, is shared by 2"),
        (own(apart, 2, c=[0.0, 2.0], g=[0.0, 1.0]), {}, "mode must turn the tip, whose angle is eps; the mode at lam = 1.00000"),
        (own(lambda link: -link.lam * link.h * sympy.cos(link.b)), {}, "mode must be at most 0, the number of buckling loads"),
    ],
)
def test_what_has_no_such_expansion_gets_one_sentence(strut, arguments, says):
    with pytest.raises(ValueError, match=says) as caught:
        koiter(strut, **arguments)
    assert "\n" not in str(caught.value)
