r"""# A straight rod held as a helix

A uniform rod, straight when unstressed, inextensible, with bending stiffness $K_1 = K_2$ and twisting stiffness $K_3$, is held as a helix of
curvature $\kappa > 0$ and torsion $\tau$ (of either sign), and twisted so that the component of its strain along the tangent $d_3$ is $u_3$ [N 2.5].

Let $(\nu, b, t)$ be the normal, binormal and tangent of the helix. The Darboux vector of this triad is $w = \kappa\, b + \tau\, t$; it is the same at
every point, and points along the axis of the helix. The moment is $m = K_1 \kappa\, b + K_3 u_3\, t$. By balance the force $n$ is constant, and
$m' + t \times n = 0$, where $m' = w \times m$ as the components of $m$ in the triad are constant.

By symmetry the end force and end moment of a helix are a wrench along its axis. **Write**

1. `force(kappa, tau, u3, K1, K3)`: components $(n_\nu, n_b, n_t)$ of the force, shape (3,), with $n$ parallel to the axis;
2. `axial_force(kappa, tau, u3, K1, K3)`: the component of the force along $w/|w|$, a number (for $\tau > 0$, tension is positive);
3. `axial_moment(kappa, tau, u3, K1, K3)`: the component of $m$ along the same unit vector, a number.
"""

# %% answer
import numpy as np


def force(kappa, tau, u3, K1, K3):
    """(n_nu, n_b, n_t), shape (3,)."""
    ### BEGIN SOLUTION
    factor = K3 * u3 - K1 * tau
    return np.array([0.0, factor * kappa, factor * tau])
    ### END SOLUTION


def axial_force(kappa, tau, u3, K1, K3):
    """The force along the axis, a number."""
    ### BEGIN SOLUTION
    return (K3 * u3 - K1 * tau) * np.sqrt(kappa**2 + tau**2)
    ### END SOLUTION


def axial_moment(kappa, tau, u3, K1, K3):
    """The component of the moment along the axis, a number."""
    ### BEGIN SOLUTION
    return (K1 * kappa**2 + K3 * u3 * tau) / np.sqrt(kappa**2 + tau**2)
    ### END SOLUTION


# %% checks
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

# %% proofs
PROOFS = {
    "force: sign": ("factor = K3 * u3 - K1 * tau", "factor = K1 * tau - K3 * u3"),
    "force: bending stiffness forgotten": ("factor = K3 * u3 - K1 * tau", "factor = K3 * u3"),
    "force: torsion for twist": ("factor = K3 * u3 - K1 * tau", "factor = K3 * tau - K1 * tau"),
    "force: components interchanged": ("[0.0, factor * kappa, factor * tau]", "[0.0, factor * tau, factor * kappa]"),
    "axial_force: sign of the axial force": ("return (K3 * u3 - K1 * tau) * np", "return (K1 * tau - K3 * u3) * np"),
    "axial_force: size for component": ("return (K3 * u3 - K1 * tau) * np", "return abs(K3 * u3 - K1 * tau) * np"),
    "axial_force: the tangential component": ("(K3 * u3 - K1 * tau) * np.sqrt(kappa**2 + tau**2)", "(K3 * u3 - K1 * tau) * tau"),
    "axial_force: not of unit length": ("- K1 * tau) * np.sqrt(kappa**2 + tau**2)", "- K1 * tau) * (kappa**2 + tau**2)"),
    "axial_moment: length of the axis forgotten": ("u3 * tau) / np.sqrt(kappa**2 + tau**2)", "u3 * tau)"),
    "axial_moment: the length of the moment": (
        "(K1 * kappa**2 + K3 * u3 * tau) / np.sqrt(kappa**2 + tau**2)",
        "np.hypot(K1 * kappa, K3 * u3)",
    ),
    "axial_moment: torsion for twist in the moment": ("K3 * u3 * tau)", "K3 * tau * tau)"),
}
