r"""# Equilibria of constant strain

A uniform rod, inextensible and unshearable ($v = d_3$), has in its body frame the balance laws [N 2.3, 2.5]

$$n' + u \times n = 0, \qquad m' + u \times m + e_3 \times n = 0, \qquad m_i = K_i (u_i - \hat u_i),$$

where $u$ is the strain, $n$ the force and $m$ the moment, each by its three components, $e_3 = (0, 0, 1)$, and $K_1, K_2, K_3 > 0$. The ends may be
held by any force and moment. Which *constant* strains $u \ne 0$ are possible? The centreline is then a helix (or an arc, or a line).

1. With $u$, $n$, $m$ constant the first law says $n = \nu u$ for a number $\nu$. What does the second say about $m$?
2. Together with the constitutive law this gives three equations for $u$, linear, with two free numbers $\mu$ and $\nu$.

**Write**

- `residual(u, n, m)`: the left-hand sides of both laws for constant $u, n, m$, an array of shape (6,), forces first;
- `moment(u, mu, nu)`: the moment that balances $n = \nu u$, where $\mu$ is the multiple of $u$ in it that the laws leave free, shape (3,);
- `strain(K, u_hat, mu, nu)`: the constant strain of a rod with stiffnesses `K` and unstressed strain `u_hat` (both of shape (3,)), shape (3,).
"""

# %% answer
import numpy as np


def residual(u, n, m):
    """u x n and u x m + e_3 x n, shape (6,)."""
    ### BEGIN SOLUTION
    forces = np.cross(u, n)
    moments = np.cross(u, m) + np.cross([0.0, 0.0, 1.0], n)
    return np.concatenate([forces, moments])
    ### END SOLUTION


def moment(u, mu, nu):
    """The moment that balances n = nu u, shape (3,)."""
    ### BEGIN SOLUTION
    tangent = np.array([0.0, 0.0, 1.0])
    return mu * np.asarray(u) + nu * tangent
    ### END SOLUTION


def strain(K, u_hat, mu, nu):
    """The constant strain, shape (3,)."""
    ### BEGIN SOLUTION
    load = np.array([0.0, 0.0, nu])
    return (K * u_hat + load) / (K - mu)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, holds
from rodlab.grading.values import Array

E3 = np.array([0.0, 0.0, 1.0])


def laws(u, n, m, *, tangent=1.0):
    return np.append(np.cross(u, n), np.cross(u, m) + tangent * np.cross(E3, n))


def unbalanced(m, u, mu, nu):
    return np.max(np.abs(laws(u, nu * u, m))) / np.max(np.abs(np.cross(E3, nu * u)))


def free_part(m, u, mu, nu):
    """With nu taken off, the moment is mu times the strain."""
    return np.max(np.abs(m - nu * E3 - mu * u)) / np.max(np.abs(m))


def not_of_the_rod(u, K, u_hat, mu, nu):
    m = K * (u - u_hat)
    return np.max(np.abs(laws(u, nu * u, m))) / np.max(np.abs(np.cross(E3, nu * u)))


def triples(draw):
    for _ in range(3):
        yield tuple(draw.normal(size=3) for _ in range(3))


def multiples(draw):
    for _ in range(3):
        yield np.array([1.0, 0.0, 0.0]) + draw.normal(size=3), draw.uniform(0.2, 0.8), draw.uniform(1, 3)


def rods(draw):
    for _ in range(3):
        yield draw.uniform(1.5, 3, size=3), draw.uniform(0.5, 2, size=3), draw.uniform(-0.9, -0.3), draw.uniform(1, 3)


exercise = Exercise(
    title="Equilibria of constant strain",
    source="N 2.5",
    questions=(
        Question(
            name="residual",
            calls=triples,
            returns=Array((6,)),
            properties=(equals(laws, 1e-12, says="is the left-hand side of both laws"),),
            mistakes=(
                Mistake(
                    "order of the cross product",
                    "Vectors of the body frame turn with it: d_i' = u x d_i. In which order do u and n stand?",
                    lambda u, n, m: np.append(np.cross(n, u), np.cross(m, u) + np.cross(E3, n)),
                ),
                Mistake(
                    "moment of the force forgotten",
                    "The force has a moment about the next point of the centreline: the term with r' = d_3.",
                    lambda u, n, m: laws(u, n, m, tangent=0.0),
                ),
                Mistake(
                    "sign of the moment of the force",
                    "It is r' x n, not n x r'.",
                    lambda u, n, m: laws(u, n, m, tangent=-1.0),
                ),
                Mistake("moments first", "Forces first, then moments.", lambda u, n, m: np.roll(laws(u, n, m), 3)),
            ),
            hint="np.cross, three times.",
        ),
        Question(
            name="moment",
            calls=multiples,
            returns=Array((3,)),
            properties=(
                holds("balances the force nu u", unbalanced, 1e-12, 1.5),
                holds("has the multiple mu of u", free_part, 1e-12, 0.5),
            ),
            mistakes=(
                Mistake(
                    "the force's share forgotten",
                    "u x m must cancel e_3 x n, which is not zero: a multiple of u alone cannot do that.",
                    lambda u, mu, nu: mu * u,
                ),
                Mistake(
                    "sign of the force's share",
                    "Write e_3 x (nu u) as u times something, and mind that a x b = -b x a.",
                    lambda u, mu, nu: mu * u - nu * E3,
                ),
                Mistake("multiples interchanged", "nu belongs to the force.", lambda u, mu, nu: nu * u + mu * E3),
            ),
            hint="Bring u x m + e_3 x (nu u) to the form u x (something): that something is parallel to u.",
        ),
        Question(
            name="strain",
            calls=rods,
            returns=Array((3,)),
            properties=(
                holds("is an equilibrium of the rod", not_of_the_rod, 1e-11, 1.5),
                equals(
                    lambda K, u_hat, mu, nu: np.linalg.solve(np.diag(K) - mu * np.eye(3), K * u_hat + nu * E3),
                    1e-11,
                    says="is that of these mu and nu",
                ),
            ),
            mistakes=(
                Mistake(
                    "sign of mu",
                    "Bring the terms with u to one side: which sign has mu there?",
                    lambda K, u_hat, mu, nu: (K * u_hat + nu * E3) / (K + mu),
                ),
                Mistake(
                    "stiffness of the unstressed strain forgotten",
                    "The unstressed strain stands in the constitutive law with its stiffness before it.",
                    lambda K, u_hat, mu, nu: (u_hat + nu * E3) / (K - mu),
                ),
                Mistake(
                    "nu in every component",
                    "e_3 has one component that is not zero.",
                    lambda K, u_hat, mu, nu: (K * u_hat + nu) / (K - mu),
                ),
                Mistake(
                    "sign of nu",
                    "Check the third component against your moment.",
                    lambda K, u_hat, mu, nu: (K * u_hat - nu * E3) / (K - mu),
                ),
            ),
            hint="K_i (u_i - u_hat_i) is component i of your moment: one linear equation for each component.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "residual: order of the cross product": [
        ("forces = np.cross(u, n)", "forces = np.cross(n, u)"),
        ("np.cross(u, m) +", "np.cross(m, u) +"),
    ],
    "residual: moment of the force forgotten": (" + np.cross([0.0, 0.0, 1.0], n)", ""),
    "residual: sign of the moment of the force": ("+ np.cross([0.0, 0.0, 1.0], n)", "- np.cross([0.0, 0.0, 1.0], n)"),
    "residual: moments first": ("[forces, moments]", "[moments, forces]"),
    "moment: the force's share forgotten": (" + nu * tangent", ""),
    "moment: sign of the force's share": ("+ nu * tangent", "- nu * tangent"),
    "moment: multiples interchanged": ("mu * np.asarray(u) + nu * tangent", "nu * np.asarray(u) + mu * tangent"),
    "strain: sign of mu": ("(K - mu)", "(K + mu)"),
    "strain: stiffness of the unstressed strain forgotten": ("K * u_hat + load", "u_hat + load"),
    "strain: nu in every component": ("[0.0, 0.0, nu]", "[nu, nu, nu]"),
    "strain: sign of nu": ("K * u_hat + load", "K * u_hat - load"),
}
