r"""# The elastica

The uniform strut (stiffness 1, length 1, clamped below, free above under the load $\lambda$) satisfies $\phi'' + \lambda \sin\phi = 0$, $\phi(0) = 0$,
$\phi'(1) = 0$ [N 2.6, 2.8.1]. Its first buckled branch, with the tip angle $\alpha = \phi(1)$ in radians, $0 < \alpha < \pi$, is known in
closed form. Multiply by $\phi'$ and integrate,

$$\tfrac12 \phi'^2 = \lambda (\cos\phi - \cos\alpha) ,$$

separate, and substitute $\sin(\phi/2) = k \sin\theta$ with $k = \sin(\alpha/2)$; what is left are the complete elliptic integrals

$$K(k) = \int_0^{\pi/2} \frac{d\theta}{\sqrt{1 - k^2 \sin^2\theta}}, \qquad E(k) = \int_0^{\pi/2} \sqrt{1 - k^2 \sin^2\theta} \, d\theta .$$

**Write**

1. `load(alpha)`, the load at which the tip angle is `alpha`, a number;
2. `tip(alpha)`, the place of the tip there, the two numbers $x(1) = \int_0^1 \sin\phi \, ds$ and $z(1) = \int_0^1 \cos\phi \, ds$;
3. `tip_angle(lam)`, the positive tip angle in radians at a load above $\pi^2/4$, a number.

For small angles the load must be $\frac{\pi^2}{4} (1 + \alpha^2/8 + \dots)$. (`scipy.special` and `mpmath` have both integrals; read which
argument they take.)
"""

# %% answer
import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk


def load(alpha):
    """The load of the first buckled branch at the tip angle alpha (radians)."""
    ### BEGIN SOLUTION
    return ellipk(np.sin(alpha / 2) ** 2) ** 2  # scipy's argument is k^2
    ### END SOLUTION


def tip(alpha):
    """The place x, z of the tip at the tip angle alpha."""
    ### BEGIN SOLUTION
    k = np.sin(alpha / 2)
    quarter = ellipk(k**2)
    return 2 * k / quarter, 2 * ellipe(k**2) / quarter - 1
    ### END SOLUTION


def tip_angle(lam):
    """The positive tip angle (radians) at the load lam."""
    ### BEGIN SOLUTION
    return brentq(lambda alpha: load(alpha) - lam, 0.0, np.pi - 1e-9, xtol=1e-13)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Number, Parts


def mean(a, b):
    """Gauss's arithmetic-geometric mean."""
    for _ in range(12):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return a


def quarter(k):
    return np.pi / 2 / mean(1.0, np.sqrt(1 - k**2))


def second(k, nodes=64):
    """E(k) by the midpoint rule, which is exact to rounding for a smooth periodic function."""
    theta = (np.arange(nodes) + 0.5) * np.pi / 2 / nodes
    return np.mean(np.sqrt(1 - k**2 * np.sin(theta) ** 2)) * np.pi / 2


def truth(alpha):
    return quarter(np.sin(alpha / 2)) ** 2


def integrated(alpha, steps=1000):
    """x(1) and z(1) by Runge and Kutta's method from the tip downwards."""
    lam, h = truth(alpha), 1 / steps

    def field(y):
        return np.array([-y[1], lam * np.sin(y[0]), np.sin(y[0]), np.cos(y[0])])

    y = np.array([alpha, 0.0, 0.0, 0.0])
    for _ in range(steps):
        a = field(y)
        b = field(y + h / 2 * a)
        c = field(y + h / 2 * b)
        y = y + h / 6 * (a + 2 * b + 2 * c + field(y + h * c))
    return y[2], y[3]


def off_small_angles(lam, alpha):
    """How far the load is from pi^2/4 (1 + alpha^2/8), in units of alpha^4; only small angles are looked at."""
    return abs(4 * lam / np.pi**2 - 1 - alpha**2 / 8) / alpha**4 if alpha < 0.3 else 0.0


def angles(draw):
    yield (draw.uniform(0.1, 0.2),)
    for between in ((0.3, 1), (1, 2), (2, 2.9)):
        yield (draw.uniform(*between),)


def far(draw):
    for between in ((0.5, 1), (1.2, 2), (2, 2.8)):
        yield (draw.uniform(*between),)


def loads(draw):
    for between in ((2.7, 3.5), (4, 6), (7, 20)):
        yield (draw.uniform(*between),)


def off_branch(alpha, lam):
    return abs(truth(alpha) / lam - 1) + (not 0 < alpha < np.pi)


def inverse(lam, function=truth, most=np.pi - 1e-9):
    """Bisection."""
    low, high = 0.0, most
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < lam else (low, middle)
    return low


def shape(alpha):
    k = np.sin(alpha / 2)
    return k, quarter(k), second(k)


exercise = Exercise(
    title="The elastica",
    source="N 2.8.1",
    imports=("numpy", "scipy.special", "scipy.optimize"),
    questions=(
        Question(
            name="load",
            calls=angles,
            returns=Number(),
            properties=(
                equals(truth, 1e-9, says="is the load at the tip angle", points=1.5),
                holds("begins at pi^2/4 with the curvature 1/8", off_small_angles, 0.02, 0.5),
            ),
            mistakes=(
                Mistake(
                    "modulus for parameter",
                    "Does your library take k or m = k^2? Compare ellipk(0.5) with the integral.",
                    lambda alpha: quarter(np.sqrt(np.sin(alpha / 2))) ** 2,
                ),
                Mistake(
                    "whole angle",
                    "The substitution has half the tip angle: what does your load do at alpha = pi/2?",
                    lambda alpha: quarter(np.sin(alpha)) ** 2,
                ),
                Mistake(
                    "square forgotten",
                    "For alpha = 0 the load must be pi^2/4; the integral of 1/sqrt(2 lam ...) is the length.",
                    lambda alpha: quarter(np.sin(alpha / 2)),
                ),
                Mistake(
                    "whole wave",
                    "From clamp to tip is a quarter of the wave, not half of it: this rod is held at both ends.",
                    lambda alpha: 4 * truth(alpha),
                ),
                Mistake(
                    "small angles only",
                    "This is only the beginning of the series: try an angle of 2.",
                    lambda alpha: np.pi**2 / 4 * (1 + alpha**2 / 8),
                ),
            ),
            hint="The length 1 is the integral of dphi/phi' from 0 to alpha; after the substitution it is K(k)/sqrt(lam).",
        ),
        Question(
            name="tip",
            calls=far,
            returns=Parts(Number(), Number()),
            properties=(equals(integrated, 1e-8, says="is where the equation integrated from the tip arrives", points=2.0),),
            mistakes=(
                Mistake(
                    "x and z interchanged",
                    "Which of the two is 1 for a straight rod?",
                    lambda alpha: integrated(alpha)[::-1],
                ),
                Mistake(
                    "modulus for parameter",
                    "Is the argument of your elliptic integrals k or m = k^2?",
                    lambda alpha: (
                        2 * np.sin(alpha / 2) / quarter(np.sin(alpha / 2) ** 0.5),
                        2 * second(np.sin(alpha / 2) ** 0.5, 2000) / quarter(np.sin(alpha / 2) ** 0.5) - 1,
                    ),
                ),
                Mistake(
                    "k squared in x",
                    "x is the integral of sin(phi) = 2 sin(phi/2) cos(phi/2): which power of k is left? Compare with small angles.",
                    lambda alpha: (integrated(alpha)[0] * np.sin(alpha / 2), integrated(alpha)[1]),
                ),
                Mistake(
                    "E / K only",
                    "cos(phi) = 1 - 2 sin^2(phi/2) = 2 (1 - k^2 sin^2(theta)) - 1: what is its mean along the rod?",
                    lambda alpha: (integrated(alpha)[0], (integrated(alpha)[1] + 1) / 2),
                ),
            ),
            hint="ds = dtheta / (sqrt(lam) sqrt(1 - k^2 sin^2(theta))); write sin(phi) and cos(phi) by half angles.",
        ),
        Question(
            name="tip_angle",
            calls=loads,
            returns=Number(),
            properties=(holds("is the angle at which load() is lam", off_branch, 1e-7),),
            mistakes=(
                Mistake("degrees", "Is your angle in radians?", lambda lam: np.degrees(inverse(lam))),
                Mistake(
                    "half the angle", "This is the angle with the sine k; the tip's is another one.", lambda lam: inverse(lam) / 2
                ),
                Mistake("modulus itself", "You found k; which tip angle belongs to it?", lambda lam: np.sin(inverse(lam) / 2)),
                Mistake(
                    "small angles only",
                    "At larger loads the rod bends further than the first term of the series says, or less? Solve for the load itself.",
                    lambda lam: np.sqrt(8 * (4 * lam / np.pi**2 - 1)),
                ),
            ),
            hint="load(alpha) grows from pi^2/4 to infinity: any safe method for one root between 0 and pi will do.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "load: modulus for parameter": ("ellipk(np.sin(alpha / 2) ** 2)", "ellipk(np.sin(alpha / 2))"),
    "load: whole angle": ("ellipk(np.sin(alpha / 2) ** 2)", "ellipk(np.sin(alpha) ** 2)"),
    "load: square forgotten": ("ellipk(np.sin(alpha / 2) ** 2) ** 2", "ellipk(np.sin(alpha / 2) ** 2)"),
    "load: whole wave": ("return ellipk(np.sin", "return 4 * ellipk(np.sin"),
    "load: small angles only": ("ellipk(np.sin(alpha / 2) ** 2) ** 2", "np.pi**2 / 4 * (1 + alpha**2 / 8)"),
    "tip: x and z interchanged": (
        "2 * k / quarter, 2 * ellipe(k**2) / quarter - 1",
        "2 * ellipe(k**2) / quarter - 1, 2 * k / quarter",
    ),
    "tip: modulus for parameter": [("quarter = ellipk(k**2)", "quarter = ellipk(k)"), ("ellipe(k**2)", "ellipe(k)")],
    "tip: k squared in x": ("return 2 * k / quarter", "return 2 * k**2 / quarter"),
    "tip: E / K only": ("2 * ellipe(k**2) / quarter - 1", "ellipe(k**2) / quarter"),
    "tip_angle: degrees": ("return brentq(", "return 180 / np.pi * brentq("),
    "tip_angle: half the angle": ("return brentq(", "return 0.5 * brentq("),
    "tip_angle: modulus itself": (
        "return brentq(lambda alpha: load(alpha) - lam, 0.0, np.pi - 1e-9, xtol=1e-13)",
        "return np.sin(brentq(lambda alpha: load(alpha) - lam, 0.0, np.pi - 1e-9, xtol=1e-13) / 2)",
    ),
    "tip_angle: small angles only": (
        "brentq(lambda alpha: load(alpha) - lam, 0.0, np.pi - 1e-9, xtol=1e-13)",
        "np.sqrt(8 * (4 * lam / np.pi**2 - 1))",
    ),
}
