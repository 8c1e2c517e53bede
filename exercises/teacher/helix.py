r"""# Constant strain is a helix

If the strains are constant, $u = (u_1, u_2, u_3)$ and $v = (0, 0, 1)$ (so that $r' = d_3$ and $s$ is arclength), the centreline is a helix
[N 2.2, Exercise Session 1]: the triad turns about the fixed axis $u$ at the constant rate $|u|$.

Its curvature is $\kappa = |r''|$, its torsion $\tau$ the rate at which the plane of $r'$ and $r''$ turns about $r'$ (positive for a right-handed helix).

**Write**

1. `curvature_and_torsion(u)`: the pair $(\kappa, \tau)$, for `u` of shape (3,);
2. `radius_and_pitch(u)`: a pair, the radius of the cylinder that the helix lies on, and its pitch, the distance along the axis of two successive turns
   (with the sign of $\tau$; assume $\kappa > 0$);
3. `centreline(u, s)`: the points $r(s)$ for an array `s`, from $r(0) = 0$ with the triad at $s = 0$ equal to the fixed frame, shape (len(s), 3).
   Assume $u \ne 0$. You may use `scipy.linalg.expm`, or the formula of Rodrigues.
"""

# %% answer
import numpy as np


def curvature_and_torsion(u):
    """(kappa, tau)."""
    ### BEGIN SOLUTION
    return np.hypot(u[0], u[1]), u[2]
    ### END SOLUTION


def radius_and_pitch(u):
    """(radius, pitch)."""
    ### BEGIN SOLUTION
    kappa, tau = np.hypot(u[0], u[1]), u[2]
    square = kappa**2 + tau**2
    return kappa / square, 2 * np.pi * tau / square
    ### END SOLUTION


def centreline(u, s):
    """r(s), shape (len(s), 3)."""
    ### BEGIN SOLUTION
    rate = np.linalg.norm(u)
    axis, tangent = np.asarray(u) / rate, np.array([0.0, 0.0, 1.0])
    along = (axis @ tangent) * axis
    across, third = tangent - along, np.cross(axis, tangent)
    turn = rate * np.asarray(s)[:, None]
    return turn / rate * along + np.sin(turn) / rate * across + (1 - np.cos(turn)) / rate * third
    ### END SOLUTION


# %% checks
import numpy as np
from scipy.linalg import expm

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number, Parts

E3 = np.array([0.0, 0.0, 1.0])


def derivatives(u):
    """r', r'', r''' in the triad: each further one is u times (cross) the one before."""
    one = E3
    two = np.cross(u, one)
    return one, two, np.cross(u, two)


def of_frenet(u):
    one, two, three = derivatives(u)
    return np.linalg.norm(two), np.linalg.det([one, two, three]) / (two @ two)


def points(u, s):
    """By the exponential of the 4 x 4 matrix of the triad and the place."""
    big = np.zeros((4, 4))
    big[:3, :3], big[:3, 3] = np.cross(np.eye(3), u), E3
    return np.array([expm(t * big)[:3, 3] for t in s])


def cylinder(u):
    """From the helix itself: the largest distance of two points of it across the axis, and its advance in one turn."""
    rate = np.linalg.norm(u)
    axis = np.asarray(u) / rate
    half, whole = points(u, [np.pi / rate, 2 * np.pi / rate])
    across = half - (half @ axis) * axis
    return np.linalg.norm(across) / 2, (whole @ axis)


def bent(draw):
    for sign in (1, -1, 1):
        yield (np.append(draw.uniform(0.5, 2, size=2), sign * draw.uniform(0.5, 3)),)


def placed(draw):
    for (u,) in bent(draw):
        yield u, np.sort(draw.uniform(0, 5, size=6))


exercise = Exercise(
    title="Constant strain is a helix",
    source="N 2.2",
    questions=(
        Question(
            name="curvature_and_torsion",
            calls=bent,
            returns=Parts(Number(), Number()),
            properties=(
                holds("has the curvature |r''|", lambda value, u: abs(value[0] / of_frenet(u)[0] - 1), 1e-10),
                holds("has the torsion of r', r'', r'''", lambda value, u: abs(value[1] / of_frenet(u)[1] - 1), 1e-10),
            ),
            mistakes=(
                Mistake(
                    "length of the Darboux vector",
                    "r'' = d_3' = u x d_3: does the component of u along d_3 bend the centreline?",
                    lambda u: (np.linalg.norm(u), u[2]),
                ),
                Mistake(
                    "square root forgotten", "kappa is a length of r'', not its square.", lambda u: (u[0] ** 2 + u[1] ** 2, u[2])
                ),
                Mistake(
                    "torsion without sign",
                    "A left-handed helix has a torsion too: of which sign?",
                    lambda u: (np.hypot(u[0], u[1]), abs(u[2])),
                ),
                Mistake("interchanged", "Curvature first.", lambda u: (u[2], np.hypot(u[0], u[1]))),
            ),
            hint="r'' = u x d_3; which components of u are in it?",
        ),
        Question(
            name="radius_and_pitch",
            calls=bent,
            returns=Parts(Number(), Number()),
            properties=(
                holds("has the radius of the helix", lambda value, u: abs(value[0] / cylinder(u)[0] - 1), 1e-9),
                holds("has the pitch of the helix", lambda value, u: abs(value[1] / cylinder(u)[1] - 1), 1e-9),
            ),
            mistakes=(
                Mistake(
                    "radius of curvature",
                    "1/kappa is the radius of the cylinder only where the helix is a circle. Which quantity must vanish for that?",
                    lambda u: (1 / np.hypot(u[0], u[1]), 2 * np.pi * u[2] / (u @ u)),
                ),
                Mistake(
                    "2 pi forgotten",
                    "A turn is an angle of 2 pi.",
                    lambda u: (np.hypot(u[0], u[1]) / (u @ u), u[2] / (u @ u)),
                ),
                Mistake(
                    "arclength of a turn",
                    "2 pi / |u| is the length of one turn of the rod. How much of it goes along the axis?",
                    lambda u: (np.hypot(u[0], u[1]) / (u @ u), 2 * np.pi / np.linalg.norm(u)),
                ),
                Mistake(
                    "length for its square",
                    "Check the dimensions: u is one over a length.",
                    lambda u: (np.hypot(u[0], u[1]) / np.linalg.norm(u), 2 * np.pi * u[2] / np.linalg.norm(u)),
                ),
            ),
            hint="The triad turns about u once in the arclength 2 pi / |u|; the tangent makes a constant angle with u.",
        ),
        Question(
            name="centreline",
            calls=placed,
            returns=Array(lambda u, s: (len(s), 3)),
            properties=(equals(points, 1e-9, says="is the curve of this strain", points=2.0),),
            mistakes=(
                Mistake(
                    "turned the other way",
                    "Which way does the tangent turn at s = 0? r'' = u x d_3.",
                    lambda u, s: points(-np.asarray(u), s),
                ),
                Mistake(
                    "the tangent for the place",
                    "This is r'(s). Integrate it from 0 to s.",
                    lambda u, s: np.array([expm(t * np.cross(np.eye(3), u)) @ E3 for t in s]),
                ),
                Mistake(
                    "constant of integration",
                    "Where is your curve at s = 0, and where should it be?",
                    lambda u, s: points(u, s) - np.cross(u, E3) / (np.asarray(u) @ u),
                ),
                Mistake("transposed", "One point a row.", lambda u, s: points(u, s).T),
            ),
            hint="Split e_3 into its part along u, which stays, and its part across u, which turns; then integrate.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "curvature_and_torsion: length of the Darboux vector": (
        "return np.hypot(u[0], u[1]), u[2]",
        "return np.linalg.norm(u), u[2]",
    ),
    "curvature_and_torsion: square root forgotten": ("return np.hypot(u[0], u[1]), u[2]", "return u[0]**2 + u[1]**2, u[2]"),
    "curvature_and_torsion: torsion without sign": (
        "return np.hypot(u[0], u[1]), u[2]",
        "return np.hypot(u[0], u[1]), abs(u[2])",
    ),
    "curvature_and_torsion: interchanged": ("return np.hypot(u[0], u[1]), u[2]", "return u[2], np.hypot(u[0], u[1])"),
    "radius_and_pitch: radius of curvature": ("return kappa / square", "return 1 / kappa"),
    "radius_and_pitch: 2 pi forgotten": ("2 * np.pi * tau / square", "tau / square"),
    "radius_and_pitch: arclength of a turn": ("2 * np.pi * tau / square", "2 * np.pi / np.sqrt(square)"),
    "radius_and_pitch: length for its square": ("square = kappa**2 + tau**2", "square = np.sqrt(kappa**2 + tau**2)"),
    "centreline: turned the other way": ("np.cross(axis, tangent)", "np.cross(tangent, axis)"),
    "centreline: the tangent for the place": (
        "turn / rate * along + np.sin(turn) / rate * across + (1 - np.cos(turn)) / rate * third",
        "along + np.cos(turn) * across + np.sin(turn) * third",
    ),
    "centreline: constant of integration": ("(1 - np.cos(turn)) / rate", "-np.cos(turn) / rate"),
    "centreline: transposed": [
        ("return turn / rate * along", "return (turn / rate * along"),
        ("(1 - np.cos(turn)) / rate * third", "(1 - np.cos(turn)) / rate * third).T"),
    ],
}
