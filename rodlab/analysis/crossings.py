"""Where along a branch eigenvalues of the Jacobian pass through zero, or only touch it: to full precision.

On a segment of known ends, J(sigma) v = 0 is an eigenvalue problem in sigma, solved on the few vectors V nearest null:

    (V^T J V) z = -delta (V^T J' V) z,        sigma <- sigma + delta           (Ritz values: errors of V come in squared)

Each zero is fenced by two solutions of the branch close by whose indices differ by its multiplicity, so that none is
invented and, by counting, none is missed. Within the fence Hermite's cubic *is* the branch to rounding, and J is taken there:
a solution computed at a branch point itself would be wrong by the square root of rounding.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rodlab.analysis.curve import Curve, Segment
from rodlab.analysis.newton import NoConvergence
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.nullspace import NearNull, near_null, quadratic

FENCE = 1e-3  # half-width of the first fence, as a part of the segment
SMALLEST = 1e-5  # fences are not narrower: solutions there would be lost in rounding
TOGETHER = 1e-9  # zeros closer than this are one of higher multiplicity; their distance is in its error
STRAIGHT = 1e-13  # error of the cubic that serves as the branch
ROUGH = 1e-9  # the same where rounding allows no better


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A solution on the way: y, its tangent, and the index (None where not verified)."""

    y: Array
    tangent: Array
    index: int | None


class Crossing(NamedTuple):
    """A zero of `multiplicity` eigenvalues: y with the error of its load, the null vectors, and the fence around it."""

    y: Array
    error: float
    multiplicity: int
    null: NearNull
    fence: Segment
    touches: bool = False
    converged: bool = True


def change(curve: Curve, segment: Segment, sigma: float, near: NearNull, part: float = 1e-4) -> Array:
    """U^T J' V, (p, p): how J changes along the cubic on the vectors nearest null, by a central difference."""
    e = part * segment.length
    plus, minus = (curve.jacobian(segment.at(sigma + side * e)) for side in (1, -1))
    return np.asarray(near.left.T @ np.column_stack([(plus @ v - minus @ v) / (2 * e) for v in near.right.T]))


class Locator:
    """Finds the zeros on a segment of a curve."""

    def __init__(self, curve: Curve) -> None:
        self.curve = curve

    def place(self, segment: Segment, sigma: float) -> Place:
        """The solution of the branch at sigma. Raises `NoConvergence` where it is not next to the cubic."""
        guess = segment.at(sigma)
        y = self.curve.correct(guess, segment.row).y
        if self.curve.norm(y - guess) > 0.05 * abs(segment.length):
            raise NoConvergence("the branch is not where its neighbours point", ())
        return Place(y, self.curve.tangent(y, segment.derivative(sigma)), self.curve.index(y))

    def between(self, a: Place, b: Place, depth: int = 0, wrong: float = np.inf) -> list[Crossing]:
        """All zeros between two places, in order. Raises `NoConvergence` when the indices cannot be explained by any."""
        if a.index is None or b.index is None or a.index == b.index:
            return []
        if depth > 60:
            raise NoConvergence(f"an index that changes from {a.index} to {b.index} within {self._length(a, b):.2g}", ())
        segment = self.segment(a, b)
        sigma, length = self._guess(segment, abs(b.index - a.index)), segment.length
        width = max(FENCE * length, min(length / 4, SMALLEST * self._size(segment)))
        for _ in range(4):
            fence = self._fence(segment, a, b, sigma, width)
            if fence is not None:
                left, right = fence
                if left.index == right.index:
                    break
                inner = self._core(left, right, depth, wrong)
                return [*self.between(a, left, depth + 1), *inner, *self.between(right, b, depth + 1)]
            width *= 1.7
        middle = self._verified(segment)
        return [*self.between(a, middle, depth + 1), *self.between(middle, b, depth + 1)]

    def segment(self, a: Place, b: Place) -> Segment:
        """The piece of the curve between two places."""
        return Segment(a.y, a.tangent, b.y, b.tangent, self.curve.row(a.tangent))

    # --- steps of the search -----------------------------------------------------------------------------------

    def _core(self, left: Place, right: Place, depth: int, before: float = np.inf) -> list[Crossing]:
        """The zeros between two places close by: at once where the cubic serves as the branch, else after a smaller fence.

        Next to a branch point it does ever better; where two branches pass each other by (an imperfection), ever worse.
        """
        fence = self.segment(left, right)
        size = self._size(fence)
        side = fence.length / 4
        wrong = 2 * self.curve.norm(self.place(fence, side).y - fence.at(side))
        assert left.index is not None
        assert right.index is not None
        p = abs(right.index - left.index)
        if wrong <= STRAIGHT * size:
            return self.zeros(fence, p, wrong)
        if fence.length <= 4 * SMALLEST * size or wrong >= before / 4:
            if wrong > ROUGH * size:
                raise NoConvergence(f"where an eigenvalue should cross zero the branch bends by {wrong:.2g}", ())
            return self.zeros(fence, p, wrong)
        return self.between(left, right, depth + 1, wrong)

    def _guess(self, segment: Segment, p: int) -> float:
        """The zero next to the middle, by a few Ritz steps on the cubic; the middle where they lead out."""
        length = segment.length
        sigma = length / 2
        V: Array | None = None
        for _ in range(6):
            delta, near = self._deltas(segment, sigma, min(p, 4), V)
            inside = [d for d in delta if 0 < sigma + d < length]
            if not inside:
                return length / 2
            step = min(inside, key=abs)
            sigma, V = sigma + step, near.right
            if abs(step) <= FENCE * length / 4:
                break
        return sigma

    def _deltas(self, segment: Segment, sigma: float, p: int, start: Array | None = None) -> tuple[Array, NearNull]:
        """Distances from sigma to the p zeros foretold on the nearest p eigenvectors, by size."""
        curve = self.curve
        y = segment.at(sigma)
        J = curve.jacobian(y)
        near = near_null(J, p, symmetric=curve.symmetric(y), start=start)
        U, V = near.left, near.right
        slope = change(curve, segment, sigma, near)
        M = U.T @ np.column_stack([J @ v for v in V.T])
        if curve.symmetric(y):
            for j, v in enumerate(V.T):
                M[j, j] = quadratic(J, v)[0]
            M, slope = (M + M.T) / 2, (slope + slope.T) / 2
        with np.errstate(all="ignore"):
            try:
                delta = np.linalg.eigvals(-np.linalg.solve(slope, M))
            except np.linalg.LinAlgError:
                return np.array([]), near
        real = delta[np.abs(delta.imag) <= 1e-6 * np.abs(delta)].real
        return real[np.argsort(np.abs(real))], near

    def _fence(self, segment: Segment, a: Place, b: Place, sigma: float, width: float) -> tuple[Place, Place] | None:
        """Places on both sides of sigma with verified indices; None where rounding leaves one open."""
        left = a if sigma - width <= 0 else self.place(segment, sigma - width)
        right = b if sigma + width >= segment.length else self.place(segment, sigma + width)
        return (left, right) if left.index is not None and right.index is not None else None

    def _verified(self, segment: Segment) -> Place:
        """A place near the middle whose index is verified."""
        for part in (0.5, 0.43, 0.61, 0.37, 0.7, 0.29):
            found = self.place(segment, part * segment.length)
            if found.index is not None:
                return found
        raise NoConvergence(f"no index can be verified along {segment.length:.2g} of the branch", ())

    # --- zeros on a cubic that serves as the branch ----------------------------------------------------------------

    def zeros(self, fence: Segment, p: int, wrong: float) -> list[Crossing]:
        """The p zeros on a short fence, those within their errors together."""
        sigma = self._settled(fence, fence.length / 2, p)
        delta, _ = self._deltas(fence, sigma, p)
        found: list[Crossing] = []
        waiting = sorted(float(d) for d in delta)
        while waiting:
            together = [d for d in waiting if d - waiting[0] <= TOGETHER * self._size(fence)]
            waiting = waiting[len(together) :]
            own = sigma + sum(together) / len(together)
            if len(together) == 1 < p:
                own = self._settled(fence, own, p)
            found.append(self.crossing(fence, own, len(together), wrong + together[-1] - together[0], p))
        if sum(c.multiplicity for c in found) != p:
            y = fence.at(fence.length / 2)
            null = near_null(self.curve.jacobian(y), p, symmetric=self.curve.symmetric(y))
            return [Crossing(y, float(np.abs(fence.b - fence.a)[-1]), p, null, fence, converged=False)]
        return found

    def crossing(self, fence: Segment, sigma: float, multiplicity: int, wrong: float, p: int) -> Crossing:
        """The zero at sigma with its null vectors and an estimate of the error of its load."""
        y, slope = fence.at(sigma), fence.derivative(sigma)
        J = self.curve.jacobian(y)
        near = near_null(J, max(p, multiplicity), symmetric=self.curve.symmetric(y))
        rounding = max(quadratic(J, v)[1] + self.missed(y, v)[1] for v in near.right.T[:multiplicity])
        rates = np.abs(np.diag(change(self.curve, fence, sigma, near)))[:multiplicity]
        off = max(rounding / (float(rates.min()) or np.inf), EPS * self._size(fence)) + 4 * wrong
        error = off * abs(float(slope[-1])) + 2 * EPS * abs(float(y[-1])) + wrong
        null = NearNull(near.values[:multiplicity], near.right[:, :multiplicity], near.left[:, :multiplicity])
        return Crossing(y, float(error), multiplicity, null, fence)

    def missed(self, y: Array, v: Array) -> tuple[float, float]:
        """How much the mesh misses of v . F and of v . J v, where the model has a mesh."""
        own = getattr(self.curve.equations, "missed", None)
        if own is None:
            return 0.0, 0.0
        force, stiffness = own(y[:-1], float(y[-1]), v)
        return float(force), float(stiffness)

    def _settled(self, fence: Segment, sigma: float, p: int) -> float:
        """sigma moved to the zero next to it until it no longer moves."""
        last = np.inf
        for _ in range(8):
            delta, _ = self._deltas(fence, sigma, p)
            if not delta.size or abs(delta[0]) >= last / 2:
                break
            last = abs(float(delta[0]))
            sigma += float(delta[0])
            if last <= EPS * self._size(fence):
                break
        return sigma

    def _size(self, segment: Segment) -> float:
        return max(1e-3, self.curve.norm(segment.a), self.curve.norm(segment.b))

    def _length(self, a: Place, b: Place) -> float:
        return self.curve.norm(b.y - a.y)
