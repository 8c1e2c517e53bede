"""What stays constant along a uniform rod, and what a discretisation keeps of it [N 2.6, 2.8.2].

    H = m^2 / (2K) + u_hat m + n3,   |n|^2 = n1^2 + n3^2             n in the body frame

In the variables (phi, m) the force is -lam (sin phi, cos phi): |n| is constant by its form, H is not quadratic, and Gauss's
method lets it drift, at the rate of its order. In the body frame,

    n1' = -n3 phi',   n3' = n1 phi',   m' = -n1,   phi' = u_hat + m/K        n1(0) = 0, n3(0) = -lam, m(1) = 0

both are quadratic, and Gauss's method keeps both to rounding whatever the mesh. (The notes' symplectic Runge-Kutta methods.)
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rodlab.mechanics.rod import Rod
from rodlab.numerics.arrays import Array
from rodlab.numerics.firstorder import System, collocate


@dataclass(frozen=True, eq=False)
class Invariants:
    """H at the mesh points s in the two formulations, and n1^2 + n3^2 in the body frame, all shape (N+1,)."""

    s: Array
    of_angle: Array
    of_body: Array
    force: Array

    @property
    def drift(self) -> tuple[float, float, float]:
        """Largest change of each along the rod, relative to its size."""
        known = (self.of_angle, self.of_body, self.force)
        return tuple(float(np.ptp(v) / np.abs(v).max()) for v in known)  # type: ignore[return-value]


def invariants(p: Any) -> Invariants:
    """The invariants along the solution of a point p of a uniform rod without terms, clamped upright, on p's mesh.

    Raises `ValueError` for any other model.

    >>> from rodlab.analysis.equilibrium import equilibrium
    >>> p = equilibrium(Rod(mesh=8, degree=2), 5.0, lambda s: 2 * s)
    >>> angle, body, force = invariants(p).drift
    >>> angle > 1e-5, body < 1e-13, force < 1e-13
    (True, True, True)
    """
    rod = p.equations
    if not isinstance(rod, Rod) or rod.varies or rod.terms or rod.phi0 or hasattr(rod, "unknowns"):
        raise ValueError(f"p must be a point of a uniform rod without terms, clamped upright; its model is {rod!r:.80}")
    K, u_hat, lam = float(rod.parameters["K"]), float(rod.parameters["u_hat"]), p.lam
    phi, m = mesh_values(rod, p.u, lam)
    n1, n3 = lam * np.sin(phi), -lam * np.cos(phi)
    body = collocate(
        body_system(K, u_hat),
        (np.array([[1.0, 0, 0], [0, 1.0, 0]]), np.array([0.0, -lam])),
        (np.array([[0, 0, 1.0]]), np.array([0.0])),
        rod.mesh,
        rod.degree,
        np.array([n1, n3, m]),
    )
    of_angle = m**2 / (2 * K) + u_hat * m + n3
    of_body = body[2] ** 2 / (2 * K) + u_hat * body[2] + body[1]
    return Invariants(rod.mesh, of_angle, of_body, body[0] ** 2 + body[1] ** 2)


def mesh_values(rod: Rod, u: Array, lam: float) -> tuple[Array, Array]:
    """phi and m at the mesh points: m by the balance of moments of each interval, as the first-order system has it."""
    tested = rod.tested(u, lam, rod.grid)
    phi = np.append(rod.phi0, u.reshape(rod.grid.N, -1)[:, -1])
    return phi, np.append(-tested[:, 0], tested[-1, -1])


def body_system(K: float, u_hat: float) -> System:
    """y = (n1, n3, m)."""

    def f(_: Array, y: Array) -> Array:
        bent = u_hat + y[2] / K
        return np.stack([-y[1] * bent, y[0] * bent, -y[0]])

    def df(_: Array, y: Array) -> Array:
        bent, zero, one = u_hat + y[2] / K, np.zeros_like(y[0]), np.ones_like(y[0])
        return np.array([[zero, -bent, -y[1] / K], [bent, zero, y[0] / K], [-one, zero, zero]])

    return System(f, df)


def angle_system(rod: Rod, lam: float) -> System:
    """y = (phi, m), the first-order system of the rod's limit, compiled from SymPy: what its collocation solves."""
    import sympy

    limit = rod.derivation()
    m = sympy.Symbol("m", real=True)
    right = (limit.slope, limit.load.subs(limit.p, limit.slope))
    names = [sympy.Symbol(name, real=True) for name in limit.parameters]
    arguments = (limit.phi, m, limit.lam, *names)
    values = sympy.lambdify(arguments, right, "numpy")
    slopes = sympy.lambdify(arguments, [[r.diff(x) for x in (limit.phi, m)] for r in right], "numpy")

    def given(s: Array) -> list[Array]:
        return [rod.profiles[x.name].at(s) for x in names]

    def f(s: Array, y: Array) -> Array:
        return np.array([np.broadcast_to(v, s.shape) for v in values(y[0], y[1], lam, *given(s))])

    def df(s: Array, y: Array) -> Array:
        rows = slopes(y[0], y[1], lam, *given(s))
        return np.array([[np.broadcast_to(v, s.shape) for v in row] for row in rows])

    return System(f, df)
