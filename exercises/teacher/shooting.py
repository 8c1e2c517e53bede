r"""# All equilibria by shooting

The uniform strut of $n$ joints [N 2.7], of length 1 with $K = 1$ and straight when unloaded, has $h = 1/n$ and $k_i = 1/h = n$. In equilibrium

$$k (\phi_i - \phi_{i-1}) - k (\phi_{i+1} - \phi_i) - \lambda h \sin\phi_i = 0, \quad i = 1, \dots, n, \qquad \phi_0 = 0, \quad \phi_{n+1} = \phi_n$$

(angles in radians; the last condition says that there is no moment at the tip). Read from left to right, the equation gives $\phi_{i+1}$ from the two
angles before it. So all angles follow from the first one, $\phi_1$, and every equilibrium at a load is a root of *one* function of *one* unknown,

$$g(\phi_1) = \phi_{n+1} - \phi_n .$$

Adding up the equations shows that $|\phi_1| \le \lambda/n$ in each equilibrium, so the search has an end.

**Write**

1. `angles(first, n, lam)`, the angles $\phi_1, \dots, \phi_n$ that follow from $\phi_1 =$ `first`, shape $(n,)$;
2. `residual(first, n, lam)`, the number $g(\phi_1)$;
3. `equilibria(n, lam)`, all equilibria at a load, one a row in ascending order of $\phi_1$, shape $(N, n)$ for $N$ of them. In the tests $n$ is 2 or 3,
   no load is close to a fold or a branch point, and the roots are at least 0.05 apart.
"""

# %% answer
import numpy as np
from scipy.optimize import brentq


def angles(first, n, lam):
    """phi_1, ..., phi_n from phi_0 = 0 and phi_1 = first."""
    ### BEGIN SOLUTION
    phi = [0.0, first]
    for i in range(1, n):
        phi.append(2 * phi[i] - phi[i - 1] - lam / n**2 * np.sin(phi[i]))
    return np.array(phi[1:])
    ### END SOLUTION


def residual(first, n, lam):
    """phi_{n+1} - phi_n: zero in equilibrium."""
    ### BEGIN SOLUTION
    phi = np.append(0.0, angles(first, n, lam))
    return phi[n] - phi[n - 1] - lam / n**2 * np.sin(phi[n])
    ### END SOLUTION


def equilibria(n, lam):
    """All equilibria, one a row, in ascending order of phi_1."""
    ### BEGIN SOLUTION
    most = lam / n + 0.01
    grid = np.linspace(-most, most * 1.001, 2000)  # not symmetric: zero is no point of it
    values = [residual(first, n, lam) for first in grid]
    found = []
    for a, b, left, right in zip(grid[:-1], grid[1:], values[:-1], values[1:], strict=True):
        if left * right < 0:
            found.append(angles(brentq(residual, a, b, args=(n, lam), xtol=1e-14), n, lam))
    return np.array(found)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import complex_step, equals, holds
from rodlab.grading.values import Array, Number


def V(phi, lam):
    n = phi.size
    bend = phi - np.append(0.0, phi[:-1])
    return n * np.sum(bend**2) / 2 + lam / n * np.sum(np.cos(phi))


def gradient(phi, lam):
    return complex_step(V, phi, lam)


def chain(first, n, load):
    """n + 1 angles from the first on; `load` is that of one link over its spring."""
    phi = [0.0, first]
    for i in range(1, n + 1):
        phi.append(2 * phi[i] - phi[i - 1] - load * np.sin(phi[i]))
    return np.array(phi[1:])


def downwards(tip, n, lam):
    """The angles 0, ..., n from that of the tip: the recurrence read from right to left."""
    phi = [tip, tip]
    for _ in range(n):
        phi.append(2 * phi[-1] - phi[-2] - lam / n**2 * np.sin(phi[-1]))
    return np.array(phi[:0:-1])


def known(n, lam):
    """All equilibria by shooting from the other end, bisected all at once."""
    most = lam * (n + 1) / (2 * n) + 0.02
    grid = np.linspace(-most, most * 1.001, 6000)
    clamp = downwards(grid, n, lam)[0]
    change = np.flatnonzero(clamp[:-1] * clamp[1:] < 0)
    low, high, sign = grid[change], grid[change + 1], np.sign(clamp[change])
    for _ in range(60):
        middle = (low + high) / 2
        same = np.sign(downwards(middle, n, lam)[0]) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    rows = downwards(low, n, lam)[1:].T
    rows[np.abs(rows) < 1e-12] = 0.0
    return rows[np.argsort(rows[:, 0])]


def shots(draw):
    for n in (2, 3, int(draw.integers(5, 9))):
        yield draw.choice([-1, 1]) * draw.uniform(0.3, 1.2), n, draw.uniform(8, 20)


def loads(draw):
    """At the second of them most equilibria have first angles beyond pi."""
    for n, between in ((2, (3.0, 9.0)), (2, (25.5, 29.0)), (3, (4.5, 12.0)), (3, (16.5, 21.0))):
        yield n, draw.uniform(*between)


def moments(phi, first, n, lam):
    """The balance at all joints but the last, and the start."""
    return np.max(np.abs(gradient(phi, lam)[:-1])) / lam + abs(phi[0] - first)


def tip(first, n, lam):
    """The moment at the last joint that is left, over the spring."""
    return gradient(chain(first, n, lam / n**2)[:n], lam)[-1] / n


def kept(condition):
    """Those of the equilibria whose first angle satisfies a condition."""
    return lambda n, lam: known(n, lam)[condition(known(n, lam)[:, 0])]


def inner(given):
    """True of rows that are the middle ones of all."""
    for (n, lam), value in given:
        rows, true = np.array(value), known(n, lam)
        outer = (len(true) - len(rows)) // 2
        if len(rows) % 2 == 0 or not np.allclose(rows, true[outer : len(true) - outer], atol=1e-6):
            return False
    return True


def off_balance(rows, n, lam):
    """The largest gradient, of rows of which no two are alike and as many as there are."""
    right = rows.shape == known(n, lam).shape and np.all(np.diff(rows[:, 0]) > 1e-3)
    return max(np.max(np.abs(gradient(row, lam))) for row in rows) if right else np.nan


exercise = Exercise(
    title="All equilibria by shooting",
    source="N 2.7",
    imports=("numpy", "scipy.optimize"),
    questions=(
        Question(
            name="angles",
            calls=shots,
            returns=Array(lambda first, n, lam: (n,)),
            properties=(holds("balances the moments at all joints but the last (gradient of V)", moments, 1e-10),),
            mistakes=(
                Mistake(
                    "sign of the load",
                    "Solve the equation for phi_{i+1} once more.",
                    lambda first, n, lam: chain(first, n, -lam / n**2)[:n],
                ),
                Mistake(
                    "springs without h",
                    "How stiff is a spring of a strut of n joints?",
                    lambda first, n, lam: chain(first, n, lam / n)[:n],
                ),
                Mistake(
                    "clamp among the angles",
                    "Link 0 is the clamp; its angle is no unknown.",
                    lambda first, n, lam: np.append(0.0, chain(first, n, lam / n**2))[:n],
                ),
            ),
            hint="Keep the last two angles; the clamp is the one before the first.",
        ),
        Question(
            name="residual",
            calls=shots,
            returns=Number(),
            properties=(equals(tip, 1e-9, says="is the moment left at the tip (gradient of V)"),),
            mistakes=(
                Mistake(
                    "tip held",
                    "What is zero at a free end, the angle or the moment?",
                    lambda first, n, lam: chain(first, n, lam / n**2)[n],
                ),
                Mistake(
                    "one joint short",
                    "Your difference is that of the angles n and n - 1: the last link is left unloaded.",
                    lambda first, n, lam: np.diff(chain(first, n, lam / n**2))[n - 2],
                ),
                Mistake("wrong sign", "Which of the two angles is subtracted?", lambda first, n, lam: -tip(first, n, lam)),
            ),
            hint="One more step of the recurrence leads to phi_{n+1}.",
        ),
        Question(
            name="equilibria",
            calls=loads,
            returns=Array(),
            properties=(
                holds("are as many equilibria as there are", off_balance, 1e-8, 1.5),
                equals(known, 1e-8, says="are those that shooting from the tip finds", points=1.5),
            ),
            mistakes=(
                Mistake("small angles only", "How large can the first angle be?", when=inner),
                Mistake("one side only", "To each bent state belongs its mirror image.", kept(lambda first: first > -1e-6)),
                Mistake(
                    "straight strut forgotten", "Is the straight strut in equilibrium?", kept(lambda first: np.abs(first) > 1e-6)
                ),
                Mistake(
                    "first angles only", "Each row holds all n angles of an equilibrium.", lambda n, lam: known(n, lam)[:, 0]
                ),
            ),
            hint="Evaluate g on a grid over the whole range, and refine each change of its sign.",
        ),
    ),
)

# %% proofs
SOLVED = "angles(brentq(residual, a, b, args=(n, lam), xtol=1e-14), n, lam)"
PROOFS = {
    "angles: sign of the load": ("- phi[i - 1] - lam", "- phi[i - 1] + lam"),
    "angles: springs without h": ("phi[i - 1] - lam / n**2", "phi[i - 1] - lam / n"),
    "angles: clamp among the angles": ("np.array(phi[1:])", "np.array(phi[:n])"),
    "residual: tip held": ("return phi[n] - phi[n - 1]", "return 2 * phi[n] - phi[n - 1]"),
    "residual: one joint short": ("phi[n - 1] - lam / n**2 * np.sin(phi[n])", "phi[n - 1]"),
    "residual: wrong sign": ("return phi[n] - phi[n - 1] - lam / n**2", "return phi[n - 1] - phi[n] + lam / n**2"),
    "equilibria: small angles only": ("most = lam / n + 0.01", "most = 1.0 - 1e-3"),
    "equilibria: one side only": ("np.linspace(-most,", "np.linspace(-1e-3,"),
    "equilibria: straight strut forgotten": ("if left * right < 0:", "if left * right < 0 and a * b > 0:"),
    "equilibria: first angles only": (SOLVED, SOLVED + "[0]"),
}
