r"""# The Hamiltonian of a planar rod

The uniform planar rod [N 2.6] under a force $(N_1, N_3)$ obeys

$$\phi' = \hat u + m/K, \qquad m' = N_3 \sin\phi - N_1 \cos\phi, \qquad N_1' = N_3' = 0 .$$

Here $s \in [0, 1]$ is arclength, $\phi$ the angle from the vertical (radians), $m$ the moment, $K$ the bending stiffness and $\hat u$ the
curvature when unstressed. Where $K$ and $\hat u$ do not depend on $s$, there is a function $H(\phi, m; N_1, N_3)$ with
$\phi' = \partial H/\partial m$ and $m' = -\partial H/\partial\phi$. It is constant along every solution, and a check of any computed one.

**Write**

1. `H(phi, m, N1, N3, K, u_hat)`, the value of this function, a number; choose the constant so that $H = N_3$ at $\phi = m = 0$;
2. `field(phi, m, N1, N3, K, u_hat)`, the right-hand sides $(\phi', m')$, an array of shape (2,);
3. `drift(phi, m, N1, N3, K, u_hat, steps)`: from the given values at $s = 0$ integrate to $s = 1$ by so many equal steps of the classical
   Runge-Kutta method of order 4, and return the number $H$ at the end less $H$ at the start.
"""

# %% answer
import numpy as np


def H(phi, m, N1, N3, K, u_hat):
    """The Hamiltonian, a number."""
    ### BEGIN SOLUTION
    return m**2 / (2 * K) + u_hat * m + N3 * np.cos(phi) + N1 * np.sin(phi)
    ### END SOLUTION


def field(phi, m, N1, N3, K, u_hat):
    """(phi', m'), an array of shape (2,)."""
    ### BEGIN SOLUTION
    return np.array([u_hat + m / K, N3 * np.sin(phi) - N1 * np.cos(phi)])
    ### END SOLUTION


def drift(phi, m, N1, N3, K, u_hat, steps):
    """H at s = 1 less H at s = 0 along steps of the classical Runge-Kutta method, a number."""
    ### BEGIN SOLUTION
    step, state = 1.0 / steps, np.array([phi, m])
    for _ in range(steps):
        a = field(*state, N1, N3, K, u_hat)
        b = field(*(state + step * a / 2), N1, N3, K, u_hat)
        c = field(*(state + step * b / 2), N1, N3, K, u_hat)
        d = field(*(state + step * c), N1, N3, K, u_hat)
        state = state + step * (a + 2 * b + 2 * c + d) / 6
    return H(*state, N1, N3, K, u_hat) - H(phi, m, N1, N3, K, u_hat)
    ### END SOLUTION


# %% checks
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

# %% proofs
PROOFS = {
    "H: unstressed curvature forgotten": ("+ u_hat * m + N3", "+ N3"),
    "H: factor one half": ("m**2 / (2 * K)", "m**2 / K"),
    "H: sign of the force along e_3": ("u_hat * m + N3", "u_hat * m - N3"),
    "H: sign of the force along e_1": ("cos(phi) + N1", "cos(phi) - N1"),
    "H: the energy density": ("+ u_hat * m + N3 * np.cos(phi) + N1", "- N3 * np.cos(phi) - N1"),
    "field: sign of the moment's equation": ("N3 * np.sin(phi) - N1 * np.cos(phi)]", "-N3 * np.sin(phi) + N1 * np.cos(phi)]"),
    "field: sine and cosine interchanged": ("N3 * np.sin(phi) - N1 * np.cos(phi)]", "N3 * np.cos(phi) - N1 * np.sin(phi)]"),
    "drift: sign": (
        "H(*state, N1, N3, K, u_hat) - H(phi, m, N1, N3, K, u_hat)",
        "H(phi, m, N1, N3, K, u_hat) - H(*state, N1, N3, K, u_hat)",
    ),
    "drift: Euler's method": ("step * (a + 2 * b + 2 * c + d) / 6", "step * a"),
    "drift: H at the end alone": ("H(*state, N1, N3, K, u_hat) - H(phi, m, N1, N3, K, u_hat)", "H(*state, N1, N3, K, u_hat)"),
}
