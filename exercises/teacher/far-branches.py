r"""# The far branches of one joint

A link of length 1 on a spring of stiffness 1 stands at the angle $\phi$ (radians) under the load $\lambda$; it is in equilibrium
[N 2.7, n = 1, $\beta = 0$] where

$$f(\phi; \lambda) = \phi - \lambda \sin\phi = 0 .$$

The spring may be wound up by more than a turn, so angles beyond $\pi$ count. At large loads, pressing ($\lambda > 0$) or pulling
($\lambda < 0$), there are many equilibria. They lie on branches that are not connected to the straight state $\phi = 0$
and that begin at folds, where also $\partial f/\partial\phi = 0$.

**Write**

1. `folds(m)`, the first $m$ folds with $\phi > 0$ in the order of their angles, rows of an angle and a load, shape $(m, 2)$;
2. `equilibria(lam)`, the angles of all equilibria at a load that is not a fold's, ascending, an array;
3. `stable(lam)`, how many of them are stable, that is, have $\partial f/\partial\phi > 0$, a whole number.

The test loads are between $-40$ and $40$ and at least $0.2$ away from every fold and from $\lambda = 1$.
"""

# %% answer
import numpy as np
from scipy.optimize import brentq


def folds(m):
    """The first m folds with phi > 0, rows (phi, lam)."""
    ### BEGIN SOLUTION
    found = []
    for turn in range(1, m + 1):
        # phi cos(phi) = sin(phi): tan(phi) = phi without its poles
        phi = brentq(lambda x: x * np.cos(x) - np.sin(x), turn * np.pi, (turn + 1 / 2) * np.pi, xtol=1e-14)
        found.append((phi, 1 / np.cos(phi)))
    return found
    ### END SOLUTION


def equilibria(lam):
    """All roots of phi - lam sin(phi), ascending."""
    ### BEGIN SOLUTION
    grid = np.linspace(0, abs(lam) + 1, 100_000)[1:]  # |phi| is at most |lam|
    f = grid - lam * np.sin(grid)
    change = np.flatnonzero(f[:-1] * f[1:] < 0)
    positive = np.array([brentq(lambda x: x - lam * np.sin(x), grid[i], grid[i + 1], xtol=1e-14) for i in change])
    return np.concatenate([-positive[::-1], [0.0], positive])
    ### END SOLUTION


def stable(lam):
    """The number of equilibria with a positive second derivative."""
    ### BEGIN SOLUTION
    slope = 1 - lam * np.cos(equilibria(lam))
    return int(np.sum(slope > 0))
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number


def bisected(function, low, high):
    """A root between two points where the function has different signs."""
    sign = np.sign(function(low))
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if np.sign(function(middle)) == sign else (low, middle)
    return (low + high) / 2


def turning(m):
    """Angles where lam = phi/sin(phi) is stationary: its derivative's numerator changes its sign once in each turn."""
    return np.array([bisected(lambda x: np.sin(x) - x * np.cos(x), k * np.pi, (k + 0.5) * np.pi) for k in range(1, m + 1)])


def table(m):
    phi = turning(m)
    return np.column_stack([phi, phi / np.sin(phi)])


CORNERS = np.concatenate([[0.0], turning(14), np.pi * np.arange(1, 14)])


def roots(lam, *, most=np.inf):
    """All of them: between neighbouring corners (poles and turning points of phi/sin(phi)) it is monotone."""
    corners = np.sort(CORNERS)
    corners[0] = 1e-9
    f = [x - lam * np.sin(x) for x in corners]
    found = [
        bisected(lambda x: x - lam * np.sin(x), a, b)
        for a, b, fa, fb in zip(corners[:-1], corners[1:], f[:-1], f[1:], strict=True)
        if fa * fb < 0
    ]
    positive = np.array([x for x in found if x < most])
    return np.concatenate([-positive[::-1], [0.0], positive])


def positive_slopes(lam, sign=1):
    return int(np.sum(sign * (1 - lam * np.cos(roots(lam))) > 0))


def numbers(draw):
    yield (3,)
    yield (int(draw.integers(4, 9)),)


def loads(draw):
    for between in ((-10.6, -5.0), (1.5, 7.5), (8.1, 13.8), (20.7, 26.4), (33.3, 39.0), (-35.9, -29.9)):
        yield (draw.uniform(*between),)


def as_many(found, lam):
    return float(abs(found.size - roots(lam).size) + (not np.all(np.isfinite(found)) or np.any(np.diff(found) <= 1e-6)))


exercise = Exercise(
    title="The far branches of one joint",
    source="N 2.7",
    imports=("numpy", "scipy.optimize"),
    questions=(
        Question(
            name="folds",
            calls=numbers,
            returns=Array(lambda m: (m, 2)),
            properties=(
                holds(
                    "has equilibria in its rows",
                    lambda rows, m: np.max(np.abs(rows[:, 0] / rows[:, 1] - np.sin(rows[:, 0]))),
                    1e-8,
                ),
                equals(table, 1e-8, says="has every fold in its order", points=2.0),
            ),
            mistakes=(
                Mistake(
                    "poles of the tangent",
                    "Your solver saw a change of sign where the tangent jumps. Multiply the equation by the cosine.",
                    when=lambda given: all(
                        np.allclose(np.asarray(v)[:, 0], (np.arange(1, m[0] + 1) - 0.5) * np.pi) for m, v in given
                    ),
                ),
                Mistake(
                    "folds under pressure only",
                    "The load of a fold may be negative: which angles have you passed over?",
                    lambda m: table(2 * m)[1::2],
                ),
            ),
            hint="Eliminate the load from f = 0 and df/dphi = 0; between which multiples of pi/2 does each root lie?",
        ),
        Question(
            name="equilibria",
            calls=loads,
            returns=Array(),
            properties=(
                holds("has as many as there are, ascending", as_many, 0.0),
                equals(roots, 1e-8, says="has them all", points=2.0),
            ),
            mistakes=(
                Mistake(
                    "one turn only",
                    "The spring may be wound up beyond pi. How large can |phi| be if phi = lam sin(phi)?",
                    lambda lam: roots(lam, most=np.pi),
                ),
                Mistake("one side only", "With phi also -phi is an equilibrium.", lambda lam: roots(lam)[roots(lam).size // 2 :]),
                Mistake(
                    "straight state forgotten",
                    "Is phi = 0 an equilibrium at every load?",
                    lambda lam: np.delete(roots(lam), roots(lam).size // 2),
                ),
            ),
            hint="Every equilibrium has |phi| at most |lam|. Look for changes of sign there, on a grid fine enough for a sine.",
        ),
        Question(
            name="stable",
            calls=loads,
            returns=Number(whole=True),
            properties=(equals(positive_slopes, 0.0, says="counts the minima of the energy"),),
            mistakes=(
                Mistake(
                    "unstable counted",
                    "Is the energy least or greatest where its slope falls?",
                    lambda lam: positive_slopes(lam, -1),
                ),
                Mistake(
                    "one side only counted",
                    "Your count is that of the angles that are not negative: what of their mirror images?",
                    lambda lam: int(np.sum((1 - lam * np.cos(roots(lam)) > 0) & (roots(lam) >= 0))),
                ),
            ),
            hint="Evaluate the derivative of f at each equilibrium and count the positive ones.",
        ),
    ),
)

# %% proofs
ROOTS = "np.concatenate([-positive[::-1], [0.0], positive])"
PROOFS = {
    "folds: poles of the tangent": (
        "brentq(lambda x: x * np.cos(x) - np.sin(x), turn * np.pi, (turn + 1 / 2) * np.pi, xtol=1e-14)",
        "(turn - 1 / 2) * np.pi",
    ),
    "folds: folds under pressure only": ("range(1, m + 1)", "range(2, 2 * m + 1, 2)"),
    "equilibria: one turn only": ("abs(lam) + 1, 100_000", "np.pi, 100_000"),
    "equilibria: one side only": (ROOTS, "np.concatenate([[0.0], positive])"),
    "equilibria: straight state forgotten": (ROOTS, "np.concatenate([-positive[::-1], positive])"),
    "stable: unstable counted": ("slope > 0", "slope < 0"),
    "stable: one side only counted": ("np.sum(slope > 0)", "np.sum((slope > 0) & (equilibria(lam) >= 0))"),
}
