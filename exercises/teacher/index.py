r"""# The index without eigenvalues

The index of an equilibrium of the strut [N 2.7] is the number of negative eigenvalues of the second derivative $A$, a symmetric tridiagonal
matrix with the diagonal $d_1, \dots, d_n$ and the entries $e_1, \dots, e_{n-1}$ beside it. By Sylvester's law of inertia it is also the number of
negative pivots of elimination without exchange of rows,

$$p_1 = d_1, \qquad p_i = d_i - e_{i-1}^2 / p_{i-1} .$$

Applied to $A - x I$ the same count is *Sturm's*: the number of eigenvalues below $x$, from which bisection finds any one of them.
A pivot can be exactly zero although $A$ is nonsingular (all $e_i \ne 0$); the count stays right if it is replaced by a tiny number of
either sign, and the next pivot is then huge.

**Write**, for arrays `diagonal` of shape (n,) and `off_diagonal` of shape (n - 1,),

1. `below(diagonal, off_diagonal, x)`, the number of eigenvalues less than $x$, a whole number;
2. `index(diagonal, off_diagonal)`, the number of negative eigenvalues, a whole number, also if a pivot is zero ($A$ itself is nonsingular), and
   in a time proportional to $n$;
3. `eigenvalue(diagonal, off_diagonal, j)`, the $j$-th smallest eigenvalue, $j = 1, \dots, n$, by bisection, correct to $10^{-8}$, a number.
"""

# %% answer
import numpy as np


def below(diagonal, off_diagonal, x):
    """The number of eigenvalues less than x."""
    ### BEGIN SOLUTION
    count, pivot = 0, 1.0
    tiny = 1e-200 * max(1.0, np.max(np.square(off_diagonal), initial=0.0))
    for d, e in zip(diagonal, np.append(0.0, off_diagonal), strict=True):
        pivot = d - x - e**2 / pivot
        if pivot == 0:
            pivot = tiny
        count += int(pivot < 0)
    return count
    ### END SOLUTION


def index(diagonal, off_diagonal):
    """The number of negative eigenvalues."""
    ### BEGIN SOLUTION
    return below(diagonal, off_diagonal, 0.0)
    ### END SOLUTION


def eigenvalue(diagonal, off_diagonal, j):
    """The j-th smallest eigenvalue (j = 1 is the smallest)."""
    ### BEGIN SOLUTION
    radius = np.max(np.abs(diagonal)) + 2 * np.max(np.abs(off_diagonal), initial=0.0)  # Gershgorin
    low, high = -radius, radius
    for _ in range(60):
        middle = (low + high) / 2
        if below(diagonal, off_diagonal, middle) >= j:
            high = middle
        else:
            low = middle
    return (low + high) / 2
    ### END SOLUTION


# %% checks
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

# %% proofs
PROOFS = {
    "below: shift forgotten": ("pivot = d - x -", "pivot = d -"),
    "below: shift added": ("pivot = d - x -", "pivot = d + x -"),
    "below: those above": ("count += int(pivot < 0)", "count += int(pivot > 0)"),
    "below: diagonal only": ("- e**2 / pivot", ""),
    "index: sign of the determinant": (
        "return below(diagonal, off_diagonal, 0.0)",
        "return below(diagonal, off_diagonal, 0.0) % 2",
    ),
    "index: zero pivot counted as negative": ("pivot = tiny", "count, pivot = count + 1, tiny"),
    "eigenvalue: counted from the largest": ("middle) >= j", "middle) >= len(diagonal) + 1 - j"),
    "eigenvalue: next one": ("middle) >= j", "middle) > j"),
}
