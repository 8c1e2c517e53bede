"""The discrete strut [N 2.7]: n joints with springs, clamped at the foot, loaded on top.

    V(phi; lam) = sum_i k_i (phi_i - phi_{i-1} - beta_i)^2 / 2  +  lam height(phi)  +  its terms,   phi_0 = beta_0
    height      = h sum_i w_i cos(phi_i)  +  h (1 - w_n) cos(phi_0)

Unknowns phi_1..phi_n, shape (n,), in radians. Positive phi turns clockwise: x' = sin phi, z' = cos phi.
Cost of every method: O(n).
"""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics import joints as joints_of
from rodlab.mechanics import strut_ends
from rodlab.mechanics.ends import CANTILEVER, checked_ends, needs_reactions
from rodlab.mechanics.joints import Joints
from rodlab.mechanics.mirror import mirror
from rodlab.mechanics.profile import Profile
from rodlab.mechanics.recipe import changed, kept, recipe_of, said_of
from rodlab.mechanics.strut_energy import StrutEnergy
from rodlab.mechanics.terms import BENDING, BENDING_WITH_REST, END_LOAD, Term, checked
from rodlab.numerics.arrays import Array, vector
from rodlab.numerics.difference import Springs

if TYPE_CHECKING:
    from rodlab.mechanics.derivation import Derivation


class Strut(StrutEnergy):
    """A strut of n joints with bending stiffness K and unstressed curvature u_hat, of length 1.

    K, u_hat: a number, n numbers (one a joint), a function of an array s, or an expression in s. rule: "end" (the notes,
    order 1) or "trapezoid" (order 2, also across the jumps declared in `breaks`). phi0: angle of the clamp.
    terms: `self_weight(q)`, `foundation(c)`, `end_torque(tau)`, `end_force(N1)`, `shearable(A1, A3)`, `potential(U)` or your own
    `term(...)`. ends: of the foot and the top, "clamped", "hinged", "guided" (the angle held, the place not) or "free"; phi1: the
    angle, and offset: the place x that the top is held at (see `rodlab.mechanics.held`).
    Raises `ValueError`, in one sentence, for whatever is not of this form.

    >>> strut = Strut(n=3, u_hat=0.75)
    >>> strut.unstressed(), strut.gradient(strut.unstressed(), 0.0)
    (array([0.25, 0.5 , 0.75]), array([0., 0., 0.]))
    >>> strut.hessian([0.0, 0.0, 0.0], 5.0).index
    1
    """

    def __new__(cls, *_: Any, **given: Any) -> "Strut":
        """A strut of the kind that its ends ask for."""
        if cls is Strut and needs_reactions(_[7] if len(_) > 7 else given.get("ends"), given):
            from rodlab.mechanics.held_strut import HeldStrut

            return object.__new__(HeldStrut)
        return object.__new__(cls)

    def __init__(
        self,
        n: int = 100,
        K: Any = 1.0,
        u_hat: Any = 0.0,
        rule: str = "end",
        phi0: float = 0.0,
        breaks: Sequence[float] = (),
        terms: Sequence[Term] = (),
        ends: tuple[str, str] = CANTILEVER,  # noqa: ARG002  `__new__` saw to them
        phi1: float = 0.0,  # noqa: ARG002
        offset: float = 0.0,  # noqa: ARG002
    ) -> None:
        self.arguments = kept({"n": n, "K": K, "u_hat": u_hat, "rule": rule, "phi0": phi0, "breaks": breaks, "terms": terms})
        self._build(joints_of.by_rule(n, K, u_hat, rule, phi0, breaks), terms, breaks)

    @classmethod
    def from_joints(
        cls,
        k: Any,
        beta: Any = None,
        h: float = 1.0,
        beta0: float = 0.0,
        weights: Any = None,
        terms: Sequence[Term] = (),
        ends: tuple[str, str] = CANTILEVER,
        phi1: float = 0.0,
        offset: float = 0.0,
    ) -> "Strut":
        """The strut with these spring constants k (n,), rest angles beta (n,) and length h of a link.

        >>> Strut.from_joints(k=[1, 1]).hessian([0.0, 0.0], 1.0).toarray()
        array([[ 1., -1.],
               [-1.,  0.]])
        """
        strut = cls.__new__(cls)
        joints = joints_of.given(k, beta, h, beta0, weights)
        strut.arguments = kept({"k": k, "beta": beta, "h": h, "beta0": beta0, "weights": weights, "terms": terms})
        strut._build(joints, terms, ())
        if not needs_reactions(ends, {"phi1": phi1, "offset": offset}):
            return strut
        from rodlab.mechanics.held_strut import HeldStrut

        return HeldStrut.around(strut, checked_ends(ends), phi1, offset)

    def replace(self, **changes: Any) -> "Strut":
        """The same strut with other arguments, or other parameters of its terms.

        >>> Strut(n=3).replace(u_hat=0.5, rule="trapezoid")
        Strut(n=3, K=1.0, u_hat=0.5, rule='trapezoid')
        """
        arguments = changed(self.arguments, self.terms, changes)
        return Strut(**arguments) if "n" in arguments else Strut.from_joints(**arguments)

    @property
    def recipe(self) -> dict[str, Any] | None:
        """What to write into a file so that `rodlab.mechanics.recipe.build` makes this strut again; None for functions."""
        return recipe_of(self.arguments, self.terms)

    def vary(self, name: str, lam: float | None = None) -> Any:
        """The same strut at the load lam, with its parameter `name` in the place of the load; see `rodlab.vary`."""
        if name == "shortening":
            from rodlab.mechanics.held_strut import HeldStrut

            return HeldStrut.around(self, CANTILEVER).vary(name, lam)
        from rodlab.mechanics.varied import VariedStrut

        return VariedStrut(self, name, lam)

    def _build(self, joints: Joints, terms: Sequence[Term], breaks: Sequence[float]) -> None:
        self.joints = joints
        self.terms = checked(terms)
        self.springs = Springs(joints.k)
        self._bend(curved=joints.curved)
        self.x0 = 0.0  # of the foot
        self.last_foot: tuple[float, strut_ends.Foot] | None = None
        self.parameters: dict[str, Any] = {"k": joints.k, "beta": joints.beta, "h": joints.h, "w": joints.w}
        self.at_foot: dict[str, float] = {}
        for term in self.terms:
            for name, given in term.parameters.items():
                profile = Profile(name, given, tuple(breaks))
                self.parameters[name] = profile.at(joints.s) if profile.constant is None else profile.constant
                if profile.constant is None:
                    self.at_foot[name] = float(profile.at(np.zeros(1))[0] if profile.values is None else profile.values[0])
        if any(term.energy is not None for term in self.terms):
            self.kernel()  # what a term of one's own lacks is said at once

    def _bend(self, *, curved: bool) -> None:
        """Choose the springs' energy: without rest angles none occur in the kernel."""
        bend = BENDING_WITH_REST if curved else BENDING
        self.loaded = (bend, END_LOAD, *self.terms)
        self._unloaded = (bend, *self.terms)

    def with_joints(self, joints: Joints, parameters: dict[str, Any]) -> "Strut":
        """The same with other joints and parameters, rest angles in the kernel whether zero or not; what is derived is kept."""
        other = copy(self)
        other.joints, other.parameters = joints, parameters
        if joints.k is not self.joints.k:
            other.springs = Springs(joints.k)
        other._bend(curved=True)
        return other._renewed("_with_load", "_without_load")

    def under(self, **values: float) -> "Strut":
        """The same with these boundary values: phi0 and x0 of the foot, N1 and tau on the end."""
        other = copy(self)
        other.x0 = values.pop("x0", self.x0)
        if "phi0" in values:
            other.joints = replace(self.joints, phi0=values.pop("phi0"))
        other.parameters = {**self.parameters, **values}
        return other._renewed()

    def _renewed(self, *more: str) -> "Strut":
        """Itself without what was computed for other joints and parameters."""
        self.last_foot = None
        for name in ("places", "carried", "symmetries", *more):
            self.__dict__.pop(name, None)
        return self

    def __repr__(self) -> str:
        return f"Strut({said_of(self.arguments, self.n, self.terms)})"

    @property
    def flexibility(self) -> float:
        """How far a unit couple on the end turns it: the sum of 1 / k."""
        return self.springs.total_compliance

    @property
    def lever(self) -> float:
        """The most that a turn of one unknown moves the end: the longest link."""
        return self.joints.h * self.joints.most_weight

    @property
    def foot_angle(self) -> float:
        """The angle of the clamp."""
        return self.joints.phi0

    def inner(self, u: Array, v: Array) -> float:
        """h sum u_i v_i: the integral of u v over the length, so that a step means the same for every n."""
        return float(self.joints.h * (u @ v))

    def start(self, guess: Any = None) -> Array:
        """Angles (n,) from a guess: angles, a function of s, or None for the unstressed shape."""
        if guess is None:
            return self.unstressed()
        if callable(guess):
            guess = Profile("guess", guess).at(self.joints.s)
        return vector("guess", guess, self.n).copy()

    @property
    def measures(self) -> dict[str, Callable[[Array, float], float]]:
        """Name -> function of (u, lam): what a point can be asked for."""
        return {
            "tip_angle": lambda u, _: float(u[-1]),
            "height": lambda u, lam: self.boundary("lam", u, lam),
            "energy": self.energy,
        }

    # --- shape --------------------------------------------------------------------------------------------------

    def unstressed(self) -> Array:
        """phi_hat_i = beta_0 + ... + beta_i [N 2.7]: the equilibrium without load and terms, shape (n,)."""
        return np.asarray(self.joints.phi0 + np.cumsum(self.joints.beta))

    @property
    def is_straight(self) -> bool:
        """True when phi = 0 is an equilibrium at every load."""
        if self.joints.curved or self.joints.phi0:
            return False
        zero = np.zeros(self.n)
        return not (self.gradient(zero, 0.0).any() or self.gradient(zero, 1.0).any())

    @cached_property
    def symmetries(self) -> tuple[Callable[[Array], Array], ...]:
        """Maps of the angles that take equilibria to equilibria: the mirror image, where the energy is the same for it."""
        return mirror(self, self.n)

    def height(self, phi: Any) -> float:
        """z of the tip."""
        j = self.joints
        c = np.cos(phi)
        return float(j.h * (np.sum(c if j.weights is None else j.w * c) + (1 - j.last_weight) * np.cos(j.phi0)))

    def shape(self, phi: Any) -> tuple[Array, Array]:
        """x, z of the n + 1 joints from the clamp (0, 0) to the tip."""
        x, z = self.places.of(vector("phi", phi, self.n))
        return np.append(0.0, x), np.append(0.0, z)

    def shape_at(self, u: Array, lam: float) -> tuple[Array, Array, Array, Array]:
        """s, phi and x, z of the n + 1 joints under a load, by which they may be sheared and extended."""
        x, z = strut_ends.reach(self, u, lam)
        return *self.nodes(u), np.append(self.x0, x), np.append(0.0, z)

    def nodes(self, phi: Array) -> tuple[Array, Array]:
        """s and phi of the n + 1 joints, the clamp first."""
        return np.append(0.0, self.joints.s), np.append(self.joints.phi0, phi)

    def derivation(self, n: int = 3) -> "Derivation":
        """SymPy's energy, gradient and Hessian of this strut with n joints, and the source of its kernel."""
        from rodlab.mechanics.derivation import derivation_of

        return derivation_of(self, n)
