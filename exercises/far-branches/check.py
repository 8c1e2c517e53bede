"""Checks of the exercise "The far branches of one joint"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number


def bisected(function, low, high):
    """A root between two points where the function has different signs."""
    sign = np.sign(function(low))
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if np.sign(function(middle)) == sign else (low, middle)
    return (low + high) / 2


def turning(m):
    """Angles where lam = phi/sin(phi) is stationary: its derivative's numerator changes its sign once in each turn."""
    return np.array([bisected(lambda x: np.sin(x) - x * np.cos(x), k * np.pi, (k + 0.5) * np.pi) for k in range(1, m + 1)])


def table(m):
    phi = turning(m)
    return np.column_stack([phi, phi / np.sin(phi)])


CORNERS = np.concatenate([[0.0], turning(14), np.pi * np.arange(1, 14)])


def roots(lam, *, most=np.inf):
    """All of them: between neighbouring corners (poles and turning points of phi/sin(phi)) it is monotone."""
    corners = np.sort(CORNERS)
    corners[0] = 1e-9
    f = [x - lam * np.sin(x) for x in corners]
    found = [
        bisected(lambda x: x - lam * np.sin(x), a, b)
        for a, b, fa, fb in zip(corners[:-1], corners[1:], f[:-1], f[1:], strict=True)
        if fa * fb < 0
    ]
    positive = np.array([x for x in found if x < most])
    return np.concatenate([-positive[::-1], [0.0], positive])


def positive_slopes(lam, sign=1):
    return int(np.sum(sign * (1 - lam * np.cos(roots(lam))) > 0))


def numbers(draw):
    yield (3,)
    yield (int(draw.integers(4, 9)),)


def loads(draw):
    for between in ((-10.6, -5.0), (1.5, 7.5), (8.1, 13.8), (20.7, 26.4), (33.3, 39.0), (-35.9, -29.9)):
        yield (draw.uniform(*between),)


def as_many(found, lam):
    return float(abs(found.size - roots(lam).size) + (not np.all(np.isfinite(found)) or np.any(np.diff(found) <= 1e-6)))


exercise = Exercise(
    title="The far branches of one joint",
    source="N 2.7",
    imports=("numpy", "scipy.optimize"),
    questions=(
        Question(
            name="folds",
            calls=numbers,
            returns=Array(lambda m: (m, 2)),
            properties=(
                holds(
                    "has equilibria in its rows",
                    lambda rows, m: np.max(np.abs(rows[:, 0] / rows[:, 1] - np.sin(rows[:, 0]))),
                    1e-8,
                ),
                equals(table, 1e-8, says="has every fold in its order", points=2.0),
            ),
            mistakes=(
                Mistake(
                    "poles of the tangent",
                    "Your solver saw a change of sign where the tangent jumps. Multiply the equation by the cosine.",
                    when=lambda given: all(
                        np.allclose(np.asarray(v)[:, 0], (np.arange(1, m[0] + 1) - 0.5) * np.pi) for m, v in given
                    ),
                ),
                Mistake(
                    "folds under pressure only",
                    "The load of a fold may be negative: which angles have you passed over?",
                    lambda m: table(2 * m)[1::2],
                ),
            ),
            hint="Eliminate the load from f = 0 and df/dphi = 0; between which multiples of pi/2 does each root lie?",
        ),
        Question(
            name="equilibria",
            calls=loads,
            returns=Array(),
            properties=(
                holds("has as many as there are, ascending", as_many, 0.0),
                equals(roots, 1e-8, says="has them all", points=2.0),
            ),
            mistakes=(
                Mistake(
                    "one turn only",
                    "The spring may be wound up beyond pi. How large can |phi| be if phi = lam sin(phi)?",
                    lambda lam: roots(lam, most=np.pi),
                ),
                Mistake("one side only", "With phi also -phi is an equilibrium.", lambda lam: roots(lam)[roots(lam).size // 2 :]),
                Mistake(
                    "straight state forgotten",
                    "Is phi = 0 an equilibrium at every load?",
                    lambda lam: np.delete(roots(lam), roots(lam).size // 2),
                ),
            ),
            hint="Every equilibrium has |phi| at most |lam|. Look for changes of sign there, on a grid fine enough for a sine.",
        ),
        Question(
            name="stable",
            calls=loads,
            returns=Number(whole=True),
            properties=(equals(positive_slopes, 0.0, says="counts the minima of the energy"),),
            mistakes=(
                Mistake(
                    "unstable counted",
                    "Is the energy least or greatest where its slope falls?",
                    lambda lam: positive_slopes(lam, -1),
                ),
                Mistake(
                    "one side only counted",
                    "Your count is that of the angles that are not negative: what of their mirror images?",
                    lambda lam: int(np.sum((1 - lam * np.cos(roots(lam)) > 0) & (roots(lam) >= 0))),
                ),
            ),
            hint="Evaluate the derivative of f at each equilibrium and count the positive ones.",
        ),
    ),
)
