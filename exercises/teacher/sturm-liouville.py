r"""# Buckling loads of a rod of variable stiffness

The straight rod of stiffness $K(s) > 0$ and length 1, clamped below and free above, buckles at the eigenvalues
$\lambda_1 < \lambda_2 < \dots$ of the Sturm-Liouville problem [N 2.8.1]

$$(K \psi')' + \lambda \psi = 0, \qquad \psi(0) = 0, \quad K(1) \psi'(1) = 0 .$$

In general they can only be computed. For $K = (1 + c s)^2$, $0 < c \le 5$, the substitution $t = \ln(1 + c s)$ leaves constant coefficients, and

$$\psi = \frac{\sin(w t)}{\sqrt{1 + c s}}, \qquad \lambda = c^2 \Bigl( w^2 + \tfrac14 \Bigr), \qquad \tan(w \ln(1 + c)) = 2 w, \quad w > 0 ;$$

the $j$-th positive root $w$ belongs to mode $j$. ($c = 1$ gives $\lambda_1 = 3.836\ldots$)

**Write**

1. `exact(c, j)`, the $j$-th load for $K = (1 + cs)^2$ from the equation for $w$, a number with a relative error below $10^{-9}$. In which
   interval is the $j$-th root, and only it?
2. `loads(K, count)`, the first `count` loads, ascending, shape (count,), for any smooth `K`, a function of an array `s` that returns an array
   of the same shape; by finite differences, shooting or any other method, with a relative error below $10^{-3}$ (`count` is at most 3).
"""

# %% answer
import numpy as np
from scipy.linalg import eigh_tridiagonal
from scipy.optimize import brentq


def exact(c, j):
    """The j-th load for K = (1 + c s)^2."""
    ### BEGIN SOLUTION
    length = np.log(1 + c)
    # sin(w length) - 2 w cos(w length) changes its sign once between (j - 1) pi and (j - 1/2) pi
    low, high = (max(j - 1, 1e-6) * np.pi / length, (j - 0.5) * np.pi / length)
    w = brentq(lambda w: np.sin(w * length) - 2 * w * np.cos(w * length), low, high, xtol=1e-13)
    return c**2 * (w**2 + 0.25)
    ### END SOLUTION


def loads(K, count):
    """The first loads for any stiffness K(s), an array of shape (count,)."""
    ### BEGIN SOLUTION
    n = 500
    h = 1 / n
    stiffness = K((np.arange(n) + 0.5) * h)  # between the unknowns psi_1, ..., psi_n and psi_0 = 0
    weight = np.append(np.ones(n - 1), 0.5)
    diagonal = (stiffness + np.append(stiffness[1:], 0.0)) / h**2 / weight
    beside = -stiffness[1:] / h**2 / np.sqrt(weight[1:] * weight[:-1])
    return eigh_tridiagonal(diagonal, beside, eigvals_only=True, select="i", select_range=(0, count - 1))
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals
from rodlab.grading.values import Array, Number


def ritz(K, *, degree=24, clamped_above=False):
    """All loads by Ritz's method with polynomials that vanish at the clamp: the first are right to ten digits."""
    x, weights = np.polynomial.legendre.leggauss(2 * degree)
    s = (x + 1) / 2
    P = np.polynomial.legendre.legvander(x, degree - 1)
    slopes = np.array([np.polynomial.legendre.legval(x, np.polynomial.legendre.legder(row)) for row in np.eye(degree)]).T
    shape = s * (1 - s) if clamped_above else s
    bend = 1 - 2 * s if clamped_above else np.ones_like(s)
    psi, slope = shape[:, None] * P, bend[:, None] * P + 2 * shape[:, None] * slopes
    root = np.linalg.qr(np.sqrt(weights)[:, None] * psi, mode="r")
    bent = np.sqrt(weights * K(s))[:, None] * slope
    return np.sort(np.linalg.svd(np.linalg.solve(root.T, bent.T), compute_uv=False) ** 2)


def square(c):
    return lambda s: (1 + c * s) ** 2


def by_ritz(c, j):
    return ritz(square(c))[j - 1]


def first(K, count):
    return ritz(K)[:count]


def bends(draw):
    for j in (1, 2, 3):
        yield draw.uniform(0.4, 4.5), j


def rods(draw):
    a, b, c = draw.uniform(0.5, 1.5), draw.uniform(0.8, 1.3), draw.uniform(2.2, 3)
    yield Code(f"lambda s: ({b:.4f} + {a:.4f} * s) ** 2"), 3
    yield Code(f"lambda s: {b:.4f} * np.exp(-{a:.4f} * s)"), 2
    yield Code(f"lambda s: 2 + {b:.4f} * np.sin({c:.4f} * s)"), 3


def wave(c, j, *, quarter=0.25, factor=2.0):
    """From another equation for w: bisection."""
    length = np.log(1 + c)
    low, high = 1e-9 if j == 1 else (j - 1) * np.pi / length, (j - 0.5) * np.pi / length
    for _ in range(60):
        w = (low + high) / 2
        inside = (np.sin(w * length) - factor * w * np.cos(w * length)) * (-1) ** (j - 1) < 0
        low, high = (w, high) if inside else (low, w)
    return c**2 * (w**2 + quarter)


def near(other, within=2e-3):
    """True if all values are those of another route, to the accuracy that is asked for."""
    return lambda given: all(np.max(np.abs(np.array(v, dtype=float) / other(*a) - 1)) < within for a, v in given)


exercise = Exercise(
    title="Buckling loads of a rod of variable stiffness",
    source="N 2.8.1",
    imports=("numpy", "scipy.linalg", "scipy.optimize"),
    questions=(
        Question(
            name="exact",
            calls=bends,
            returns=Number(),
            properties=(
                equals(by_ritz, 1e-3, says="is the load of the mode, roughly", points=0.5),
                equals(by_ritz, 1e-8, says="is the load of the mode to eight digits"),
            ),
            mistakes=(
                Mistake("next branch", "Is there a root below yours? Draw both sides over w.", lambda c, j: wave(c, j + 1)),
                Mistake(
                    "c squared forgotten",
                    "The derivative with respect to s is c/(1 + cs) times that with respect to t.",
                    lambda c, j: wave(c, j) / c**2,
                ),
                Mistake("quarter forgotten", "Your load is c^2 w^2; look at lambda again.", lambda c, j: wave(c, j, quarter=0.0)),
                Mistake(
                    "clamped above",
                    "The sine vanishes at your end s = 1; it is the slope of psi that must vanish there.",
                    lambda c, j: c**2 * ((j * np.pi / np.log(1 + c)) ** 2 + 0.25),
                ),
                Mistake(
                    "pole of the tangent",
                    "Where the tangent jumps from plus to minus infinity there is a change of sign, but no root.",
                    lambda c, j: c**2 * (((j - 0.5) * np.pi / np.log(1 + c)) ** 2 + 0.25),
                ),
            ),
            hint="Between two poles of the tangent there is one root; multiply by the cosine to be rid of the poles.",
        ),
        Question(
            name="loads",
            calls=rods,
            returns=Array(lambda K, count: (count,)),
            properties=(
                equals(first, 0.2, says="are the loads, roughly", points=0.5),
                equals(first, 1e-3, says="are the loads to three digits", points=1.5),
            ),
            mistakes=(
                Mistake(
                    "clamped above",
                    "Your rod is held at both ends; what is different in the last row if the upper end is free?",
                    when=near(lambda K, count: ritz(K, clamped_above=True)[:count], 0.02),
                ),
                Mistake(
                    "square roots",
                    "Are these eigenvalues, or square roots of them?",
                    when=near(lambda K, count: np.sqrt(first(K, count))),
                ),
                Mistake(
                    "near but not to three digits",
                    "Double the number of points: if the error only halves, look at the last one, with a whole weight the rod is h/2 too long.",
                    when=lambda given: (
                        any(np.max(np.abs(v - first(*a))) > 1e-3 * first(*a)[-1] for a, v in given) and near(first, 0.05)(given)
                    ),
                ),
                Mistake(
                    "stiffness at the clamp for the whole rod",
                    "Does your answer see how K changes along the rod?",
                    when=near(lambda K, count: ritz(lambda s: K(0 * s))[:count]),
                ),
                Mistake(
                    "sign",
                    "The loads are positive: psi'' is the negative of what resists.",
                    when=near(lambda K, count: -first(K, count)),
                ),
            ),
            hint="Differences of psi between neighbouring points, K in the middle between them, half a weight at the free end.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "exact: next branch": ("    length = np.log(1 + c)\n", "    length, j = np.log(1 + c), j + 1\n"),
    "exact: c squared forgotten": ("return c**2 * (w", "return (w"),
    "exact: quarter forgotten": ("(w**2 + 0.25)", "w**2"),
    "exact: clamped above": ("w = brentq(", "w = j * np.pi / length or brentq("),
    "exact: pole of the tangent": ("w = brentq(", "w = high or brentq("),
    "loads: clamped above": [
        ("weight = np.append(np.ones(n - 1), 0.5)", "weight = np.ones(n)"),
        ("np.append(stiffness[1:], 0.0)", "np.append(stiffness[1:], stiffness[-1])"),
    ],
    "loads: square roots": (
        'return eigh_tridiagonal(diagonal, beside, eigvals_only=True, select="i", select_range=(0, count - 1))',
        'return np.sqrt(eigh_tridiagonal(diagonal, beside, eigvals_only=True, select="i", select_range=(0, count - 1)))',
    ),
    "loads: near but not to three digits": [
        ("n = 500", "n = 50"),
        ("weight = np.append(np.ones(n - 1), 0.5)", "weight = np.ones(n)"),
    ],
    "loads: stiffness at the clamp for the whole rod": ("K((np.arange(n) + 0.5) * h)", "K(np.zeros(n))"),
    "loads: sign": ("return eigh_tridiagonal(", "return -eigh_tridiagonal("),
}
