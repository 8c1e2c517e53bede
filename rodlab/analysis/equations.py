"""Anything with a residual, its Jacobian, its derivative in the load and a length: F(u, lam) = 0.

Four methods suffice. What more a model knows it tells by further members, each read where it is of use:

    measures          name -> function of (u, lam)             a point answers for the model: tip_angle, height, energy
    second_variation  symmetric matrix at (u, lam)             index and nullity (else the Jacobian, where symmetric)
    lipschitz         bounds on the change of the derivatives  a step is proved; the index is that of the exact solution
    embedding         max |w|^2 <= a w.Jw + b w.w              longer steps are proved
    start             u from a guess, None for the natural one
    nodes, shape      s, phi and x, z of one shape; or shape_at(u, lam) -> (s, phi, x, z)
    rounding          bound on v . (computed residual - exact)  the error of a point
    residual_wide     the residual to more digits               the last corrections see it
    seen              what of du the bounds of `lipschitz` are in
    adapted           (u, lam, tangent) -> the same problem on a better mesh with u and tangent on it, None where its own serves;
                      with `moved`, `suited`, `mesh`, `on_points`: each point of a branch carries its own equations
    observed          which unknown a point's error is of, the last if not
    error, inertia    of a point, where meshes are compared for them; `missed`: what a mesh misses of v.F and v.Jv
    between           phi, x, z at any s
    constraints       how many of the unknowns are multipliers: such a model is not solved downhill
    recipe            plain data that make it again             a saved branch can be read with its model
    symmetries        maps u -> u that take solutions to such   a diagram recognises images
    vary              (name, lam) -> the same model             another parameter in the load's place

lipschitz(u, lam) returns a function of (du, dlam) that bounds, for all |u' - u| <= du entrywise and |lam' - lam| <= dlam, the
change of the Jacobian by a diagonal d, -d <= J' - J <= d, and that of d_lam entrywise; numbers or shape (n,), convex. The
residual must be at most linear in lam. embedding(lam) returns (a, b) that hold for every load of at most the size |lam|.
"""

from typing import Any, Protocol, runtime_checkable

import numpy as np

from rodlab.numerics.arrays import Array, vector


@runtime_checkable
class Equations(Protocol):
    """F(u, lam) = 0 with u of shape (n,).

    `jacobian` returns a numpy array, a scipy sparse matrix, or one of rodlab's structured matrices.

    >>> class Square:
    ...     def residual(self, u, lam): return u**2 - lam
    ...     def jacobian(self, u, lam): return np.diag(2 * u)
    ...     def d_lam(self, u, lam): return -np.ones_like(u)
    ...     def inner(self, u, v): return u @ v
    >>> isinstance(Square(), Equations)
    True
    """

    def residual(self, u: Array, lam: float, /) -> Array:
        """F(u, lam), shape of u."""
        ...

    def jacobian(self, u: Array, lam: float, /) -> Any:
        """dF/du."""
        ...

    def d_lam(self, u: Array, lam: float, /) -> Array:
        """dF/dlam, shape of u."""
        ...

    def inner(self, u: Array, v: Array, /) -> float:
        """The scalar product in which steps are measured."""
        ...


def jacobian(equations: Equations, u: Array, lam: float) -> Any:
    """The Jacobian as a matrix: structured, scipy sparse, or a numpy array also where rows came as lists."""
    return as_matrix(equations.jacobian(u, lam))


def second_variation(equations: Equations, u: Array, lam: float) -> Any:
    """The symmetric matrix whose negative eigenvalues are the index: the model's own, else the Jacobian."""
    own = getattr(equations, "second_variation", None)
    return jacobian(equations, u, lam) if own is None else as_matrix(own(u, lam))


def as_matrix(given: Any) -> Any:
    """Rows in lists as a numpy array; any other matrix as it is."""
    return np.asarray(given) if isinstance(given, (list, tuple, np.matrix)) else given


def started(equations: Equations, guess: Any) -> Array:
    """The first iterate: the model's own way of reading a guess, or the array itself."""
    missing = [name for name in ("residual", "jacobian", "d_lam", "inner") if not hasattr(equations, name)]
    if missing or isinstance(equations, type):
        lacks = f"lacks {', '.join(missing)}" if missing else "is a class, not an object"
        raise ValueError(f"model must have the methods of rodlab.Equations; {equations!r:.60} {lacks}")
    start = getattr(equations, "start", None)
    if start is not None:
        return np.asarray(start(guess))
    if guess is None:
        raise ValueError(f"guess must be given: {type(equations).__name__} has no state to start from")
    return vector("guess", guess).copy()
