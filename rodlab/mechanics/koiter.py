"""Koiter's expansion of the half-branch on which a straight strut buckles, order by order and in closed form.

    lam(eps) = lam_j + lam_2 eps^2 + lam_4 eps^4 + ...    phi(eps) = eps v + eps^3 phi_3 + ...    eps = phi_n, the tip angle

    A v = 0,  v_n = 1                      the mode, with A = V''(0; lam_j)
    A phi_m + lam_{m-1} B v + R_m = 0      power m of V' = 0, with B = dA/dlam and R_m of the lower coefficients
    lam_{m-1} = -(v . R_m) / (v . B v)     makes it solvable; then phi_m, with 0 at the tip [Lyapunov, Schmidt]

[Koiter 1945, On the stability of elastic equilibrium; N 2.7]. V' is the gradient that `derivation` derives. lam_j is a root
of an irreducible factor of det V''(0; lam), so that all numbers above are polynomials in lam_j modulo that factor with
rational coefficients: nothing is rounded, and no root is taken before the end. An even term of V' gives lam_1 eps as well.
With springs and the load alone, lam_2 = lam_j sum_i w_i v_i^4 / (6 sum_i w_i v_i^2).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial, reduce
from itertools import count
from math import factorial, floor, log10
from typing import Any

import numpy as np
import sympy
from sympy import QQ, AlgebraicNumber, Dummy, Expr, Float, Integer, Matrix, Poly, Rational, Symbol
from sympy.polys.matrices import DomainMatrix
from sympy.polys.matrices.exceptions import DMNonInvertibleMatrixError
from sympy.polys.polyerrors import BasePolynomialError
from sympy.polys.ring_series import rs_mul
from sympy.polys.rings import PolyElement, ring

from rodlab.mechanics.ends import refuse_held
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import EPS, whole

MOST = 6
NOT_STRAIGHT = "strut must be straight to buckle: phi0, u_hat and every rest angle zero, no term that bends it"


@dataclass(frozen=True)
class Gradient:
    """V'(phi; lam) of a strut with its numbers in: `rows` (n,), and `straight`, the Hessian (n, n) at phi = 0."""

    phi: tuple[Symbol, ...]
    lam: Symbol
    rows: tuple[Expr, ...]
    straight: Matrix

    def at(self, series: Sequence[PolyElement], most: int) -> list[PolyElement]:
        """The rows at the angles and the load, given as series in eps, up to eps^most."""
        known = dict(zip((*self.phi, self.lam), series, strict=True))
        return [composed(row, known, most) for row in self.rows]


@dataclass(frozen=True, eq=False)
class Koiter:
    """Load and angles of mode `mode` as polynomials in the tip angle `eps`, up to eps^order and eps^(order + 1).

    `value` is the closed form of lam_j and `root` the symbol for it; `series` are the angles (n,) and the load over QQ(lam_j).
    Shows as LaTeX in a notebook; where lam_j takes more than a square root, in polynomials in lam_j.
    """

    gradient: Gradient
    mode: int
    order: int
    value: Expr
    series: tuple[PolyElement, ...]

    @property
    def eps(self) -> Symbol:
        """The tip angle; its sign chooses the half-branch."""
        return Symbol("epsilon", real=True)

    @property
    def root(self) -> Symbol:
        """lam_j."""
        return Symbol(f"lambda_{self.mode}", real=True)

    @property
    def minimal(self) -> Poly:
        """The polynomial, irreducible over QQ, whose root is lam_j."""
        return Poly(self.series[-1].ring.domain.mod.to_list(), self.root)

    @cached_property
    def coefficients(self) -> dict[int, Expr]:
        """Power of eps -> closed form of its coefficient in the load; an odd power only where it occurs."""
        even = dict.fromkeys(range(0, self.order + 1, 2), Integer(0))
        return dict(sorted((even | _powers(self.series[-1], self._closed)).items()))

    @cached_property
    def load(self) -> Expr:
        """lam(eps)."""
        return sympy.Add(*(c * self.eps**m for m, c in self.coefficients.items()))

    @cached_property
    def angles(self) -> tuple[Expr, ...]:
        """phi_1(eps)..phi_n(eps)."""
        return tuple(sympy.Add(*(c * self.eps**m for m, c in _powers(p, self._closed).items())) for p in self.series[:-1])

    def residual_order(self) -> int:
        """The first power of eps that is left in V' at this expansion; above order + 1 if the expansion is right.

        Exact, and computed from the gradient. Looked for below 2 order + 4, which is the answer where nothing is left.

        >>> koiter(Strut(n=3), order=2).residual_order()
        5
        """
        for most in (self.order + 3, 2 * self.order + 3):
            left = [m for row in self.gradient.at(self.series, most) for (m,) in row.monoms()]
            if left:
                return int(min(left))
        return 2 * self.order + 4

    # --- to be read -------------------------------------------------------------------------------------------------

    def _in_root(self, c: Any) -> Expr:
        return Poly(c.to_list(), self.root, domain=QQ).as_expr()

    def _closed(self, c: Any) -> Expr:
        return sympy.expand(self._in_root(c).subs(self.root, self.value))

    @property
    def rows(self) -> list[tuple[Symbol, list[Expr]]]:
        """What is expanded, and its terms as they are shown, powers ascending."""
        radical = self.minimal.degree() <= 2
        show = self._closed if radical else self._in_root
        names, more = (self.gradient.lam, *self.gradient.phi[:-1]), Symbol("...")
        expanded = ([c * self.eps**m for m, c in _powers(p, show).items()] for p in (self.series[-1], *self.series[:-2]))
        rows = [(name, [*(terms or [Integer(0)]), more]) for name, terms in zip(names, expanded, strict=True)]
        return [*rows, (self.gradient.phi[-1], [self.eps]), *([] if radical else [(self.root, [self.value])])]

    def _repr_latex_(self) -> str:
        lines = r" \\ ".join(f"{sympy.latex(name)} &= {_sum(terms, sympy.latex)}" for name, terms in self.rows)
        return rf"$\displaystyle \begin{{aligned}} {lines} \end{{aligned}}$"

    def __str__(self) -> str:
        return "\n".join(f"{name} = {_sum(terms, str)}" for name, terms in self.rows)

    __repr__ = __str__


def koiter(strut: Strut, mode: int = 1, order: int = 4) -> Koiter:
    """The half-branch that leaves the straight strut at its buckling load number `mode`, up to eps^order, for n up to 6.

    Floats are taken for the rationals they are meant to be: h = 1/3 and K = 0.1 exactly. Any terms will do that leave the strut
    straight and have Taylor series with rational coefficients. Raises `ValueError` for others, and at a double load.

    >>> koiter(Strut.from_joints(k=[1, 1]), order=2)
    lambda = 3/2 - sqrt(5)/2 + epsilon**2*(1/2 - sqrt(5)/5) + ...
    phi_1 = epsilon*(-1/2 + sqrt(5)/2) + epsilon**3*(-1/4 + 7*sqrt(5)/60) + ...
    phi_2 = epsilon
    >>> koiter(Strut.from_joints(k=[1])).coefficients
    {0: 1, 2: 1/6, 4: 7/360}
    """
    mode, order = whole("mode", mode, least=1), whole("order", order, least=2)
    gradient = gradient_of(strut)
    load, minimal = buckling_load(gradient, mode)
    return Koiter(gradient, mode, order, closed_form(strut, mode, load, minimal), expansion(gradient, minimal, load, order))


def gradient_of(strut: Strut) -> Gradient:
    """The gradient that SymPy derives for this strut, its numbers put in as rationals."""
    if not isinstance(strut, Strut):
        raise ValueError(f"strut must be a Strut; it is {strut!r:.60}")
    refuse_held("strut", strut)
    if strut.n > MOST:
        raise ValueError(f"n must be at most {MOST} for closed forms; it is {strut.n} (rl.expansion has the numbers for every n)")
    if not strut.is_straight:
        raise ValueError(NOT_STRAIGHT)
    d = strut.derivation(strut.n)
    numbers = {name: float(given) for name, given in strut.parameters.items() if np.ndim(given) == 0}
    for name, given in strut.parameters.items():
        numbers |= {f"{name}_{i}": x for i, x in enumerate(np.ravel(given).tolist(), start=1)}
    own = {s: rational(numbers[s.name]) for s in d.gradient.free_symbols - {*d.phi, d.lam}}
    own |= {x: rational(float(x)) for x in d.gradient.atoms(Float)}
    rows, at_rest = d.gradient.xreplace(own), dict.fromkeys(d.phi, Integer(0))
    if not rows.xreplace(at_rest).expand().is_zero_matrix:
        raise ValueError(NOT_STRAIGHT)
    return Gradient(d.phi, d.lam, tuple(rows), rows.jacobian(d.phi).xreplace(at_rest).expand())


def rational(x: float) -> Rational:
    """The rational that a float is meant to be: a power of ten times a fraction of few digits, within two roundings.

    >>> [rational(x) for x in (0.0, 1 / 3, 0.1, 3 * 1.1, -2.5e-20)]
    [0, 1/3, 1/10, 33/10, -1/40000000000000000000]
    """
    scale = Fraction(10) ** floor(log10(abs(x) or 1.0))
    exact = Fraction(x) / scale
    near = (exact.limit_denominator(10**digits) for digits in count())
    return Rational(scale * next(q for q in near if abs(q - exact) <= 2 * EPS * abs(exact)))


def buckling_load(gradient: Gradient, mode: int) -> tuple[Expr, Poly]:
    """Load number `mode` among the real roots of det V''(0; lam), ascending, and its minimal polynomial."""
    in_lam = QQ[gradient.lam]
    try:
        det = DomainMatrix.from_Matrix(gradient.straight).convert_to(in_lam).det()
    except BasePolynomialError:
        raise ValueError(f"terms must have rational second derivatives at phi = 0; V'' is {gradient.straight!s:.60}") from None
    factors = Poly(in_lam.to_sympy(det), gradient.lam).factor_list()[1]
    found = [(root, p, times) for p, times in factors for root in p.real_roots(radicals=False) for _ in range(times)]
    if mode > len(found):
        raise ValueError(f"mode must be at most {len(found)}, the number of buckling loads; it is {mode}")
    load, p, times = sorted(found, key=lambda one: one[0].n(50))[mode - 1]
    if times > 1:
        raise ValueError(f"mode must have a simple buckling load; lam = {load.n(6)}, that of mode {mode}, is shared by {times}")
    return load, p


def closed_form(strut: Strut, mode: int, load: Expr, minimal: Poly) -> Expr:
    """The load by square roots, for a uniform strut by a sine [N 2.7], else as it is: SymPy's root of a polynomial."""
    j = strut.joints
    trapezoid = bool((j.w[:-1] == 1).all()) and j.last_weight == 0.5
    if minimal.degree() <= 2:
        return min(minimal.real_roots(), key=lambda root: abs(root.n(50) - load.n(50)))
    if strut.terms or np.ptp(j.k) or not (j.weights is None or trapezoid):
        return load
    angle = (2 * mode - 1) * sympy.pi / (2 * j.n + (j.weights is None))
    square = sympy.sin(angle / 2) ** 2
    return 4 * rational(j.k[0]) / rational(j.h) * (square if square.has(sympy.sin) else (1 - sympy.cos(angle)) / 2)


def expansion(gradient: Gradient, minimal: Poly, load: Expr, order: int) -> tuple[PolyElement, ...]:
    """Angles and load as series in eps over QQ(lam_j), by the three lines at the top of this module."""
    field = QQ.algebraic_field(AlgebraicNumber((minimal, load)))
    series, eps = ring("epsilon", field)
    lam_j = field.unit * field.one  # the product reduces it where the load is rational
    B = DomainMatrix.from_Matrix(gradient.straight.diff(gradient.lam)).convert_to(field)
    A = DomainMatrix.from_Matrix(gradient.straight.subs(gradient.lam, 0)).convert_to(field) + B.scalarmul(lam_j)
    try:
        inverse = A[:-1, :-1].inv()
    except DMNonInvertibleMatrixError:
        raise ValueError(f"mode must turn the tip, whose angle is eps; the mode at lam = {load.n(6)} does not") from None
    v = [*(-inverse * A[:-1, -1:]).to_list_flat(), field.one]
    Bv = (B * _column(v, field)).to_list_flat()
    angles, lam = [c * eps for c in v], series(lam_j)
    for m in range(2, order + 2):
        R = [row.coeff(eps**m) for row in gradient.at((*angles, lam), m)]
        change = -_dot(v, R) / _dot(v, Bv)
        right = [-(r + change * b) for r, b in zip(R, Bv, strict=True)]
        phi = [*(inverse * _column(right[:-1], field)).to_list_flat(), field.zero]
        angles = [angle + c * eps**m for angle, c in zip(angles, phi, strict=True)]
        lam += change * eps ** (m - 1)
    return (*angles, lam)


def composed(e: Expr, known: dict[Expr, PolyElement], most: int) -> PolyElement:
    """The expression at series in eps for its symbols, up to eps^most; `known` gathers its parts.

    >>> x, (R, eps) = Symbol("x"), ring("eps", QQ)
    >>> composed(sympy.sin(x) * sympy.exp(x), {x: eps}, 3)
    1/3*eps**3 + eps**2 + eps
    """
    if e not in known:
        one = next(iter(known.values())).ring.one
        parts = (composed(part, known, most) for part in e.args)
        if e.is_Rational:
            known[e] = one * one.ring.domain.from_sympy(e)
        elif e.is_Add:
            known[e] = sum(parts, 0 * one)
        elif e.is_Mul:
            known[e] = reduce(partial(_times, most), parts)
        else:
            known[e] = _function(e, known, most)
    return known[e]


def _function(e: Expr, known: dict[Expr, PolyElement], most: int) -> PolyElement:
    """A function or power of one expression, by Taylor's series at that expression's value for eps = 0."""
    t = Dummy("t", real=True)
    inner = [x for x in e.args if x.free_symbols]
    if len(inner) == 1:
        u = composed(inner[0], known, most)
        domain, constant = u.ring.domain, u.coeff(1)
        f, at = e.func(*(t if x is inner[0] else x for x in e.args)), domain.to_sympy(constant)
        taylor = [sympy.diff(f, t, k).subs(t, at) / factorial(k) for k in range(most + 1)]
        if all(c.is_Rational for c in taylor):
            return reduce(lambda p, c: _times(most, p, u - constant) + domain.from_sympy(c), reversed(taylor), 0 * u)
    raise ValueError(f"terms must have a Taylor series at phi = 0 with rational coefficients; {e!s:.60} has none")


def _times(most: int, p: PolyElement, q: PolyElement) -> PolyElement:
    return rs_mul(p, q, p.ring.gens[0], most + 1)


def _column(values: Sequence[Any], field: Any) -> DomainMatrix:
    return DomainMatrix([[x] for x in values], (len(values), 1), field)


def _dot(v: Sequence[Any], w: Sequence[Any]) -> Any:
    return sum(x * y for x, y in zip(v, w, strict=True))


def _powers(series: PolyElement, show: Callable[[Any], Expr]) -> dict[int, Expr]:
    return {m: show(c) for (m,), c in reversed(series.terms())}


def _sum(terms: Sequence[Expr], printed: Callable[[Expr], str]) -> str:
    return " + ".join(map(printed, terms)).replace("+ -", "- ")
