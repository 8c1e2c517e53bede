"""The strut between other ends than clamped and free: `rodlab.mechanics.held` on a strut."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rodlab.mechanics.ends import CANTILEVER, checked_ends, held_arguments, reactions_of
from rodlab.mechanics.held import Held
from rodlab.mechanics.recipe import recipe_of, said_of
from rodlab.mechanics.strut import Strut
from rodlab.mechanics.terms import Term
from rodlab.mechanics.varied import VariedStrut
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.constrained import Constrained
from rodlab.numerics.inertia import Inertia


class HeldStrut(Held, Strut):  # type: ignore[misc]  # what no bound is known for is None
    """A strut whose ends are held otherwise; made by `Strut(..., ends=...)`. Unknowns u: its reactions, then its angles.

    >>> Strut(n=4, ends=("clamped", "hinged"))
    Strut(n=4, K=1.0, u_hat=0.0, rule='end', ends=('clamped', 'hinged'))
    """

    def __init__(
        self,
        n: int = 100,
        K: Any = 1.0,
        u_hat: Any = 0.0,
        rule: str = "end",
        phi0: float = 0.0,
        breaks: Sequence[float] = (),
        terms: Sequence[Term] = (),
        ends: tuple[str, str] = CANTILEVER,
        phi1: float = 0.0,
        offset: float = 0.0,
    ) -> None:
        ends = checked_ends(ends)
        super().__init__(n, K, u_hat, rule, phi0, breaks, terms)
        self._hold(Strut(n, K, u_hat, rule, phi0, breaks, (*self.terms, *reactions_of(ends, self.terms))), ends, phi1, offset)
        self.arguments |= held_arguments(ends, phi1, offset)

    @classmethod
    def around(cls, strut: Strut, ends: tuple[str, str], phi1: float = 0.0, offset: float = 0.0) -> "HeldStrut":
        """The strut of these joints between other ends."""
        held = object.__new__(cls)
        held.__dict__.update(strut.__dict__)
        terms = (*strut.terms, *reactions_of(ends, strut.terms))
        held._hold(strut.replace(terms=terms) if len(terms) > len(strut.terms) else strut, ends, phi1, offset)
        held.arguments = {**strut.arguments, **held_arguments(ends, phi1, offset)}
        return held

    def at(self, value: float) -> Strut:
        """The strut with this value of what is followed."""
        if self._varied is not None:
            return VariedStrut(Strut.replace(self), self.follows, 0.0).at(value)
        return Strut.replace(self, **{self.follows: value})

    def __repr__(self) -> str:
        return self._said(f"Strut({said_of(self.arguments, self.n, self.terms)}")

    @property
    def recipe(self) -> dict[str, Any] | None:
        """What to write into a file so that `rodlab.mechanics.recipe.build` makes this strut again; None for functions."""
        return self._recipe(recipe_of(self.arguments, self.terms))

    # --- what a point asks -------------------------------------------------------------------------------------------

    def inertia(self, u: Array, value: float) -> Inertia:
        """Signs of the eigenvalues of the second variation on the directions that keep what is given, for all states near u."""
        matrix = self.jacobian(u, value)
        model, phi, lam = self.acting(u, value)
        with np.errstate(all="ignore"):
            step = np.abs(matrix.solve(self.residual(u, value)))
        off = 2 * float(self.angles(step).max()) + 4 * EPS * float(np.abs(phi).max(initial=0.0))
        loads = 2 * float(step[: len(self.unknowns)].max(initial=0.0))
        slack = model.lipschitz(phi, lam)(off, loads)[0] if np.isfinite(off + loads) else np.inf
        if not np.isfinite(slack).all():  # no bound is known for a term of one's own: ten times what is seen
            if not np.isfinite(off + loads):
                return Inertia(0, phi.size, 0)
            moved = (model.jacobian(phi + side * max(off, 1e-6), lam).toarray() for side in (1, -1))
            here = model.jacobian(phi, lam).toarray()
            slack = 10 * max(np.abs(other - here).sum(axis=1).max() for other in moved) * off / max(off, 1e-6)
        if isinstance(matrix, Constrained):
            matrix.noise = self.blurred(off)
        known: Inertia = matrix.inertia(slack)
        return known

    def observed(self, u: Array) -> int:
        """Which unknown a point's error is of: the angle of the tip; where that is held the largest other, or the couple."""
        m = len(self.unknowns)
        if "tau" not in self.unknowns:
            return -1
        return m + int(np.abs(u[m:-1]).argmax()) if u.size - m > 1 else self.unknowns.index("tau")

    def shape_at(self, u: Array, lam: float) -> tuple[Array, Array, Array, Array]:
        """s, phi and x, z of the n + 1 joints."""
        model, phi, load = self.acting(u, lam)
        shape: tuple[Array, Array, Array, Array] = model.shape_at(phi, load)
        return shape
