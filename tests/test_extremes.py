"""Stiff and extreme cases, as a table: a verified answer or one clear sentence, never a silent wrong one.

An answer is verified here by a residual in extended precision and one more Newton step from it.
"""

import numpy as np
import pytest

import rodlab as rl

LOADS = (-1e8, -1e3, -1.0, 0.0, 1.0, 2.4, 30.0, 1e3, 1e8)


def off(strut, p):
    """Distance of the tip angle from the exact solution, by a Newton step with the residual in extended precision."""
    L, j = np.longdouble, strut.joints
    phi = p.u.astype(L)
    below = np.concatenate([[L(j.phi0)], phi[:-1]])
    m = j.k.astype(L) * (phi - below - j.beta.astype(L))
    F = m - np.append(m[1:], L(0)) - L(p.lam) * L(j.h) * j.w.astype(L) * np.sin(phi)
    return abs(strut.hessian(p.u, p.lam).solve(-F.astype(float))[-1])


def verify(strut, lam, guess=None):
    """The point, or None where it was said that there is none; anything silent and wrong fails."""
    try:
        p = rl.equilibrium(strut, lam, guess)
    except rl.NoConvergence as sentence:
        assert str(sentence).startswith(("Newton did not converge", "neither Newton", "1000 steps"))
        return None
    assert np.isfinite(p.u).all()
    assert p.error >= 0
    if p.index_verified:
        assert off(strut, p) <= p.error + 1e-300
    return p


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
@pytest.mark.parametrize("u_hat", [0.0, 0.01, 1.0, 1e3])
@pytest.mark.parametrize("K", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("n", [1, 2, 10, 300])
def test_loads_of_both_signs_on_any_stiffness(n, K, u_hat, rule):
    """lam from -1e8 to 1e8, K from 1e-12 to 1e12, u_hat from 0 to 1e3: every one solved, none silently wrong."""
    strut = rl.Strut(n=n, K=K, u_hat=u_hat, rule=rule)
    for lam in LOADS:
        p = verify(strut, lam)
        assert p is not None
        assert p.error <= 1e-9 * max(1.0, abs(p.tip_angle)) or not p.index_verified


@pytest.mark.parametrize("decades", [6, 12])
@pytest.mark.parametrize("n", [2, 10, 100])
def test_stiffness_ratios(n, decades):
    """Springs over 12 and 24 decades: what angles can hold is solved, and the error says how well."""
    solved = 0
    for seed in range(4):
        k = 10.0 ** np.random.default_rng(seed).uniform(-decades, decades, n)
        for beta in (0.0, 0.1):
            strut = rl.Strut.from_joints(k=k, beta=np.full(n, beta), h=1 / n)
            for lam in (-1.0, 0.0, 1e-9, 1.0):
                solved += verify(strut, lam) is not None
    assert solved >= {6: 32, 12: 28}[decades]


@pytest.mark.parametrize("n", [10**5, 10**6])
@pytest.mark.parametrize(("u_hat", "lam"), [(0.0, 5.0), (0.01, 2.4), (1.0, -1e8), (1.0, 30.0)])
def test_a_million_joints(n, u_hat, lam):
    strut = rl.Strut(n=n, u_hat=u_hat)
    guess = None if u_hat else (lambda s: 2 * np.sin(np.pi * s / 2))
    p = verify(strut, lam, guess)
    assert p is not None
    assert p.index_verified
    assert p.error < 1e-12
    residual = np.abs(strut.gradient(p.u, lam)).max()
    assert residual < 1e-4  # rounding of phi alone: no test of the residual would do


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
@pytest.mark.parametrize("n", [1, 2, 10, 1000])
def test_at_and_around_a_branch_point_the_index_is_right_or_said_to_be_unknown(n, rule):
    strut = rl.Strut(n=n, rule=rule)
    for j, load in enumerate(rl.buckling_loads(strut, min(n, 3)), start=1):
        at = rl.equilibrium(strut, load)
        assert (at.index, at.nullity, at.index_verified) == (j - 1, 1, False)
        assert (at.u == 0).all()
        assert at.error == 0
        for step in (1e-4, 1e-6, 1e-8, 1e-10):
            below, above = rl.equilibrium(strut, load * (1 - step)), rl.equilibrium(strut, load * (1 + step))
            assert (below.index, above.index) == (j - 1, j)
            assert below.index_verified
            assert above.index_verified


def test_the_index_far_out_is_counted_not_multiplied_out():
    """All n eigenvalues negative at lam = 1e12: no determinant overflows, at any n."""
    for n in (1, 10, 1000, 10**5):
        assert rl.Strut(n=n).hessian(np.zeros(n), 4.0 * (n + 1) ** 3 + 4).index == n
        assert rl.Strut(n=n).hessian(np.zeros(n), -1e8).index == 0


def test_angles_beyond_pi_are_states_like_others():
    """u_hat = 1, lam = 30: a stable state with its tip above pi [DESIGN 1.4]."""
    strut = rl.Strut(n=200, u_hat=1.0, rule="trapezoid")
    p = rl.equilibrium(strut, 30.0, lambda s: 3.2 * np.sin(np.pi * s / 2))
    assert p.index == 0
    assert p.index_verified
    assert p.tip_angle > np.pi
    assert off(strut, p) <= p.error


def test_exponentially_small_eigenvalues_are_said_to_be_unknown():
    """Far along branch 2 the critical eigenvalue is exponentially small: double precision cannot tell its sign."""
    strut = rl.Strut(n=300, rule="trapezoid")
    own = rl.buckling_loads(strut, [2])[0]
    guess, lam, seen = 0.4 * rl.buckling(strut, [2]).modes[0], 1.02 * own, []
    while lam < 100 * own and (p := verify(strut, lam, guess)):
        seen.append((p.index, p.index_verified))
        if not p.index_verified:
            break
        guess, lam = p.u, min(1.05 * lam, lam + own)
    assert lam > 10 * own
    assert {index for index, verified in seen if verified} == {1}
    assert seen[-1][1] is False or p is None


@pytest.mark.parametrize(("k", "lam"), [([3e7, 2e-10, 8e13], 7e-6), ([3e7, 1e-6, 1e16], 7e-6), ([3e7, 1e-3, 1e18], 1.0)])
def test_steps_of_zero_are_no_solution(k, lam):
    """Springs over 21 decades: a solve loses an unknown, and Newton's steps shrink where the residual stays."""
    strut = rl.Strut.from_joints(k=k, beta=[0.01 / 3] * 3, h=1 / 3)
    try:
        p = rl.equilibrium(strut, lam, np.array([-2.2, 1.37, -1.66]))
    except rl.NoConvergence:
        return
    assert p.error < 1.0 or not p.index_verified
