"""Loads are terms of the energy that are added; a term that is absent costs nothing. Imports no SymPy.

    strut = Strut(n=100, terms=(self_weight(1.0), end_torque(0.2)))

A term of your own is a function of a link (`rodlab.mechanics.link`) that returns its SymPy energy:

    def wind(link):
        return -link.p * link.h * link.w * link.x
    strut = Strut(n=100, terms=(term(wind, p=0.3),))
"""

import keyword
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rodlab.numerics.arrays import number


@dataclass(frozen=True)
class Term:
    """One term of a link's energy: its name, its parameters, and its energy unless the name says it.

    A parameter is a number, one number a joint, a function of s, or an expression in s.
    """

    name: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    energy: Callable[[Any], Any] | None = None

    def __repr__(self) -> str:
        return f"{self.name}({', '.join(f'{k}={v!r}' for k, v in self.parameters.items())})"


BENDING = Term("bending")
BENDING_WITH_REST = Term("bending_with_rest")
END_LOAD = Term("end_load")


def self_weight(q: Any) -> Term:
    """Dead weight q per unit length, positive downwards: energy the integral of q z.

    The straight column buckles under its own weight at q L^3 / (E I) = 7.8373 [Greenhill 1881].

    >>> self_weight(2.0)
    self_weight(q=2.0)
    """
    return Term("self_weight", {"q": q})


def foundation(c: Any) -> Term:
    """Winkler's elastic foundation: lateral force -c x per unit length, energy the integral of c x^2 / 2.

    >>> foundation("1 + s")
    foundation(c='1 + s')
    """
    return Term("foundation", {"c": c})


def end_torque(tau: float) -> Term:
    """A couple tau about e_2 on the free end [N 2.6]: m(1) = tau, energy -tau (phi(1) - phi(0)).

    >>> end_torque(0.5)
    end_torque(tau=0.5)
    """
    return Term("end_torque", {"tau": number("tau", tau)})


def term(energy: Callable[[Any], Any], **parameters: Any) -> Term:
    """A term of your own: `energy(link)` returns the SymPy energy of one link, with its parameters by name.

    >>> def wind(link):
    ...     return -link.p * link.h * link.x
    >>> term(wind, p=0.3)
    wind(p=0.3)
    """
    if not callable(energy):
        raise ValueError(f"energy must be a function of a link; it is {energy!r}")
    name = re.sub(r"\W", "_", getattr(energy, "__name__", "term"))  # a lambda has none that Python would take
    return Term(name, dict(parameters), energy)


def checked(terms: Any) -> tuple[Term, ...]:
    """The terms as a tuple, or one sentence about the first that is none or whose parameters are taken."""
    given: tuple[Any, ...] = tuple(terms) if isinstance(terms, (tuple, list)) else (terms,)
    taken: dict[str, str] = dict.fromkeys(("a", "b", "x", "z", "lam", "k", "beta", "h", "w"), "the strut")
    for term in given:
        if not isinstance(term, Term):
            raise ValueError(f"terms must be made by self_weight, foundation, end_torque or term; one is {term!r}")
        for name in term.parameters:
            if name.startswith("_") or keyword.iskeyword(name) or hasattr(np, name) or re.fullmatch(r"t\d+", name):
                raise ValueError(f"the parameter {name} of {term.name} must have a name that numpy and the kernel do not use")
            if name in taken:
                raise ValueError(f"the parameter {name} of {term.name} is already that of {taken[name]}; give each once")
            taken[name] = term.name
    return given
