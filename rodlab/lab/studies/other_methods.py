"""The tip angle of the uniform elastica by the other methods: collocated (phi, m), shooting, steepest descent, the exact formula.

    phi' = m,  m' = -lam sin(phi),  phi(0) = 0,  m(1) = 0       [N 2.8.1], with K = 1: only lam / K counts
    guess: phi = A sin(w s),  A = min(2, sqrt(8 (lam / lam_j - 1))),  w = (2j - 1) pi / 2,  for mode j

One guess for all: near lam_j it is of the theory, alpha^2 = 8 (lam / lam_j - 1), above of the eye. A note that begins with
"refused" is a method's own, one that begins with "wrong" tells of an answer to another question.

    collocation           Gauss's points, Newton's method on all unknowns; order 2 degree
    shooting              the strut's map from the tip's angle a to phi_0(a) = 0; order of its rule
    steepest descent      the strut's energy, its minimum and nothing else: what it costs
    elliptic functions    sqrt(lam) = (2j - 1) Kell(sin(alpha / 2)) in mpmath: one point

Shooting knows its mode: a larger tip swings more slowly, so that fewer zeros of phi lie between the ends, and the count
of them says on which side of the root a is; Newton's step is taken where it stays between the two. Few joints under a large
load swing without this order [parasites, N 2.7]: what was found is looked at, and said where it is another mode.
"""

import math
from typing import NamedTuple

import numpy as np

from rodlab.analysis.downhill import steepest_descent
from rodlab.analysis.newton import NoConvergence
from rodlab.lab.studies.asked import Found, Method, Question
from rodlab.lab.studies.methods import ORDER
from rodlab.mechanics import elastica as exact
from rodlab.mechanics.recurrence import Floats, Recurrence, index_of
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.firstorder import System, collocate

DOUBLED = {1: (4, 8, 16, 32, 64, 128, 256, 512), 2: (4, 8, 16, 32, 64, 128, 256), 4: (2, 4, 8, 16, 32)}  # intervals of a degree
SHOT = (16.0, 64.0, 256.0, 1024.0, 4096.0, 16384.0)
DESCENDED = (4.0, 8.0, 16.0, 32.0)  # steps grow as n^2
NOTHING = 1e-3  # of the guess's size: an answer as small is phi = 0
CORRECTIONS = 200


class Posed(NamedTuple):
    """The question in units of K: the load, the mode, and the guess's amplitude and wave number."""

    lam: float
    mode: int
    amplitude: float
    wave: float

    def guess(self, s: Array) -> Array:
        """phi and phi' at s, (2, k)."""
        return self.amplitude * np.array([np.sin(self.wave * s), self.wave * np.cos(self.wave * s)])

    def sign(self) -> int:
        """Sign of the tip's angle where phi'(0) > 0."""
        return 1 if self.mode % 2 else -1


def posed(question: Question) -> Posed:
    """The question, looked at. Raises `ValueError` for any but the tip angle of a uniform, straight rod above its buckling load.

    >>> posed(Question("tip_angle", lam=5.0)).amplitude
    2.0
    """
    if question.quantity != "tip_angle" or not question.uniform:
        raise ValueError(f"these methods know the tip angle of the uniform straight rod only; asked was {question!r}")
    wave, K = (2 * question.mode - 1) * math.pi / 2, float(question.K)
    lam = 2 * wave**2 if question.lam is None else question.lam / K
    if not lam > wave**2:
        raise ValueError(f"lam must be above the buckling load {K * wave**2:g} of mode {question.mode}; it is {K * lam:g}")
    return Posed(lam, question.mode, min(2.0, math.sqrt(8 * (lam / wave**2 - 1))), wave)


def landed(asked: Posed, phi: Array, slope: float) -> tuple[float, str]:
    """The tip's angle, signed as phi'(0) > 0, of angles from the clamp to the tip, and a note where it is not the mode's."""
    value = math.copysign(1.0, slope) * float(phi[-1])
    if not np.abs(phi).max() > NOTHING * asked.amplitude:
        return value, "wrong: fell to the trivial solution phi = 0"
    reached = 1 + changes(phi[1:])
    return value, "" if reached == asked.mode else f"wrong: landed on mode {reached}"


def changes(values: Array) -> int:
    """Changes of sign in a row of numbers, zeros left out."""
    signs = np.sign(values[values != 0])
    return int(np.count_nonzero(signs[1:] != signs[:-1]))


def refused(why: object) -> Found:
    """No answer, and the sentence that says why."""
    return Found(math.nan, math.inf, 0, f"refused: {why}")


# --- collocation of the first-order system ----------------------------------------------------------------------------


class _Boundary(NamedTuple):
    asked: Posed
    system: System
    mesh: Array
    degree: int
    guess: Array


def elastica_system(lam: float) -> System:
    """y = (phi, m), with its derivatives."""

    def f(_: Array, y: Array) -> Array:
        return np.array([y[1], -lam * np.sin(y[0])])

    def df(_: Array, y: Array) -> Array:
        J = np.zeros((2, 2, *y.shape[1:]))
        J[0, 1], J[1, 0] = 1, -lam * np.cos(y[0])
        return J

    return System(f, df)


def _collocation(degree: int) -> Method:
    def setup(question: Question, size: float) -> _Boundary:
        asked, mesh = posed(question), np.linspace(0, 1, int(size) + 1)
        return _Boundary(asked, elastica_system(asked.lam), mesh, degree, asked.guess(mesh))

    sizes = tuple(float(N) for N in DOUBLED[degree])
    return Method(f"collocation of (phi, m), degree {degree}", 2 * degree, sizes, sizes[:4], setup, _collocated)


def _collocated(_: Question, given: _Boundary) -> Found:
    left, right = (np.array([[1.0, 0.0]]), np.zeros(1)), (np.array([[0.0, 1.0]]), np.zeros(1))
    try:
        y = collocate(given.system, left, right, given.mesh, given.degree, given.guess)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return refused(error)
    value, note = landed(given.asked, y[0], y[1, 0])
    return Found(value, math.inf, y.size + 2 * given.degree * (given.mesh.size - 1), note)


# --- shooting, from the strut's tip to its clamp -----------------------------------------------------------------------


class _Shot(NamedTuple):
    asked: Posed
    map: Recurrence


def _shooting(rule: str, order: int) -> Method:
    def setup(question: Question, size: float) -> _Shot:
        asked = posed(question)
        return _Shot(asked, Recurrence(Strut(n=int(size), rule=rule), asked.lam, Floats()))

    return Method(f'strut, shooting, "{rule}"', order, SHOT, SHOT[:4], setup, _shot)


def _shot(_: Question, given: _Shot) -> Found:
    """Newton's method on phi_0(a) = 0 between tips that are known to be too small and too large."""
    asked, n = given.asked, given.map.n
    low, high, a, last = 0.0, math.pi, asked.amplitude, math.inf
    for _tries in range(CORRECTIONS):
        phi, psi = (np.array(column) for column in given.map.thin(a))
        low, high = (a, high) if changes(phi) >= asked.mode else (low, a)
        step = -float(phi[-1] / psi[-1]) if psi[-1] else math.inf
        if abs(step) <= 2 * EPS * a or last / 2 <= abs(step) <= 1e-9 * a:
            break
        inside = low < a + step < high
        a, last = (a + step, abs(step)) if inside else ((low + high) / 2, math.inf)
    else:
        return refused(f"the root was not reached in {CORRECTIONS} corrections")
    grown, sizes = float(np.abs(psi).max() / abs(psi[-1])), float(np.abs(phi).max() + n * np.abs(np.diff(phi)).max())
    index = index_of([int(x) for x in np.sign(psi)])
    lost = changes(phi[:-1]) != asked.mode - 1 or index != asked.mode - 1
    note = f"wrong: lost mode {asked.mode}: {changes(phi[:-1]) + 1} by the zeros of phi, index {index}" if lost else ""
    return Found(asked.sign() * a, abs(step) + n * EPS * grown * sizes, n, note)


# --- steepest descent, and the exact formula ----------------------------------------------------------------------------


class _Slope(NamedTuple):
    asked: Posed
    strut: Strut
    guess: Array


def _descent(rule: str, order: int) -> Method:
    def setup(question: Question, size: float) -> _Slope:
        asked, strut = posed(question), Strut(n=int(size), rule=rule)
        return _Slope(asked, strut, asked.guess(strut.joints.s)[0])

    return Method(f'strut, steepest descent, "{rule}"', order, DESCENDED, DESCENDED[:3], setup, _descended)


def _descended(_: Question, given: _Slope) -> Found:
    if given.asked.mode > 1:
        return refused(f"steepest descent goes to minima, and mode {given.asked.mode} is a saddle")
    try:
        p, history = steepest_descent(given.strut, given.asked.lam, given.guess)
    except NoConvergence as error:
        return refused(error)
    value, note = landed(given.asked, np.append(0.0, p.u), p.u[0])
    return Found(value, p.remaining, given.strut.n, note or f"{len(history)} steps")


def _elliptic(_: Question, asked: Posed) -> Found:
    exact._modulus.cache_clear()
    value = exact.elastica(asked.lam, asked.mode).tip_angle
    return Found(value, EPS / 2 * abs(value), 1)


def _posed(question: Question, _: float) -> Posed:
    return posed(question)


def other_methods() -> list[Method]:
    """Every method of the house but Newton's on the strut and on the rod, which have a list of their own."""
    return [
        *(_collocation(degree) for degree in DOUBLED),
        *(_shooting(rule, order) for rule, order in ORDER.items()),
        *(_descent(rule, order) for rule, order in ORDER.items()),
        Method("elliptic functions, mpmath", None, (EPS,), (EPS,), _posed, _elliptic),
    ]
