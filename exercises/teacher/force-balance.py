r"""# Force balance by multipliers

The strut of $n$ joints has links $0, \dots, n$ of length $h$, and at joint $i = 1, \dots, n$, between links $i - 1$ and $i$, a spring $k_i$
with the rest angle $\beta_i$. The links are at the angles $\phi_0 = 0, \phi_1, \dots, \phi_n$ (radians) from the vertical;
link $i - 1$ ends at the point $(x_i, z_i)$, and $x_0 = z_0 = 0$. Let angles *and* places be unknowns, tied by constraints
[N 2.8, the discrete force balance]: for $i = 1, \dots, n + 1$

$$x_i - x_{i-1} = h \sin\phi_{i-1}, \qquad z_i - z_{i-1} = h \cos\phi_{i-1} .$$

The load $\lambda$ presses on the end of the *last* link, so that (the notes stop one link too early) the function whose derivatives
with respect to all $\phi_i, x_i, z_i$ vanish at an equilibrium is

$$L = \sum_{i=1}^{n} \tfrac12 k_i (\phi_i - \phi_{i-1} - \beta_i)^2 + \lambda z_{n+1}
+ \sum_{i=1}^{n+1} \nu_i (x_i - x_{i-1} - h \sin\phi_{i-1}) + \mu_i (z_i - z_{i-1} - h \cos\phi_{i-1}) .$$

**Write**

1. `places(phi, h)` for the $n$ free angles `phi`: the two arrays $(x_1, \dots, x_{n+1})$ and $(z_1, \dots, z_{n+1})$;
2. `multipliers(n, lam)`: the arrays $(\nu_1, \dots, \nu_{n+1})$ and $(\mu_1, \dots, \mu_{n+1})$ at an equilibrium;
3. `moment_balance(phi, nu, mu, k, beta, h)`: the derivatives $\partial L/\partial\phi_i$, $i = 1, \dots, n$, shape (n,), for any
   multipliers `nu`, `mu` of shape (n+1,); `phi`, `k`, `beta` have the shape (n,). With your multipliers it must be the balance of moments of the strut without multipliers.
"""

# %% answer
import numpy as np


def places(phi, h):
    """The places of the ends of links 0, ..., n: x and z, two arrays of shape (n + 1,)."""
    ### BEGIN SOLUTION
    angles = np.concatenate([[0.0], phi])
    return np.cumsum(h * np.sin(angles)), np.cumsum(h * np.cos(angles))
    ### END SOLUTION


def multipliers(n, lam):
    """The multipliers nu and mu at an equilibrium, two arrays of shape (n + 1,)."""
    ### BEGIN SOLUTION
    nu = np.zeros(n + 1)
    mu = np.full(n + 1, -lam)
    return nu, mu
    ### END SOLUTION


def moment_balance(phi, nu, mu, k, beta, h):
    """dL/dphi_i for i = 1, ..., n, an array of shape (n,)."""
    ### BEGIN SOLUTION
    moment = k * (np.diff(phi, prepend=0.0) - beta)
    above = np.append(moment[1:], 0.0)
    return moment - above + h * mu[1:] * np.sin(phi) - h * nu[1:] * np.cos(phi)
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import complex_step, equals, gradient_of, holds
from rodlab.grading.values import Array, Parts


def angles(draw):
    for n in (1, 2, 6):
        yield draw.uniform(-2, 2, size=n), draw.uniform(0.15, 0.9)


def struts(draw):
    for n in (2, 3, 7):
        yield n, draw.uniform(1.5, 9)


def states(draw):
    for n in (2, 3, 6):
        nu, mu = draw.normal(size=n + 1), draw.normal(size=n + 1)
        yield draw.uniform(-2, 2, size=n), nu, mu, draw.uniform(1, 3, size=n), draw.normal(size=n), draw.uniform(0.15, 0.9)


def tip(phi, h):
    """Places as sums of complex numbers z + i x."""
    way = h * np.exp(1j * np.append(0.0, phi))
    ends = np.array([way[: i + 1].sum() for i in range(way.size)])
    return ends.imag, ends.real


def L(phi, x, z, nu, mu, lam, k, beta, h):
    phi, x, z = (np.append(0.0, part) for part in (phi, x, z))
    bend = phi[1:] - phi[:-1] - beta
    sideways, upwards = x[1:] - x[:-1] - h * np.sin(phi), z[1:] - z[:-1] - h * np.cos(phi)
    return np.sum(k * bend**2) / 2 + lam * z[-1] + np.sum(nu * sideways + mu * upwards)


def off_balance(value, n, lam):
    """The largest derivative of L with respect to a place, against the load."""
    at = np.linspace(0.1, 0.9, n + 1)
    rest = (*value, lam, np.ones(n), np.zeros(n), 0.5)
    sideways = complex_step(lambda x: L(at[1:], x, at, *rest), at)
    upwards = complex_step(lambda z: L(at[1:], at, z, *rest), at)
    return max(np.max(np.abs(sideways)), np.max(np.abs(upwards))) / lam


def along_phi(phi, nu, mu, k, beta, h):
    return L(phi, np.zeros_like(nu), np.zeros_like(mu), nu, mu, 0.0, k, beta, h)


def balance(phi, nu, mu, k, beta, h):
    return complex_step(along_phi, phi, nu, mu, k, beta, h)


def spring_above(phi, nu, mu, k, beta, h):
    right = balance(phi, nu, mu, k, beta, h)
    right[-1] -= k[-1] * (phi[-1] - phi[-2] - beta[-1])
    return right


exercise = Exercise(
    title="Force balance by multipliers",
    source="N 2.8",
    questions=(
        Question(
            name="places",
            calls=angles,
            returns=Parts(Array(lambda phi, h: (phi.size + 1,)), Array(lambda phi, h: (phi.size + 1,))),
            properties=(equals(tip, 1e-12, says="is where the links end"),),
            mistakes=(
                Mistake(
                    "clamped link forgotten",
                    "Which link ends at (x_1, z_1)? Count your points: there are as many as links.",
                    lambda phi, h: (tip(phi, h)[0][1:], tip(phi, h)[1][1:] - h),
                ),
                Mistake(
                    "sine and cosine interchanged",
                    "The angles are measured from the vertical: where does your tip go for phi = 0?",
                    lambda phi, h: tip(phi, h)[::-1],
                ),
                Mistake("h forgotten", "How long is your strut? Each link has the length h.", lambda phi, h: tip(phi, 1.0)),
            ),
            hint="Sum the constraints from the clamp upwards; the clamped link 0 is the first to be summed.",
        ),
        Question(
            name="multipliers",
            calls=struts,
            returns=Parts(Array(lambda n, lam: (n + 1,)), Array(lambda n, lam: (n + 1,))),
            properties=(holds("makes L stationary in every x_i and z_i", off_balance, 1e-12),),
            mistakes=(
                Mistake(
                    "sign of the load",
                    "Differentiate L with respect to the last z: two terms have it, and their sum vanishes.",
                    lambda n, lam: (np.zeros(n + 1), np.full(n + 1, lam)),
                ),
                Mistake(
                    "last link unloaded",
                    "Where does the load act? A last multiplier of zero would leave the last link without it.",
                    lambda n, lam: (np.zeros(n + 1), np.append(np.full(n, -lam), 0.0)),
                ),
                Mistake(
                    "directions interchanged",
                    "Which multiplier belongs to the height, which to the sideways place? The load is vertical.",
                    lambda n, lam: (np.full(n + 1, -lam), np.zeros(n + 1)),
                ),
                Mistake(
                    "one too few",
                    "There is a constraint for each link, the clamped one too: how many links are there?",
                    lambda n, lam: (np.zeros(n), np.full(n, -lam)),
                ),
            ),
            hint="Each place but the last occurs in two constraints with opposite signs; begin with the last one.",
        ),
        Question(
            name="moment_balance",
            calls=states,
            returns=Array(lambda phi, *_: phi.shape),
            properties=(gradient_of(along_phi, 1e-12, points=2.0),),
            mistakes=(
                Mistake(
                    "multiplier of the link below",
                    "Angle i occurs in the constraint for the end of link i: which number does that constraint have?",
                    lambda phi, nu, mu, *rest: balance(phi, np.append(0.0, nu[:-1]), np.append(0.0, mu[:-1]), *rest),
                ),
                Mistake(
                    "sign of the constraints",
                    "The constraints have -sin and -cos: what are the signs after differentiation? Check by a small change of one angle.",
                    lambda phi, nu, mu, *rest: balance(phi, -nu, -mu, *rest),
                ),
                Mistake(
                    "sine and cosine interchanged",
                    "The derivative of the height with respect to an angle is not the height.",
                    lambda phi, nu, mu, *rest: balance(phi, -mu, -nu, *rest),
                ),
                Mistake(
                    "h forgotten",
                    "Lengthen the links: the springs' part stays, the lever of the forces must grow.",
                    lambda phi, nu, mu, k, beta, h: balance(phi, nu, mu, k, beta, 1.0),
                ),
                Mistake(
                    "a spring above the last link",
                    "Is there a joint at the end of link n? Its balance has one spring only.",
                    spring_above,
                ),
            ),
            hint="Angle i occurs in two springs (the last one in one) and in the two constraints for the end of link i.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "places: clamped link forgotten": ("np.concatenate([[0.0], phi])", "phi"),
    "places: sine and cosine interchanged": (
        "return np.cumsum(h * np.sin(angles)), np.cumsum(h * np.cos(angles))",
        "return np.cumsum(h * np.cos(angles)), np.cumsum(h * np.sin(angles))",
    ),
    "places: h forgotten": [("np.cumsum(h * np.sin", "np.cumsum(np.sin"), ("np.cumsum(h * np.cos", "np.cumsum(np.cos")],
    "multipliers: sign of the load": ("np.full(n + 1, -lam)", "np.full(n + 1, lam)"),
    "multipliers: last link unloaded": ("np.full(n + 1, -lam)", "np.append(np.full(n, -lam), 0.0)"),
    "multipliers: directions interchanged": ("return nu, mu", "return mu, nu"),
    "multipliers: one too few": [("np.zeros(n + 1)", "np.zeros(n)"), ("np.full(n + 1, -lam)", "np.full(n, -lam)")],
    "moment_balance: multiplier of the link below": [
        ("mu[1:]", "mu[:-1]"),
        ("nu[1:]", "nu[:-1]"),
    ],
    "moment_balance: sign of the constraints": ("above + h * mu[1:] * np.sin(phi) - h", "above - h * mu[1:] * np.sin(phi) + h"),
    "moment_balance: sine and cosine interchanged": [
        ("h * mu[1:] * np.sin(phi)", "h * mu[1:] * np.cos(phi)"),
        ("h * nu[1:] * np.cos(phi)", "h * nu[1:] * np.sin(phi)"),
    ],
    "moment_balance: h forgotten": [("h * mu[1:]", "mu[1:]"), ("h * nu[1:]", "nu[1:]")],
    "moment_balance: a spring above the last link": ("np.append(moment[1:], 0.0)", "np.append(moment[1:], moment[-1])"),
}
