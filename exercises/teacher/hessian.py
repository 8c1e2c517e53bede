r"""# The tridiagonal second derivative

The strut of $n$ joints [N 2.7] has the energy

$$V(\phi; \lambda) = \sum_{i=1}^n \tfrac12 k_i (\phi_i - \phi_{i-1} - \beta_i)^2 + \lambda h \sum_{i=1}^n \cos\phi_i, \qquad \phi_0 = \beta_0 = 0$$

(angles in radians), where $k_i$ is the stiffness of the spring at joint $i$, $h$ the length of a link and $\lambda$ the load. Its second derivative with respect to $\phi_1, \dots, \phi_n$ is symmetric and tridiagonal, because a spring connects
neighbours only, and it does not contain $\beta$. Two arrays hold all of it: the diagonal, of length $n$, and the entries
$(i, i + 1)$ beside it, of length $n - 1$. Nothing in a computation with it has to be larger than these.

**Write**

1. `hessian(phi, lam, k, h)` for arrays `phi` and `k` of shape (n,), which returns the pair `diagonal, off_diagonal` of shapes $(n,)$ and
   $(n - 1,)$; for $n = 1$ the second is empty;
2. `product(diagonal, off_diagonal, v)`, the matrix of these two arrays times the vector $v$, shape $(n,)$, without forming the matrix:
   it has to work for $n = 10^5$;
3. `second_variation(phi, lam, k, h, v)`, for `v` of shape (n,) the number $v \cdot V'' v$, which decides whether $V$ rises or falls from $\phi$ in the direction $v$.
"""

# %% answer
import numpy as np


def hessian(phi, lam, k, h):
    """The diagonal and the entries beside it of the second derivative of V."""
    ### BEGIN SOLUTION
    above = np.append(k[1:], 0.0)  # no spring above the last link
    return k + above - lam * h * np.cos(phi), -k[1:]
    ### END SOLUTION


def product(diagonal, off_diagonal, v):
    """The symmetric tridiagonal matrix times v."""
    ### BEGIN SOLUTION
    result = diagonal * v
    result[:-1] += off_diagonal * v[1:]
    result[1:] += off_diagonal * v[:-1]
    return result
    ### END SOLUTION


def second_variation(phi, lam, k, h, v):
    """v . V'' v at the angles phi."""
    ### BEGIN SOLUTION
    return v @ product(*hessian(phi, lam, k, h), v)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import complex_jacobian, equals, holds
from rodlab.grading.values import Array, Number, Parts


def gradient(phi, lam, k, h):
    """Without rest angles, which are constants in it."""
    moment = k * np.diff(np.append(0.0, phi))
    return moment - np.append(moment[1:], 0.0) - lam * h * np.sin(phi)


def arrays(phi, lam, k, h, *, end=0.0, load=1.0, beside=slice(1, None)):
    diagonal = k + np.append(k[1:], end) - load * lam * h * np.cos(phi)
    return diagonal, -k[beside]


def full(diagonal, beside):
    return np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1)


def off_jacobian(found, phi, lam, k, h):
    true = complex_jacobian(gradient, phi, lam, k, h)
    return np.max(np.abs(full(*found) - true)) / np.max(np.abs(true))


def off_beside(found, phi, lam, k, h):
    true = complex_jacobian(gradient, phi, lam, k, h)
    return np.max(np.abs(found[1] - np.diag(true, 1)), initial=0.0) / np.max(k)


def struts(draw):
    for n in (2, 5, 9, 1):
        yield draw.uniform(0.3, 1.2, size=n), draw.uniform(4, 9), draw.uniform(1, 3, size=n), draw.uniform(0.2, 0.9)


def directions(draw):
    for phi, lam, k, h in struts(draw):
        yield phi, lam, k, h, draw.normal(size=phi.size)


def matrices(draw):
    for n in (2, 6, 20_000):
        yield draw.normal(size=n), draw.uniform(1, 2, size=n - 1), draw.uniform(1, 2, size=n)


def times(diagonal, beside, v):
    """Row by row: three terms where there are three."""
    lower, upper = np.append(0.0, beside), np.append(beside, 0.0)
    return diagonal * v + lower * np.append(0.0, v[:-1]) + upper * np.append(v[1:], 0.0)


def second(phi, lam, k, h, v):
    """The derivative of the gradient along v, times v."""
    return v @ np.imag(gradient(phi + 1e-30j * v, lam, k, h)) / 1e-30


exercise = Exercise(
    title="The tridiagonal second derivative",
    source="N 2.7",
    questions=(
        Question(
            name="hessian",
            calls=struts,
            returns=Parts(Array(lambda phi, *_: phi.shape), Array(lambda phi, *_: (phi.size - 1,))),
            properties=(
                holds("is right beside the diagonal", off_beside, 1e-12, 0.5),
                holds("is the gradient's derivative (complex steps)", off_jacobian, 1e-12, 1.5),
            ),
            mistakes=(
                Mistake(
                    "a spring above the last link",
                    "The upper end is free: which springs does phi_n stretch?",
                    lambda phi, lam, k, h: arrays(phi, lam, k, h, end=k[-1]),
                ),
                Mistake(
                    "spring of the wrong joint beside the diagonal",
                    "Links i and i + 1 are connected by the spring of which joint? Try n = 2 with two different springs.",
                    lambda phi, lam, k, h: arrays(phi, lam, k, h, beside=slice(None, -1)),
                ),
                Mistake(
                    "sign beside the diagonal",
                    "Differentiate (phi_2 - phi_1)^2 with respect to both angles.",
                    lambda phi, lam, k, h: (arrays(phi, lam, k, h)[0], k[1:]),
                ),
                Mistake(
                    "sign of the load",
                    "A load that presses makes the straight strut softer. Does it in your diagonal?",
                    lambda *given: arrays(*given, load=-1.0),
                ),
                Mistake(
                    "sine for cosine",
                    "The gradient has a sine; it is differentiated once more.",
                    lambda phi, *rest: arrays(np.pi / 2 - phi, *rest),
                ),
                Mistake(
                    "h forgotten",
                    "A link has the length h: where does it enter V?",
                    lambda phi, lam, k, h: arrays(phi, lam, k, 1.0),
                ),
            ),
            hint="Each angle meets itself in two springs (the last in one) and in a cosine, and each neighbour in one spring.",
        ),
        Question(
            name="product",
            calls=matrices,
            returns=Array(lambda diagonal, *_: diagonal.shape),
            properties=(equals(times, 1e-11, says="is the matrix times the vector"),),
            mistakes=(
                Mistake(
                    "upper half only",
                    "Your matrix is triangular. Where are the entries below the diagonal?",
                    lambda d, e, v: d * v + np.append(e * v[1:], 0.0),
                ),
                Mistake(
                    "neighbours shifted against their entries",
                    "Entry (i, i + 1) multiplies v_{i+1} in row i. Compare with the full matrix for n = 2.",
                    lambda d, e, v: d * v + np.append(e * v[:-1], 0.0) + np.append(0.0, e * v[1:]),
                ),
            ),
            hint="Three products of arrays: the diagonal with v, and the other array with v shifted up and shifted down.",
            seconds=5.0,
        ),
        Question(
            name="second_variation",
            calls=directions,
            returns=Number(),
            properties=(equals(second, 1e-9, says="is the second derivative along v (complex step)"),),
            mistakes=(
                Mistake(
                    "each pair of neighbours once",
                    "A symmetric matrix has each entry beside the diagonal twice.",
                    lambda phi, lam, k, h, v: second(phi, lam, k, h, v) + np.sum(k[1:] * v[1:] * v[:-1]),
                ),
            ),
            hint="Use the first two functions and a scalar product.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "hessian: a spring above the last link": ("np.append(k[1:], 0.0)", "np.append(k[1:], k[-1])"),
    "hessian: spring of the wrong joint beside the diagonal": ("-k[1:]", "-k[:-1]"),
    "hessian: sign beside the diagonal": ("-k[1:]", "k[1:]"),
    "hessian: sign of the load": ("- lam * h", "+ lam * h"),
    "hessian: sine for cosine": ("np.cos(phi)", "np.sin(phi)"),
    "hessian: h forgotten": ("- lam * h *", "- lam *"),
    "product: upper half only": ("    result[1:] += off_diagonal * v[:-1]\n", ""),
    "product: neighbours shifted against their entries": [
        ("result[:-1] += off_diagonal * v[1:]", "result[:-1] += off_diagonal * v[:-1] "),
        ("result[1:] += off_diagonal * v[:-1]\n", "result[1:] += off_diagonal * v[1:]\n"),
    ],
    "second_variation: each pair of neighbours once": (
        "return v @ product(*hessian(phi, lam, k, h), v)",
        "d, e = hessian(phi, lam, k, h)\n    return np.sum(d * v**2) + np.sum(e * v[1:] * v[:-1])",
    ),
}
