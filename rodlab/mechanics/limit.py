"""From the energy of one link to the rod: what is left of it as the links shorten [N 2.8].

    e(a, b; k, beta, h) / h   ->   W(phi, phi')      with a = phi - h phi', b = phi, k = K / h, beta = u_hat h, w = 1, h -> 0

    m = W_phi'                        moment, K (phi' - u_hat)
    m' = W_phi                        Euler and Lagrange's equation, the balance of moments [N 2.6]
    m(1) = 0                          natural boundary condition at the free end
    phi' = u_hat + m / K,  m' = ...   the same as a first-order system, which is collocated
    H = m phi' - W                    constant where neither K nor u_hat depends on s

A term of the place leaves W_x and W_z, forces on a unit of length. Their sums from s to the end, Q1 and Q3, turn the rod besides:
m' = W_phi + Q1 cos phi - Q3 sin phi,  Q1' = -W_x,  Q3' = -W_z. Where these depend on x and z the balance of forces does not
decouple.

Nothing is typed again: a term that a strut can carry gives the rod its own density, and that the kernel of the rod.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import sympy
from sympy import Derivative, Eq, Expr, Function, Symbol, cos, sin

from rodlab.mechanics.derive import energy_of, kernel_name, method, pushed, reach_of, tidy
from rodlab.mechanics.link import Link
from rodlab.mechanics.terms import Term

if TYPE_CHECKING:
    from rodlab.mechanics.multipliers import Balance

STATE = ("phi_s", "phi", "x", "z", "lam")  # phi', phi, the place and the load, as the kernel's arguments
LOADS = ("tau", "N1")  # numbers
X, Z = (Symbol(name, real=True) for name in ("x", "z"))


@dataclass(frozen=True)
class Limit:
    """The density W(phi', phi, x, z; lam) of a sum of terms, SymPy, in phi_s = phi', phi, x, z, lam and the terms' parameters."""

    terms: tuple[Term, ...]
    density: Expr
    reach: tuple[Expr, Expr]  # (x', z')
    yielding: tuple[Expr, Expr, Expr]  # W in (lam, lam), (lam, N1), (N1, N1)

    @property
    def p(self) -> Symbol:
        """phi'."""
        return Symbol("phi_s", real=True)

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
        """W_phi, the moment on a unit of length: m' on an equilibrium, but for what the forces do."""
        return tidy(self.density.diff(self.phi))

    @property
    def forces(self) -> tuple[Expr, Expr]:
        """W_x and W_z, the forces on a unit of length against its place."""
        return tidy(self.density.diff(X)), tidy(self.density.diff(Z))

    @property
    def placed(self) -> bool:
        """True when the density depends on the place."""
        return bool(self.density.has(X, Z))

    @property
    def turned(self) -> Expr:
        """m' on an equilibrium: W_phi, and the moment of the forces Q1, Q3 that are carried above."""
        if not self.placed:
            return self.load
        return self.load + Symbol("Q1", real=True) * cos(self.phi) - Symbol("Q3", real=True) * sin(self.phi)

    # --- to be read -------------------------------------------------------------------------------------------------

    @cached_property
    def along(self) -> dict[Symbol, Expr]:
        """Symbols -> functions of s: phi(s), phi'(s), and every profile; lam and end_torque's tau stay numbers."""
        s = Symbol("s", real=True)
        phi = Function("phi")(s)
        profiles = {x: Function(x.name)(s) for x in self.density.free_symbols if x.name not in (*STATE, *LOADS)}
        places = {x: Function(x.name)(s) for x in (X, Z, *(Symbol(name, real=True) for name in ("Q1", "Q3")))}
        return {self.phi: phi, self.p: Derivative(phi, s), self.lam: Symbol("lambda", real=True), **places, **profiles}

    def _read(self, expression: Expr) -> Expr:
        return expression.subs(self.along, simultaneous=True)

    @property
    def euler_lagrange(self) -> Eq:
        """(W_phi')' - W_phi = 0 as an equation for phi(s); with the moment of forces on the length where there are any."""
        s = Symbol("s", real=True)
        return Eq(Derivative(self._read(self.moment), s) - self._read(self.turned), 0)

    @property
    def natural(self) -> Eq:
        """W_phi' = 0 at the free end."""
        return Eq(self._read(self.moment).subs(Symbol("s", real=True), 1), 0)

    @property
    def first_order(self) -> tuple[Eq, Eq]:
        """phi' = ..., m' = ... in phi(s) and m(s): Legendre's transformation, which needs W_phi'phi' > 0."""
        s, m = Symbol("s", real=True), Symbol("m", real=True)
        phi, moment = Function("phi")(s), Function("m")(s)
        right = (self.slope.subs(m, moment), self.turned.subs(self.p, self.slope).subs(m, moment))
        return Eq(phi.diff(s), self._read(right[0])), Eq(moment.diff(s), self._read(tidy(right[1])))

    @property
    def balance(self) -> tuple[Eq, ...]:
        """x', z', Q1' and Q3' in the place: what joins the first-order system where a term depends on it; Q1(1) = Q3(1) = 0."""
        s = Symbol("s", real=True)
        left = (X, Z, Symbol("Q1", real=True), Symbol("Q3", real=True))
        right = (sin(self.phi), cos(self.phi), *(-force for force in self.forces))
        return tuple(Eq(self._read(a).diff(s), self._read(b)) for a, b in zip(left, right, strict=True)) if self.placed else ()

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
            ("first order", self.first_order[0]), ("", self.first_order[1]), *(("", line) for line in self.balance),
            ("H", self.hamiltonian),
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
        """The kernel: a class of plain numpy functions of phi_s, phi, x, z (any shape), lam and the parameters."""
        m, f, forces = self.moment, self.load, self.forces
        given = "".join(f", {name}: Value" for name in self.parameters)
        local, placed = f"phi_s: Array, phi: Array, lam: float{given}", f"x: Array, z: Array{given}"
        whole = f"phi_s: Array, phi: Array, x: Array, z: Array, lam: float{given}" if self.placed else local
        symbols = sorted((x for x in self.density.free_symbols if x.name in self.parameters), key=str)
        kernels = [
            ("energy", whole, (self.density,)),
            ("moments", local, (m, f)),
            ("stiffness", local, (tidy(m.diff(self.p)), tidy(m.diff(self.phi)), tidy(f.diff(self.phi)))),
            ("moments_lam", local, (tidy(m.diff(self.lam)), tidy(f.diff(self.lam)))),
        ]
        if not self.reach[1].is_zero:
            kernels += [("reach", local, self.reach), ("yielding", local, self.yielding)]
        kernels += [(f"moments_{x.name}", local, (tidy(m.diff(x)), tidy(f.diff(x)))) for x in symbols]
        hardening = tuple(tidy(self.density.diff(a, b)) for a, b in ((X, X), (X, Z), (Z, Z)))
        if self.placed:
            kernels += [("forces", placed, forces), ("hardening", placed, hardening)]
            kernels += [(f"forces_{x.name}", placed, tuple(tidy(force.diff(x)) for force in forces)) for x in symbols]
        head = f'class {self.name}:\n    """W = {self.density}"""\n\n    parameters = {self.parameters!r}\n'
        head += f"    places = {self.placed}\n    aside = {not forces[0].is_zero}\n"
        head += f"    hardens = {any(not e.is_zero for e in hardening)}\n"
        head += f"    yields = {any(not e.is_zero for e in self.yielding)}\n"
        return head + "".join(method(*each) for each in kernels)


def limit(terms: Sequence[Term]) -> Limit:
    """The limit of a sum of terms. Raises `ValueError` where it has none.

    >>> from rodlab.mechanics.terms import BENDING_WITH_REST, END_LOAD
    >>> limit((BENDING_WITH_REST, END_LOAD)).density
    K*(phi_s - u_hat)**2/2 + lam*cos(phi)
    """
    link, h = Link(_weighted=False, _pushed=pushed(terms)), Symbol("h", positive=True)
    p, phi, K, u_hat = (Symbol(name, real=True) for name in ("phi_s", "phi", "K", "u_hat"))
    shortened = {link.a: phi - h * p, link.b: phi, link.k: K / h, link.beta: u_hat * h}
    reach, yielding = reach_of(terms, link)
    per_length = [
        sympy.Add(
            *(
                sympy.limit(part, h, 0, "+")
                for part in sympy.Add.make_args(sympy.expand(e.subs(shortened, simultaneous=True) / h))
            )
        )
        for e in (energy_of(terms, link), *reach, *yielding)
    ]
    if any(e.has(sympy.oo, -sympy.oo, sympy.nan, sympy.zoo) or e.has(h) for e in per_length):
        raise ValueError(f"the energy of a link must be of the order of its length to have a limit; W came to {per_length[0]}")
    density, dx, dz, hh, hN, NN = (per_length[0], *map(tidy, per_length[1:]))
    return Limit(tuple(terms), _collected(density, p, u_hat), (dx, dz), (hh, hN, NN))


def _collected(density: Expr, p: Symbol, u_hat: Symbol) -> Expr:
    """The density with the square of p - u_hat made whole again, as one would write it."""
    square = sympy.Poly(density, p).all_coeffs() if density.is_polynomial(p) else []
    if len(square) == 3 and density.has(u_hat):
        rest = sympy.expand(density - square[0] * (p - u_hat) ** 2)
        return square[0] * (p - u_hat) ** 2 + rest
    return density
