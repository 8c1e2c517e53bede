"""Checks of the exercise "The Hamiltonian of a rod in space"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array, Number

E3 = np.array([0.0, 0.0, 1.0])
CROSS = np.cross(np.eye(3)[:, None], np.eye(3)).transpose(2, 0, 1)  # (a x b)_i = CROSS_ijk a_j b_k


def legendre(m, n, K, u_hat):
    """m u + n v - W(u), at the strains u of the moment m and at v = e_3."""
    u = u_hat + m / K
    return m @ u + n @ E3 - K @ (u - u_hat) ** 2 / 2


def series(m, n, K, u_hat, s, *, turn=1.0, force=1.0, steps=6, order=15):
    """By power series: the equations are quadratic, so that each coefficient is a sum of products of those before it."""
    state = np.array([m, n])
    for _ in range(steps):
        c, u = np.zeros((order + 1, 2, 3)), np.zeros((order + 1, 3))
        c[0], u[0] = state, u_hat + state[0] / K
        for k in range(order):
            c[k + 1] = turn * np.einsum("ijk,apj,ak->pi", CROSS, c[: k + 1], u[k::-1])
            c[k + 1, 0] += force * np.array([c[k, 1, 1], -c[k, 1, 0], 0.0])
            c[k + 1] /= k + 1
            u[k + 1] = c[k + 1, 0] / K
        state = np.einsum("a,apj->pj", (s / steps) ** np.arange(order + 1), c)
    return state


def drift(value, m, n, K, u_hat, s):
    """Of n.n, m.n and H, relative to their sizes, plus how far the pair is from having moved at all."""
    (a, b), still = value, np.allclose(value, [m, n])
    change = (
        abs(b @ b / (n @ n) - 1),
        abs(a @ b - m @ n) / (abs(m) @ abs(n)),
        abs(legendre(a, b, K, u_hat) / legendre(m, n, K, u_hat) - 1),
    )
    return max(change) + still


def in_plane(phi, moment, N1, N3, *, sign=1, place=1):
    force = (N1 + 1j * N3) * np.exp(sign * 1j * phi)  # clockwise: n1 + i n3
    return np.array([moment * np.eye(3)[place], [force.real, 0.0, force.imag]])


def off_planar(value, phi, moment, N1, N3):
    """H of the pair against that of [N 2.6], for two rods."""
    rods = ((np.array([2.0, 1.5, 3.0]), np.array([0.0, 0.7, 0.0])), (np.array([0.5, 0.8, 0.4]), np.array([0.0, -0.3, 0.0])))
    true = [moment**2 / (2 * K[1]) + u_hat[1] * moment + N3 * np.cos(phi) + N1 * np.sin(phi) for K, u_hat in rods]
    return max(abs(legendre(*value, *rod) / H - 1) for rod, H in zip(rods, true, strict=True))


def states(draw):
    for _ in range(3):
        yield (
            draw.uniform(0.8, 1.6, size=3),
            draw.uniform(1, 2, size=3),
            draw.permutation([0.6, 0.8, 1.3]),
            draw.uniform(0.4, 1, size=3),
        )


def spans(draw):
    for given in states(draw):
        yield *given, draw.uniform(0.6, 1.2)


def bent(draw):
    for _ in range(3):
        yield draw.uniform(0.4, 1.2), *draw.uniform(1, 3, size=3)


exercise = Exercise(
    title="The Hamiltonian of a rod in space",
    source="N 2.5, 2.6",
    imports=("numpy", "scipy.integrate"),
    questions=(
        Question(
            name="H",
            calls=states,
            returns=Number(),
            properties=(equals(legendre, 1e-12, says="is the function with these derivatives", points=1.5),),
            mistakes=(
                Mistake(
                    "axial force forgotten",
                    "Differentiate your H by n_3. It is conserved only where there is no force.",
                    lambda m, n, K, u_hat: legendre(m, 0 * n, K, u_hat),
                ),
                Mistake(
                    "unstressed strains forgotten",
                    "Is the derivative of your H by m the strain, or the strain less that of the unstressed rod?",
                    lambda m, n, K, u_hat: legendre(m, n, K, 0 * u_hat),
                ),
                Mistake(
                    "factor one half",
                    "Differentiate your H by m_1 and compare the term with 1/K_1.",
                    lambda m, n, K, u_hat: legendre(m, n, K / 2, u_hat),
                ),
            ),
            hint="Integrate u_i over m_i, then add what has the derivative e_3 by n.",
        ),
        Question(
            name="transported",
            calls=spans,
            returns=Array((2, 3)),
            properties=(
                equals(series, 1e-6, says="solves the equations"),
                holds("moves, and keeps n.n, m.n and H", drift, 1e-5, 0.5),
            ),
            mistakes=(
                Mistake(
                    "sign of the turning",
                    "m x u is not u x m. Which of them is in the equations? Is H constant along your solution?",
                    lambda *given: series(*given, turn=-1.0),
                ),
                Mistake(
                    "moment of the force forgotten",
                    "m.n is constant along yours, but H is not: what else changes the moment, other than turning?",
                    lambda *given: series(*given, force=0.0),
                ),
                Mistake(
                    "sign of the force's moment",
                    "n x e_3 or e_3 x n? Try your H along the solution.",
                    lambda *given: series(*given, force=-1.0),
                ),
                Mistake(
                    "unstressed strains forgotten",
                    "The rod is curved when unstressed: which u turns the components?",
                    lambda m, n, K, u_hat, s: series(m, n, K, 0 * u_hat, s),
                ),
                Mistake("in the other order", "The moment comes first.", lambda *given: series(*given)[::-1]),
            ),
            hint="Six ordinary differential equations with given values at 0: an initial value problem; ask its solver for enough digits.",
        ),
        Question(
            name="planar",
            calls=bent,
            returns=Array((2, 3)),
            properties=(
                equals(in_plane, 1e-12, says="has the components along the directors"),
                holds("gives H = m^2/(2 K_2) + m u_hat_2 + N_3 cos(phi) + N_1 sin(phi)", off_planar, 1e-12, 0.5),
            ),
            mistakes=(
                Mistake(
                    "turned the other way",
                    "Take the products of the force with d_1 and d_3 as the statement has them.",
                    lambda *given: in_plane(*given, sign=-1),
                ),
                Mistake(
                    "a twist",
                    "The moment is about e_2, at a right angle to the plane: which director is that?",
                    lambda *given: in_plane(*given, place=2),
                ),
            ),
            hint="m.d_i and n.d_i, one after the other; three of the six vanish.",
        ),
    ),
)
