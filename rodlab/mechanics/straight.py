"""Where the straight state of any strut or rod is singular: buckling loads with terms, between any ends, in any parameter.

    M(p) w = 0,    M(p) the second variation at phi = 0 under the load, weight, ... p, on the directions that the ends leave

A load is isolated by the index, which tells how many lie below p, and found by Rayleigh's quotient iteration

    w <- M(p)^{-1} M'(p) w,    p <- p - w . M(p) w / w . M'(p) w            [Lancaster 1961; cubic, M symmetric]

M is linear in p, or quadratic where the rod shears and extends: its derivative by a central difference is exact. O(n) a load; of
a rod also what a companion of eight degrees more changes, on meshes halved until that is small.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from rodlab.mechanics.resolution import softening
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.constrained import Constrained
from rodlab.numerics.factor import inertia_of, solve
from rodlab.numerics.inertia import Symmetric
from rodlab.numerics.mesh import halved
from rodlab.numerics.nullspace import quadratic

DEGREE, MORE = 10, 8
WANTED = 1e-12  # relative error of a load of a rod
MESHES = 7  # tried for it
LOOKS = 64  # loads at which the index of a rod that extends is asked, up to where it would be crushed
WIDEST = 1e150  # of a bracket
ROUGH = 1e-6  # relative change of a load that no longer falls, at most: rounding


class Load(NamedTuple):
    """A load, an estimate of its error from above, and its mode: a model and the unknowns' direction."""

    load: float
    error: float
    model: Any
    mode: Array


class Bracket(NamedTuple):
    """Between low and high the index passes from passed - 1 to `passed`, upwards (rises 1) or back (-1)."""

    low: float
    high: float
    passed: int
    rises: int


class Straight:
    """The second variation at the straight state of a model, for all p."""

    def __init__(self, model: Any) -> None:
        self.model = model
        self.zero = np.zeros_like(model.start())
        self.held = len(getattr(model, "unknowns", ()))

    def matrix(self, p: float) -> Any:
        """M(p)."""
        return self.model.jacobian(self.zero, p)

    def below(self, p: float) -> tuple[int, int]:
        """Negative eigenvalues of M(p): certainly, and at most."""
        known = inertia_of(self.matrix(p))
        assert known is not None
        return known.negative, known.negative + known.unclear

    def refined(self, low: float, high: float) -> tuple[float, float, Array] | None:
        """The load between two that hold one alone, its rounding and its mode; None where the iteration leads elsewhere."""
        p, w, last = (low + high) / 2, np.cos(1.7 * np.arange(self.zero.size) ** 1.5) + 0.3, np.inf
        w[: self.held] = 0.0
        e = max(abs(low), abs(high), high - low) / 4
        for sweep in range(40):
            plus, minus = self.matrix(p + e), self.matrix(p - e)
            with np.errstate(all="ignore"):
                matrix = self.matrix(p)
                right = (plus @ w - minus @ w) / (2 * e)
                w = matrix.solve_fully(right) if isinstance(matrix, Symmetric) else solve(matrix, right)
                size = float(np.abs(w[self.held :]).max(initial=0.0))
                if not (np.isfinite(w).all() and size > 0):
                    return None
                w = w / size
                value, rounding = _quotient(matrix, w)
                slope = (_quotient(plus, w)[0] - _quotient(minus, w)[0]) / (2 * e)
            if slope == 0:
                return None
            moved, off = p - value / slope, abs(rounding / slope)
            change = abs(moved - p)
            if sweep > 2:  # at first the shift stays, so that the nearest mode is what is left
                p = moved
            if not low < moved < high and sweep > 2:
                return None
            if sweep > 2 and (change <= max(off, 4 * EPS * abs(p)) or (change >= last and change <= ROUGH * abs(p))):
                return p, off + change + 2 * EPS * abs(p), w
            last = change if sweep > 2 else np.inf
        return None


def _quotient(matrix: Any, w: Array) -> tuple[float, float]:
    """w . M w and a bound on its rounding, of a rod by what its blocks were summed from: a jump of K costs no digits."""
    if isinstance(matrix, Constrained):
        return matrix.quadratic(w, of=_quotient)
    parts = getattr(matrix, "parts", None)
    known: tuple[float, float] = quadratic(matrix, w) if parts is None else parts(w)
    return known


def straight_loads(model: Any, numbers: Sequence[int]) -> Iterator[Load]:
    """The loads of these numbers, ascending. `ValueError` where there are not so many, `ArithmeticError` for one not resolved."""
    if hasattr(model, "mesh"):
        yield from _of_rod(model, numbers)
        return
    straight, brackets = Straight(model), _brackets(model)
    for j in numbers:
        load, error, w = _load(straight, brackets(straight, j))
        yield Load(load, error, model, w)


def _of_rod(rod: Any, numbers: Sequence[int]) -> Iterator[Load]:
    own = rod.on(rod.mesh, DEGREE)
    brackets = _brackets(rod)
    for j in numbers:
        best: Load | None = None
        for _ in range(MESHES):
            straight = Straight(own)
            load, error, w = _load(straight, brackets(straight, j))
            coarse = _coarse(own, straight, load)
            if coarse is None:
                fine = Straight(own.on(own.mesh, own.degree + MORE))
                near = max(0.01 * abs(load), 4 * error)
                better = fine.refined(load - near, load + near)
                found = Load(load, np.inf, own, w) if better is None else Load(better[0], 0.0, fine.model, better[2])
                error += np.inf if better is None else better[1] + 2 * abs(better[0] - load)
                if best is None or error < best.error:
                    best = found._replace(error=error)
                if error <= max(WANTED * abs(load), 4 * (better[1] if better is not None else 0.0)):
                    break
            own = own.on(halved(own.mesh) if coarse is None else coarse, DEGREE)
        if best is None or not np.isfinite(best.error):
            raise ArithmeticError(f"load {j} near {load:.6g} is not resolved by {own.mesh.size - 1} intervals")
        yield best


def _coarse(rod: Any, straight: Straight, load: float) -> Array | None:
    """A finer mesh where an interval by itself would have buckled, or nearly; None where this one serves."""
    own, zero, lam = rod.acting(straight.zero, load)
    K = np.broadcast_to(own.parameters["K"], own.grid.s.shape).min(axis=1)
    turn = np.diff(own.mesh) ** 2 * softening(own, zero, lam).max(axis=1) / K
    if turn.max() <= 2.0:
        return None
    parts = np.ceil(np.sqrt(turn / 1.5)).astype(int).clip(1, 1000)
    cut = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(own.mesh, own.mesh[1:], parts, strict=False)]
    return np.append(np.concatenate(cut), 1.0)


# --- brackets ---------------------------------------------------------------------------------------------------------


def _load(straight: Straight, bracket: Bracket) -> tuple[float, float, Array]:
    """The load in a bracket, its error and its mode."""
    low, high, j, rises = bracket

    def side(p: float) -> int:
        sure, maybe = straight.below(p)
        return rises * (-1 if maybe < j else 1 if sure >= j else 0)

    for _ in range(400):
        a, b = straight.below(low), straight.below(high)
        if a[0] == a[1] and b[0] == b[1] and abs(b[0] - a[0]) == 1:
            found = straight.refined(low, high)
            if found is not None:
                return found
        for part in (0.5, 0.45, 0.6, 0.3):
            middle = low + part * (high - low)
            where = side(middle)
            if where:
                break
        if not where or not low < middle < high or high - low <= 8 * EPS * max(abs(low), abs(high)):
            break
        low, high = (middle, high) if where < 0 else (low, middle)
    found = straight.refined(low - (high - low), high + (high - low))  # several loads in one place
    mode = np.zeros_like(straight.zero) if found is None else found[2]
    return (low + high) / 2, (high - low) / 2 + 8 * EPS * max(abs(low), abs(high)), mode


def _brackets(model: Any) -> Callable[[Straight, int], Bracket]:
    """A function (straight, number) -> where that load is."""
    limit = _crushed(model)
    return _rising if limit is None else _Looked(limit)


def _rising(straight: Straight, j: int) -> Bracket:
    """Where the index rises with p: from below all loads to above j of them."""
    unit = 1.0 / _flexibility(straight.model)
    high = reach = unit
    while straight.below(high)[0] < j:
        high *= 2
        if high > WIDEST * unit:
            raise ValueError(f"modes must be at most {straight.below(high)[0]}, the number of loads; it is {j}")
    low = 0.0
    while straight.below(low)[1] >= j:
        low, reach = -reach, 2 * reach
        if reach > WIDEST * unit:
            raise ValueError(f"the index must rise with what is followed; it is {straight.below(low)[0]} however far below zero")
    return Bracket(low, high, j, 1)


class _Looked:
    """Brackets for a rod that extends: the index rises and falls again, up to the load at which it would be crushed."""

    def __init__(self, limit: tuple[float, Array]) -> None:
        self.limit, self.peaks = limit

    def __call__(self, straight: Straight, number: int) -> Bracket:
        found: list[Bracket] = []
        at = np.unique(np.concatenate([np.linspace(0.0, self.limit, LOOKS + 1)[:-1], self.peaks, [self.limit * (1 - 1e-9)]]))
        last, before = 0.0, self._known(straight, 0.0)
        for p in at[1:]:
            here = self._known(straight, float(p))
            if here is None:
                continue
            if before is not None and here != before:
                step = 1 if here > before else -1
                passed = range(before + 1, here + 1) if step > 0 else range(before, here, -1)
                found += [Bracket(last, float(p), j, step) for j in passed]
            last, before = float(p), here
        if number > len(found):
            most = f"{len(found)}, the number of loads below {self.limit:g}, which crushes the rod"
            raise ValueError(f"modes must be at most {most}; it is {number}")
        return found[number - 1]

    @staticmethod
    def _known(straight: Straight, p: float) -> int | None:
        sure, maybe = straight.below(p)
        return sure if sure == maybe else None


def _crushed(model: Any) -> tuple[float, Array] | None:
    """The load A3 at which an extensible rod would have no length, and where its index may turn; None for any other."""
    own = getattr(model, "base", getattr(model, "rod", getattr(model, "strut", model)))
    if "extension" not in own.parameters or getattr(model, "follows", "lam") != "lam" or hasattr(model, "sharing"):
        return None
    extension, shear = (np.ravel(own.parameters[name]) for name in ("extension", "shear"))
    if not extension.max() > 0:
        return None
    limit = 1 / float(extension.max())
    delta = extension - shear
    with np.errstate(divide="ignore"):
        turns = np.unique(1 / (2 * delta[delta > 0]))[:16] if (delta > 0).any() else np.array([])
    return limit, turns[turns < limit]


def _flexibility(model: Any) -> float:
    own = getattr(model, "base", getattr(model, "rod", getattr(model, "strut", model)))
    return float(own.flexibility)
