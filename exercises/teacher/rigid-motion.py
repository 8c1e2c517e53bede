r"""# Six strains fix a rod up to a rigid motion

The strains $u_i(s)$ and $v_i(s)$ are the components along the triad of the vectors in $d_i' = u \times d_i$ and $r' = v$ [N 2.2]. They say nothing about where
the rod is: place and triad at $s = 0$ are free, and everything else follows by integration. Here the strains are constant on pieces of equal length $h$,
so that the integration is exact.

Collect the triad as the matrix $R$ whose *columns* are $d_1, d_2, d_3$ in the fixed frame. Then $R' = R\, [u]$, where $[u]$ is the skew matrix with $[u]\,a =
u \times a$ for every $a$ and $u$ stands for the three components. Over a piece, $R(h) = R(0) \exp(h\,[u])$. Straight pieces, $u = 0$, occur.

**Write**

1. `turn(R, u, h)`: the matrix $R$ at the end of a piece, shape (3, 3);
2. `advance(R, u, v, h)`: the vector $r(h) - r(0)$ over a piece in the fixed frame, shape (3,);
3. `rod(u, v, h, r0, R0)`: for `u`, `v` of shape (n, 3), a piece a row, the places of the ends of all pieces, shape (n + 1, 3). The rod
   begins at `r0`, the first of them, with the matrix `R0`.

Then move `r0` and `R0` by a rotation and a translation, and see the whole rod move with them.
"""

# %% answer
import numpy as np
from scipy.linalg import expm


def turn(R, u, h):
    """R at the end of a piece, shape (3, 3)."""
    ### BEGIN SOLUTION
    skew = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    return R @ expm(h * skew)
    ### END SOLUTION


def advance(R, u, v, h):
    """r(h) - r(0) in the fixed frame, shape (3,)."""
    ### BEGIN SOLUTION
    skew = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    big = np.zeros((4, 4))
    big[:3, :3], big[:3, 3] = skew, v
    return R @ expm(h * big)[:3, 3]
    ### END SOLUTION


def rod(u, v, h, r0, R0):
    """The places of the ends of all pieces, shape (n + 1, 3)."""
    ### BEGIN SOLUTION
    places, R = [np.asarray(r0, dtype=float)], np.asarray(R0)
    for ui, vi in zip(u, v):
        places.append(places[-1] + advance(R, ui, vi, h))
        R = turn(R, ui, h)
    return np.array(places)
    ### END SOLUTION


# %% checks
import numpy as np
from scipy.linalg import expm

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds, together
from rodlab.grading.values import Array

NODES, WEIGHTS = np.polynomial.legendre.leggauss(10)


def rotation(u):
    """The rotation by the vector u, after Rodrigues."""
    angle = np.linalg.norm(u)
    if angle == 0.0:
        return np.eye(3)
    skew = np.cross(np.eye(3), np.asarray(u) / angle)
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def turned(R, u, h):
    return R @ rotation(h * np.asarray(u))


def moved(R, u, v, h):
    """By Gauss's rule for the integral of the triad."""
    return R @ sum(h * w / 2 * rotation(h * (1 + x) / 2 * np.asarray(u)) @ v for x, w in zip(NODES, WEIGHTS, strict=True))


def places(u, v, h, r0, R0, *, step=moved, turn=turned):
    r, R = [np.asarray(r0, dtype=float)], R0
    for ui, vi in zip(u, v, strict=True):
        r.append(r[-1] + step(R, ui, vi, h))
        R = turn(R, ui, h)
    return np.array(r)


def fails_if_straight(given):
    """No number where u = 0, and only there."""
    return all(np.any(np.isnan(np.array(value, dtype=float))) == (not np.any(arguments[1])) for arguments, value in given)


def not_rigid(calls):
    """Calls come in pairs: the second begins elsewhere, moved by Q and c."""
    far = []
    for one, two in zip(calls[::2], calls[1::2], strict=True):
        Q = two.arguments[4] @ one.arguments[4].T
        c = two.arguments[3] - Q @ one.arguments[3]
        there = one.value @ Q.T + c
        far.append(np.max(np.abs(two.value - there)) / np.max(np.abs(there)))
    return np.max(far)  # of numpy's: NaN stays NaN


def pieces(draw):
    for scale in (1, 1, 0):
        yield rotation(draw.normal(size=3)), scale * draw.normal(size=3), draw.uniform(0.3, 0.9)


def both(draw):
    for R, u, h in pieces(draw):
        yield R, u, np.append(0.3 * draw.normal(size=2), draw.uniform(0.8, 1.2)), h


def rods(draw):
    for _ in range(2):
        u, v = draw.normal(size=(5, 3)), [0, 0, 1] + 0.2 * draw.normal(size=(5, 3))
        r, R = draw.normal(size=3), rotation(draw.normal(size=3))
        yield u, v, 0.4, r, R
        Q = rotation(draw.normal(size=3))
        yield u, v, 0.4, Q @ r + draw.normal(size=3), Q @ R


exercise = Exercise(
    title="Six strains fix a rod up to a rigid motion",
    source="N 2.2",
    questions=(
        Question(
            name="turn",
            calls=pieces,
            returns=Array((3, 3)),
            properties=(
                equals(turned, 1e-12, says="is the triad at the end of the piece"),
                holds("is a rotation", lambda R, *_: np.max(np.abs(R @ R.T - np.eye(3))) + abs(np.linalg.det(R) - 1), 1e-12, 0.5),
            ),
            mistakes=(
                Mistake(
                    "turned about the fixed frame",
                    "The components u_i are along the triad. On which side of R does the exponential stand?",
                    lambda R, u, h: rotation(h * np.asarray(u)) @ R,
                ),
                Mistake(
                    "sign of the skew matrix",
                    "Apply your skew matrix to a vector: is it u x a or a x u?",
                    lambda R, u, h: turned(R, -u, h),
                ),
                Mistake(
                    "one step of Euler's method",
                    "Is your matrix a rotation? The columns must stay of unit length.",
                    lambda R, u, h: R @ (np.eye(3) + h * np.cross(np.eye(3), u)),
                ),
                Mistake(
                    "no axis where u = 0",
                    "Try u = 0, a piece that does not turn: what do you divide by?",
                    when=fails_if_straight,
                ),
                Mistake("h forgotten", "The rotation grows with the length of the piece.", lambda R, u, h: turned(R, u, 1.0)),
            ),
            hint="A matrix exponential of a skew matrix, on the right side of R.",
        ),
        Question(
            name="advance",
            calls=both,
            returns=Array((3,)),
            properties=(equals(moved, 1e-11, says="is the way from end to end of the piece", points=1.5),),
            mistakes=(
                Mistake(
                    "one step of Euler's method",
                    "This is h times r' at the start. The triad turns on the way.",
                    lambda R, u, v, h: h * R @ v,
                ),
                Mistake(
                    "components for the vector",
                    "r' has the components v_i along the triad: what has R to do with the vector in the fixed frame?",
                    lambda R, u, v, h: moved(np.eye(3), u, v, h),
                ),
                Mistake(
                    "triad at the end",
                    "Along the piece the triad goes from R(0) to R(h); yours is always the last.",
                    lambda R, u, v, h: h * turned(R, u, h) @ v,
                ),
                Mistake(
                    "divided by u = 0",
                    "A piece with u = 0 is straight: its way is simpler than that of the others, and your formula has no value for it.",
                    when=fails_if_straight,
                ),
                Mistake(
                    "inverse of the triad",
                    "Do the columns of R take components to vectors, or vectors to components?",
                    lambda R, u, v, h: moved(R.T, u, v, h),
                ),
            ),
            hint="Integrate R(t) v over the piece; the exponential of one matrix of size 4 does it at once.",
        ),
        Question(
            name="rod",
            calls=rods,
            returns=Array(lambda u, *_: (len(u) + 1, 3)),
            properties=(
                equals(places, 1e-10, says="is the rod of these strains", points=1.5),
                together("moves with its beginning as a rigid body", not_rigid, 1e-10, 0.5),
            ),
            mistakes=(
                Mistake("first place missing", "n pieces have n + 1 ends.", lambda *given: places(*given)[1:]),
                Mistake("begins at the origin", "The rod begins at r0.", lambda u, v, h, r0, R0: places(u, v, h, 0 * r0, R0)),
                Mistake(
                    "triad never turned",
                    "Every piece begins with the triad that the one before ended with.",
                    lambda *given: places(*given, turn=lambda R, u, h: R),
                ),
                Mistake(
                    "turned before it advances",
                    "Which triad does a piece begin with?",
                    lambda *given: places(*given, step=lambda R, u, v, h: moved(turned(R, u, h), u, v, h)),
                ),
            ),
            hint="Piece by piece: first the place with the triad at its beginning, then the triad.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "turn: turned about the fixed frame": ("R @ expm(h * skew)", "expm(h * skew) @ R"),
    "turn: sign of the skew matrix": ("R @ expm(h * skew)", "R @ expm(-h * skew)"),
    "turn: one step of Euler's method": ("R @ expm(h * skew)", "R @ (np.eye(3) + h * skew)"),
    "turn: no axis where u = 0": (
        "    return R @ expm(h * skew)",
        """    with np.errstate(invalid="ignore"):
        axis = skew / np.linalg.norm(u)
        angle = h * np.linalg.norm(u)
        return R @ (np.eye(3) + np.sin(angle) * axis + (1 - np.cos(angle)) * axis @ axis)""",
    ),
    "turn: h forgotten": ("R @ expm(h * skew)", "R @ expm(skew)"),
    "advance: one step of Euler's method": ("R @ expm(h * big)[:3, 3]", "h * R @ v"),
    "advance: components for the vector": ("R @ expm(h * big)[:3, 3]", "expm(h * big)[:3, 3]"),
    "advance: triad at the end": ("R @ expm(h * big)[:3, 3]", "h * turn(R, u, h) @ v"),
    "advance: divided by u = 0": (
        "    return R @ expm(h * big)[:3, 3]",
        """    with np.errstate(invalid="ignore"):
        axis, rate = skew / np.linalg.norm(u), np.linalg.norm(u)
        across, along = (1 - np.cos(h * rate)) / rate, h - np.sin(h * rate) / rate
        return R @ (h * np.eye(3) + across * axis + along * axis @ axis) @ v""",
    ),
    "advance: inverse of the triad": ("R @ expm(h * big)[:3, 3]", "R.T @ expm(h * big)[:3, 3]"),
    "rod: first place missing": ("np.array(places)", "np.array(places[1:])"),
    "rod: begins at the origin": ("[np.asarray(r0, dtype=float)]", "[np.zeros(3)]"),
    "rod: triad never turned": ("        R = turn(R, ui, h)\n", ""),
    "rod: turned before it advances": ("advance(R, ui, vi, h))", "advance(turn(R, ui, h), ui, vi, h))"),
}
