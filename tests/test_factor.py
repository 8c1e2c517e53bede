"""One door to every matrix, and borders around singular ones."""

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array

import rodlab as rl
from rodlab.numerics.factor import shifted, solve
from rodlab.numerics.full import Full
from rodlab.numerics.tridiagonal import Tridiagonal


def kinds(A):
    d, e = np.diagonal(A).copy(), np.diagonal(A, 1).copy()
    return {"structured": Tridiagonal(d, e), "dense": A, "sparse": csr_array(A), "full": Full(A)}


@pytest.fixture(params=["structured", "dense", "sparse", "full"])
def kind(request):
    return request.param


def random_tridiagonal(n, seed):
    rng = np.random.default_rng(seed)
    return np.diag(rng.standard_normal(n)) + (E := np.diag(rng.standard_normal(n - 1), 1)) + E.T


@pytest.mark.parametrize("seed", range(5))
def test_every_kind_solves_and_counts(kind, seed):
    A = random_tridiagonal(40, seed)
    matrix, b = kinds(A)[kind], np.arange(40.0)
    F = rl.factor(matrix)
    assert A @ F.solve(b) == pytest.approx(b, abs=1e-10)
    assert A.T @ F.solve_transposed(b) == pytest.approx(b, abs=1e-10)
    assert A @ solve(matrix, b) == pytest.approx(b, abs=1e-10)
    w = np.linalg.eigvalsh(A)
    assert F.inertia() == ((w < 0).sum(), 0, (w > 0).sum())
    moved = rl.factor(shifted(matrix, 0.5)).inertia()
    assert moved.negative == (w < -0.5).sum()


def test_a_matrix_that_is_not_symmetric_has_no_index():
    A = np.array([[1.0, 2.0], [0.0, 1.0]])
    assert rl.factor(A).inertia() is None
    assert rl.factor(csr_array(A)).inertia() is None
    assert rl.factor(csr_array(A)).solve_transposed(np.array([1.0, 0.0])) == pytest.approx([1.0, -2.0])


def test_sparse_inertia_of_a_grid_matches_lapack():
    n = 12
    line = diags_array([np.full(n, 2.0), np.full(n - 1, -1.0), np.full(n - 1, -1.0)], offsets=[0, 1, -1])
    one = np.eye(n)
    A = csr_array(np.kron(line.toarray(), one) + np.kron(one, line.toarray()) - 3.03 * np.eye(n * n))
    w = np.linalg.eigvalsh(A.toarray())
    assert rl.factor(A).inertia() == ((w < 0).sum(), 0, (w > 0).sum())


@pytest.mark.parametrize("bad", [np.ones((2, 3)), np.array([[np.nan]]), csr_array(np.ones((2, 3)))])
def test_bad_matrices_are_refused(bad):
    with pytest.raises(ValueError, match="the matrix must be"):
        rl.factor(bad)


@pytest.mark.parametrize("width", [1, 2, 3])
def test_borders_make_singular_matrices_regular(kind, width):
    """A of nullity `width`, bordered by its null vectors: solved to full accuracy, where A alone cannot be."""
    n = 30
    A = np.zeros((n, n))
    blocks = np.array_split(np.arange(n), width)
    null = np.zeros((n, width))
    for j, rows in enumerate(blocks):  # free chains: each has a rigid motion
        m = rows.size
        D = np.diff(np.eye(m), axis=0)
        A[np.ix_(rows, rows)] = D.T @ D
        null[rows, j] = 1 / np.sqrt(m)
    matrix = kinds(A)[kind]
    M = rl.Bordered(matrix if kind != "sparse" else csr_array(A), rl.factor(matrix), B=null, C=null, D=np.zeros((width, width)))
    rng = np.random.default_rng(0)
    x, y = rng.standard_normal(n), rng.standard_normal(width)
    got_x, got_y = M.solve(A @ x + null @ y, null.T @ x)
    assert got_x == pytest.approx(x, abs=1e-12)
    assert got_y == pytest.approx(y, abs=1e-12)


def test_nearly_singular_matrices_lose_nothing_in_the_border():
    rng = np.random.default_rng(3)
    for size in 10.0 ** -np.arange(0, 17.0):
        T = Tridiagonal(np.array([1.0, 2.0, 1.0 + size]), np.array([-1.0, -1.0]))
        b = c = np.ones((3, 1))
        x, y = rng.standard_normal(3), rng.standard_normal(1)
        got_x, got_y = rl.Bordered(T, rl.factor(T), B=b, C=c, D=np.zeros((1, 1))).solve(T @ x + b @ y, c.T @ x)
        assert got_x == pytest.approx(x, abs=1e-13)
        assert got_y == pytest.approx(y, abs=1e-13)


def test_a_singular_bordered_matrix_is_said_to_be():
    T = Tridiagonal(np.array([1.0, 1.0]), np.array([-1.0]))
    zero = np.zeros((2, 1))
    with pytest.raises(ArithmeticError, match="singular to working precision"):
        rl.Bordered(T, rl.factor(T), B=zero, C=zero, D=np.zeros((1, 1))).solve(np.ones(2), np.ones(1))
