"""The discrete strut [N 2.7]: n joints with springs, clamped at the foot, loaded on top.

    V(phi; lam) = sum_i k_i (phi_i - phi_{i-1} - beta_i)^2 / 2  +  lam height(phi)  +  its terms,   phi_0 = beta_0
    height      = h sum_i w_i cos(phi_i)  +  h (1 - w_n) cos(phi_0)

Unknowns phi_1..phi_n, shape (n,), in radians. Positive phi turns clockwise: x' = sin phi, z' = cos phi.
Cost of every method: O(n), but for the Hessian with a term quadratic in the place (a foundation), which is full.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics import joints as joints_of
from rodlab.mechanics.assembly import balance, difference_form, full
from rodlab.mechanics.joints import Joints
from rodlab.mechanics.kernels import Kernel, kernel
from rodlab.mechanics.places import Places
from rodlab.mechanics.profile import Profile
from rodlab.mechanics.terms import BENDING, BENDING_WITH_REST, END_LOAD, Term, checked
from rodlab.numerics.arrays import EPS, Array, number, vector
from rodlab.numerics.difference import DifferenceForm, Springs
from rodlab.numerics.full import Full
from rodlab.numerics.tridiagonal import Tridiagonal

if TYPE_CHECKING:
    from rodlab.mechanics.derivation import Derivation

FULL_LIMIT = 4000


class Strut:
    """A strut of n joints with bending stiffness K and unstressed curvature u_hat, of length 1.

    K, u_hat: a number, n numbers (one a joint), a function of an array s, or an expression in s. rule: "end" (the notes,
    order 1) or "trapezoid" (order 2, also across the jumps declared in `breaks`). phi0: angle of the clamp.
    terms: `self_weight(q)`, `foundation(c)`, `end_torque(tau)` or your own `term(...)`.
    Raises `ValueError`, in one sentence, for whatever is not of this form.

    >>> strut = Strut(n=3, u_hat=0.75)
    >>> strut.unstressed(), strut.gradient(strut.unstressed(), 0.0)
    (array([0.25, 0.5 , 0.75]), array([0., 0., 0.]))
    >>> strut.hessian([0.0, 0.0, 0.0], 5.0).index
    1
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
        ends: tuple[str, str] = ("clamped", "free"),
    ) -> None:
        if not isinstance(ends, (tuple, list)) or tuple(ends) != ("clamped", "free"):
            raise ValueError(f"ends must be ('clamped', 'free'); they are {ends!r}")
        self._said = f"n={n!r}, K={K!r}, u_hat={u_hat!r}, rule={rule!r}" + (f", phi0={phi0!r}" if phi0 else "")
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
    ) -> "Strut":
        """The strut with these spring constants k (n,), rest angles beta (n,) and length h of a link.

        >>> Strut.from_joints(k=[1, 1]).hessian([0.0, 0.0], 1.0).toarray()
        array([[ 1., -1.],
               [-1.,  0.]])
        """
        strut = cls.__new__(cls)
        joints = joints_of.given(k, beta, h, beta0, weights)
        strut._said = f"n={joints.n}, from joints"
        strut._build(joints, terms, ())
        return strut

    def _build(self, joints: Joints, terms: Sequence[Term], breaks: Sequence[float]) -> None:
        self.joints = joints
        self.terms = checked(terms)
        self.springs = Springs(joints.k)
        bend = BENDING_WITH_REST if joints.curved else BENDING
        self._loaded = (bend, END_LOAD, *self.terms)
        self._unloaded = (bend, *self.terms)
        self.parameters: dict[str, Any] = {"k": joints.k, "beta": joints.beta, "h": joints.h, "w": joints.w}
        for term in self.terms:
            for name, given in term.parameters.items():
                profile = Profile(name, given, tuple(breaks))
                self.parameters[name] = profile.at(joints.s) if profile.constant is None else profile.constant
        if any(term.energy is not None for term in self.terms):
            self.kernel()  # what a term of one's own lacks is said at once

    def __repr__(self) -> str:
        terms = f", terms={self.terms!r}" if self.terms else ""
        return f"Strut({self._said}{terms})"

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.joints.n

    # --- energy and its derivatives ------------------------------------------------------------------------

    def kernel(self, lam: float = 1.0) -> Kernel:
        """The compiled derivatives of one link's energy; at lam = 0 the load does not occur in it."""
        return kernel(self._loaded if lam else self._unloaded, weighted=self.joints.weights is not None)

    def energy(self, phi: Any, lam: float) -> Any:
        """V(phi; lam): a float, or complex for complex angles. `ValueError` unless phi (n,) and lam are finite."""
        phi, lam = self._state(phi, lam)
        link, below = self.kernel(lam), self._below(phi)
        places = self.places.of(phi) if link.places else ()
        e = link.energy(below, phi, *places, lam, **self._given(link))
        clamp = lam * self.joints.h * (1 - self.joints.last_weight) * np.cos(self.joints.phi0) if lam else 0.0
        V = np.sum(e) + clamp
        return complex(V) if np.iscomplexobj(V) else float(V)

    def gradient(self, phi: Any, lam: float) -> Array:
        """dV/dphi, shape (n,): the balance of moments on each link. `ValueError` unless phi (n,) and lam are finite."""
        phi, lam = self._state(phi, lam)
        link = self.kernel(lam)
        given = self._given(link)
        m, f = link.moments(self._below(phi), phi, lam, **given)
        g = balance(m, f, phi)
        if link.places:
            g += self.places.moments(phi, *link.forces(*self.places.of(phi), **given))
        return g

    def hessian(self, phi: Any, lam: float) -> DifferenceForm | Tridiagonal | Full:
        """d2V/dphi2: `.diagonal`, `.off_diagonal`, `.toarray()`, `.index`, `.solve(b)`; symmetric.

        Tridiagonal, but full with a term quadratic in the place (a foundation), which more than 4000 joints cannot have.
        """
        phi, lam = self._state(phi, lam)
        link = self.kernel(lam)
        given = self._given(link)
        k, c_above, c_below = link.stiffness(self._below(phi), phi, lam, **given)
        c, spread = full(c_above, self.n), 0.0
        if np.ndim(c_below) or c_below:
            c[:-1] += full(c_below, self.n)[1:]
        if link.places:
            forces = link.forces(*self.places.of(phi), **given)
            c += self.places.softening(phi, *forces)
            spread = 2 * self.n * EPS * float(self.places.size(*forces).max())  # of their cumulative sums
        local = difference_form(self.springs if k is self.joints.k else full(k, self.n), c, spread)
        if not link.hardens:
            return local
        if self.n > FULL_LIMIT:
            raise ValueError(f"n must be at most {FULL_LIMIT} where a term couples all angles (a foundation); it is {self.n}")
        x, z = self.places.of(phi)
        return Full(local.toarray() + self.places.hardening(phi, *link.hardening(x, z, **given)))

    def d_lam(self, phi: Any, lam: float) -> Array:
        """d(gradient)/dlam, shape (n,)."""
        phi, lam = self._state(phi, lam)
        link = self.kernel()
        m, f = link.moments_lam(self._below(phi), phi, lam, **self._given(link))
        return balance(m, f, phi)

    # --- the equations F(u, lam) = 0 that a solver sees -------------------------------------------------------

    def residual(self, u: Array, lam: float) -> Array:
        """The gradient."""
        return self.gradient(u, lam)

    def jacobian(self, u: Array, lam: float) -> DifferenceForm | Tridiagonal | Full:
        """The Hessian."""
        return self.hessian(u, lam)

    def second_variation(self, u: Array, lam: float) -> DifferenceForm | Tridiagonal | Full:
        """The Hessian, whose negative eigenvalues are the index."""
        return self.hessian(u, lam)

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
            "height": lambda u, _: self.height(u),
            "energy": self.energy,
        }

    def lipschitz(self, lam: float) -> float:
        """Bound on the change of the Hessian, in any entry, per unit of change of the angles; infinite if none is known.

        Each entry of the load's Hessian is at most |lam| h w times a sine or cosine of one angle; that of a dead force
        adds what is carried. A foundation, or a term of one's own, has no bound here.
        """
        bound = abs(lam) * self.joints.h * float(self.joints.w.max())
        if any(term.energy is not None for term in self.terms) or self.kernel().hardens:
            return np.inf
        link, zero = self.kernel(), np.zeros(self.n)
        if link.places:
            bound += float(self.places.size(*link.forces(zero, zero, **self._given(link))).max())
        return bound

    def rounding(self, phi: Array, lam: float, v: Array) -> float:
        """Bound on |v . (computed gradient - exact gradient)|: how far rounding moves a functional of the solution.

        The moments enter as differences, so their relative rounding counts with the variation of v, not with n.
        """
        link = self.kernel(lam)
        given = self._given(link)
        below = self._below(phi)
        m, f = link.moments(below, phi, lam, **given)
        size = np.abs(m) + 2 * self.joints.k * np.abs(phi - below)
        moments = np.abs(np.diff(v, prepend=0.0)) @ size
        loads = np.abs(v) @ (2 * np.abs(full(f, self.n)) + np.abs(balance(m, f, phi)))
        if link.places:
            N = link.forces(*self.places.of(phi), **given)
            loads += self.n * float(np.abs(v) @ self.places.size(*N))
        return float(4 * EPS * (moments + loads))

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

    def height(self, phi: Any) -> float:
        """z of the tip."""
        j = self.joints
        c = np.cos(phi)
        return float(j.h * (np.sum(c if j.weights is None else j.w * c) + (1 - j.last_weight) * np.cos(j.phi0)))

    def shape(self, phi: Any) -> tuple[Array, Array]:
        """x, z of the n + 1 joints from the clamp (0, 0) to the tip."""
        x, z = self.places.of(vector("phi", phi, self.n))
        return np.append(0.0, x), np.append(0.0, z)

    def nodes(self, phi: Array) -> tuple[Array, Array]:
        """s and phi of the n + 1 joints, the clamp first."""
        return np.append(0.0, self.joints.s), np.append(self.joints.phi0, phi)

    def derivation(self, n: int = 3) -> "Derivation":
        """SymPy's energy, gradient and Hessian of this strut with n joints, and the source of its kernel."""
        from rodlab.mechanics.derivation import derivation

        j = self.joints
        own = j.weights is not None and not ((j.w[:-1] == 1).all() and j.last_weight == 0.5)
        scalars = {name for name, given in self.parameters.items() if np.ndim(given) == 0}
        weights = None if j.weights is None else "own" if own else "trapezoid"
        return derivation(self._loaded, n, weights=weights, scalars=scalars, clamped_upright=j.phi0 == 0)

    # --- small parts ----------------------------------------------------------------------------------------------

    @cached_property
    def places(self) -> Places:
        return Places(self.joints)

    def _state(self, phi: Any, lam: Any) -> tuple[Array, float]:
        return vector("phi", phi, self.n, complex_too=True), number("lam", lam)

    def _below(self, phi: Array) -> Array:
        below = np.empty_like(phi)
        below[0] = self.joints.phi0
        below[1:] = phi[:-1]
        return below

    def _given(self, link: Kernel) -> dict[str, Any]:
        return {name: self.parameters[name] for name in link.parameters}
