"""Checks of the exercise "The force in two bases"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import STEP, equals, holds
from rodlab.grading.values import Array


def directors(phi):
    """d_1 and d_3 as rows, in e_1 and e_3."""
    return np.array([[np.cos(phi), -np.sin(phi)], [np.sin(phi), np.cos(phi)]])


def turned(a, b, phi):
    """Components along the directors of the vector (a, b)."""
    return directors(phi) @ [a, b]


def off_force(value, N1, N3, phi):
    """How far n1 d_1 + n3 d_3 is from the force."""
    return np.max(np.abs(value @ directors(phi) - [N1, N3])) / np.hypot(N1, N3)


def off_components(value, n1, n3, phi):
    """How far the products with d_1 and d_3 are from those asked for."""
    return np.max(np.abs(directors(phi) @ value - [n1, n3])) / np.hypot(n1, n3)


def slopes(n1, n3, kappa):
    """By a complex step along a rod that bends from phi = 0 on, with the force fixed; and the moment by a cross product."""
    force = directors(1j * STEP * kappa) @ [n1, n3]
    moment = -np.cross([0, 0, 1], [n1, 0, n3])[1]
    return np.array([*(np.imag(force) / STEP), moment])


def off_moment(value, n1, n3, kappa):
    return abs(value[2] - slopes(n1, n3, kappa)[2]) / np.hypot(n1, n3)


def off_size(value, n1, n3, kappa):
    """The size of the force and the bending: the rate of n1^2 + n3^2, and that of the force's direction in the body."""
    size = n1**2 + n3**2
    return (abs(n1 * value[0] + n3 * value[1]) + abs(n3 * value[0] - n1 * value[1] + kappa * size)) / size


def angles(draw):
    for sign in (1, -1, 1):
        a, b = draw.uniform(1, 2), draw.uniform(2.5, 4)
        yield a, sign * b, draw.uniform(0.3, 0.7) if sign > 0 else draw.uniform(2, 2.6)


def bends(draw):
    for sign in (1, -1):
        yield draw.uniform(1, 2), sign * draw.uniform(2.5, 4), draw.uniform(1.5, 2.5)


exercise = Exercise(
    title="The force in two bases",
    source="N 2.6",
    questions=(
        Question(
            name="body",
            calls=angles,
            returns=Array((2,)),
            properties=(holds("makes n1 d_1 + n3 d_3 the given force", off_force, 1e-12),),
            mistakes=(
                Mistake(
                    "anticlockwise",
                    "Put phi = pi/2 into the statement: where does d_3 point? In the plane as drawn, is this a turn to the right or to the left?",
                    lambda N1, N3, phi: turned(N1, N3, -phi),
                ),
                Mistake(
                    "degrees for radians",
                    "In which unit does the statement give angles, and in which does np.cos take them?",
                    lambda N1, N3, phi: turned(N1, N3, np.radians(phi)),
                ),
                Mistake(
                    "sine and cosine interchanged",
                    "At phi = 0 the two bases are the same: what do you return?",
                    lambda N1, N3, phi: np.array([N1 * np.sin(phi) - N3 * np.cos(phi), N1 * np.cos(phi) + N3 * np.sin(phi)]),
                ),
                Mistake("in the other order", "The component along d_1 comes first.", lambda *given: turned(*given)[::-1]),
            ),
            hint="Take the product of the force with d_1, and with d_3.",
        ),
        Question(
            name="fixed",
            calls=angles,
            returns=Array((2,)),
            properties=(holds("has the given components along d_1 and d_3", off_components, 1e-12),),
            mistakes=(
                Mistake(
                    "not inverted",
                    "This turns the same way as the map from the fixed basis does. Go there and back: are you where you started?",
                    turned,
                ),
                Mistake(
                    "only the sine's angle turned back",
                    "The inverse of a rotation is one by the opposite angle. Which of cos and sin changes its sign, and in which entries?",
                    lambda n1, n3, phi: np.array([n1 * np.cos(phi) + n3 * np.sin(phi), n1 * np.sin(phi) + n3 * np.cos(phi)]),
                ),
            ),
            hint="Collect in n1 d_1 + n3 d_3 what stands before e_1, and before e_3.",
        ),
        Question(
            name="rates",
            calls=bends,
            returns=Array((3,)),
            properties=(
                holds("keeps the size of the force and turns it with the rod", off_size, 1e-12),
                holds("balances the moments", off_moment, 1e-12, 0.5),
                equals(slopes, 1e-12, says="is the derivative of the three", points=0.5),
            ),
            mistakes=(
                Mistake(
                    "force turns the wrong way",
                    "The force stands still while the body turns clockwise: differentiate your own formula for n1 by phi.",
                    lambda *given: slopes(*given) * [-1, -1, 1],
                ),
                Mistake(
                    "sign of the moment's derivative",
                    "Write r' x n for r' = e_3 and n = n1 e_1: is e_3 x e_1 plus or minus e_2? And on which side of the equation is it?",
                    lambda *given: slopes(*given) * [1, 1, -1],
                ),
                Mistake(
                    "curvature forgotten",
                    "By phi or by s? The chain rule brings in the curvature.",
                    lambda n1, n3, kappa: slopes(n1, n3, 1.0),
                ),
                Mistake(
                    "body components constant",
                    "It is N1 and N3 that are constant: seen from a body that turns, a constant force turns too.",
                    lambda n1, n3, kappa: slopes(n1, n3, 0.0),
                ),
                Mistake(
                    "axial force in the moment's balance",
                    "A force along the rod has no moment about its points: which component is left in d_3 x n?",
                    lambda n1, n3, kappa: np.array([-kappa * n3, kappa * n1, -n3]),
                ),
            ),
            hint="Differentiate (n1, n3) at constant N1 and N3; for the moment, d_3 x d_1 = d_2.",
        ),
    ),
)
