"""Gauss collocation: points, blocks, orders, invariants, and that the energy's gradient is the collocated system."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rodlab as rl
from rodlab.mechanics.invariants import angle_system, body_system, mesh_values
from rodlab.numerics.collocated import Collocated
from rodlab.numerics.collocation import Grid
from rodlab.numerics.firstorder import collocate
from rodlab.numerics.gauss import basis
from rodlab.numerics.mesh import equidistributed, given_mesh
from rodlab.numerics.pieces import smooth_pieces

# degree, intervals, allowed distance from the order; multiples of three, so that the layer at 2/3 is met alike
ORDERS = [(1, (66, 132), 0.1), (2, (33, 66), 0.1), (3, (27, 36), 0.1), (4, (27, 36), 0.1), (5, (27, 33), 0.3)]
CLAMP = (np.array([[1.0, 0.0]]), np.array([0.0]))
FREE = (np.array([[0.0, 1.0]]), np.array([0.0]))


@pytest.mark.parametrize("degree", [1, 2, 3, 6, 12, 20, 40])
def test_points_and_weights(degree):
    g = basis(degree)
    powers = np.arange(2 * degree)
    assert np.abs([g.b @ g.c**k * (k + 1) - 1 for k in powers]).max() < 1e-14
    x = np.linspace(0, 1, 7)
    E, D = g.at(x)
    assert np.abs(E @ g.nodes**degree - x**degree).max() < 1e-13
    assert np.abs(D @ g.nodes**degree - degree * x ** (degree - 1)).max() < 1e-11 * degree**2
    assert np.abs(g.A.sum(axis=1) - g.c).max() < 1e-14
    assert (g.weights > 0).all()
    assert abs(g.weights.sum() - 1) < 1e-14


def test_gauss_method_of_two_stages_is_that_of_the_books():
    r = np.sqrt(3) / 6
    assert np.allclose(basis(2).A, [[0.25, 0.25 - r], [0.25 + r, 0.25]], atol=1e-16)


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 6), st.integers(1, 5), st.integers(0, 2**32 - 1), st.floats(-4, 6))
def test_blocks_against_dense(N, m, seed, shift):
    rng = np.random.default_rng(seed)
    B = rng.standard_normal((N, m + 1, m + 1))
    A = Collocated(B + B.transpose(0, 2, 1)).shifted(shift)
    dense, b = A.toarray(), rng.standard_normal(N * m)
    assert np.allclose(dense, dense.T)
    assert np.allclose(A @ b, dense @ b)
    assert np.allclose(A.diagonal, np.diag(dense))
    assert np.allclose(abs(A).toarray(), np.abs(dense))
    w = np.linalg.eigvalsh(dense)
    known = A.inertia()
    assert known.negative <= (w < 0).sum() <= known.negative + known.unclear
    if np.abs(w).min() > 1e-6:
        assert known.verified
        assert np.allclose(dense @ A.solve(b), b, atol=1e-7 * np.abs(w).max() / np.abs(w).min())
        assert A.factor().sign() == (-1) ** int((w < 0).sum())


def test_a_singular_inner_problem_is_counted_all_the_same():
    """The inner nodes of an interval by themselves singular: condensation breaks down, the index does not."""
    block = np.array([[2.0, 1, 0], [1, 0, 1], [0, 1, 2]])
    A = Collocated(np.array([block, block]))
    assert A.index == (np.linalg.eigvalsh(A.toarray()) < 0).sum()
    assert A.index_verified


@pytest.mark.parametrize("degree", [1, 2, 3, 6])
def test_the_gradient_is_gauss_collocation_of_the_first_order_system(degree):
    """The system compiled from SymPy's limit, solved by Runge and Kutta's form of the method, has the same mesh values."""
    rod = rl.Rod(K="1 + s", u_hat="0.3*sin(2*s)", mesh=7, degree=degree)
    p = rl.equilibrium(rod, 7.0, lambda s: 2 * s)
    own = np.array(mesh_values(rod, p.u, p.lam))
    found = collocate(angle_system(rod, p.lam), CLAMP, FREE, rod.mesh, degree, own * 1.01)
    assert np.abs(found - own).max() < 1e-12


def test_degree_one_is_the_difference_scheme_of_the_notes():
    """K (phi_i - phi_{i-1}) / h jumps by the load at the middles of the two links beside the joint [N 2.8.2]."""
    n, lam = 5, 3.0
    rod = rl.Rod(K="1 + s", u_hat="s", mesh=n, degree=1)
    rng = np.random.default_rng(0)
    phi = np.append(0.0, rng.standard_normal(n))
    h, middle = 1 / n, (np.arange(n) + 0.5) / n
    moment = (1 + middle) * (np.diff(phi) / h - middle)
    load = lam * h * np.sin((phi[1:] + phi[:-1]) / 2) / 2
    expected = moment - load - np.append(moment[1:] + load[1:], 0.0)
    assert np.allclose(rod.gradient(phi[1:], lam), expected, atol=1e-13)


@pytest.mark.parametrize(("degree", "meshes", "within"), ORDERS)
def test_order_is_twice_the_degree(degree, meshes, within):
    """Mode 2 at four times its load, tip angle against the elastica, above the floor."""
    exact = rl.elastica(4 * (1.5 * np.pi) ** 2, mode=2)
    fine = rl.equilibrium(rl.Rod(mesh=60), exact.lam, elastica_guess(exact))
    errors = [
        abs(rl.equilibrium(rl.Rod(mesh=N, degree=degree), exact.lam, fine_guess(fine)).tip_angle - exact.tip_angle)
        for N in meshes
    ]
    assert errors[1] > 3e-14  # above the floor of rounding
    observed = np.log(errors[0] / errors[1]) / np.log(meshes[1] / meshes[0])
    assert abs(observed - 2 * degree) < within


def elastica_guess(exact):
    from scipy.interpolate import CubicSpline

    s = np.linspace(0, 1, 65)
    return CubicSpline(s, exact(s).phi)


def fine_guess(p):
    return lambda s: p(s).phi


def test_invariants_of_the_body_frame_are_kept_and_those_of_the_angle_are_not():
    drifts = []
    for N in (8, 16):
        p = rl.equilibrium(rl.Rod(mesh=N, degree=2, u_hat=0.3), 5.0, lambda s: 2 * s)
        angle, body, force = rl.invariants(p).drift
        assert body < 1e-13
        assert force < 1e-13
        drifts.append(angle)
    assert drifts[1] > 1e-7
    assert abs(np.log2(drifts[0] / drifts[1]) - 4) < 0.5


def test_body_frame_and_angle_have_one_limit():
    p = rl.equilibrium(rl.Rod(), 5.0, lambda s: 2 * s)
    rod = p.equations
    phi, m = mesh_values(rod, p.u, 5.0)
    left = (np.array([[1.0, 0, 0], [0, 1, 0]]), np.array([0.0, -5.0]))
    right = (np.array([[0, 0, 1.0]]), np.array([0.0]))
    guess = np.array([5 * np.sin(phi), -5 * np.cos(phi), m])
    y = collocate(body_system(1.0, 0.0), left, right, rod.mesh, 6, guess)
    assert np.abs(y - guess).max() < 1e-9


def test_collocation_that_does_not_converge_says_so():
    from rodlab.numerics.firstorder import System

    wild = System(lambda s, y: np.stack([1 + y[0] ** 2]) * 10, lambda s, y: np.stack([[20 * y[0]]]))
    with pytest.raises(ArithmeticError, match="collocation"), np.errstate(all="ignore"):
        collocate(
            wild, (np.array([[1.0]]), np.array([0.0])), (np.zeros((0, 1)), np.zeros(0)), np.linspace(0, 1, 4), 2, np.ones((1, 4))
        )


# --- meshes ------------------------------------------------------------------------------------------------------


@settings(max_examples=50, deadline=None)
@given(
    st.lists(st.floats(1e-14, 1.0), min_size=3, max_size=30), st.floats(1e-12, 1e-2), st.lists(st.floats(0.01, 0.99), max_size=3)
)
def test_breaks_are_points_of_every_mesh(errors, aim, breaks):
    breaks = np.unique(breaks)
    mesh = given_mesh(len(errors), breaks)
    e = np.resize(errors, mesh.size - 1)
    new = equidistributed(mesh, e, aim, 13, breaks)
    assert np.isin(breaks, new).all()
    assert new[0] == 0
    assert new[-1] == 1
    assert (np.diff(new) > 0).all()


def test_jumps_are_found_to_the_last_bit_and_kinks_lived_with():
    for at in (0.3, 1 / 3, 0.77):
        _, breaks = smooth_pieces(lambda s, at=at: np.where(s < at, 1.0, 50.0), np.array([0.0, 1.0]))
        assert breaks.tolist() == [at]
    pieces, breaks = smooth_pieces(lambda s: 1 + np.abs(s - 0.4), np.array([0.0, 1.0]))
    assert not breaks.size
    assert np.abs(pieces - 0.4).min() < 1e-5


def test_polynomials_survive_a_change_of_mesh():
    coarse, fine = Grid(np.array([0, 0.3, 1.0]), 4), Grid(np.array([0, 0.1, 0.3, 0.6, 1.0]), 5)
    Y = coarse.nodal(np.sin(coarse.places[1:]), 0.0)
    back = fine.onto(fine.nodal(coarse.onto(Y, fine), 0.0), coarse)
    assert np.abs(back - Y[:, 1:].ravel()).max() < 1e-14
