"""Small equations that the tests of the continuation share, each with what is known of it."""

import numpy as np
from scipy.linalg import solve_banded
from scipy.sparse import block_diag, csr_array, diags_array

import rodlab as rl


class Scalar:
    """F(u, lam) = 0 for one unknown, from three functions."""

    def __init__(self, F, Fu, Fl):
        self.F, self.Fu, self.Fl = F, Fu, Fl

    def residual(self, u, lam):
        return np.array([self.F(u[0], lam)])

    def jacobian(self, u, lam):
        return np.array([[self.Fu(u[0], lam)]])

    def d_lam(self, u, lam):
        return np.array([self.Fl(u[0], lam)])

    def inner(self, u, v):
        return float(u @ v)


circle = Scalar(lambda u, lam: u * u + lam * lam - 1, lambda u, lam: 2 * u, lambda u, lam: 2 * lam)
transcritical = Scalar(lambda u, lam: u * (lam - u), lambda u, lam: lam - 2 * u, lambda u, lam: u)
subcritical = Scalar(lambda u, lam: lam * u + u**3, lambda u, lam: lam + 3 * u * u, lambda u, lam: u)
hysteresis = Scalar(lambda u, lam: lam - 3 * u + u**3, lambda u, lam: -3 + 3 * u * u, lambda u, lam: 1.0)


class Struts:
    """Struts side by side, uncoupled: every eigenvalue of one is one of all."""

    def __init__(self, *struts, sparse=False):
        self.struts, self.sparse = struts, sparse
        self.cuts = np.cumsum([strut.n for strut in struts])[:-1]

    def parts(self, u):
        return zip(self.struts, np.split(u, self.cuts), strict=True)

    def residual(self, u, lam):
        return np.concatenate([strut.gradient(v, lam) for strut, v in self.parts(u)])

    def jacobian(self, u, lam):
        blocks = [strut.hessian(v, lam).toarray() for strut, v in self.parts(u)]
        return csr_array(block_diag(blocks)) if self.sparse else block_diag(blocks).toarray()

    def d_lam(self, u, lam):
        return np.concatenate([strut.d_lam(v, lam) for strut, v in self.parts(u)])

    def inner(self, u, v):
        return float(u @ v) / self.struts[0].n


class Bare:
    """A model with its four methods and nothing else: no bounds, no measures, a dense Jacobian."""

    def __init__(self, model):
        self.model = model

    def residual(self, u, lam):
        return self.model.residual(u, lam)

    def jacobian(self, u, lam):
        return self.model.jacobian(u, lam).toarray()

    def d_lam(self, u, lam):
        return self.model.d_lam(u, lam)

    def inner(self, u, v):
        return self.model.inner(u, v)


class Bratu:
    """u'' + lam exp(u) = 0, u(0) = u(1) = 0, by differences on n inner points: a student's ten lines."""

    def __init__(self, n):
        self.n, self.h = n, 1 / (n + 1)
        self.A = diags_array([np.ones(n - 1), np.full(n, -2.0), np.ones(n - 1)], offsets=[-1, 0, 1]) / self.h**2

    def residual(self, u, lam):
        return self.A @ u + lam * np.exp(u)

    def jacobian(self, u, lam):
        return self.A + diags_array(lam * np.exp(u))

    def d_lam(self, u, lam):
        return np.exp(u)

    def inner(self, u, v):
        return self.h * (u @ v)


def fine_run(strut, u, lam, to, ds):
    """The angles at the load `to` on the branch from (u, lam): tiny pseudo-arclength steps, nothing of rodlab's continuation."""
    h, n = strut.joints.h, strut.n

    def solved(y, row, *sides):
        H = strut.hessian(y[:-1], y[-1])
        bands = np.zeros((3, n))
        bands[0, 1:], bands[1], bands[2, :-1] = H.off_diagonal, H.diagonal, H.off_diagonal
        x = solve_banded((1, 1), bands, np.column_stack([strut.d_lam(y[:-1], y[-1]), *(f for f, _ in sides)]))
        out = []
        for (_, g), xf in zip(sides, x.T[1:], strict=True):
            dlam = (g - row[:-1] @ xf) / (row[-1] - row[:-1] @ x[:, 0])
            out.append(np.append(xf - dlam * x[:, 0], dlam))
        return out

    y, row = np.append(u, lam), np.append(np.zeros(n), np.sign(to - lam))
    for _ in range(200_000):
        (t,) = solved(y, row, (np.zeros(n), 1.0))
        t /= np.sqrt(h * t[:-1] @ t[:-1] + t[-1] ** 2)
        row = np.append(h * t[:-1], t[-1])
        if (y[-1] + ds * t[-1] - to) * np.sign(to) >= 0:
            return rl.equilibrium(strut, to, y[:-1] + (to - y[-1]) / t[-1] * t[:-1]).u
        y = y + ds * t
        for _ in range(3):
            (step,) = solved(y, row, (-strut.gradient(y[:-1], y[-1]), 0.0))
            y = y + step
    raise AssertionError("the fine run did not arrive")
