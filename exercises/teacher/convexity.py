r"""# Where the equilibrium is unique

The energy of a strut of length 1 at the load $\lambda$ [N 2.6, 2.8], with the angle $\phi(s)$ (radians), $\phi(0) = 0$, the stiffness
$K(s) > 0$ and the unstressed curvature $\hat u(s)$, and its second variation at $\phi$, for every $\eta$ with $\eta(0) = 0$, are

$$V = \int_0^1 \tfrac12 K (\phi' - \hat u)^2 + \lambda \cos\phi \; ds, \qquad
Q(\eta) = \int_0^1 K \eta'^2 - \lambda \cos\phi\; \eta^2 \; ds .$$

If $Q$ is positive at every $\phi$, then $V$ is strictly convex and has one critical point. Recall $\int \eta'^2 \ge (\pi^2/4) \int \eta^2$.

**Write**

1. `bound(K)`: the largest number such that this shows uniqueness for all $|\lambda|$ below it, whatever $\phi$ and $\hat u$; relative error at
   most $10^{-4}$. `K` is a smooth function of $s \in [0, 1]$ (a number or an array) with one minimum, inside or at an end;
2. `second_variation(phi, lam, K)`: the matrix $A$ of shape (n, n) with $Q(\eta) = \eta^T A \eta$ exactly, where the rod has $n$ links of
   length $h = 1/n$, `phi` and `K` of shape (n,) give the angle and the stiffness of each, constant on it, and $\eta$ is linear on each link,
   with the values $0, \eta_1, \dots, \eta_n$ at the ends. Below the bound it must be positive definite, as the rod is;
3. `end_moment(slope, lam, K)` for $\lambda < 0$, $\hat u = 0$, $K$ a number: the moment $K\phi'(1)$ of the solution of $K\phi'' + \lambda\sin\phi = 0$,
   $\phi(0) = 0$, $\phi'(0) =$ `slope`, relative error at most $10^{-6}$. Can it vanish, as it must at a free end, unless $\phi = 0$?
"""

# %% answer
import numpy as np
from scipy.integrate import solve_ivp


def bound(K):
    """The load below which convexity shows uniqueness, a number."""
    ### BEGIN SOLUTION
    return np.pi**2 / 4 * np.min(K(np.linspace(0.0, 1.0, 2001)))
    ### END SOLUTION


def second_variation(phi, lam, K):
    """The matrix of Q for links of constant angle and stiffness, an array of shape (n, n)."""
    ### BEGIN SOLUTION
    n = len(phi)
    h = 1 / n
    bend = np.array([[1.0, -1.0], [-1.0, 1.0]]) / h
    load = np.array([[2.0, 1.0], [1.0, 2.0]]) * h / 6
    A = np.zeros((n + 1, n + 1))
    for i in range(n):
        A[i : i + 2, i : i + 2] += K[i] * bend - lam * np.cos(phi[i]) * load
    return A[1:, 1:]
    ### END SOLUTION


def end_moment(slope, lam, K):
    """The moment K phi' at s = 1 of the solution that leaves phi = 0 with phi' = slope, a number."""
    ### BEGIN SOLUTION
    path = solve_ivp(
        lambda s, y: [y[1], -lam * np.sin(y[0]) / K], (0.0, 1.0), [0.0, slope], method="DOP853", rtol=1e-10, atol=1e-12
    )
    return K * path.y[1, -1]
    ### END SOLUTION


# %% checks
import mpmath
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number


def stiffnesses(draw):
    a, b, c = draw.uniform(0.6, 0.8), draw.uniform(2, 3), draw.uniform(0.4, 0.7)
    yield (Code(f"lambda s: {a} + {b} * (s - {c})**2"),)
    yield (Code(f"lambda s: {a} + {b} * np.exp(-{2 + c} * s)"),)


def euler(K):
    """The bound, from the least K on a grid that is made finer where it is least."""
    s = np.linspace(0.0, 1.0, 101)
    for _ in range(3):
        least = s[np.argmin(K(s))]
        s = np.linspace(max(least - s[1] + s[0], 0.0), min(least + s[1] - s[0], 1.0), 101)
    return (np.pi / 2) ** 2 * np.min(K(s))


def form(phi, lam, K, *, load=1.0, lumped=False):
    """The matrix of Q by polarisation, Q by Gauss's rule of two nodes a link (exact), or the trapezoidal rule if lumped."""
    n = len(phi)
    t = np.array([[0.0], [1.0]]) if lumped else (1 + np.array([[-1.0], [1.0]]) / np.sqrt(3)) / 2

    def Q(*modes):
        eta = np.append(0.0, np.sum(np.eye(n)[list(modes)], axis=0))
        within = eta[:-1] + t * np.diff(eta)
        return np.sum(K * np.diff(eta) ** 2) * n - load * lam * np.sum(np.cos(phi) * np.mean(within**2, axis=0)) / n

    return np.array([[(Q(i, j) - Q(i) - Q(j)) / 2 for j in range(n)] for i in range(n)])


def held(phi, lam, K):
    A = form(phi, lam, K)
    A[-1, -1] += K[-1] * len(phi)
    return A


def below(A, phi, lam, K):
    """By how much Q(eta) falls short of (1 - |lam| / bound) times the bending alone, at the worst eta."""
    L = np.linalg.cholesky(form(phi, 0.0, K))
    least = np.linalg.eigvalsh(np.linalg.solve(L, np.linalg.solve(L, A).T))[0]
    return max(0.0, 1 - abs(lam) / (np.pi**2 / 4 * np.min(K)) - least) + np.max(np.abs(A - A.T))


def links(draw):
    for n, sign in ((3, 1), (6, -1)):
        K = draw.uniform(1, 3, size=n)
        yield (
            draw.uniform(0.4, 1.2, size=n) * draw.choice([-1, 2], size=n),
            sign * draw.uniform(0.7, 0.95) * np.pi**2 / 4 * np.min(K),
            K,
        )


def shots(draw):
    for sign in (1, -1):
        yield sign * draw.uniform(0.8, 1.5), -draw.uniform(3, 7), draw.uniform(1.5, 2.5)


def moment(slope, lam, K):
    """Closed form: phi = 2 am(slope s / 2 | m), m = 4 lam / (K slope^2) < 0."""
    return K * slope * float(mpmath.ellipfun("dn", slope / 2, m=4 * lam / (K * slope**2)))


def linear(slope, lam, K):
    return K * slope * np.cosh(np.sqrt(-lam / K))


def pressed(slope, lam, K):
    """The same with lam > 0, where m > 1: dn(u | m) = cn(u sqrt(m) | 1/m)."""
    m = -4 * lam / (K * slope**2)
    return K * slope * float(mpmath.ellipfun("cn", np.sqrt(m) * slope / 2, m=1 / m))


exercise = Exercise(
    title="Where the equilibrium is unique",
    source="N 2.6, 2.8",
    imports=("numpy", "scipy.integrate"),
    questions=(
        Question(
            name="bound",
            calls=stiffnesses,
            returns=Number(),
            properties=(equals(euler, 1e-4, says="is what the inequality gives"),),
            mistakes=(
                Mistake(
                    "mean stiffness",
                    "Would it hold for an eta that bends only where the rod is soft?",
                    lambda K: np.pi**2 / 4 * np.mean(K((np.arange(2000) + 0.5) / 2000)),
                    within=2e-3,
                ),
                Mistake(
                    "both ends held",
                    "Which eta are admitted? Nothing is asked of eta(1).",
                    lambda K: 4 * euler(K),
                    within=1e-4,
                ),
                Mistake(
                    "square forgotten",
                    "Take K = 1: at which load does a straight strut buckle?",
                    lambda K: euler(K) / (np.pi / 2),
                    within=1e-4,
                ),
            ),
            hint="Bound Q below by the integral of eta^2 times a number: K by its least value, the cosine by 1 in size.",
        ),
        Question(
            name="second_variation",
            calls=links,
            returns=Array(lambda phi, *_: (len(phi), len(phi))),
            properties=(
                equals(form, 1e-11, says="gives Q(eta) for every eta that is linear on the links", points=1.5),
                holds("is symmetric and positive definite, as convexity wants", below, 1e-10, 0.5),
            ),
            mistakes=(
                Mistake(
                    "sign of the load",
                    "Differentiate lam cos(phi) twice by phi.",
                    lambda *given: form(*given, load=-1.0),
                ),
                Mistake(
                    "a link above the last",
                    "The end is free: how many links does eta_n bend?",
                    held,
                ),
                Mistake(
                    "load lumped at the joints",
                    "Where eta is linear, eta^2 is not: integrate it over a link exactly. Lumped, Q is no longer bounded as the rod's is.",
                    lambda *given: form(*given, lumped=True),
                ),
                Mistake(
                    "h forgotten",
                    "The load acts on the integral of eta^2 over a link: how does that depend on the link's length?",
                    lambda phi, lam, K: form(phi, lam, K, load=len(phi)),
                ),
            ),
            hint="A matrix of two rows for each link, in the values of eta at its ends; add them up and strike out eta_0 = 0.",
        ),
        Question(
            name="end_moment",
            calls=shots,
            returns=Number(),
            properties=(equals(moment, 1e-6, says="is the moment at the end"),),
            mistakes=(
                Mistake(
                    "sign of the load", "A strut under tension (lam < 0): does phi'' have the sign of phi, or the other?", pressed
                ),
                Mistake("linearised", "The sine is not its argument: the angle is not small at the end.", linear),
                Mistake(
                    "slope for moment", "The moment is not the slope: K is not 1.", lambda *given: moment(*given) / given[-1]
                ),
            ),
            hint="An initial value problem for (phi, phi'). K phi'^2/2 - lam cos(phi) is constant: what does it say when phi'(1) = 0?",
        ),
    ),
)

# %% proofs
GRID, PATH = "np.min(K(np.linspace(0.0, 1.0, 2001)))", "-lam * np.sin(y[0]) / K"
PROOFS = {
    "bound: mean stiffness": (GRID, "np.mean(K(np.linspace(0.0, 1.0, 2001)))"),
    "bound: both ends held": ("np.pi**2 / 4", "np.pi**2"),
    "bound: square forgotten": ("np.pi**2 / 4", "np.pi / 2"),
    "second_variation: sign of the load": ("bend - lam", "bend + lam"),
    "second_variation: a link above the last": ("    return A[1:, 1:]", "    A[n, n] += K[-1] / h\n    return A[1:, 1:]"),
    "second_variation: load lumped at the joints": ("[[2.0, 1.0], [1.0, 2.0]]", "[[3.0, 0.0], [0.0, 3.0]]"),
    "second_variation: h forgotten": ("* h / 6", "/ 6"),
    "end_moment: sign of the load": (PATH, "lam * np.sin(y[0]) / K"),
    "end_moment: linearised": (PATH, "-lam * y[0] / K"),
    "end_moment: slope for moment": ("return K * path", "return path"),
}
