r"""# No singularity without a load

At $\lambda = 0$ the linearisation of the rod at its unstressed shape is, whatever $\hat u$ [N 2.8.1, exercise],

$$-(K \psi')' = \mu \psi, \qquad \psi(0) = 0, \quad \psi'(1) = 0,$$

and it is nonsingular if no eigenvalue $\mu$ is zero. Show it for the discrete rod: joints at $s_i = i h$, $h = 1/n$, $i = 1, \dots, n$, with
stiffnesses $K(s_i) > 0$, values $\psi_1, \dots, \psi_n$, $\psi_0 = 0$, and the equations

$$\frac{1}{h} \Bigl( K(s_i) \frac{\psi_i - \psi_{i-1}}{h} - K(s_{i+1}) \frac{\psi_{i+1} - \psi_i}{h} \Bigr) = \mu \psi_i, \qquad i = 1, \dots, n,$$

where the second term is absent for $i = n$ (natural boundary condition).

**Write**

1. `linearisation(K, n)`, the matrix of the left side, shape (n, n), for a function `K` of an array of arclengths;
2. `smallest(K, n)`, its smallest eigenvalue, a number;
3. `bound(K_min, n)`, the largest number that is a lower bound of `smallest(K, n)` for *every* $K \ge K_{\min}$. It is positive: the
   unstressed rod lies on one branch of equilibria only. For $n \to \infty$ it tends to $K_{\min} \pi^2/4$.
"""

# %% answer
import numpy as np


def linearisation(K, n):
    """The matrix of -(K psi')' at the joints 1, ..., n, an array of shape (n, n)."""
    ### BEGIN SOLUTION
    h = 1 / n
    stiffness = K(np.arange(1, n + 1) * h)
    differences = np.eye(n) - np.eye(n, k=-1)  # of psi_0 = 0, psi_1, ..., psi_n
    return differences.T @ np.diag(stiffness) @ differences / h**2
    ### END SOLUTION


def smallest(K, n):
    """Its smallest eigenvalue."""
    ### BEGIN SOLUTION
    return np.linalg.eigvalsh(linearisation(K, n))[0]
    ### END SOLUTION


def bound(K_min, n):
    """The smallest eigenvalue of the softest rod with K >= K_min."""
    ### BEGIN SOLUTION
    return 4 * K_min * n**2 * np.sin(np.pi / (2 * (2 * n + 1))) ** 2
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds, symmetric
from rodlab.grading.values import Array, Number


def stiffness(K, n):
    return np.array([K(np.array([i / n]))[0] for i in range(1, n + 1)])


def springs(k, *, first=1.0, beyond=0.0, h=None):
    """The sum of each spring's own matrix, K_i/h^2 times that of a difference; `beyond` the last joint there is none."""
    n = len(k)
    A = np.zeros((n + 1, n + 1))
    for i in range(n):
        A[i : i + 2, i : i + 2] += k[i] * (first if i == 0 else 1.0) * np.array([[1.0, -1.0], [-1.0, 1.0]])
    A[n, n] += beyond * k[-1]
    return A[1:, 1:] / (h or 1 / n) ** 2


def matrix(K, n, **changed):
    return springs(stiffness(K, n), **changed)


def smallest_by_inverse(K, n):
    """The inverse has the entries h^2 sum of 1/K_l over l <= min(i, j): its largest eigenvalue, by its norm."""
    soft = np.cumsum(1 / stiffness(K, n)) / n**2
    return 1 / np.linalg.norm(soft[np.minimum.outer(range(n), range(n))], 2)


def off_determinant(A, K, n):
    """The determinant is the product of K_i/h^2, none of which vanishes."""
    sign, size = np.linalg.slogdet(A)
    return abs(sign - 1) + abs(size - np.sum(np.log(stiffness(K, n) * n**2)))


def rods(draw):
    for n in (2, 5, 12):
        a, b, c = draw.uniform(1.5, 3), draw.uniform(0.6, 1.2), draw.uniform(2, 4)
        yield Code(f"lambda s: {a:.4f} + {b:.4f} * np.cos({c:.4f} * s)"), n


def floors(draw):
    for n in (2, 3, 9, 40):
        yield draw.uniform(0.5, 3), n


def constant(K_min, n, **changed):
    return np.linalg.eigvalsh(springs(np.full(n, K_min), **changed))[0]


exercise = Exercise(
    title="No singularity without a load",
    source="N 2.8.1",
    questions=(
        Question(
            name="linearisation",
            calls=rods,
            returns=Array(lambda K, n: (n, n)),
            properties=(
                symmetric(points=0.5),
                equals(matrix, 1e-12, says="is the matrix of the equations", points=1.5),
                holds("has the determinant product of K_i/h^2, not zero", off_determinant, 1e-9, 0.5),
            ),
            mistakes=(
                Mistake(
                    "clamped at both ends",
                    "The end s = 1 is free: is there a spring beyond joint n?",
                    lambda K, n: matrix(K, n, beyond=1.0),
                ),
                Mistake(
                    "free at both ends",
                    "Your matrix is singular: constants are mapped to zero. What holds the rod at s = 0?",
                    lambda K, n: matrix(K, n, first=0.0),
                ),
                Mistake(
                    "h once",
                    "-(K psi')' has two derivatives: how does the matrix grow when n is doubled?",
                    lambda K, n: matrix(K, n, h=n**-0.5),
                ),
                Mistake("h forgotten", "Your matrix is that of links of length 1; h = 1/n.", lambda K, n: matrix(K, n, h=1.0)),
                Mistake(
                    "sign", "A spring resists: the matrix of -(K psi')' has a positive diagonal.", lambda K, n: -matrix(K, n)
                ),
                Mistake(
                    "stiffness of the joint before",
                    "At which arclength is the spring between psi_i and psi_(i-1)? Look at the first argument of your K.",
                    lambda K, n: springs(np.array([K(np.array([i / n]))[0] for i in range(n)])),
                ),
            ),
            hint="Each spring K(s_i) couples psi_i to psi_(i-1); write down the rows for n = 3, the first and the last with care.",
        ),
        Question(
            name="smallest",
            calls=rods,
            returns=Number(),
            properties=(equals(smallest_by_inverse, 1e-9, says="is the smallest eigenvalue"),),
            mistakes=(
                Mistake(
                    "largest eigenvalue",
                    "Yours grows without bound with n; which eigenvalue comes nearest to zero?",
                    lambda K, n: np.linalg.eigvalsh(matrix(K, n))[-1],
                ),
                Mistake(
                    "clamped at both ends",
                    "This is several times too large: with a free end the first mode is a quarter of a wave.",
                    lambda K, n: np.linalg.eigvalsh(matrix(K, n, beyond=1.0))[0],
                ),
                Mistake(
                    "smallest singular value of a factor",
                    "Your number is the square root of an eigenvalue.",
                    lambda K, n: np.sqrt(smallest_by_inverse(K, n)),
                ),
            ),
            hint="The matrix is symmetric; its eigenvalues are real and can be had in ascending order.",
        ),
        Question(
            name="bound",
            calls=floors,
            returns=Number(),
            properties=(equals(constant, 1e-9, says="is the smallest eigenvalue of the softest rod"),),
            mistakes=(
                Mistake(
                    "limit of many joints",
                    "This holds for the continuous rod. Try K = K_min with n = 2: the discrete eigenvalue is smaller.",
                    lambda K_min, n: K_min * np.pi**2 / 4,
                ),
                Mistake(
                    "clamped at both ends",
                    "A bound that is larger than an eigenvalue is none: the free end makes the rod softer.",
                    lambda K_min, n: constant(K_min, n, beyond=1.0),
                ),
                Mistake(
                    "half the last weight",
                    "This is the eigenvalue of another rule, with half of the last joint's weight; here every psi_i counts the same.",
                    lambda K_min, n: 4 * K_min * n**2 * np.sin(np.pi / (4 * n)) ** 2,
                ),
            ),
            hint="psi^T A psi is a sum of K(s_i) times squares: for which K >= K_min is it smallest? Then only one rod is left.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "linearisation: clamped at both ends": (
        "    return differences.T @ np.diag(stiffness) @ differences / h**2",
        "    A = differences.T @ np.diag(stiffness) @ differences\n    A[-1, -1] += stiffness[-1]\n    return A / h**2",
    ),
    "linearisation: free at both ends": (
        "    differences = np.eye(n)",
        "    stiffness = stiffness * (np.arange(n) > 0)\n    differences = np.eye(n)",
    ),
    "linearisation: h once": ("differences / h**2", "differences / h"),
    "linearisation: h forgotten": ("differences / h**2", "differences"),
    "linearisation: sign": ("return differences.T", "return -differences.T"),
    "linearisation: stiffness of the joint before": ("np.arange(1, n + 1)", "np.arange(n)"),
    "smallest: largest eigenvalue": ("(linearisation(K, n))[0]", "(linearisation(K, n))[-1]"),
    "smallest: clamped at both ends": (
        "    return np.linalg.eigvalsh(linearisation(K, n))[0]",
        "    A = linearisation(K, n)\n    A[-1, -1] += K(1.0) * n**2\n    return np.linalg.eigvalsh(A)[0]",
    ),
    "smallest: smallest singular value of a factor": (
        "np.linalg.eigvalsh(linearisation(K, n))[0]",
        "np.linalg.eigvalsh(linearisation(K, n))[0] ** 0.5",
    ),
    "bound: limit of many joints": ("4 * K_min * n**2 * np.sin(np.pi / (2 * (2 * n + 1))) ** 2", "K_min * np.pi**2 / 4"),
    "bound: clamped at both ends": ("(2 * (2 * n + 1))", "(2 * (n + 1))"),
    "bound: half the last weight": ("(2 * (2 * n + 1))", "(4 * n)"),
}
