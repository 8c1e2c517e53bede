r"""# The gradient of the strut's energy

A strut of $n$ joints [N 2.7] has the energy

$$V(\phi; \lambda) = \sum_{i=1}^n \tfrac12 k_i (\phi_i - \phi_{i-1} - \beta_i)^2 + \lambda h \sum_{i=1}^n \cos\phi_i,
\qquad \phi_0 = \beta_0 = 0 .$$

Link $i$, of length $h$, stands at the angle $\phi_i$ from the vertical (radians); the spring of stiffness $k_i$ at its lower end is at rest
where $\phi_i - \phi_{i-1} = \beta_i$. The first sum is stored in the springs, the second is the load $\lambda$ times the height of its point of
application. An equilibrium is a zero of the gradient: the balance of moments about each joint.

**Write**, for arrays `phi`, `k`, `beta` of the same length $n$,

1. `energy(phi, lam, k, beta, h)`, the energy $V$, a number;
2. `gradient(phi, lam, k, beta, h)`, the derivatives $\partial V/\partial\phi_i$ for $i = 1, \dots, n$, an array of shape $(n,)$.
"""

# %% answer
import numpy as np


def energy(phi, lam, k, beta, h):
    """V at the angles phi_1, ..., phi_n (radians), a number."""
    ### BEGIN SOLUTION
    bend = np.diff(phi, prepend=0.0) - beta
    return np.sum(k * bend**2) / 2 + lam * h * np.sum(np.cos(phi))
    ### END SOLUTION


def gradient(phi, lam, k, beta, h):
    """dV/dphi_i for i = 1, ..., n, an array of shape (n,)."""
    ### BEGIN SOLUTION
    moment = k * (np.diff(phi, prepend=0.0) - beta)
    above = np.append(moment[1:], 0.0)
    return moment - above - lam * h * np.sin(phi)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, gradient_of
from rodlab.grading.values import Array, Number


def calls(draw):
    for n in (1, 2, 7):
        yield draw.normal(size=n), draw.uniform(2, 9), draw.uniform(1, 3, size=n), draw.normal(size=n), draw.uniform(0.1, 0.9)


def V(phi, lam, k, beta, h):
    bend = phi - np.append(0.0, phi[:-1]) - beta
    return np.sum(k * bend**2) / 2 + lam * h * np.sum(np.cos(phi))


def moments(phi, lam, k, beta, h, *, load=1.0, end=0.0):
    moment = k * (phi - np.append(0.0, phi[:-1]) - beta)
    return moment - np.append(moment[1:], end * moment[-1]) - load * lam * h * np.sin(phi)


exercise = Exercise(
    title="The gradient of the strut's energy",
    source="N 2.7",
    questions=(
        Question(
            name="energy",
            calls=calls,
            returns=Number(),
            properties=(equals(V, 1e-12, says="is the energy"),),
            mistakes=(
                Mistake(
                    "rest angles forgotten",
                    "At which difference of angles is a spring at rest? Your energy is lowest elsewhere.",
                    lambda phi, lam, k, beta, h: V(phi, lam, k, 0 * beta, h),
                ),
                Mistake(
                    "factor one half",
                    "What is the energy of a spring whose moment is k times its bend? Integrate.",
                    lambda phi, lam, k, beta, h: 2 * V(phi, 0.0, k, beta, h) + lam * h * np.sum(np.cos(phi)),
                ),
                Mistake(
                    "h forgotten",
                    "A link of length h stands at the angle phi_i: how much higher is its upper end than its lower one?",
                    lambda phi, lam, k, beta, h: V(phi, lam, k, beta, 1.0),
                ),
            ),
            hint="Two sums: what each spring stores, and the load times the height of the strut.",
        ),
        Question(
            name="gradient",
            calls=calls,
            returns=Array(lambda phi, *_: phi.shape),
            properties=(gradient_of(V, 1e-12, points=2.0),),
            mistakes=(
                Mistake(
                    "sign of the load",
                    "The derivative of a cosine: which sign does the load's moment have? At lam = 0 your gradient is right.",
                    lambda *given: moments(*given, load=-1.0),
                ),
                Mistake(
                    "upper spring forgotten",
                    "Angle i occurs in two springs: the one below link i and the one above it.",
                    lambda phi, lam, k, beta, h: k * (phi - np.append(0.0, phi[:-1]) - beta) - lam * h * np.sin(phi),
                ),
                Mistake(
                    "a spring above the last link",
                    "Link n is free at its upper end: how many springs does phi_n occur in? (The natural boundary condition.)",
                    lambda *given: moments(*given, end=1.0),
                ),
                Mistake(
                    "rest angles forgotten",
                    "Is your gradient zero where no spring is stretched and there is no load?",
                    lambda phi, lam, k, beta, h: moments(phi, lam, k, 0 * beta, h),
                ),
                Mistake(
                    "h forgotten",
                    "The load's moment about a joint has an arm: how long is the link?",
                    lambda phi, lam, k, beta, h: moments(phi, lam, k, beta, 1.0),
                ),
            ),
            hint="Each angle occurs in the two springs at the ends of its link and in one cosine; the first and last joint are special.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "energy: rest angles forgotten": ("prepend=0.0) - beta\n    return", "prepend=0.0)\n    return"),
    "energy: factor one half": ("bend**2) / 2", "bend**2)"),
    "energy: h forgotten": ("lam * h * np.sum", "lam * np.sum"),
    "gradient: rest angles forgotten": ("prepend=0.0) - beta)", "prepend=0.0))"),
    "gradient: h forgotten": ("- lam * h * np.sin", "- lam * np.sin"),
    "gradient: sign of the load": ("above - lam * h", "above + lam * h"),
    "gradient: upper spring forgotten": ("moment - above - lam", "moment - lam"),
    "gradient: a spring above the last link": ("(moment[1:], 0.0)", "(moment[1:], moment[-1])"),
}
