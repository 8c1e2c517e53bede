"""Solve with a matrix and a border, also where the matrix itself is singular.

    [ A    B ] [x]   [f]        A (n, n) known by its factor, B and C (n, m), D (m, m)
    [ C^T  D ] [y] = [g]

At a fold or branch point A is singular and the bordered matrix is not. Plain block elimination then loses
everything; Govaerts' mixed block elimination (solve the transposed problem for y first, then correct) is stable for
any A whose perturbed factor is backward stable [Govaerts, SIAM J. Matrix Anal. 12 (1991) 469; Govaerts and Pryce,
IMA J. Numer. Anal. 13 (1993) 161]. A border of width m is m borders of width one, each around the last.
"""

from typing import Any

import numpy as np

from rodlab.numerics.arrays import EPS, Array, vector
from rodlab.numerics.factor import Solves
from rodlab.numerics.factor import factor as factored


class OneBorder:
    """Mixed block elimination for a border of width one, [[A, b], [c^T, d]]; itself a factored matrix of order n + 1.

    >>> from rodlab.numerics.factor import factor
    >>> OneBorder(factor(np.diag([1.0, 0.0])), np.array([0.0, 1.0]), np.array([0.0, 1.0]), 0.0).solve(np.array([1.0, 2.0, 3.0]))
    array([1., 3., 2.])
    """

    def __init__(self, inner: Solves, b: Array, c: Array, d: float) -> None:
        self.inner, self.b, self.c, self.d = inner, b, c, d
        self.v, self.w = inner.solve(b), inner.solve_transposed(c)
        self.right = _nonzero(float(d - c @ self.v))
        self.left = _nonzero(float(d - self.w @ b))

    def solve(self, fg: Array, /) -> Array:
        """(x, y) with A x + b y = f, c.x + d y = g; once, without refinement."""
        return self._solve(fg, self.inner.solve, self.b, self.c, self.v, self.w, self.right, self.left)

    def solve_transposed(self, fg: Array, /) -> Array:
        """The same with the transposed matrix."""
        return self._solve(fg, self.inner.solve_transposed, self.c, self.b, self.w, self.v, self.left, self.right)

    def _solve(self, fg: Array, inner: Any, b: Array, c: Array, v: Array, w: Array, right: float, left: float) -> Array:
        f, g = fg[:-1], fg[-1]
        y1 = (g - w @ f) / left  # the border first, by the transposed problem
        x1 = inner(f - b * y1)
        y2 = (g - self.d * y1 - c @ x1) / right
        x = np.empty_like(fg)
        np.subtract(x1, v * y2, out=x[:-1])
        x[-1] = y1 + y2
        return x


class Bordered:
    """The bordered matrix [[A, B], [C^T, D]], solved to full accuracy whether or not A is singular.

    `matrix` multiplies (A @ x), `factor` solves with A, its zero pivots perturbed. B, C: shape (n, m); D: (m, m).

    >>> from rodlab.numerics.factor import factor
    >>> A = np.array([[1.0, -1.0], [-1.0, 1.0]])                        # singular
    >>> M = Bordered(A, factor(A), B=np.ones((2, 1)), C=np.ones((2, 1)), D=np.zeros((1, 1)))
    >>> x, y = M.solve(np.array([1.0, 0.0]), np.array([0.0]))
    >>> np.allclose(x, [0.25, -0.25], atol=1e-15), np.allclose(y, [0.5])
    (True, True)
    """

    def __init__(self, matrix: Any, factor: Solves, *, B: Array, C: Array, D: Array) -> None:
        B, C, D = (np.asarray(block, dtype=np.float64) for block in (B, C, D))
        if B.ndim != 2 or B.shape != C.shape or D.shape != (B.shape[1], B.shape[1]) or B.shape[1] == 0:
            raise ValueError(f"B and C must have shape (n, m) and D (m, m), m >= 1; they have {B.shape}, {C.shape}, {D.shape}")
        self.matrix, self.B, self.C, self.D = matrix, B, C, D
        self._solver = self._whole() if isinstance(matrix, np.ndarray) or hasattr(matrix, "tocsc") else self._nested(factor)

    def _whole(self) -> Solves:
        """An unstructured matrix is factored with its border, pivots chosen in both."""
        if isinstance(self.matrix, np.ndarray):
            return factored(np.block([[self.matrix, self.B], [self.C.T, self.D]]))
        from scipy.sparse import block_array

        blocks: Any = [[self.matrix, self.B], [self.C.T, self.D]]
        return factored(block_array(blocks, format="csc"))

    def _nested(self, factor: Solves) -> Solves:
        """A structured one keeps its own factor, each column of the border around the last."""
        B, C, D, solver = self.B, self.C, self.D, factor
        for j in range(D.shape[0]):
            solver = OneBorder(solver, np.append(B[:, j], D[:j, j]), np.append(C[:, j], D[j, :j]), float(D[j, j]))
        return solver

    def solve_once(self, f: Array, g: Array) -> tuple[Array, Array]:
        """x (n,) and y (m,) without refinement, for an iteration that corrects itself."""
        with np.errstate(all="ignore"):
            z = self._solver.solve(np.append(f, g))
        return z[: f.size], z[f.size :]

    def solve(self, f: Array, g: Array) -> tuple[Array, Array]:
        """x (n,) and y (m,), refined until the correction stops shrinking.

        Raises `ArithmeticError` when the bordered matrix is itself singular: nothing then is a solution.
        """
        f, g = vector("f", f, self.B.shape[0]), vector("g", g, self.B.shape[1])
        n = f.size
        z, size = np.zeros(n + g.size), np.inf
        for _ in range(4):
            x, y = z[:n], z[n:]
            residual = np.append(f - self.matrix @ x - self.B @ y, g - self.C.T @ x - self.D @ y)
            with np.errstate(all="ignore"):
                step = self._solver.solve(residual)
            if not np.isfinite(step).all():
                raise ArithmeticError(f"the bordered matrix of order {n + g.size} is singular to working precision")
            last, size = size, float(np.abs(step).max(initial=0.0))
            if size >= last / 2:
                break
            z = z + step
            if size <= EPS * np.abs(z).max(initial=0.0):
                break
        if last < np.inf and size > 1e-8 * np.abs(z).max(initial=0.0):
            raise ArithmeticError(f"the bordered matrix of order {n + g.size} is singular to working precision")
        return z[:n], z[n:]


def _nonzero(pivot: float) -> float:
    return pivot or EPS
