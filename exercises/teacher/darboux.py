r"""# The Darboux vector

Three unit vectors $d_1(s), d_2(s), d_3(s)$, right-handed and perpendicular to each other at every $s$, have derivatives of the form

$$d_i' = u \times d_i$$

with one vector $u(s)$ for all three, the Darboux vector [N 2.2]. It exists because $d_i \cdot d_j$ does not change: write $d_i' = \sum_j c_{ij} d_j$,
differentiate, and see that $c$ is skew. Its components along the triad, $u_i = u \cdot d_i$, are the strains of bending ($u_1, u_2$) and twist
($u_3$).

A triad is given as an array `d` of shape (3, 3) whose *row* i holds the components of $d_i$ in a fixed frame, its derivative likewise as `d_prime`.

**Write**

1. `strain(d, d_prime)`: the components $u_i$ along the triad, shape (3,);
2. `darboux(d, d_prime)`: the vector $u$ itself by its components in the fixed frame, shape (3,);
3. `derivative(d, u)`: the derivatives $d_i'$, one a row, shape (3, 3), from the components $u_i$ along the triad.
"""

# %% answer
import numpy as np


def strain(d, d_prime):
    """The components u_i = u . d_i, shape (3,)."""
    ### BEGIN SOLUTION
    c = d_prime @ d.T
    return np.array([c[1, 2], c[2, 0], c[0, 1]])
    ### END SOLUTION


def darboux(d, d_prime):
    """The vector u in the fixed frame, shape (3,)."""
    ### BEGIN SOLUTION
    components = strain(d, d_prime)
    return components @ d
    ### END SOLUTION


def derivative(d, u):
    """The derivatives d_i', one a row, shape (3, 3)."""
    ### BEGIN SOLUTION
    vector = u @ d
    return np.cross(vector, d)
    ### END SOLUTION


# %% checks
import numpy as np
from scipy.linalg import expm

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array


def turned(u):
    """The rotation by the vector u."""
    return expm(np.cross(np.eye(3), u))


def triad(draw):
    Q = np.linalg.qr(draw.normal(size=(3, 3)))[0]
    return Q * np.linalg.det(Q)  # right-handed


def moving(draw):
    """A triad and its derivative, of a known vector in the fixed frame."""
    d, w = triad(draw), draw.normal(size=3)
    return d, np.array([np.cross(w, row) for row in d])


def true_vector(d, d_prime):
    """u = sum of d_i x d_i' / 2: no components of the triad are needed."""
    return sum(np.cross(a, b) for a, b in zip(d, d_prime, strict=True)) / 2


def rows(d, u):
    return np.array([np.cross(np.asarray(u) @ d, row) for row in d])


def not_turning(value, d, u):
    """Along a turning triad of this strain, by a central difference of rotations."""
    step = 1e-5
    ahead, behind = (turned(sign * step * (np.asarray(u) @ d)) @ d.T for sign in (1, -1))
    true = (ahead - behind).T / (2 * step)
    return np.max(np.abs(value - true)) / np.max(np.abs(true))


def moved(draw):
    for _ in range(4):
        yield moving(draw)


def strained(draw):
    for _ in range(4):
        yield triad(draw), draw.normal(size=3)


exercise = Exercise(
    title="The Darboux vector",
    source="N 2.2",
    questions=(
        Question(
            name="strain",
            calls=moved,
            returns=Array((3,)),
            properties=(
                holds(
                    "turns the triad as its derivative says",
                    lambda u, d, dp: np.max(np.abs(rows(d, u) - dp)) / np.max(np.abs(dp)),
                    1e-12,
                    2.0,
                ),
            ),
            mistakes=(
                Mistake(
                    "sign", "Put your u into u x d_i: does it give d_i' or its opposite?", lambda d, dp: -(d @ true_vector(d, dp))
                ),
                Mistake(
                    "components in the fixed frame",
                    "These are the components of u along the fixed frame. Along which vectors are u_1, u_2, u_3 asked for?",
                    true_vector,
                ),
                Mistake(
                    "counted twice",
                    "The sum over j and k meets every pair twice: what factor stands before it?",
                    lambda d, dp: 2 * (d @ true_vector(d, dp)),
                ),
                Mistake(
                    "rows for columns",
                    "The vectors d_i are the rows of d. Which of the two arrays is to be transposed?",
                    lambda d, dp: d.T @ true_vector(d.T, dp.T),
                ),
                Mistake(
                    "order of the components",
                    "u_1 turns d_2 towards d_3: which entry of d_i' . d_j is it?",
                    lambda d, dp: (d @ true_vector(d, dp))[::-1],
                ),
            ),
            hint="d_i' . d_j is an entry of a skew matrix; three of its entries are the u_i.",
        ),
        Question(
            name="darboux",
            calls=moved,
            returns=Array((3,)),
            properties=(equals(true_vector, 1e-12, says="is the Darboux vector"),),
            mistakes=(
                Mistake(
                    "components along the triad",
                    "These are the u_i. The vector is the sum of u_i d_i.",
                    lambda d, dp: d @ true_vector(d, dp),
                ),
                Mistake(
                    "every direction counted twice",
                    "d_i x d_i' is u without its part along d_i. Add the three: how often is each part of u in the sum?",
                    lambda d, dp: 2 * true_vector(d, dp),
                ),
                Mistake(
                    "the triad applied the wrong way",
                    "The sum of u_i d_i takes row i of d with u_i: is that d u or u d?",
                    lambda d, dp: d @ d @ true_vector(d, dp),
                ),
            ),
            hint="u is the sum of u_i d_i.",
        ),
        Question(
            name="derivative",
            calls=strained,
            returns=Array((3, 3)),
            properties=(holds("is the derivative of the turning triad", not_turning, 1e-8, 1.5),),
            mistakes=(
                Mistake("order of the cross product", "u x d_i, or d_i x u?", lambda d, u: -rows(d, u)),
                Mistake(
                    "components for the vector",
                    "A cross product is of two vectors in one frame: u_i are components along the triad, the rows of d along the fixed frame.",
                    lambda d, u: np.cross(u, d),
                ),
                Mistake("transposed", "One derivative a row.", lambda d, u: rows(d, u).T),
            ),
            hint="First the vector u in the fixed frame, then a cross product with each row.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "strain: sign": ("c[1, 2], c[2, 0], c[0, 1]", "c[2, 1], c[0, 2], c[1, 0]"),
    "strain: components in the fixed frame": (
        "np.array([c[1, 2], c[2, 0], c[0, 1]])",
        "np.array([c[1, 2], c[2, 0], c[0, 1]]) @ d",
    ),
    "strain: counted twice": ("np.array([c[1, 2], c[2, 0], c[0, 1]])", "2 * np.array([c[1, 2], c[2, 0], c[0, 1]])"),
    "strain: rows for columns": ("d_prime @ d.T", "d_prime.T @ d"),
    "strain: order of the components": ("c[1, 2], c[2, 0], c[0, 1]", "c[0, 1], c[2, 0], c[1, 2]"),
    "darboux: components along the triad": ("components @ d", "components"),
    "darboux: every direction counted twice": ("components @ d", "2 * components @ d"),
    "darboux: the triad applied the wrong way": ("components @ d", "d @ components"),
    "derivative: order of the cross product": ("np.cross(vector, d)", "np.cross(d, vector)"),
    "derivative: components for the vector": ("np.cross(vector, d)", "np.cross(u, d)"),
    "derivative: transposed": ("np.cross(vector, d)", "np.cross(vector, d).T"),
}
