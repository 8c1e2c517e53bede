r"""# Buckling loads to all digits

The straight strut of $n$ springs $k_1, \dots, k_n > 0$ and links of length $h$ buckles at the eigenvalues of $A = D^T \mathrm{diag}(k) D / h$
[N 2.7, 2.8.1], where $(D \phi)_i = \phi_i - \phi_{i-1}$, $\phi_0 = 0$:

$$A = \frac1h \begin{pmatrix} k_1 + k_2 & -k_2 & & \\ -k_2 & k_2 + k_3 & \ddots & \\ & \ddots & \ddots & -k_n \\ & & -k_n & k_n \end{pmatrix} .$$

If the stiffnesses differ by many powers of ten, the sums on the diagonal lose the digits of the soft springs, and the smallest load with them:
the eigenvalues of $A$ computed in double precision have errors relative to the *largest* one. The factor $B$ with
$B^T B = A$ has no sums: its entries are right to rounding, it is bidiagonal, and the loads are the squares of its singular values.

**Write**

1. `factor(k, h)`, a bidiagonal matrix $B$ (lower or upper) of shape (n, n) with $B^T B = A$, every entry accurate to rounding however the $k_i$ differ;
2. `smallest_load(k, h)`, the first buckling load with a relative error below $10^{-10}$ for stiffnesses that differ by $10^{14}$. (The *largest*
   singular value of any matrix is computed accurately: of which matrix is it the one you look for? What are the signs of its entries?)
"""

# %% answer
import numpy as np


def factor(k, h):
    """A bidiagonal B with B^T B = A, an array of shape (n, n)."""
    ### BEGIN SOLUTION
    n = len(k)
    root = np.sqrt(k / h)
    return np.diag(root) - np.diag(root[1:], -1)
    ### END SOLUTION


def smallest_load(k, h):
    """The first buckling load to nearly all digits."""
    ### BEGIN SOLUTION
    n = len(k)
    inverse = np.tril(np.ones((n, n))) * np.sqrt(h / k)  # B's, without any subtraction
    return 1 / np.linalg.norm(inverse, 2) ** 2
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import holds
from rodlab.grading.values import Array, Number


def matrix(k, h, *, above=0.0):
    """A, summed spring by spring."""
    A = np.zeros((len(k) + 1, len(k) + 1))
    for i, one in enumerate(k):
        A[i : i + 2, i : i + 2] += one / h * np.array([[1.0, -1.0], [-1.0, 1.0]])
    A[-1, -1] += above * k[-1] / h
    return A[1:, 1:]


def first_load(k, h):
    """From the compliances, A^-1_ij = h sum of 1/k_l over l <= min(i, j), all positive: the largest eigenvalue by powers of it."""
    n = len(k)
    soft = (h * np.cumsum(1 / k))[np.minimum.outer(range(n), range(n))]
    size = np.max(soft)
    power = soft / size
    for _ in range(14):  # to the power 16384
        power = power @ power
        power /= np.max(power)
    x = power @ np.ones(n)
    return (x @ x) / (x @ soft @ x)


def even(draw):
    for n in (2, 3, 7):
        yield draw.uniform(1, 5, size=n), draw.uniform(0.1, 0.8)


def spread(draw):
    yield from even(draw)
    for n in (6, 12):
        exponents = np.linspace(0, 14, n)
        yield 10.0 ** draw.permutation(exponents) * draw.uniform(1, 2, size=n), draw.uniform(0.1, 0.8)
    yield 10.0 ** np.append([14.0, 13.5], draw.uniform(0, 1, size=6)), draw.uniform(0.1, 0.8)


def off_product(B, k, h):
    return np.max(np.abs(B.T @ B - matrix(k, h))) / np.max(matrix(k, h))


def off_shape(B, *_):
    """Zero if entries are on the diagonal and on one of its sides only."""
    beside = min(np.max(np.abs(np.diag(B, 1)), initial=0.0), np.max(np.abs(np.diag(B, -1)), initial=0.0))
    far = np.abs(np.subtract.outer(range(len(B)), range(len(B)))) > 1
    return (beside + np.max(np.abs(B[far]), initial=0.0)) / np.max(np.abs(B))


def off_determinant(B, k, h):
    """The determinant of B squared is the product of all k_i / h; of a bidiagonal matrix it is that of its diagonal."""
    return abs(2 * np.sum(np.log(np.abs(np.diag(B)))) - np.sum(np.log(k / h)))


def off_load(lam, k, h):
    return abs(lam / first_load(k, h) - 1)


def spread_only(calls):
    return [(a, value) for a, value in calls if max(a[0]) > 1e6 * min(a[0])]


def even_only(calls):
    return [(a, value) for a, value in calls if max(a[0]) < 1e6 * min(a[0])]


def right_where_even(given, off, allowed):
    return max(off(np.array(value, dtype=float), *a) for a, value in even_only(given)) < allowed


def summed_first(given):
    """Right for even springs, and for others only relative to the largest entry: a factor of the summed matrix."""
    if not all(off_shape(np.array(B), *a) < 1e-12 for a, B in given):
        return False
    late = any(not off_determinant(np.array(B), *a) < 1e-8 for a, B in spread_only(given))
    return late and right_where_even(given, off_product, 1e-10) and right_where_even(given, off_determinant, 1e-10)


def from_the_tridiagonal(given):
    def off_by_rounding(value, k, h):
        return abs(value - first_load(k, h)) / np.max(matrix(k, h)) < 1e-13

    lost = any(not off_load(value, *a) < 2e-7 for a, value in spread_only(given))
    return lost and all(off_by_rounding(value, *a) for a, value in given) and right_where_even(given, off_load, 1e-9)


def half_of_the_digits(given):
    off = max(off_load(value, *a) for a, value in given)
    return 1e-10 < off < 2e-7 and right_where_even(given, off_load, 1e-9)


def like_even(other, within=1e-6):
    """Recognised by the calls with springs that hardly differ."""

    def found(given):
        return all(np.max(np.abs(np.array(v, dtype=float) / other(*a) - 1)) < within for a, v in even_only(given))

    return found


def lower(k, h, *, power=0.5, transposed=False, length=True):
    root = (k / (h if length else 1.0)) ** power
    B = np.diag(root) - np.diag(root[1:], -1)
    return B.T if transposed else B


exercise = Exercise(
    title="Buckling loads to all digits",
    source="N 2.7, 2.8.1",
    imports=("numpy", "scipy.linalg"),
    questions=(
        Question(
            name="factor",
            calls=spread,
            returns=Array(lambda k, h: (k.size, k.size)),
            properties=(
                holds("is bidiagonal and B^T B = A", lambda *a: off_product(*a) + off_shape(*a), 1e-12),
                holds("has the determinant of A's square root, for all stiffnesses", off_determinant, 1e-10),
            ),
            mistakes=(
                Mistake(
                    "B B^T for B^T B",
                    "Compare the corner k_n of A with that of your product: in which order is it taken?",
                    lambda *given: lower(*given, transposed=True),
                ),
                Mistake("square root forgotten", "B occurs twice in A.", lambda *given: lower(*given, power=1.0)),
                Mistake("h forgotten", "Shorter links buckle later: A has 1/h.", lambda *given: lower(*given, length=False)),
                Mistake(
                    "roots of the wrong springs",
                    "Row i of B belongs to spring i: both of its entries have the same size.",
                    lambda k, h: np.diag(np.sqrt(k / h)) - np.diag(np.sqrt(k[:-1] / h), -1),
                ),
                Mistake(
                    "factor of the summed matrix",
                    "For springs that hardly differ you are right. A factor computed from A has already lost what the sums lost; make it from k.",
                    when=summed_first,
                ),
            ),
            hint="A is D^T diag(k) D / h: put half of diag(k) to each side.",
        ),
        Question(
            name="smallest_load",
            calls=spread,
            returns=Number(),
            properties=(
                holds(
                    "is the first load for springs that hardly differ",
                    lambda lam, k, h: off_load(lam, k, h) if max(k) < 1e6 * min(k) else 0.0,
                    1e-9,
                ),
                holds("is the first load to ten digits for all springs", off_load, 1e-10, 2.0),
            ),
            mistakes=(
                Mistake(
                    "from the tridiagonal matrix",
                    "Your error is small against the largest load, not against the smallest. Which digits do the sums k_i + k_(i+1) keep?",
                    when=from_the_tridiagonal,
                ),
                Mistake(
                    "digits lost in the singular values",
                    "B keeps the digits, but your way from B to its smallest singular value rounds against its largest one.",
                    when=half_of_the_digits,
                ),
                Mistake(
                    "square forgotten",
                    "This is a singular value of B; how is a load made of it?",
                    when=like_even(lambda k, h: np.sqrt(first_load(k, h))),
                ),
                Mistake(
                    "largest load",
                    "This is the load of the last mode.",
                    when=like_even(lambda k, h: np.linalg.eigvalsh(matrix(k, h))[-1]),
                ),
                Mistake(
                    "a spring above the last link",
                    "Yours is the load of a strut that is held at its upper end too.",
                    when=like_even(lambda k, h: np.linalg.eigvalsh(matrix(k, h, above=1.0))[0]),
                ),
                Mistake(
                    "reciprocal",
                    "The largest singular value of the inverse is not yet the smallest of the matrix.",
                    when=like_even(lambda k, h: 1 / first_load(k, h)),
                ),
            ),
            hint="The inverse of B is known in closed form: a sum from the clamp, with positive entries only.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "factor: B B^T for B^T B": ("return np.diag(root) - np.diag(root[1:], -1)", "return np.diag(root) - np.diag(root[1:], 1)"),
    "factor: square root forgotten": ("root = np.sqrt(k / h)", "root = k / h"),
    "factor: h forgotten": ("root = np.sqrt(k / h)", "root = np.sqrt(k)"),
    "factor: roots of the wrong springs": ("np.diag(root[1:], -1)", "np.diag(root[:-1], -1)"),
    "factor: factor of the summed matrix": (
        "    return np.diag(root) - np.diag(root[1:], -1)",
        "    A = np.diag(k + np.append(k[1:], 0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)\n"
        "    pivots = [A[0, 0]]\n"
        "    for i in range(1, n):\n"
        "        pivots.append(A[i, i] - k[i] ** 2 / pivots[-1])\n"
        "    root = np.sqrt(np.abs(pivots) / h)\n"
        "    return np.diag(root) - np.diag(k[1:] / h / root[:-1], 1)",
    ),
    "smallest_load: from the tridiagonal matrix": (
        "    return 1 / np.linalg.norm(inverse, 2) ** 2",
        "    A = np.diag(k + np.append(k[1:], 0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)\n    return np.linalg.eigvalsh(A / h)[0]",
    ),
    "smallest_load: digits lost in the singular values": (
        "    return 1 / np.linalg.norm(inverse, 2) ** 2",
        "    B, O = factor(k, h), np.zeros((n, n))\n    return np.linalg.eigvalsh(np.block([[O, B.T], [B, O]]))[n] ** 2",
    ),
    "smallest_load: square forgotten": ("1 / np.linalg.norm(inverse, 2) ** 2", "1 / np.linalg.norm(inverse, 2)"),
    "smallest_load: largest load": ("1 / np.linalg.norm(inverse, 2) ** 2", "np.linalg.norm(factor(k, h), 2) ** 2"),
    "smallest_load: a spring above the last link": (
        "    return 1 / np.linalg.norm(inverse, 2) ** 2",
        "    A = factor(k, h).T @ factor(k, h)\n    A[-1, -1] += k[-1] / h\n    return np.linalg.eigvalsh(A)[0]",
    ),
    "smallest_load: reciprocal": ("1 / np.linalg.norm(inverse, 2) ** 2", "np.linalg.norm(inverse, 2) ** 2"),
}
