"""The planar rod [N 2.6, 2.8]: the limit of the strut, collocated at Gauss's points.

    V = integral of K (phi' - u_hat)^2 / 2 + lam cos(phi)  +  its terms        phi(0) = phi0
    (K (phi' - u_hat))' + lam sin(phi) = 0,   K (phi' - u_hat)(1) = 0,   x' = sin phi,  z' = cos phi

Unknowns u (N m,): the angles at the nodes of a piecewise polynomial of degree m on a mesh of N intervals, the clamp's left out;
u[-1] is the tip's. The equations are those of Gauss collocation of phi' = u_hat + m/K, m' = -lam sin phi, written as the gradient
of the energy by Gauss's rule (`rodlab.numerics.collocation`): symmetric, with an index, of order 2m at mesh points.
A mesh that is not given adapts (`rodlab.mechanics.remesh`): each point has the rod on its own mesh for its equations.
"""

from collections.abc import Callable, Sequence
from copy import copy
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics import bounds, remesh, resolution, rod_bounds, rod_ends, rod_places
from rodlab.mechanics.held import CANTILEVER, needs_reactions
from rodlab.mechanics.kernels import density
from rodlab.mechanics.mirror import mirror
from rodlab.mechanics.profile import Profile
from rodlab.mechanics.recipe import changed, kept, rod_recipe_of, said_of_rod
from rodlab.mechanics.terms import BENDING, BENDING_WITH_REST, END_LOAD, Term, checked
from rodlab.numerics.arrays import EPS, Array, number, vector, whole
from rodlab.numerics.collocated import Collocated
from rodlab.numerics.collocation import Grid
from rodlab.numerics.full import Full
from rodlab.numerics.inertia import Inertia
from rodlab.numerics.mesh import given_mesh, spread_out
from rodlab.numerics.pieces import smooth_pieces

if TYPE_CHECKING:
    from rodlab.mechanics.limit import Limit

FIRST = 4  # intervals of the first mesh
HIGHEST = 32  # degree
NEAREST = 1e-9  # distance of breaks
DERIVED = ("companion", "compliance", "_stiff", "_with_load", "_without_load", "symmetries")  # of mesh and parameters


class Rod:
    """A rod with bending stiffness K and unstressed curvature u_hat, of length 1, clamped at its foot.

    K, u_hat: a number, a function of an array s, or an expression in s; jumps and kinks are found, those narrower than a
    hundredth must be declared in `breaks`; either are points of every mesh. degree: of the polynomials, order 2 degree.
    mesh: a number of intervals or points from 0 to 1; None adapts it so that the angles at mesh points are right to `tol`.
    terms, ends, phi1, offset: as of a strut.
    Raises `ValueError`, in one sentence, for whatever is not of this form.

    >>> rod = Rod(K="1 + s", u_hat=0.5)
    >>> rod
    Rod(K='1 + s', u_hat=0.5)
    >>> Rod(mesh=2, degree=1).gradient([0.1, 0.2], 0.0)             # two links of length 1/2: springs K / h = 2
    array([0. , 0.2])
    """

    def __new__(cls, *_: Any, **given: Any) -> "Rod":
        """A rod of the kind that its ends ask for."""
        if cls is Rod and needs_reactions(_[8] if len(_) > 8 else given.get("ends"), given):
            from rodlab.mechanics.held_rod import HeldRod

            return object.__new__(HeldRod)
        return object.__new__(cls)

    def __init__(
        self,
        K: Any = 1.0,
        u_hat: Any = 0.0,
        phi0: float = 0.0,
        breaks: Sequence[float] = (),
        degree: int = 6,
        mesh: Any = None,
        tol: float = 1e-10,
        terms: Sequence[Term] = (),
        ends: tuple[str, str] = CANTILEVER,  # noqa: ARG002  `__new__` saw to them
        phi1: float = 0.0,  # noqa: ARG002
        offset: float = 0.0,  # noqa: ARG002
    ) -> None:
        self.arguments = kept(
            {"K": K, "u_hat": u_hat, "phi0": phi0, "breaks": breaks, "degree": degree, "mesh": mesh, "tol": tol, "terms": terms}
        )
        self.phi0, self.tol, self.terms = number("phi0", phi0), number("tol", tol, above=0.0), checked(terms)
        degree = whole("degree", degree, least=1)
        if degree > HIGHEST:
            raise ValueError(f"degree must be at most {HIGHEST}; it is {str(degree)[:20]}")
        given = {"K": K, "u_hat": u_hat, **{name: value for term in self.terms for name, value in term.parameters.items()}}
        declared = _breaks(breaks)
        self.profiles = {name: _along_the_rod(name, value, declared) for name, value in given.items()}
        self.curved = self.profiles["u_hat"].constant != 0.0
        bend = BENDING_WITH_REST if self.curved else BENDING
        self.loaded, self._unloaded = (bend, END_LOAD, *self.terms), (bend, *self.terms)
        self.breaks, self.pieces = self._pieces()
        self.adapts, self.expected = mesh is None, (0.0, np.inf)  # the load at which this mesh was made, and errors below
        self.stuck = 0.0  # errors which a finer mesh does not mend
        first = np.union1d(spread_out(FIRST, self.breaks), self.pieces) if mesh is None else given_mesh(mesh, self.breaks)
        self._collocate(first, degree)
        self.x0 = 0.0  # of the foot
        self.kernel()  # what a term of one's own lacks is said at once

    def _pieces(self) -> tuple[Array, Array]:
        """The breaks, declared and found, and the edges of the pieces on which every property is smooth."""
        said = {b for profile in self.profiles.values() for b in profile.breaks if 0 < b < 1}
        edges = np.array([0.0, *sorted(said), 1.0])
        breaks, pieces = [edges[1:-1]], [edges]
        for profile in self.profiles.values():
            if profile.function is not None:
                try:
                    smooth, found = smooth_pieces(profile.at, edges)
                except ValueError as error:
                    raise ValueError(f"{profile.name} must be smooth between its breaks: {error}") from None
                breaks.append(found)
                pieces.append(smooth)
        return np.unique(np.concatenate(breaks)), np.unique(np.concatenate(pieces))

    def _collocate(self, mesh: Array, degree: int) -> None:
        self.grid = Grid(mesh, degree)
        self._last_state: tuple[Array, Array, Array] | None = None
        self._last_hardening: tuple[Array, Array] | None = None
        self.last_corrected: tuple[Array, float, resolution.Corrected] | None = None
        s = self.grid.s
        self.parameters: dict[str, Any] = {
            name: profile.at(s) if profile.constant is None else profile.constant for name, profile in self.profiles.items()
        }
        K = np.asarray(self.parameters["K"])
        self.profiles["K"].positive(np.broadcast_to(K, s.shape), s)
        self.profiles["K"].positive(self.profiles["K"].at(mesh), mesh)

    def on(self, mesh: Array, degree: int | None = None) -> "Rod":
        """The same rod on another mesh, which holds the breaks, or with another degree."""
        other = self.fresh()
        other.expected, other.stuck = (0.0, np.inf), 0.0
        other._collocate(mesh, self.degree if degree is None else degree)
        return other

    def fresh(self) -> "Rod":
        """A copy without what was computed for its mesh and parameters."""
        other = copy(self)
        for name in DERIVED:
            other.__dict__.pop(name, None)
        other._last_state = other._last_hardening = other.last_corrected = None
        return other

    def on_points(self, points: Sequence[float]) -> "Rod":
        """The same rod on the mesh of these points, as a recipe holds them."""
        return self.on(given_mesh(np.asarray(points), self.breaks))

    def replace(self, **changes: Any) -> "Rod":
        """The same rod with other arguments, or other parameters of its terms.

        >>> Rod().replace(u_hat=0.5, degree=4)
        Rod(K=1.0, u_hat=0.5, degree=4)
        """
        return Rod(**changed(self.arguments, self.terms, changes))

    @property
    def recipe(self) -> dict[str, Any] | None:
        """What to write into a file so that `rodlab.mechanics.recipe.build` makes this rod, on this mesh; None for functions."""
        recipe = rod_recipe_of(self.arguments, self.terms)
        return None if recipe is None else {**recipe, "points": self.mesh.tolist()}

    def vary(self, name: str, lam: float | None = None) -> Any:
        """The same rod at the load lam, with its parameter `name` in the place of the load; see `rodlab.vary`."""
        if name == "shortening":
            from rodlab.mechanics.held_rod import HeldRod

            return HeldRod.around(self, CANTILEVER).vary(name, lam)
        from rodlab.mechanics.varied_rod import VariedRod

        return VariedRod(self, name, lam)

    def __repr__(self) -> str:
        return f"Rod({said_of_rod(self.arguments, self.terms)})"

    @property
    def mesh(self) -> Array:
        """The mesh points, from 0 to 1."""
        return self.grid.mesh

    @property
    def degree(self) -> int:
        """Degree of the polynomials."""
        return self.grid.degree

    @property
    def flexibility(self) -> float:
        """How far a unit couple on the end turns it: the integral of 1 / K."""
        return self.compliance[0]

    @property
    def lever(self) -> float:
        """The most that a turn of one unknown moves the end: two of the longest intervals."""
        return 2 * float(np.diff(self.mesh).max())

    @property
    def foot_angle(self) -> float:
        """The angle of the clamp."""
        return self.phi0

    @property
    def varies(self) -> bool:
        """True when a property depends on s."""
        return any(profile.constant is None for profile in self.profiles.values())

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.grid.N * self.degree

    @property
    def freedom(self) -> int:
        """Number of eigenvalues of the second variation."""
        return self.size

    # --- energy and its derivatives ------------------------------------------------------------------------------

    def kernel(self, lam: float = 1.0) -> Any:
        """The compiled derivatives of the density; at lam = 0 the load does not occur in it."""
        return self._with_load if lam else self._without_load

    @cached_property
    def _with_load(self) -> Any:
        return density(self.loaded)

    @cached_property
    def _without_load(self) -> Any:
        return self._with_load if self.terms else density(self._unloaded)

    def given(self, kernel: Any) -> dict[str, Any]:
        """The parameters that a kernel asks for."""
        return {name: self.parameters[name] for name in kernel.parameters}

    def energy(self, phi: Any, lam: float) -> float:
        """V(phi; lam) by Gauss's rule. `ValueError` unless phi (N m,) and lam are finite."""
        u, lam = self._state(phi, lam)
        W, grid = self.kernel(lam), self.grid
        angle, slope = grid.at_gauss(grid.nodal(u, self.phi0))
        places = rod_places.places(self, angle, grid) if W.places else ()
        V = np.sum(grid.hb * W.energy(slope, angle, *places, lam, **self.given(W)))
        return complex(V) if np.iscomplexobj(V) else float(V)  # type: ignore[return-value]

    def gradient(self, phi: Any, lam: float) -> Array:
        """dV/dphi, shape (N m,). `ValueError` unless phi (N m,) and lam are finite."""
        return self.residual(*self._state(phi, lam))

    def hessian(self, phi: Any, lam: float) -> Collocated | Full:
        """d2V/dphi2: `.toarray()`, `.index`, `.solve(b)`; symmetric, of overlapping blocks.

        Full where forces change with the place (a foundation): then a solve costs O((N m)^3).
        """
        return self.jacobian(*self._state(phi, lam))

    def d_lam(self, phi: Array, lam: float) -> Array:
        """d(gradient)/dlam, shape (N m,), of arguments that are not looked at."""
        return self.by("lam", phi, lam)

    # --- the equations F(u, lam) = 0 that a solver sees ---------------------------------------------------------

    def residual(self, u: Array, lam: float) -> Array:
        """The gradient, of arguments that are not looked at."""
        return Grid.gathered(self.tested(u, lam, self.grid))

    def residual_wide(self, u: Array, lam: float) -> Array:
        """The same computed in numpy's longest float, and rounded once: 11 bits more where the machine has them."""
        return np.asarray(Grid.gathered(self.tested(u, lam, self.grid.wide)), dtype=np.float64)

    def tested(self, u: Array, lam: float, grid: Grid) -> Array:
        """What each interval contributes to the gradient at its nodes, (N, m+1)."""
        return grid.tested(*self.moments(u, lam, grid))

    def moments(self, u: Array, lam: float, grid: Grid | None = None) -> tuple[Any, Any]:
        """W_phi' and the moment on a unit of length at Gauss's points: W_phi, and what forces on the places do."""
        W = self.kernel(lam)
        own = grid is None or grid is self.grid
        angle, slope = self.at_gauss(u) if own else grid.at_gauss(grid.nodal(u, self.phi0))  # type: ignore[union-attr]
        m, f = W.moments(slope, angle, lam, **self.given(W))
        if W.places:
            Q1, Q3 = rod_places.forces(self, angle, self.grid if grid is None else grid)
            f = f + np.cos(angle) * Q1 - np.sin(angle) * Q3
        return m, f

    def stiffness(self, u: Array, lam: float) -> tuple[Any, Any, Any]:
        """W_phi'phi', W_phi'phi and the change of the moment above with the angle, the forces as they are."""
        W = self.kernel(lam)
        angle, slope = self.at_gauss(u)
        k, mixed, soft = W.stiffness(slope, angle, lam, **self.given(W))
        if W.places:
            Q1, Q3 = rod_places.forces(self, angle, self.grid)
            soft = soft - np.sin(angle) * Q1 - np.cos(angle) * Q3
        return k, mixed, soft

    def local(self, u: Array, lam: float) -> Collocated:
        """The second variation with the forces of terms as they are: all of it but for a foundation."""
        k, mixed, soft = self.stiffness(u, lam)
        matrix = self.grid.second(self._stiff if k is self.parameters["K"] else self.grid.stiff(k), mixed, soft)
        matrix.parts = partial(self.grid.quadratic, k, mixed, soft)
        return matrix

    def hardening(self, u: Array) -> Array | None:
        """The rest of it over all nodes, the foot's first: (N m + 1, N m + 1); None where no force changes with the place.

        Kept for the last u that was asked for: the border of other ends asks for its first column too.
        """
        if not self.kernel().hardens:
            return None
        angle, _ = self.at_gauss(u)
        if self._last_hardening is None or self._last_hardening[0] is not angle:
            self._last_hardening = angle, rod_places.hardening(self, angle)
        return self._last_hardening[1]

    def jacobian(self, u: Array, lam: float) -> Collocated | Full:
        """The Hessian, of arguments that are not looked at."""
        local, rest = self.local(u, lam), self.hardening(u)
        return local if rest is None else Full(local.toarray() + rest[1:, 1:])

    @cached_property
    def _stiff(self) -> Array:
        return self.grid.stiff(self.parameters["K"])

    def by(self, name: str, u: Array, lam: float, unit: Any = 1.0) -> Array:
        """The derivative of the gradient in the load, or in a parameter that grows like `unit`, a number or (N, m)."""
        return Grid.gathered(self.by_nodes(name, u, lam, unit))

    def by_nodes(self, name: str, u: Array, lam: float, unit: Any = 1.0) -> Array:
        """The same as what each interval contributes at its nodes, (N, m+1)."""
        W, grid = self.kernel(), self.grid
        angle, slope = self.at_gauss(u)
        given = self.given(W)
        m, f = getattr(W, f"moments_{name}")(slope, angle, lam, **given)
        f = f * unit
        if W.places and hasattr(W, f"forces_{name}"):
            changes = getattr(W, f"forces_{name}")(*rod_places.places(self, angle, grid), **given)
            Q1, Q3 = (rod_places.carried(change * unit, grid) for change in changes)
            f = f + np.cos(angle) * Q1 - np.sin(angle) * Q3
        return grid.tested(np.broadcast_to(m * unit, angle.shape), f)

    def at_gauss(self, u: Array) -> tuple[Array, Array]:
        """Angles and their derivatives at Gauss's points, (N, m) each; kept for the last u that was asked for."""
        last = self._last_state
        if last is not None and last[0].size == u.size and (last[0] == u).all():
            return last[1], last[2]
        angle, slope = self.grid.at_gauss(self.grid.nodal(u, self.phi0))
        self._last_state = (u.copy(), angle, slope)
        return angle, slope

    def inner(self, u: Array, v: Array) -> float:
        """The integral of u v over the length, by Lobatto's rule."""
        return float((self.grid.weights * u) @ v)

    def start(self, guess: Any = None) -> Array:
        """Unknowns (N m,) from a guess: angles, a function of s, or None for the unstressed shape."""
        if guess is None:
            return self.unstressed()
        if callable(guess):
            guess = Profile("guess", guess).at(self.grid.places[1:])
        return vector("guess", guess, self.size).copy()

    @property
    def measures(self) -> dict[str, Callable[[Array, float], float]]:
        """Name -> function of (u, lam): what a point can be asked for."""
        return {
            "tip_angle": lambda u, _: float(u[-1]),
            "height": lambda u, lam: self.boundary("lam", u, lam),
            "energy": self.energy,
            "moment": self.moment,
            "curvature": self.curvature,
            "condition": lambda u, lam: resolution.condition(self, u, lam),
        }

    # --- what it knows besides: bounds for proofs, errors, meshes --------------------------------------------------

    def lipschitz(self, u: Array, lam: float) -> bounds.Bound:
        """How far Jacobian and d_lam may be from those at (u, lam) near by; see `rodlab.mechanics.rod_bounds`."""
        return rod_bounds.lipschitz(self, u, lam)

    def seen(self, u: Array) -> Array:
        """What of a direction the Jacobian and its bounds depend on: its values at Gauss's points, (N, m)."""
        return self.grid.seen(u)

    def embedding(self, lam: float) -> tuple[float, float]:
        """(a, b) with max |w|^2 <= a w.Jw + b w.w for the Jacobian J at any angles and this load."""
        return rod_bounds.embedding(self, lam)

    @cached_property
    def compliance(self) -> tuple[float, float]:
        return rod_bounds.compliance(self)

    def rounding(self, u: Array, lam: float, v: Array, eps: float = EPS) -> float:
        """Bound on |v . (computed gradient - exact gradient)| for arithmetic of this precision."""
        return rod_bounds.rounding(self, u, lam, v, eps)

    def sizes(self, u: Array, lam: float) -> Array:
        """Sum of the sizes of what is added up to each entry of the gradient, (N m,)."""
        return rod_bounds.sizes(self, u, lam)

    def angles(self, u: Array) -> Array:
        """The angles among the unknowns, or their part of a direction: all of them."""
        return u

    def at_mesh(self, i: int) -> int:
        """The place in u of the angle at the upper end of interval i."""
        return (i + 1) * self.degree - 1

    def observed(self, u: Array) -> int:  # noqa: ARG002
        """At which interval's end the error of a point is told: the last."""
        return self.grid.N - 1

    @cached_property
    def companion(self) -> "Rod":
        """The same rod on the same mesh with polynomials of about twice the degree, by which errors are told."""
        return self.on(self.mesh, min(2 * self.degree, self.degree + 8))

    def error(self, u: Array, lam: float) -> float:
        """Estimate from above of the error of the tip angle against the exact solution of the rod's equations."""
        return resolution.tip_error(self, u, lam)

    def inertia(self, u: Array, lam: float) -> Inertia:
        """Signs of the eigenvalues of the second variation, as far as this mesh and its companion agree on them."""
        return resolution.inertia(self, u, lam)

    def missed(self, u: Array, lam: float, v: Array) -> tuple[float, float]:
        """How much the mesh misses of v . F and of v . J v for a null vector v."""
        return resolution.missed(self, u, lam, v)

    def adapted(self, u: Array, lam: float, tangent: Array | None = None) -> "tuple[Rod, Array, Array | None] | None":
        """The rod on a mesh that serves at (u, lam), with u and tangent on it; None where its own serves."""
        return remesh.adapted(self, u, lam, tangent)

    def suited(self, guess: Any, finer: int = 0) -> "Rod":
        """The rod on a mesh on which a guess, a function of s, can be represented, halved so many times."""
        return remesh.suited(self, guess, finer)

    def moved(self, other: "Rod", u: Array, *, direction: bool = False) -> Array:
        """Unknowns of the same rod on another mesh, or a direction among them, on this one."""
        if other.grid is self.grid:
            return u
        return other.grid.onto(other.grid.nodal(u, 0.0 if direction else other.phi0), self.grid)

    # --- what is given at its ends, and what that brings about: see `rodlab.mechanics.rod_ends` -------------------------

    def under(self, **values: float) -> "Rod":
        """The same with these boundary values: phi0 and x0 of the foot, N1 and tau on the end."""
        other = self.fresh()
        other.phi0, other.x0 = values.pop("phi0", self.phi0), values.pop("x0", self.x0)
        other.parameters = {**self.parameters, **values}
        other.profiles = {**self.profiles, **{name: Profile(name, value) for name, value in values.items()}}
        return other

    def acting(self, u: Array, lam: float) -> "tuple[Rod, Array, float]":
        """The clamped rod whose state this is, its angles, and the load on it: itself."""
        return self, u, lam

    def boundary(self, name: str, u: Array, lam: float) -> float:
        """dV/d(name) of a boundary value: lam, N1, tau, phi0 or x0."""
        return rod_ends.boundary(self, name, u, lam)

    def column(self, name: str, u: Array, lam: float) -> Array:
        """d(gradient)/d(name) of a boundary value, shape (N m,)."""
        return rod_ends.column(self, name, u, lam)

    def second(self, one: str, other: str, u: Array, lam: float) -> float:
        """d2V/d(one) d(other) of two boundary values."""
        return rod_ends.second(self, one, other, u, lam)

    # --- shape ---------------------------------------------------------------------------------------------------

    def unstressed(self) -> Array:
        """phi0 + the integral of u_hat [N 2.6]: the equilibrium without load and terms."""
        u_hat = np.broadcast_to(self.parameters["u_hat"], self.grid.s.shape)
        return np.asarray(self.phi0 + self.grid.antiderivative(u_hat))

    @property
    def is_straight(self) -> bool:
        """True when phi = 0 is an equilibrium at every load."""
        if self.curved or self.phi0:
            return False
        zero = np.zeros(self.size)
        return not (self.residual(zero, 0.0).any() or self.residual(zero, 1.0).any())

    @cached_property
    def symmetries(self) -> tuple[Callable[[Array], Array], ...]:
        """Maps of the unknowns that take equilibria to equilibria: the mirror image, where the energy is the same for it."""
        return mirror(self, self.size)

    def height(self, u: Array) -> float:
        """z of the tip."""
        angle, _ = self.grid.at_gauss(self.grid.nodal(u, self.phi0))
        return float(np.sum(self.grid.hb * np.cos(angle)))

    def moment(self, u: Array, lam: float) -> float:
        """m(0), the moment in the clamp: what balances the moments of all loads, of order 2m as the angles are."""
        return -float(self.tested(u, lam, self.grid)[0, 0])

    def curvature(self, u: Array, lam: float) -> float:
        """phi'(0), from the moment in the clamp."""
        W = self.kernel(lam)
        s = np.zeros(1)
        given = {name: self.profiles[name].at(s) for name in W.parameters}
        foot = np.full(1, self.phi0)
        m0, k = W.moments(s, foot, lam, **given)[0], W.stiffness(s, foot, lam, **given)[0]
        return float(np.squeeze((self.moment(u, lam) - m0) / k))

    def shape(self, u: Any) -> tuple[Array, Array]:
        """x, z of the nodes, from the clamp (0, 0) to the tip."""
        angle, _ = self.grid.at_gauss(self.grid.nodal(vector("phi", u, self.size), self.phi0))
        x, z = (self.grid.antiderivative(f(angle)) for f in (np.sin, np.cos))
        return np.append(0.0, x), np.append(0.0, z)

    def reached(self, u: Array, lam: float) -> tuple[Array, Array]:
        """x, z of the nodes under a load, by which the rod may be sheared and extended."""
        x, z = (self.grid.antiderivative(slope) for slope in rod_ends.reach(self, u, lam))
        return np.append(self.x0, x + self.x0), np.append(0.0, z)

    def nodes(self, u: Array) -> tuple[Array, Array]:
        """s and phi of the nodes, the clamp first."""
        return self.grid.places, np.append(self.phi0, u)

    def shape_at(self, u: Array, lam: float) -> tuple[Array, Array, Array, Array]:
        """s, phi and x, z, inside of the intervals as accurate as at mesh points: those of the companion."""
        fine, v = resolution.corrected(self, u, lam)
        return *fine.nodes(v), *fine.reached(v, lam)

    def between(self, u: Array, lam: float, s: Array) -> tuple[Array, Array, Array]:
        """phi, x, z at any arclengths s (k,)."""
        fine, v = resolution.corrected(self, u, lam)
        return resolution.between(fine, v, lam, s)

    def derivation(self) -> "Limit":
        """SymPy's limit of the link: density, Euler and Lagrange's equation, first-order system; LaTeX in a notebook."""
        from rodlab.mechanics.limit import limit

        return limit(self.loaded)

    def _state(self, phi: Any, lam: Any) -> tuple[Array, float]:
        return vector("phi", phi, self.size, complex_too=True), number("lam", lam)


def _breaks(breaks: Any) -> tuple[float, ...]:
    given = vector("breaks", list(breaks) if np.iterable(breaks) else [breaks])
    if ((given <= 0) | (given >= 1)).any():
        raise ValueError(f"breaks must lie between 0 and 1; they are {given.tolist()}")
    given = np.unique(given)
    if (np.diff(given, prepend=0.0, append=1.0) < NEAREST).any():
        raise ValueError(f"breaks must be at least {NEAREST:g} apart, and from the ends; they are {given.tolist()}")
    return tuple(float(b) for b in given)


def _along_the_rod(name: str, given: Any, breaks: tuple[float, ...]) -> Profile:
    profile = Profile(name, given, breaks)
    if profile.values is not None:
        raise ValueError(f"{name} of a rod must be a number, a function of s or an expression in s; it is {given!r:.60}")
    return profile
