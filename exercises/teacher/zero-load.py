r"""# The strut without load

At $\lambda = 0$ no force and no moment acts in the planar rod, and its shape is given by integrals [N 2.6]. Let $s \in [0, 1]$ be arclength,
$\phi(s)$ the angle of the rod from the vertical $e_3$ (radians, positive clockwise, that is, towards $e_1$), $\hat u(s)$ its curvature when
unstressed, and $\phi_0$ the angle at the clamp, which stands at $x = z = 0$. Then

$$\phi' = \hat u, \quad \phi(0) = \phi_0, \qquad x' = \sin\phi, \quad z' = \cos\phi, \quad x(0) = z(0) = 0 .$$

The stiffness does not enter. When $\hat u$ is a constant $c \ne 0$ the rod is an arc of a circle of radius $1/|c|$.

**Write**, with a relative error of at most $10^{-7}$,

1. `angle(s, u_hat, phi_0)`: $\phi$ at each entry of the array `s` of shape (k,), ascending in $[0, 1]$; the same shape. `u_hat` is a
   function of one argument, a number or an array; it is smooth;
2. `tip(u_hat, phi_0)`: the pair $(x, z)$ at $s = 1$;
3. `centre(c, phi_0)`: the pair $(x, z)$ of the centre of the circle for $\hat u = c$, of either sign.
"""

# %% answer
import numpy as np
from scipy.integrate import quad


def angle(s, u_hat, phi_0):
    """phi at the arclengths s (shape (k,)), radians, an array of shape (k,)."""
    ### BEGIN SOLUTION
    return np.array([phi_0 + quad(u_hat, 0.0, end, epsabs=1e-12)[0] for end in s])
    ### END SOLUTION


def tip(u_hat, phi_0):
    """The place (x, z) of the end s = 1."""
    ### BEGIN SOLUTION
    nodes, weights = np.polynomial.legendre.leggauss(24)
    phi = angle((nodes + 1) / 2, u_hat, phi_0)
    return weights @ np.sin(phi) / 2, weights @ np.cos(phi) / 2
    ### END SOLUTION


def centre(c, phi_0):
    """The centre (x, z) of the circle that a rod of constant curvature c is part of."""
    ### BEGIN SOLUTION
    radius = 1 / c
    return radius * np.cos(phi_0), -radius * np.sin(phi_0)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array

PANELS = 64
GAUSS = np.sqrt(3 / 5) * np.array([-1.0, 0.0, 1.0]), np.array([5.0, 8.0, 5.0]) / 9


def integral(f, start, end):
    """Of f from each start to each end: Gauss's rule of three nodes on 64 panels."""
    start, end = np.broadcast_arrays(np.asarray(start, float), np.asarray(end, float))
    width = (end - start)[..., None, None] / PANELS
    nodes = start[..., None, None] + width * (np.arange(PANELS)[:, None] + (GAUSS[0] + 1) / 2)
    return np.sum(width * GAUSS[1] / 2 * f(nodes), axis=(-1, -2))


def phi_at(s, u_hat, phi_0):
    return phi_0 + integral(u_hat, 0.0, s)


def place(u_hat, phi_0):
    x = integral(lambda s: np.sin(phi_at(s, u_hat, phi_0)), 0.0, 1.0)
    z = integral(lambda s: np.cos(phi_at(s, u_hat, phi_0)), 0.0, 1.0)
    return np.array([x, z])


def curvature(draw):
    """A curvature that is positive, generic, and nowhere nearly constant."""
    a, b, w = draw.uniform(0.8, 1.2), draw.uniform(0.3, 0.6), draw.uniform(2, 4)
    return Code(f"lambda s: {a} + {b} * np.sin({w} * s) + s**2")


def angles(draw):
    for _ in range(3):
        yield np.sort(draw.uniform(0.15, 0.9, size=5)), curvature(draw), draw.uniform(0.2, 0.6)


def shapes(draw):
    for _ in range(2):
        yield curvature(draw), draw.uniform(0.2, 0.6)


def circles(draw):
    for sign in (1, -1, 1):
        yield sign * draw.uniform(1.5, 3), draw.uniform(0.2, 0.6)


def off_circle(value, c, phi_0):
    """How far points of the arc are from lying at distance 1/|c|."""
    s = np.linspace(0.0, 1.0, 9)
    x, z = integral(lambda t: np.sin(phi_0 + c * t), 0.0, s), integral(lambda t: np.cos(phi_0 + c * t), 0.0, s)
    return np.max(np.abs(np.hypot(x - value[0], z - value[1]) * abs(c) - 1))


exercise = Exercise(
    title="The strut without load",
    source="N 2.6",
    imports=("numpy", "scipy.integrate"),
    questions=(
        Question(
            name="angle",
            calls=angles,
            returns=Array(lambda s, *_: s.shape),
            properties=(equals(phi_at, 1e-7, says="has the derivative u_hat and starts at phi_0", points=1.5),),
            mistakes=(
                Mistake(
                    "clamp's angle forgotten",
                    "What is your angle at s = 0, and what should it be?",
                    lambda s, u_hat, phi_0: phi_at(s, u_hat, 0.0),
                ),
                Mistake(
                    "curvature times arclength",
                    "That is the angle of a rod of constant curvature only. Differentiate yours for u_hat(s) = s.",
                    lambda s, u_hat, phi_0: phi_0 + u_hat(s) * s,
                ),
                Mistake(
                    "integrated from the free end",
                    "At which end is the angle known? Let s go to 0 in your integral.",
                    lambda s, u_hat, phi_0: phi_0 + integral(u_hat, s, 1.0),
                ),
                Mistake(
                    "turned the other way",
                    "Which sign has phi' when u_hat is positive?",
                    lambda s, u_hat, phi_0: phi_0 - integral(u_hat, 0.0, s),
                ),
            ),
            hint="An integral of u_hat from 0 to s for each s; scipy.integrate.quad does one.",
        ),
        Question(
            name="tip",
            calls=shapes,
            returns=Array((2,)),
            properties=(equals(place, 1e-7, says="is the end of the curve with these angles", points=1.5),),
            mistakes=(
                Mistake(
                    "sine and cosine interchanged",
                    "A straight vertical rod, u_hat = 0 and phi_0 = 0: which of its coordinates is 1?",
                    lambda *given: place(*given)[::-1],
                ),
                Mistake(
                    "two cosines",
                    "The line r = int cos(phi) in the notes is for one of the coordinates only.",
                    lambda *given: place(*given)[[1, 1]],
                ),
                Mistake(
                    "clamp's angle forgotten",
                    "Does turning the clamp move your tip?",
                    lambda u_hat, phi_0: place(u_hat, 0.0),
                ),
            ),
            hint="First the angle at many s, then two more integrals; few nodes are enough for a smooth function.",
        ),
        Question(
            name="centre",
            calls=circles,
            returns=Array((2,)),
            properties=(holds("is at the distance 1/|c| from every point of the rod", off_circle, 1e-9),),
            mistakes=(
                Mistake(
                    "radius for curvature",
                    "How large is the circle when the curvature is small?",
                    lambda c, phi_0: c * np.array([np.cos(phi_0), -np.sin(phi_0)]),
                ),
                Mistake(
                    "on the other side",
                    "A rod of positive curvature turns clockwise, towards its d_1: on which side is the centre?",
                    lambda c, phi_0: np.array([-np.cos(phi_0), np.sin(phi_0)]) / c,
                ),
                Mistake(
                    "along the tangent",
                    "From the clamp to the centre one goes at a right angle to the rod.",
                    lambda c, phi_0: np.array([np.sin(phi_0), np.cos(phi_0)]) / c,
                ),
            ),
            hint="Integrate sin and cos of phi_0 + c s: which point do x and z go round?",
        ),
    ),
)

# %% proofs
PROOFS = {
    "angle: clamp's angle forgotten": ("phi_0 + quad", "quad"),
    "angle: curvature times arclength": ("quad(u_hat, 0.0, end, epsabs=1e-12)[0]", "u_hat(end) * end"),
    "angle: integrated from the free end": ("quad(u_hat, 0.0, end,", "quad(u_hat, end, 1.0,"),
    "angle: turned the other way": ("phi_0 + quad", "phi_0 - quad"),
    "tip: sine and cosine interchanged": (
        "weights @ np.sin(phi) / 2, weights @ np.cos(phi) / 2",
        "weights @ np.cos(phi) / 2, weights @ np.sin(phi) / 2",
    ),
    "tip: two cosines": ("weights @ np.sin(phi) / 2,", "weights @ np.cos(phi) / 2,"),
    "tip: clamp's angle forgotten": ("(nodes + 1) / 2, u_hat, phi_0", "(nodes + 1) / 2, u_hat, 0.0"),
    "centre: radius for curvature": ("radius = 1 / c", "radius = c"),
    "centre: on the other side": ("radius = 1 / c", "radius = -1 / c"),
    "centre: along the tangent": ("np.cos(phi_0), -radius * np.sin(phi_0)", "np.sin(phi_0), radius * np.cos(phi_0)"),
}
