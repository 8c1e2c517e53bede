r"""# The constitutive law and its inverse

The diagonal linear law of an elastic rod [N 2.4] gives the moment and the force in the body from the six strains,

$$m_i = K_i (u_i - \hat u_i), \qquad n_i = A_i (v_i - \hat v_i), \qquad i = 1, 2, 3 ,$$

with positive moduli: $K_1, K_2$ of bending, $K_3$ of twist, $A_1, A_2$ of shear, $A_3$ of extension. Here $\hat u, \hat v$ are the strains when
unstressed. The law is hyper-elastic: there is an energy density $W(u, v)$ with $m_i = \partial W/\partial u_i$, $n_i = \partial W/\partial v_i$.

A law that couples the strains is $\sigma = C (\varepsilon - \hat\varepsilon)$, where $\varepsilon = (u, v)$ and $\sigma = (m, n)$ have six entries and
$C$ is a symmetric matrix without negative eigenvalues. Is $\hat\varepsilon$ still the only unstressed state?

**Write**; all triples are arrays of shape (3,),

1. `density(u, v, K, A, u_hat, v_hat)`: $W$, a number, zero when unstressed;
2. `strains(m, n, K, A, u_hat, v_hat)`: the strains that have the given stresses, $u$ in the first row and $v$ in the second, shape (2, 3);
3. `unstressed(C)`: the dimension of the set of unstressed strains of the law with the matrix `C` of shape (6, 6), a whole number; 0 stands for
   $\hat\varepsilon$ alone.
"""

# %% answer
import numpy as np


def density(u, v, K, A, u_hat, v_hat):
    """The strain energy of the rod per length, a number."""
    ### BEGIN SOLUTION
    return np.sum(K * (u - u_hat) ** 2 + A * (v - v_hat) ** 2) / 2
    ### END SOLUTION


def strains(m, n, K, A, u_hat, v_hat):
    """The strains u and v, one a row, that have the moment m and the force n."""
    ### BEGIN SOLUTION
    return np.array([u_hat + m / K, v_hat + n / A])
    ### END SOLUTION


def unstressed(C):
    """The dimension of the set of strains without stress: 0 if there is one only."""
    ### BEGIN SOLUTION
    return 6 - int(np.linalg.matrix_rank(C, tol=1e-8))
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import complex_step, equals, holds
from rodlab.grading.values import Array, Number


def triples(draw):
    """u, v or m, n; K, A; u_hat, v_hat."""
    for _ in range(3):
        yield (
            *draw.normal(size=(2, 3)),
            draw.uniform(0.5, 3, size=3),
            draw.uniform(5, 9, size=3),
            *draw.uniform(0.5, 1.5, size=(2, 3)),
        )


def W(u, v, K, A, u_hat, v_hat, *, half=0.5):
    """As the work along the straight path of strains from the unstressed state."""
    return half * ((u - u_hat) @ np.diag(K) @ (u - u_hat) + (v - v_hat) @ np.diag(A) @ (v - v_hat))


def off_stress(value, m, n, *law):
    """How far the stresses, W's derivatives at the strains returned, are from the given ones."""
    found = complex_step(lambda strain: W(strain[:3], strain[3:], *law), value.ravel())
    given = np.concatenate([m, n])
    return np.max(np.abs(found - given)) / np.max(np.abs(given))


def inverted(m, n, K, A, u_hat, v_hat, *, sign=1.0, power=-1.0):
    return np.array([u_hat + sign * m * K**power, v_hat + sign * n * A**power])


def matrices(draw):
    """Of ranks 6, 5, 3 and 2 with whole eigenvalues, in a random basis: a coupled law without a zero in its matrix."""
    for rank in (6, 5, 3, 2):
        basis = np.linalg.qr(draw.normal(size=(6, 6)))[0][:, :rank]
        yield (basis * draw.uniform(1, 4, size=rank) @ basis.T,)


def null(C):
    return np.sum(np.linalg.eigvalsh(C) < 1e-6)


exercise = Exercise(
    title="The constitutive law and its inverse",
    source="N 2.4",
    questions=(
        Question(
            name="density",
            calls=triples,
            returns=Number(),
            properties=(equals(W, 1e-12, says="has the stresses as derivatives and is zero when unstressed"),),
            mistakes=(
                Mistake(
                    "factor one half",
                    "Differentiate your W by u_1: do you get m_1?",
                    lambda *given: W(*given, half=1.0),
                ),
                Mistake(
                    "unstressed strains forgotten",
                    "At which strains is your W least? A rod that is curved when unstressed stores nothing then.",
                    lambda u, v, K, A, *_: W(u, v, K, A, np.zeros(3), np.zeros(3)),
                ),
                Mistake(
                    "bending and twist alone",
                    "This is the energy of the inextensible, unshearable rod: here the strains v are free as well.",
                    lambda u, v, K, A, u_hat, v_hat: W(u, v_hat, K, A, u_hat, v_hat),
                ),
                Mistake(
                    "moduli interchanged",
                    "K belongs to the strains u, A to the strains v.",
                    lambda u, v, K, A, u_hat, v_hat: W(u, v, A, K, u_hat, v_hat),
                ),
            ),
            hint="Integrate m_i over u_i and n_i over v_i, from the unstressed strains on.",
        ),
        Question(
            name="strains",
            calls=triples,
            returns=Array((2, 3)),
            properties=(holds("has the given moment and force by the law", off_stress, 1e-11, 1.5),),
            mistakes=(
                Mistake(
                    "multiplied by the moduli",
                    "Does a stiffer rod strain more under the same stress? Solve the law for the strain.",
                    lambda *given: inverted(*given, power=1.0),
                ),
                Mistake(
                    "sign of the unstressed strains",
                    "Without stress the strains are the unstressed ones: are yours?",
                    lambda m, n, K, A, u_hat, v_hat: inverted(m, n, K, A, -u_hat, -v_hat),
                ),
                Mistake(
                    "unstressed strains forgotten",
                    "Your strains are those of a rod that is straight and without length when unstressed.",
                    lambda m, n, K, A, u_hat, v_hat: inverted(m, n, K, A, 0 * u_hat, 0 * v_hat),
                ),
                Mistake(
                    "sign of the stress",
                    "A positive moment makes its strain larger or smaller than the unstressed one?",
                    lambda *given: inverted(*given, sign=-1.0),
                ),
                Mistake(
                    "inextensible and unshearable",
                    "Here the rod gives way to a force: v is not v_hat.",
                    lambda m, n, K, A, u_hat, v_hat: inverted(m, 0 * n, K, A, u_hat, v_hat),
                ),
            ),
            hint="Six equations, each with one unknown.",
        ),
        Question(
            name="unstressed",
            calls=matrices,
            returns=Number(whole=True),
            properties=(equals(null, 0.0, says="counts the independent strains that cause no stress", points=1.5),),
            mistakes=(
                Mistake(
                    "rank for nullity",
                    "A matrix that can be inverted has one unstressed state: what do you return for it?",
                    lambda C: 6 - null(C),
                ),
                Mistake(
                    "zeros on the diagonal counted",
                    "In a coupled law a combination of strains can be free of stress where none of them is; and rounding makes zeros small.",
                    lambda C: np.sum(np.abs(np.diag(C)) < 1e-6),
                ),
                Mistake(
                    "one for every singular matrix",
                    "That C is singular says that there are more unstressed states, not how many.",
                    lambda C: np.minimum(null(C), 1),
                ),
            ),
            hint="Which strains does C map to zero? Mind rounding: an eigenvalue of 1e-16 stands for zero.",
        ),
    ),
)

# %% proofs
INVERSE = "[u_hat + m / K, v_hat + n / A]"
RANK = "6 - int(np.linalg.matrix_rank(C, tol=1e-8))"
PROOFS = {
    "density: factor one half": ("** 2) / 2", "** 2)"),
    "density: unstressed strains forgotten": [("(u - u_hat)", "u"), ("(v - v_hat)", "v")],
    "density: bending and twist alone": (" + A * (v - v_hat) ** 2", ""),
    "density: moduli interchanged": [("(K * (u", "(A * (u"), (" + A * (v", " + K * (v")],
    "strains: multiplied by the moduli": (INVERSE, "[u_hat + m * K, v_hat + n * A]"),
    "strains: sign of the unstressed strains": (INVERSE, "[m / K - u_hat, n / A - v_hat]"),
    "strains: unstressed strains forgotten": (INVERSE, "[m / K, n / A]"),
    "strains: sign of the stress": (INVERSE, "[u_hat - m / K, v_hat - n / A]"),
    "strains: inextensible and unshearable": (INVERSE, "[u_hat + m / K, v_hat]"),
    "unstressed: rank for nullity": (RANK, RANK.removeprefix("6 - ")),
    "unstressed: zeros on the diagonal counted": (RANK, "int(np.sum(np.diag(C) == 0))"),
    "unstressed: one for every singular matrix": (RANK, "int(np.linalg.matrix_rank(C, tol=1e-8) < 6)"),
}
