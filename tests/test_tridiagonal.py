"""Solve and inertia of tridiagonal matrices against exact fractions and LAPACK's eigenvalues."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rodlab.lab.studies.truths import exact_index
from rodlab.numerics import tridiagonal
from rodlab.numerics.difference import DifferenceForm, Springs
from rodlab.numerics.tridiagonal import Tridiagonal, count_below_zero

small = st.integers(-2, 2).map(float)


@st.composite
def matrices(draw, entry):
    n = draw(st.integers(1, 12))
    return (
        np.array(draw(st.lists(entry, min_size=n, max_size=n))),
        np.array(draw(st.lists(entry, min_size=n - 1, max_size=n - 1)), dtype=float),
    )


@given(matrices(small))
def test_inertia_of_small_whole_numbers_is_exact_zero_pivots_and_all(matrix):
    d, e = matrix
    w = np.linalg.eigvalsh(Tridiagonal(d, e).toarray())
    inertia = Tridiagonal(d, e).inertia()
    assert inertia == ((w < -1e-9).sum(), (abs(w) <= 1e-9).sum(), (w > 1e-9).sum())
    if (e != 0).all():
        negative, zero = exact_index(d, e)
        assert (inertia.negative, inertia.unclear) == (negative, zero)


@given(matrices(st.floats(-1e3, 1e3).filter(lambda x: x == 0 or abs(x) > 1e-6)))
def test_inertia_holds_the_exact_index_between_its_bounds(matrix):
    d, e = matrix
    if not (e != 0).all():
        return
    negative, zero = exact_index(d, e)
    inertia = Tridiagonal(d, e).inertia()
    assert inertia.negative <= negative <= negative + zero <= inertia.negative + inertia.unclear


@pytest.mark.parametrize("closed", [False, True])
def test_the_two_ways_of_counting_agree(closed):
    rng = np.random.default_rng(0)
    for _ in range(200):
        n = int(rng.integers(2, 60))
        d, e = rng.standard_normal(n), rng.standard_normal(n - 1)
        count = tridiagonal._count_by_bisection(d.copy(), e.copy(), closed=closed)
        assert count == count_below_zero(d, e, closed=closed) == (np.linalg.eigvalsh(Tridiagonal(d, e).toarray()) < 0).sum()


@pytest.mark.parametrize("n", [500, 1000, 1001])
def test_a_zero_diagonal_has_as_many_signs_of_either_kind(n):
    """Every second pivot is zero, the next then huge: neither is taken for the scale of the rest."""
    d, e = np.zeros(n), np.ones(n - 1)
    assert count_below_zero(d, e, closed=False) == n // 2
    assert count_below_zero(d, e, closed=True) == (n + 1) // 2
    assert Tridiagonal(d, e).inertia() == (n // 2, n % 2, n // 2)


def test_many_negative_pivots_are_counted_by_bisection_of_the_rest():
    n = 2000
    d, e = np.where(np.arange(n) % 2, 1.0, -1.0), np.full(n - 1, 0.25)
    assert Tridiagonal(d, e).inertia() == (n // 2, 0, n // 2)


@given(matrices(st.floats(-10, 10)), st.randoms(use_true_random=False))
def test_solve_leaves_a_residual_of_rounding(matrix, random):
    d, e = matrix
    b = np.array([random.uniform(-1, 1) for _ in d])
    for scale in (1.0, 1e-100, 1e100):
        T = Tridiagonal(scale * d, scale * e)
        A = T.toarray()
        if not np.linalg.cond(A / scale) < 1e6:
            continue
        for x in (T.solve(b), T.factor().solve(b), T.factor().solve_transposed(b)):
            assert np.abs(T @ x - b).max() <= 1e-8 * (np.abs(A).max() * np.abs(x).max() + np.abs(b).max())


def test_a_singular_matrix_is_factored_with_a_perturbed_pivot():
    T = Tridiagonal(np.array([1.0, 1.0]), np.array([-1.0]))
    assert T.inertia() == (0, 1, 1)
    assert (T.index, T.nullity, T.index_verified) == (0, 1, False)
    x = T.factor().solve(np.array([1.0, 1.0]))
    assert np.isfinite(x).all()
    assert x[0] / x[1] == pytest.approx(1)


def test_the_zero_pivot_of_the_notes():
    """n = 2, k = h = lam = 1 on the trivial branch: a zero pivot, nonsingular, index 1."""
    T = Tridiagonal(np.array([1.0, 0.0]), np.array([-1.0]))
    assert T.inertia() == (1, 0, 1)
    assert T.solve(np.array([1.0, 0.0])) == pytest.approx([0.0, -1.0])


@pytest.mark.parametrize("size", [0.0, 1e-20, 1e-9])
def test_a_zero_diagonal_is_pivoted(size):
    rng = np.random.default_rng(0)
    for n in (2, 4, 10):
        T, x = Tridiagonal(np.full(n, size), rng.uniform(1, 2, n - 1)), rng.standard_normal(n)
        assert T.solve(T @ x) == pytest.approx(x, rel=1e-6)


def test_a_side_of_the_wrong_length_is_refused():
    T = Tridiagonal(np.full(3, 2.0), np.ones(2))
    for solve in (T.solve, T.factor().solve, DifferenceForm(Springs(np.ones(3)), np.zeros(3)).solve):
        for b in (np.ones(2), [1.0, 2.0, 3.0, 4.0]):
            with pytest.raises(ValueError, match=r"b must have shape \(3,\)"):
                solve(b)


def test_no_determinant_overflows():
    n = 5000
    T = Tridiagonal(np.full(n, 1e8), np.full(n - 1, 1e-8))
    assert T.index == 0
    assert Tridiagonal(-T.diagonal, T.off_diagonal).index == n
    assert np.isfinite(T.solve(np.ones(n))).all()


@pytest.mark.parametrize(
    ("d", "e", "says"),
    [
        ([1.0, np.nan], [1.0], "diagonal must be finite; entry 1 is nan"),
        ([1.0, 2.0], [np.inf], "off_diagonal must be finite; entry 0 is inf"),
        ([1.0, 2.0], [1.0, 2.0], r"off_diagonal must have shape \(1,\)"),
        ([], [], "at least one entry"),
        ([[1.0]], [], "one dimension"),
    ],
)
def test_bad_entries_are_named(d, e, says):
    with pytest.raises(ValueError, match=says):
        Tridiagonal(np.array(d), np.array(e))


def mp_solve(k, c, r):
    """(solution, number of negative pivots) of (D^T k D - diag c) y = r in 60 digits."""
    with mp.workdps(60):
        n, k = len(k), [*map(mp.mpf, k), mp.mpf(0)]
        d = [k[i] + k[i + 1] - mp.mpf(c[i]) for i in range(n)]
        y = [mp.mpf(x) for x in r]
        for i in range(1, n):
            q = k[i] / d[i - 1]
            d[i], y[i] = d[i] - q * k[i], y[i] + q * y[i - 1]
        for i in reversed(range(n)):
            y[i] = (y[i] + (k[i + 1] * y[i + 1] if i + 1 < n else 0)) / d[i]
        return np.array([float(x) for x in y]), sum(x < 0 for x in d)


def random_forms(count):
    rng = np.random.default_rng(1)
    for _ in range(count):
        n, decades = int(rng.integers(1, 60)), rng.uniform(0, 12)
        k = 10.0 ** rng.uniform(-decades, decades, n)
        c = rng.choice([0, 1e-3, 1, 1e3]) * rng.standard_normal(n) * 10.0 ** rng.uniform(-2, 2) * k.min()
        yield k, c, rng.standard_normal(n)


def test_springs_over_24_decades_are_solved_and_counted():
    """Where summing the springs would cost the digits the mixed form is taken: 1e-12 there, 1e-3 at the border."""
    mixed = 0
    for k, c, r in random_forms(300):
        A = DifferenceForm(Springs(k), c)
        x, negative = mp_solve(k, c, r)
        hurts = A.springs.summing_hurts
        mixed += hurts
        for y in (A.solve(r), A.factor().solve(r)):
            assert np.abs(y - x).max() <= (1e-12 if hurts else 2e-3) * np.abs(x).max()
        inertia = A.inertia()
        assert inertia.negative <= negative <= inertia.negative + inertia.unclear
        assert inertia.verified
    assert mixed > 20


def test_the_mixed_form_decides_what_the_entries_leave_unclear():
    """n = 10^5, loads a relative 10^-7 from the first: the entries know the index to 10^-5 only."""
    n = 10**5
    first = 4 * n * n * np.sin(np.pi / (2 * (2 * n + 1))) ** 2
    for side, index in ((1 - 1e-7, 0), (1 + 1e-7, 1)):
        A = DifferenceForm(Springs(np.full(n, float(n))), np.full(n, side * first / n))
        assert not A.summed.inertia(2e-16 * A.springs.diagonal).verified
        assert A.inertia() == (index, 0, n - index)


def test_difference_form_is_the_matrix_it_says():
    rng = np.random.default_rng(2)
    k, c, y = rng.uniform(1, 2, 6), rng.standard_normal(6), rng.standard_normal(6)
    A = DifferenceForm(Springs(k), c)
    D = np.eye(6) - np.eye(6, k=-1)
    dense = D.T @ np.diag(k) @ D - np.diag(c)
    assert A.toarray() == pytest.approx(dense)
    assert A @ y == pytest.approx(dense @ y)
    assert A.shifted(2.0).toarray() == pytest.approx(dense + 2 * np.eye(6))


def test_springs_must_be_positive():
    with pytest.raises(ValueError, match="k must be positive; entry 1"):
        Springs(np.array([1.0, 0.0]))
