"""Checks of the exercise "Quadratic integrals and the midpoint rule"; made from the teacher's file."""

from itertools import pairwise

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number, Parts

STEP = 1e-30


def turned(y, K, u_hat, *, bend=None, turn=1.0):
    """From the definitions: N_1, N_3 are those at phi = 0, and the derivative is a complex step along phi' = u."""
    n1, n3, m = y
    u = u_hat + m / K if bend is None else bend(m, K, u_hat)
    phi = 1j * STEP * u * turn
    along = np.array([n1 * np.cos(phi) - n3 * np.sin(phi), n1 * np.sin(phi) + n3 * np.cos(phi)])
    return np.append(along.imag / STEP, -n1)


def g(y, K, u_hat):
    turn = (u_hat + y[2] / K) * np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    return turn @ y - np.array([0.0, 0.0, y[0]])


def quadratic(y, K, u_hat, *, rest=1.0, half=0.5, root=1.0):
    return half * y[2] ** 2 / K + rest * u_hat * y[2] + y[1], (y[0] ** 2 + y[1] ** 2) ** root


def states(draw):
    for _ in range(4):
        yield draw.normal(size=3) * 2 + 0.3, draw.uniform(1.3, 3), draw.uniform(0.3, 1.2)


def rods(draw):
    for n in (10, 20):
        size = draw.choice([-1.0, 1.0], size=3) * draw.uniform(2, 4, size=3)
        yield size, draw.uniform(1.3, 2), draw.uniform(0.3, 1.0), n


def off_rule(rows, y, K, u_hat, n):
    """The largest residual of the rule over all steps, and the beginning."""
    steps = [b - a - g((a + b) / 2, K, u_hat) / n for a, b in pairwise(rows)]
    return max(np.max(np.abs(steps)), np.max(np.abs(rows[0] - y)))


def drift(rows, y, K, u_hat, n):
    """How much the integrals change along the rod; for a march that goes at all."""
    values = np.array([quadratic(row, K, u_hat) for row in rows])
    moved = np.max(np.abs(rows[1:] - rows[:-1]))
    return np.nan if moved < 1e-3 else np.max(np.abs(values - quadratic(y, K, u_hat)))


def marched(one):
    def rows(y, K, u_hat, n):
        found = [y]
        for _ in range(n):
            found.append(one(found[-1], lambda y: g(y, K, u_hat), 1 / n))
        return np.array(found)

    return rows


def repeated(rule, sweeps=200):
    def one(y, f, h):
        new = y + h * f(y)
        for _ in range(sweeps):
            new = rule(y, new, f, h)
        return new

    return one


def runge_kutta(y, f, h):
    a = f(y)
    b = f(y + h / 2 * a)
    c = f(y + h / 2 * b)
    return y + h / 6 * (a + 2 * b + 2 * c + f(y + h * c))


def middle(y, new, f, h):
    return y + h * f((y + new) / 2)


exercise = Exercise(
    title="Quadratic integrals and the midpoint rule",
    source="N 2.8.2",
    questions=(
        Question(
            name="field",
            calls=states,
            returns=Array((3,)),
            properties=(equals(turned, 1e-12, says="is the derivative of the definitions (complex steps)", points=1.5),),
            mistakes=(
                Mistake(
                    "turning the other way",
                    "Differentiate n_1 = N_1 cos(phi) - N_3 sin(phi): which sign has n_3 in it?",
                    lambda *given: turned(*given, turn=-1.0),
                ),
                Mistake(
                    "rest curvature forgotten",
                    "The frame turns with phi', not with what the moment adds to it.",
                    lambda *given: turned(*given, bend=lambda m, K, u_hat: m / K),
                ),
                Mistake(
                    "moment for bend",
                    "phi' is not the moment: the stiffness lies between them.",
                    lambda *given: turned(*given, bend=lambda m, K, u_hat: u_hat + m),
                ),
                Mistake(
                    "sign of the moment's rate",
                    "Put phi = 0 into m' and into n_1.",
                    lambda *given: turned(*given) * np.array([1.0, 1.0, -1.0]),
                ),
            ),
            hint="The derivative of n_1 is -phi' times n_3; find the others alike, and m' among the definitions.",
        ),
        Question(
            name="integrals",
            calls=states,
            returns=Parts(Number(), Number()),
            properties=(equals(quadratic, 1e-12, says="are H and C"),),
            mistakes=(
                Mistake(
                    "factor one half",
                    "Differentiate H along your field: does it vanish?",
                    lambda *given: quadratic(*given, half=1.0),
                ),
                Mistake(
                    "rest curvature forgotten", "H has a term that is linear in m.", lambda *given: quadratic(*given, rest=0.0)
                ),
                Mistake("size of the force", "C is the square of the force's size.", lambda *given: quadratic(*given, root=0.5)),
            ),
            hint="They stand in the statement; mind that y is (n_1, n_3, m).",
        ),
        Question(
            name="march",
            calls=rods,
            returns=Array(lambda y, K, u_hat, n: (n + 1, 3)),
            properties=(
                holds("satisfies the midpoint rule at every step", off_rule, 1e-9, 1.5),
                holds("conserves H and C", drift, 1e-8),
            ),
            mistakes=(
                Mistake(
                    "Euler's steps",
                    "Your integrals drift in proportion to h: where is your right side evaluated?",
                    marched(lambda y, f, h: y + h * f(y)),
                ),
                Mistake(
                    "Runge and Kutta's method",
                    "Accurate, but explicit: look how H and C change by a little at every step.",
                    marched(runge_kutta),
                ),
                Mistake(
                    "explicit midpoint",
                    "You put a predicted value into the middle: the rule asks for the new value itself.",
                    marched(repeated(middle, 1)),
                ),
                Mistake(
                    "trapezoid rule",
                    "The mean of two right sides is not the right side at the mean; only one of the two rules conserves C.",
                    marched(repeated(lambda y, new, f, h: y + h * (f(y) + f(new)) / 2)),
                ),
                Mistake(
                    "implicit Euler's steps",
                    "You evaluate at the end of the step; where is the middle?",
                    marched(repeated(lambda y, new, f, h: y + h * f(new))),
                ),
            ),
            hint="Each step is a small system of equations for the new y: repeat the substitution until it stands still.",
        ),
    ),
)
