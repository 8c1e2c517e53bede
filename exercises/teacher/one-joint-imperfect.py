r"""# One imperfect joint

A link of length 1 stands on a spring of stiffness 1 whose rest angle is $\beta \neq 0$, a small imperfection. Under the load $\lambda$ it
is in equilibrium at the angle $\phi$ (radians) if [N 2.7, n = 1]

$$f(\phi; \lambda) = \phi - \beta - \lambda \sin\phi = 0 .$$

The pitchfork of the perfect strut is broken: one branch leads smoothly from the unstressed state to large angles, to the side of $\beta$,
and the other states lie on a detached branch that exists only beyond a fold, where also $\partial f/\partial\phi = 0$.

**Write**

1. `angle(lam, beta)`, for $0 \le \lambda$ and $0 < |\beta| < 1$ the equilibrium on the branch of the unstressed state, a number of the sign of
   $\beta$ between $|\beta|$ and $\pi$ in size;
2. `fold(beta)`, the fold with $|\phi| < \pi/2$, for $\beta$ of either sign: its angle and its load, two numbers `phi, lam`;
3. `leading(beta)`, for $0 < \beta \ll 1$ the leading term of the angle at $\lambda = 1$, and the load of the fold in the form $1 + c \beta^p$
   (without higher terms): their values at the given $\beta$, two numbers.
"""

# %% answer
import numpy as np
from scipy.optimize import brentq


def angle(lam, beta):
    """The equilibrium angle at lam on the branch that starts at phi = beta without load."""
    ### BEGIN SOLUTION
    size = abs(beta)
    return np.sign(beta) * brentq(lambda phi: phi - size - lam * np.sin(phi), size, np.pi, xtol=1e-14)
    ### END SOLUTION


def fold(beta):
    """phi and lam of the fold of the detached branch."""
    ### BEGIN SOLUTION
    size = abs(beta)
    phi = brentq(lambda phi: np.tan(phi) - phi - size, 0, np.arctan(size + np.pi / 2), xtol=1e-14)
    return -np.sign(beta) * phi, 1 / np.cos(phi)
    ### END SOLUTION


def leading(beta):
    """Leading terms: the angle at lam = 1, and the load of the fold."""
    ### BEGIN SOLUTION
    return (6 * beta) ** (1 / 3), 1 + (3 * beta) ** (2 / 3) / 2
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds, observed_order
from rodlab.grading.values import Number, Parts


def f(phi, lam, beta):
    return phi - beta - lam * np.sin(phi)


def bisected(function, low, high):
    """The only root of a function that rises from below zero at low to above it at high."""
    for _ in range(70):
        middle = (low + high) / 2
        low, high = (low, middle) if function(middle) > 0 else (middle, high)
    return (low + high) / 2


def state(lam, beta, low=None):
    size = abs(beta)
    return np.sign(beta) * bisected(lambda phi: f(phi, lam, size), size if low is None else low, np.pi)


def far(beta):
    """The fold as the least load on the detached branch: there d lam/d phi = 0 for lam = (phi - beta)/sin(phi)."""
    side, size = -np.sign(beta), abs(beta)
    phi = bisected(lambda phi: np.sin(phi) - (phi + size) * np.cos(phi), 0.0, np.pi / 2)
    return side * phi, (phi + size) / np.sin(phi)


def states(draw):
    for loads, betas in (((0.2, 0.8), (0.1, 0.3)), ((0.95, 1.05), (0.001, 0.01)), ((1.5, 6.0), (0.1, 0.5))):
        yield draw.uniform(*loads), draw.choice([-1, 1]) * draw.uniform(*betas)


def rests(draw):
    for side in (1, -1, 1):
        yield (side * draw.uniform(0.01, 0.5),)


def tiny(draw):
    for size in (1e-4, 1e-5, 1e-6, 1e-7):
        yield (draw.uniform(1.0, 1.5) * size,)


def at_one(found, beta):
    return abs(found[0] - state(1.0, beta))


exercise = Exercise(
    title="One imperfect joint",
    source="N 2.7",
    imports=("numpy", "scipy.optimize"),
    questions=(
        Question(
            name="angle",
            calls=states,
            returns=Number(),
            properties=(
                holds("is an equilibrium", lambda phi, lam, beta: abs(f(phi, lam, beta)) / abs(beta), 1e-6),
                equals(state, 1e-6, says="is on the branch of the unstressed state (bisection)"),
            ),
            mistakes=(
                Mistake(
                    "linearised",
                    "At which loads does your angle become infinite, or change its side? Solve the equation with the sine.",
                    lambda lam, beta: beta / (1 - lam),
                ),
                Mistake(
                    "sign of the load",
                    "Does a load that presses down increase the lean?",
                    lambda lam, beta: state(-lam, beta, 0.0),
                ),
            ),
            hint="For positive beta the function f is negative at beta and positive at pi, with one root between them.",
        ),
        Question(
            name="fold",
            calls=rests,
            returns=Parts(Number(), Number()),
            properties=(
                holds("is an equilibrium", lambda found, beta: abs(f(*found, beta)), 1e-8),
                holds(
                    "has a singular second derivative",
                    lambda found, beta: abs(1 - found[1] * np.cos(found[0])) + (found[0] == 0),
                    1e-8,
                ),
                holds(
                    "is the fold of the detached branch",
                    lambda found, beta: float(np.max(np.abs(np.subtract(found, far(beta))))),
                    1e-7,
                ),
            ),
            mistakes=(
                Mistake(
                    "side of the imperfection",
                    "On which side does the detached branch lie? Insert your angle and load into f.",
                    lambda beta: (-far(beta)[0], far(beta)[1]),
                ),
                Mistake(
                    "load of the perfect strut",
                    "Your load holds a strut with beta = 0 at this angle; insert it into both equations.",
                    lambda beta: (far(beta)[0], far(beta)[0] / np.sin(far(beta)[0])),
                ),
                Mistake(
                    "cosine for its inverse",
                    "Is the load of the fold above or below that of the perfect pitchfork?",
                    lambda beta: (far(beta)[0], np.cos(far(beta)[0])),
                ),
            ),
            hint="Two equations, f = 0 and df/dphi = 0: eliminate the load and one equation for the angle is left.",
        ),
        Question(
            name="leading",
            calls=tiny,
            returns=Parts(Number(), Number()),
            properties=(
                observed_order("leaves an error of order beta in the angle", lambda _, beta: beta, at_one, 1.0),
                equals(
                    lambda beta: (6 ** (1 / 3) * np.cbrt(beta), 1 + 0.5 * 3 ** (2 / 3) * np.cbrt(beta) ** 2),
                    1e-9,
                    says="has the leading terms",
                ),
            ),
            mistakes=(
                Mistake(
                    "square root",
                    "What is the first power of phi that is left in phi - sin(phi)?",
                    lambda beta: (np.sqrt(6 * beta), 1 + (3 * beta) ** (2 / 3) / 2),
                ),
                Mistake(
                    "sine's cubic for the tangent's",
                    "The angle of the fold solves phi - tan(phi) = beta: what is the first term of that difference?",
                    lambda beta: ((6 * beta) ** (1 / 3), 1 + (6 * beta) ** (2 / 3) / 2),
                ),
            ),
            hint="Expand sine, tangent and cosine at small angles and keep the first term that does not cancel.",
        ),
    ),
)

# %% proofs
ROOT = "np.sign(beta) * brentq(lambda phi: phi - size - lam * np.sin(phi), size, np.pi, xtol=1e-14)"
PROOFS = {
    "angle: linearised": (ROOT, "beta / (1 - lam)"),
    "angle: sign of the load": (ROOT, "np.sign(beta) * brentq(lambda phi: phi - size + lam * np.sin(phi), 0, np.pi, xtol=1e-14)"),
    "fold: side of the imperfection": ("-np.sign(beta) * phi, ", "np.sign(beta) * phi, "),
    "fold: load of the perfect strut": ("phi, 1 / np.cos(phi)", "phi, phi / np.sin(phi)"),
    "fold: cosine for its inverse": ("phi, 1 / np.cos(phi)", "phi, np.cos(phi)"),
    "leading: square root": ("(6 * beta) ** (1 / 3)", "(6 * beta) ** (1 / 2)"),
    "leading: sine's cubic for the tangent's": ("(3 * beta) ** (2 / 3) / 2", "(6 * beta) ** (2 / 3) / 2"),
}
