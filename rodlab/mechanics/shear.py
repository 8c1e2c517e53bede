"""The planar rod that shears and stretches: its principle, what is left of it in phi alone, its buckling [N 2.6, 2.8].

    x' = v1 cos phi + v3 sin phi,   z' = v3 cos phi - v1 sin phi          v1 the shear, v3 the stretch, 0 and 1 at rest
    V  = integral of K (phi' - u_hat)^2 / 2 + A1 v1^2 / 2 + A3 (v3 - 1)^2 / 2   plus   lam z(1) - N1 x(1)

    n1 = A1 v1       = lam sin phi + N1 cos phi          stationary in v1
    n3 = A3 (v3 - 1) = N1 sin phi - lam cos phi          stationary in v3
    W  = K (phi' - u_hat)^2 / 2 + lam cos phi - N1 sin phi - (n1^2 / A1 + n3^2 / A3) / 2
    m' = n3 v1 - n1 v3,   n1' = -n3 phi',   n3' = n1 phi',   m = K (phi' - u_hat),   m(1) = 0

V is strictly convex in v1 and v3, so that W has its equilibria and its index. A strut's term, in the words of `link`:
-h w ((lam sin b + N1 cos b)^2 / A1 + (lam cos b - N1 sin b)^2 / A3) / 2. A straight rod, N1 zero or the force that holds its tip:

    K w'' + (lam w + N1) (1 - delta lam) = 0,   x' = (1 - delta lam) w + N1 / A1,   delta = 1/A3 - 1/A1
    P (1 - delta P) = P_E = K q^2                where N1 = 0 [Haringx 1948; A1 infinite: Magnusson et al. 2001]

    clamped-free, hinged-guided      q = (2j - 1) pi/2    guided: phi = 0, and x is free
    clamped-guided                   q = j pi
    hinged-hinged, x(1) = 0          q = j pi, and q = 0: at P = 1/delta the sections turn, the centreline stays
    clamped-clamped, x(1) = 0        q = 2 j pi; between these N1 is not 0, and tan(q/2) / (q/2) = v3 / (1 - delta P)
    clamped-hinged, x(1) = 0         N1 is never 0, and tan(q) / q = v3 / (1 - delta P)

There v3 = 1 - P/A3, and must be positive. With A1 infinite it is 1 - delta P, and every rod has its own Euler loads as P_E.
The roots are (1 -+ sqrt(1 - 4 delta P_E)) / (2 delta). For delta > 0 the rod buckles at the lower and is straight again above the
upper, or never buckles; for delta < 0 one is negative, and the rod buckles in tension too [Zaccaria et al. 2011].
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, NamedTuple

import sympy
from sympy import Derivative, Eq, Expr, Function, Symbol, cos, sin

from rodlab.mechanics.derive import tidy
from rodlab.numerics.arrays import number, vector, whole

s, w, delta = Symbol("s", real=True), Function("w"), Symbol("delta", real=True)
p, phi, v1, v3, n1, n3, lam, N1 = sympy.symbols("p phi v1 v3 n1 n3 lam N1", real=True)
K, u_hat, A1, A3 = sympy.symbols("K u_hat A1 A3", real=True)
MOST = 1e150  # of a stiffness and of a load: products of two do not overflow

_SLOPE, _RISE = v1 * cos(phi) + v3 * sin(phi), v3 * cos(phi) - v1 * sin(phi)  # x', z'


@dataclass(frozen=True)
class ShearableRod:
    """The density of V in the symbols p = phi', phi, v1, v3, lam, N1, K, u_hat, A1, A3, and what SymPy derives from it.

    Expressions are in these symbols, equations in functions of s. Shows as LaTeX in a notebook.
    """

    density: Expr

    @property
    def principle(self) -> Expr:
        """The density of V, to be made stationary in phi(s), v1(s) and v3(s)."""
        return self._read(self.density)

    @cached_property
    def strains(self) -> dict[Symbol, Expr]:
        """v1, v3 -> their values where V is stationary in both."""
        found = sympy.solve([self.density.diff(v1), self.density.diff(v3)], [v1, v3])
        return {v1: sympy.together(found[v1]), v3: 1 + sympy.together(found[v3] - 1)}

    @cached_property
    def forces(self) -> dict[Symbol, Expr]:
        """n1, n3 -> the forces A1 v1 and A3 (v3 - 1) in the frame of the section."""
        return {n1: sympy.expand(A1 * self.strains[v1]), n3: sympy.expand(A3 * (self.strains[v3] - 1))}

    @cached_property
    def reduced(self) -> Expr:
        """W(p, phi; lam, N1): the density with v1 and v3 eliminated, as one would write it."""
        left, bent = sympy.expand(self.density.subs(self.strains)), K * (p - u_hat) ** 2 / 2
        squares = (self.forces[n1] ** 2 / A1 + self.forces[n3] ** 2 / A3) / 2
        return bent + sympy.expand(left - sympy.expand(bent) + sympy.expand(squares)) - squares

    @property
    def moment(self) -> Expr:
        """m = W_phi'."""
        return tidy(self.reduced.diff(p))

    # --- to be read -------------------------------------------------------------------------------------------------

    def _read(self, expression: Expr) -> Expr:
        """With functions of s for all symbols but lam and N1, which are constants."""
        profiles = {x: Function(x.name)(s) for x in (phi, v1, v3, n1, n3, K, u_hat, A1, A3)}
        return expression.subs({p: Derivative(profiles[phi], s), lam: Symbol("lambda", real=True), **profiles}, simultaneous=True)

    @property
    def euler_lagrange(self) -> Eq:
        """(W_phi')' - W_phi = 0 as an equation for phi(s)."""
        bends, force = self.reduced.diff(phi), self.forces[n1]
        bends = force * sympy.expand(sympy.cancel(sympy.expand(bends) / force))
        return Eq(Derivative(self._read(self.moment), s) - self._read(bends), 0)

    @property
    def natural(self) -> Eq:
        """W_phi' = 0 at the free end."""
        return Eq(self._read(self.moment).subs(s, 1), 0)

    @cached_property
    def balance(self) -> tuple[Eq, ...]:
        """n1' = ..., n3' = ..., m' = ...: forces and moments in the frame of the section, derived from V [N 2.6]."""
        constants = sympy.solve([Eq(*pair) for pair in self.forces.items()], [lam, N1])  # by n1 and n3, which turn with phi
        rates = {n: force.diff(phi) * p for n, force in self.forces.items()} | {self.moment: self.density.diff(phi)}
        right = {left: sympy.expand(sympy.simplify(rate.subs(constants))) for left, rate in rates.items()}
        return tuple(Eq(Derivative(self._read(left), s), self._read(rate)) for left, rate in right.items())

    @cached_property
    def held(self) -> tuple[Eq, Eq]:
        """The uniform straight rod linearised in w and in the force N1 that holds its tip: balance of moments, and x'."""
        size, angle, load = Symbol("epsilon", real=True), Symbol("w", real=True), Symbol("lambda", real=True)
        near, factor = {phi: size * angle, N1: size * N1, lam: load}, 1 - delta * load
        bends, slope = (
            sympy.expand(sympy.cancel(e.subs(near, simultaneous=True).diff(size).subs(size, 0).subs(A3, 1 / (delta + 1 / A1))))
            for e in (self.reduced.diff(phi), _SLOPE.subs(self.strains))
        )
        bends = sympy.cancel(-bends / factor) * factor
        bends, slope = (e.subs(angle, w(s)) for e in (bends, sympy.collect(slope, angle)))
        return Eq(K * w(s).diff(s, 2) + bends, 0), Eq(Function("x")(s).diff(s), slope)

    @property
    def linearised(self) -> Eq:
        """The same moments for a tip that is free to move: N1 = 0."""
        return Eq(self.held[0].lhs.subs(N1, 0), 0)

    @property
    def rows(self) -> list[tuple[str, Expr]]:
        """Name -> what is derived, in the order in which one would write it on a board."""
        eliminated = [(str(x), self._read(Eq(x, value))) for x, value in self.strains.items()]
        balance = [("forces", self.balance[0]), ("", self.balance[1]), ("moments", self.balance[2])]
        return [
            ("V", self.principle), *eliminated, ("W", self._read(self.reduced)), ("Euler-Lagrange", self.euler_lagrange),
            ("free end", self.natural), *balance, ("straight", self.linearised), ("tip held", self.held[0]), ("", self.held[1]),
        ]  # fmt: skip

    def _repr_latex_(self) -> str:
        lines = r" \\ ".join(rf"\text{{{name}}} &\quad {sympy.latex(value)}" for name, value in self.rows)
        return rf"$\displaystyle \begin{{aligned}} {lines} \end{{aligned}}$"

    def __str__(self) -> str:
        return "\n\n".join(f"{name}\n{sympy.pretty(value, wrap_line=False)}" for name, value in self.rows)

    __repr__ = __str__


@cache
def shearable_principle() -> ShearableRod:
    """The rod clamped below, with the dead load lam pressing down and N1 pulling along x at its tip [N 2.8, Exercise].

    >>> shearable_principle().linearised
    Eq(K*Derivative(w(s), (s, 2)) + lambda*(-delta*lambda + 1)*w(s), 0)
    """
    stored = K * (p - u_hat) ** 2 / 2 + A1 * v1**2 / 2 + A3 * (v3 - 1) ** 2 / 2
    return ShearableRod(stored + lam * _RISE - N1 * _SLOPE)


class StraightLoad(NamedTuple):
    """A load at which a mode of the straight rod changes its stability, whether v3 > 0 there, and what happens as |load| grows.

    `meaning`: "buckles", "straight again" (this mode no longer bends it), or "buckles in tension", where `load` is negative.
    """

    load: float
    admissible: bool
    meaning: str


def shear_loads(
    A1: float, A3: float, euler: Sequence[float] | None = None, *, K: float = 1.0, modes: int = 1
) -> list[StraightLoad]:
    """Roots P of P (1 - delta P) = P_E, ascending, for each Euler load P_E of the rod that can neither shear nor stretch.

    A1, A3: from 1e-150 to 1e150, or `math.inf` for no shear, no stretch. euler: from 0 to 1e150; the top of this module says
    which hold for which ends (0, of sections that all turn alike, gives 1/delta). Without it, the first `modes` loads of the
    clamped-free rod of stiffness K. P = 0 is left out, and so is a double root, where no sign changes. Raises `ValueError`.

    >>> for load in shear_loads(math.inf, 50): print(load)
    StraightLoad(load=2.60290320183..., admissible=True, meaning='buckles')
    StraightLoad(load=47.3970967981..., admissible=True, meaning='straight again')
    >>> shear_loads(math.inf, 9)                # below 4 P_E = pi^2 it shortens, and never buckles
    []
    """
    A1, A3 = _stiffness("A1", A1), _stiffness("A3", A3)
    K, modes = number("K", K, above=0.0), whole("modes", modes, least=1)
    if euler is None:
        euler = [K * ((2 * j - 1) * math.pi / 2) ** 2 for j in range(1, modes + 1)]
    given = vector("euler", euler).tolist()
    for i, P_E in enumerate(given):
        if not 0 <= P_E <= MOST:
            raise ValueError(f"euler must lie between 0 and {MOST:g}; entry {i} is {P_E!r}")
    return sorted(load for P_E in given for load in _loads(A1, A3, P_E))


def _loads(A1: float, A3: float, P_E: float) -> list[StraightLoad]:
    """The roots P_E / half and half / delta, half = (1 + sqrt(1 - 4 delta P_E)) / 2; their sum is 1 / delta.

    At the second that gives v3 = delta first - second / A1, which keeps its sign where 1 - P / A3 is lost in rounding.
    """
    difference = _compliance(A1, A3)
    if 4 * difference * P_E >= 1:
        return []
    half = (1 + math.sqrt(1 - 4 * difference * P_E)) / 2
    first = P_E / half
    found = [StraightLoad(first, first < A3, "buckles")] if P_E else []
    if difference:
        second, meaning = half / difference, "straight again" if difference > 0 else "buckles in tension"
        found.append(StraightLoad(second, second < 0 or difference * first > second / A1, meaning))
    return found


def _compliance(A1: float, A3: float) -> float:
    """1/A3 - 1/A1, to a few roundings also where the two are close."""
    soft, stiff = sorted((A1, A3))
    size = 0.0 if soft == stiff else 1 / soft if stiff == math.inf else (stiff - soft) / stiff / soft
    return size if soft == A3 else -size


def _stiffness(name: str, value: Any) -> float:
    if isinstance(value, float) and value == math.inf:
        return math.inf
    if not 1 / MOST <= (x := number(name, value, above=0.0)) <= MOST:
        raise ValueError(f"{name} must lie between {1 / MOST:g} and {MOST:g}, or be math.inf; it is {value!r}")
    return x
