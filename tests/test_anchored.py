"""The full second variation on a foundation, in O(n), against exact fractions, LAPACK's eigenvalues and the strut itself."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rodlab
from rodlab.mechanics.places import Places
from rodlab.numerics import anchored
from rodlab.numerics.anchored import Anchored
from rodlab.numerics.difference import DifferenceForm, Springs
from rodlab.numerics.tridiagonal import Tridiagonal


def on_foundation(strut, phi, lam, c):
    """The second variation of a strut with foundation(c)."""
    joints, places = strut.joints, Places(strut.joints)
    cosine = joints.h * joints.w * np.cos(phi)
    upper, lower = places.theta * cosine, np.append(0.0, (1 - places.theta) * cosine[:-1])
    upper[-1] = cosine[-1]
    stiffness = np.broadcast_to(c, joints.n) * joints.h * joints.w
    softening = lam * cosine + places.softening(phi, stiffness * places.of(phi)[0], 0.0)
    return Anchored(DifferenceForm(strut.springs, softening), lower[None], upper[None], stiffness[None, None])


def dense(A):
    """The same matrix by its definition."""
    n = A.shape[0]
    J = [
        np.tril(np.tile(up, (n, 1))) + np.tril(np.tile(np.append(low[1:], 0.0), (n, 1)), -1)
        for low, up in zip(A.lower, A.upper, strict=True)
    ]
    couples = sum(J[k].T @ np.diag(A.stiffness[k, m]) @ J[m] for k in range(len(J)) for m in range(len(J)))
    return A.local.toarray() + couples


def random_matrix(rng, n, components, jumps=0.0, springs=True, size=1e3):
    """A strut of any shape on a foundation of any sign, its springs jumping by factors up to 10**jumps."""
    phi, h, theta = rng.standard_normal(n) * rng.choice([0, 1e-6, 1]), 1 / n, rng.choice([0.5, 1.0])
    directions = np.array([np.cos(phi), -np.sin(phi)])[:components]
    upper, lower = theta * h * directions, (1 - theta) * h * np.roll(directions, 1, axis=1)
    C = size * h * rng.standard_normal((components, components, n))
    local = DifferenceForm(Springs(n * 10.0 ** rng.uniform(0, jumps, n)), rng.choice([0.0, 3.0, 30.0, -10.0]) * h * np.cos(phi))
    return Anchored(local if springs else local.summed, lower, upper, (C + C.transpose(1, 0, 2)) / 2)


@st.composite
def matrices(draw, largest=40):
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    n, components = draw(st.integers(1, largest)), draw(st.integers(1, 2))
    return random_matrix(rng, n, components, draw(st.sampled_from([0, 6])), draw(st.booleans()), 10.0 ** draw(st.integers(-3, 6)))


exact = np.vectorize(Fraction, otypes=[object])


def exact_entries(A):
    """The dense matrix in fractions."""
    n = A.shape[0]
    C, upper, lower = exact(A.stiffness), exact(A.upper), exact(np.append(A.lower[:, 1:], 0 * A.lower[:, :1], axis=1))
    on_and_below = exact(np.tri(n)), exact(np.tri(n, k=-1))
    J = [on_and_below[0] * up + on_and_below[1] * low for low, up in zip(lower, upper, strict=True)]
    couples = sum((J[k].T * C[k, m]) @ J[m] for k in range(len(J)) for m in range(len(J)))
    if not isinstance(A.local, DifferenceForm):
        return exact(A.local.toarray()) + couples
    D = exact(np.eye(n) - np.eye(n, k=-1))
    return (D.T * exact(A.local.springs.k)) @ D - exact(np.eye(n)) * exact(A.local.c) + couples


def exact_signs(A):
    """(negative, zero) eigenvalues of A, by elimination in fractions; where the diagonal is zero a row is added to another."""
    M, negative = exact_entries(A), 0
    while M.any():
        p = int(np.abs(np.diag(M)).argmax())
        if M[p, p] == 0:
            i, j = np.argwhere(M != 0)[0]
            M[i] += M[j]
            M[:, i] += M[:, j]
            continue
        negative += M[p, p] < 0
        M = M - np.outer(M[:, p], M[p] / M[p, p])
        M = np.delete(np.delete(M, p, 0), p, 1)
    return int(negative), len(M)


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
@pytest.mark.parametrize("n", [1, 2, 3, 8, 61])
def test_it_is_the_hessian_of_the_strut(n, rule):
    rng = np.random.default_rng(n)
    strut = rodlab.Strut(n=n, K="1 + s", rule=rule, terms=(rodlab.foundation("100 * (1 + s)"),))
    phi = rng.standard_normal(n)
    A = on_foundation(strut, phi, 30.0, 100 * (1 + strut.joints.s))
    truth = strut.hessian(phi, 30.0).toarray()
    assert A.toarray() == pytest.approx(truth, abs=1e-12 * np.abs(truth).max())
    w = np.linalg.eigvalsh(truth)
    assert A.inertia() == ((w < 0).sum(), 0, (w > 0).sum())
    assert A.factor().sign() == (-1) ** (w < 0).sum()


@given(matrices())
def test_entries_products_and_forms_are_those_of_the_dense_matrix(A):
    M, y = dense(A), np.cos(np.arange(1.0, A.shape[0] + 1))
    close = 1e-12 * float(np.abs(M).max())
    assert A.toarray() == pytest.approx(M, abs=close)
    assert A.diagonal == pytest.approx(np.diag(M), abs=close)
    assert A.off_diagonal == pytest.approx(np.diag(M, 1), abs=close)
    assert A @ y == pytest.approx(M @ y, abs=100 * close)
    assert A.shifted(2.0).toarray() == pytest.approx(M + 2 * np.eye(y.size), abs=close + 1e-12)
    assert A.shifted(y).toarray() == pytest.approx(M + np.diag(y), abs=close + 1e-12)
    assert (abs(A).toarray() >= np.abs(M) - close).all()
    value, rounding = A.quadratic(y)
    assert abs(value - y @ M @ y) <= rounding + 100 * close
    assert rounding <= 1e3 * y.size * np.finfo(float).eps * (np.abs(y) @ abs(A).toarray() @ np.abs(y))


@given(matrices())
def test_solve_leaves_a_residual_of_rounding(A):
    M, b = dense(A), np.cos(np.arange(1.0, A.shape[0] + 1))
    assume(np.linalg.cond(M) < 1e10)
    for x in (A.solve(b), A.solve_fully(b), A.factor().solve(b), A.factor().solve_transposed(b)):
        assert np.abs(M @ x - b).max() <= 1e-11 * (np.abs(M).max() * np.abs(x).max() + 1)


@given(matrices())
def test_inertia_is_that_of_the_eigenvalues(A):
    w = np.linalg.eigvalsh(dense(A))
    size = np.abs(w).max()
    assume(np.abs(w).min() > 1e-9 * size)
    negative = int((w < 0).sum())
    assert A.inertia() == (negative, 0, w.size - negative)
    assert (A.index, A.index_within(np.abs(w).min() / 4)) == (negative, negative)
    assert A.index_within(np.abs(w).min() * 1.01) in (None, negative)
    assert A.inertia(2 * size).unclear == w.size
    assert A.factor().sign() in (0, (-1) ** negative)


@pytest.mark.parametrize("computed", [0, anchored.DENSE])
def test_no_sign_is_claimed_that_exact_fractions_deny(computed, monkeypatch):
    """Shifted by an eigenvalue, to rounding: the exact index lies between the bounds, and away from zero they meet."""
    monkeypatch.setattr(anchored, "DENSE", computed)
    rng = np.random.default_rng(computed)
    unclear = 0
    for _ in range(120):
        A = random_matrix(rng, int(rng.integers(1, 9)), int(rng.integers(1, 3)), rng.choice([0, 6]), rng.random() < 0.7)
        w = np.linalg.eigvalsh(A.toarray())
        A = A.shifted(-rng.choice(w) * (1 + rng.choice([0.0, 1e-15, -1e-13, 1e-11])))
        negative, zero = exact_signs(A)
        known = A.inertia()
        assert known.negative <= negative <= negative + zero <= known.negative + known.unclear
        assert sum(known) == w.size
        unclear += known.unclear > 0
    assert unclear > 20


def test_whole_numbers_that_make_every_pivot_zero():
    """A singular matrix, a joint whose place nothing moves, a foundation that is absent: never a wrong sign."""
    rng = np.random.default_rng(3)
    for _ in range(200):
        n, components = int(rng.integers(1, 7)), int(rng.integers(1, 3))
        C = rng.integers(-1, 2, (components, components, n)).astype(float)
        local = Tridiagonal(rng.integers(-1, 2, n).astype(float), rng.integers(-1, 2, n - 1).astype(float))
        lower, upper = rng.integers(-1, 2, (2, components, n)).astype(float)
        A = Anchored(local, lower, upper, np.triu(C.T).T + np.triu(C.T, 1).T if components == 1 else (C + C.transpose(1, 0, 2)))
        negative, zero = exact_signs(A)
        assert A.inertia() == (negative, zero, n - negative - zero)
        if zero == 0:
            assert A @ A.solve(np.ones(n)) == pytest.approx(np.ones(n), abs=1e-9)


@pytest.mark.parametrize("decades", [6, 12, 18])
def test_springs_that_jump_by_many_decades(decades):
    """No eigenvalue is lost in the rounding of a stiff neighbour: dense eigenvalues would be."""
    rng = np.random.default_rng(decades)
    for n in (5, 24):
        k = n * 10.0 ** rng.choice([0, decades], n)
        for lam in (1.0, 30.0, 300.0):
            A = on_foundation(rodlab.Strut.from_joints(k=k, h=1 / n), np.zeros(n), lam, 500.0)
            negative, zero = exact_signs(A)
            assert zero == 0
            assert A.inertia() == (negative, 0, n - negative)


@pytest.mark.parametrize("n", [300, 1001])
def test_stiff_parts_of_a_longer_strut(n):
    rng = np.random.default_rng(n)
    A = on_foundation(rodlab.Strut.from_joints(k=n * 1e6 ** rng.integers(0, 2, n), h=1 / n), np.zeros(n), 30.0, 500.0)
    w = np.linalg.eigvalsh(A.toarray())
    assert np.abs(w).min() > 1e-13 * w.max()
    assert A.inertia() == ((w < 0).sum(), 0, (w > 0).sum())


def first_load(n, c):
    """Bounds of the first load of a straight strut on a foundation, by the index, as near as it is told."""
    strut, zero, below, above = rodlab.Strut(n=n, rule="trapezoid"), np.zeros(n), 900.0, 1100.0
    while above - below > 1e-9 * above:
        middle = (below + above) / 2
        known = on_foundation(strut, zero, middle, c).inertia()
        if known.unclear:
            break
        below, above = (below, middle) if known.negative else (middle, above)
    return below, above


def test_a_long_strut_on_a_foundation_buckles_at_its_free_end():
    """lam -> sqrt(K c) as c grows [Hetenyi 1946], at order 2; told to eight digits."""
    errors = []
    for n in (1000, 2000):
        below, above = first_load(n, 1e6)
        assert above - below < 1e-8 * above
        errors.append(below - 1000)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.02)


@pytest.mark.parametrize("component", ["x", "both"])
def test_a_hundred_thousand_joints(component):
    n = 100_000
    s = np.arange(1, n + 1) / n
    A = on_foundation(rodlab.Strut(n=n, K="1 + s", rule="trapezoid"), 0.3 * np.sin(5 * s), 60.0, 200.0)
    if component == "both":
        slope = np.full(n, -0.25)
        C = np.array([[A.stiffness[0, 0], 0.1 * A.stiffness[0, 0]], [0.1 * A.stiffness[0, 0], 0.5 * A.stiffness[0, 0]]])
        A = Anchored(A.local, np.vstack([A.lower, slope * A.lower]), np.vstack([A.upper, slope * A.upper]), C)
    b = np.cos(9 * s) / n
    y = A.solve_fully(b)
    assert np.abs(A @ y - b).max() <= 1e-14 * (4 * n * np.abs(y).max())
    assert A.solve(b) == pytest.approx(y, abs=1e-5 * np.abs(y).max())
    assert A.index_verified
    assert A.factor().sign() == (-1) ** A.index
    coarse = on_foundation(rodlab.Strut(n=500, K="1 + s", rule="trapezoid"), 0.3 * np.sin(np.arange(1, 501) / 100), 60.0, 200.0)
    assert component == "both" or A.index == coarse.index == (np.linalg.eigvalsh(coarse.toarray()) < 0).sum()


def test_what_does_not_fit_is_refused():
    local, one = DifferenceForm(Springs(np.ones(3)), np.zeros(3)), np.ones((1, 3))
    with pytest.raises(ValueError, match=r"stiffness must have shape \(1, 1, 3\)"):
        Anchored(local, one, one, one)
    with pytest.raises(ValueError, match="upper must be finite"):
        Anchored(local, one, one * np.nan, one[None])
    with pytest.raises(ValueError, match=r"b must have shape \(3,\)"):
        Anchored(local, one, one, one[None]).solve(np.ones(2))
