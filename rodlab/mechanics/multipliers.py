"""The force balance from a constrained principle [N 2.8, The Discrete Force Balance Equations], discrete and continuous.

Angles and places are unknowns of their own; the forces N1, N3 are the multipliers of the kinematics:

    discrete     sum_i bending_i + lam z_n + N1_i (x_i - x_{i-1} - h sin phi_i) + N3_i (z_i - z_{i-1} - h cos phi_i)
    continuous   integral of bending + N1 (x' - sin phi) + N3 (z' - cos phi), plus lam z(1)

Stationary in the places: every N1_i is equal and zero on top, every N3_i equal and -lam on top; put into the equations of the
angles these give back those of the reduced principle. (The constraints run to i = n, or link n would carry no load.)
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy
from sympy import Derivative, Eq, Expr, Function, Symbol, cos, sin

from rodlab.mechanics.derive import energy_of, tidy
from rodlab.mechanics.link import Link
from rodlab.mechanics.terms import Term

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rodlab.mechanics.limit import Limit


@dataclass(frozen=True)
class Balance:
    """The constrained principle and what it gives: balance of forces, the forces that solve it, and balance of moments."""

    principle: Expr
    force_balance: tuple[Eq, ...]
    forces: dict[Expr, Expr]
    moment_balance: tuple[Eq, ...]
    reduced: tuple[Expr, ...]  # left sides of the balance of moments with the forces put in

    def _repr_latex_(self) -> str:
        parts = [self.principle, *self.force_balance, *(Eq(*pair) for pair in self.forces.items()), *self.moment_balance]
        lines = r" \\ ".join(f"& {sympy.latex(part)}" for part in [*parts, *(Eq(left, 0) for left in self.reduced)])
        return rf"$\displaystyle \begin{{aligned}} {lines} \end{{aligned}}$"


def discrete(terms: "Sequence[Term]", n: int, *, upright: bool) -> Balance:
    """The strut of n joints whose links carry `terms` besides the load."""
    lam, h = Symbol("lambda", real=True), Symbol("h", positive=True)
    phi = [sympy.Integer(0) if upright else Symbol("phi_0", real=True), *_numbered("phi", n)]
    x, z, N1, N3 = ([sympy.Integer(0), *_numbered(name, n)] for name in ("x", "z", "N1", "N3"))
    link = Link(_weighted=False)
    energy, L = energy_of(terms, link), lam * z[n]
    for i in range(1, n + 1):
        named = {s: Symbol(f"{s.name}_{i}", **s.assumptions0) for s in energy.free_symbols if s.name != "h"}
        L += energy.subs({**named, link.a: phi[i - 1], link.b: phi[i]}, simultaneous=True)
        L += N1[i] * (x[i] - x[i - 1] - h * sin(phi[i])) + N3[i] * (z[i] - z[i - 1] - h * cos(phi[i]))
    force = [Eq(L.diff(place[i]), 0) for place in (x, z) for i in range(1, n + 1)]
    forces = sympy.solve(force, [*N1[1:], *N3[1:]], dict=True)[0]
    moment = [L.diff(phi[i]) for i in range(1, n + 1)]
    reduced = tuple(sympy.Add(*map(tidy, sympy.Add.make_args(sympy.expand(left.subs(forces))))) for left in moment)
    return Balance(L, tuple(force), forces, tuple(Eq(left, 0) for left in moment), reduced)


def continuous(limit: "Limit") -> Balance:
    """The rod, whose density without the load is the bending of the principle.

    Forces on the length that are given, a weight, leave N1 and N3 known; where they depend on the place, a foundation, the
    balance of forces does not decouple, and they stay unknown.
    """
    s, t, lam = (Symbol(name, real=True) for name in ("s", "t", "lambda"))
    phi, x, z, N1, N3 = (Function(name)(s) for name in ("phi", "x", "z", "N1", "N3"))
    pushed = Symbol("N1", real=True)  # a dead force on the end
    L = limit.density.subs({limit.lam: 0, pushed: 0}).subs(limit.along, simultaneous=True)
    L += N1 * (x.diff(s) - sin(phi)) + N3 * (z.diff(s) - cos(phi))
    force = tuple(Eq(Derivative(L.diff(place.diff(s)), s).doit(), L.diff(place)) for place in (x, z))
    held = (pushed if limit.density.has(pushed) else sympy.Integer(0), -lam)
    ends = tuple(Eq(N.subs(s, 1), value) for N, value in zip((N1, N3), held, strict=True))  # stationary in x(1) and z(1)
    forces: dict[Expr, Expr] = {
        N: value - sympy.integrate(equation.rhs.subs(s, t), (t, s, 1))
        for N, value, equation in zip((N1, N3), held, force, strict=True)
        if not equation.rhs.has(x, z)
    }
    moment = Derivative(L.diff(phi.diff(s)), s) - L.diff(phi)
    reduced = sympy.expand(moment.subs(forces).doit())
    return Balance(L, (*force, *ends), forces, (Eq(moment, 0),), (reduced,))


def _numbered(name: str, n: int) -> list[Any]:
    return [Symbol(f"{name}_{i}", real=True) for i in range(1, n + 1)]
