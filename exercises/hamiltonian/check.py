"""Checks of the exercise "The Hamiltonian of a planar rod"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number


def energy(phi, m, N1, N3, K, u_hat, *, moment=1.0, curvature=1.0, cosine=1.0, sine=1.0):
    return moment * m**2 / (2 * K) + curvature * u_hat * m + cosine * N3 * np.cos(phi) + sine * N1 * np.sin(phi)


def right_hand_side(phi, m, N1, N3, K, u_hat):
    return np.array([u_hat + m / K, N3 * np.sin(phi) - N1 * np.cos(phi)])


def integrated(phi, m, N1, N3, K, u_hat, steps, *, euler=False):
    step, state = 1.0 / steps, np.array([phi, m])
    for _ in range(steps):
        a = right_hand_side(*state, N1, N3, K, u_hat)
        if euler:
            state = state + step * a
            continue
        b = right_hand_side(*(state + step * a / 2), N1, N3, K, u_hat)
        c = right_hand_side(*(state + step * b / 2), N1, N3, K, u_hat)
        d = right_hand_side(*(state + step * c), N1, N3, K, u_hat)
        state = state + step * (a + 2 * b + 2 * c + d) / 6
    return state


def change(phi, m, *given, euler=False):
    *others, steps = given
    return energy(*integrated(phi, m, *others, steps, euler=euler), *others) - energy(phi, m, *others)


def states(draw):
    for _ in range(4):
        yield (
            draw.uniform(0.3, 1.2),
            draw.uniform(1, 2),
            *draw.uniform(1, 3, size=2),
            draw.uniform(1.5, 3),
            draw.uniform(0.5, 1.5),
        )


def runs(draw):
    start = (
        draw.uniform(0.3, 0.6),
        draw.uniform(1, 1.5),
        *draw.uniform(2, 3, size=2),
        draw.uniform(0.9, 1.1),
        draw.uniform(0.8, 1.2),
    )
    for steps in (16, 32, 64):
        yield *start, steps


def off_drift(value, *given):
    """Relative distance from the true drift, which is itself a difference and known to rounding only."""
    true = change(*given)
    return abs(value - true) / (abs(true) + 1e-8)


exercise = Exercise(
    title="The Hamiltonian of a planar rod",
    source="N 2.6",
    questions=(
        Question(
            name="H",
            calls=states,
            returns=Number(),
            properties=(equals(energy, 1e-12, says="is the Hamiltonian", points=2.0),),
            mistakes=(
                Mistake(
                    "unstressed curvature forgotten",
                    "Differentiate your H by m: is it phi' for a rod that is curved when unstressed?",
                    lambda *given: energy(*given, curvature=0.0),
                ),
                Mistake(
                    "factor one half",
                    "Differentiate your H by m and compare with the first equation.",
                    lambda *given: energy(*given, moment=2.0),
                ),
                Mistake(
                    "sign of the force along e_3",
                    "Differentiate your H by phi, mind the minus sign in m' = -dH/dphi, and compare the term with N3.",
                    lambda *given: energy(*given, cosine=-1.0),
                ),
                Mistake(
                    "sign of the force along e_1",
                    "Differentiate your H by phi and compare the term with N1.",
                    lambda *given: energy(*given, sine=-1.0),
                ),
                Mistake(
                    "the energy density",
                    "This is K (phi' - u_hat)^2 / 2 less the force's part: a Lagrangian. H is its Legendre transform.",
                    lambda *given: energy(*given, curvature=0.0, cosine=-1.0, sine=-1.0),
                ),
            ),
            hint="Integrate phi' = dH/dm over m, then choose the rest so that -dH/dphi is m'.",
        ),
        Question(
            name="field",
            calls=states,
            returns=Array((2,)),
            properties=(equals(right_hand_side, 1e-12, says="is the right-hand side"),),
            mistakes=(
                Mistake(
                    "sign of the moment's equation",
                    "Which sign have the forces in m'? Compare with the statement at phi = pi/2.",
                    lambda *given: right_hand_side(*given) * [1, -1],
                ),
                Mistake(
                    "sine and cosine interchanged",
                    "A straight rod (phi = 0) that is pushed along itself (N1 = 0) is in equilibrium. Is yours?",
                    lambda phi, m, N1, N3, K, u_hat: np.array([u_hat + m / K, N3 * np.cos(phi) - N1 * np.sin(phi)]),
                ),
            ),
            hint="The two equations of the statement, as they stand.",
        ),
        Question(
            name="drift",
            calls=runs,
            returns=Number(),
            properties=(
                holds("is small", lambda value, *_: abs(value), 1e-4, 0.25),
                holds(
                    "is of order 4: steps^4 times it stays bounded", lambda value, *given: given[-1] ** 4 * abs(value), 10.0, 0.25
                ),
                holds("is that of the classical method", off_drift, 1e-5, 1.5),
            ),
            mistakes=(
                Mistake("sign", "The end less the start.", lambda *given: -change(*given), within=1e-4),
                Mistake(
                    "Euler's method",
                    "Does the drift fall by 16 when the steps are halved? An order of 4 takes four slopes a step.",
                    lambda *given: change(*given, euler=True),
                ),
                Mistake(
                    "H at the end alone",
                    "A drift is a difference: what was H at the start?",
                    lambda *given: energy(*integrated(*given), *given[2:-1]),
                    within=1e-9,
                ),
            ),
            hint="Four slopes a step: at the start, twice in the middle, at the end; weights 1, 2, 2, 1 over 6.",
        ),
    ),
)
