"""A rod at a fixed load with another of its parameters in the load's place: equations F(u, value) = 0.

As for a strut (`varied`) a number is followed itself, a profile by its amplitude, 1 being as given. The residual is linear in
K and in u_hat; the clamp's angle enters as the first node does.
"""

from collections.abc import Callable, Sequence
from copy import copy
from functools import partial
from typing import TYPE_CHECKING, Any

from rodlab.mechanics import bounds, remesh
from rodlab.mechanics.profile import Profile
from rodlab.mechanics.terms import BENDING_WITH_REST, END_LOAD
from rodlab.numerics.arrays import Array, number
from rodlab.numerics.collocation import Grid
from rodlab.numerics.inertia import Inertia

if TYPE_CHECKING:
    from rodlab.mechanics.rod import Rod


class VariedRod:
    """The equations of `rod` at the load `lam`, followed in the parameter `name`; made by `rodlab.vary`.

    >>> from rodlab.mechanics.rod import Rod
    >>> bent = VariedRod(Rod(), "u_hat", 1.0)
    >>> bent.at(0.5), bent.value
    (Rod(K=1.0, u_hat=0.5), 0.0)
    """

    def __init__(self, rod: "Rod", name: str, lam: float | None) -> None:
        own = [p for term in rod.terms for p in term.parameters]
        known = ["K", "u_hat", "phi0", *own]
        if name not in known:
            raise ValueError(f"name must be a parameter of the rod, one of {', '.join(known)}; it is {name!r}")
        if lam is None:
            raise ValueError(f"lam must be given where {name} is followed: the load that stays")
        self.rod, self.name, self.lam = rod, name, number("lam", lam)
        self.profile: Profile | None = None if name == "phi0" else rod.profiles[name]
        self.scalar = self.profile is None or self.profile.constant is not None
        self.value = 1.0 if not self.scalar else rod.phi0 if self.profile is None else float(self.profile.constant or 0.0)
        self._last: tuple[float, Rod] | None = None

    def __repr__(self) -> str:
        return f"VariedRod({self.rod!r}, {self.name!r}, lam={self.lam:g})"

    @property
    def is_straight(self) -> bool:
        """True when phi = 0 is an equilibrium at every value."""
        return all(self.sharing(value).is_straight for value in (1.0, 2.0))

    @property
    def recipe(self) -> dict[str, Any] | None:
        """What to write into a file so that this can be made again; None for functions."""
        rod = self.rod.recipe
        return None if rod is None else {**rod, "vary": self.name, "lam": self.lam}

    def at(self, value: float) -> "Rod":
        """The rod with this value of the parameter."""
        value = number("value", value)
        if self.scalar:
            return self.rod.replace(**{self.name: value})
        given = self.profile.given if self.profile is not None else None
        if isinstance(given, str):
            return self.rod.replace(**{self.name: f"({value!r})*({given})"})
        return self.rod.replace(**{self.name: lambda s: value * given(s)})  # type: ignore[misc]

    def under(self, lam: float, **values: float) -> "VariedRod":
        """The same under another load and these boundary values."""
        other = copy(self)
        other.rod, other.lam, other._last = self.rod.under(**values), lam, None
        return other

    def _unit(self, rod: "Rod") -> Any:
        """The parameter at Gauss's points of a rod's mesh, at the value 1."""
        return 1.0 if self.scalar or self.profile is None else self.profile.at(rod.grid.s)

    def sharing(self, value: float) -> "Rod":
        """The same on this mesh, sharing all that does not change."""
        if self._last is not None and self._last[0] == value:
            return self._last[1]
        rod = self.rod.fresh()
        if self.name == "phi0":
            rod.phi0 = value
        else:
            if self.name == "K" and not value > 0:
                raise ValueError(f"K must stay positive; it came to {value:g}")
            rod.profiles = {**rod.profiles, self.name: _scaled(rod.profiles[self.name], value, scalar=self.scalar)}
            rod.parameters = {**rod.parameters, self.name: value * self._unit(rod)}
        if self.name == "u_hat":
            rod.loaded, rod._unloaded = (BENDING_WITH_REST, END_LOAD, *rod.terms), (BENDING_WITH_REST, *rod.terms)
        self._last = (value, rod)
        return rod

    def _on(self, rod: "Rod") -> "VariedRod":
        """The same equations on another mesh."""
        other = copy(self)
        other.rod, other._last = self.rod.on(rod.mesh, rod.degree), None
        other.rod.expected, other.rod.stuck = rod.expected, rod.stuck
        return other

    def on(self, mesh: Array, degree: int | None = None) -> "VariedRod":
        """The same on another mesh, or with another degree."""
        return self._on(self.rod.on(mesh, degree))

    @property
    def degree(self) -> int:
        """The rod's."""
        return self.rod.degree

    @property
    def grid(self) -> Grid:
        """The rod's."""
        return self.rod.grid

    @property
    def mesh(self) -> Array:
        """The rod's."""
        return self.rod.mesh

    def on_points(self, points: Sequence[float]) -> "VariedRod":
        """The same equations on the mesh of these points, as a recipe holds them."""
        return self._on(self.rod.on_points(points))

    def acting(self, u: Array, value: float) -> "tuple[Rod, Array, float]":
        """The rod with this value, its angles, and the load on it."""
        return self.sharing(value), u, self.lam

    # --- the equations -----------------------------------------------------------------------------------------

    def residual(self, u: Array, value: float) -> Array:
        """The gradient of the energy at the fixed load."""
        return self.sharing(value).residual(u, self.lam)

    def residual_wide(self, u: Array, value: float) -> Array:
        """The same to more digits."""
        return self.sharing(value).residual_wide(u, self.lam)

    def jacobian(self, u: Array, value: float) -> Any:
        """The Hessian."""
        return self.sharing(value).jacobian(u, self.lam)

    def d_lam(self, u: Array, value: float) -> Array:
        """d(gradient)/d(value), shape (N m,)."""
        rod = self.sharing(value)
        if self.name == "phi0":
            return rod.column("phi0", u, self.lam)
        return rod.by(self.name, u, self.lam, self._unit(rod))

    def inner(self, u: Array, v: Array) -> float:
        """That of the rod."""
        return self.rod.inner(u, v)

    # --- what more the rod knows ----------------------------------------------------------------------------------

    @property
    def measures(self) -> dict[str, Callable[[Array, float], float]]:
        """The rod's, at the fixed load."""
        return {name: partial(self._measure, name) for name in self.rod.measures}

    def _measure(self, name: str, u: Array, value: float) -> float:
        return float(self.sharing(value).measures[name](u, self.lam))

    def seen(self, u: Array) -> Array:
        """As the rod's."""
        return self.rod.seen(u)

    def lipschitz(self, u: Array, value: float) -> bounds.Bound:
        """As the rod's; known where the parameter takes no part in the Hessian: u_hat and an end torque."""
        if self.name not in ("u_hat", "tau"):
            return bounds.unknown
        bound = self.sharing(value).lipschitz(u, self.lam)

        def unmoved(moved: Any, _: float) -> tuple[Any, Any]:
            return bound(moved, 0.0)[0], 0.0

        return unmoved

    def embedding(self, value: float) -> tuple[float, float]:
        """As the rod's."""
        return self.sharing(value).embedding(self.lam)

    def rounding(self, u: Array, value: float, v: Array) -> float:
        """As the rod's."""
        return self.sharing(value).rounding(u, self.lam, v)

    def error(self, u: Array, value: float) -> float:
        """As the rod's."""
        return self.sharing(value).error(u, self.lam)

    def inertia(self, u: Array, value: float) -> Inertia:
        """As the rod's."""
        return self.sharing(value).inertia(u, self.lam)

    def missed(self, u: Array, value: float, v: Array) -> tuple[float, float]:
        """As the rod's."""
        return self.sharing(value).missed(u, self.lam, v)

    def adapted(self, u: Array, value: float, tangent: Array | None = None) -> "tuple[VariedRod, Array, Array | None] | None":
        """The same on a mesh that serves; None where its own does."""
        better = remesh.adapted(self.sharing(value), u, self.lam, tangent)
        return None if better is None else (self._on(better[0]), better[1], better[2])

    def moved(self, other: "VariedRod", u: Array, *, direction: bool = False) -> Array:
        """As the rod's."""
        return self.rod.moved(other.rod, u, direction=direction)

    def start(self, guess: Any = None) -> Array:
        """As the rod's."""
        return self.rod.start(guess)

    def shape_at(self, u: Array, value: float) -> tuple[Array, Array, Array, Array]:
        """As the rod's."""
        return self.sharing(value).shape_at(u, self.lam)

    def between(self, u: Array, value: float, s: Array) -> tuple[Array, Array, Array]:
        """As the rod's."""
        return self.sharing(value).between(u, self.lam, s)


def _scaled(profile: Profile, value: float, *, scalar: bool) -> Profile:
    """The profile with another value, or amplitude."""
    if scalar:
        return Profile(profile.name, value)
    other = copy(profile)
    function = profile.function
    assert function is not None
    other.function = lambda s: value * function(s)
    return other
