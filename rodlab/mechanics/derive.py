"""From the energy of one link to everything the strut needs, once for every n [N 2.7].

With e(a, b, x, z; lam) the energy of link i (a = phi_{i-1}, b = phi_i, and x, z the place of its upper joint)

    m = -e_a               moment in joint i              gradient_i = m_i - m_{i+1} + f_i + ...
    f = e_a + e_b          net moment on the link
    k = -e_ab              coupling of the two angles     Hessian = D^T diag(k) D - diag(c)
    c = -(e_b + e_a)_b on angle b,  c_below = -(e_a + e_b)_a on angle a
    e_lam, -e_N1           how far the link reaches up and aside: sums of them are z and x of the end
    e_x, e_z               force on the joint             ... + the moments of all forces above
    e_xx, e_xz, e_zz       its change with the place
    m_p, f_p, ...          their change with each parameter p, which may be followed in the load's place

Writing the Hessian by its couplings and rests, as symbols, is what keeps its small eigenvalues accurate: nothing
large is cancelled in floating point. `rodlab.mechanics.ship` writes `standard.py`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import sympy
from sympy import Expr, Symbol
from sympy.printing.numpy import NumPyPrinter

from rodlab.mechanics import link as standard_link
from rodlab.mechanics.link import Link
from rodlab.mechanics.terms import END_FORCE, Term

LONG = 40  # operations up to which an expression is simplified
ARGUMENTS = ("a", "b", "x", "z", "lam")


@dataclass(frozen=True)
class LinkDerivation:
    """The energy of one link and its derivatives, as SymPy expressions; tuples as the kernel returns them."""

    name: str
    energy: Expr
    moments: tuple[Expr, Expr]
    stiffness: tuple[Expr, Expr, Expr]
    moments_lam: tuple[Expr, Expr]
    reach: tuple[Expr, Expr]  # (dx, dz)
    yielding: tuple[Expr, Expr, Expr]  # e in (lam, lam), (lam, N1), (N1, N1): zero unless the rod shears or extends
    forces: tuple[Expr, Expr]
    hardening: tuple[Expr, Expr, Expr]
    by: dict[str, tuple[Expr, Expr, Expr, Expr]]  # derivatives of (m, f, e_x, e_z) in each parameter

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters that occur, sorted: a term that is absent leaves none."""
        return tuple(sorted(s.name for s in self.energy.free_symbols if s.name not in ARGUMENTS))

    @property
    def source(self) -> str:
        """The kernel: a class of plain numpy functions."""
        return _class_source(self)


def energy_of(terms: Sequence[Term], link: Link) -> Expr:
    """Sum of the terms' energies of one link. Raises `ValueError` for terms that do not go together."""
    e = sympy.Add(*(_energy(term)(link) for term in terms))
    if any(term.name == "shearable" for term in terms) and e.has(link.x, link.z):
        other = next(term.name for term in terms if _energy(term)(link).has(link.x, link.z))
        raise ValueError(
            f"a rod that shears or extends bears no load on its length (its strains are those of end loads): {other}"
        )
    return e


def pushed(terms: Sequence[Term]) -> bool:
    """True when a dead force N1 is among the terms."""
    return any(term.name == "end_force" for term in terms)


def reach_of(terms: Sequence[Term], link: Link) -> tuple[tuple[Expr, Expr], tuple[Expr, Expr, Expr]]:
    """(-e_N1, e_lam), and e in (lam, lam), (lam, N1), (N1, N1); also where no force N1 acts."""
    lam, N1 = Symbol("lam", real=True), Symbol("N1", real=True)
    acts = pushed(terms)
    e = energy_of(terms if acts else [*terms, END_FORCE], Link(link._weighted))
    absent = {} if acts else {N1: 0}
    dx, dz = (tidy(part.subs(absent)) for part in (-e.diff(N1), e.diff(lam)))
    if dx.has(link.x, link.z) or dz.has(link.x, link.z):
        raise ValueError("the loads lam and N1 must act through the angles of a link, not its place")
    hh, hN, NN = (tidy(e.diff(*pair).subs(absent)) for pair in ((lam, lam), (lam, N1), (N1, N1)))
    return (dx, dz), (hh, hN, NN)


def derive(terms: Sequence[Term], *, weighted: bool) -> LinkDerivation:
    """Differentiate the sum of the terms; about 0.1 s. Raises `ValueError` for a term this strut cannot carry.

    >>> from rodlab.mechanics.terms import BENDING, END_LOAD
    >>> d = derive((BENDING, END_LOAD), weighted=False)
    >>> d.moments, d.stiffness
    ((k*(-a + b), -h*lam*sin(b)), (k, h*lam*cos(b), 0))
    """
    link = Link(weighted, pushed(terms))
    a, b, x, z, lam = (getattr(link, name) for name in ARGUMENTS)
    e = energy_of(terms, link)
    if any(not tidy(e.diff(place, angle)).is_zero for place in (x, z) for angle in (a, b)):
        raise ValueError("a term must not multiply the place (x, z) of a link by its angles; write it as a sum")
    if any(not tidy(e.diff(lam, place)).is_zero for place in (x, z)):
        raise ValueError("the load lam must act through the angles of a link, not its place")
    m, f = -e.diff(a), e.diff(a) + e.diff(b)
    reach, yielding = reach_of(terms, link)
    return LinkDerivation(
        name=kernel_name(terms, weighted=weighted),
        energy=e,
        moments=(tidy(m), tidy(f)),
        stiffness=(tidy(m.diff(b)), tidy(-f.diff(b)), tidy(-f.diff(a))),
        moments_lam=(tidy(m.diff(lam)), tidy(f.diff(lam))),
        reach=reach,
        yielding=yielding,
        forces=(tidy(e.diff(x)), tidy(e.diff(z))),
        hardening=(tidy(e.diff(x, 2)), tidy(e.diff(x, z)), tidy(e.diff(z, 2))),
        by={
            s.name: (tidy(m.diff(s)), tidy(f.diff(s)), tidy(e.diff(x, s)), tidy(e.diff(z, s)))
            for s in sorted(e.free_symbols, key=str)
            if s.name not in (*ARGUMENTS, "h", "w")
        },
    )


def kernel_name(terms: Sequence[Term], *, weighted: bool) -> str:
    """The name of the kernel for these terms, an identifier."""
    return "_and_".join(term.name for term in terms) + ("_weighted" if weighted else "")


def tidy(expression: Expr) -> Expr:
    """The expression with common factors taken out and sums collected; a long one, which takes SymPy seconds, as it is.

    >>> a, b, k = sympy.symbols("a b k"); tidy(k * (2 * a - 2 * b) / 2)
    k*(a - b)
    """
    return sympy.factor_terms(expression if expression.count_ops() > LONG else sympy.simplify(expression))


def _energy(term: Term) -> Callable[[Link], Expr]:
    if term.energy is not None:
        own = term.energy

        def checked(link: Link) -> Expr:
            try:
                e = sympy.sympify(own(link))
                _ = e.free_symbols
            except (TypeError, ValueError, AttributeError, NameError, ArithmeticError, LookupError, sympy.SympifyError) as error:
                raise ValueError(f"the term {term.name} must return a SymPy expression of the link: {error}") from error
            known = {*ARGUMENTS, "N1", "h", "w", "k", "beta", *term.parameters}
            unknown = sorted({s.name for s in e.free_symbols} - known)
            if unknown:
                raise ValueError(f"the term {term.name} uses {', '.join(unknown)} but was given {dict(term.parameters)!r}")
            return e

        return checked
    function: Callable[[Link], Expr] = getattr(standard_link, term.name)
    return function


def _class_source(d: LinkDerivation) -> str:
    places = any(not e.is_zero for e in d.forces)
    given = "".join(f", {name}: Value" for name in d.parameters)
    angles = f"a: Array, b: Array, lam: float{given}"
    joints = f"x: Array, z: Array{given}"
    energy = f"a: Array, b: Array, x: Array, z: Array, lam: float{given}" if places else angles
    methods = [
        method("energy", energy, (d.energy,)),
        method("moments", angles, d.moments),
        method("stiffness", angles, d.stiffness),
        method("moments_lam", angles, d.moments_lam),
    ]
    if not d.reach[1].is_zero:  # of a load that does not act nothing is asked
        methods += [method("reach", angles, d.reach), method("yielding", angles, d.yielding)]
    methods += [method(f"moments_{name}", angles, known[:2]) for name, known in d.by.items()]
    if places:
        methods += [method("forces", joints, d.forces), method("hardening", joints, d.hardening)]
        methods += [method(f"forces_{name}", joints, known[2:]) for name, known in d.by.items()]
    head = (
        f"class {d.name}:\n"
        f'    """e = {d.energy}"""\n\n'
        f"    parameters = {d.parameters!r}\n"
        f"    places = {places}\n"
        f"    aside = {not d.forces[0].is_zero}\n"
        f"    hardens = {any(not e.is_zero for e in d.hardening)}\n"
        f"    yields = {any(not e.is_zero for e in d.yielding)}\n"
    )
    return head + "".join(methods)


class KernelPrinter(NumPyPrinter):  # type: ignore[misc]
    """numpy source that begins a sum with what is added, not with what is taken away: one pass less over arrays."""

    def _print_Add(self, expr: Expr, order: str | None = None) -> str:
        terms = sorted(self._as_ordered_terms(expr, order=order), key=lambda term: term.could_extract_minus_sign())
        return str(super()._print_Add(sympy.Add(*terms, evaluate=False), order="none"))


def method(name: str, arguments: str, results: tuple[Expr, ...]) -> str:
    """The source of one function of a kernel, common parts computed once."""
    shared, reduced = sympy.cse(results, symbols=(Symbol(f"t{i}") for i in range(1000)), order="none")
    printer = KernelPrinter({"fully_qualified_modules": False})
    lines = [f"        {left} = {printer.doprint(right)}" for left, right in shared]
    values = [printer.doprint(e) if not e.is_number else repr(float(e)) for e in reduced]
    returns = "Value" if len(values) == 1 else f"tuple[{', '.join(['Value'] * len(values))}]"
    body = "\n".join([*lines, f"        return {', '.join(values)}"])
    return f"\n    @staticmethod\n    def {name}({arguments}) -> {returns}:\n{body}\n"


HEADER = '''"""Kernels of the standard terms. Generated by `python -m rodlab.mechanics.ship`; a test derives them again."""

# ruff: noqa: N801, ARG004, E501

from typing import Any

from numpy import cos, sin

from rodlab.numerics.arrays import Array

Value = Any  # a float or an array (n,): what numpy makes of the parameters given

'''
