r"""# Elimination in a tridiagonal matrix

Newton's method for the strut of $n$ joints [N 2.7] solves $A x = b$ with a symmetric tridiagonal matrix $A$ at each step. Let its diagonal be
$d_1, \dots, d_n$ and its entries $(i, i + 1)$ be $e_1, \dots, e_{n-1}$. Elimination from the top, without exchanging rows,
subtracts a multiple of each row from the next one and leaves the *pivots* $p_1, \dots, p_n$ on the diagonal; it takes a number of operations
proportional to $n$. A matrix of a strut of $10^5$ joints could not even be stored as a square.

**Write**, for arrays `diagonal` of shape (n,), `off_diagonal` of shape (n - 1,) and `right` of shape (n,),

1. `pivots(diagonal, off_diagonal)`, the array of the pivots, shape $(n,)$;
2. `solve(diagonal, off_diagonal, right)`, the solution $x$, shape $(n,)$;
3. `determinant(diagonal, off_diagonal)`, the sign of $\det A$ ($1$ or $-1$) and the natural logarithm of its absolute value: two numbers. The determinant
   itself may be too large or too small for a floating point number.

The matrices of the tests are such that no exchange of rows is needed: $|d_i| > |e_{i-1}| + |e_i|$, with $d_i$ of either sign. The largest has
$n = 20\,000$ and a few seconds are allowed.
"""

# %% answer
import numpy as np


def pivots(diagonal, off_diagonal):
    """The diagonal that elimination from the top leaves."""
    ### BEGIN SOLUTION
    left = [diagonal[0]]
    for d, e in zip(diagonal[1:], off_diagonal, strict=True):
        left.append(d - e**2 / left[-1])
    return np.array(left)
    ### END SOLUTION


def solve(diagonal, off_diagonal, right):
    """x of A x = right."""
    ### BEGIN SOLUTION
    n, p = len(diagonal), pivots(diagonal, off_diagonal)
    x = np.array(right, dtype=float)
    for i in range(1, n):  # down: the right-hand side is eliminated along
        x[i] -= off_diagonal[i - 1] / p[i - 1] * x[i - 1]
    x[-1] /= p[-1]
    for i in range(n - 2, -1, -1):  # and up
        x[i] = (x[i] - off_diagonal[i] * x[i + 1]) / p[i]
    return x
    ### END SOLUTION


def determinant(diagonal, off_diagonal):
    """The sign of the determinant, and the logarithm of its absolute value."""
    ### BEGIN SOLUTION
    p = pivots(diagonal, off_diagonal)
    return np.prod(np.sign(p)), np.sum(np.log(np.abs(p)))
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number, Parts


def matrix(diagonal, beside):
    return np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1)


def drawn(draw, n):
    beside = draw.uniform(1, 2, size=n - 1)
    sums = np.append(beside, 0.0) + np.append(0.0, beside)
    sign = draw.choice([-1, 1], size=n)
    sign[:2] = 1, -1  # both occur, and one of the first two is negative
    return sign * (sums + draw.uniform(0.5, 1.5, size=n)), beside


def small(draw):
    for n in (2, 3, 8):
        yield drawn(draw, n)


def any_size(draw):
    for n in (2, 3, 8, 20_000):
        yield *drawn(draw, n), draw.normal(size=n)


def many(draw):
    """Determinants of a known sign, which is that of the product of a dominant diagonal."""
    for n, sign in ((3, -1), (8, 1), (2_000, -1)):
        diagonal, beside = drawn(draw, n)
        diagonal[-1] *= np.prod(np.sign(diagonal)) * sign
        yield diagonal, beside


def minors(diagonal, beside):
    """Pivots as ratios of leading minors."""
    leading = [1.0] + [np.linalg.det(matrix(diagonal[:m], beside[: m - 1])) for m in range(1, diagonal.size + 1)]
    return np.array(leading[1:]) / leading[:-1]


def eliminated(diagonal, beside, *, sign=-1, power=2):
    left = [diagonal[0]]
    for d, e in zip(diagonal[1:], beside, strict=True):
        left.append(d + sign * e**power / left[-1])
    return np.array(left)


def left_over(x, diagonal, beside, right):
    """The largest residual, relative to the right-hand side."""
    row = diagonal * x
    row[:-1] += beside * x[1:]
    row[1:] += beside * x[:-1]
    return np.max(np.abs(row - right)) / np.max(np.abs(right))


def bidiagonal(diagonal, beside, right):
    """The right-hand side not eliminated."""
    p, x = eliminated(diagonal, beside), np.array(right)
    x[-1] /= p[-1]
    for i in range(x.size - 2, -1, -1):
        x[i] = (x[i] - beside[i] * x[i + 1]) / p[i]
    return x


def down_only(diagonal, beside, right):
    p, x = eliminated(diagonal, beside), np.array(right)
    for i in range(1, x.size):
        x[i] -= beside[i - 1] / p[i - 1] * x[i - 1]
    return x / p


def log_product(diagonal, beside, over=None):
    over = eliminated(diagonal, beside) if over is None else over
    return np.prod(np.sign(over)), np.sum(np.log(np.abs(over)))


def from_bottom(diagonal, beside):
    """Sign and logarithm by elimination from the other end."""
    return log_product(diagonal[::-1], beside[::-1])


exercise = Exercise(
    title="Elimination in a tridiagonal matrix",
    source="N 2.7",
    questions=(
        Question(
            name="pivots",
            calls=small,
            returns=Array(lambda diagonal, *_: diagonal.shape),
            properties=(equals(minors, 1e-9, says="are the ratios of leading minors"),),
            mistakes=(
                Mistake(
                    "entry beside the diagonal not squared",
                    "It enters twice: in the multiple of the row and in the row that is subtracted.",
                    lambda d, e: eliminated(d, e, power=1),
                ),
                Mistake(
                    "added instead of subtracted",
                    "The entry below the pivot has to vanish.",
                    lambda d, e: eliminated(d, e, sign=1),
                ),
            ),
            hint="Do it by hand for n = 2, then let the second pivot take the place of the first.",
        ),
        Question(
            name="solve",
            calls=any_size,
            returns=Array(lambda diagonal, *_: diagonal.shape),
            properties=(holds("satisfies the equations", left_over, 1e-10, 2.0),),
            mistakes=(
                Mistake(
                    "right-hand side not eliminated",
                    "What is subtracted from a row is subtracted on both sides of the equation.",
                    bidiagonal,
                ),
                Mistake(
                    "no way back up",
                    "Elimination leaves the entries above the diagonal: which unknown is found first?",
                    down_only,
                ),
            ),
            hint="One loop down with the right-hand side along, one loop up.",
            seconds=5.0,
        ),
        Question(
            name="determinant",
            calls=many,
            returns=Parts(Number(), Number()),
            properties=(
                holds("has the sign", lambda found, d, e: abs(found[0] - from_bottom(d, e)[0]), 0.0, 0.5),
                holds("has the logarithm of the size", lambda found, d, e: abs(found[1] / from_bottom(d, e)[1] - 1), 1e-9),
            ),
            mistakes=(
                Mistake(
                    "product overflows",
                    "Logarithms turn the product into a sum before it is too large for a floating point number.",
                    when=lambda given: np.isinf(given[-1][1][1]) and np.isfinite(given[0][1][1]),
                ),
                Mistake(
                    "product of the diagonal",
                    "The determinant is the product of the pivots.",
                    lambda d, e: log_product(d, e, over=d),
                ),
            ),
            hint="The steps of elimination do not change the determinant, and a triangular matrix shows its own.",
            seconds=5.0,
        ),
    ),
)

# %% proofs
PROOFS = {
    "pivots: entry beside the diagonal not squared": ("e**2", "e"),
    "pivots: added instead of subtracted": ("d - e**2", "d + e**2"),
    "solve: right-hand side not eliminated": ("x[i] -= off_diagonal[i - 1] / p[i - 1] * x[i - 1]", "pass"),
    "solve: no way back up": ("x[i] = (x[i] - off_diagonal[i] * x[i + 1]) / p[i]", "x[i] = x[i] / p[i]"),
    "determinant: product overflows": [
        ("import numpy as np", "import math\n\nimport numpy as np"),
        ("np.sum(np.log(np.abs(p)))", "np.log(abs(math.prod(p.tolist())))"),
    ],
    "determinant: product of the diagonal": ("p = pivots(diagonal, off_diagonal)\n    return", "p = diagonal\n    return"),
}
