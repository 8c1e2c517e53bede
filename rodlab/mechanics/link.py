"""The energy of one link, in SymPy, as terms that add [N 2.7].

    a = phi_{i-1}, b = phi_i      angles below and above the spring k with rest angle beta
    x, z                          place of the joint at the link's upper end
    h, w                          length of the link, weight of its angle in the rule (1 where the rule has none)
    lam                           the load

Every other name is a parameter of the term that uses it. V is the sum over the links.
"""

from dataclasses import dataclass

from sympy import Expr, Integer, Symbol, cos


@dataclass(frozen=True)
class Link:
    """A link as a bag of symbols: `link.a`, `link.k`, `link.anything`. `_weighted`: whether the rule has weights."""

    _weighted: bool = True

    def __getattr__(self, name: str) -> Expr:
        if name.startswith("_"):
            raise AttributeError(name)
        if name == "w" and not self._weighted:
            return Integer(1)
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
