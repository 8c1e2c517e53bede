"""The strut against itself, derivative by derivative, and against SymPy."""

from pathlib import Path

import numpy as np
import pytest
import sympy
from conftest import states, struts
from hypothesis import given, settings

import rodlab as rl
from rodlab.mechanics import derive, ship, standard
from rodlab.mechanics.terms import BENDING, BENDING_WITH_REST, END_LOAD
from rodlab.numerics.anchored import Anchored
from rodlab.numerics.difference import DifferenceForm
from rodlab.numerics.full import Full

STEP = 1e-30


@given(states())
def test_gradient_is_the_derivative_of_the_energy(state):
    strut, phi, lam = state
    by_complex_step = [strut.energy(phi + 1j * STEP * row, lam).imag / STEP for row in np.eye(strut.n)]
    assert strut.gradient(phi, lam) == pytest.approx(np.array(by_complex_step), rel=1e-12, abs=1e-11)


@given(states())
def test_hessian_is_the_derivative_of_the_gradient_and_symmetric(state):
    strut, phi, lam = state
    H = strut.hessian(phi, lam)
    by_complex_step = np.array([strut.gradient(phi + 1j * STEP * row, lam).imag / STEP for row in np.eye(strut.n)])
    dense = H.toarray()
    assert dense == pytest.approx(by_complex_step, rel=1e-12, abs=1e-11)
    assert dense == pytest.approx(dense.T, abs=1e-12)
    assert H.diagonal == pytest.approx(np.diagonal(dense))
    assert H.off_diagonal == pytest.approx(np.diagonal(dense, 1))
    assert H @ phi == pytest.approx(dense @ phi, abs=1e-9)


@given(states())
def test_index_is_that_of_the_dense_eigenvalues(state):
    strut, phi, lam = state
    H = strut.hessian(phi, lam)
    w = np.linalg.eigvalsh(H.toarray())
    away = 1e-10 * np.abs(w).max()
    assert (w < -away).sum() <= H.index + H.nullity
    assert H.index <= (w < away).sum()
    if (np.abs(w) > away).all():
        assert (H.index, H.nullity) == ((w < 0).sum(), 0)


@given(states())
def test_d_lam_is_the_derivative_in_the_load(state):
    strut, phi, lam = state
    change = strut.gradient(phi, lam + 1.0) - strut.gradient(phi, lam)  # the gradient is linear in lam
    assert strut.d_lam(phi, lam) == pytest.approx(change, abs=1e-10)


@given(states())
def test_height_is_the_top_of_the_shape_and_the_derivative_of_the_energy(state):
    strut, phi, lam = state
    x, z = strut.shape(phi)
    assert x.shape == z.shape == (strut.n + 1,)
    assert z[-1] == pytest.approx(strut.height(phi), abs=1e-14)
    assert strut.energy(phi, lam + 1) - strut.energy(phi, lam) == pytest.approx(strut.height(phi), abs=1e-10)


@given(struts(terms=False))
def test_the_unstressed_shape_is_in_equilibrium_without_load_and_stable(strut):
    phi = strut.unstressed()
    assert np.abs(strut.gradient(phi, 0.0)).max() <= 1e-13 * strut.joints.k.max()
    assert strut.energy(phi, 0.0) == pytest.approx(0.0, abs=1e-24 * strut.joints.k.sum())
    assert strut.hessian(phi, 0.0).index == 0


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
def test_a_straight_strut_has_height_one(rule):
    for n in (1, 2, 17):
        assert rl.Strut(n=n, rule=rule).height(np.zeros(n)) == pytest.approx(1.0, rel=1e-15)


def test_the_rules_are_those_of_the_notes():
    end = rl.Strut(n=4, K="1 + s", u_hat="s").joints
    assert end.k == pytest.approx(4 * (1 + np.arange(1, 5) / 4))
    assert end.beta == pytest.approx(np.arange(1, 5) / 16)
    assert end.weights is None
    exact = rl.Strut(n=4, K="1 + s", u_hat="s", rule="trapezoid").joints
    edges = np.arange(5) / 4
    assert 1 / exact.k == pytest.approx(np.diff(np.log1p(edges)), rel=1e-15)
    assert exact.beta == pytest.approx(np.diff(edges**2) / 2, rel=1e-15)
    assert list(exact.w) == [1, 1, 1, 0.5]


def test_breaks_are_integrated_across():
    """A jump inside a link: the compliance of the link is exact with the break declared, as an expression or apart."""
    for K, breaks in (("Piecewise((1, s < 0.3), (1000, True))", ()), (lambda s: np.where(s < 0.3, 1.0, 1000.0), (0.3,))):
        k = rl.Strut(n=2, K=K, rule="trapezoid", breaks=breaks).joints.k
        assert 1 / k == pytest.approx([0.3 + 0.2e-3, 0.5e-3], rel=1e-14)


def test_from_joints_says_everything_itself():
    strut = rl.Strut.from_joints(k=[1, 2], beta=[0.1, 0.2], h=0.5, beta0=0.3, weights=[1, 0.5])
    phi, lam = np.array([0.4, 0.9]), 2.0
    V = 1 * (0.4 - 0.3 - 0.1) ** 2 / 2 + 2 * (0.9 - 0.4 - 0.2) ** 2 / 2
    V += lam * 0.5 * (np.cos(0.4) + 0.5 * np.cos(0.9) + 0.5 * np.cos(0.3))
    assert strut.energy(phi, lam) == pytest.approx(V, rel=1e-15)
    assert strut.unstressed() == pytest.approx([0.4, 0.6])


# --- derivation ------------------------------------------------------------------------------------------------


def test_the_shipped_kernels_are_those_derived():
    assert Path(standard.__file__).read_text() == ship.standard_source()
    assert Path(standard.__file__).with_name("standard_loads.py").read_text() == ship.loads_source()


def test_what_is_absent_does_not_occur_in_the_kernel():
    straight, curved = rl.Strut(n=3), rl.Strut(n=3, u_hat=1.0)
    assert "beta" not in straight.kernel().parameters
    assert "beta" in curved.kernel().parameters
    assert straight.kernel(0.0).parameters == ("k",)
    assert "w" not in straight.kernel().parameters
    assert "w" in rl.Strut(n=3, rule="trapezoid").kernel().parameters
    assert "beta" not in str(straight.derivation(2).energy)
    assert "lambda" in str(straight.derivation(2).energy)
    assert not straight.kernel().places


@settings(max_examples=15)
@given(states(most=3))
def test_the_symbolic_strut_is_the_numeric_one(state):
    strut, phi, lam = state
    d = strut.derivation(strut.n)
    values = {d.lam: lam, **dict(zip(d.phi, phi, strict=True))}
    numbers = {"phi_0": strut.joints.phi0, **{name: x for name, x in strut.parameters.items() if np.ndim(x) == 0}}
    for name, given_value in strut.parameters.items():
        for i, x in enumerate(np.broadcast_to(given_value, strut.n), start=1):
            numbers[f"{name}_{i}"] = x
    free = d.energy.free_symbols | d.gradient.free_symbols | d.hessian.free_symbols
    values |= {s: numbers[s.name] for s in free if s.name in numbers}
    assert float(d.energy.subs(values)) == pytest.approx(strut.energy(phi, lam), rel=1e-12, abs=1e-12)
    assert np.array(d.gradient.subs(values), float).ravel() == pytest.approx(strut.gradient(phi, lam), rel=1e-10, abs=1e-10)
    assert np.array(d.hessian.subs(values), float) == pytest.approx(strut.hessian(phi, lam).toarray(), rel=1e-10, abs=1e-10)


def test_derivation_shows_weights_and_single_numbers_as_they_are():
    strut = rl.Strut.from_joints(k=[1, 2], weights=[2, 4])
    d = strut.derivation(2)
    numbers = {"k_1": 1, "k_2": 2, "w_1": 2, "w_2": 4, "h": 1, "phi_1": 0.3, "phi_2": 0.7, "lambda": 2.0}
    values = {s: numbers[s.name] for s in d.energy.free_symbols}
    assert float(d.energy.subs(values)) == pytest.approx(strut.energy([0.3, 0.7], 2.0))
    torque = rl.Strut(n=3, terms=(rl.end_torque(0.2),)).derivation(2).gradient
    assert "tau" not in str(torque[0])
    assert "tau" in str(torque[1])


def test_derivation_shows_itself():
    d = rl.Strut(n=50).derivation(3)
    assert d.hessian[0, 2] == 0
    assert sympy.simplify(d.hessian - sympy.hessian(d.energy, d.phi)) == sympy.zeros(3)
    assert r"\lambda" in d._repr_latex_()
    assert "class bending_and_end_load" in str(d)
    assert d.source in str(d)
    with pytest.raises(ValueError, match="n must be at most 12 for showing; it is 13"):
        rl.Strut(n=50).derivation(13)


def test_the_link_derivation_never_sums_springs():
    for terms in ((BENDING, END_LOAD), (BENDING_WITH_REST, END_LOAD)):
        k, c, below = derive.derive(terms, weighted=True).stiffness
        assert str(k) == "k"
        assert "k" not in {s.name for s in c.free_symbols}
        assert below == 0


# --- terms -----------------------------------------------------------------------------------------------------


def test_terms_keep_the_hessian_as_thin_as_they_can():
    phi = np.zeros(5)
    assert isinstance(rl.Strut(n=5, terms=rl.self_weight(1.0)).hessian(phi, 1.0), DifferenceForm)
    assert isinstance(rl.Strut(n=5, terms=(rl.end_torque(1.0),)).hessian(phi, 1.0), DifferenceForm)
    assert isinstance(rl.Strut(n=5, terms=(rl.foundation(1.0),)).hessian(phi, 1.0), Full)
    assert isinstance(rl.Strut(n=500, terms=(rl.foundation(1.0),)).hessian(np.zeros(500), 1.0), Anchored)
    long = rl.Strut(n=50_001, terms=(rl.foundation(1.0),)).hessian(np.zeros(50_001), 1.0)
    assert (long.index, long.index_verified) == (0, True)


def test_end_torque_bends_into_an_arc():
    """[N 2.6, exercise]: m = tau everywhere, phi' = u_hat + tau / K: exact at every n."""
    p = rl.equilibrium(rl.Strut(n=20, u_hat=0.5, terms=(rl.end_torque(0.7),)), lam=0.0)
    assert p.phi == pytest.approx(1.2 * p.s, abs=1e-14)


def test_self_weight_is_dead_load_shared_out():
    """Weight in one lump at the tip, q = lam delta(s - 1), is the load lam."""
    n, lam = 6, 3.0
    q = np.zeros(n)
    q[-1] = lam * n
    phi = np.linspace(0.1, 1.0, n)
    heavy, loaded = rl.Strut(n=n, terms=(rl.self_weight(q),)), rl.Strut(n=n)
    assert heavy.gradient(phi, 0.0) == pytest.approx(loaded.gradient(phi, lam), abs=1e-12)
    assert heavy.hessian(phi, 0.0).toarray() == pytest.approx(loaded.hessian(phi, lam).toarray(), abs=1e-12)


def test_a_term_of_ones_own_in_five_lines():
    def wind(link):
        return -link.p * link.h * link.x

    strut = rl.Strut(n=30, terms=(rl.term(wind, p=0.3),))
    p = rl.equilibrium(strut, lam=0.5)
    assert p.index == 0
    assert p.x[-1] > 0.03
    assert rl.equilibrium(rl.Strut(n=30, terms=(rl.term(wind, p=-0.3),)), lam=0.5).x[-1] == pytest.approx(-p.x[-1])


def nonlinear_spring(link):
    return link.g * (link.b - link.a) ** 4


def test_a_nonlinear_spring_changes_the_coupling():
    strut = rl.Strut(n=5, terms=(rl.term(nonlinear_spring, g=2.0),))
    phi = np.array([0.3, -0.2, 0.5, 1.0, 0.7])
    by_complex_step = np.array([strut.gradient(phi + 1j * STEP * row, 2.0).imag / STEP for row in np.eye(5)])
    assert strut.hessian(phi, 2.0).toarray() == pytest.approx(by_complex_step, abs=1e-11)
    soft = rl.Strut(n=5, terms=(rl.term(nonlinear_spring, g=-10.0),))
    w = np.linalg.eigvalsh(soft.hessian(phi, 2.0).toarray())
    assert soft.hessian(phi, 2.0).index == (w < 0).sum() > 0


# --- bad input -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"n": 0}, "n must be a whole number, at least 1; it is 0"),
        ({"n": 2.5}, "n must be a whole number, at least 1; it is 2.5"),
        ({"n": True}, "n must be a whole number"),
        ({"n": "3"}, "n must be a whole number"),
        ({"K": -1.0}, "K must be a finite number above 0; it is -1.0"),
        ({"K": 0}, "K must be a finite number above 0; it is 0"),
        ({"K": float("nan")}, "K must be a finite number"),
        ({"K": np.inf}, "K must be a finite number"),
        ({"K": "1 - 2*s"}, "K must be positive; it is -1 at s = 1"),
        ({"K": "1 - 2*s", "rule": "trapezoid"}, "K must be positive"),
        ({"K": "1/s**0/0"}, "K must be finite; it is not at s = 0.2"),
        ({"K": "log(-s)"}, "K must be finite"),
        ({"K": [1.0, 2.0]}, r"K must have shape \(5,\); it has shape \(2,\)"),
        ({"K": "import os"}, "is not an expression in s"),
        ({"K": lambda s: 1 / None}, "K must be a function of an array s; it failed with"),
        ({"K": lambda s: s[:2]}, "K must return the shape of s"),
        ({"K": 1e308}, "K must give springs"),
        ({"K": lambda s: np.where(np.sin(1e5 * s) > 0, 1.0, 2.0), "rule": "trapezoid"}, "K must be smooth between its breaks"),
        ({"u_hat": np.nan}, "u_hat must be a finite number; it is nan"),
        ({"u_hat": [np.inf] * 5}, "u_hat must be finite; entry 0 is inf"),
        ({"u_hat": None}, "u_hat must be a finite number; it is None"),
        ({"rule": "middle"}, "rule must be one of 'end', 'trapezoid'; it is 'middle'"),
        ({"phi0": np.inf}, "phi0 must be a finite number"),
        ({"breaks": (1.5,)}, "breaks must lie between 0 and 1"),
        ({"ends": ("clamped", "welded")}, "ends must be"),
        (
            {"terms": (3,)},
            "terms must be made by self_weight, foundation, end_torque, end_force, shearable, potential or term; one is 3",
        ),
        ({"terms": (rl.self_weight(1), rl.self_weight(2))}, "the parameter q of self_weight is already that of self_weight"),
        ({"terms": (rl.self_weight("1/0*s"),)}, "q must be finite"),
    ],
)
def test_bad_struts_get_one_sentence(arguments, says):
    with pytest.raises(ValueError, match=says) as caught:
        rl.Strut(**{"n": 5, **arguments})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"k": []}, "k must hold one positive"),
        ({"k": [1, -1]}, "k must hold one positive"),
        ({"k": [1, np.nan]}, "k must be finite; entry 1 is nan"),
        ({"k": "soft"}, "k must be an array of numbers"),
        ({"k": [1, 1], "beta": [0.1]}, r"beta must have shape \(2,\)"),
        ({"k": [1, 1], "h": 0}, "h must be a finite number above 0; it is 0"),
        ({"k": [1, 1], "weights": [1, 0]}, "weights must be positive; entry 1 is 0"),
        ({"k": [1, 1], "beta0": "up"}, "beta0 must be a finite number; it is 'up'"),
    ],
)
def test_bad_joints_get_one_sentence(arguments, says):
    with pytest.raises(ValueError, match=says):
        rl.Strut.from_joints(**arguments)


@pytest.mark.parametrize("method", ["energy", "gradient", "hessian", "d_lam"])
@pytest.mark.parametrize(
    ("phi", "lam", "says"),
    [
        ([0.0] * 4, 1.0, r"phi must have shape \(5,\); it has shape \(4,\)"),
        ([[0.0] * 5], 1.0, r"phi must have shape \(5,\); it has shape \(1, 5\)"),
        ([0, 0, np.nan, 0, 0], 1.0, "phi must be finite; entry 2 is nan"),
        (["a"] * 5, 1.0, "phi must be an array of numbers"),
        ([0.0] * 5, np.nan, "lam must be a finite number; it is nan"),
        ([0.0] * 5, "5", "lam must be a finite number; it is '5'"),
        ([0.0] * 5, None, "lam must be a finite number; it is None"),
    ],
)
def test_bad_states_get_one_sentence(method, phi, lam, says):
    with pytest.raises(ValueError, match=says):
        getattr(rl.Strut(n=5), method)(phi, lam)


def product(link):
    return link.x * sympy.sin(link.b)


def load_on_place(link):
    return link.lam * link.x


def stranger(link):
    return link.p * link.x + link.zeta


@pytest.mark.parametrize(
    ("energy", "says"),
    [
        (product, "a term must not multiply the place"),
        (load_on_place, "the load lam must act through the angles"),
        (stranger, "the term stranger uses zeta but was given"),
    ],
)
def test_terms_that_the_strut_cannot_carry_are_refused(energy, says):
    with pytest.raises(ValueError, match=says):
        rl.Strut(n=3, terms=(rl.term(energy, p=1.0),))


def soft(link):
    return -link.g * link.b**2 / 2


def test_nothing_given_is_changed_and_nothing_changed_is_felt():
    g, k, guess = np.full(4, 0.1), np.ones(4), np.full(4, 0.2)
    strut = rl.Strut.from_joints(k=k, terms=(rl.term(soft, g=g), rl.self_weight(1.0)))
    first = [strut.hessian(guess, 0.0).diagonal for _ in range(3)]
    assert (first[0] == first[2]).all()
    assert (g == 0.1).all()
    k[0] = g[0] = 100.0
    assert (strut.hessian(guess, 0.0).diagonal == first[0]).all()
    assert strut.gradient(guess, 0.0)[0] < 10


def test_names_that_the_kernel_uses_are_refused_and_a_lambda_is_taken():
    for name in ("sin", "t0"):
        with pytest.raises(ValueError, match=f"the parameter {name} of soft must have a name"):
            rl.Strut(n=3, terms=(rl.term(soft, **{name: 1.0, "g": 1.0}),))
    strut = rl.Strut(n=3, terms=(rl.term(lambda link: link.g * link.b, g=1.0),))
    assert strut.gradient(np.zeros(3), 0.0) == pytest.approx([1, 1, 1])


def test_a_term_must_be_a_function():
    with pytest.raises(ValueError, match="energy must be a function of a link; it is 3"):
        rl.term(3)
