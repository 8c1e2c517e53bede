r"""# The tangent predictor

Let $f(z; \lambda) = 0$ be $n$ equations for $n$ unknowns with a known solution $(z^0, \lambda^0)$ at which the Jacobian $J = f_z$ is
nonsingular. On the branch through it $z = z^0 + (\lambda - \lambda^0) z^1 + O((\lambda - \lambda^0)^2)$, where [N 2.7, "Parameter Continuation Method"]

$$J^0 z^1 = - f_\lambda^0 .$$

The first two terms are the guess from which Newton's method sets out at the load $\lambda$. For one joint, $f = \phi - \beta - \lambda \sin\phi$
(angles in radians), all of this is a formula.

**Write**

1. `slope(phi, lam)`, the derivative $d\phi/d\lambda$ along the branch of one joint at the equilibrium $(\phi, \lambda)$, a number;
2. `tangent(J, f_lam, z, lam)`, where the functions `J(z, lam)` and `f_lam(z, lam)` return arrays of shapes $(n, n)$ and $(n,)$: the vector
   $z^1$ at the solution $(z, \lambda)$, shape $(n,)$;
3. `predict(J, f_lam, z, lam, target)`, the guess for the load `target` from the solution $(z, \lambda)$, shape $(n,)$.
"""

# %% answer
import numpy as np


def slope(phi, lam):
    """d phi/d lam of one joint."""
    ### BEGIN SOLUTION
    return np.sin(phi) / (1 - lam * np.cos(phi))
    ### END SOLUTION


def tangent(J, f_lam, z, lam):
    """dz/dlam along the branch."""
    ### BEGIN SOLUTION
    return np.linalg.solve(J(z, lam), -f_lam(z, lam))
    ### END SOLUTION


def predict(J, f_lam, z, lam, target):
    """The first guess at the load target."""
    ### BEGIN SOLUTION
    return z + (target - lam) * tangent(J, f_lam, z, lam)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds, observed_order
from rodlab.grading.values import Array, Number

STEP = 1e-30


def angle(lam, beta, guess):
    """Newton's method, at complex loads too."""
    phi = guess
    for _ in range(60):
        phi = phi - (phi - beta - lam * np.sin(phi)) / (1 - lam * np.cos(phi))
    return phi


def joints(draw):
    for between in ((0.3, 1.2), (-1.2, -0.3), (1.9, 2.8)):
        phi = draw.uniform(*between)
        yield phi, (phi - np.sign(phi) * draw.uniform(0.05, 0.2)) / np.sin(phi)


def along(phi, lam):
    """The derivative of the equilibrium with respect to the load, by a complex step in the load."""
    return np.imag(angle(lam + 1j * STEP, phi - lam * np.sin(phi), phi)) / STEP


def system(draw):
    """Equations of two links with an unsymmetric Jacobian, as codes: f, J, f_lam."""
    a, b, c = draw.uniform(0.3, 0.6), draw.uniform(0.2, 0.4), draw.uniform(0.6, 0.9)
    f = f"lambda z, lam: np.array([2*z[0] - z[1] - lam*np.sin(z[0]) - {b!r}, z[1] - {c!r}*z[0] - {a!r}*lam*np.sin(z[1] - z[0]) - {b!r}])"
    J = (
        "lambda z, lam: np.array([[2 - lam*np.cos(z[0]), -1],"
        f" [-{c!r} + {a!r}*lam*np.cos(z[1] - z[0]), 1 - {a!r}*lam*np.cos(z[1] - z[0])]])"
    )
    f_lam = f"lambda z, lam: np.array([-np.sin(z[0]), -{a!r}*np.sin(z[1] - z[0])])"
    return Code(f), Code(J), Code(f_lam)


def settled(f, J, z, lam):
    for _ in range(60):
        z = z - np.linalg.solve(J(z, lam), f(z, lam))
    return z


def solution(draw):
    """Arguments J, f_lam, z, lam at a solution; f stays here, as an attribute of J."""
    f, J, f_lam = system(draw)
    J.f, lam = f, draw.uniform(0.2, 0.35)
    return J, f_lam, settled(f, J, np.zeros(2), lam), lam


def starts(draw):
    for _ in range(3):
        yield solution(draw)


def differences(J, f_lam, z, lam):
    """dz/dlam by a complex step in the load."""
    return np.imag(settled(J.f, J, z.astype(complex), lam + 1j * STEP)) / STEP


def targets(draw):
    J, f_lam, z, lam = solution(draw)
    for step in (0.08, 0.04, 0.02, 0.01):
        yield J, f_lam, z, lam, lam + step


def size(found, J, f_lam, z, lam, target):
    return target - lam


def error(found, J, f_lam, z, lam, target):
    return np.max(np.abs(found - settled(J.f, J, z, target)))


def off_line(found, J, f_lam, z, lam, target):
    true = z + (target - lam) * differences(J, f_lam, z, lam)
    return np.max(np.abs(found - true))


exercise = Exercise(
    title="The tangent predictor",
    source="N 2.7",
    questions=(
        Question(
            name="slope",
            calls=joints,
            returns=Number(),
            properties=(equals(along, 1e-8, says="is the derivative of the equilibrium (complex step in the load)"),),
            mistakes=(
                Mistake("sign", "Under more load, does a stable strut lean more or less?", lambda phi, lam: -along(phi, lam)),
                Mistake(
                    "equilibrium held fixed",
                    "The angle changes with the load: differentiate lam sin(phi) by the product rule.",
                    lambda phi, lam: np.sin(phi),
                ),
                Mistake(
                    "derivative of the load",
                    "Which of the two is the function here, and which the variable?",
                    lambda phi, lam: 1 / along(phi, lam),
                ),
            ),
            hint="Differentiate f(phi(lam); lam) = 0 with respect to lam.",
        ),
        Question(
            name="tangent",
            calls=starts,
            returns=Array((2,)),
            properties=(equals(differences, 1e-8, says="is the derivative of the solution (complex step in the load)"),),
            mistakes=(
                Mistake(
                    "sign",
                    "To first order in the load f must not change along the branch. Is f_lam + J z^1 zero for yours?",
                    lambda *given: -differences(*given),
                ),
                Mistake(
                    "transposed Jacobian",
                    "J_ij is the derivative of equation i with respect to unknown j, and it is not symmetric here.",
                    lambda J, f_lam, z, lam: np.linalg.solve(J(z, lam).T, -f_lam(z, lam)),
                ),
                Mistake(
                    "multiplied instead of solved",
                    "A linear system is solved by the inverse matrix: insert your vector into it.",
                    lambda J, f_lam, z, lam: -J(z, lam) @ f_lam(z, lam),
                ),
            ),
            hint="One linear solve.",
        ),
        Question(
            name="predict",
            calls=targets,
            returns=Array((2,)),
            properties=(
                observed_order("has an error of second order in the change of load", size, error, 2.0, 0.2),
                holds("is on the tangent", off_line, 1e-9),
            ),
            mistakes=(
                Mistake(
                    "old solution",
                    "Your guess does not change with the load: its error is of first order.",
                    lambda J, f_lam, z, lam, target: z,
                ),
                Mistake(
                    "load for its change",
                    "The tangent is multiplied by the change of the load. At target = lam the guess has to be z.",
                    lambda J, f_lam, z, lam, target: z + target * differences(J, f_lam, z, lam),
                ),
                Mistake(
                    "a step of length one",
                    "How far is it to the target? Your guess is the same for every target.",
                    lambda J, f_lam, z, lam, target: z + differences(J, f_lam, z, lam),
                ),
            ),
            hint="A point and a direction give a straight line; how far along it is the target?",
        ),
    ),
)

# %% proofs
PROOFS = {
    "slope: sign": ("return np.sin(phi)", "return -np.sin(phi)"),
    "slope: equilibrium held fixed": ("np.sin(phi) / (1 - lam * np.cos(phi))", "np.sin(phi)"),
    "slope: derivative of the load": (
        "np.sin(phi) / (1 - lam * np.cos(phi))",
        "(1 - lam * np.cos(phi)) / np.sin(phi)",
    ),
    "tangent: sign": ("-f_lam(z, lam)", "f_lam(z, lam)"),
    "tangent: transposed Jacobian": ("solve(J(z, lam), ", "solve(J(z, lam).T, "),
    "tangent: multiplied instead of solved": ("np.linalg.solve(J(z, lam), -f_lam(z, lam))", "-J(z, lam) @ f_lam(z, lam)"),
    "predict: old solution": ("z + (target - lam) *", "z + 0 *"),
    "predict: load for its change": ("(target - lam)", "target"),
    "predict: a step of length one": ("(target - lam)", "1"),
}
