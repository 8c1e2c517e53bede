"""Checks of the exercise "A straight rod held as a helix"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number

T = np.array([0.0, 0.0, 1.0])


def vectors(kappa, tau, u3, K1, K3):
    """The axis, the moment and the force in the triad (nu, b, t): the force as that multiple of the axis that balances."""
    w, m = np.array([0.0, kappa, tau]), np.array([0.0, K1 * kappa, K3 * u3])
    n = w * (np.cross(w, m) @ np.cross(w, T)) / (np.cross(w, T) @ np.cross(w, T))
    return w, m, n


def unbalanced(n, kappa, tau, u3, K1, K3):
    w, m, _ = vectors(kappa, tau, u3, K1, K3)
    return np.linalg.norm(np.cross(w, m) + np.cross(T, n)) / np.linalg.norm(np.cross(w, m))


def off_axis(n, kappa, tau, *_):
    w = np.array([0.0, kappa, tau])
    return np.linalg.norm(np.cross(w, n)) / (np.linalg.norm(w) * np.linalg.norm(n))


def along(vector, w):
    return vector @ w / np.linalg.norm(w)


def force_along(*given):
    w, _, n = vectors(*given)
    return along(n, w)


def moment_along(*given):
    w, m, _ = vectors(*given)
    return along(m, w)


def calls(draw):
    """Helices of either hand, twisted in the sense of their torsion (so that no sum cancels); w points along t or against it."""
    for hand in (1, -1, 1, -1):
        kappa, tau, u3 = draw.uniform(0.5, 1.5), hand * draw.uniform(0.5, 1.5), hand * draw.uniform(2.5, 4)
        yield kappa, tau, u3, draw.uniform(1, 1.6), draw.uniform(1.7, 2.5)


exercise = Exercise(
    title="A straight rod held as a helix",
    source="N 2.5",
    questions=(
        Question(
            name="force",
            calls=calls,
            returns=Array((3,)),
            properties=(
                holds("balances the moment", unbalanced, 1e-12, 1.5),
                holds("is parallel to the axis", off_axis, 1e-12, 0.5),
            ),
            mistakes=(
                Mistake(
                    "sign",
                    "Put your force into m' + t x n = 0: do the two terms cancel or add?",
                    lambda *given: -vectors(*given)[2],
                ),
                Mistake(
                    "bending stiffness forgotten",
                    "How does the moment turn as the binormal turns about the tangent? The bending part has a share in the force.",
                    lambda kappa, tau, u3, K1, K3: K3 * u3 * np.array([0, kappa, tau]),
                ),
                Mistake(
                    "torsion for twist",
                    "The strain u3 and the torsion of the centreline are two different numbers: which of them is twisted against K3?",
                    lambda kappa, tau, u3, K1, K3: (K3 - K1) * tau * np.array([0, kappa, tau]),
                ),
                Mistake(
                    "components interchanged",
                    "The order of the components is normal, binormal, tangent.",
                    lambda *given: vectors(*given)[2][[0, 2, 1]],
                ),
            ),
            hint="Compute w x m in the triad; the force is a multiple of w that makes the balance of moments hold.",
        ),
        Question(
            name="axial_force",
            calls=calls,
            returns=Number(),
            properties=(equals(force_along, 1e-12, says="is the force along the axis"),),
            mistakes=(
                Mistake(
                    "sign of the axial force",
                    "Take a right-handed helix: is it positive when the ends are pulled apart?",
                    lambda *given: -force_along(*given),
                ),
                Mistake(
                    "size for component",
                    "A component has a sign. Which way does w point along a left-handed helix, and which way the force?",
                    lambda *given: abs(force_along(*given)),
                ),
                Mistake(
                    "the tangential component",
                    "The tangent of a helix is not its axis.",
                    lambda *given: vectors(*given)[2][2],
                ),
                Mistake(
                    "not of unit length",
                    "Project on a vector of length 1: how long is w?",
                    lambda *given: vectors(*given)[2] @ vectors(*given)[0],
                ),
            ),
            hint="Project the force on the unit vector along w.",
        ),
        Question(
            name="axial_moment",
            calls=calls,
            returns=Number(),
            properties=(equals(moment_along, 1e-12, says="is the moment along the axis"),),
            mistakes=(
                Mistake(
                    "length of the axis forgotten",
                    "Divide by the length of w, not by 1.",
                    lambda *given: vectors(*given)[1] @ vectors(*given)[0],
                ),
                Mistake(
                    "the length of the moment",
                    "A component along an axis is a scalar product.",
                    lambda *given: np.linalg.norm(vectors(*given)[1]),
                ),
                Mistake(
                    "torsion for twist in the moment",
                    "The twisting moment is K3 times the strain u3, whatever the torsion of the centreline is.",
                    lambda kappa, tau, u3, K1, K3: moment_along(kappa, tau, tau, K1, K3),
                ),
            ),
            hint="Project the moment on the unit vector along w.",
        ),
    ),
)
