"""Any parameter of a model as the one that is followed: the same equations, another question."""

from copy import copy
from typing import Any

import numpy as np

from rodlab.analysis.derivatives import central
from rodlab.analysis.equations import Equations, jacobian, started
from rodlab.numerics.arrays import Array, number


def vary(model: Any, name: str, lam: float | None = None) -> Any:
    """The same model at the load lam, with its parameter `name` in the place of the load.

    A strut has K, u_hat, phi0 (or k, beta, beta0) and the parameters of its terms. A number is followed itself, a profile
    by its amplitude, 1 being as given. So are the angle phi1 and the place offset of a held top; and the "shortening", how far
    the end is pressed down, whose reaction the load then is, so that no lam is given. Any other model needs the parameter as
    an attribute that is a number; its derivative is then taken by differences. `varied.at(value)` is the model with that value.
    Raises `ValueError` for a name that the model does not have.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> from rodlab.analysis.follow import follow
    >>> from rodlab.mechanics.strut import Strut
    >>> bent = vary(Strut(n=20), "u_hat", lam=1.0)
    >>> b = follow(equilibrium(bent, 0.0), to=0.5)
    >>> round(b.points[-1].tip_angle, 6)
    0.777155
    """
    own = getattr(model, "vary", None)
    return own(name, lam) if own is not None else Varied(model, name, number("lam", lam))


class Family:
    """A model at every load and every value of one of its parameters: equations F(u, lam, value) = 0.

    Raises `ValueError` for a name that the model does not have.
    """

    def __init__(self, model: Any, name: str) -> None:
        self.name, self._varied = name, vary(model, name, 0.0)
        self.value = float(self._varied.value)

    def at(self, value: float) -> Any:
        """The model with this value of the parameter, on the same mesh."""
        sharing = getattr(self._varied, "sharing", self._varied.at)
        return sharing(value)

    def d_value(self, u: Array, lam: float, value: float) -> Array:
        """dF/d(value), shape (n,)."""
        varied = copy(self._varied)
        varied.lam = lam
        return np.asarray(varied.d_lam(u, value))


class Varied:
    """A model followed in one of its attributes.

    >>> class Square:
    ...     c = 2.0
    ...     def residual(self, u, lam): return self.c * u**2 - lam
    ...     def jacobian(self, u, lam): return np.diag(2 * self.c * u)
    ...     def d_lam(self, u, lam): return -np.ones_like(u)
    ...     def inner(self, u, v): return u @ v
    >>> varied = Varied(Square(), "c", 4.0)
    >>> varied.residual(np.array([1.0]), 4.0), varied.d_lam(np.array([1.0]), 4.0).round(9)
    (array([0.]), array([1.]))
    """

    def __init__(self, model: Equations, name: str, lam: float) -> None:
        value = getattr(model, name, None)
        if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
            raise ValueError(f"name must be an attribute of {type(model).__name__} that is a number; {name!r} is {value!r:.60}")
        self.model, self.name, self.lam, self.value = model, name, number("lam", lam), float(value)

    def at(self, value: float) -> Any:
        """The model with this value of the parameter."""
        other = copy(self.model)
        setattr(other, self.name, value)
        return other

    def residual(self, u: Array, value: float) -> Array:
        """The model's, at the fixed load."""
        return np.asarray(self.at(value).residual(u, self.lam))

    def jacobian(self, u: Array, value: float) -> Any:
        """The model's, at the fixed load."""
        return jacobian(self.at(value), u, self.lam)

    def d_lam(self, u: Array, value: float) -> Array:
        """d(residual)/d(value) by central differences of two lengths, of fourth order."""
        return np.asarray(central(lambda x: self.residual(u, value + x), 1e-3 * max(1.0, abs(value))))

    def inner(self, u: Array, v: Array) -> float:
        """The model's."""
        return self.model.inner(u, v)

    def start(self, guess: Any = None) -> Array:
        """The model's."""
        return started(self.model, guess)

    @property
    def measures(self) -> dict[str, Any]:
        """The model's, at the fixed load."""
        known: dict[str, Any] = getattr(self.model, "measures", {})
        return {name: lambda u, value, name=name: self.at(value).measures[name](u, self.lam) for name in known}
