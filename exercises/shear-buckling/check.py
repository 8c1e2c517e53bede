"""Checks of the exercise "Buckling with shear and compression"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Number, Truth


def euler(j):
    return np.square((j - 0.5) * np.pi)


def gain(A_1, A_3):
    return (A_3 - A_1) / A_1 / A_3 if np.isfinite(A_1 * A_3) else 1 / A_1 - 1 / A_3


def left(lam, A_1, A_3):
    return lam * (1 + lam * gain(A_1, A_3))


def largest(A_1, A_3):
    """The largest value of the equation's left side over all positive loads."""
    a = gain(A_1, A_3)
    return np.inf if a >= 0 else left(-0.5 / a, A_1, A_3)


def has_load(j, A_1, A_3):
    return bool(largest(A_1, A_3) >= euler(j))


def root(j, A_1, A_3, *, P=None):
    """The smallest positive root by Newton's method, from that side where the curvature makes it monotone."""
    P, a = euler(j) if P is None else P, gain(A_1, A_3)
    lam = 0.0 if a < 0 else P
    for _ in range(60):
        lam -= (lam * (1 + lam * a) - P) / (1 + 2 * lam * a)
    return lam


def other_root(j, A_1, A_3):
    a = gain(A_1, A_3)
    return -1 / a - root(j, A_1, A_3)


def questions(draw):
    for j in (1, 2, 3):
        P = euler(j)
        yield j, np.inf, P * draw.uniform(1.5, 3.7)
        yield j, np.inf, P * draw.uniform(4.3, 9)
        yield j, P * draw.uniform(0.2, 0.9), P * draw.uniform(1.2, 3.8)
        yield j, P * draw.uniform(5, 7), P * draw.uniform(1.1, 2)


def stiffnesses(draw):
    yield 1, 17.0, 17.0
    for j in (1, 2, 3):
        P = euler(j)
        yield j, P * draw.uniform(4.3, 7), np.inf
        yield j, np.inf, P * draw.uniform(4.5, 9)
        yield j, P * draw.uniform(4, 6), P * draw.uniform(8, 12)
        A_1 = P * draw.uniform(5, 6)
        yield j, A_1, A_1 * (1 + 1e-9 * draw.uniform(1, 2))


def modes(draw):
    for j in (1, 2, 3, 4):
        yield (j,)


def near(A_1, A_3):
    return abs(A_1 - A_3) < 1e-6 * A_1 or A_1 == A_3


def off_equation(lam, j, A_1, A_3):
    return abs(left(lam, A_1, A_3) / euler(j) - 1)


def digits_lost(given):
    """Right where the stiffnesses differ; where they hardly do, digits are missing, or all of them (0/0)."""
    far = [off_equation(float(lam), *a) for a, lam in given if not near(*a[1:])]
    close = [off_equation(float(lam), *a) for a, lam in given if near(*a[1:]) and np.isfinite(float(lam))]
    return max(far) < 1e-12 < max(close) < 1e-3


def where_apart(measure):
    """A measure that looks at stiffnesses that differ only."""
    return lambda lam, j, *A: 0.0 if near(*A) else measure(lam, j, *A)


def off_root(lam, *given):
    return abs(lam / root(*given) - 1)


def the_other(given):
    """The other of the two roots, or the largest of them: that is the same one where both are positive."""
    apart = [(arguments, lam) for arguments, lam in given if not near(*arguments[1:])]
    negative = [other_root(*arguments) < 0 < lam and off_root(lam, *arguments) < 1e-6 for arguments, lam in apart]
    return all(right or abs(lam / other_root(*a) - 1) < 1e-6 for right, (a, lam) in zip(negative, apart, strict=True))


exercise = Exercise(
    title="Buckling with shear and compression",
    source="N 2.8",
    questions=(
        Question(
            name="buckles",
            calls=questions,
            returns=Truth(),
            properties=(equals(has_load, 0.0, says="says whether there is a load"),),
            mistakes=(
                Mistake(
                    "A_1 and A_3 interchanged",
                    "A rod that shears easily buckles early: can a small A_1 prevent buckling?",
                    lambda j, A_1, A_3: has_load(j, A_3, A_1),
                ),
                Mistake(
                    "compression always prevents",
                    "If the coefficient of lam^2 is negative, how large does the left side become at most?",
                    lambda j, A_1, A_3: bool(gain(A_1, A_3) >= 0),
                ),
                Mistake("first mode only", "Higher modes have larger P_j: is there still a load?", lambda j, *A: has_load(1, *A)),
            ),
            hint="The left side is a parabola in lam through zero: where does it bend down, and how high does it come?",
        ),
        Question(
            name="load",
            calls=stiffnesses,
            returns=Number(),
            properties=(
                holds("satisfies the equation where A_1 and A_3 differ", where_apart(off_equation), 1e-8, 0.5),
                holds("is the smallest positive root where A_1 and A_3 differ", where_apart(off_root), 1e-8),
                equals(root, 1e-12, says="is correct to nearly all digits, whatever A_1 and A_3 are"),
            ),
            mistakes=(
                Mistake(
                    "j for 2j - 1",
                    "One end is free: which waves have a horizontal tangent there? Compare P_2 with P_1.",
                    lambda j, *A: root(j, *A, P=j**2 * np.pi**2 / 4),
                ),
                Mistake(
                    "A_1 and A_3 interchanged",
                    "Shear alone (A_3 infinite) must lower the load below Euler's.",
                    lambda j, A_1, A_3: root(j, A_3, A_1),
                ),
                Mistake(
                    "the other root",
                    "A parabola has two roots. Which one tends to Euler's load as the stiffnesses grow?",
                    when=the_other,
                ),
                Mistake("Euler's load", "This is the load of a rod that neither shears nor shortens.", lambda j, *A: euler(j)),
                Mistake(
                    "digits lost",
                    "The root is right where A_1 and A_3 differ much. Where they hardly differ, two nearly equal numbers are subtracted.",
                    when=digits_lost,
                ),
            ),
            hint="Solve the quadratic; then ask which form of its root survives when the coefficient of lam^2 tends to zero.",
        ),
        Question(
            name="least_stiffness",
            calls=modes,
            returns=Number(),
            properties=(
                equals(lambda j: 4 * euler(j), 1e-10, says="is where the load of an unshearable rod disappears", points=0.5),
            ),
            mistakes=(
                Mistake("Euler's load itself", "At A_3 = P_j your rod would have to shrink to nothing before it buckles.", euler),
                Mistake("half", "Where are the two roots the same? Look at the discriminant again.", lambda j: 2 * euler(j)),
                Mistake("mode forgotten", "This is the answer for the first mode; P_j grows with j.", lambda j: 4 * euler(1)),
            ),
            hint="At the smallest stiffness the parabola just touches the height P_j.",
        ),
    ),
)
