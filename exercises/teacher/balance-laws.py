r"""# The balance laws in the body frame

A rod in space has the centreline $r(s)$ and a triad $d_i(s)$ with $r' = v$ and $d_i' = u \times d_i$ [N 2.2]. Without distributed loads the force $n$
and the moment $m$ that the part beyond $s$ exerts obey [N 2.3]

$$n' = 0, \qquad m' + r' \times n = 0 .$$

The constitutive law knows components along the triad: $n_i = n \cdot d_i$, $m_i = m \cdot d_i$, and likewise $u_i$, $v_i$. As the triad turns, the components of a
constant vector are not constant.

**Write**, for arrays of components of shape (3,),

1. `force_rate(n, u)`: the derivatives $n_i'$, shape (3,);
2. `moment_rate(n, m, u, v)`: the derivatives $m_i'$, shape (3,);
3. `invariants(n, m)`: the pair of two functions of the components that are constant along every such rod, whatever its constitutive law:
   $|n|^2$, and the product of the vectors $n$ and $m$ that is a number and stays the same.
"""

# %% answer
import numpy as np


def force_rate(n, u):
    """n_i', shape (3,)."""
    ### BEGIN SOLUTION
    return -np.cross(u, n)
    ### END SOLUTION


def moment_rate(n, m, u, v):
    """m_i', shape (3,)."""
    ### BEGIN SOLUTION
    turning = np.cross(u, m)
    return -turning - np.cross(v, n)
    ### END SOLUTION


def invariants(n, m):
    """Two numbers that do not depend on s."""
    ### BEGIN SOLUTION
    n, m = np.asarray(n), np.asarray(m)
    return n @ n, m @ n
    ### END SOLUTION


# %% checks
import numpy as np
from scipy.linalg import expm

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import holds, together
from rodlab.grading.values import Array, Number, Parts


def skew(u):
    return np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0.0]])


def in_space(n, m, u, v, s):
    """Components at s of a constant force and its moment, along a rod of constant strain: by its triad, not by a rate."""
    turn = expm(s * skew(u))  # columns: the triad at s in that at 0
    place = s * v if np.linalg.norm(u) == 0 else np.array([expm(t * skew(u)) @ v for t in s * NODES]).T @ (s * WEIGHTS)
    return turn.T @ n, turn.T @ (m - np.cross(place, n))


NODES, WEIGHTS = (lambda x, w: ((x + 1) / 2, w / 2))(*np.polynomial.legendre.leggauss(8))
STEP = 1e-4


def rates(n, m, u, v):
    ahead, behind = in_space(n, m, u, v, STEP), in_space(n, m, u, v, -STEP)
    return tuple((a - b) / (2 * STEP) for a, b in zip(ahead, behind, strict=True))


def off(value, true):
    return np.max(np.abs(value - true)) / np.max(np.abs(true))


def drift(calls):
    """Calls come in pairs: the same rod at two places; relative to the larger number, as m . n may nearly vanish."""
    pairs = zip(calls[::2], calls[1::2], strict=True)
    return np.max([off(np.array(two.value), np.array(one.value)) for one, two in pairs])  # of numpy's: NaN stays NaN


def forces(draw):
    for _ in range(3):
        yield draw.normal(size=3), draw.normal(size=3)


def states(draw):
    for _ in range(3):
        yield tuple(draw.normal(size=3) for _ in range(4))


def along(draw):
    for _ in range(3):
        n, m, u, v = (draw.normal(size=3) for _ in range(4))
        yield n, m
        yield in_space(n, m, u, v, 0.7)


exercise = Exercise(
    title="The balance laws in the body frame",
    source="N 2.3",
    questions=(
        Question(
            name="force_rate",
            calls=forces,
            returns=Array((3,)),
            properties=(
                holds(
                    "is the rate of a constant force's components",
                    lambda value, n, u: off(value, rates(n, 0 * n, u, 0 * n)[0]),
                    1e-6,
                ),
                holds(
                    "does not change the length of the force", lambda value, n, u: abs(value @ n) / np.linalg.norm(value), 1e-12
                ),
            ),
            mistakes=(
                Mistake(
                    "sign",
                    "The triad turns by u; how do the components of a vector that stays turn? Try n along d_1 and u along d_3.",
                    lambda n, u: np.cross(u, n),
                ),
                Mistake(
                    "constant components",
                    "The vector n is constant. Its components are taken along a triad that turns.",
                    lambda n, u: 0 * n,
                ),
                Mistake("product for cross product", "u x n, not the product of components.", lambda n, u: -u * n),
            ),
            hint="Differentiate n_i = n . d_i with n' = 0 and d_i' = u x d_i.",
        ),
        Question(
            name="moment_rate",
            calls=states,
            returns=Array((3,)),
            properties=(
                holds(
                    "is the rate of the moment's components",
                    lambda value, n, m, u, v: off(value, rates(n, m, u, v)[1]),
                    1e-6,
                    2.0,
                ),
            ),
            mistakes=(
                Mistake(
                    "turning of the triad forgotten",
                    "This is m' in space. Its components change also because the triad turns.",
                    lambda n, m, u, v: -np.cross(v, n),
                ),
                Mistake(
                    "moment of the force forgotten",
                    "m is not constant in space: n has a moment about the next point.",
                    lambda n, m, u, v: -np.cross(u, m),
                ),
                Mistake(
                    "sign of the moment of the force",
                    "The law has r' x n on the side of m'.",
                    lambda n, m, u, v: -np.cross(u, m) + np.cross(v, n),
                ),
                Mistake(
                    "sign of the turning",
                    "Without the moment of the force (v = 0) the moment is constant in space, as the force is. Compare with `force_rate`.",
                    lambda n, m, u, v: np.cross(u, m) - np.cross(v, n),
                ),
                Mistake(
                    "sign", "Both terms stand on the side of m' in the law.", lambda n, m, u, v: np.cross(u, m) + np.cross(v, n)
                ),
            ),
            hint="As for the force, with m' = -r' x n in the place of n' = 0.",
        ),
        Question(
            name="invariants",
            calls=along,
            returns=Parts(Number(), Number()),
            properties=(
                together("are the same at two places of a rod", drift, 1e-10),
                holds(
                    "are |n|^2 and the product of n and m",
                    lambda value, n, m: off(np.array(value), np.array([n @ n, m @ n])),
                    1e-10,
                ),
            ),
            mistakes=(
                Mistake(
                    "length for its square", "The square of the length is asked for.", lambda n, m: [np.linalg.norm(n), m @ n]
                ),
                Mistake(
                    "length of the moment",
                    "Is |m| constant? Differentiate m . m and look at what r' x n does to it.",
                    lambda n, m: [n @ n, m @ m],
                ),
                Mistake("order", "First |n|^2, then the product.", lambda n, m: [m @ n, n @ n]),
            ),
            hint="n is a constant vector; which product of m' with n vanishes?",
        ),
    ),
)

# %% proofs
PROOFS = {
    "force_rate: sign": ("return -np.cross(u, n)", "return np.cross(u, n)"),
    "force_rate: constant components": ("return -np.cross(u, n)", "return np.zeros(3)"),
    "force_rate: product for cross product": ("return -np.cross(u, n)", "return -u * n"),
    "moment_rate: turning of the triad forgotten": ("-turning - np", "-np"),
    "moment_rate: moment of the force forgotten": ("-turning - np.cross(v, n)", "-turning"),
    "moment_rate: sign of the moment of the force": ("-turning - np", "-turning + np"),
    "moment_rate: sign of the turning": ("-turning - np", "turning - np"),
    "moment_rate: sign": ("-turning - np.cross(v, n)", "turning + np.cross(v, n)"),
    "invariants: length for its square": ("return n @ n, m @ n", "return np.sqrt(n @ n), m @ n"),
    "invariants: length of the moment": ("return n @ n, m @ n", "return n @ n, m @ m"),
    "invariants: order": ("return n @ n, m @ n", "return m @ n, n @ n"),
}
