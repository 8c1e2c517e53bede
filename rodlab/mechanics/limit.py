"""From the energy of one link to the rod: what is left of it as the links shorten [N 2.8].

    e(a, b; k, beta, h) / h   ->   W(phi, phi')      with a = phi - h phi', b = phi, k = K / h, beta = u_hat h, w = 1, h -> 0

    m = W_phi'                        moment, K (phi' - u_hat)
    m' = W_phi                        Euler and Lagrange's equation, the balance of moments [N 2.6]
    m(1) = 0                          natural boundary condition at the free end
    phi' = u_hat + m / K,  m' = ...   the same as a first-order system, which is collocated
    H = m phi' - W                    constant where neither K nor u_hat depends on s

Nothing is typed again: a term that a strut can carry gives the rod its own density, and that the kernel of the rod.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import sympy
from sympy import Derivative, Eq, Expr, Function, Symbol

from rodlab.mechanics.derive import energy_of, kernel_name, method, tidy
from rodlab.mechanics.link import Link
from rodlab.mechanics.terms import Term

if TYPE_CHECKING:
    from rodlab.mechanics.multipliers import Balance

STATE = ("p", "phi", "lam")  # phi', phi and the load, as the kernel's arguments


@dataclass(frozen=True)
class Limit:
    """The density W(phi', phi; lam) of a sum of terms, SymPy, in the symbols p = phi', phi, lam and the terms' parameters."""

    terms: tuple[Term, ...]
    density: Expr

    @property
    def p(self) -> Symbol:
        """phi'."""
        return Symbol("p", real=True)

    @property
    def phi(self) -> Symbol:
        """The angle."""
        return Symbol("phi", real=True)

    @property
    def lam(self) -> Symbol:
        """The load."""
        return Symbol("lam", real=True)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters that occur, sorted."""
        return tuple(sorted(s.name for s in self.density.free_symbols if s.name not in STATE))

    @property
    def moment(self) -> Expr:
        """m = W_phi'."""
        return tidy(self.density.diff(self.p))

    @property
    def load(self) -> Expr:
        """W_phi, the moment on a unit of length: m' on an equilibrium."""
        return tidy(self.density.diff(self.phi))

    # --- to be read -------------------------------------------------------------------------------------------------

    @cached_property
    def along(self) -> dict[Symbol, Expr]:
        """Symbols -> functions of s: phi(s), phi'(s), and every profile; lam and end_torque's tau stay numbers."""
        s = Symbol("s", real=True)
        phi = Function("phi")(s)
        profiles = {x: Function(x.name)(s) for x in self.density.free_symbols if x.name not in (*STATE, "tau")}
        return {self.phi: phi, self.p: Derivative(phi, s), self.lam: Symbol("lambda", real=True), **profiles}

    def _read(self, expression: Expr) -> Expr:
        return expression.subs(self.along, simultaneous=True)

    @property
    def euler_lagrange(self) -> Eq:
        """(W_phi')' - W_phi = 0 as an equation for phi(s)."""
        s = Symbol("s", real=True)
        return Eq(Derivative(self._read(self.moment), s) - self._read(self.load), 0)

    @property
    def natural(self) -> Eq:
        """W_phi' = 0 at the free end."""
        return Eq(self._read(self.moment).subs(Symbol("s", real=True), 1), 0)

    @property
    def first_order(self) -> tuple[Eq, Eq]:
        """phi' = ..., m' = ... in phi(s) and m(s): Legendre's transformation, which needs W_phi'phi' > 0."""
        s, m = Symbol("s", real=True), Symbol("m", real=True)
        phi, moment = Function("phi")(s), Function("m")(s)
        right = (self.slope.subs(m, moment), self.load.subs(self.p, self.slope).subs(m, moment))
        return Eq(phi.diff(s), self._read(right[0])), Eq(moment.diff(s), self._read(tidy(right[1])))

    @property
    def slope(self) -> Expr:
        """phi' as a function of m."""
        (slope,) = sympy.solve(self.moment - Symbol("m", real=True), self.p)
        return sympy.expand(slope)

    @property
    def hamiltonian(self) -> Expr:
        """H = m phi' - W in m and phi."""
        return sympy.expand(sympy.simplify((Symbol("m", real=True) * self.p - self.density).subs(self.p, self.slope)))

    @property
    def with_multipliers(self) -> "Balance":
        """The same from the principle in which x and z are unknowns too, with the forces as multipliers [N 2.8]."""
        from rodlab.mechanics.multipliers import continuous

        return continuous(self)

    @property
    def rows(self) -> list[tuple[str, Expr]]:
        """Name -> what the limit gives, in the order in which one would write it on a board."""
        return [
            ("W", self._read(self.density)), ("Euler-Lagrange", self.euler_lagrange), ("free end", self.natural),
            ("first order", self.first_order[0]), ("", self.first_order[1]), ("H", self.hamiltonian),
        ]  # fmt: skip

    def _repr_latex_(self) -> str:
        lines = r" \\ ".join(rf"\text{{{name}}} &\quad {sympy.latex(value)}" for name, value in self.rows)
        return rf"$\displaystyle \begin{{aligned}} {lines} \end{{aligned}}$"

    def __str__(self) -> str:
        return "\n\n".join(f"{name}\n{sympy.pretty(value, wrap_line=False)}" for name, value in self.rows)

    __repr__ = __str__

    # --- to be computed with -----------------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """The name of the kernel."""
        return "limit_of_" + kernel_name(self.terms, weighted=False)

    @property
    def source(self) -> str:
        """The kernel: a class of plain numpy functions of p, phi (any shape), lam and the parameters."""
        m, f = self.moment, self.load
        arguments = "p: Array, phi: Array, lam: float" + "".join(f", {name}: Value" for name in self.parameters)
        kernels = [
            ("energy", (self.density,)),
            ("moments", (m, f)),
            ("stiffness", (tidy(m.diff(self.p)), tidy(m.diff(self.phi)), tidy(f.diff(self.phi)))),
            ("moments_lam", (tidy(m.diff(self.lam)), tidy(f.diff(self.lam)))),
        ]
        symbols = sorted((x for x in self.density.free_symbols if x.name in self.parameters), key=str)
        kernels += [(f"moments_{x.name}", (tidy(m.diff(x)), tidy(f.diff(x)))) for x in symbols]
        head = f'class {self.name}:\n    """W = {self.density}"""\n\n    parameters = {self.parameters!r}\n'
        return head + "".join(method(name, arguments, results) for name, results in kernels)


def limit(terms: Sequence[Term]) -> Limit:
    """The limit of a sum of terms; `ValueError` for a term of the place, whose limit is no density of phi and phi' alone.

    >>> from rodlab.mechanics.terms import BENDING_WITH_REST, END_LOAD
    >>> limit((BENDING_WITH_REST, END_LOAD)).density
    K*(p - u_hat)**2/2 + lam*cos(phi)
    """
    link, h = Link(_weighted=False), Symbol("h", positive=True)
    e = energy_of(terms, link)
    if e.has(link.x, link.z):
        name = next(term.name for term in terms if energy_of([term], link).has(link.x, link.z))
        raise ValueError(f"terms of a rod must depend on the angle and its derivative alone; {name} depends on the place")
    p, phi, K, u_hat = (Symbol(name, real=True) for name in ("p", "phi", "K", "u_hat"))
    shortened = {link.a: phi - h * p, link.b: phi, link.k: K / h, link.beta: u_hat * h}
    per_length = sympy.expand(e.subs(shortened, simultaneous=True) / h)
    density = sympy.Add(*(sympy.limit(part, h, 0, "+") for part in sympy.Add.make_args(per_length)))
    if density.has(sympy.oo, -sympy.oo, sympy.nan, sympy.zoo) or density.has(h):
        raise ValueError(f"the energy of a link must be of the order of its length to have a limit; W came to {density}")
    return Limit(tuple(terms), _collected(density, p, u_hat))


def _collected(density: Expr, p: Symbol, u_hat: Symbol) -> Expr:
    """The density with the square of p - u_hat made whole again, as one would write it."""
    square = sympy.Poly(density, p).all_coeffs() if density.is_polynomial(p) else []
    if len(square) == 3 and density.has(u_hat):
        rest = sympy.expand(density - square[0] * (p - u_hat) ** 2)
        return square[0] * (p - u_hat) ** 2 + rest
    return density
