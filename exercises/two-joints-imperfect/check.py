"""Checks of the exercise "Two imperfect joints"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import complex_step, equals, holds
from rodlab.grading.values import Array, Number

SPRING = np.array([[2.0, -1.0], [-1.0, 1.0]])
LOADS, VECTORS = np.linalg.eigh(SPRING)


def V(phi, lam, beta):
    return (phi[0] - beta[0]) ** 2 / 2 + (phi[1] - phi[0] - beta[1]) ** 2 / 2 + lam * np.sum(np.cos(phi))


def force(beta):
    return -complex_step(V, np.zeros(2), 0.0, beta)


def component(beta, j, mode=None):
    mode = VECTORS[:, j - 1] / VECTORS[1, j - 1] if mode is None else mode
    return mode @ force(beta)


def ratio(j):
    return -component([0.0, 1.0], j) / component([1.0, 0.0], j)


def solved(beta, lam, steps=300, load=1.0):
    """By the map phi -> spring^-1 (force + lam sin phi), which contracts below lam_1; polished by one Newton step."""
    phi = np.cumsum(beta)
    for _ in range(steps):
        phi = np.linalg.solve(SPRING, force(beta) + load * lam * np.sin(phi))
    left = complex_step(V, phi, load * lam, beta)
    return phi - np.linalg.solve(SPRING - load * lam * np.diag(np.cos(phi)), left)


def rests(draw):
    for j in (1, 2, 1, 2):
        yield draw.choice([-1, 1], size=2) * draw.uniform(0.1, 0.5, size=2), j


def numbers(draw):
    yield from ((1,), (2,))


def loads(draw):
    for between in ((0.05, 0.1), (0.2, 0.3), (0.33, 0.37)):
        yield draw.choice([-1, 1], size=2) * draw.uniform(0.2, 0.5, size=2), draw.uniform(*between)


def once(beta, lam):
    phi = np.cumsum(beta)
    return phi - np.linalg.solve(SPRING - lam * np.diag(np.cos(phi)), complex_step(V, phi, lam, beta))


exercise = Exercise(
    title="Two imperfect joints",
    source="N 2.7",
    questions=(
        Question(
            name="reduced",
            calls=rests,
            returns=Number(),
            properties=(equals(component, 1e-10, says="is the force (complex step of V) along the null vector"),),
            mistakes=(
                Mistake("sign", "A force is minus the gradient of the energy.", lambda beta, j: -component(beta, j)),
                Mistake(
                    "upper spring forgotten",
                    "The spring of the second joint acts on both links: in which terms of V does beta_2 meet phi_1?",
                    lambda beta, j: VECTORS[:, j - 1] @ beta / VECTORS[1, j - 1],
                ),
                Mistake(
                    "null vector of length one",
                    "How is the null vector scaled here? Look at its second component.",
                    when=lambda given: all(  # whatever sign the vector has
                        abs(abs(b / component(*a)) - abs(VECTORS[1, a[1] - 1])) < 1e-6 for a, b in given
                    ),
                ),
                Mistake(
                    "null vector with its components interchanged",
                    "Multiply your null vector by the second derivative of V at phi = 0: is it zero?",
                    lambda beta, j: component(beta, j, mode=np.array([1.0, 1 - LOADS[j - 1]])),
                ),
            ),
            hint="At phi = 0 the load has no moment: differentiate the two springs' energy only, then take the scalar product.",
        ),
        Question(
            name="ineffective",
            calls=numbers,
            returns=Number(),
            properties=(holds("exerts no force along the null vector", lambda found, j: abs(component([found, 1.0], j)), 1e-8),),
            mistakes=(
                Mistake("sign of the ratio", "Insert your ratio into reduced: is it zero?", lambda j: -ratio(j)),
                Mistake("ratio upside down", "Which of the two rest angles is divided by the other?", lambda j: 1 / ratio(j)),
                Mistake("the other load", "Which of the two null vectors belongs to lam_1?", lambda j: ratio(3 - j)),
            ),
            hint="b_j is linear in beta_1 and beta_2: set it to zero and divide.",
        ),
        Question(
            name="equilibrium",
            calls=loads,
            returns=Array((2,)),
            properties=(
                holds(
                    "balances the moments (gradient by complex step)",
                    lambda phi, beta, lam: np.max(np.abs(complex_step(V, phi, lam, beta))),
                    1e-9,
                ),
                equals(solved, 1e-7, says="is where a contraction converges to"),
            ),
            mistakes=(
                Mistake("unloaded shape", "Your strut does not feel the load.", lambda beta, lam: np.cumsum(beta), within=1e-3),
                Mistake(
                    "linearised",
                    "Solving with phi for sin(phi) is the first step only, and wrong by the cube of the angles.",
                    lambda beta, lam: np.linalg.solve(SPRING - lam * np.eye(2), force(beta)),
                ),
                Mistake("one step of Newton's method", "How large is the gradient after your last step?", once),
                Mistake(
                    "sign of the load",
                    "Does a load that presses down increase the angles or reduce them?",
                    lambda beta, lam: solved(beta, lam, load=-1.0),
                ),
            ),
            hint="Start from the unloaded shape; each step solves the second derivative times the step = minus the gradient.",
        ),
    ),
)
