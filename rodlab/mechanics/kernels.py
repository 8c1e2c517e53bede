"""The kernel of a sum of terms: shipped for the standard ones, else derived and compiled when first asked for."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, Protocol

from rodlab.mechanics import standard
from rodlab.mechanics.terms import Term
from rodlab.numerics.arrays import Array


class Kernel(Protocol):
    """Plain numpy functions of the links' angles a, b (n,), the load, and the parameters by name.

    `energy`, `moments` (m, f), `stiffness` (k, c, c_below), `moments_lam` (dm/dlam, df/dlam), `reach` (dx, dz) of a link and
    `yielding`, the second derivatives in the loads lam and N1; where `places`
    (the energy depends on the place; `aside`: on x),
    also `forces` (e_x, e_z) and, where `hardens`, `hardening` (e_xx, e_xz, e_zz), of the joints' x, z (n,).
    `moments_k`, `forces_q`, ...: the same differentiated in a parameter.
    """

    parameters: tuple[str, ...]
    places: bool
    aside: bool
    hardens: bool
    yields: bool

    def energy(self, *angles: Any, **parameters: Any) -> Any: ...
    def moments(self, a: Array, b: Array, lam: float, **parameters: Any) -> Any: ...
    def stiffness(self, a: Array, b: Array, lam: float, **parameters: Any) -> Any: ...
    def moments_lam(self, a: Array, b: Array, lam: float, **parameters: Any) -> Any: ...
    def reach(self, a: Array, b: Array, lam: float, **parameters: Any) -> Any: ...
    def yielding(self, a: Array, b: Array, lam: float, **parameters: Any) -> Any: ...
    def moments_N1(self, a: Array, b: Array, lam: float, **parameters: Any) -> Any: ...
    def forces(self, x: Array, z: Array, **parameters: Any) -> Any: ...
    def hardening(self, x: Array, z: Array, **parameters: Any) -> Any: ...


def kernel(terms: Sequence[Term], *, weighted: bool) -> Kernel:
    """The kernel of a sum of terms; SymPy is imported only when it is not among the shipped ones."""
    shipped: Kernel | None = _shipped("KERNELS", terms, "_weighted" if weighted else "")
    if shipped is not None:
        return shipped
    return _derived(tuple((term.name, tuple(term.parameters), term.energy) for term in terms), weighted)


def density(terms: Sequence[Term]) -> Any:
    """The kernel of the limit of a sum of terms: functions of phi', phi, the load and the parameters, of any one shape."""
    shipped = _shipped("DENSITIES", terms)
    if shipped is not None:
        return shipped
    return _derived_limit(tuple((term.name, tuple(term.parameters), term.energy) for term in terms))


def _shipped(table: str, terms: Sequence[Term], suffix: str = "") -> Any:
    """The kernel in the shipped tables, the second of which is read only where the first has none; None where neither has."""
    if any(term.energy is not None for term in terms):
        return None
    name = ("limit_of_" if table == "DENSITIES" else "") + "_and_".join(term.name for term in terms) + suffix
    if name in getattr(standard, table):
        return getattr(standard, table)[name]
    from rodlab.mechanics import standard_loads

    return getattr(standard_loads, table).get(name)


Recipe = tuple[tuple[str, tuple[str, ...], Any], ...]


@lru_cache(maxsize=64)
def _derived_limit(recipe: Recipe) -> Any:
    from rodlab.mechanics.limit import limit

    terms = _terms(recipe)
    return _compiled(limit(terms), terms)


@lru_cache(maxsize=64)
def _derived(recipe: Recipe, weighted: bool) -> Kernel:
    from rodlab.mechanics.derive import derive

    terms = _terms(recipe)
    compiled: Kernel = _compiled(derive(terms, weighted=weighted), terms)
    return compiled


def _terms(recipe: Recipe) -> list[Term]:
    return [Term(name, dict.fromkeys(names), energy) for name, names, energy in recipe]


def _compiled(derivation: Any, terms: Sequence[Term]) -> Any:
    """The class that a derivation's source defines."""
    from rodlab.mechanics.derive import HEADER

    namespace: dict[str, Any] = {}
    try:
        source = derivation.source
    except NotImplementedError as error:  # SymPy's printer: DiracDelta, say, from the derivative of a kink
        names = ", ".join(term.name for term in terms if term.energy)
        raise ValueError(f"the energy of {names} must be smooth, of functions that numpy has; {error}".split("\n")[0]) from None
    exec("from numpy import *\n" + HEADER + source, namespace)  # noqa: S102  our own generated text
    return namespace[derivation.name]
