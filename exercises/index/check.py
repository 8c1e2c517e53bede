"""Checks of the exercise "The index without eigenvalues"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds, together
from rodlab.grading.values import Number


def spectrum(diagonal, beside):
    return np.linalg.eigvalsh(np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1))


def made(draw, n, negative):
    """A matrix with so many negative pivots: the product of factors that are drawn."""
    pivot = draw.uniform(1, 2, size=n)
    pivot[draw.permutation(n)[:negative]] *= -1
    factor = draw.choice([-1, 1], size=n - 1) * draw.uniform(0.5, 1.0, size=n - 1)
    return pivot + np.append(0.0, factor**2 * pivot[:-1]), factor * pivot[:-1]


def second_pivot_zero(draw):
    """2 x = 1 has been taken from 1/2: the second pivot is zero, the index at least two."""
    diagonal, beside = made(draw, 6, 2)
    diagonal[:2], beside[0] = (2.0, 0.5), draw.choice([-1.0, 1.0])
    diagonal[-1] = -10.0
    return diagonal, beside


def matrices(draw):
    yield made(draw, 9, 3)
    yield made(draw, 30, int(draw.integers(5, 12)))
    diagonal, beside = made(draw, 5, 2)
    yield np.append(0.0, diagonal), np.append(draw.uniform(1, 2), beside)  # the first pivot is zero
    yield second_pivot_zero(draw)
    yield made(draw, 5_000, 777)


def shifts(draw):
    """Between two eigenvalues of the upper half, where the diagonal's entries, the index and those above would give another count."""
    for n in (5, 9, 20):
        found = []
        while not found:
            diagonal, beside = made(draw, n, n // 4)
            values = spectrum(diagonal, beside)
            for c in range(n // 2 + 1, n):
                x = (values[c - 1] + values[c]) / 2
                if values[c] - values[c - 1] > 0.01 and np.sum(diagonal < x) not in (c, n - c, n // 4) and c != n - n // 4:
                    found.append(x)
        yield diagonal, beside, float(draw.choice(found))


def numbers(draw):
    for n, j in ((4, 1), (9, 9), (10, int(draw.integers(3, 5)))):
        yield *made(draw, n, n // 2), j


def known(diagonal, beside):
    """From dense eigenvalues, or for large matrices from the pivots that they are made of."""
    return 777 if diagonal.size == 5_000 else int(np.sum(spectrum(diagonal, beside) < 0))


def count(diagonal, beside, x=0.0, *, zero=0.0):
    """Negative pivots, each exact zero taken for the given sign without being replaced."""
    number, pivot = 0, 1.0
    for d, e in zip(diagonal, np.append(0.0, beside), strict=True):
        pivot = d - x - e**2 / pivot
        number += int(pivot < 0 or (zero < 0 and pivot == 0))
    return number


def true_below(diagonal, beside, x):
    return int(np.sum(spectrum(diagonal, beside) < x))


def off_value(found, diagonal, beside, j):
    values = spectrum(diagonal, beside)
    return abs(found - values[j - 1]) / np.max(np.abs(values))


def at(shift, *, turn=False):
    """The eigenvalue of another number."""
    return lambda d, e, j: float(spectrum(d, e)[(d.size - j if turn else j - 1 + shift) % d.size])


exercise = Exercise(
    title="The index without eigenvalues",
    source="N 2.7",
    questions=(
        Question(
            name="below",
            calls=shifts,
            returns=Number(whole=True),
            properties=(equals(true_below, 0.0, says="counts the eigenvalues (dense)", points=1.5),),
            mistakes=(
                Mistake("shift forgotten", "Your count is the same for every x.", lambda d, e, x: count(d, e)),
                Mistake("shift added", "The eigenvalues of which matrix are those of A less x?", lambda d, e, x: count(d, e, -x)),
                Mistake(
                    "those above",
                    "Which sign does an eigenvalue below x give to a pivot of A - x I?",
                    lambda d, e, x: d.size - count(d, e, x),
                ),
                Mistake("diagonal only", "The diagonal's entries are not yet the pivots.", lambda d, e, x: count(d, 0 * e, x)),
            ),
            hint="A loop over the pivots of A - x I, of which only the last has to be kept.",
        ),
        Question(
            name="index",
            calls=matrices,
            returns=Number(whole=True),
            properties=(
                together(
                    "counts the negative eigenvalues",
                    lambda calls: max(abs(c.value - known(*c.arguments)) for c in (*calls[:2], calls[-1])),
                    0.0,
                ),
                together(
                    "counts them though a pivot is zero",
                    lambda calls: max(abs(c.value - known(*c.arguments)) for c in calls[2:4]),
                    0.0,
                ),
            ),
            mistakes=(
                Mistake(
                    "sign of the determinant",
                    "Two negative pivots have a positive product: count them one by one.",
                    lambda d, e: known(d, e) % 2,
                ),
                Mistake(
                    "zero pivot counted as negative",
                    "A zero pivot makes the next one huge; if both are counted as negative, one eigenvalue is counted twice.",
                    lambda d, e: count(d, e, zero=-1.0),
                ),
            ),
            hint="The eigenvalues below zero: the first function has it all, if it survives a zero pivot.",
            seconds=5.0,
        ),
        Question(
            name="eigenvalue",
            calls=numbers,
            returns=Number(),
            properties=(holds("is the eigenvalue (dense)", off_value, 1e-7),),
            mistakes=(
                Mistake("counted from the largest", "j = 1 is the smallest eigenvalue.", at(0, turn=True)),
                Mistake(
                    "next one",
                    "Where there are j eigenvalues below x, is the j-th one below or above it?",
                    when=lambda given: all(
                        abs(v - at(1)(*a)) < 1e-5 for a, v in given if a[2] < a[0].size
                    ),  # none follows the last
                ),
            ),
            hint="Start with an interval that holds all eigenvalues, and halve it by the count at its middle.",
        ),
    ),
)
