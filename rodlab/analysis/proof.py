"""A proof that a piece of a branch was followed without a jump: Newton and Kantorovich along a chord.

On the chord from y_a to y_b, y_c its middle, let the Jacobian J and F_lam = f move by no more than `lipschitz` allows within a
tube of radius r around it. Two ways:

    regular  |eigenvalues of J| >= kappa in the tube, by the inertia of J_c -+ (d + kappa). Any solution in the tube is within
             e of the chord at its load, e = |F| / kappa. If e < r the solution curve can neither end nor leave the tube,
             nor meet another: J keeps its index, and there is no fold and no branch point. Where two chords meet
             F is small, and the curve passes from one tube into the next.
    fold     the same for [J f; f^T 0], the curve as a function of f . u: |eigenvalues of J on the plane normal to f| >= kappa.
             The curve may turn; [J f] keeps its full rank, so that there is no branch point.

Exact but for rounding in the norms, for which every bound has a margin. Without `lipschitz` the same test with the changes
seen at the ends in its place is a check and no proof.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from rodlab.analysis.curve import Curve, Segment
from rodlab.numerics.arrays import Array
from rodlab.numerics.bordered import OneBorder
from rodlab.numerics.factor import factor, index_within, largest_change, shifted

MARGIN = 1.01  # on every bound, for rounding in computing it
WIDEST = 0.5  # radius of a tube
FINEST = 2.0**-5  # the smallest part of a segment that is tried

Kind = Literal["regular", "fold", "open"]


@dataclass(frozen=True, slots=True)
class Span:
    """A part of a segment, sigma from `start` to `stop`: what was shown of it, and the index where it is constant."""

    start: float
    stop: float
    kind: Kind
    index: int | None


class _Chord(NamedTuple):
    """A chord: its ends, the residuals there, its middle, and half of its extent."""

    a: Array
    b: Array
    residual: float
    middle: Array
    du: Array
    dlam: float
    r: float  # radius of the tube in any one unknown, and in the load
    r_lam: float
    gate: float  # radius where two tubes meet
    bound: Any  # what `lipschitz` knows at the middle

    @property
    def step(self) -> Array:
        return np.asarray(self.b - self.a)


class Prover:
    """Shows, span by span, that a segment is one piece of one branch."""

    def __init__(self, curve: Curve) -> None:
        self.curve = curve
        self.lipschitz: Any = getattr(curve.equations, "lipschitz", None)

    @property
    def proves(self) -> bool:
        """True when the model knows bounds, so that what is shown is proved."""
        return self.lipschitz is not None

    def spans(self, segment: Segment, finest: float = FINEST) -> list[Span]:
        """The segment in spans, each regular, a fold, or open: not shown with parts of the size `finest`."""
        if self.proves and not np.isfinite(np.max(self.lipschitz(segment.a[:-1], float(segment.a[-1]))(1.0, 1.0)[0])):
            self.lipschitz = None
        length = segment.length
        if not self.curve.has_index(segment.a):
            return [Span(0.0, length, "open", None)]
        found: list[Span] = []
        waiting = [(0.0, 1.0)]
        gate = float(np.abs(segment.b - segment.a)[:-1].max(initial=0.0)) / 32 + 1e-9
        ends: dict[float, tuple[Array, float]] = {0.0: (segment.a, 0.0), 1.0: (segment.b, 0.0)}
        for x in (0.0, 1.0):
            ends[x] = (ends[x][0], self._residual(ends[x][0]))
        while waiting:
            start, stop = waiting.pop()
            span = self._shown(self._chord(ends[start], ends[stop], gate), start * length, stop * length)
            if span.kind == "open" and stop - start > finest * 1.5:
                middle = (start + stop) / 2
                y = segment.at(middle * length)
                ends[middle] = (y, self._residual(y))
                waiting += [(middle, stop), (start, middle)]
                continue
            found.append(span)
        return _merged(found)

    def _shown(self, chord: _Chord, start: float, stop: float) -> Span:
        index = self._regular(chord)
        if index is not None:
            return Span(start, stop, "regular", index)
        return Span(start, stop, "fold" if self.proves and self._fold(chord) else "open", None)

    def _chord(self, a: tuple[Array, float], b: tuple[Array, float], gate: float) -> _Chord:
        half, middle = (b[0] - a[0]) / 2, (a[0] + b[0]) / 2
        du, dlam = np.abs(half[:-1]), abs(float(half[-1]))
        r = max(float(du.max(initial=0.0)) / 8, gate)
        bound = self.lipschitz(middle[:-1], float(middle[-1])) if self.proves else None
        return _Chord(a[0], b[0], max(a[1], b[1]), middle, du, dlam, r, dlam / 4 + gate, gate / 2, bound)

    def _residual(self, y: Array) -> float:
        F = self.curve.residual(y)
        size = math.sqrt(float(F @ F))
        return MARGIN * size if math.isfinite(size) else math.inf

    # --- regular -----------------------------------------------------------------------------------------------

    def _regular(self, chord: _Chord) -> int | None:
        """The index, constant in the tube, or None."""
        matrix = self.curve.second_variation(chord.middle)
        if not self.proves:
            return self._regular_as_seen(chord, matrix)
        rho, r = self._tube(chord)
        kappa = max(self._held(chord, rho, r), self._held(chord, chord.residual, chord.gate))
        return index_within(matrix, MARGIN * self._bounds(chord, r)[0] + kappa) if math.isfinite(kappa) else None

    def _tube(self, chord: _Chord) -> tuple[float, float]:
        """Bound rho on F along the chord, and the radius r for which little is asked of J: rho / r + the change of J with r."""
        at_rest, wider = self._bounds(chord, 0.0), self._bounds(chord, chord.r)
        rho = chord.residual + _bend(chord, *at_rest)
        slope = float(np.max(wider[0]) - np.max(at_rest[0])) / chord.r
        asked = self._held(chord, rho, chord.r) * chord.r
        r = math.sqrt(asked / slope) if slope > 0 and math.isfinite(asked) else chord.r
        return rho, min(max(r, chord.r), max(WIDEST, chord.r))

    def _held(self, chord: _Chord, rho: float, r: float) -> float:
        """kappa for which a residual rho moves a solution by less than r: rho sqrt(a / kappa + b / kappa^2) = r."""
        a, b = self._embedding(chord)
        return MARGIN * rho * (rho * a + math.sqrt(rho * rho * a * a + 4 * r * r * b)) / (2 * r * r)

    def _regular_as_seen(self, chord: _Chord, matrix: Any) -> int | None:
        change = max(largest_change(self.curve.second_variation(y), matrix) for y in (chord.a, chord.b))
        return index_within(matrix, 2 * change) if math.isfinite(change) else None

    # --- fold --------------------------------------------------------------------------------------------------

    def _fold(self, chord: _Chord) -> bool:
        curve, step = self.curve, chord.step
        f = curve.d_lam(chord.middle)
        if not f.any() or float(f @ step[:-1]) == 0:
            return False
        J = curve.jacobian(chord.middle)
        rho, r = self._tube(chord)
        chord = chord._replace(r=r, r_lam=max(chord.r_lam, chord.dlam))
        d, c = self._bounds(chord, chord.r, chord.r_lam)
        with np.errstate(all="ignore"):
            z = OneBorder(factor(J), f, f, 0.0).solve(np.append(np.zeros_like(f), 1.0))[:-1]
        kappa = self._turned(chord, z, rho, d, c) if np.isfinite(z).all() else None
        return kappa is not None and self._compressed(J, f, MARGIN * d + kappa)

    def _turned(self, chord: _Chord, z: Array, rho: float, d: Any, c: Any) -> float | None:
        """kappa on the plane for which solutions stay within the tube: by doubling it, until the bounds close."""
        a, b = self._embedding(chord)
        worst, turn = float(np.max(d)), _length(c, z.size)
        size = MARGIN * math.sqrt(float(z @ z))
        mixed = MARGIN * math.sqrt(worst * float(np.sum(d * z * z)))
        kappa = max(worst / 8, 1e-300)
        for _ in range(12):
            hold = 1 - size * turn - mixed * turn / kappa

            def within(rho: float, r: float, r_lam: float, hold: float = hold, kappa: float = kappa) -> bool:
                e_lam = rho * (size + mixed / kappa) / hold
                push = rho + turn * e_lam
                return e_lam < r_lam and (a * kappa + b) * (push / kappa) ** 2 < r * r

            if hold > 0 and within(rho, chord.r, chord.r_lam) and within(chord.residual, chord.gate, chord.gate):
                return MARGIN * kappa
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
                schur = -float(f @ factor(moved).solve(f))
            if not math.isfinite(schur) or schur == 0:
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
    bent = math.sqrt(float(np.max(d)) * float(np.sum(d * u * u)))
    bent += abs(float(step[-1])) * _length(c, u.size)
    return MARGIN * bent / 4


def _length(c: Any, n: int) -> float:
    """Euclidean norm of bounds on n entries, one for all or one each."""
    return math.sqrt(float(c @ c) if np.ndim(c) else n * float(c) ** 2)


def _merged(spans: list[Span]) -> list[Span]:
    """Neighbours of one kind and inertia as one."""
    merged: list[Span] = []
    for span in spans:
        if merged and merged[-1].kind == span.kind and merged[-1].index == span.index:
            merged[-1] = replace(merged[-1], stop=span.stop)
        else:
            merged.append(span)
    return merged
