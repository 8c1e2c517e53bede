"""Orders, floors, limits and growth: known sequences give back what they were made of."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rodlab.numerics.orders import growth, observed_order, richardson

SIZES = np.array([8, 16, 32, 64, 128, 256])


@given(st.integers(1, 6), st.floats(0.1, 10), st.floats(-2, 2), st.integers(1, 2))
def test_the_order_is_within_its_uncertainty(p, size, next_power, step):
    errors = size * SIZES ** (-float(p)) * (1 + next_power * SIZES ** (-float(step)))
    found = observed_order(SIZES, errors, step=step)
    assert found.clear
    assert abs(found.order - p) <= max(found.uncertainty, 1e-9)
    assert found.floor is None
    assert found.local[0] is None
    assert found.local[1] == pytest.approx(np.log2(errors[0] / errors[1]))


@given(st.integers(2, 4), st.integers(0, 1000))
def test_rounding_is_found_and_no_order_is_read_from_it(p, seed):
    noise = 1e-13 * np.random.default_rng(seed).uniform(0.1, 1, 9)
    sizes = 8.0 * 2.0 ** np.arange(9)
    errors = sizes ** (-3.0 * p) + noise
    found = observed_order(sizes, errors, noise=1e-13)
    where = errors > 30 * 1e-13
    assert all(order is None for order in np.array(found.local, dtype=object)[~where])
    assert found.order is None or not found.clear or abs(found.order - 3 * p) <= 0.1
    if not where[-4:].any() and (np.diff(errors[-4:]) > 0).any():
        assert found.floor < 2e-13


def test_a_dip_is_no_floor():
    """An error that changes sign is small once, and large again: no rounding."""
    found = observed_order([4, 8, 16, 32, 64, 128], np.abs([-1e-2, 1e-6, 2e-4, 6e-5, 1.6e-5, 4.05e-6]), step=2)
    assert found.floor is None
    assert found.order == pytest.approx(2.0, abs=0.1)


def test_two_errors_tell_an_order_but_not_how_well():
    found = observed_order([4, 8], [1e-2, 2.5e-3])
    assert (found.order, found.uncertainty, found.clear) == (pytest.approx(2.0), None, False)
    assert observed_order([4], [1e-2]).order is None


@given(st.lists(st.floats(-5, 5), min_size=4, max_size=4), st.integers(1, 2))
def test_extrapolation_is_exact_for_polynomials_in_h(coefficients, step):
    h = 1 / np.array([4.0, 8.0, 12.0, 24.0, 40.0])
    values = 3.0 + sum(c * h ** (step * (k + 1)) for k, c in enumerate(coefficients))
    limit, columns = richardson(1 / h, values, order=step, step=step, stages=4)
    assert columns[4][-1] == pytest.approx(3.0, abs=1e-11)
    assert len(columns) == 5
    assert limit.estimate < np.inf


@given(st.floats(0.5, 5), st.lists(st.floats(0, 1), min_size=3, max_size=3), st.sampled_from([1, -1]), st.integers(1, 2))
def test_the_estimate_of_a_limit_holds(first, later, sign, step):
    h = 1 / (8.0 * 2.0 ** np.arange(4))
    coefficients = first * np.cumprod([1.0, *later])
    values = 3.0 + sum(c * (sign * h**step) ** (k + 1) for k, c in enumerate(coefficients))
    limit, _ = richardson(1 / h, values, order=step, step=step)
    assert abs(limit.value - 3.0) <= limit.estimate + 1e-14


def test_extrapolation_in_other_powers_and_its_rounding():
    n = 2.0 ** np.arange(2, 8)
    limit, columns = richardson(n, 1 + n**-4 + n**-6, order=4, step=2, rounding=1e-16)
    assert columns[2][-1] == pytest.approx(1.0, abs=1e-15)
    assert 1e-16 < limit.estimate < 1e-10
    assert abs(limit.value - 1) <= limit.estimate
    only, _ = richardson([4.0], [2.0], 1, 1)
    assert (only.value, only.estimate) == (2.0, np.inf)


def test_growth_is_told_only_where_it_shows():
    n = 10.0 ** np.arange(1, 7)
    assert growth(n, 1e-6 * n**1.5).exponent == pytest.approx(1.5)
    assert growth(n, np.full(6, 1e-3)).exponent is None
    found = growth(n, 1e-3 + 1e-6 * n)
    assert found.first == 1e4
    assert abs(found.exponent - 1) <= 0.1
    assert growth(n[:2], n[:2]).exponent is None


@pytest.mark.parametrize("sizes", [[], [0, 1], [2, 1], [1, 1]])
def test_sizes_that_are_none_are_refused(sizes):
    with pytest.raises(ValueError, match="sizes must be positive and ascending"):
        observed_order(sizes, [1.0] * len(sizes))
    with pytest.raises(ValueError, match="must"):
        growth(sizes, [1.0] * 7)
