"""The limit of the link: density, Euler and Lagrange's equation, first-order system, and the principle with multipliers."""

import pytest
import sympy
from sympy import Derivative, Eq, Function, Symbol, cos, sin

import rodlab as rl
from rodlab.mechanics.limit import limit
from rodlab.mechanics.multipliers import discrete
from rodlab.mechanics.terms import BENDING, BENDING_WITH_REST, END_LOAD

s, lam = Symbol("s", real=True), Symbol("lambda", real=True)
phi, K, u_hat, m, N1, N3 = (Function(name)(s) for name in ("phi", "K", "u_hat", "m", "N1", "N3"))


def same(left, right):
    return sympy.simplify((left - right).doit()) == 0


def test_density_is_that_of_the_notes():
    found = limit((BENDING_WITH_REST, END_LOAD))
    p, angle, load, stiffness, rest = (Symbol(name, real=True) for name in ("phi_s", "phi", "lam", "K", "u_hat"))
    assert same(found.density, stiffness * (p - rest) ** 2 / 2 + load * cos(angle))
    assert limit((BENDING, END_LOAD)).parameters == ("K",)  # without rest angles none occur


def test_euler_lagrange_and_natural_condition():
    found = limit((BENDING_WITH_REST, END_LOAD))
    assert same(found.euler_lagrange.lhs, Derivative(K * (phi.diff(s) - u_hat), s) + lam * sin(phi))
    assert same(found.natural.lhs, (K * (phi.diff(s) - u_hat)).subs(s, 1))


def test_first_order_system_and_hamiltonian():
    found = limit((BENDING_WITH_REST, END_LOAD))
    assert found.first_order == (Eq(phi.diff(s), u_hat + m / K), Eq(m.diff(s), -lam * sin(phi)))
    moment, angle, load, stiffness, rest = (Symbol(name, real=True) for name in ("m", "phi", "lam", "K", "u_hat"))
    assert same(found.hamiltonian, moment**2 / (2 * stiffness) + rest * moment - load * cos(angle))


def test_euler_lagrange_is_the_limit_of_the_discrete_balance():
    """Taylor's series of the strut's moment balance over h, from the same link."""
    h, k, b = Symbol("h", positive=True), Symbol("kappa", positive=True), Symbol("b", real=True)
    f = [Symbol(f"f_{i}", real=True) for i in range(4)]  # phi and its derivatives at s
    after, before = (f[0] + side * h * f[1] + h**2 * f[2] / 2 + side * h**3 * f[3] / 6 for side in (1, -1))
    spring, rest = k / h, b * h
    balance = -spring * (after - f[0] - rest) + spring * (f[0] - before - rest) - lam * h * sin(f[0])
    assert same(sympy.limit(sympy.expand(balance / h), h, 0), -k * f[2] - lam * sin(f[0]))


@pytest.mark.parametrize("n", [1, 2, 4])
def test_discrete_multipliers_give_back_the_reduced_principle(n):
    balance = discrete((BENDING_WITH_REST,), n, upright=True)
    forces = {str(name): value for name, value in balance.forces.items()}
    assert forces == {f"N1_{i}": 0 for i in range(1, n + 1)} | {f"N3_{i}": -lam for i in range(1, n + 1)}
    gradient = rl.Strut(n=n, u_hat=0.3).derivation(n).gradient
    for reduced, own in zip(balance.reduced, gradient, strict=True):
        names = {x: Symbol(x.name, **y.assumptions0) for x in reduced.free_symbols for y in own.free_symbols if x.name == y.name}
        assert same(reduced.subs(names), own)


def test_continuous_multipliers_give_back_the_reduced_principle():
    found = limit((BENDING_WITH_REST, END_LOAD))
    balance = found.with_multipliers
    assert balance.forces == {N1: 0, N3: -lam}
    assert Eq(Function("N1")(1), 0) in balance.force_balance
    assert Eq(Function("N3")(1), -lam) in balance.force_balance
    assert same(balance.reduced[0], found.euler_lagrange.lhs)
    moment = Derivative(K * (phi.diff(s) - u_hat), s) - N3 * sin(phi) + N1 * cos(phi)  # m' = N3 sin(phi) - N1 cos(phi) [N 2.6]
    assert same(balance.moment_balance[0].lhs, moment)


def test_a_term_of_ones_own_has_its_limit():
    def stiffening(link):
        return link.c * link.h * link.w * link.b**4 / 24

    rod = rl.Rod(terms=(rl.term(stiffening, c=2.0),))
    angle, c = Symbol("phi", real=True), Symbol("c", real=True)
    assert same(rod.derivation().load.coeff(c), angle**3 / 6)
    p = rl.equilibrium(rod, 4.0, lambda s: 1.5 * s)
    strut = rl.equilibrium(rl.Strut(n=4000, rule="trapezoid", terms=(rl.term(stiffening, c=2.0),)), 4.0, lambda s: p(s).phi)
    assert p.tip_angle == pytest.approx(strut.tip_angle, abs=1e-6)


def test_what_has_no_limit_is_said():
    with pytest.raises(ValueError, match="of the order of its length"):
        rl.Rod(terms=(rl.term(lambda link: link.c * link.b**2, c=1.0),))


def test_derivations_show_themselves():
    found = rl.Rod(u_hat=0.1).derivation()
    assert "Euler-Lagrange" in str(found)
    assert found._repr_latex_().startswith("$")
    assert r"\lambda" in found.with_multipliers._repr_latex_()
