r"""# Collocation of degree one

As a first-order system the strut with $\phi(0) = 0$, $m(1) = 0$ is [N 2.8.1]

$$\phi' = \hat u(s) + \frac{m}{K(s)}, \qquad m' = -\lambda \sin\phi .$$

Approximate $\phi$ and $m$ (angles in radians, moment) by continuous functions that are linear on each of $n$ intervals of length $h = 1/n$, and ask
for the equations at the *middle* of each interval, Gauss's point of degree one [N 2.8.2]. The unknowns are the values
$\phi_0, \dots, \phi_n$ and $m_0, \dots, m_n$ at $s_i = i h$: what results is a difference scheme.

**Write**

1. `residual(phi, m, lam, K, u_hat)`, for arrays `phi`, `m` of shape (n+1,) and functions `K`, `u_hat` of an array of arclengths: in each interval
   the derivative minus the right side, at its middle; shape (2, n), the first row for $\phi$, the second for $m$;
2. `eliminated(phi, lam)`, for $K = 1$, $\hat u = 0$: a scheme in $\phi$ only. Take the difference of the first equations of the two intervals at
   $s_i$, divide by $h$, and eliminate $m$ by the second equations: the left side of
   $(\phi_{i+1} - 2\phi_i + \phi_{i-1})/h^2 + \dots = 0$, $i = 1, \dots, n-1$, shape (n-1,);
3. `solve(lam, K, u_hat, n)`, the arrays $\phi$, $m$ for which all residuals and both ends' conditions vanish. ($\lambda$ is below the first
   buckling load: there is only one, and Newton's method finds it from the unstressed shape or from zero.)

Compare 2 with the scheme of the strut, $\dots + \lambda \sin\phi_i = 0$: at the inner points both are of second order; at the free end the strut's is not.
"""

# %% answer
import numpy as np
from scipy.optimize import root


def residual(phi, m, lam, K, u_hat):
    """The equations at the middle of each interval, an array of shape (2, n)."""
    ### BEGIN SOLUTION
    n = len(phi) - 1
    h = 1 / n
    s = (np.arange(n) + 0.5) * h
    angle, moment = (phi[1:] + phi[:-1]) / 2, (m[1:] + m[:-1]) / 2
    bend = np.diff(phi) / h - u_hat(s) - moment / K(s)
    balance = np.diff(m) / h + lam * np.sin(angle)
    return np.array([bend, balance])
    ### END SOLUTION


def eliminated(phi, lam):
    """The scheme in phi only at the inner points, for K = 1 and u_hat = 0, an array of shape (n - 1,)."""
    ### BEGIN SOLUTION
    force = lam * np.sin((phi[1:] + phi[:-1]) / 2)  # at the middle of each interval
    return np.diff(phi, 2) * (len(phi) - 1) ** 2 + (force[1:] + force[:-1]) / 2
    ### END SOLUTION


def solve(lam, K, u_hat, n):
    """phi and m at s_0, ..., s_n, two arrays of shape (n + 1,)."""

    ### BEGIN SOLUTION
    def ends(y):
        return np.append(0.0, y[:n]), np.append(y[n:], 0.0)

    found = root(lambda y: residual(*ends(y), lam, K, u_hat).ravel(), np.zeros(2 * n), tol=1e-12)
    return ends(found.x)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds, observed_order
from rodlab.grading.values import Array, Parts


def rows(phi, m, lam, K, u_hat, *, place=0.5, load=1.0, mean=0.5, ends=False):
    """Interval by interval, by the linear functions themselves."""
    n, found = len(phi) - 1, []
    for i in range(n):
        s = np.array([(i + place) / n])
        angle = phi[i] + place * (phi[i + 1] - phi[i])
        moment = (m[i] + place * (m[i + 1] - m[i])) * mean / 0.5
        sine = (np.sin(phi[i]) + np.sin(phi[i + 1])) / 2 if ends else np.sin(angle)
        bend = (phi[i + 1] - phi[i]) * n - u_hat(s)[0] - moment / K(s)[0]
        found.append([bend, (m[i + 1] - m[i]) * n + load * lam * sine])
    return np.array(found).T


def one_angle(phi, lam, part):
    """(phi_(i+1) - 2 phi_i + phi_(i-1))/h^2 + lam part(below, here, above)."""
    below, here, above = phi[:-2], phi[1:-1], phi[2:]
    return (above - 2 * here + below) * (phi.size - 1) ** 2 + lam * part(below, here, above)


def middle(below, here, above):
    return (np.sin((below + here) / 2) + np.sin((here + above) / 2)) / 2


def rod(draw):
    a, b, c = draw.uniform(1.2, 2), draw.uniform(0.3, 0.8), draw.uniform(0.4, 1.2)
    return Code(f"lambda s: {a:.4f} + {b:.4f} * s**2"), Code(f"lambda s: {c:.4f} + np.sin({a:.4f} * s)")


def arrays(draw):
    for n in (1, 2, 5):
        yield draw.uniform(-2, 2, size=n + 1), draw.normal(size=n + 1), draw.uniform(1, 5), *rod(draw)


def angles(draw):
    for n in (2, 3, 8):
        yield draw.uniform(-2, 2, size=n + 1), draw.uniform(30, 60)


def loads(draw):
    lam, given = draw.uniform(1.0, 2.3), rod(draw)
    for n in (4, 8, 16):
        yield lam, *given, n


def off_equations(value, lam, K, u_hat, n):
    return max(np.max(np.abs(rows(*value, lam, K, u_hat))), abs(value[0][0]), abs(value[1][-1]))


def integrated(lam, K, u_hat, bend, steps=200):
    """phi(1) and m(1) from the clamp with the moment `bend`, by Runge and Kutta's method."""
    y, h = np.array([0.0, bend]), 1 / steps

    def field(s, y):
        s = np.array([s])
        return np.array([u_hat(s)[0] + y[1] / K(s)[0], -lam * np.sin(y[0])])

    for i in range(steps):
        a = field(i * h, y)
        b = field((i + 0.5) * h, y + h / 2 * a)
        c = field((i + 0.5) * h, y + h / 2 * b)
        y = y + h / 6 * (a + 2 * b + 2 * c + field((i + 1) * h, y + h * c))
    return y


TIPS = {}


def tip(lam, K, u_hat):
    """The tip angle by shooting: the secant method for m(1) = 0."""
    key = (lam, K.text, u_hat.text)
    if key not in TIPS:
        (m0, m1), (f0, f1) = (0.0, 0.5), (integrated(lam, K, u_hat, m)[1] for m in (0.0, 0.5))
        for _ in range(12):
            if abs(f1) < 1e-12:
                break
            m0, m1, f0 = m1, m1 - f1 * (m1 - m0) / (f1 - f0), f1
            f1 = integrated(lam, K, u_hat, m1)[1]
        TIPS[key] = integrated(lam, K, u_hat, m1)[0]
    return TIPS[key]


def tip_error(value, lam, K, u_hat, n):
    return abs(value[0][-1] - tip(lam, K, u_hat))


def satisfies(**changed):
    """True if the values solve the equations of a mistaken scheme."""

    def found(given):
        off = [np.max(np.abs(rows(*map(np.array, value), *a[:-1], **changed))) for a, value in given]
        return max(off) < 1e-6

    return found


def other_end(given):
    return satisfies()(given) and all(abs(value[0][0]) < 1e-8 and abs(value[1][0]) < 1e-8 for _, value in given)


exercise = Exercise(
    title="Collocation of degree one",
    source="N 2.8.2",
    imports=("numpy", "scipy.optimize"),
    questions=(
        Question(
            name="residual",
            calls=arrays,
            returns=Array(lambda phi, *_: (2, phi.size - 1)),
            properties=(equals(rows, 1e-12, says="asks for the equations at the middles", points=1.5),),
            mistakes=(
                Mistake(
                    "sines averaged",
                    "What is the sine of the linear function at the middle? Not the mean of its ends' sines.",
                    lambda *given: rows(*given, ends=True),
                ),
                Mistake(
                    "left ends",
                    "You ask for the equations at the left end of each interval; where is Gauss's point?",
                    lambda *given: rows(*given, place=0.0),
                ),
                Mistake(
                    "sign of the load",
                    "With lam > 0 the straight rod buckles: m' has the sign opposite to the angle.",
                    lambda *given: rows(*given, load=-1.0),
                ),
                Mistake(
                    "sum for mean",
                    "At the middle m is the mean of its two ends' values.",
                    lambda *given: rows(*given, mean=1.0),
                ),
            ),
            hint="On an interval the derivative is a difference over h; at its middle a linear function is the mean of its ends.",
        ),
        Question(
            name="eliminated",
            calls=angles,
            returns=Array(lambda phi, lam: (phi.size - 2,)),
            properties=(
                equals(lambda phi, lam: one_angle(phi, lam, middle), 1e-11, says="is what is left without m", points=1.5),
            ),
            mistakes=(
                Mistake(
                    "the strut's scheme",
                    "This is the scheme of the notes' strut; here the sines stand at the middles of the intervals.",
                    lambda phi, lam: one_angle(phi, lam, lambda below, here, above: np.sin(here)),
                ),
                Mistake(
                    "sum for mean",
                    "Each of the two means of m has a factor one half: follow it.",
                    lambda phi, lam: one_angle(phi, lam, lambda *three: 2 * middle(*three)),
                ),
                Mistake(
                    "sines at the joints",
                    "Put the mean of the angles into the sine, not the angles themselves.",
                    lambda phi, lam: one_angle(
                        phi, lam, lambda below, here, above: (np.sin(below) + 2 * np.sin(here) + np.sin(above)) / 4
                    ),
                ),
            ),
            hint="The difference of two means of m is half the sum of the changes of m over the two intervals.",
        ),
        Question(
            name="solve",
            calls=loads,
            returns=Parts(Array(lambda lam, K, u_hat, n: (n + 1,)), Array(lambda lam, K, u_hat, n: (n + 1,))),
            properties=(
                holds("satisfies the equations and both ends", off_equations, 1e-6, 1.5),
                observed_order("has a tip of second order", lambda v, *a: 1 / a[-1], tip_error, 2.0, 0.25, 0.5),
            ),
            mistakes=(
                Mistake(
                    "left ends",
                    "Halve h: your error only halves. Where in the interval do you ask for the equations?",
                    when=satisfies(place=0.0),
                ),
                Mistake(
                    "sines averaged",
                    "This is the trapezoid's rule: it solves other equations than your residual should ask for.",
                    when=satisfies(ends=True),
                ),
                Mistake(
                    "both conditions at the clamp", "One condition belongs to the clamp, one to the free end.", when=other_end
                ),
            ),
            hint="2n equations; which 2n of the 2n + 2 values are unknown? Give them to Newton's method, or to scipy's root.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "residual: sines averaged": ("lam * np.sin(angle)", "lam * (np.sin(phi[1:]) + np.sin(phi[:-1])) / 2"),
    "residual: left ends": [
        ("(np.arange(n) + 0.5) * h", "np.arange(n) * h"),
        ("(phi[1:] + phi[:-1]) / 2, (m[1:] + m[:-1]) / 2", "phi[:-1], m[:-1]"),
    ],
    "residual: sign of the load": ("/ h + lam * np.sin(angle)", "/ h - lam * np.sin(angle)"),
    "residual: sum for mean": ("(m[1:] + m[:-1]) / 2", "m[1:] + m[:-1]"),
    "eliminated: the strut's scheme": ("(force[1:] + force[:-1]) / 2", "lam * np.sin(phi[1:-1])"),
    "eliminated: sum for mean": ("(force[1:] + force[:-1]) / 2", "force[1:] + force[:-1]"),
    "eliminated: sines at the joints": (
        "lam * np.sin((phi[1:] + phi[:-1]) / 2)  #",
        "lam * (np.sin(phi[1:]) + np.sin(phi[:-1])) / 2  #",
    ),
    "solve: left ends": [
        ("(np.arange(n) + 0.5) * h", "np.arange(n) * h"),
        ("(phi[1:] + phi[:-1]) / 2, (m[1:] + m[:-1]) / 2", "phi[:-1], m[:-1]"),
    ],
    "solve: sines averaged": ("lam * np.sin(angle)", "lam * (np.sin(phi[1:]) + np.sin(phi[:-1])) / 2"),
    "solve: both conditions at the clamp": ("np.append(y[n:], 0.0)", "np.append(0.0, y[n:])"),
}
