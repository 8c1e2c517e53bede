"""The symbolic strut of a few joints, for showing: energy, gradient, Hessian in SymPy, and the kernel's source.

Here V is written out for n joints and differentiated whole; the strut itself derives one link (`derive`), and a test
compares the two. In a notebook it shows as LaTeX, in a terminal as text.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy
from sympy import Expr, Matrix, Rational, Symbol, cos, sin

from rodlab.mechanics.derive import derive, tidy
from rodlab.mechanics.terms import Term
from rodlab.numerics.arrays import whole

if TYPE_CHECKING:
    from rodlab.mechanics.strut import Strut

MOST = 12


@dataclass(frozen=True)
class Derivation:
    """Energy V, its gradient (n, 1) and Hessian (n, n) in the angles `phi`; `source` is the kernel that computes them."""

    phi: tuple[Symbol, ...]
    lam: Symbol
    energy: Expr
    gradient: Matrix
    hessian: Matrix
    source: str

    def _repr_latex_(self) -> str:
        rows = [("V", self.energy), ("V'", self.gradient), ("V''", self.hessian)]
        lines = r" \\ ".join(f"{name} &= {sympy.latex(value)}" for name, value in rows)
        return rf"$\displaystyle \begin{{aligned}} {lines} \end{{aligned}}$"

    def __str__(self) -> str:
        parts = [("V", self.energy), ("gradient", self.gradient), ("Hessian", self.hessian)]
        shown = "\n\n".join(f"{name} =\n{sympy.pretty(value, wrap_line=False)}" for name, value in parts)
        return f"{shown}\n\nkernel:\n{self.source}"

    __repr__ = __str__


def derivation(
    terms: Sequence[Term], n: int, *, weights: str | None, scalars: Collection[str], clamped_upright: bool
) -> Derivation:
    """V of n joints, summed from the links and differentiated.

    weights: None where all are 1, "trapezoid" where the last is 1/2, "own" for symbols w_i. scalars: names of the
    parameters that are one number for all joints. Raises `ValueError` for more than 12 joints.

    >>> from rodlab.mechanics.terms import BENDING, END_LOAD
    >>> d = derivation((BENDING, END_LOAD), 2, weights=None, scalars={"h"}, clamped_upright=True)
    >>> print(d.hessian)
    Matrix([[-h*lambda*cos(phi_1) + k_1 + k_2, -k_2], [-k_2, -h*lambda*cos(phi_2) + k_2]])
    """
    n = whole("n", n, least=1)
    if n > MOST:
        raise ValueError(f"n must be at most {MOST} for showing; it is {n} (the strut itself derives one link for every n)")
    one = derive(terms, weighted=weights is not None)
    lam, h = Symbol("lambda", real=True), Symbol("h", positive=True)
    phi0 = sympy.Integer(0) if clamped_upright else Symbol("phi_0", real=True)
    phi = tuple(Symbol(f"phi_{i}", real=True) for i in range(1, n + 1))
    angles = (phi0, *phi)
    w: list[Any] = [sympy.Integer(1)] * (n + 1)
    if weights == "own":
        w[1:] = [Symbol(f"w_{i}", positive=True) for i in range(1, n + 1)]
    elif weights == "trapezoid":
        w[n] = Rational(1, 2)
    theta, x, z = w[n], sympy.Integer(0), sympy.Integer(0)
    V: Any = lam * h * (1 - theta) * cos(phi0)
    for i in range(1, n + 1):
        upper, lower = (w[n] if i == n else theta * w[i]), (1 - theta) * w[i - 1]
        x += h * (lower * sin(angles[i - 1]) + upper * sin(angles[i]))
        z += h * (lower * cos(angles[i - 1]) + upper * cos(angles[i]))
        here: dict[str, Any] = {"a": angles[i - 1], "b": angles[i], "x": x, "z": z, "lam": lam, "w": w[i]}
        names = {s: here.get(s.name, s if s.name in scalars else _numbered(s, i)) for s in one.energy.free_symbols}
        V += one.energy.subs(names, simultaneous=True)
    gradient = Matrix([sympy.Add(*map(tidy, sympy.Add.make_args(V.diff(p)))) for p in phi])
    return Derivation(phi, lam, V, gradient, gradient.jacobian(phi).applyfunc(sympy.expand), one.source)


def derivation_of(strut: "Strut", n: int) -> Derivation:
    """The same for a strut: its terms, and which of its parameters are one number for all joints."""
    j = strut.joints
    own = j.weights is not None and not ((j.w[:-1] == 1).all() and j.last_weight == 0.5)
    scalars = {name for name, given in strut.parameters.items() if np.ndim(given) == 0}
    weights = None if j.weights is None else "own" if own else "trapezoid"
    return derivation(strut.loaded, n, weights=weights, scalars=scalars, clamped_upright=j.phi0 == 0)


def _numbered(symbol: Symbol, i: int) -> Symbol:
    return Symbol(f"{symbol.name}_{i}", **symbol.assumptions0)
