r"""# One step of Gauss collocation

To go from $y(t)$ to $y(t + h)$ for $y' = f(t, y)$, take a polynomial of degree $m = 2$ that starts at $y(t)$ and satisfies the equation at two
points $t + c_1 h$, $t + c_2 h$, Gauss's quadrature points of the interval [N 2.8.2]. With the slopes $k_1, k_2$ there, this is an implicit
Runge-Kutta method,

$$k_i = f \Bigl( t + c_i h, \; y + h \sum_{j=1}^{2} a_{ij} k_j \Bigr), \qquad y(t + h) \approx y + h (b_1 k_1 + b_2 k_2),$$

where $a_{ij} = \int_0^{c_i} \ell_j$, $b_j = \int_0^1 \ell_j$, and $\ell_1, \ell_2$ are the linear polynomials that are 1 at one of the points and 0 at the
other. The error after many steps is of order $2m = 4$.

**Write**

1. `tableau()`, the arrays $a$ of shape (2, 2), $b$ and $c$ of shape (2,), with $c_1 < c_2$;
2. `step(f, t, y, h)`, one step, an array of the shape of `y`, for a function `f(t, y)`
   that returns one too; solve for the slopes to an error below $10^{-9}$
   ($h$ is small enough for repeated substitution to converge quickly);
3. `integrate(f, y, end, n)`, the value at `t = end` after `n` equal steps from `y` at $t = 0$.
"""

# %% answer
import numpy as np


def tableau():
    """The coefficients a, b, c of Gauss's method with two points."""
    ### BEGIN SOLUTION
    off = np.sqrt(3) / 6
    a = np.array([[1 / 4, 1 / 4 - off], [1 / 4 + off, 1 / 4]])
    return a, np.array([1 / 2, 1 / 2]), np.array([1 / 2 - off, 1 / 2 + off])
    ### END SOLUTION


def step(f, t, y, h):
    """The value at t + h, an array of the shape of y."""
    ### BEGIN SOLUTION
    a, b, c = tableau()
    k = np.array([f(t, y), f(t, y)])
    for _ in range(60):
        k = np.array([f(t + c[i] * h, y + h * a[i] @ k) for i in range(2)])
    return y + h * b @ k
    ### END SOLUTION


def integrate(f, y, end, n):
    """The value at t = end after n steps from t = 0."""
    ### BEGIN SOLUTION
    h = end / n
    for i in range(n):
        y = step(f, i * h, y, h)
    return y
    ### END SOLUTION


# %% checks
import numpy as np
from numpy.polynomial import Polynomial, legendre

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds, observed_order
from rodlab.grading.values import Array, Parts

GAUSS = (legendre.leggauss(2)[0] + 1) / 2


def method(points):
    """a, b, c of the collocation at any two points, by integrating Lagrange's polynomials."""
    lagrange = [Polynomial.fromroots([q]) / (p - q) for p, q in (points, points[::-1])]
    a = [[one.integ()(c) for one in lagrange] for c in points]
    return np.array(a), np.array([one.integ()(1.0) for one in lagrange]), np.array(points)


def advanced(f, t, y, h, *, points=GAUSS, sweeps=80, clock=1.0):
    a, b, c = method(points)
    k = np.array([f(t, y)] * 2)
    for _ in range(sweeps):
        k = np.array([f(t + clock * c[i] * h, y + h * a[i] @ k) for i in range(2)])
    return y + h * b @ k


def midpoint(f, t, y, h):
    k = f(t, y)
    for _ in range(80):
        k = f(t + h / 2, y + h / 2 * k)
    return y + h * k


def nothing(draw):
    yield ()


def problems(draw):
    w, c = draw.uniform(1, 2), draw.uniform(0.5, 1.5)
    pendulum = Code(f"lambda t, y: np.array([y[1], -{w:.4f} * np.sin(y[0])])")
    yield pendulum, draw.uniform(0, 2), draw.uniform(0.5, 1.5, size=2), draw.uniform(0.2, 0.4)
    forced = Code(f"lambda t, y: np.array([np.cos({w:.4f} * t) - {c:.4f} * y[0] ** 2])")
    yield forced, draw.uniform(0.5, 1), draw.uniform(0.5, 1, size=1), draw.uniform(0.2, 0.4)
    turning = Code(f"lambda t, y: np.array([y[1] - y[2], {w:.4f} * t * y[2] - y[0], y[0] - {w:.4f} * t * y[1]])")
    yield turning, draw.uniform(0.5, 1), draw.normal(size=3), draw.uniform(0.15, 0.3)


def refined(draw):
    """y' = c (1 + t) y, y = y(0) exp(c (t + t^2/2))."""
    c, y, end = draw.uniform(1.3, 1.8), draw.uniform(0.7, 1.2, size=1), draw.uniform(1.0, 1.4)
    for n in (5, 10, 20):
        yield Code(f"lambda t, y: {c} * (1 + t) * y"), y, end, n


def exact(f, y, end):
    return y * np.exp(f(0.0, 1.0) * (end + end**2 / 2))


def error(value, f, y, end, n):
    return float(np.abs(value - exact(f, y, end))[0])


def walked(f, y, end, n, *, one=advanced, more=0, **changed):
    for i in range(n + more):
        y = one(f, i * end / n, y, end / n, **changed)
    return y


def at_zero(f, y, end, n):
    for _ in range(n):
        y = advanced(f, 0.0, y, end / n)
    return y


def off_tableau(value):
    """Simplifying conditions: b integrates t^0..t^3 over (0, 1), a integrates 1 and t up to each point."""
    a, b, c = value
    over = max(abs(b @ c**q - 1 / (q + 1)) for q in range(4))
    return max(over, *(np.max(np.abs(a @ c**q - c ** (q + 1) / (q + 1))) for q in range(2)), float(c[0] >= c[1]))


def like_tableau(points=GAUSS, transposed=False, scale=1.0):
    def given():
        a, b, c = method(points)
        return (a.T if transposed else a), b * scale, c

    return given


exercise = Exercise(
    title="One step of Gauss collocation",
    source="N 2.8.2",
    questions=(
        Question(
            name="tableau",
            calls=nothing,
            returns=Parts(Array((2, 2)), Array((2,)), Array((2,))),
            properties=(holds("integrates polynomials of degree 3, and linear ones to each point", off_tableau, 1e-12),),
            mistakes=(
                Mistake(
                    "interval from -1 to 1",
                    "Tables of Gauss's points are for the interval (-1, 1); a step goes from 0 to 1.",
                    when=lambda given: np.max(np.abs(np.array(given[0][1][2], dtype=float) - legendre.leggauss(2)[0])) < 1e-6,
                ),
                Mistake(
                    "a transposed",
                    "a_ij: i is the point, j the slope. What must the sum of each row be?",
                    like_tableau(transposed=True),
                ),
                Mistake(
                    "ends of the interval",
                    "Collocation at both ends is the trapezoid's rule, of second order: which points are Gauss's?",
                    like_tableau(np.array([0.0, 1.0])),
                ),
                Mistake("weights of sum two", "The weights integrate 1 over an interval of length 1.", like_tableau(scale=2.0)),
            ),
            hint="Map Gauss's points from (-1, 1) to (0, 1); the rest are integrals of two linear polynomials.",
        ),
        Question(
            name="step",
            calls=problems,
            returns=Array(lambda f, t, y, h: y.shape),
            properties=(equals(advanced, 1e-8, says="is the end of the collocating polynomial", points=2.0),),
            mistakes=(
                Mistake(
                    "slopes not solved for",
                    "The slopes occur on both sides: one substitution does not solve the equations.",
                    lambda *given: advanced(*given, sweeps=1),
                ),
                Mistake(
                    "Euler's step", "Your slopes are those at the beginning of the step.", lambda f, t, y, h: y + h * f(t, y)
                ),
                Mistake("one point only", "This is the midpoint rule, the method with one point; here are two.", midpoint),
                Mistake(
                    "time at the beginning",
                    "The right side depends on t too: at which times does the method ask for it?",
                    lambda *given: advanced(*given, clock=0.0),
                ),
            ),
            hint="Start with k = f(t, y) and substitute until the slopes stand still, or give the equations to a solver.",
        ),
        Question(
            name="integrate",
            calls=refined,
            returns=Array(lambda f, y, end, n: y.shape),
            properties=(
                observed_order("is of order 4 at the end", lambda v, f, y, end, n: end / n, error, 4.0, 0.2),
                equals(walked, 1e-7, says="is n steps of the method"),
            ),
            mistakes=(
                Mistake(
                    "one step too many", "After n steps of length end/n, where are you?", lambda *given: walked(*given, more=1)
                ),
                Mistake("one step too few", "How many steps lead from 0 to end?", lambda *given: walked(*given, more=-1)),
                Mistake("clock stands still", "Each step begins at another time; do yours all begin at t = 0?", at_zero),
                Mistake(
                    "of second order",
                    "Halving h divides your error by four only: is it the method of two points?",
                    lambda *given: walked(*given, one=midpoint),
                ),
            ),
            hint="Step i begins at i times end/n.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "tableau: interval from -1 to 1": ("np.array([1 / 2 - off, 1 / 2 + off])", "np.array([-2 * off, 2 * off])"),
    "tableau: a transposed": ("return a, np", "return a.T, np"),
    "tableau: ends of the interval": (
        "return a, np.array([1 / 2, 1 / 2]), np.array([1 / 2 - off, 1 / 2 + off])",
        "return np.array([[0, 0], [1 / 2, 1 / 2]]), np.array([1 / 2, 1 / 2]), np.array([0, 1])",
    ),
    "tableau: weights of sum two": ("a, np.array([1 / 2, 1 / 2])", "a, np.array([1, 1])"),
    "step: slopes not solved for": ("range(60)", "range(1)"),
    "step: Euler's step": ("return y + h * b @ k", "return y + h * f(t, y)"),
    "step: one point only": (
        "a, b, c = tableau()",
        "a, b, c = np.full((2, 2), 1 / 4), np.array([1 / 2, 1 / 2]), np.array([1 / 2, 1 / 2])",
    ),
    "step: time at the beginning": ("f(t + c[i] * h, y", "f(t, y"),
    "integrate: one step too many": ("for i in range(n)", "for i in range(n + 1)"),
    "integrate: one step too few": ("for i in range(n)", "for i in range(n - 1)"),
    "integrate: clock stands still": ("step(f, i * h, y, h)", "step(f, 0.0, y, h)"),
    "integrate: of second order": (
        "a, b, c = tableau()",
        "a, b, c = np.full((2, 2), 1 / 4), np.array([1 / 2, 1 / 2]), np.array([1 / 2, 1 / 2])",
    ),
}
