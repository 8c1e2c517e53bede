"""Checks of the exercise "No singularity without a load"; made from the teacher's file."""

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
