r"""# Two imperfect joints

A strut of two joints [N 2.7, exercise session] has unit springs with the rest angles $\beta_1, \beta_2$ (radians) and unit links:

$$V(\phi_1, \phi_2; \lambda) = \tfrac12 (\phi_1 - \beta_1)^2 + \tfrac12 (\phi_2 - \phi_1 - \beta_2)^2 + \lambda (\cos\phi_1 + \cos\phi_2) .$$

For $\beta = 0$ the straight strut is singular at $\lambda_j = (3 \mp \sqrt5)/2$, $j = 1, 2$; let $v_j$ be its null vector there, scaled so that
its second component is 1. The *reduced imperfection* is the component along $v_j$ of the force that $\beta$ exerts at $\phi = 0$,

$$b_j = - v_j \cdot \nabla V(0; \lambda) .$$

It alone decides, to leading order, how the pitchfork at $\lambda_j$ is broken. If $b_j = 0$ the imperfection is ineffective there.

**Write**

1. `reduced(beta, j)`, the number $b_j$ for an array `beta` of shape (2,) and $j = 1$ or $2$;
2. `ineffective(j)`, the ratio $\beta_1/\beta_2$ that is ineffective at $\lambda_j$, a number;
3. `equilibrium(beta, lam)` for $0 \le \lambda < \lambda_1$, where the equilibrium is unique: its angles, shape (2,), by Newton's method,
   until the gradient is of the order of rounding.
"""

# %% answer
import numpy as np

LAM = (3 + np.sqrt(5) * np.array([-1, 1])) / 2  # loads at which the straight strut is singular


def reduced(beta, j):
    """The component along v_j = (., 1) of the force that the rest angles exert on the straight strut."""
    ### BEGIN SOLUTION
    mode = np.array([1 - LAM[j - 1], 1.0])
    force = np.array([beta[0] - beta[1], beta[1]])
    return mode @ force
    ### END SOLUTION


def ineffective(j):
    """The ratio beta_1/beta_2 for which it is zero."""
    ### BEGIN SOLUTION
    return -reduced([0.0, 1.0], j) / reduced([1.0, 0.0], j)
    ### END SOLUTION


def equilibrium(beta, lam):
    """The angles (phi_1, phi_2) of the equilibrium at a load below lam_1."""
    ### BEGIN SOLUTION
    spring = np.array([[2.0, -1.0], [-1.0, 1.0]])
    force = np.array([beta[0] - beta[1], beta[1]])
    phi = np.cumsum(beta)
    for _ in range(50):
        gradient = spring @ phi - force - lam * np.sin(phi)
        phi = phi - np.linalg.solve(spring - lam * np.diag(np.cos(phi)), gradient)
    return phi
    ### END SOLUTION


# %% checks
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

# %% proofs
PROOFS = {
    "reduced: sign": ("return mode @ force", "return -mode @ force"),
    "reduced: upper spring forgotten": ("[beta[0] - beta[1], beta[1]])\n    return", "[beta[0], beta[1]])\n    return"),
    "reduced: null vector of length one": ("return mode @ force", "return mode @ force / np.linalg.norm(mode)"),
    "reduced: null vector with its components interchanged": ("[1 - LAM[j - 1], 1.0]", "[1.0, 1 - LAM[j - 1]]"),
    "ineffective: sign of the ratio": ("return -reduced([0.0", "return reduced([0.0"),
    "ineffective: ratio upside down": (
        "-reduced([0.0, 1.0], j) / reduced([1.0, 0.0], j)",
        "-reduced([1.0, 0.0], j) / reduced([0.0, 1.0], j)",
    ),
    "ineffective: the other load": ("return -reduced([0.0", "j = 3 - j\n    return -reduced([0.0"),
    "equilibrium: unloaded shape": ("range(50)", "range(0)"),
    "equilibrium: linearised": [("- lam * np.sin(phi)", "- lam * phi"), ("np.diag(np.cos(phi))", "np.eye(2)")],
    "equilibrium: one step of Newton's method": ("range(50)", "range(1)"),
    "equilibrium: sign of the load": [("- lam * np.sin(phi)", "+ lam * np.sin(phi)"), ("spring - lam", "spring + lam")],
}
