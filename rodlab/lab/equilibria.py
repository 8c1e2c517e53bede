"""All equilibria of a strut at a load: certified to be all, or said why not.

covered     every tip angle decided by enclosures: complete           rodlab.mechanics.enumerate
sampled     the same function in floats: none missed between samples   rodlab.mechanics.sampled
Krawczyk    each one proved to exist and to be alone near by           rodlab.mechanics.krawczyk
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rodlab.analysis.diagram import diagram
from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.newton import Newton, NoConvergence
from rodlab.analysis.point import Point
from rodlab.mechanics.ends import refuse_held
from rodlab.mechanics.enumerate import CLOSE, Root, cover
from rodlab.mechanics.krawczyk import krawczyk
from rodlab.mechanics.recurrence import bits, precision
from rodlab.mechanics.sampled import sampled, too_many
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array, number, whole
from rodlab.numerics.balls import engine_of
from rodlab.numerics.inertia import Inertia

WORK = {"flint": 6_000_000, "mpmath": 300_000}  # joints of all boxes before giving up: a minute or two
CHAOTIC = 48  # binary digits lost on the way to the clamp, beyond which floats are asked first whether it is worth it
LARGE = 1e-9  # radius of angles that floats hold too coarsely to certify


@dataclass(frozen=True, eq=False)
class Equilibria:
    """The equilibria of `strut` at `lam`, lowest energy first. `certified`: proved to be all, each alone and its index exact.

    method: how they were found, in words. reason: why they are not certified, else empty.
    """

    strut: Strut
    lam: float
    points: tuple[Point, ...]
    certified: bool
    method: str
    reason: str = ""

    def __repr__(self) -> str:
        said = "certified" if self.certified else f"not certified: {self.reason}"
        return f"Equilibria({len(self.points)} at lam = {self.lam:g}; {self.method}; {said})"

    def __len__(self) -> int:
        return len(self.points)

    def __iter__(self) -> Iterator[Point]:
        return iter(self.points)

    @property
    def index_sum(self) -> int | None:
        """Sum of (-1)^index: 1 where none is degenerate, as V grows in every direction [Morse]. None where an index is open."""
        return _index_sum(self.points)

    @cached_property
    def images(self) -> tuple[int | None, ...]:
        """For each point the position of its mirror image, its own where it is symmetric; None for a strut without symmetry."""
        if not self.strut.symmetries:
            return (None,) * len(self.points)
        (mirror,) = self.strut.symmetries
        places = {_key(p.u): i for i, p in enumerate(self.points)}
        return tuple(places.get(_key(mirror(p.u))) for p in self.points)

    @cached_property
    def connected(self) -> tuple[bool, ...]:
        """For each point: is it on a branch that is connected to the unstressed shape? Found by the diagram up to this load.

        Of a straight strut those that are not are parasites of the discretisation [Domokos and Holmes 1993]: the rod has none. Of
        any other they may also be on a branch that an imperfection cut off. Raises `NoConvergence` where the diagram stays open.
        """
        if self.lam == 0:
            return tuple(np.abs(p.u - self.strut.unstressed()).max() < CLOSE for p in self.points)
        found = diagram(self.strut, (min(self.lam, 0.0), max(self.lam, 0.0)), equilibrium(self.strut, 0.0))
        if not found.complete:
            why = next((row.reason for row in found.table if row.reason), "")
            raise NoConvergence(f"the diagram from 0 to {self.lam:g} could not be completed: {why}", ())
        every, own = np.array([p.u for p in self.points]), np.zeros(len(self.points), dtype=bool)
        for p in found.at(self.lam):
            own |= np.abs(every - p.u).max(axis=1) < 10 * CLOSE
        return tuple(own.tolist())

    @cached_property
    def unconnected(self) -> str:
        """Why it cannot be told which are connected; empty where it can."""
        try:
            _ = self.connected
        except NoConvergence as failure:
            return str(failure)
        return ""

    def standing(self, i: int) -> str:
        """How a point stands to the unstressed shape: "connected", "detached", or of a straight strut "parasite"."""
        return "connected" if self.connected[i] else "parasite" if self.strut.is_straight else "detached"

    def symmetry(self, i: int) -> str:
        """The symmetry class of a point: "symmetric", "mirror pair", or "none" where the strut itself has none."""
        image = self.images[i]
        return "none" if image is None else "symmetric" if image == i else "mirror pair"


def all_equilibria(
    strut: Strut, lam: float, certify: bool = True, *, most: int | None = None, engine: str | None = None
) -> Equilibria:
    """Every equilibrium of a strut at a load, by the standard map: roots of one function of the tip angle in one turn.

    certify: prove it, by ball arithmetic (python-flint) or, where that is missing, mpmath's intervals; `engine` names one.
    Equilibria closer than 1e-6 radians to each other are one that is degenerate, and not certified. Where `most` boxes do not
    suffice (long struts at high loads) the equilibria are those that samples show, each proved to exist.
    Cost: O(n) for each box; boxes grow with the number of equilibria, thousands of them in seconds.
    Raises `ValueError` for a foundation or terms of one's own; `NoConvergence` where there are too many to be told apart.

    >>> found = all_equilibria(Strut.from_joints(k=[1, 1]), lam=3.0)
    >>> [(round(p.tip_angle, 6), p.index) for p in found], found.certified, found.index_sum
    ([(2.966878, 0), (-2.966878, 0), (0.529526, 1), (-0.529526, 1), (0.0, 2)], True, 1)
    """
    if not isinstance(strut, Strut):
        raise ValueError(f"strut must be a Strut; it is {strut!r:.60}")
    refuse_held("strut", strut)
    lam = number("lam", lam)
    chosen = engine_of(engine)
    if not isinstance(certify, bool):
        raise ValueError(f"certify must be True or False; it is {certify!r:.60}")
    if not certify:
        return _sampled(strut, lam, (), None)
    digits = precision(strut, lam)
    if too_many(strut, lam) or (bits(strut, lam) > CHAOTIC and sampled(strut, lam) is None):
        raise NoConvergence(_too_many(strut, lam), ())
    work = int(WORK[chosen] / strut.n / (1 + digits / 512)) + 100
    found = cover(strut, lam, most=work if most is None else whole("most", most, least=1), engine=chosen)
    if not found.complete:
        return _sampled(strut, lam, (f"{found.boxes} boxes did not suffice to cover all tip angles",), chosen)
    points = [_point(strut, lam, root) for root in (*found.roots, *found.clusters)]
    method = f"one turn of tip angles covered by {found.boxes} boxes in {found.method}"
    reason, coarse = "", max((root.radius for root in found.roots), default=0.0)
    if found.clusters:
        near = f"next to the tip angle {found.clusters[0].phi[-1]:.6g} there may be one, several or none"
        reason = f"{len(found.clusters)} degenerate: {near}, as at the load of a fold or branch point, to rounding"
    elif coarse > LARGE:
        reason = f"floats hold angles as large as these only to {coarse:.1e} radians"
    return Equilibria(strut, lam, _ordered(points), not reason, method, reason)


def _sampled(strut: Strut, lam: float, why: Sequence[str], engine: str | None) -> Equilibria:
    """Those that samples show, corrected; with an engine each is proved to exist."""
    shown = sampled(strut, lam)
    if shown is None:
        raise NoConvergence(_too_many(strut, lam), ())
    run, points, reasons = Newton.at(strut, lam), dict[tuple[float, ...], Point](), list(why)
    lost, unproved = 0, 0
    for phi in shown:
        try:
            root = run.solve(phi)
        except NoConvergence:
            lost += 1
            continue
        p = Point(strut, lam, root.u, root.history, root.remaining)
        proof = None if engine is None else krawczyk(strut, lam, p.u, engine)
        unproved += proof is None and engine is not None
        points.setdefault(_key(p.u), p if proof is None else _point(strut, lam, proof))
    doubled = len(shown) - lost - len(points)
    if lost or doubled:
        reasons.append(f"{lost} more could not be corrected and {doubled} fell onto others")
    if unproved:
        reasons.append(f"{unproved} of these could not be proved to exist")
    if engine is None:
        reasons.append("nothing was proved, as certify=False")
    method = "sampled tip angles in floats" + ("" if engine is None else ", each equilibrium proved by Krawczyk's test")
    total = _index_sum(points.values())
    if total not in (1, None):
        reasons.append(f"the sum of (-1)^index is {total} and not 1, so some are missing")
    return Equilibria(strut, lam, _ordered(points.values()), False, method, "; ".join(reasons))


def _index_sum(points: Iterable[Point]) -> int | None:
    if not all(p.index_verified for p in points):
        return None
    return sum(-1 if p.index and p.index % 2 else 1 for p in points)


def _too_many(strut: Strut, lam: float) -> str:
    return f"there are too many equilibria at lam = {lam:g} to be told apart, of {strut!r:.80}"


def _point(strut: Strut, lam: float, root: Root) -> Point:
    known = None if root.index is None else Inertia(root.index, 0, strut.n - root.index)
    return Point(strut, lam, root.phi, (), root.radius, known_inertia=known)


def _ordered(points: Iterable[Point]) -> tuple[Point, ...]:
    with np.errstate(all="ignore"):
        return tuple(sorted(points, key=lambda p: (round(p.energy, 9), p.index or 0, -abs(p.tip_angle), -p.tip_angle)))


def _key(u: Array) -> tuple[float, ...]:
    return tuple(np.round(u / CLOSE) + 0.0)
