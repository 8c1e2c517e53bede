"""Loads are terms of the energy that are added; a term that is absent costs nothing. Imports no SymPy.

    strut = Strut(n=100, terms=(self_weight(1.0), end_torque(0.2)))

A term of your own is a function of a link (`rodlab.mechanics.link`) that returns its SymPy energy:

    def wind(link):
        return -link.p * link.h * link.w * link.x
    strut = Strut(n=100, terms=(term(wind, p=0.3),))
"""

import keyword
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rodlab.mechanics.expression import Expression
from rodlab.numerics.arrays import number


@dataclass(frozen=True)
class Potential:
    """The energy of a link in a potential of the place; equal for equal texts, so that it is derived once."""

    U: str

    def __call__(self, link: Any) -> Any:
        from rodlab.mechanics.link import potential

        return potential(link, self.U)


@dataclass(frozen=True)
class Term:
    """One term of a link's energy: its name, its parameters, and its energy unless the name says it.

    A parameter is a number, one number a joint, a function of s, or an expression in s.
    """

    name: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    energy: Callable[[Any], Any] | None = None

    @property
    def arguments(self) -> dict[str, Any]:
        """What the term was made of: its parameters, or the text of its potential."""
        return {"U": self.energy.U} if isinstance(self.energy, Potential) else dict(self.parameters)

    @property
    def own(self) -> bool:
        """True where the energy is a function that no file could hold."""
        return self.energy is not None and not isinstance(self.energy, Potential)

    def __repr__(self) -> str:
        return f"{self.name}({', '.join(f'{k}={v!r}' for k, v in self.arguments.items())})"


BENDING = Term("bending")
BENDING_WITH_REST = Term("bending_with_rest")
END_LOAD = Term("end_load")
END_FORCE = Term("end_force", {"N1": 0.0})


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


def end_force(N1: float) -> Term:
    """A dead force N1 along x on the free end, beside the load that presses down: energy -N1 x(1).

    >>> end_force(-0.1)
    end_force(N1=-0.1)
    """
    return Term("end_force", {"N1": number("N1", N1)})


def shearable(A1: float = math.inf, A3: float = math.inf, *, shear: Any = None, extension: Any = None) -> Term:
    """A rod that shears and extends: stiffnesses A1 across and A3 along it, infinite where it does not [N 2.8, exercise].

    Or their inverses, `shear` = 1 / A1 and `extension` = 1 / A3, which may be functions of s. The strains are eliminated: each is
    that of the forces of the dead end loads, so that no other load may act on the rod's length.

    >>> shearable(A3=50.0)
    shearable(shear=0.0, extension=0.02)
    """
    given = {"shear": shear, "extension": extension}
    for name, own, stiffness in (("A1", "shear", A1), ("A3", "extension", A3)):
        if given[own] is None:
            if isinstance(stiffness, str) or not (np.ndim(stiffness) == 0 and stiffness > 0):
                raise ValueError(f"{name} must be positive, or infinite; it is {stiffness!r}")
            given[own] = 1 / float(stiffness)
    return Term("shearable", given)


def potential(U: str) -> Term:
    """A potential of the place, U a length of the rod: an expression in x and z as a string, such as "z**2" or "exp(-x)*z".

    >>> potential("sin(z)")
    potential(U='sin(z)')
    """
    if not isinstance(U, str):
        raise ValueError(f"U must be an expression in x and z as a string; it is {U!r:.60}")
    try:
        Expression(U, ("x", "z"))
    except ValueError as error:
        raise ValueError(f"U: {error}") from None
    return Term("potential", {}, Potential(U))


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
    taken: dict[str, str] = dict.fromkeys(("a", "b", "x", "z", "lam", "k", "beta", "h", "w", "phi", "phi_s"), "the model")
    for term in given:
        if not isinstance(term, Term):
            raise ValueError(
                "terms must be made by self_weight, foundation, end_torque, end_force, shearable, potential or term;"
                f" one is {term!r}"
            )
        for name in term.parameters:
            if name.startswith("_") or keyword.iskeyword(name) or hasattr(np, name) or re.fullmatch(r"t\d+", name):
                raise ValueError(f"the parameter {name} of {term.name} must have a name that numpy and the kernel do not use")
            if name == "N1" and term.name != "end_force":
                raise ValueError(
                    f"the parameter N1 of {term.name} is the dead force on the end; give end_force(N1) as well, and use it"
                )
            if name in taken:
                raise ValueError(f"the parameter {name} of {term.name} is already that of {taken[name]}; give each once")
            taken[name] = term.name
    return given
