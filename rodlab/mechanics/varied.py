"""A strut at a fixed load with another of its parameters in the load's place: equations F(u, value) = 0.

    value of a number        K, u_hat, phi0, q, tau, ...       the number itself
    value of a profile       an array, a function of s         its amplitude: 1 is the strut as given

Spring constants and rest angles are proportional to the value; the derivative of the residual is SymPy's, as the load's is.
"""

from collections.abc import Callable
from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics import bounds
from rodlab.mechanics.assembly import balance, full
from rodlab.numerics.arrays import Array, number

if TYPE_CHECKING:
    from rodlab.mechanics.strut import Strut

ARRAY = {"K": "k", "k": "k", "u_hat": "beta", "beta": "beta"}  # the joints' array that is proportional to the value
CLAMP = ("phi0", "beta0")


class VariedStrut:
    """The equations of `strut` at the load `lam`, followed in the parameter `name`; made by `rodlab.vary`.

    >>> from rodlab.mechanics.strut import Strut
    >>> bent = VariedStrut(Strut(n=4), "u_hat", 1.0)
    >>> bent.at(0.5), bent.value
    (Strut(n=4, K=1.0, u_hat=0.5, rule='end'), 0.0)
    """

    def __init__(self, strut: "Strut", name: str, lam: float | None) -> None:
        own = [p for term in strut.terms for p in term.parameters]
        known = [n for n in (*ARRAY, *CLAMP) if n in strut.arguments] + own
        if name not in known:
            raise ValueError(f"name must be a parameter of the strut, one of {', '.join(known)}; it is {name!r}")
        if lam is None:
            raise ValueError(f"lam must be given where {name} is followed: the load that stays")
        self.strut, self.name, self.lam = strut, name, number("lam", lam)
        given = next((t.parameters[name] for t in strut.terms if name in t.parameters), strut.arguments.get(name))
        if given is None:
            raise ValueError(f"{name} must be given to be followed; this strut has none. Rest angles of one: beta=[1, 0, ...]")
        self.scalar = not isinstance(given, str) and not callable(given) and np.ndim(given) == 0
        self._profile = given
        self.value = float(given) if self.scalar else 1.0
        self.unit = self._unit()
        self._last: tuple[float, Strut] | None = None

    def __repr__(self) -> str:
        return f"VariedStrut({self.strut!r}, {self.name!r}, lam={self.lam:g})"

    @property
    def is_straight(self) -> bool:
        """True when phi = 0 is an equilibrium at every value."""
        return all(self.sharing(value).is_straight for value in (1.0, 2.0))

    @property
    def recipe(self) -> dict[str, Any] | None:
        """What to write into a file so that this can be made again; None for functions."""
        strut = self.strut.recipe
        return None if strut is None else {**strut, "vary": self.name, "lam": self.lam}

    def _unit(self) -> Any:
        """The joints' array (or the term's parameter) at the value 1."""
        if self.name in CLAMP:
            return 1.0
        one = self.strut.replace(**{self.name: 1.0}) if self.scalar else self.strut
        array = ARRAY.get(self.name, self.name)
        return one.parameters[array]

    def at(self, value: float) -> "Strut":
        """The strut with this value of the parameter."""
        value = number("value", value)
        if self.scalar:
            return self.strut.replace(**{self.name: value})
        if value == 1:
            return self.strut
        if isinstance(self._profile, str):
            return self.strut.replace(**{self.name: f"({value!r})*({self._profile})"})
        if callable(self._profile):
            profile: Callable[[Any], Any] = self._profile
            return self.strut.replace(**{self.name: lambda s: value * profile(s)})
        return self.strut.replace(**{self.name: value * np.asarray(self._profile)})

    def sharing(self, value: float) -> "Strut":
        """The same, sharing all that does not change."""
        if self._last is not None and self._last[0] == value:
            return self._last[1]
        joints, parameters = self.strut.joints, dict(self.strut.parameters)
        if self.name in CLAMP:
            joints = replace(joints, phi0=value)
        else:
            array = ARRAY.get(self.name, self.name)
            parameters[array] = value * self.unit
            if array in ("k", "beta"):
                if array == "k" and not value > 0:
                    raise ValueError(f"{self.name} must stay positive; it came to {value:g}")
                joints = replace(joints, **{array: parameters[array]})
        strut = self.strut.with_joints(joints, parameters)
        self._last = (value, strut)
        return strut

    def under(self, lam: float, **values: float) -> "VariedStrut":
        """The same under another load and these boundary values."""
        other = copy(self)
        other.strut, other.lam, other._last = self.strut.under(**values), lam, None
        return other

    def acting(self, u: Array, value: float) -> "tuple[Strut, Array, float]":
        """The strut with this value, its angles, and the load on it."""
        return self.sharing(value), u, self.lam

    # --- the equations ------------------------------------------------------------------------------------------

    def residual(self, u: Array, value: float) -> Array:
        """The gradient of the energy at the fixed load."""
        return self.sharing(value).gradient(u, self.lam)

    def jacobian(self, u: Array, value: float) -> Any:
        """The Hessian."""
        return self.sharing(value).hessian(u, self.lam)

    second_variation = jacobian

    def d_lam(self, u: Array, value: float) -> Array:
        """d(gradient)/d(value), shape (n,)."""
        strut = self.sharing(value)
        if self.name in CLAMP:
            return strut.column("phi0", u, self.lam)
        link, array = strut.kernel(), ARRAY.get(self.name, self.name)
        given = {name: strut.parameters[name] for name in link.parameters}
        below = np.append(strut.joints.phi0, u[:-1])
        m, f = (np.asarray(part) * self.unit for part in getattr(link, f"moments_{array}")(below, u, self.lam, **given))
        g = balance(full(m, strut.n), f, u)
        if link.places:
            forces = getattr(link, f"forces_{array}")(*strut.places.of(u, strut.x0), **given)
            g += strut.places.moments(u, *(np.asarray(force) * self.unit for force in forces))
        return g

    def inner(self, u: Array, v: Array) -> float:
        """That of the strut."""
        return self.strut.inner(u, v)

    # --- what more the strut knows --------------------------------------------------------------------------------

    @property
    def measures(self) -> dict[str, Callable[[Array, float], float]]:
        """The strut's, at the fixed load."""
        return {
            "tip_angle": lambda u, _: float(u[-1]),
            "height": lambda u, value: self.sharing(value).boundary("lam", u, self.lam),
            "energy": lambda u, value: float(self.sharing(value).energy(u, self.lam)),
        }

    def lipschitz(self, u: Array, value: float) -> bounds.Bound:
        """As the strut's; known where the parameter takes no part in the Hessian: rest angles, the clamp, an end torque."""
        if self.name not in ("u_hat", "beta", "phi0", "beta0", "tau"):
            return bounds.unknown
        bound = self.sharing(value).lipschitz(u, self.lam)

        def unmoved(du: Any, _: float) -> tuple[Any, Any]:
            return bound(du, 0.0)[0], 0.0

        return unmoved

    def embedding(self, value: float) -> tuple[float, float]:
        """As the strut's."""
        return self.sharing(value).embedding(self.lam)

    def rounding(self, u: Array, value: float, v: Array) -> float:
        """As the strut's."""
        return self.sharing(value).rounding(u, self.lam, v)

    def start(self, guess: Any = None) -> Array:
        """As the strut's."""
        return self.strut.start(guess)

    def shape_at(self, u: Array, value: float) -> tuple[Array, Array, Array, Array]:
        """s, phi and x, z of the shape at a value of the parameter, which may be the clamp's angle."""
        return self.sharing(value).shape_at(u, self.lam)
