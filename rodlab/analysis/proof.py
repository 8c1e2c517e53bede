"""A proof that a piece of a branch was followed without a jump: Newton and Kantorovich along a chord.

On the chord from y_a to y_b, y_c its middle, let the Jacobian J and F_lam = f move by no more than `lipschitz` allows within a
tube of radius r around it. Two ways:

    regular  |eigenvalues of J| >= kappa in the tube, by the inertia of J_c -+ (d + kappa). Any solution in the tube is within
             e of the chord at its load, e = |F| / kappa. If e < r the solution curve can neither end nor leave the tube,
             nor meet another: J keeps its index, and there is no fold and no branch point. Where two chords meet
             F is small, and the curve passes from one tube into the next.
    fold     the same for [J f; f^T 0], the curve as a function of f . u: |eigenvalues of J on the plane normal to f| >= kappa.
             The curve may turn; [J f] keeps its full rank, so that there is no branch point.

A proof in exact arithmetic: rounding is covered where inertia is counted, by margins in the norms, and not in the residual.
Without `lipschitz` the same test with the changes seen at the ends in its place is a check and no proof.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from rodlab.analysis.curve import Curve, Segment
from rodlab.numerics.arrays import Array
from rodlab.numerics.bordered import OneBorder
from rodlab.numerics.constrained import Constrained
from rodlab.numerics.factor import factor, index_within, largest_change, shifted
from rodlab.numerics.full import Full, relative_change
from rodlab.numerics.slack import form, largest

MARGIN = 1.01  # on every bound, for rounding in computing it
EXTENDED = 1.1  # a fold is shown for a chord this much longer, for what lies between its ends and its neighbours'
WIDEST = 0.5  # radius of a tube
FEW = 200  # order up to which a change of a matrix is seen in all directions, not by its norm alone
FINEST = 2.0**-5  # the smallest part of a segment that is tried

Kind = Literal["regular", "fold", "open"]


@dataclass(frozen=True, slots=True)
class Span:
    """A part of a segment, sigma from `start` to `stop`: what was shown of it, and the index where it is constant."""

    start: float
    stop: float
    kind: Kind
    index: int | None
    reach: float = math.inf  # how far, in any unknown, the solution may be from the ends of the chord
    turn: float = 0.0  # of a fold: how much of the chord a change of the solution by one moves its plane


class _Chord(NamedTuple):
    """A chord: its ends, the larger residual there, its middle, half of its extent, and the tube around it."""

    a: Array
    b: Array
    residual: float
    middle: Array
    du: Array
    dlam: float
    r: float  # radius of the tube in any one unknown, and in the load
    r_lam: float
    gate: float  # the same where two tubes meet
    bound: Any  # what `lipschitz` knows at the middle

    @property
    def step(self) -> Array:
        return np.asarray(self.b - self.a)


class Prover:
    """Shows, span by span, that a segment is one piece of one branch."""

    def __init__(self, curve: Curve) -> None:
        self.curve = curve
        self.lipschitz: Any = getattr(curve.equations, "lipschitz", None)
        self.seen: Any = getattr(curve.equations, "seen", np.asarray)

    @property
    def proves(self) -> bool:
        """True when the model knows bounds, so that what is shown is proved."""
        return self.lipschitz is not None

    def spans(self, segment: Segment, finest: float = FINEST, *, hasty: bool = False) -> list[Span]:
        """The segment in spans, each regular, a fold, or open: not shown with parts of the size `finest`.

        hasty: all of it is called open as soon as a part is.
        """
        length = segment.length
        if not self.curve.has_index(segment.a):
            return [Span(0.0, length, "open", None)]
        if self.proves and not self._applies(segment.a):
            self.lipschitz = None
        found: list[Span] = []
        waiting = [(0.0, 1.0)]
        gate = float(np.abs(self.seen((segment.b - segment.a)[:-1])).max(initial=0.0)) / 64 + 1e-9
        ends = {0.0: (segment.a, 0.0), 1.0: (segment.b, 0.0)}  # solutions: what is left of F there is rounding
        while waiting:
            start, stop = waiting.pop()
            span = self._shown(self._chord(ends[start], ends[stop], gate), start * length, stop * length)
            if not found and stop - start == 1 and span.kind == "open" and self._drowned(segment, gate):
                return [span]
            if span.kind == "open" and stop - start > finest * 1.5:
                middle = (start + stop) / 2
                y = segment.at(middle * length)
                ends[middle] = (y, self._residual(y))
                waiting += [(middle, stop), (start, middle)]
                continue
            if span.kind == "open" and hasty:
                return [Span(0.0, length, "open", None)]
            found.append(span)
        return _merged(_joined(found))

    def _drowned(self, segment: Segment, gate: float) -> bool:
        """True when rounding of F alone, as it is at the ends, asks for more than J has: parts would not be shown either."""
        if not self.proves:
            return False
        noise = max(self._residual(segment.a), self._residual(segment.b))
        kappa = self._held(self._chord((segment.a, 0.0), (segment.b, 0.0), gate), noise, gate)
        return index_within(self.curve.jacobian(segment.at(segment.length / 2)), kappa) is None

    def _applies(self, y: Array) -> bool:
        """True when the bounds are finite and the index is that of the Jacobian itself."""
        d, _ = self.lipschitz(y[:-1], float(y[-1]))(0.0, 0.0)
        own = getattr(self.curve.equations, "second_variation", None)
        same = own is None or largest_change(self.curve.second_variation(y), self.curve.jacobian(y)) == 0
        return math.isfinite(largest(d)) and same and self.curve.symmetric(y)

    def _shown(self, chord: _Chord, start: float, stop: float) -> Span:
        if not self.proves:
            index = self._regular_as_seen(chord)
            return Span(start, stop, "open" if index is None else "regular", index, 0.0)
        regular = self._regular(chord)
        if regular is not None:
            return Span(start, stop, "regular", *regular)
        fold = self._fold(chord)
        return Span(start, stop, "open", None) if fold is None else Span(start, stop, "fold", None, *fold)

    def _chord(self, a: tuple[Array, float], b: tuple[Array, float], gate: float) -> _Chord:
        half, middle = (b[0] - a[0]) / 2, (a[0] + b[0]) / 2
        du, dlam = np.abs(self.seen(half[:-1])), abs(float(half[-1]))
        r = max(float(du.max(initial=0.0)) / 8, 2 * gate)
        bound = self.lipschitz(middle[:-1], float(middle[-1])) if self.proves else None
        return _Chord(a[0], b[0], max(a[1], b[1]), middle, du, dlam, r, dlam / 4 + gate, gate, bound)

    def _residual(self, y: Array) -> float:
        F = self.curve.residual(y)
        size = math.sqrt(float(F @ F))
        return MARGIN * size if math.isfinite(size) else math.inf

    # --- regular -----------------------------------------------------------------------------------------------

    def _regular(self, chord: _Chord) -> tuple[int, float] | None:
        """The index, constant in the tube, and how far the solution may be from the ends; or None."""
        rho, r = self._tube(chord)
        d, _ = self._bounds(chord, r)
        kappa = max(self._held(chord, rho, r), self._held(chord, chord.residual, chord.gate))
        if not (math.isfinite(kappa) and np.isfinite(largest(d))):
            return None
        index = index_within(self.curve.jacobian(chord.middle), MARGIN * d + kappa)
        a, b = self._embedding(chord)
        return None if index is None else (index, chord.residual * math.sqrt(a / kappa + b / kappa**2) if kappa else 0.0)

    def _tube(self, chord: _Chord) -> tuple[float, float]:
        """Bound rho on F along the chord, and the radius r for which little is asked of J: rho / r + the change of J with r."""
        at_rest, wider = self._bounds(chord, 0.0), self._bounds(chord, chord.r)
        rho = chord.residual + _bend(chord, *at_rest)
        slope = (largest(wider[0]) - largest(at_rest[0])) / chord.r
        asked = self._held(chord, rho, chord.r) * chord.r
        r = math.sqrt(asked / slope) if slope > 0 and math.isfinite(asked) else chord.r
        return rho, min(max(r, chord.r), max(WIDEST, chord.r))

    def _held(self, chord: _Chord, rho: float, r: float) -> float:
        """kappa for which a residual rho moves a solution by less than r: rho sqrt(a / kappa + b / kappa^2) = r."""
        a, b = self._embedding(chord)
        return MARGIN * rho * (rho * a + math.sqrt(rho * rho * a * a + 4 * r * r * b)) / (2 * r * r)

    def _regular_as_seen(self, chord: _Chord) -> int | None:
        """The same with the changes seen at the ends for bounds: a check."""
        matrix, ends = self.curve.second_variation(chord.middle), [self.curve.second_variation(y) for y in (chord.a, chord.b)]
        if isinstance(matrix, (Constrained, Full)) and matrix.shape[0] <= FEW:
            near = max(relative_change(matrix.toarray(), end.toarray()) for end in ends)
            return index_within(matrix, 0.0) if near < 1 / 2 else None
        change = max(largest_change(end, matrix) for end in ends)
        return index_within(matrix, 2 * change) if math.isfinite(change) else None

    # --- fold --------------------------------------------------------------------------------------------------

    def _fold(self, chord: _Chord) -> tuple[float, float] | None:
        """How far the solution may be from the ends, and how much that moves the plane; None where nothing is shown."""
        curve, step = self.curve, chord.step
        f = curve.d_lam(chord.middle)
        along = abs(float(f @ step[:-1]))
        if along == 0:
            return None
        J = curve.jacobian(chord.middle)
        rho, r = self._tube(chord)
        chord = chord._replace(r=r, r_lam=max(chord.r_lam, chord.dlam))
        d, c = self._bounds(chord._replace(du=EXTENDED * chord.du, dlam=EXTENDED * chord.dlam), r, chord.r_lam)
        with np.errstate(all="ignore"):
            z = OneBorder(factor(J), f, f, 0.0).solve(np.append(np.zeros_like(f), 1.0))
            left = J @ z[:-1] + z[-1] * f
        if not (np.isfinite(z).all() and np.isfinite(largest(d))) or abs(left).max() > 1e-6 * abs(z[-1]) * abs(f).max():
            return None
        turned = self._turned(chord, z[:-1], rho, d, c)
        if turned is None or not self._compressed(J, f, MARGIN * d + turned[0]):
            return None
        return turned[1], float(np.abs(f).sum()) / along

    def _turned(self, chord: _Chord, z: Array, rho: float, d: Any, c: Any) -> tuple[float, float] | None:
        """kappa on the plane for which solutions stay within the tube, by doubling it until the bounds close; their distance."""
        a, b = self._embedding(chord)
        worst, turn = largest(d), _length(c, z.size)
        size = MARGIN * math.sqrt(float(z @ z))
        mixed = MARGIN * math.sqrt(worst * form(d, z))
        kappa = max(worst / 8, 1e-300)
        for _ in range(12):
            hold = 1 - size * turn - mixed * turn / kappa
            if hold > 0:
                in_load = (size + mixed / kappa) / hold  # per unit of residual
                in_angle = (1 + turn * in_load) / kappa * math.sqrt(a * kappa + b)
                inside = rho * in_load < chord.r_lam and rho * in_angle < chord.r
                if inside and chord.residual * max(in_load, in_angle) < chord.gate:
                    return MARGIN * kappa, chord.residual * in_angle
            kappa *= 2
        return None

    def _compressed(self, J: Any, f: Array, slack: Array | float) -> bool:
        """True when J on the plane normal to f keeps its inertia within the slack: by that of [J -+ slack, f; f^T 0]."""
        counts = []
        for side in (-1, 1):
            moved = shifted(J, side * slack)
            index = index_within(moved, 0.0)
            if index is None:
                return False
            with np.errstate(all="ignore"):
                x = factor(moved).solve(f)
                schur, size = -float(f @ x), float(np.abs(f) @ np.abs(x))
            if not abs(schur) > 1e-6 * size:  # a sign that rounding could have made
                return False
            counts.append(index + int(schur < 0) - 1)
        return counts[0] == counts[1]

    # --- bounds ------------------------------------------------------------------------------------------------

    def _bounds(self, chord: _Chord, r: float, r_lam: float = 0.0) -> tuple[Any, Any]:
        """(d, c) within a tube around the chord."""
        known: tuple[Any, Any] = chord.bound(chord.du + r if r else chord.du, chord.dlam + r_lam)
        return known

    def _embedding(self, chord: _Chord) -> tuple[float, float]:
        a, b = self.curve.embedding(abs(float(chord.middle[-1])) + chord.dlam + chord.r_lam)
        return MARGIN * a, MARGIN * b


def _bend(chord: _Chord, d: Any, c: Any) -> float:
    """Bound on how far F on the chord is from the line between its values at the ends.

    With g(t) = F on the chord, |g'(t) - g'(1/2)| <= |2t - 1| W, the bounds being convex: then it is off by at most W / 4.
    """
    step = chord.step
    u = step[:-1]
    bent = math.sqrt(largest(d) * form(d, u))
    bent += abs(float(step[-1])) * _length(c, u.size)
    return MARGIN * bent / 4


def _length(c: Any, n: int) -> float:
    """Euclidean norm of bounds on n entries, one for all or one each."""
    return math.sqrt(float(c @ c) if np.ndim(c) else n * float(c) ** 2)


def _joined(spans: list[Span]) -> list[Span]:
    """Folds whose plane the solution of a neighbour may miss are open: there the curve could pass between two tubes."""
    joined = list(spans)
    for i, span in enumerate(spans):
        beside = [other.reach for other in (*spans[max(i - 1, 0) : i], *spans[i + 1 : i + 2]) if other.kind != "open"]
        if span.kind == "fold" and max([span.reach, *beside]) * span.turn > (EXTENDED - 1) / 2:
            joined[i] = Span(span.start, span.stop, "open", None)
    return joined


def _merged(spans: list[Span]) -> list[Span]:
    """Neighbours of one kind and inertia as one."""
    merged: list[Span] = []
    for span in spans:
        if merged and merged[-1].kind == span.kind and merged[-1].index == span.index:
            merged[-1] = replace(merged[-1], stop=span.stop)
        else:
            merged.append(span)
    return merged
