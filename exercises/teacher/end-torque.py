r"""# A torque at the end

A planar rod of length 1 [N 2.6] carries no force, but a torque $\tau$ at its free end. With the angle $\phi(s)$ from the vertical (radians),
the stiffness $K(s) > 0$ and the unstressed curvature $\hat u(s)$, where $s \in [0, 1]$ is arclength, its equilibria obey

$$\big(K (\phi' - \hat u)\big)' = 0, \qquad \phi(0) = 0, \qquad K (\phi' - \hat u) = \tau \ \text{ at } s = 1 .$$

They are the critical points of $\displaystyle V[\phi] = \int_0^1 \tfrac12 K (\phi' - \hat u)^2 \, ds - \tau\, \phi(1)$. Is there an equilibrium for
every $\tau$, and is there only one? Find it by integrals, and compare its energy with that of every other shape.

**Write**, with a relative error of at most $10^{-7}$; `K`, `u_hat`, `slope` are smooth functions of $s$, a number or an array:

1. `angle(s, K, u_hat, tau)`: $\phi$ at the entries of the array `s` of shape (k,), ascending in $[0, 1]$; the same shape;
2. `torque(tip, K, u_hat)`: the $\tau$ for which $\phi(1)$ equals the number `tip`;
3. `excess(slope, K, u_hat, tau)`: $V[\phi + \eta] - V[\phi]$ for the equilibrium $\phi$ and any $\eta$ with $\eta(0) = 0$, $\eta'(s) =$ `slope(s)`.
"""

# %% answer
import numpy as np
from scipy.integrate import quad


def angle(s, K, u_hat, tau):
    """phi at the arclengths s (shape (k,)), radians, an array of shape (k,)."""
    ### BEGIN SOLUTION
    return np.array([quad(lambda t: u_hat(t) + tau / K(t), 0.0, end, epsabs=1e-12)[0] for end in s])
    ### END SOLUTION


def torque(tip, K, u_hat):
    """The end torque that turns the end to the angle tip (radians), a number."""
    ### BEGIN SOLUTION
    unstressed = quad(u_hat, 0.0, 1.0)[0]
    compliance = quad(lambda t: 1 / K(t), 0.0, 1.0)[0]
    return (tip - unstressed) / compliance
    ### END SOLUTION


def excess(slope, K, u_hat, tau):
    """By how much the energy of phi + eta, eta' = slope, exceeds that of the equilibrium phi, a number."""
    ### BEGIN SOLUTION
    return quad(lambda t: K(t) * slope(t) ** 2 / 2, 0.0, 1.0)[0]
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number

NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def integral(f, end=1.0):
    """Of f from 0 to each end, by Gauss's rule."""
    half = np.asarray(end, float)[..., None] / 2
    return np.sum(half * WEIGHTS * f(half * (NODES + 1)), axis=-1)


def phi_at(s, K, u_hat, tau):
    return integral(lambda t: u_hat(t) + tau / K(t), s)


def energy(bend, K, u_hat, tau):
    """V of the shape with phi' = bend."""
    return integral(lambda t: K(t) * (bend(t) - u_hat(t)) ** 2 / 2 - tau * bend(t))


def above(slope, K, u_hat, tau):
    """The difference of two energies, each integrated as it stands."""

    def bend(t, eta=0.0):
        return u_hat(t) + tau / K(t) + eta

    return energy(lambda t: bend(t, slope(t)), K, u_hat, tau) - energy(bend, K, u_hat, tau)


def turned_to(value, tip, K, u_hat):
    return abs(phi_at(1.0, K, u_hat, value) / tip - 1)


def rod(draw):
    """A stiffness that grows from below 1 to about 4, and a curvature."""
    a, b, c, w = draw.uniform(0.5, 0.8), draw.uniform(2, 3), draw.uniform(0.5, 0.9), draw.uniform(2, 4)
    return Code(f"lambda s: {a} + {b} * s**2"), Code(f"lambda s: {c} + 0.4 * np.cos({w} * s)")


def angles(draw):
    for sign in (1, -1):
        yield np.sort(draw.uniform(0.2, 0.9, size=5)), *rod(draw), sign * draw.uniform(1, 3)


def tips(draw):
    for sign in (1, -1):
        yield sign * draw.uniform(2, 5), *rod(draw)


def variations(draw):
    for sign in (1, -1):
        a, w = draw.uniform(0.6, 1.2), draw.uniform(3, 6)
        yield Code(f"lambda s: {a} - s + np.sin({w} * s)"), *rod(draw), sign * draw.uniform(1, 3)


exercise = Exercise(
    title="A torque at the end",
    source="N 2.6",
    imports=("numpy", "scipy.integrate"),
    questions=(
        Question(
            name="angle",
            calls=angles,
            returns=Array(lambda s, *_: s.shape),
            properties=(equals(phi_at, 1e-7, says="is the angle at equilibrium", points=1.5),),
            mistakes=(
                Mistake(
                    "unstressed curvature forgotten",
                    "What is the shape at tau = 0? Yours is straight.",
                    lambda s, K, u_hat, tau: phi_at(s, K, lambda t: 0 * t, tau),
                ),
                Mistake(
                    "stiffness for compliance",
                    "Does a stiffer rod bend more? Look at where K stands.",
                    lambda s, K, u_hat, tau: phi_at(s, lambda t: 1 / K(t), u_hat, tau),
                ),
                Mistake(
                    "sign of the torque",
                    "At s = 1 the moment is tau: which sign has it there in your solution?",
                    lambda s, K, u_hat, tau: phi_at(s, K, u_hat, -tau),
                ),
                Mistake(
                    "moment proportional to arclength",
                    "The first equation says how the moment varies along the rod. Read it again.",
                    lambda s, K, u_hat, tau: integral(lambda t: u_hat(t) + tau * t / K(t), s),
                ),
            ),
            hint="The first equation and the last give the moment for every s; then solve for phi' and integrate.",
        ),
        Question(
            name="torque",
            calls=tips,
            returns=Number(),
            properties=(holds("turns the end to the angle that was asked for", turned_to, 1e-7),),
            mistakes=(
                Mistake(
                    "mean stiffness",
                    "The mean of K is not what resists here: which mean of K does phi(1) depend on?",
                    lambda tip, K, u_hat: (tip - integral(u_hat)) * integral(K),
                ),
                Mistake(
                    "unstressed curvature forgotten",
                    "No torque is needed to hold the rod where it is unstressed. Which end angle is that?",
                    lambda tip, K, u_hat: tip / integral(lambda t: 1 / K(t)),
                ),
                Mistake(
                    "compliance for stiffness",
                    "Twice as stiff a rod takes twice the torque; yours takes half.",
                    lambda tip, K, u_hat: (tip - integral(u_hat)) * integral(lambda t: 1 / K(t)),
                ),
            ),
            hint="phi(1) is linear in tau, with a slope that is not zero: this is existence and uniqueness in one line.",
        ),
        Question(
            name="excess",
            calls=variations,
            returns=Number(),
            properties=(equals(above, 1e-7, says="is the difference of the two energies", points=1.5),),
            mistakes=(
                Mistake(
                    "factor one half",
                    "Expand the square: what stands in front of the term of second order in eta?",
                    lambda *given: 2 * above(*given),
                ),
                Mistake(
                    "load forgotten",
                    "V has two terms, and the load's changes as well. At an equilibrium nothing of first order is left.",
                    lambda slope, K, u_hat, tau: above(slope, K, u_hat, tau) + tau * integral(slope),
                ),
                Mistake(
                    "compared with the unstressed shape",
                    "The excess is over the equilibrium under tau, not over the shape without a torque.",
                    lambda slope, K, u_hat, tau: above(slope, K, u_hat, 0.0) - tau * integral(slope),
                ),
            ),
            hint="Expand (phi' + eta' - u_hat)^2 and use the equilibrium; the sign of what is left answers the question of uniqueness.",
        ),
    ),
)

# %% proofs
EXCESS = "quad(lambda t: K(t) * slope(t) ** 2 / 2, 0.0"
PROOFS = {
    "angle: unstressed curvature forgotten": ("u_hat(t) + tau / K(t)", "tau / K(t)"),
    "angle: stiffness for compliance": ("tau / K(t)", "tau * K(t)"),
    "angle: sign of the torque": ("u_hat(t) + tau", "u_hat(t) - tau"),
    "angle: moment proportional to arclength": ("tau / K(t)", "tau * t / K(t)"),
    "torque: mean stiffness": [("1 / K(t), 0.0", "K(t), 0.0"), ("unstressed) / compliance", "unstressed) * compliance")],
    "torque: unstressed curvature forgotten": ("(tip - unstressed)", "tip"),
    "torque: compliance for stiffness": ("unstressed) / compliance", "unstressed) * compliance"),
    "excess: factor one half": ("slope(t) ** 2 / 2", "slope(t) ** 2"),
    "excess: load forgotten": (EXCESS, EXCESS.replace("/ 2", "/ 2 + tau * slope(t)")),
    "excess: compared with the unstressed shape": (EXCESS, EXCESS.replace("/ 2", "/ 2 - tau * slope(t)")),
}
