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
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics import bounds, remesh, resolution, rod_bounds
from rodlab.mechanics.ends import CANTILEVER, needs_reactions
from rodlab.mechanics.profile import Profile
from rodlab.mechanics.recipe import changed, kept, rod_recipe_of, said_of_rod
from rodlab.mechanics.rod_shape import RodShape
from rodlab.mechanics.terms import BENDING, BENDING_WITH_REST, END_LOAD, Term, checked
from rodlab.numerics.arrays import EPS, Array, number, vector, whole
from rodlab.numerics.collocation import Grid
from rodlab.numerics.inertia import Inertia
from rodlab.numerics.mesh import given_mesh, spread_out
from rodlab.numerics.pieces import smooth_pieces

if TYPE_CHECKING:
    pass

FIRST = 4  # intervals of the first mesh
HIGHEST = 32  # degree
NEAREST = 1e-9  # distance of breaks
DERIVED = ("companion", "compliance", "_stiff", "_with_load", "_without_load", "symmetries")  # of mesh and parameters


class Rod(RodShape):
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
    def freedom(self) -> int:
        """Number of eigenvalues of the second variation."""
        return self.size

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

    # --- what a point asks for -------------------------------------------------------------------------------------------

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

    def shape_at(self, u: Array, lam: float) -> tuple[Array, Array, Array, Array]:
        """s, phi and x, z, inside of the intervals as accurate as at mesh points: those of the companion."""
        fine, v = resolution.corrected(self, u, lam)
        return *fine.nodes(v), *fine.reached(v, lam)

    def between(self, u: Array, lam: float, s: Array) -> tuple[Array, Array, Array]:
        """phi, x, z at any arclengths s (k,)."""
        fine, v = resolution.corrected(self, u, lam)
        return resolution.between(fine, v, lam, s)


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
