"""The energy of one link, in SymPy, as terms that add [N 2.7].

    a = phi_{i-1}, b = phi_i      angles below and above the spring k with rest angle beta
    x, z                          place of the joint at the link's upper end
    h, w                          length of the link, weight of its angle in the rule (1 where the rule has none)
    lam, N1                       the dead loads on the end: lam presses down, N1 pushes along x (0 unless a term names it)

Every other name is a parameter of the term that uses it. V is the sum over the links.
"""

from dataclasses import dataclass

import sympy
from sympy import Expr, Integer, Symbol, cos, sin

from rodlab.mechanics.expression import FUNCTIONS, Expression


@dataclass(frozen=True)
class Link:
    """A link as a bag of symbols: `link.a`, `link.k`, `link.anything`.

    `_weighted`: whether the rule has weights; `_pushed`: whether a dead force N1 acts.
    """

    _weighted: bool = True
    _pushed: bool = True

    def __getattr__(self, name: str) -> Expr:
        if name.startswith("_"):
            raise AttributeError(name)
        if name == "w" and not self._weighted:
            return Integer(1)
        if name == "N1" and not self._pushed:
            return Integer(0)
        return Symbol(name, positive=True) if name in ("k", "h", "w") else Symbol(name, real=True)


def bending(link: Link) -> Expr:
    """A straight spring."""
    return link.k * (link.b - link.a) ** 2 / 2


def bending_with_rest(link: Link) -> Expr:
    """A spring with rest angle beta."""
    return link.k * (link.b - link.a - link.beta) ** 2 / 2


def end_load(link: Link) -> Expr:
    """The load lam times the height that this link adds."""
    return link.lam * link.h * link.w * cos(link.b)


def self_weight(link: Link) -> Expr:
    """The weight of a link's length, lifted to z."""
    return link.q * link.h * link.w * link.z


def foundation(link: Link) -> Expr:
    """A spring that pulls the joint back to x = 0."""
    return link.c * link.h * link.w * link.x**2 / 2


def end_torque(link: Link) -> Expr:
    """A couple on the end: -tau phi_n, up to a constant, shared out over the joints."""
    return -link.tau * (link.b - link.a)


def end_force(link: Link) -> Expr:
    """A dead force N1 along x on the end: -N1 times the x that this link adds."""
    return -link.N1 * link.h * link.w * sin(link.b)


def shearable(link: Link) -> Expr:
    """Shear and extension under dead end loads, eliminated: -(shear n1^2 + extension n3^2) / 2 a length [N 2.8, exercise].

    n1 = lam sin phi + N1 cos phi and n3 = N1 sin phi - lam cos phi are the forces across and along the link.
    """
    across = link.lam * sin(link.b) + link.N1 * cos(link.b)
    along = link.N1 * sin(link.b) - link.lam * cos(link.b)
    return -link.h * link.w * (link.shear * across**2 + link.extension * along**2) / 2


def potential(link: Link, U: str) -> Expr:
    """A potential U of the place, as text in x and z, on a link's length; decimals are taken for the fractions they are."""
    functions = {name: getattr(sympy, name) for name in FUNCTIONS}
    return link.h * link.w * sympy.nsimplify(Expression(U, ("x", "z")).of(**functions, x=link.x, z=link.z), rational=True)
