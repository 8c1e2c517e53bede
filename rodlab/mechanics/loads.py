"""Buckling loads of a straight rod for any stiffness K(s): a Sturm-Liouville problem [N 2.8.1].

    -(K w')' = lam w,   w(0) = 0,   K w'(1) = 0          lam_j = ((2j-1) pi/2)^2 for K = 1

Collocated on a mesh that follows sqrt(lam / K), it is the pencil S - lam M. A load is isolated by the index, which rises by one
at each, found by Rayleigh's quotient iteration, and told as the quotient itself,

    lam = sum h b K w'^2 / sum h b w^2,

sums of positive terms, stationary in w, so that no cancellation touches it however K jumps. Its error is what a companion of
eight degrees more changes, and rounding. O(N) a mode, N of the order of the mode.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.collocated import Collocated, Condensed
from rodlab.numerics.collocation import Grid
from rodlab.numerics.difference import DifferenceForm, Springs
from rodlab.numerics.mesh import equidistributed, halved

if TYPE_CHECKING:
    from rodlab.mechanics.rod import Rod

DEGREE, MORE = 10, 8  # of the polynomials, and of the companion's besides
PHASE = 1.0  # of a mode, sqrt(lam / K) h, on an interval
FEWEST = 4  # intervals
WANTED, AIM = 1e-12, 1e-14  # relative error of a load: asked for, and that a better mesh is made for
TRIES = 400  # bounds tried for a load
MESHES = 12  # tried for a load
LARGEST = 1e153  # of K and 1/K


class Load(NamedTuple):
    """A buckling load, a bound on its error, and the mode: its grid and nodal values, largest 1, first positive."""

    load: float
    error: float
    grid: Grid
    mode: Array
    missed: Array  # by each interval of the mesh, relative to the load
    rounding: float  # the part of the error that a finer mesh does not mend


class Pencil:
    """S - lam M on a grid."""

    def __init__(self, rod: "Rod", mesh: Array, degree: int) -> None:
        self.rod, self.grid = rod, Grid(mesh, degree)
        K = rod.profiles["K"]
        self.K = np.broadcast_to(K.positive(K.at(self.grid.s), self.grid.s), self.grid.s.shape)
        self.stiff = self.grid.stiff(self.K)
        self.mass = self.grid.soft(self.grid.hb).reshape(self.stiff.shape)

    @cached_property
    def companion(self) -> "Pencil":
        """The same on the same mesh, of eight degrees more."""
        return Pencil(self.rod, self.grid.mesh, self.grid.degree + MORE)

    def at(self, lam: float) -> Collocated:
        """S - lam M."""
        n = self.grid.degree + 1
        return Collocated((self.stiff - lam * self.mass).reshape(-1, n, n), self.grid.layout)

    def condensed(self, lam: float) -> tuple[DifferenceForm, Array, Array] | None:
        """S - lam M condensed to the mesh points, (the tridiagonal, F, the inner inverse); None where the mesh is too coarse.

        As springs k between the points and a softening c of each, D^T k D - C: the response to a constant needs no stiffness, so
        that c is not what is left over of K, and nothing is lost whatever its contrast.
        """
        n = self.grid.degree + 1
        blocks, mass = ((part.reshape(-1, n, n)) for part in (self.stiff - lam * self.mass, self.mass))
        inner, coupling = blocks[:, 1:-1, 1:-1], blocks[:, 1:-1, :: n - 1]
        try:
            np.linalg.cholesky(inner)
            inverse = np.linalg.inv(inner)
        except np.linalg.LinAlgError:  # an interval by itself has buckled
            return None
        F = np.asarray(inverse @ coupling)
        known = Condensed(blocks[:, :: n - 1, :: n - 1] - coupling.transpose(0, 2, 1) @ F, F, np.asarray(inverse))
        k, ends = known.springs(-lam * mass.sum(axis=2))
        return DifferenceForm(Springs(k), -Grid.gathered(ends)), F, known.inverse

    def below(self, lam: float) -> tuple[int, int]:
        """Loads certainly below this one, and those that may be."""
        condensed = self.condensed(lam)
        if condensed is None:
            known = self.at(lam).inertia()
        else:
            known = condensed[0].inertia(64 * (self.grid.degree + 1) * EPS * np.abs(condensed[0].c))
        return known.negative, known.negative + known.unclear

    def solve(self, lam: float, b: Array) -> Array:
        """w with (S - lam M) w = b."""
        condensed = self.condensed(lam)
        if condensed is None:
            return self.at(lam).factor().solve(b)
        form, F, inverse = condensed
        rows = b.reshape(self.grid.N, -1)
        inner = rows[:, :-1]
        shares = (inner[:, None, :] @ F)[:, 0]
        right = rows[:, -1] - Grid.gathered(shares)
        ends = form.solve_fully(right)
        both = np.stack([np.append(0.0, ends[:-1]), ends], axis=1)
        within = (inverse @ inner[:, :, None])[:, :, 0] - (F @ both[:, :, None])[:, :, 0]
        return np.concatenate([within, ends[:, None]], axis=1).ravel()

    def quotient(self, w: Array) -> tuple[float, float]:
        """Rayleigh's quotient of w (N m,) and a bound on its rounding."""
        grid = self.grid
        Y = grid.nodal(w, 0.0)
        value, slope = grid.at_gauss(Y)
        bending, length = float(np.sum(grid.hb * self.K * slope**2)), float(np.sum(grid.hb * value**2))
        spread = (np.abs(Y[:, 1:] - Y[:, :1]) @ np.abs(grid.slope) + np.abs(Y).max(axis=1, keepdims=True)) / grid.h[:, None]
        lost = float(np.sum(grid.hb * self.K * np.abs(slope) * spread)) / length
        return bending / length, EPS * (2 * lost + 8 * grid.degree * bending / length)

    def iterated(self, lam: float, w: Array, sweeps: int, *, fixed: bool = False) -> tuple[float, float, Array]:
        """Rayleigh's quotient iteration from a shift, or inverse iteration with it: quotient, its rounding, and the vector."""
        found, rounding = lam, np.inf
        for _ in range(sweeps):
            with np.errstate(all="ignore"):
                w = self.solve(lam, self.mass_times(w))
            size = float(np.abs(w).max())
            if not (np.isfinite(size) and size > 0):
                break
            w = w / size
            found, rounding = self.quotient(w)
            change = abs(found - lam)
            lam = lam if fixed else found
            if change <= max(rounding / 8, 4 * EPS * abs(found)):
                break
        return found, rounding, w

    def mass_times(self, w: Array) -> Array:
        """M w."""
        n = self.grid.degree + 1
        return Grid.gathered((self.mass.reshape(-1, n, n) @ self.grid.nodal(w, 0.0)[:, :, None])[:, :, 0])


def rod_loads(rod: "Rod", numbers: Sequence[int]) -> Iterator[Load]:
    """The loads of these mode numbers, ascending, as they are found. Raises `ValueError` for a K out of range."""
    pencil = Pencil(rod, _first_mesh(rod), DEGREE)
    known: list[tuple[int, float]] = [(0, 0.0)]
    for j in numbers:
        guess = _guess(rod, j, known)
        low = high = guess
        while True:
            finer = _resolving(pencil, max(high, guess))
            if finer is not None:
                pencil, low = Pencil(rod, finer, DEGREE), high
            elif high > low:
                break
            else:
                low, high = _isolated(pencil, j, guess)
                guess = (low + high) / 2
        found = _found(pencil, j, low, high)
        tries = 2
        for _ in range(MESHES):
            if not tries or found.error <= WANTED * abs(found.load) or found.error <= 4 * found.rounding:
                break
            mesh = equidistributed(pencil.grid.mesh, found.missed, AIM, 2 * DEGREE + 1, rod.breaks)
            if mesh.size <= pencil.grid.mesh.size:
                mesh = halved(mesh)
            finer_pencil = Pencil(rod, mesh, DEGREE)
            better = _found(finer_pencil, j, *_isolated(finer_pencil, j, found.load))
            if better.error > found.error / 2:
                tries -= 1
            if better.error < found.error:
                pencil, found = finer_pencil, better
            else:
                break
        known.append((j, found.load))
        yield found


def mesh_load(rod: "Rod", j: int) -> tuple[float, float]:
    """Load j of a rod as its own mesh and degree have it, and a bound on rounding: what a study of the mesh compares.

    >>> from rodlab.mechanics.rod import Rod
    >>> load, rounding = mesh_load(Rod(mesh=2, degree=1), 1)             # two links: 8 (1 - cos(pi/4)) / cos(pi/8)^2
    >>> round(load, 12), rounding < 1e-13
    (2.745166004061, True)
    """
    if j > rod.size:
        raise ValueError(f"mode must be at most {rod.size}, the number of unknowns on the mesh; it is {j}")
    pencil = Pencil(rod, rod.mesh, rod.degree)
    load, rounding, _ = _alone(pencil, j, *_isolated(pencil, j, _guess(rod, j, [])))
    return load, rounding


def _found(pencil: Pencil, j: int, low: float, high: float) -> Load:
    """Load j between bounds that hold it alone. Raises `ArithmeticError` where it cannot be told from its neighbours."""
    load, rounding, w = _alone(pencil, j, low, high)
    fine = pencil.companion
    better, finest, v = fine.iterated(load, pencil.grid.onto(pencil.grid.nodal(w, 0.0), fine.grid), 3)
    error = 2 * abs(better - load) + rounding + finest
    missed = np.abs(_shares(fine, v, better) - _shares(pencil, w, better))
    mode = np.append(0.0, v)
    mode /= np.sign(mode[np.flatnonzero(mode)[0]]) * float(np.abs(mode).max())
    return Load(better, error, fine.grid, mode, missed / max(abs(better), 1e-300), rounding + finest)


def _alone(pencil: Pencil, j: int, low: float, high: float) -> tuple[float, float, Array]:
    """The pencil's own load j, its rounding and its vector. Raises `ArithmeticError` where a neighbour is too near."""
    for _ in range(60):
        load, rounding, w = _nearest(pencil, low, high)
        if low < load < high:
            return load, rounding, w
        low, high = _narrowed(pencil, j, low, high)  # a neighbour is nearer to the middle
    raise ArithmeticError(f"load {j} cannot be told from its neighbours between {low:.9g} and {high:.9g}")


def _nearest(pencil: Pencil, low: float, high: float) -> tuple[float, float, Array]:
    """The load nearest to the middle, found from a vector with something of every mode."""
    n = pencil.grid.N * pencil.grid.degree
    w = np.cos(1.7 * np.arange(n) ** 1.5) + 0.3
    load, _, w = pencil.iterated((low + high) / 2, w, 4, fixed=True)
    return pencil.iterated(load, w, 40) if low < load < high else (load, np.inf, w)


def _shares(pencil: Pencil, w: Array, load: float) -> Array:
    """What each interval adds to w.(S - lam M)w, for w of length one, (N,)."""
    grid = pencil.grid
    value, slope = grid.at_gauss(grid.nodal(w, 0.0))
    share = np.sum(grid.hb * (pencil.K * slope**2 - load * value**2), axis=1)
    return np.asarray(share / float(np.sum(grid.hb * value**2)))


def _first_mesh(rod: "Rod") -> Array:
    K = rod.parameters["K"]
    if not (float(np.max(K)) < LARGEST and float(np.min(K)) > 1 / LARGEST):
        raise ValueError(f"K must lie between 1e-153 and 1e153 for loads; it reaches {float(np.max(K)):g}")
    return np.union1d(rod.pieces, np.linspace(0, 1, FEWEST + 1))


def _guess(rod: "Rod", j: int, known: list[tuple[int, float]]) -> float:
    """By the waves of the modes before, else by the phase that sqrt(lam / K) must run through."""
    if len(known) > 2:
        (i, a), (k, b) = known[-2:]
        return float((np.sqrt(b) + (np.sqrt(b) - np.sqrt(a)) / (k - i) * (j - k)) ** 2)
    K = np.broadcast_to(rod.parameters["K"], rod.grid.s.shape)
    return float(((j - 0.5) * np.pi / np.sum(rod.grid.hb / np.sqrt(K))) ** 2)


def _isolated(pencil: Pencil, j: int, guess: float) -> tuple[float, float]:
    """Bounds around load j: j - 1 loads are certainly below the one, j below the other, and no more."""
    low, high = guess * (1 - 0.5 / j), guess * (1 + 0.5 / j)
    at_low, at_high = pencil.below(low), pencil.below(high)
    for tries in range(TRIES):
        grow = (1 + 1 / j if j > 2 else 2) ** (1 + tries // 8)  # a guess by the continuum is far off where a mesh is coarse
        if at_low[1] >= j:  # too high for a lower bound
            if at_low[0] >= j:
                high, at_high = low, at_low
            low /= grow
            at_low = pencil.below(low)
        elif at_high[0] < j:
            if at_high[1] < j:
                low, at_low = high, at_high
            high *= grow
            at_high = pencil.below(high)
        elif at_low == (j - 1, j - 1) and at_high == (j, j):
            return low, high
        else:
            before = low, high
            low, high = _narrowed(pencil, j, low, high)
            at_low, at_high = pencil.below(low), pencil.below(high)
            if (low, high) == before:
                break
    raise ArithmeticError(f"load {j} cannot be told from its neighbours near {guess:.6g}: rounding hides it")


def _narrowed(pencil: Pencil, j: int, low: float, high: float) -> tuple[float, float]:
    """One bisection; a middle that is too near the load to tell is avoided."""
    for part in (0.5, 0.4, 0.65):
        middle = low + part * (high - low)
        sure, maybe = pencil.below(middle)
        if maybe < j:
            return middle, high
        if sure >= j:
            return low, middle
    return low, high


def _resolving(pencil: Pencil, lam: float) -> Array | None:
    """A mesh on whose intervals a mode turns by no more than PHASE; None where the pencil's own will do."""
    mesh = pencil.grid.mesh
    phase = np.diff(mesh) * np.sqrt(lam / pencil.K.min(axis=1))
    if phase.max() <= PHASE:
        return None
    parts = np.ceil(1.2 * phase / PHASE).astype(int).clip(1, 1000)
    return np.append(np.concatenate([np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(mesh, mesh[1:], parts, strict=False)]), 1.0)
