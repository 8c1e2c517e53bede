r"""# Newton's method

To solve $f(z) = 0$, $n$ equations for $n$ unknowns, Newton's method [N 2.7, "Review of Newton's method"] goes from an approximation $z^k$ to
the next one by

$$z^{k+1} = z^k + w^k, \qquad J(z^k)\, w^k = -f(z^k), \qquad J_{ij} = \partial f_i / \partial z_j .$$

Near a root where $J$ is nonsingular the error is squared in each step: $e_{k+1} \approx C e_k^2$ with $e_k = |z^k - z^e|$. At a root
where $J$ is singular it still shrinks, but only in a constant ratio. One joint at its buckling load, $f(\phi) = \phi - \sin\phi$, is such a case.

**Write**

1. `newton(f, J, z, steps)`, where the functions `f(z)` and `J(z)` return arrays of shapes $(n,)$ and $(n, n)$: all iterates,
   the start `z` first, one a row, shape (steps + 1, n);
2. `order(errors)`, from the last three of a list of errors $e_{k-1}, e_k, e_{k+1}$ the observed order $p$ of $e_{k+1} = C e_k^p$ (with the
   same $C$ in both steps): a number;
3. `ratio(m)`, the limit of $e_{k+1}/e_k$ for a scalar $f$ that vanishes like $(z - z^e)^m$, a number.
"""

# %% answer
import numpy as np


def newton(f, J, z, steps):
    """All iterates, one a row."""
    ### BEGIN SOLUTION
    iterates = [np.array(z, dtype=float)]
    for _ in range(steps):
        z = iterates[-1]
        step = np.linalg.solve(J(z), -f(z))
        iterates.append(z + step)
    return np.array(iterates)
    ### END SOLUTION


def order(errors):
    """The order of convergence from the last three errors."""
    ### BEGIN SOLUTION
    before, now, after = errors[-3:]
    return np.log(after / now) / np.log(now / before)
    ### END SOLUTION


def ratio(m):
    """The ratio of successive errors of Newton's method at an m-fold root."""
    ### BEGIN SOLUTION
    return 1 - 1 / m  # z - z^m/(m z^(m-1))
    ### END SOLUTION


# %% checks
from itertools import pairwise

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number


def two(draw):
    """Two imperfect joints that are pulled aside by a follower: an unsymmetric Jacobian, with a regular root near the start."""
    a, b, c = draw.uniform(0.3, 0.5), draw.uniform(0.1, 0.2), draw.uniform(0.4, 0.6)
    f = Code(
        f"lambda z: np.array([2*z[0] - z[1] - {a!r}*np.sin(z[0] - z[1]) - {b!r}, z[1] - z[0] - {c!r}*np.sin(z[1]) + z[0]**2 - {b!r}])"
    )
    J = Code(
        f"lambda z: np.array([[2 - {a!r}*np.cos(z[0] - z[1]), -1 + {a!r}*np.cos(z[0] - z[1])],"
        f" [-1 + 2*z[0], 1 - {c!r}*np.cos(z[1])]])"
    )
    return f, J, draw.uniform(0.3, 0.5, size=2), 6


def problems(draw):
    yield two(draw)
    start = draw.uniform(0.5, 1.5, size=1)  # one joint at its buckling load
    yield Code("lambda z: z - np.sin(z)"), Code("lambda z: np.diag(1 - np.cos(z))"), start, 9
    n, load = 4, draw.uniform(1.0, 2.0)
    T = f"(2*np.eye({n}) - np.eye({n}, k=1) - np.eye({n}, k=-1))"
    f, J = f"lambda z: {T} @ z + {load!r}*z**3 - 1", f"lambda z: {T} + 3*{load!r}*np.diag(z**2)"
    yield Code(f), Code(J), draw.uniform(0.5, 1.0, size=n), 5


def defect(z, f, J, start, steps):
    """How far each row is from solving the linear equation for it, relative to the first step."""
    left = [J(a) @ (b - a) + f(a) for a, b in pairwise(z)]
    return np.max(np.abs(left)) / min(1.0, np.max(np.abs(f(start))))


def converged(z, f, J, start, steps):
    """To rounding where the root is regular; in the ratio 2/3 where it is threefold."""
    return abs(z[-1, 0] / z[-2, 0] - 2 / 3) if start.size == 1 else 1e6 * np.max(np.abs(f(z[-1])))


def variant(f, J, z, steps, *, sign=-1.0, transposed=False, frozen=False):
    rows, first = [z], J(z)
    for _ in range(steps):
        A = first if frozen else J(rows[-1])
        rows.append(rows[-1] + sign * np.linalg.inv(A.T if transposed else A) @ f(rows[-1]))
    return np.array(rows)


def begins(**wrong):
    """True of iterates that begin as those of a mistake; later ones may run away."""

    def alike(given):
        return all(np.allclose(np.array(v)[:3], variant(*a, **wrong)[:3], rtol=1e-8) for a, v in given)

    return alike


def errors(draw):
    for p in (1.0, 2.0, 1.618, 3.0):
        e, C, found = draw.uniform(0.01, 0.1), draw.uniform(0.2, 0.6), []
        for _ in range(4):
            found.append(e)
            e = C * e**p
        yield (np.array(found),)


def slope(e):
    return np.polyfit(np.log(e[-3:-1]), np.log(e[-2:]), 1)[0]


def multiplicities(draw):
    yield from ((m,) for m in (2, 3, 4, 7))


def watched(m):
    """By doing it: one step for f(z) = z^m from z = 1."""
    return 1.0 - 1.0**m / (m * 1.0 ** (m - 1))


exercise = Exercise(
    title="Newton's method",
    source="N 2.7",
    questions=(
        Question(
            name="newton",
            calls=problems,
            returns=Array(lambda f, J, z, steps: (steps + 1, z.size)),
            properties=(
                holds(
                    "begins with the start",
                    lambda z, f, J, start, steps: np.max(np.abs(z[0] - start)) + (z[1:] == start).all(),
                    1e-14,
                    0.5,
                ),
                holds("solves the linear equation in every step", defect, 1e-10, 1.5),
                holds("converges: to rounding, or in the ratio 2/3 at a threefold root", converged, 0.01),
            ),
            mistakes=(
                Mistake("step in the wrong direction", "What should f(z) + J w be after the step?", when=begins(sign=1.0)),
                Mistake(
                    "transposed Jacobian",
                    "Does row i of the Jacobian belong to equation i or to unknown i?",
                    when=begins(transposed=True),
                ),
                Mistake(
                    "Jacobian of the start",
                    "Your steps are those of the chord method, of first order. Where is J taken?",
                    when=begins(frozen=True),
                ),
                Mistake(
                    "one array for all rows",
                    "Your rows are all alike: z += w changes the array that has been kept already. Keep a new one.",
                    when=lambda given: all(np.ptp(np.array(v), axis=0).max() == 0 and np.any(v[0] != a[2]) for a, v in given),
                ),
                Mistake("start left out", "The first row is the start itself.", lambda *given: variant(*given)[1:]),
            ),
            hint="A loop: solve a linear system, add its solution, keep the result.",
        ),
        Question(
            name="order",
            calls=errors,
            returns=Number(),
            properties=(equals(slope, 1e-8, says="is the slope of log e_{k+1} against log e_k"),),
            mistakes=(
                Mistake(
                    "constant not eliminated",
                    "log e_{k+1} = p log e_k + log C: two such equations are needed to be rid of C.",
                    lambda e: np.log(e[-1]) / np.log(e[-2]),
                ),
                Mistake("ratio upside down", "Try errors 1e-1, 1e-2, 1e-4: the order is 2.", lambda e: 1 / slope(e)),
            ),
            hint="Take logarithms of both equations and eliminate C.",
        ),
        Question(
            name="ratio",
            calls=multiplicities,
            returns=Number(),
            properties=(equals(watched, 1e-3, says="is the ratio that the iterates show"),),
            mistakes=(
                Mistake("one over m", "That is the part of the error that a step removes. What is left?", lambda m: 1 / m),
                Mistake(
                    "multiplicity less one",
                    "For m = 1 convergence is quadratic: what is the limit of the ratio then?",
                    lambda m: m / (m + 1),
                ),
                Mistake("always two thirds", "That is the ratio at a threefold root.", lambda m: 2 / 3),
            ),
            hint="Let f(z) = z^m and do one step from any z.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "newton: step in the wrong direction": ("z + step", "z - step"),
    "newton: transposed Jacobian": ("solve(J(z), -f(z))", "solve(J(z).T, -f(z))"),
    "newton: Jacobian of the start": ("solve(J(z), -f(z))", "solve(J(iterates[0]), -f(z))"),
    "newton: one array for all rows": ("iterates.append(z + step)", "z += step\n        iterates.append(z)"),
    "newton: start left out": ("return np.array(iterates)", "return np.array(iterates[1:])"),
    "order: constant not eliminated": ("np.log(after / now) / np.log(now / before)", "np.log(after) / np.log(now)"),
    "order: ratio upside down": ("np.log(after / now) / np.log(now / before)", "np.log(now / before) / np.log(after / now)"),
    "ratio: one over m": ("1 - 1 / m", "1 / m"),
    "ratio: multiplicity less one": ("1 - 1 / m", "1 - 1 / (m + 1)"),
    "ratio: always two thirds": ("1 - 1 / m", "2 / 3"),
}
