r"""# Two joints: the buckled branches

The strut of two joints [N 2.7, exercise session] with unit springs and unit links has the energy

$$V(\phi_1, \phi_2; \lambda) = \tfrac12 \phi_1^2 + \tfrac12 (\phi_2 - \phi_1)^2 + \lambda (\cos\phi_1 + \cos\phi_2)$$

(angles in radians). The straight strut is singular at $\lambda_1 = (3 - \sqrt5)/2$ and $\lambda_2 = (3 + \sqrt5)/2$; from each of these loads
a branch of buckled states leaves. Use the angle of the last link, $\phi_2 = \varepsilon$, as the parameter along branch $j$:

$$\phi_1 = a_j \varepsilon + b_j \varepsilon^3 + O(\varepsilon^5), \qquad \lambda = \lambda_j + c_j \varepsilon^2 + O(\varepsilon^4) .$$

**Write**

1. `coefficient(j)` for $j = 1$ and $2$, the number $c_j$ (of which the sign says whether the branch leaves towards higher or lower loads);
2. `shape(j)`, the numbers $a_j$ and $b_j$, an array of shape (2,);
3. `state(j, eps)`, the equilibrium on branch $j$ with $\phi_2 = \varepsilon$ ($0 < \varepsilon \le 0.4$) to at least nine digits,
   not by the series but as a solution of the equations: two numbers `phi_1, lam`.
"""

# %% answer
import numpy as np
from scipy.optimize import root


def branch_load(j):
    """The load at which branch j leaves the straight strut."""
    return (3 + (-1) ** j * np.sqrt(5)) / 2


def coefficient(j):
    """c_j in lam = lam_j + c_j eps^2 + ..."""
    ### BEGIN SOLUTION
    lam = branch_load(j)
    mode = np.array([1 - lam, 1.0])
    return lam / 6 * np.sum(mode**4) / np.sum(mode**2)
    ### END SOLUTION


def shape(j):
    """a_j and b_j in phi_1 = a_j eps + b_j eps^3 + ..."""
    ### BEGIN SOLUTION
    lam = branch_load(j)
    return [1 - lam, lam / 6 - coefficient(j)]  # the second equation: phi_1 = eps - lam sin(eps)
    ### END SOLUTION


def state(j, eps):
    """phi_1 and lam of the equilibrium on branch j that has phi_2 = eps."""

    ### BEGIN SOLUTION
    def residual(unknown):
        first, lam = unknown
        return [2 * first - eps - lam * np.sin(first), eps - first - lam * np.sin(eps)]

    a, b = shape(j)
    guess = [a * eps + b * eps**3, branch_load(j) + coefficient(j) * eps**2]
    return root(residual, guess, tol=1e-12).x
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number, Parts

LOADS = np.linalg.eigvalsh([[2.0, -1.0], [-1.0, 1.0]])
MODES = np.linalg.eigh([[2.0, -1.0], [-1.0, 1.0]])[1].T


def gradient(first, last, lam):
    return np.array([2 * first - last - lam * np.sin(first), last - first - lam * np.sin(last)])


def on_branch(j, eps):
    """The last equation gives phi_1 at a load, the first one is left: bisection for the load near lam_j."""

    def left(lam):
        first = eps - lam * np.sin(eps)
        return gradient(first, eps, lam)[0] / eps

    low, high = LOADS[j - 1] - 0.2, LOADS[j - 1] + 0.3
    sign = np.sign(left(low))
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if np.sign(left(middle)) == sign else (low, middle)
    return eps - low * np.sin(eps), low


def fitted(j):
    """a, b, c from states: polynomials in eps^2 through eight of them."""
    eps = np.linspace(0.05, 0.4, 8)
    first, lam = np.array([on_branch(j, e) for e in eps]).T
    a, b = np.linalg.solve(np.vander(eps**2, increasing=True), first / eps)[:2]
    return a, b, np.linalg.solve(np.vander(eps**2, increasing=True), lam)[1]


def curvature(j, *, sine=1 / 6, length=1.0):
    mode = MODES[j - 1] / MODES[j - 1][1] * length
    return LOADS[j - 1] * sine * np.sum(mode**4) / np.sum(mode**2)


def unit(j):
    return curvature(j, length=abs(MODES[j - 1][1]))


def by_first(j):
    return curvature(j) / (1 - LOADS[j - 1]) ** 2


def branches(draw):
    yield from ((1,), (2,))


def both(draw):
    for j in (1, 2):
        for between in ((0.05, 0.1), (0.2, 0.3), (0.35, 0.4)):
            yield j, draw.uniform(*between)


exercise = Exercise(
    title="Two joints: the buckled branches",
    source="N 2.7",
    imports=("numpy", "scipy.optimize"),
    questions=(
        Question(
            name="coefficient",
            calls=branches,
            returns=Number(),
            properties=(equals(lambda j: fitted(j)[2], 1e-5, says="is the curvature of computed branches", points=2.0),),
            mistakes=(
                Mistake(
                    "subcritical", "Is sin(phi) larger or smaller than phi? What load makes up for it?", lambda j: -curvature(j)
                ),
                Mistake("mode of length one", "Which component of the mode has to be one if phi_2 is the parameter?", unit),
                Mistake(
                    "second derivative for the coefficient",
                    "At eps = 0.1 compare lam_j + c_j eps^2 with the load of a state: is it off by as much as it adds?",
                    lambda j: 2 * curvature(j),
                ),
                Mistake("parameter phi_1", "Your coefficient belongs to the square of another angle than phi_2.", by_first),
                Mistake(
                    "factorial of the sine", "What is the cubic term of the sine's series?", lambda j: curvature(j, sine=1 / 2)
                ),
            ),
            hint="Insert both series, collect the terms of order eps^3 and multiply them by the mode: what contains b_j drops out.",
        ),
        Question(
            name="shape",
            calls=branches,
            returns=Array((2,)),
            properties=(
                holds("has the mode of its load", lambda found, j: abs(found[0] - fitted(j)[0]), 1e-8),
                holds("has the cubic term of computed branches", lambda found, j: abs(found[1] - fitted(j)[1]), 1e-5),
            ),
            mistakes=(
                Mistake(
                    "mode upside down",
                    "Which of the two angles is eps, and which one is a times it?",
                    when=lambda given: all(abs(v[0] * (1 - LOADS[a[0] - 1]) - 1) < 1e-6 for a, v in given),
                ),
                Mistake(
                    "load of the branch point in the cubic term",
                    "The load moves along the branch: in phi_1 = eps - lam sin(eps) its second term contributes too.",
                    lambda j: np.array([1 - LOADS[j - 1], LOADS[j - 1] / 6]),
                ),
            ),
            hint="The equation of the last link gives phi_1 when the series of the load is known.",
        ),
        Question(
            name="state",
            calls=both,
            returns=Parts(Number(), Number()),
            properties=(
                holds("is an equilibrium", lambda found, j, eps: np.max(np.abs(gradient(found[0], eps, found[1]))) / eps, 1e-7),
                holds("is on its branch", lambda found, j, eps: abs(found[1] - on_branch(j, eps)[1]), 1e-7),
            ),
            mistakes=(
                Mistake(
                    "first order",
                    "Insert your state into the equations: what is left? Give it to a solver as a guess.",
                    lambda j, eps: ((1 - LOADS[j - 1]) * eps, LOADS[j - 1]),
                ),
                Mistake(
                    "series for the solution",
                    "The series is a good guess, and its error grows like eps^4. Solve the equations.",
                    lambda j, eps: (
                        (1 - LOADS[j - 1]) * eps + (LOADS[j - 1] / 6 - curvature(j)) * eps**3,
                        LOADS[j - 1] + curvature(j) * eps**2,
                    ),
                ),
                Mistake(
                    "on the other branch",
                    "Check which branch point your guess starts from.",
                    lambda j, eps: on_branch(3 - j, eps),
                ),
            ),
            hint="With phi_2 given, the two equations have the two unknowns phi_1 and lam; the series is the guess.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "coefficient: subcritical": ("return lam / 6 *", "return -lam / 6 *"),
    "coefficient: mode of length one": ("1.0])\n", "1.0]) / np.hypot(1 - lam, 1)\n"),
    "coefficient: parameter phi_1": ("np.array([1 - lam, 1.0])", "np.array([1, 1 / (1 - lam)])"),
    "coefficient: second derivative for the coefficient": ("return lam / 6 *", "return lam / 3 *"),
    "coefficient: factorial of the sine": ("return lam / 6 *", "return lam / 2 *"),
    "shape: mode upside down": ("return [1 - lam,", "return [1 / (1 - lam),"),
    "shape: load of the branch point in the cubic term": ("lam / 6 - coefficient(j)]", "lam / 6]"),
    "state: first order": ("root(residual, guess, tol=1e-12).x", "a * eps, branch_load(j)"),
    "state: series for the solution": ("root(residual, guess, tol=1e-12).x", "guess"),
    "state: on the other branch": ("a, b = shape(j)", "j = 3 - j\n    a, b = shape(j)"),
}
