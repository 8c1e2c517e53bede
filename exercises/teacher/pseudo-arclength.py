r"""# Through a fold by pseudo-arclength

One imperfect joint [N 2.7, n = 1] is in equilibrium at the angle $\phi$ (radians) under the load $\lambda$ if

$$f(\phi, \lambda) = \phi - \beta - \lambda \sin\phi = 0 .$$

Its detached branch has a fold, where a continuation that prescribes the next load cannot go on. Treat both $\phi$ and $\lambda$ as
unknowns instead. At a point $x = (\phi, \lambda)$ of the curve let $t$ be a unit vector tangent to it, $\nabla f \cdot t = 0$. The next
point $x^+$ solves the two equations

$$f(x^+) = 0, \qquad t \cdot (x^+ - x) = \ell ,$$

by Newton's method from $x + \ell t$, where the given length $\ell$ is positive. Their Jacobian is nonsingular at a fold too.

**Write**

1. `tangent(phi, lam, previous)`, of the two unit tangents the one with $t \cdot$ `previous` $> 0$, shape (2,);
2. `step(phi, lam, beta, t, length)`, the next point $(\phi^+, \lambda^+)$ near the given one, shape (2,), for a unit tangent `t` of shape (2,);
3. `branch(phi, lam, beta, direction, length, count)`: the start and `count` more points, one a row, shape (count + 1, 2). Each step uses the tangent
   at its own point; the first one has a positive product with `direction` (shape (2,)), each other one with the tangent before.
"""

# %% answer
import numpy as np


def tangent(phi, lam, previous):
    """The unit tangent of the curve of equilibria that goes on in the direction previous."""
    ### BEGIN SOLUTION
    t = np.array([np.sin(phi), 1 - lam * np.cos(phi)])
    t = t / np.linalg.norm(t)
    return t if t @ np.asarray(previous) > 0 else -t
    ### END SOLUTION


def step(phi, lam, beta, t, length):
    """The next point (phi, lam)."""
    ### BEGIN SOLUTION
    x = np.array([phi, lam])
    new = x + length * np.asarray(t)
    for _ in range(30):
        residual = [new[0] - beta - new[1] * np.sin(new[0]), t @ (new - x) - length]
        jacobian = [[1 - new[1] * np.cos(new[0]), -np.sin(new[0])], t]
        new = new - np.linalg.solve(jacobian, residual)
    return new
    ### END SOLUTION


def branch(phi, lam, beta, direction, length, count):
    """The start and count more points of the branch, one a row."""
    ### BEGIN SOLUTION
    points, t = [np.array([phi, lam])], direction
    for _ in range(count):
        t = tangent(*points[-1], t)
        points.append(step(*points[-1], beta, t, length))
    return np.array(points)
    ### END SOLUTION


# %% checks
from itertools import pairwise

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import complex_step, equals, holds
from rodlab.grading.values import Array


def f(x, beta=0.0):
    return x[0] - beta - x[1] * np.sin(x[0])


def along(phi, lam, previous):
    normal = complex_step(f, np.array([phi, lam]))
    t = np.array([-normal[1], normal[0]]) / np.hypot(*normal)
    return t * np.sign(t @ previous)


def load(phi, beta):
    return (phi - beta) / np.sin(phi)


def points(draw):
    """Points of detached branches on both sides of their folds; both tangents of each occur."""
    for side, between in ((1, (0.1, 0.25)), (-1, (0.1, 0.25)), (1, (0.9, 1.5)), (-1, (0.9, 1.5))):
        phi = -draw.uniform(*between)
        lam = load(phi, draw.uniform(0.05, 0.1))
        yield phi, lam, along(phi, lam, np.array([0.0, side])) + draw.uniform(-0.2, 0.2, size=2)


def steps(draw):
    for between in ((0.2, 0.3), (0.45, 0.6), (1.0, 1.4)):
        phi, beta = -draw.uniform(*between), draw.uniform(0.05, 0.1)
        lam = load(phi, beta)
        yield phi, lam, beta, along(phi, lam, np.array([-1.0, 0.0])), draw.uniform(0.1, 0.2)


def starts(draw):
    for _ in range(2):
        beta = draw.uniform(0.05, 0.1)
        phi = -draw.uniform(1.0, 1.3) * beta
        yield phi, load(phi, beta), beta, np.array([0.0, -1.0]), draw.uniform(0.12, 0.16), 16


def off_curve(x, start, beta, length):
    """The residual, of a point that is not the start itself and not far away."""
    away = np.hypot(*np.subtract(x, start))
    return abs(f(x, beta)) if length / 2 < away < 3 * length else np.nan


def off_curves(rows, phi, lam, beta, direction, length, count):
    return np.max([off_curve(b, a, beta, length) for a, b in pairwise(rows)]) + np.max(np.abs(rows[0] - (phi, lam)))


def off_planes(rows, phi, lam, beta, direction, length, count):
    far, t = [], direction
    for a, b in pairwise(rows):
        t = along(*a, t)
        far.append(abs(t @ (b - a) - length))
    return np.max(far)


def through(rows, *given):
    """On the curve the angle goes on while the load turns: 0 if so."""
    loads = rows[:, 1]
    turned = loads.min() < min(loads[0], loads[-1]) - 0.2
    return float(not (np.all(np.diff(rows[:, 0]) < 0) and turned and off_curves(rows, *given) < 1e-6))


def always(equation):
    """True of values that all satisfy an equation of the point, the start, the tangent and the length."""
    return lambda given: all(abs(equation(np.array(v), np.array(a[:2]), a[3], a[4])) < 1e-8 for a, v in given)


def unoriented(given):
    rows = [(np.array(v), along(*a)) for a, v in given]
    return all(abs(abs(v @ t) - 1) < 1e-9 and abs(v @ v - 1) < 1e-9 for v, t in rows)


def turned_back(given):
    """True of rows on the curve that set out in the right direction and do not keep to it."""
    forward = [np.diff(np.array(v)[:, 0]) < 0 for _, v in given]
    return all(off_curves(np.array(v), *a) < 1e-8 and on[0] and not on.all() for (a, v), on in zip(given, forward, strict=True))


exercise = Exercise(
    title="Through a fold by pseudo-arclength",
    source="N 2.7",
    questions=(
        Question(
            name="tangent",
            calls=points,
            returns=Array((2,)),
            properties=(equals(along, 1e-9, says="is normal to the gradient (complex step), of length one, and goes on"),),
            mistakes=(
                Mistake("direction not kept", "Look at the sign of the product with the tangent before.", when=unoriented),
                Mistake(
                    "normal for tangent",
                    "The gradient of f is normal to the curve f = 0.",
                    lambda phi, lam, t: (lambda n: n / np.hypot(*n) * np.sign(n @ t))(complex_step(f, np.array([phi, lam]))),
                ),
                Mistake(
                    "length not one",
                    "Your vector has the right direction. How long is it?",
                    when=lambda given: all(abs(np.array(v) @ along(*a) / np.hypot(*v) - 1) < 1e-9 for a, v in given),
                ),
            ),
            hint="The gradient of f has two components; exchange them and change one sign.",
        ),
        Question(
            name="step",
            calls=steps,
            returns=Array((2,)),
            properties=(
                holds("is on the curve", lambda x, phi, lam, beta, t, length: off_curve(x, (phi, lam), beta, length), 1e-9),
                holds(
                    "is at the length along the tangent",
                    lambda x, phi, lam, beta, t, length: abs(t @ (x - (phi, lam)) - length),
                    1e-9,
                ),
            ),
            mistakes=(
                Mistake(
                    "predictor only",
                    "You went along the tangent; how far from the curve are you?",
                    lambda phi, lam, beta, t, length: np.array([phi, lam]) + length * t,
                ),
                Mistake(
                    "corrected at a fixed load",
                    "Your corrector moves the angle alone, and would fail near the fold. What is the second equation?",
                    when=always(lambda x, start, t, length: x[1] - start[1] - length * t[1]),
                ),
                Mistake(
                    "distance for projection",
                    "The second equation is linear: the projection of the step onto the tangent has the given length.",
                    when=always(lambda x, start, t, length: np.hypot(*(x - start)) - length),
                ),
            ),
            hint="Newton's method for two unknowns; the second row of the Jacobian is t.",
        ),
        Question(
            name="branch",
            calls=starts,
            returns=Array(lambda phi, lam, beta, t, length, count: (count + 1, 2)),
            properties=(
                holds("begins at the start and stays on the curve", off_curves, 1e-8),
                holds("goes on by the length along each tangent", off_planes, 1e-8),
                holds("passes the fold", through, 0.0),
            ),
            mistakes=(
                Mistake(
                    "turned back at the fold",
                    "Beyond the fold the load turns: with which earlier vector do you compare the tangent there?",
                    when=turned_back,
                ),
                Mistake(
                    "load prescribed",
                    "Your loads are equally spaced. What equilibria are there below the load of the fold?",
                    when=lambda given: all(
                        np.ptp(np.diff(np.array(v)[:, 1]) / a[4]) < 1e-9 < v[0][1] - v[1][1] for a, v in given
                    ),
                ),
            ),
            hint="A loop over the first two functions; keep the last tangent.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "tangent: direction not kept": ("return t if t @ np.asarray(previous) > 0 else -t", "return t"),
    "tangent: normal for tangent": ("[np.sin(phi), 1 - lam * np.cos(phi)]", "[1 - lam * np.cos(phi), -np.sin(phi)]"),
    "tangent: length not one": ("t = t / np.linalg.norm(t)", "t = 2 * t"),
    "step: predictor only": ("range(30)", "range(0)"),
    "step: corrected at a fixed load": [
        ("t @ (new - x) - length]", "new[1] - lam - length * t[1]]"),
        ("-np.sin(new[0])], t]", "-np.sin(new[0])], [0, 1]]"),
    ],
    "step: distance for projection": [
        ("t @ (new - x) - length]", "(new - x) @ (new - x) - length**2]"),
        ("-np.sin(new[0])], t]", "-np.sin(new[0])], 2 * (new - x)]"),
    ],
    "branch: turned back at the fold": ("tangent(*points[-1], t)", "tangent(*points[-1], direction)"),
    "branch: load prescribed": ("step(*points[-1], beta, t, length))", "points[-1] + [0, -length])"),
}
