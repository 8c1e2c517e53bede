"""Checks of the exercise "Two joints"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds, jacobian_of, symmetric
from rodlab.grading.values import Array, Number


def gradient(phi, lam):
    return np.array([2 * phi[0] - phi[1], phi[1] - phi[0]]) - lam * np.sin(phi)


def second(phi, lam, *, corner=1.0, load=1.0):
    return np.array([[2.0, -1.0], [-1.0, corner]]) - load * lam * np.diag(np.cos(phi))


def straight(lam):
    return second(np.zeros(2), lam)


LOADS = np.linalg.eigvalsh(straight(0.0))  # the second derivative is that at no load, less lam times the identity
MODES = np.linalg.eigh(straight(0.0))[1].T


def off_null(rows):
    """How far each row is from being mapped to zero at its load."""
    return max(np.linalg.norm(straight(lam) @ row) / np.linalg.norm(row) for lam, row in zip(LOADS, rows, strict=True))


def angles(draw):
    for _ in range(4):
        yield draw.uniform(-3, 3, size=2), draw.uniform(0.5, 4)


def nothing(draw):
    yield ()


def loads(draw):
    low, high = LOADS
    for between in ((-1.0, low), (low, high), (high, 6.0)):
        yield (draw.uniform(between[0] + 0.05, between[1] - 0.05),)


def stable_above(lam):
    return 2 - int(np.sum(lam > LOADS))


exercise = Exercise(
    title="Two joints",
    source="N 2.7",
    questions=(
        Question(
            name="hessian",
            calls=angles,
            returns=Array((2, 2)),
            properties=(symmetric(points=0.5), jacobian_of(gradient, 1e-12, points=1.5)),
            mistakes=(
                Mistake(
                    "missing end joint",
                    "How many springs act on the last link? Its diagonal entry is not that of an inner one.",
                    lambda phi, lam: second(phi, lam, corner=2.0),
                ),
                Mistake(
                    "sign of the load",
                    "Differentiate the cosine twice: does a load that presses down make the strut stiffer or softer?",
                    lambda phi, lam: second(phi, lam, load=-1.0),
                ),
                Mistake(
                    "sine for cosine",
                    "The load's part of the second derivative is that of the first, differentiated once more.",
                    lambda phi, lam: second(np.pi / 2 - phi, lam),
                ),
            ),
            hint="Differentiate the energy twice; the springs give a constant matrix, the load a diagonal one.",
        ),
        Question(
            name="branch_points",
            calls=nothing,
            returns=Array((2,)),
            properties=(
                holds(
                    "makes the second derivative singular",
                    lambda found: max(abs(np.linalg.det(straight(lam))) for lam in found) + (abs(found[0] - found[1]) < 1e-3),
                    1e-10,
                ),
                holds("is ascending", lambda found: float(not found[0] < found[1]), 0.0, 0.5),
            ),
            mistakes=(
                Mistake(
                    "missing end joint",
                    "These are the loads of a strut whose last link is held by two springs.",
                    lambda: np.array([1.0, 3.0]),
                ),
                Mistake(
                    "sign",
                    "A strut that is pulled does not buckle.",
                    when=lambda given: np.allclose(np.sort(np.array(given[0][1])), -LOADS[::-1], rtol=1e-6),
                ),
                Mistake("descending", "The smaller load comes first.", lambda: LOADS[::-1]),
            ),
            hint="On the straight strut all cosines are 1: the determinant is a quadratic in lam.",
        ),
        Question(
            name="modes",
            calls=nothing,
            returns=Array((2, 2)),
            properties=(holds("is in the null space", off_null, 1e-9, 1.0),),
            mistakes=(
                Mistake(
                    "transposed",
                    "One mode a row: yours stand in columns.",
                    when=lambda given: off_null(np.array(given[0][1]).T) < 1e-6,
                ),
                Mistake(
                    "in the order of the other load",
                    "Which mode belongs to which load? In the first both joints bend the same way.",
                    when=lambda given: off_null(np.array(given[0][1])[::-1]) < 1e-6,
                ),
            ),
            hint="Put each load into the second derivative and solve for a vector that it maps to zero; one component is free.",
        ),
        Question(
            name="index",
            calls=loads,
            returns=Number(whole=True),
            properties=(equals(lambda lam: np.sum(lam > LOADS), 0.0, says="counts the negative eigenvalues", points=1.5),),
            mistakes=(
                Mistake("positive eigenvalues counted", "Which eigenvalues make an equilibrium unstable?", stable_above),
                Mistake(
                    "sign of the determinant",
                    "Two negative eigenvalues have a positive product: a determinant cannot count them.",
                    lambda lam: np.sum(lam > LOADS) % 2,
                ),
            ),
            hint="Count the eigenvalues below zero of your second derivative at phi = 0, or the branch points below lam.",
        ),
    ),
)
