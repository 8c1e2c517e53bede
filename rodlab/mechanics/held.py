"""Ends: at each a pair of boundary values, of which one is given and the other a reaction [N 2.6; Antman, IV.1].

                      clamped       hinged        guided        free
    top     angle     phi1  tau*    tau   phi*    phi1  tau*    tau   phi*        * unknown
            place     x     N1*     x     N1*     N1    x*      N1    x*
    foot    angle     phi0  m*      m = 0 phi0*   phi0  m*      m = 0 phi0*
            place     x = 0         x = 0         force zero, x0* where a term asks for places, else of no matter
    lam given, the end's height z* found; or the shortening 1 - z given, lam* its reaction

Every strut and rod is the cantilever under its reactions p, which join the angles as unknowns u = (p, phi):

    V(phi; p) stationary in phi;    V_p = what is given:    -x(1), -phi(1), z(1), or a moment or force that vanishes

Symmetric, with a border of one column a reaction (`rodlab.numerics.constrained`). A reaction whose partner is given is a
multiplier: the index is that on the directions that keep what is given.
"""

from collections.abc import Callable, Mapping
from copy import copy
from typing import Any

import numpy as np

from rodlab.mechanics.ends import SLIDES, TURNS
from rodlab.numerics.arrays import EPS, Array, number, vector
from rodlab.numerics.constrained import Constrained

MULTIPLIERS = ("lam", "N1", "tau")
GIVEN = {"shortening": "lam", "offset": "N1", "phi1": "tau"}  # what is given -> the reaction that it has
SIGNS = {"lam": -1.0, "N1": 1.0, "tau": 1.0}  # of what is given, in the equation of the reaction
WEIGHT = 0.01  # of a force's change in the length of a step, per angle by which it could turn the rod


class Held:
    """What a strut or rod with other ends than clamped and free has in place of the cantilever's equations; a mixin.

    `base` is the cantilever, `unknowns` the names of the reactions in the order of u, `follows` what the last argument of every
    method is: "lam", or the name of what is given in the load's place (`vary`). phi (n,) are the angles of the cantilever.
    """

    base: Any
    ends: tuple[str, str]
    unknowns: tuple[str, ...]
    follows: str
    load: float | None  # where another thing is followed; None where it is a reaction
    targets: dict[str, float]
    terms: Any
    arguments: dict[str, Any]
    lipschitz = embedding = None  # no bound is known: steps are checked, not proved
    seen = staticmethod(np.asarray)

    def _hold(self, base: Any, ends: tuple[str, str], phi1: Any, offset: Any) -> None:
        foot, top = self.ends = ends
        angle_free, held = top in TURNS, top not in SLIDES
        self.base, self.follows, self.load = base, "lam", None
        self._varied: Any = None
        self._last: Any = None
        self.targets = {"tau": number("phi1", phi1), "N1": number("offset", offset)}
        if angle_free and phi1 != 0:
            raise ValueError(f"phi1 must be zero where the top is {top}, whose angle is not held; it is {phi1:g}")
        if offset and not (held and foot not in SLIDES):
            raise ValueError(f"offset must be zero unless both ends hold the place; it is {offset:g} with ends {ends}")
        sliding = foot in SLIDES and base.kernel().aside
        pushed = held and (foot not in SLIDES or sliding)
        given = any(term.name == "end_force" for term in self.terms)
        if given and foot in SLIDES and not (sliding or pushed):
            raise ValueError(f"N1 must have something to act against; with ends {ends} and no term of x the foot slides freely")
        self.unknowns = tuple(
            name
            for name, unknown in (("N1", pushed), ("tau", not angle_free), ("phi0", foot in TURNS), ("x0", sliding))
            if unknown
        )
        if base.start().size + len(self.unknowns) < 2 * self.constraints:
            raise ValueError(f"the ends {ends} hold more than {base.start().size} angles can obey; more joints are needed")

    # --- the cantilever under its reactions --------------------------------------------------------------------------

    @property
    def constraints(self) -> int:
        """How many of the unknowns are multipliers."""
        return sum(name in MULTIPLIERS for name in self.unknowns)

    def split(self, u: Array) -> tuple[dict[str, float], Array]:
        """The reactions by name, and the angles phi."""
        m = len(self.unknowns)
        return dict(zip(self.unknowns, u[:m].tolist(), strict=True)), u[m:]

    def angles(self, u: Array) -> Array:
        """The angles phi of unknowns, or their part of a direction."""
        return u[len(self.unknowns) :]

    def acting(self, u: Array, value: float) -> tuple[Any, Array, float]:
        """The cantilever that these reactions act on, its angles, and the load on it."""
        if self._last is not None and self._last[1] == value and np.array_equal(self._last[0], u):
            known: tuple[Any, Array, float] = self._last[2]
            return known
        reactions, phi = self.split(u)
        lam = reactions.pop("lam", value if self.load is None else self.load)
        model = self.base if self._varied is None else self._varied.sharing(value)
        found = (model.under(**reactions) if reactions else model), phi, float(lam)
        self._last = (u.copy(), value, found)
        return found

    def given_at(self, value: float) -> dict[str, float]:
        """Reaction -> what is given in its stead: x(1), phi(1), z(1)."""
        targets = dict(self.targets)
        if self.follows in GIVEN:
            targets[GIVEN[self.follows]] = 1 - value if self.follows == "shortening" else value
        return targets

    # --- the equations F(u, lam) = 0 -------------------------------------------------------------------------------

    def residual(self, u: Array, value: float) -> Array:
        """The reactions' equations, then the gradient in the angles."""
        model, phi, lam = self.acting(u, value)
        return np.append(self._rows(model, phi, lam, value), model.residual(phi, lam))

    def _rows(self, model: Any, phi: Array, lam: float, value: float) -> Array:
        targets = self.given_at(value)
        return np.array(
            [model.boundary(name, phi, lam) + SIGNS.get(name, 0.0) * targets.get(name, 0.0) for name in self.unknowns]
        )

    def jacobian(self, u: Array, value: float) -> Any:
        """The second variation with its border."""
        model, phi, lam = self.acting(u, value)
        if not self.unknowns:
            return model.jacobian(phi, lam)
        border = np.column_stack([model.column(name, phi, lam) for name in self.unknowns])
        corner = np.array([[model.second(a, b, phi, lam) for b in self.unknowns] for a in self.unknowns])
        return Constrained(model.jacobian(phi, lam), border, corner, self.constraints, self.blurred(0.0))

    def blurred(self, off: float) -> Array:
        """How far the border may be off, by columns, with angles known to `off` and rounding: those of loads turn with them."""
        return np.array([self.base.lever * (off + 4 * EPS) if name in ("lam", "N1") else 0.0 for name in self.unknowns])

    def second_variation(self, u: Array, value: float) -> Any:
        """The same: its negative eigenvalues are counted on the directions that keep what is given."""
        return self.jacobian(u, value)

    def d_lam(self, u: Array, value: float) -> Array:
        """d(residual)/d(value)."""
        model, phi, lam = self.acting(u, value)
        if self.follows == "lam":
            return np.append([model.second(name, "lam", phi, lam) for name in self.unknowns], model.column("lam", phi, lam))
        if self.follows in GIVEN:
            own = GIVEN[self.follows]
            change = SIGNS[own] * (-1.0 if self.follows == "shortening" else 1.0)
            return np.append([change * (name == own) for name in self.unknowns], np.zeros_like(phi))
        reactions, _ = self.split(u)
        reactions.pop("lam", None)
        varied = self._varied.under(lam, **reactions)
        e = 1e-3 * max(1.0, abs(value))

        def rows(x: float) -> Array:
            return self._rows(varied.sharing(value + x), phi, lam, value)

        wide, close = ((rows(x) - rows(-x)) / (2 * x) for x in (e, e / 2))
        return np.append((4 * close - wide) / 3, varied.d_lam(phi, value))

    def inner(self, u: Array, v: Array) -> float:
        """That of the angles, and a little of the reactions, by how far each could turn the rod."""
        m = len(self.unknowns)
        return float(self.base.inner(u[m:], v[m:])) + float((self._weights * u[:m]) @ v[:m])

    @property
    def _weights(self) -> Array:
        turn = WEIGHT * self.base.flexibility
        return np.array([turn**2 if name in MULTIPLIERS else 1.0 for name in self.unknowns])

    def start(self, guess: Any = None) -> Array:
        """Unknowns from a guess at the angles: all of u, the angles, a function of s, or None for the unstressed shape."""
        m = len(self.unknowns)
        if guess is not None and not callable(guess) and np.size(guess) == m + self.base.start().size:
            return vector("guess", guess).copy()
        phi = self.base.start(guess)
        foot = float(np.ravel(guess(np.zeros(1)))[0]) if callable(guess) else float(phi[0])
        known = {"phi0": foot if guess is not None else self.base.foot_angle, "x0": 0.0}
        u = np.append([known.get(name, 0.0) for name in self.unknowns], phi)
        return self._balanced(u)

    def _balanced(self, u: Array) -> Array:
        """The multipliers that come nearest to balance at these angles, by least squares."""
        free = [i for i, name in enumerate(self.unknowns) if name in MULTIPLIERS]
        if free and u[len(self.unknowns) :].any():
            model, phi, lam = self.acting(u, self.value)
            columns = np.column_stack([model.column(self.unknowns[i], phi, lam) for i in free])
            u[free] = np.linalg.lstsq(columns, -model.residual(phi, lam), rcond=None)[0]
        return u

    # --- what a point asks ---------------------------------------------------------------------------------------------

    @property
    def measures(self) -> dict[str, Callable[[Array, float], float]]:
        """Those of the cantilever, the potential energy without the reactions' own, and the reactions by name."""
        known = {name: self._of_base(name) for name in self.base.measures if name != "condition"}
        own: dict[str, Callable[[Array, float], float]] = {
            "energy": self._energy,
            "load": lambda u, value: self.acting(u, value)[2],
            "shortening": lambda u, value: 1 - self._of_base("height")(u, value),
        }
        reactions = {name: (lambda u, _, i=i: float(u[i])) for i, name in enumerate(self.unknowns) if name != "lam"}
        return {**known, **own, **reactions}

    def _of_base(self, name: str) -> Callable[[Array, float], float]:
        def measure(u: Array, value: float) -> float:
            model, phi, lam = self.acting(u, value)
            return float(model.measures[name](phi, lam))

        return measure

    def _energy(self, u: Array, value: float) -> float:
        model, phi, lam = self.acting(u, value)
        reactions, _ = self.split(u)
        V = model.energy(phi, lam)
        if "phi0" in reactions:
            V -= model.parameters.get("tau", 0.0) * reactions["phi0"]
        if "x0" in reactions:
            V -= model.parameters.get("N1", 0.0) * reactions["x0"]
        return float(V - sum(p * model.boundary(name, phi, lam) for name, p in reactions.items() if name in MULTIPLIERS))

    def rounding(self, u: Array, value: float, v: Array) -> float:
        """Bound on |v . (computed residual - exact)|."""
        model, phi, lam = self.acting(u, value)
        m = len(self.unknowns)
        rows = np.array([1 + abs(model.second(name, name, phi, lam) * p) for name, p in zip(self.unknowns, u[:m], strict=True)])
        return float(model.rounding(phi, lam, v[m:])) + 8 * EPS * float(np.abs(v[:m]) @ rows)

    @property
    def symmetries(self) -> tuple[Callable[[Array], Array], ...]:
        """The mirror image, where the energy and what is given are the same for it."""
        odd = any(self.targets[name] for name in self.unknowns if name in self.targets)
        if odd or self.follows not in ("lam", "shortening") or not self.base.symmetries:
            return ()
        signs = np.append([1.0 if name == "lam" else -1.0 for name in self.unknowns], -1.0)

        def mirrored(u: Array) -> Array:
            return np.append(signs[:-1] * u[: signs.size - 1], -u[signs.size - 1 :])

        return (mirrored,)

    @property
    def is_straight(self) -> bool:
        """True when phi = 0 is an equilibrium at every load."""
        return bool(self.base.is_straight) and not any(self.targets[name] for name in self.unknowns if name in self.targets)

    # --- the angles' own energy: of the cantilever, without reactions ----------------------------------------------------

    def energy(self, phi: Any, lam: float) -> Any:
        """V(phi; lam) of angles phi (n,), no reaction acting: what the reactions' work is then added to."""
        return self.base.energy(phi, lam)

    def gradient(self, phi: Any, lam: float) -> Array:
        """dV/dphi of angles phi (n,), no reaction acting."""
        return np.asarray(self.base.gradient(phi, lam))

    def hessian(self, phi: Any, lam: float) -> Any:
        """d2V/dphi2 of angles phi (n,), no reaction acting."""
        return self.base.hessian(phi, lam)

    # --- another thing in the load's place -------------------------------------------------------------------------------

    def vary(self, name: str, lam: float | None = None) -> Any:
        """The same with `name` in the load's place, at the dead load lam; the shortening, whose reaction is the load, without."""
        if self.follows != "lam":
            raise ValueError(f"a model can be varied once; this one is followed in {self.follows}")
        other = self._afresh()
        other.follows, other.load = name, None
        if name == "shortening":
            if lam is not None:
                raise ValueError(f"lam must not be given with the shortening, whose reaction it is; it is {lam:g}")
            other.unknowns = ("lam", *self.unknowns)
            return other
        if lam is None:
            raise ValueError(f"lam must be given where {name} is followed: the load that stays")
        other.load = number("lam", lam)
        if name in GIVEN:
            if GIVEN[name] not in self.unknowns:
                raise ValueError(f"{name} must be held by the ends to be followed; they are {self.ends}")
            return other
        if name in self.unknowns:
            raise ValueError(f"{name} must be given to be followed; with ends {self.ends} it is a reaction")
        other._varied = self.base.vary(name, lam)
        return other

    @property
    def lam(self) -> float | None:
        """The load that stays where another thing is followed."""
        return self.load

    @lam.setter
    def lam(self, lam: float) -> None:
        self.load, self._last = lam, None

    def sharing(self, value: float) -> Any:
        """The model with this value of what is followed, under any load, on the same mesh."""
        other = self._afresh()
        other.follows, other.load, other._varied = "lam", None, None
        if self._varied is not None:
            other.base = self._varied.sharing(value)
        elif self.follows in GIVEN:
            other.targets = {**self.targets, GIVEN[self.follows]: value}
        return other

    def replace(self, **changes: Any) -> Any:
        """The same with other arguments, or other parameters of its terms, followed in what this one is followed in."""
        plain = super().replace(**changes)  # type: ignore[misc]
        return plain if self.follows == "lam" else plain.vary(self.follows, self.load)

    def _afresh(self) -> Any:
        """A copy without what was computed for these equations."""
        fresh = getattr(self, "fresh", None)
        other = copy(self) if fresh is None else fresh()
        other._last = None
        return other

    def released(self) -> Any:
        """Where the shortening is followed: the same under a dead load."""
        other = self._afresh()
        other.follows = "lam"
        other.unknowns = tuple(name for name in self.unknowns if name != "lam")
        return other

    @property
    def value(self) -> float:
        """The value of what is followed that the model was made with."""
        if self.follows in GIVEN:
            return self.targets.get(GIVEN[self.follows], 0.0)
        return 0.0 if self._varied is None else float(self._varied.value)

    def _said(self, said: str) -> str:
        """What is held, for the end of a repr."""
        given = {name: self.arguments[name] for name in ("phi1", "offset") if name in self.arguments}
        held = said + f", ends={self.ends}" + "".join(f", {name}={x!r}" for name, x in given.items()) + ")"
        if self.follows == "lam":
            return held
        return held + f", followed in {self.follows}" + ("" if self.load is None else f" at lam={self.load:g}")

    def _recipe(self, recipe: Mapping[str, Any] | None) -> dict[str, Any] | None:
        """The recipe with what is followed."""
        if recipe is None or self.follows == "lam":
            return None if recipe is None else dict(recipe)
        return {**recipe, "vary": self.follows} | ({} if self.load is None else {"lam": self.load})
