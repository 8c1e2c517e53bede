r"""# Buckling loads of the rod

The straight uniform rod $\phi = 0$ of stiffness $K$ and length 1 is an equilibrium at every load $\lambda$. The linearisation there
[N 2.8.1] has a solution $\psi \neq 0$ at the buckling loads $\lambda_1 < \lambda_2 < \dots$ only:

$$K \psi'' + \lambda \psi = 0, \qquad \psi(0) = 0, \quad \psi'(1) = 0 .$$

(The notes' "$K_2 \equiv 0$" there should read: $K_2$ constant.) From each buckling load a pair of bent equilibria, $\phi$ and $-\phi$, leaves to
larger $\lambda$ and continues for all larger loads; there are no others. Angles are radians.

**Write**

1. `loads(K, count)`, the first `count` buckling loads, ascending, shape (count,);
2. `mode(j, s)`, the solution $\psi_j$ at an array `s` of arclengths, the shape of `s`; any multiple of it will do;
3. `index(lam, K)`, the number of negative eigenvalues $\mu$ of $-K \psi'' - \lambda \psi = \mu \psi$ with the same ends, a whole number
   (`lam` is no buckling load);
4. `equilibria(lam, K)`, the number of all equilibria at `lam`, a whole number.
"""

# %% answer
import numpy as np


def loads(K, count):
    """The first buckling loads, an array of shape (count,)."""
    ### BEGIN SOLUTION
    j = np.arange(1, count + 1)
    return K * ((2 * j - 1) * np.pi / 2) ** 2
    ### END SOLUTION


def mode(j, s):
    """psi_j at the arclengths s, up to a factor."""
    ### BEGIN SOLUTION
    return np.sin((2 * j - 1) * np.pi / 2 * s)
    ### END SOLUTION


def index(lam, K):
    """The number of negative eigenvalues at phi = 0."""
    ### BEGIN SOLUTION
    j, passed = 1, 0
    while K * ((2 * j - 1) * np.pi / 2) ** 2 < lam:
        passed, j = passed + 1, j + 1
    return passed
    ### END SOLUTION


def equilibria(lam, K):
    """The number of equilibria at lam: the straight one and the bent ones."""
    ### BEGIN SOLUTION
    return 1 + 2 * index(lam, K)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number


def free_end(loads, K, count):
    """psi'(1) of the solution with psi(0) = 0, psi'(0) = 1, and how far the number of its zeros is from j - 1."""
    w = np.sqrt(loads / K)
    within = np.sin(np.outer(w, np.linspace(0.001, 1, 2000)))
    zeros = np.sum(within[:, 1:] * within[:, :-1] < 0, axis=1)
    return np.max(np.abs(np.cos(w))) + np.max(np.abs(zeros - np.arange(count)))


def off(value, right):
    """How far an array is from a multiple of another one that is not zero."""
    value = value / np.linalg.norm(value)
    return np.linalg.norm(value - right * (right @ value) / (right @ right))


def off_mode(value, j, s):
    return off(value, np.exp(1j * np.pi * (j - 0.5) * s).imag)


def like_mode(other):
    return lambda given: all(off(np.array(value), other(j, s)) < 1e-6 for (j, s), value in given)


def negative(lam, K, n=150):
    """Negative eigenvalues of the second variation by finite differences."""
    A = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    A[-1, -1] = 1.0
    weight = np.append(np.ones(n - 1), 0.5)
    return int(np.sum(np.linalg.eigvalsh(K * n**2 * A - lam * np.diag(weight)) < 0))


def shot(lam, K, steps=300):
    """Equilibria counted by shooting from the free end, at angles between 0 and pi, to the clamp; mirror images are added."""
    tip = np.pi - np.geomspace(1e-6, np.pi - 2e-3, 600)
    phi, rate, h = tip, np.zeros_like(tip), 1 / steps

    def field(phi, rate):
        return rate, -lam / K * np.sin(phi)

    for _ in range(steps):
        a = field(phi, rate)
        b = field(phi + h / 2 * a[0], rate + h / 2 * a[1])
        c = field(phi + h / 2 * b[0], rate + h / 2 * b[1])
        d = field(phi + h * c[0], rate + h * c[1])
        phi, rate = (y + h / 6 * (p + 2 * q + 2 * r + t) for y, p, q, r, t in zip((phi, rate), a, b, c, d, strict=True))
    return 1 + 2 * int(np.sum(phi[1:] * phi[:-1] < 0))


def rods(draw):
    for count in (1, 3, 6):
        yield draw.uniform(1.3, 4), count


def places(draw):
    for j in (1, 2, 3, 5):
        yield j, np.sort(draw.uniform(0, 1, size=9))


def states(draw):
    yield draw.uniform(-8, -1), 1.5
    yield draw.uniform(2.6, 3.2), draw.uniform(1.5, 2.5)
    for between in ((0.3, 2.2), (3, 20), (25, 58), (66, 115)):
        K = draw.uniform(1.3, 3)
        yield K * draw.uniform(*between), K


def passes(count):
    return (np.arange(count) + 0.5) ** 2 * np.pi**2


def wrong_loads(factor):
    return lambda K, count: K * factor(np.arange(1, count + 1)) ** 2


def passed(lam, K, count=9):
    return int(np.sum(K * (np.arange(0.5, count) * np.pi) ** 2 < lam))


exercise = Exercise(
    title="Buckling loads of the rod",
    source="N 2.8.1",
    questions=(
        Question(
            name="loads",
            calls=rods,
            returns=Array(lambda K, count: (count,)),
            properties=(holds("lets the j-th solution arrive at the free end with psi' = 0", free_end, 1e-9),),
            mistakes=(
                Mistake(
                    "held at both ends",
                    "Your modes vanish at s = 1; the free end asks for a horizontal tangent.",
                    wrong_loads(lambda j: j * np.pi),
                ),
                Mistake(
                    "j for 2j - 1",
                    "Every other of your waves has a vanishing value, not a vanishing slope, at s = 1.",
                    wrong_loads(lambda j: j * np.pi / 2),
                ),
                Mistake(
                    "off by one",
                    "Is there a load below your first one? Try a quarter of a wave.",
                    wrong_loads(lambda j: (2 * j + 1) * np.pi / 2),
                ),
                Mistake(
                    "square root",
                    "These are the wave numbers; how is the load made of them?",
                    lambda K, count: np.sqrt(K) * (2 * np.arange(1, count + 1) - 1) * np.pi / 2,
                ),
                Mistake(
                    "K forgotten", "How does the load of a strut change if it is twice as stiff?", lambda K, count: passes(count)
                ),
            ),
            hint="Solve the equation from the clamp; the slope at s = 1 is a cosine of sqrt(lam/K).",
        ),
        Question(
            name="mode",
            calls=places,
            returns=Array(lambda j, s: s.shape),
            properties=(holds("is the mode, up to a factor", off_mode, 1e-9),),
            mistakes=(
                Mistake(
                    "cosine",
                    "Which of the two ends is clamped? Your mode does not vanish there.",
                    when=like_mode(lambda j, s: np.cos((2 * j - 1) * np.pi / 2 * s)),
                ),
                Mistake(
                    "held at both ends",
                    "Your mode vanishes at the free end too; the first mode is a quarter of a wave.",
                    when=like_mode(lambda j, s: np.sin(j * np.pi * s)),
                ),
                Mistake(
                    "the next mode",
                    "How many zeros has mode j inside the rod? Yours has one too many.",
                    when=like_mode(lambda j, s: np.sin((2 * j + 1) * np.pi / 2 * s)),
                ),
            ),
            hint="Put lam_j into the solution that vanishes at the clamp.",
        ),
        Question(
            name="index",
            calls=states,
            returns=Number(whole=True),
            properties=(equals(negative, 0.0, says="counts the negative eigenvalues (finite differences)"),),
            mistakes=(
                Mistake("equilibria counted", "Not the equilibria are asked for but the negative eigenvalues.", shot),
                Mistake(
                    "K forgotten",
                    "A stiffer rod loses stability later: does your index depend on K?",
                    lambda lam, K: passed(lam, 1.0),
                ),
                Mistake(
                    "only stable or not",
                    "Beyond the second load there are two directions in which the energy falls.",
                    lambda lam, K: min(passed(lam, K), 1),
                ),
            ),
            hint="The eigenvalues are lam_j - lam.",
        ),
        Question(
            name="equilibria",
            calls=states,
            returns=Number(whole=True),
            properties=(equals(shot, 0.0, says="counts the equilibria (by shooting)"),),
            mistakes=(
                Mistake(
                    "mirror images forgotten",
                    "A rod that can buckle to the right can buckle to the left.",
                    lambda lam, K: 1 + passed(lam, K),
                ),
                Mistake(
                    "straight rod forgotten",
                    "Your number is even: which equilibrium is its own mirror image?",
                    lambda lam, K: 2 * passed(lam, K),
                ),
            ),
            hint="The straight rod, and a pair for every buckling load that lam has passed.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "loads: held at both ends": ("((2 * j - 1) * np.pi / 2) ** 2\n    #", "(j * np.pi) ** 2\n    #"),
    "loads: j for 2j - 1": ("((2 * j - 1) * np.pi / 2) ** 2\n    #", "(j * np.pi / 2) ** 2\n    #"),
    "loads: off by one": ("((2 * j - 1) * np.pi / 2) ** 2\n    #", "((2 * j + 1) * np.pi / 2) ** 2\n    #"),
    "loads: square root": ("return K * ((2 * j - 1) * np.pi / 2) ** 2", "return K**0.5 * (2 * j - 1) * np.pi / 2"),
    "loads: K forgotten": ("return K * ((2", "return ((2"),
    "mode: cosine": ("np.sin((2", "np.cos((2"),
    "mode: held at both ends": ("np.sin((2 * j - 1) * np.pi / 2 * s)", "np.sin(j * np.pi * s)"),
    "mode: the next mode": ("np.sin((2 * j - 1)", "np.sin((2 * j + 1)"),
    "index: equilibria counted": ("return passed\n", "return 1 + 2 * passed\n"),
    "index: K forgotten": ("while K * ((2", "while ((2"),
    "index: only stable or not": ("return passed\n", "return min(passed, 1)\n"),
    "equilibria: mirror images forgotten": ("1 + 2 * index", "1 + index"),
    "equilibria: straight rod forgotten": ("1 + 2 * index", "2 * index"),
}
