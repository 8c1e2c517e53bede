r"""# A fold to full precision

At a fold of the equilibria $f(z, \lambda) = 0$, $n$ equations with the symmetric Jacobian $J = \partial f/\partial z$, the load is extreme along
the branch and $J$ is singular [N 2.7]. Watching an eigenvalue of $J$ change its sign along a branch shows about where a fold is. For the digits one
solves the *extended system* of $2n + 1$ equations for the fold $z$, $\lambda$ and the null vector $v$,

$$f(z, \lambda) = 0, \qquad J(z, \lambda)\, v = 0, \qquad v \cdot v - 1 = 0 .$$

It is regular where $J$ is singular, so that Newton's method (a solver of SciPy will do, or derivatives of $J$ by differences) converges as usual.

**Write**

1. `nearest(A)`, the eigenvalue of the symmetric matrix `A` that is nearest to zero, with its sign, a number;
2. `extended(f, J, z, v, lam)`, the residual of the extended system, its three parts in this order, shape (2n + 1,), where the functions `f(z, lam)` and
   `J(z, lam)` return arrays of shapes $(n,)$ and $(n, n)$;
3. `fold(f, J, z, lam)`, the fold near the given angles `z` of shape (n,) and load: the pair `z, lam`, correct to at least eight digits.

The starts of the tests are within a few per cent of a fold. The systems are struts of one to three joints with angles in radians and, as a
test of the method, one equation of which the fold is that of Bratu's problem $u'' + \lambda e^u = 0$, at $\lambda = 3.51383\ldots$
"""

# %% answer
import numpy as np
from scipy.optimize import root


def nearest(A):
    """The eigenvalue of A nearest to zero."""
    ### BEGIN SOLUTION
    values = np.linalg.eigvalsh(A)
    return values[np.argmin(np.abs(values))]
    ### END SOLUTION


def extended(f, J, z, v, lam):
    """f, J v and v.v - 1, one after the other."""
    ### BEGIN SOLUTION
    return np.concatenate([f(z, lam), J(z, lam) @ v, [v @ v - 1]])
    ### END SOLUTION


def fold(f, J, z, lam):
    """z and lam of the fold near the given ones."""
    ### BEGIN SOLUTION
    n = len(z)
    values, vectors = np.linalg.eigh(J(z, lam))
    v = vectors[:, np.argmin(np.abs(values))]
    start = np.concatenate([z, v, [lam]])
    found = root(lambda x: extended(f, J, x[:n], x[n:-1], x[-1]), start, tol=1e-13).x
    return found[:n], found[-1]
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number, Parts

BRATU_F = Code("lambda z, lam: lam - 8*z**2/np.cosh(z)**2")
BRATU_J = Code("lambda z, lam: np.diag(16*z*(z*np.tanh(z) - 1)/np.cosh(z)**2)")
BRATU = 3.513830719125162


def strut(draw, n):
    """Equations of n joints with unit springs, k = h = 1, and a force by rest angles that lean to one side."""
    force = draw.uniform(0.02, 0.1, size=n)
    spring = f"(2*np.eye({n}) - np.eye({n}, k=1) - np.eye({n}, k=-1) - np.diag(np.eye({n})[-1]))"
    f = Code(f"lambda z, lam: {spring} @ z - lam*np.sin(z) - np.array({force.tolist()!r})")
    return f, Code(f"lambda z, lam: {spring} - lam*np.diag(np.cos(z))")


def near(draw, n):
    """A start near the first fold: Newton's method for the extended system from the cube root law, then disturbed."""
    f, J = strut(draw, n)
    values, vectors = np.linalg.eigh(J(np.zeros(n), 0.0))
    lam, mode = values[0], vectors[:, 0] * np.sign(vectors[0, 0])
    quartic, pushed = np.sum(mode**4), -mode @ f(np.zeros(n), 0.0)
    size = np.cbrt(3 * pushed / (lam * quartic))
    x = np.concatenate([-size * mode, mode, [lam * (1 + size**2 * quartic / 2)]])
    for _ in range(20):
        z, v, lam = x[:n], x[n:-1], x[-1]
        A, sine = J(z, lam), np.sin(z)
        top = np.hstack([A, np.zeros((n, n)), -sine[:, None]])
        middle = np.hstack([lam * np.diag(sine * v), A, -(np.cos(z) * v)[:, None]])
        last = np.concatenate([np.zeros(n), 2 * v, [0.0]])
        x = x - np.linalg.solve(np.vstack([top, middle, last]), np.concatenate([f(z, lam), A @ v, [v @ v - 1]]))
    return f, J, x[:n] * draw.uniform(1.01, 1.04), float(x[-1] * draw.uniform(1.01, 1.03))


def folds(draw):
    for n in (1, 2, 3):
        yield near(draw, n)
    yield BRATU_F, BRATU_J, np.array([1.2 * draw.uniform(1.01, 1.05)]), BRATU * draw.uniform(0.97, 0.99)


def states(draw):
    for n in (1, 2, 3):
        yield *strut(draw, n), draw.uniform(0.3, 1.0, size=n), draw.uniform(0.5, 1.0, size=n), draw.uniform(0.5, 2)


def symmetric(draw):
    for n, small in ((3, -0.3), (4, 0.2), (6, -0.1)):
        Q = np.linalg.qr(draw.normal(size=(n, n)))[0]
        values = np.concatenate([[small], -draw.uniform(1, 3, size=1), draw.uniform(1, 3, size=n - 2)])
        A = Q @ np.diag(values * draw.uniform(0.9, 1.1)) @ Q.T
        yield ((A + A.T) / 2,)


def by_inverse(A):
    """Nearest to zero is the largest of the inverse, by the power method."""
    x = np.ones(len(A)) + np.arange(len(A)) / 7
    for _ in range(200):
        x = np.linalg.solve(A, x)
        x = x / np.linalg.norm(x)
    return x @ A @ x


def system(f, J, z, v, lam):
    return np.array([*f(z, lam), *(J(z, lam) @ v), np.sum(v**2) - 1])


def is_near(found, f, J, z, lam):
    """Far is none of the folds that were asked for."""
    return np.max(np.abs(found[0] - z)) < 0.3 and abs(found[1] - lam) < 0.3


def off_equilibrium(found, f, J, z, lam):
    return np.max(np.abs(f(*found))) if is_near(found, f, J, z, lam) else np.nan


def off_singular(found, f, J, z, lam):
    return np.min(np.abs(np.linalg.eigvalsh(J(*found)))) if is_near(found, f, J, z, lam) else np.nan


def measured(property_, wanted):
    """True if a property holds of all values, or of none."""
    return lambda given: all((property_((np.array(v[0]), v[1]), *a) < 1e-7) == wanted for a, v in given)


exercise = Exercise(
    title="A fold to full precision",
    source="N 2.7",
    imports=("numpy", "scipy.optimize"),
    questions=(
        Question(
            name="nearest",
            calls=symmetric,
            returns=Number(),
            properties=(equals(by_inverse, 1e-8, says="is the inverse's largest, inverted"),),
            mistakes=(
                Mistake("least eigenvalue", "The least one may be far below zero.", lambda A: np.linalg.eigvalsh(A)[0]),
                Mistake(
                    "sign lost",
                    "Its sign tells on which side of the fold one is.",
                    lambda A: np.min(np.abs(np.linalg.eigvalsh(A))),
                ),
                Mistake("determinant", "That is the product of all eigenvalues.", np.linalg.det),
            ),
            hint="Compute all eigenvalues; which of them has the smallest absolute value?",
        ),
        Question(
            name="extended",
            calls=states,
            returns=Array(lambda f, J, z, v, lam: (2 * z.size + 1,)),
            properties=(equals(system, 1e-12, says="has the three parts"),),
            mistakes=(
                Mistake(
                    "Jacobian times the angles",
                    "Which vector does the Jacobian map to zero at a fold?",
                    lambda f, J, z, v, lam: system(f, J, z, v, lam) + np.concatenate([0 * z, J(z, lam) @ (z - v), [0.0]]),
                ),
                Mistake(
                    "normalisation without its right-hand side",
                    "The zero vector is a null vector of every matrix; which equation excludes it?",
                    lambda f, J, z, v, lam: system(f, J, z, v, lam) + np.append(0 * z, np.append(0 * v, 1.0)),
                ),
            ),
            hint="Three arrays, concatenated; the last has one entry.",
        ),
        Question(
            name="fold",
            calls=folds,
            returns=Parts(Array(lambda f, J, z, lam: z.shape), Number()),
            properties=(
                holds("is an equilibrium, and near", off_equilibrium, 1e-7),
                holds("has a singular Jacobian, and is near", off_singular, 1e-7, 2.0),
            ),
            mistakes=(
                Mistake(
                    "equilibrium but no fold",
                    "Evaluate the eigenvalue nearest to zero at your solution.",
                    when=lambda given: measured(off_equilibrium, True)(given) and not measured(off_singular, True)(given),
                ),
                Mistake(
                    "singular but no equilibrium",
                    "Insert your solution into f.",
                    when=lambda given: measured(off_singular, True)(given) and not measured(off_equilibrium, True)(given),
                ),
                Mistake(
                    "load first",
                    "In which order are the angles and the load wanted?",
                    when=lambda given: all(np.size(v[0]) == 1 and np.shape(v[1]) == a[2].shape for a, v in given),
                ),
            ),
            hint="Start v from the eigenvector of the eigenvalue nearest to zero, and give extended to a solver.",
        ),
    ),
)

# %% proofs
SYSTEM = "lambda x: extended(f, J, x[:n], x[n:-1], x[-1])"
PROOFS = {
    "nearest: least eigenvalue": ("values[np.argmin(np.abs(values))]\n    ###", "values[0]\n    ###"),
    "nearest: sign lost": ("values[np.argmin(np.abs(values))]\n    ###", "np.min(np.abs(values))\n    ###"),
    "nearest: determinant": ("values[np.argmin(np.abs(values))]\n    ###", "np.prod(values)\n    ###"),
    "extended: Jacobian times the angles": ("J(z, lam) @ v,", "J(z, lam) @ z,"),
    "extended: normalisation without its right-hand side": ("v @ v - 1", "v @ v"),
    "fold: equilibrium but no fold": (SYSTEM, "lambda x: np.concatenate([f(x[:n], x[-1]), x[n:-1] - v, [x[0] - z[0]]])"),
    "fold: singular but no equilibrium": (
        SYSTEM,
        "lambda x: np.concatenate([x[:n] - z * (1 + x[-1] - lam), J(x[:n], x[-1]) @ x[n:-1], [x[n:-1] @ x[n:-1] - 1]])",
    ),
    "fold: load first": ("found[:n], found[-1]", "found[-1], found[:n]"),
}
