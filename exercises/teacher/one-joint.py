r"""# One joint

The strut of one joint [N 2.7, n = 1] is a stiff link of length 1 on a spring of stiffness 1, pressed down by the load $\lambda$. Its
angle $\phi$ from the vertical is in radians, the spring is at rest at the angle $\beta$, and the energy is

$$V(\phi; \lambda) = \tfrac12 (\phi - \beta)^2 + \lambda \cos\phi .$$

Each equilibrium can be found on paper if one asks for the load at a given angle rather than for the angle at a given load.

**Write**

1. `load(phi, beta)`, the load at which the angle $\phi$ (no multiple of $\pi$) is an equilibrium, a number;
2. `hessian(phi, beta)`, the second derivative $V''$ with respect to $\phi$ at the angle $\phi$ under the load `load(phi, beta)`, a number:
   the equilibrium is stable where it is positive;
3. `coefficients()`, the numbers $a$ and $b$ in $\lambda = 1 + a \phi^2 + b \phi^4 + O(\phi^6)$ on the buckled branch of $\beta = 0$, an
   array of shape (2,);
4. `buckled(lam)`, for $\beta = 0$ and $\lambda > 1$ the angle of the buckled equilibrium between $0$ and $\pi$, a number correct to at
   least eight digits.
"""

# %% answer
import numpy as np
from scipy.optimize import brentq


def load(phi, beta):
    """The load at which phi (radians) is an equilibrium."""
    ### BEGIN SOLUTION
    return (phi - beta) / np.sin(phi)
    ### END SOLUTION


def hessian(phi, beta):
    """The second derivative of V at this equilibrium."""
    ### BEGIN SOLUTION
    lam = load(phi, beta)
    return 1 - lam * np.cos(phi)
    ### END SOLUTION


def coefficients():
    """a and b in lam = 1 + a phi^2 + b phi^4 + ..."""
    ### BEGIN SOLUTION
    second = 1 / 6
    fourth = second**2 - 1 / 120  # (1 - x/6 + x^2/120)^(-1), x = phi^2
    return [second, fourth]
    ### END SOLUTION


def buckled(lam):
    """The angle between 0 and pi that is an equilibrium at lam > 1 when beta = 0."""
    ### BEGIN SOLUTION
    low, high = np.arccos(1 / lam), np.pi  # phi - lam sin(phi) is least at low
    return brentq(lambda phi: phi - lam * np.sin(phi), low, high, xtol=1e-14)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import STEP, equals, holds
from rodlab.grading.values import Array, Number


def moment(phi, lam, beta):
    return phi - beta - lam * np.sin(phi)


def balanced(phi, beta):
    """The load at which the moments balance: they are linear in it."""
    unloaded, unit = moment(phi, 0.0, beta), moment(phi, 1.0, beta)
    return unloaded / (unloaded - unit)


def second(phi, beta):
    return np.imag(moment(phi + 1j * STEP, balanced(phi, beta), beta)) / STEP


def angle(lam):
    """By bisection: the load of an angle grows from 1 to infinity between 0 and pi."""
    low, high = 0.0, np.pi
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if balanced(middle, 0.0) > lam else (middle, high)
    return (low + high) / 2


def angles(draw):
    for between in ((0.3, 1.2), (-1.2, -0.3), (1.9, 2.8), (3.6, 5.0)):
        yield draw.uniform(*between), draw.choice([-1, 1]) * draw.uniform(0.05, 0.2)


def nothing(draw):
    yield ()


def loads(draw):
    for between in ((1.001, 1.01), (1.2, 2.0), (3.0, 20.0)):
        yield (draw.uniform(*between),)


exercise = Exercise(
    title="One joint",
    source="N 2.7",
    imports=("numpy", "scipy.optimize"),
    questions=(
        Question(
            name="load",
            calls=angles,
            returns=Number(),
            properties=(holds("balances the moments", lambda lam, phi, beta: abs(moment(phi, lam, beta)), 1e-10),),
            mistakes=(
                Mistake("rest angle forgotten", "At which angle is the spring at rest?", lambda phi, beta: phi / np.sin(phi)),
                Mistake(
                    "sign of the load",
                    "For a small beta, is a leaning strut held by a load that presses or by one that pulls?",
                    lambda phi, beta: -balanced(phi, beta),
                ),
            ),
            hint="Set the derivative of V to zero; it is linear in lam.",
        ),
        Question(
            name="hessian",
            calls=angles,
            returns=Number(),
            properties=(equals(second, 1e-10, says="is the derivative of the moment at a fixed load (complex step)"),),
            mistakes=(
                Mistake(
                    "load eliminated before differentiating",
                    "The load is held fixed while the angle is varied. Put load(phi, beta) in only after the second derivative is taken.",
                    lambda phi, beta: 0.0,
                    within=1e-4,
                ),
                Mistake(
                    "softening with the wrong sign",
                    "Differentiate lam cos(phi) twice: does pressing make the straight strut stiffer or softer?",
                    lambda phi, beta: 2 - second(phi, beta),
                ),
                Mistake(
                    "load of the perfect strut",
                    "Which load holds the imperfect strut at this angle? Use load with both of its arguments.",
                    lambda phi, beta: 1 - phi / np.tan(phi),
                ),
            ),
            hint="Differentiate V twice at a fixed load, then put in the load of this equilibrium.",
        ),
        Question(
            name="coefficients",
            calls=nothing,
            returns=Array((2,)),
            properties=(
                holds("has the coefficient of phi^2", lambda found: abs(found[0] - (balanced(1e-3, 0.0) - 1) / 1e-6), 1e-6),
                holds(
                    "has the coefficient of phi^4 (what the first leaves)",
                    lambda found: abs(found[1] - ((balanced(0.02, 0.0) - 1) / 4e-4 - 1 / 6) / 4e-4) + 100 * abs(found[0] - 1 / 6),
                    1e-5,
                ),
            ),
            mistakes=(
                Mistake(
                    "inverse series",
                    "Does the load rise along the branch? Compare with load(0.5, 0).",
                    lambda: np.array([-1 / 6, 1 / 120]),
                ),
                Mistake(
                    "product of the first order forgotten",
                    "Inverting a series to fourth order, the square of its second order term contributes too.",
                    lambda: np.array([1 / 6, -1 / 120]),
                ),
            ),
            hint="Insert the Taylor series of the sine to the order phi^5 and divide.",
        ),
        Question(
            name="buckled",
            calls=loads,
            returns=Number(),
            properties=(equals(angle, 1e-7, says="is the angle that bisection finds", points=2.0),),
            mistakes=(
                Mistake(
                    "straight strut",
                    "Zero is an equilibrium at every load. Keep your solver away from it: where does phi - lam sin(phi) turn?",
                    lambda lam: 0.0,
                    within=1e-5,
                ),
                Mistake(
                    "first terms of the series",
                    "The series holds near lam = 1 only. Use its angle as a first guess and solve the equation.",
                    lambda lam: np.sqrt(6 * (lam - 1)),
                ),
            ),
            hint="Enclose the root: phi - lam sin(phi) is negative just above zero and positive at pi.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "load: rest angle forgotten": ("return (phi - beta) / np.sin(phi)", "return phi / np.sin(phi)"),
    "load: sign of the load": ("return (phi - beta) / np.sin(phi)", "return (beta - phi) / np.sin(phi)"),
    "hessian: load eliminated before differentiating": (
        "return 1 - lam * np.cos(phi)",
        "return 1 - lam * np.sin(phi) / (phi - beta)",
    ),
    "hessian: softening with the wrong sign": ("1 - lam * np.cos", "1 + lam * np.cos"),
    "hessian: load of the perfect strut": ("lam = load(phi, beta)", "lam = load(phi, 0)"),
    "coefficients: inverse series": ("[second, fourth]", "[-1 / 6, 1 / 120]"),
    "coefficients: product of the first order forgotten": ("second**2 - 1 / 120", "-1 / 120"),
    "buckled: straight strut": ("brentq(lambda phi: phi - lam * np.sin(phi), low, high, xtol=1e-14)", "0.0"),
    "buckled: first terms of the series": (
        "brentq(lambda phi: phi - lam * np.sin(phi), low, high, xtol=1e-14)",
        "np.sqrt(6 * (lam - 1))",
    ),
}
