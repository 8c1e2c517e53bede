"""One joint and two joints, in closed form [N 2.7 and its exercises]."""

import numpy as np
import pytest
from scipy.optimize import brentq

import rodlab as rl

ONE = rl.Strut.from_joints(k=[1])
TWO = rl.Strut.from_joints(k=[1, 1])
GOLDEN = (1 + np.sqrt(5)) / 2


def all_equilibria_of_two_joints(strut, lam):
    """Every root, by the recurrence from the clamp: one unknown phi_1 in |phi_1| <= 2 lam, scanned finely."""

    def second(a):
        return 2 * a - lam * np.sin(a)

    def end(a):
        b = second(a)
        return b - a - lam * np.sin(b)

    grid = np.linspace(-2 * lam - 0.1, 2 * lam + 0.1, 200_001)
    values = end(grid)
    signs = np.flatnonzero(values[1:] * values[:-1] < 0)
    roots = [brentq(end, grid[i], grid[i + 1], xtol=1e-15) for i in signs]
    assert np.count_nonzero(values == 0) <= 1
    roots += list(grid[values == 0])
    return [rl.equilibrium(strut, lam, [a, second(a)]) for a in sorted(roots)]


# --- one joint: lam = phi / sin(phi) ---------------------------------------------------------------------------------


@pytest.mark.parametrize("phi", [0.01, 0.5, 1.5, 3.0, -2.0, 7.0, 8.5])
def test_one_joint_lies_on_its_curve(phi):
    lam = phi / np.sin(phi)
    p = rl.equilibrium(ONE, lam, [phi])
    assert p.tip_angle == pytest.approx(phi, rel=1e-12)
    assert abs(p.tip_angle - phi) <= p.error + 4e-16 * abs(phi) / abs(1 - lam * np.cos(phi))
    assert p.index == (1 - lam * np.cos(phi) < 0)
    assert p.energy == pytest.approx(phi**2 / 2 + lam * np.cos(phi), rel=1e-14)


def test_one_joint_with_rest_angle():
    """lam = (phi - beta) / sin(phi); the fold at lam = 1 / cos(phi), beta = phi - tan(phi)."""
    beta, phi = 0.1, 0.9
    lam = (phi - beta) / np.sin(phi)
    assert rl.equilibrium(rl.Strut.from_joints(k=[1], beta=[beta]), lam, [1.0]).tip_angle == pytest.approx(phi, rel=1e-13)


def test_one_joint_buckles_at_one_where_the_index_is_not_known():
    p = rl.equilibrium(ONE, 1.0)
    assert (p.u[0], p.error) == (0.0, 0.0)
    assert (p.index, p.nullity, p.index_verified) == (0, 1, False)
    assert "not verified" in repr(p)
    assert rl.equilibrium(ONE, 1 - 1e-12).index_verified
    assert rl.equilibrium(ONE, 1 + 1e-12).index == 1


def test_newton_at_the_pitchfork_contracts_by_two_thirds():
    """phi - sin(phi) = 0: a root of multiplicity three; the history shows the ratio, the error is not hidden."""
    p = rl.equilibrium(ONE, 1.0, [1.0])
    steps = np.array([entry.step for entry in p.newton])
    assert steps[10:20] / steps[9:19] == pytest.approx(2 / 3, abs=1e-3)
    assert abs(p.tip_angle) < 1e-6
    assert not p.index_verified
    assert p.error == np.inf  # the Jacobian may be singular: no error is known, and none is pretended


# --- two joints ---------------------------------------------------------------------------------------------------


def test_two_joints_on_the_trivial_branch():
    """Eigenvalues (3 - 2 lam +- sqrt 5)/2: index 0, 1, 2; at lam = 1 a zero pivot on a nonsingular Hessian."""
    for lam in (0.0, 0.3, 0.5, 1.0, 2.0, 2.6, 2.7, 10.0, -5.0):
        w = np.array([(3 - 2 * lam - np.sqrt(5)) / 2, (3 - 2 * lam + np.sqrt(5)) / 2])
        H = TWO.hessian([0.0, 0.0], lam)
        assert np.linalg.eigvalsh(H.toarray()) == pytest.approx(w, abs=1e-12)
        assert (H.index, H.nullity) == ((w < 0).sum(), 0)


def test_two_joints_have_null_vectors_at_their_loads():
    for lam, null in (((3 - np.sqrt(5)) / 2, [1, GOLDEN]), ((3 + np.sqrt(5)) / 2, [GOLDEN, -1])):
        H = TWO.hessian([0.0, 0.0], lam)
        assert H @ np.array(null) == pytest.approx([0, 0], abs=1e-15)
        assert (H.nullity, H.index_verified) == (1, False)


@pytest.mark.parametrize(("lam", "indices"), [(0.2, [0]), (1.0, [0, 1, 0]), (3.0, [0, 1, 2, 1, 0])])
def test_all_equilibria_of_two_joints(lam, indices):
    """One equilibrium before the first load, three between the loads, five above: each with its index."""
    found = all_equilibria_of_two_joints(TWO, lam)
    assert [p.index for p in found] == indices
    assert all(p.index_verified for p in found)
    assert sum((-1) ** p.index for p in found) == 1
    for p, mirror in zip(found, reversed(found), strict=True):
        assert p.u == pytest.approx(-mirror.u, abs=1e-12)
        assert p.index == (np.linalg.eigvalsh(TWO.hessian(p.u, lam).toarray()) < 0).sum()
        assert p.error < 1e-14 * max(1, abs(p.tip_angle)) * 10


@pytest.mark.parametrize("j", [1, 2])
def test_two_joints_bend_as_expanded(j):
    """lam = lam_j + (1/2 -+ 1/sqrt 5) eps^2 + ..., |phi_2| = eps on branch 1 and 2."""
    load = (3 - (3 - 2 * j) * np.sqrt(5)) / 2
    coefficient = 0.5 - (3 - 2 * j) / np.sqrt(5)
    mode = rl.buckling(TWO, 2).modes[j - 1]
    for eps in (0.1, 0.05):
        lam = load + coefficient * eps**2
        p = rl.equilibrium(TWO, lam, eps * mode / abs(mode[1]))
        assert abs(p.u[1]) == pytest.approx(eps, abs=2 * eps**3)
        assert p.index == j - 1
