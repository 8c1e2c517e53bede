"""Steps: proved or checked, never a jump; natural and pseudo-arclength; stops; what is refused."""

from itertools import islice

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from models import Bare, Scalar, Struts, circle, fine_run, hysteresis

import rodlab as rl
from rodlab.analysis.continuation import Walk
from rodlab.analysis.curve import Curve, Segment
from rodlab.analysis.proof import Prover


def mode(strut, j, to):
    trivial = rl.follow(rl.equilibrium(strut, 0.0), to=1.2 * float(rl.buckling_loads(strut, [j])[0]))
    return rl.follow(rl.switch(trivial.events[j - 1])[0], to=to)


# --- no jumps ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("u_hat", [0.01, 0.001])
@pytest.mark.parametrize("step", [None, 0.01, 0.3, 1.0, 2.0, 5.0])
def test_an_imperfect_strut_stays_on_its_branch_whatever_the_step(u_hat, step):
    strut = rl.Strut(n=50, u_hat=u_hat)
    b = rl.follow(rl.equilibrium(strut, 0.0), to=30.0, step=step)
    assert b.completed
    assert b.points[-1].lam == 30.0
    assert [e.kind for e in b.events] == ["end"]
    assert all(p.proved for p in b.points[1:])
    upper = rl.equilibrium(strut, 30.0, lambda s: 3.1 * np.sin(np.pi * s / 2) ** 0.3)
    assert b.points[-1].u == pytest.approx(upper.u, abs=1e-11)
    assert all(p.index == 0 and p.index_verified and p.tip_angle > 0 for p in b.points)
    lengths = [Curve(strut).norm(np.append(q.u - p.u, q.lam - p.lam)) for p, q in zip(b.points, b.points[1:], strict=False)]
    assert step is None or max(lengths) <= 1.02 * step


def test_fifty_random_imperfect_struts_against_a_fine_run():
    rng = np.random.default_rng(11)
    for _ in range(50):
        n = int(np.exp(rng.uniform(np.log(2), np.log(200))))
        u_hat = float(10 ** rng.uniform(-3, 0.3)) * float(rng.choice([-1, 1]))
        K = float(10 ** rng.uniform(-0.3, 0.3))
        strut = rl.Strut(n=n, K=K, u_hat=u_hat, rule=str(rng.choice(["end", "trapezoid"])))
        step, to = float(10 ** rng.uniform(-2, np.log10(5))), float(rng.uniform(3, 8)) * K
        p = rl.equilibrium(strut, 0.0)
        b = rl.follow(p, to=to, step=step)
        assert b.completed
        assert b.points[-1].u == pytest.approx(fine_run(strut, p.u, 0.0, to, 0.01), abs=1e-9), (n, u_hat, K, step, to)
        assert all(q.proved or q.checked for q in b.points[1:])


@pytest.mark.parametrize("u_hat", [0.05, 1e-3, 1e-5])
@pytest.mark.parametrize("step", [0.2, 5.0])
def test_a_class_without_bounds_does_not_jump_either(u_hat, step):
    model = Bare(rl.Strut(n=12, u_hat=u_hat))
    b = rl.follow(rl.equilibrium(model, 0.0, model.model.unstressed()), to=20.0, step=step)
    assert b.points[-1].u[-1] == pytest.approx(3.09, abs=0.05)
    assert all(p.checked and p.index == 0 for p in b.points[1:])


@pytest.mark.parametrize(("n", "lam", "step"), [(10, 10.0, 0.5), (4, 10.0, None), (2, 10.0, 1.0)])
@pytest.mark.parametrize("bare", [False, True])
def test_down_past_a_pitchfork_that_an_imperfection_broke(n, lam, step, bare):
    strut = rl.Strut(n=n, u_hat=1e-4)
    p = rl.equilibrium(strut, lam, lambda s: 3 * s)
    b = rl.follow(rl.Point(Bare(strut) if bare else strut, lam, p.u), to=1.0, step=step)
    assert b.reason == "lam = 1 reached"
    assert [e.kind for e in b.events] == ["end"]
    assert (np.abs(b.points[-1].u) < 1e-3).all()


@pytest.mark.parametrize(("n", "u_hat", "lam", "to", "fold"), [(20, 0.2, 30.0, -50.0, 22.4562), (7, 0.016, 113.0, 1.0, 2.26003)])
@pytest.mark.parametrize("step", [None, 5.0, 1.0])
def test_detached_branches_turn_at_their_fold(n, u_hat, lam, to, fold, step):
    b = rl.follow(rl.equilibrium(rl.Strut(n=n, u_hat=u_hat), lam, lambda s: -2 * s), to=to, step=step)
    assert [e.kind for e in b.events] == ["fold", "end"]
    assert b.events[0].lam == pytest.approx(fold, abs=1e-4)
    assert b.reason == f"back at lam = {lam:g}"


def test_a_second_variation_that_is_not_the_jacobian_proves_nothing():
    class Other(Scalar):
        def second_variation(self, u, lam):
            return np.eye(1)

        def lipschitz(self, u, lam):
            return lambda du, dlam: (dlam + 0 * du, 0.0)

    model = Other(lambda u, lam: u * (lam - 1), lambda u, lam: lam - 1, lambda u, lam: u)
    b = rl.follow(rl.equilibrium(model, 0.0, [0.0]), to=2.0)
    assert not any(p.proved for p in b.points)


def test_nearly_degenerate_branches_are_followed_far():
    trivial = rl.follow(rl.equilibrium(rl.Strut(n=100), 0.0), to=30.0)
    b = rl.follow(rl.switch(trivial.events[1])[0], to=2200.0)
    assert b.completed
    assert len(b.points) < 60
    assert b.points[-1].index == 1


@pytest.mark.parametrize("u_hat", [1e-6, 1e-10])
def test_imperfections_that_no_eye_sees_are_still_followed_round_the_corner(u_hat):
    b = rl.follow(rl.equilibrium(rl.Strut(n=10, u_hat=u_hat), 0.0), to=5.0)
    assert b.points[-1].tip_angle == pytest.approx(2.27, abs=0.05)
    assert b.points[-1].index == 0


def test_two_states_of_one_index_at_one_load_are_not_confused():
    strut = rl.Strut(n=50, u_hat=0.01)
    own, other = rl.equilibrium(strut, 3.0, lambda s: 1.3 * s), rl.equilibrium(strut, 3.0, lambda s: -1.3 * s)
    assert own.index == other.index == 0
    down = rl.follow(own, to=0.0)
    assert down.points[-1].u == pytest.approx(strut.unstressed(), abs=1e-12)
    back = rl.follow(other, to=0.0)
    assert back.reason == "back at lam = 3"
    assert [e.kind for e in back.events] == ["fold", "end"]


# --- what proved means -----------------------------------------------------------------------------------------------


@settings(max_examples=25)
@given(n=st.integers(1, 12), u_hat=st.floats(-1.5, 1.5), lam=st.floats(-20, 20), angle=st.floats(-4, 4), s=st.floats(0.01, 1.0))
def test_a_proved_span_has_the_index_that_dense_eigenvalues_have(n, u_hat, lam, angle, s):
    strut = rl.Strut(n=n, u_hat=u_hat)
    try:
        p = rl.equilibrium(strut, lam, np.full(n, angle))
        step = Walk(p, step=s).advance()
    except rl.NoConvergence:
        return
    prover = Prover(Curve(strut))
    for span in prover.spans(step.segment):
        for x in np.linspace(span.start, span.stop, 5):
            y = step.segment.at(float(x))
            if span.kind == "regular":
                w = np.linalg.eigvalsh(strut.hessian(y[:-1], y[-1]).toarray())
                assert int((w < 0).sum()) == span.index


def test_a_segment_that_joins_two_branches_is_not_proved():
    strut = rl.Strut(n=20, u_hat=0.05)
    curve = Curve(strut)
    own, other = (rl.equilibrium(strut, 3.0, lambda s, side=side: side * 1.3 * s) for side in (1, -1))
    a, b = np.append(own.u, 3.0), np.append(other.u, 3.0)
    chord = (b - a) / curve.norm(b - a)
    spans = Prover(curve).spans(Segment(a, chord, b, chord, curve.row(chord)))
    assert any(span.kind == "open" for span in spans)


def test_the_bounds_bound_what_they_say():
    rng = np.random.default_rng(5)
    for terms in ((), (rl.self_weight(3.0),), (rl.end_torque(0.5), rl.self_weight("1 + s"))):
        for rule in ("end", "trapezoid"):
            strut = rl.Strut(n=7, K="1 + s", u_hat=0.3, rule=rule, terms=terms)
            for _ in range(40):
                u, lam = rng.uniform(-4, 4, 7), float(rng.uniform(-30, 30))
                du, dlam = np.abs(rng.uniform(0, 10 ** rng.uniform(-4, 0), 7)), float(rng.uniform(0, 5))
                d, c = strut.lipschitz(u, lam)(du, dlam)
                v, mu = u + du * rng.uniform(-1, 1, 7), lam + dlam * float(rng.uniform(-1, 1))
                change = strut.hessian(v, mu).toarray() - strut.hessian(u, lam).toarray()
                w = np.linalg.eigvalsh(np.diag(np.broadcast_to(d, 7)) - change)
                assert w.min() >= -1e-10
                assert np.linalg.eigvalsh(np.diag(np.broadcast_to(d, 7)) + change).min() >= -1e-10
                assert (np.abs(strut.d_lam(v, mu) - strut.d_lam(u, lam)) <= c + 1e-14).all()
                half = strut.lipschitz(u, lam)(du / 2, dlam / 2)
                assert (half[0] <= d / 2 + 1e-14).all()  # convex
                a, b = strut.embedding(lam)
                x = rng.standard_normal(7)
                assert np.abs(x).max() ** 2 <= a * x @ (strut.hessian(u, lam) @ x) + b * x @ x + 1e-9


def test_steps_are_proved_where_they_can_be():
    b = mode(rl.Strut(n=1000), 1, 25.0)
    assert len(b.points) <= 40  # few, long steps
    assert all(p.proved for p in b.points[1:])
    assert b.points[-1].tip_angle == pytest.approx(3.0878, abs=1e-3)


def test_one_step_means_the_same_for_every_n():
    ends = [len(mode(rl.Strut(n=n), 1, 20.0).points) for n in (30, 300, 3000)]
    assert max(ends) - min(ends) <= 3


# --- natural and pseudo-arclength ------------------------------------------------------------------------------------


def test_natural_continuation_ends_at_the_fold_that_arclength_passes():
    start = rl.equilibrium(hysteresis, -4.0, [2.2])
    stream = rl.branch(start, 0.3, natural=True)
    with pytest.raises(rl.NoConvergence, match="natural continuation ends at a fold"):
        list(stream)
    assert next(rl.branch(start, 0.3, natural=True)).lam == pytest.approx(-3.7, abs=1e-14)
    b = rl.follow(start, to=4.0)
    assert [e.kind for e in b.events] == ["fold", "fold", "end"]
    assert [e.lam for e in b.events[:2]] == pytest.approx([2.0, -2.0], abs=1e-13)


def test_the_stream_is_lazy_and_endless():
    strut = rl.Strut(n=5, u_hat=0.3)
    stream = rl.branch(rl.equilibrium(strut, 0.0), step=0.25)
    points = list(islice(stream, 80))
    assert points[-1].lam > 15
    assert all(p.proved for p in points)
    assert next(rl.branch(points[3], 0.1)).lam > points[3].lam  # goes on as its tangent says
    assert next(rl.branch(rl.equilibrium(strut, 1.0), 0.1, toward=0.0)).lam < 1.0


# --- where a branch ends -----------------------------------------------------------------------------------------------


def test_it_ends_exactly_at_to():
    b = rl.follow(rl.equilibrium(rl.Strut(n=5, u_hat=0.1), 0.0), to=7.3)
    assert b.points[-1].lam == 7.3
    assert b.points[-1].error < 1e-13
    assert b.end.reason == "lam = 7.3 reached"
    assert np.abs(b.points[-1].equations.gradient(b.points[-1].u, 7.3)).max() < 1e-13


def test_a_closed_branch_says_so():
    b = rl.follow(rl.equilibrium(circle, 0.3, [0.9]), to=3.0)
    assert b.end.reason.startswith("back at") or b.end.reason.startswith("closed")
    away = rl.Point(circle, 0.6, np.array([0.8]), tangent=np.array([0.6, -0.8]))  # does not set out towards 3
    b = rl.follow(away, to=3.0)
    assert b.end.reason == "closed: back at its first point"
    assert [e.kind for e in b.events] == ["fold", "fold", "end"]
    assert [e.lam for e in b.events[:2]] == pytest.approx([-1.0, 1.0], abs=1e-13)


def test_back_where_it_set_out():
    b = rl.follow(rl.equilibrium(circle, 0.0, [1.0]), to=3.0)
    assert b.reason == "back at lam = 0"
    assert b.points[-1].u == pytest.approx([-1.0], abs=1e-14)


def test_within_limits_and_max_points():
    p = rl.equilibrium(rl.Strut(n=10, u_hat=0.2), 0.0)
    b = rl.follow(p, to=30.0, within={"tip_angle": (0.0, 1.0)})
    assert b.reason == "left the limits given"
    assert b.points[-1].tip_angle == pytest.approx(1.0, abs=1e-9)
    b = rl.follow(p, to=30.0, within=lambda p: p.lam < 2.0)
    assert b.points[-1].lam == pytest.approx(2.0, abs=1e-9)
    b = rl.follow(p, to=30.0, step=0.1, max_points=5)
    assert len(b.points) == 5
    assert "max_points" in b.reason


def test_a_branch_that_cannot_be_followed_says_why_and_keeps_what_was_found():
    wall = Scalar(lambda u, lam: u - lam if lam < 1 else np.nan, lambda u, lam: 1.0 if lam < 1 else np.nan, lambda u, lam: -1.0)
    b = rl.follow(rl.equilibrium(wall, 0.0, [0.1]), to=2.0)
    assert not b.completed
    assert b.points[-1].lam == pytest.approx(1.0, abs=1e-6)
    assert "cannot be followed beyond lam = " in b.reason


def test_loads_between_points():
    b = mode(rl.Strut(n=30), 1, 20.0)
    (p,) = b.at(7.77)
    assert p.lam == 7.77
    assert p.tip_angle == pytest.approx(rl.equilibrium(p.equations, 7.77, p.u).tip_angle, abs=1e-14)
    assert b.at(1.0) == []
    back = rl.follow(rl.equilibrium(circle, 0.0, [1.0]), to=3.0)
    near = float(back.lam.max()) + 0.5 * (1 - float(back.lam.max()))  # between the fold and its neighbours
    assert len(back.at(near)) == 2
    assert [p.u[0] for p in back.at(0.5)] == pytest.approx([np.sqrt(0.75), -np.sqrt(0.75)], abs=1e-14)


def test_extended_is_followed_in_one_go():
    p = rl.equilibrium(rl.Strut(n=2), 0.0)
    in_two = rl.follow(p, to=3.0).extended(12.0)
    whole = rl.follow(p, to=12.0)
    assert [e.lam for e in in_two.events] == pytest.approx([e.lam for e in whole.events], abs=1e-13)
    assert in_two.points[-1].lam == 12.0


# --- scales ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("K", [1e-10, 1e-3, 1e6])
def test_any_unit_of_stiffness(K):
    strut = rl.Strut(n=10, K=K)
    b = rl.follow(rl.equilibrium(strut, 0.0), to=70 * K)
    loads = rl.buckling_loads(strut, 3)
    assert [e.lam for e in b.events[:-1]] == pytest.approx(loads, rel=1e-11)
    start = rl.switch(b.events[0])[0]
    end = rl.follow(start, to=20 * K).points[-1]
    assert end.tip_angle == pytest.approx(mode(rl.Strut(n=10), 1, 20.0).points[-1].tip_angle, abs=1e-10)


def test_negative_loads():
    b = rl.follow(rl.equilibrium(rl.Strut(n=20, u_hat=0.5), 0.0), to=-1e4)
    assert b.completed
    assert [e.kind for e in b.events] == ["end"]
    assert all(p.index == 0 for p in b.points)


# --- what is refused ---------------------------------------------------------------------------------------------------


def test_wrong_arguments_get_a_sentence():
    strut = rl.Strut(n=3, u_hat=0.1)
    p = rl.equilibrium(strut, 1.0)
    for run, says in (
        (lambda: rl.follow(strut, 3.0), "p must be a Point"),
        (lambda: rl.follow(p, np.nan), "to must be a finite number"),
        (lambda: rl.follow(p, 1.0), "to must differ from the load of p"),
        (lambda: rl.follow(p, 3.0, step=0.0), "step must be a finite number above 0"),
        (lambda: rl.follow(p, 3.0, events=("fold",)), "events must be rl.fold, rl.branch_point or functions"),
        (lambda: rl.follow(p, 3.0, within={"tip_angle": (2, 1)}), r"within must map measures to \(low, high\)"),
        (lambda: rl.follow(p, 3.0, within={"curvature": (0, 1)}), "within must name measures of the model"),
        (lambda: rl.follow(p, 3.0, within={"tip_angle": (2, 3)}), "p must lie within"),
        (lambda: rl.follow(p, 3.0, max_points=0), "max_points must be a whole number"),
        (lambda: rl.follow(p, 3.0, scale=-1.0), "scale must be a finite number above 0"),
        (lambda: rl.branch(p, step=-1), "step must be a finite number above 0"),
    ):
        with pytest.raises(ValueError, match=says):
            run()


class Wrong(Bare):
    """A strut with one derivative spoilt."""

    def __init__(self, jacobian=lambda J: J, d_lam=lambda f: f):
        super().__init__(rl.Strut(n=4, u_hat=0.2))
        self.spoilt, self.spoilt_lam = jacobian, d_lam

    def jacobian(self, u, lam):
        return self.spoilt(super().jacobian(u, lam))

    def d_lam(self, u, lam):
        return self.spoilt_lam(super().d_lam(u, lam))


@pytest.mark.parametrize(
    ("model", "says"),
    [
        (Wrong(jacobian=lambda J: -J), "jacobian of Wrong is not the derivative of residual in u"),
        (Wrong(jacobian=lambda J: J * (1 + np.eye(4) * 1e-3)), "jacobian of Wrong is not"),
        (Wrong(jacobian=lambda J: np.tril(J) + np.tril(J, -1).T * 0.5), "jacobian of Wrong is not"),
        (Wrong(jacobian=lambda J: J[:3]), r"jacobian of Wrong must have shape \(4, 4\); it has \(3, 4\)"),
        (Wrong(d_lam=lambda f: -f), "d_lam of Wrong is not the derivative of residual in lam"),
        (Wrong(d_lam=lambda f: 2 * f), "d_lam of Wrong is not the derivative of residual in lam"),
        (Wrong(d_lam=lambda f: f[0]), r"d_lam of Wrong must have the shape of u, \(4,\)"),
    ],
)
def test_a_wrong_derivative_is_named(model, says):
    p = rl.Point(model, 1.0, rl.equilibrium(model.model, 1.0).u)
    with pytest.raises(ValueError, match=says):
        rl.follow(p, to=2.0)
    with pytest.raises(ValueError, match=says):
        rl.branch(p)


def test_a_transposed_jacobian_is_called_that():
    class Transposed:
        def residual(self, u, lam):
            return np.array([u[0] ** 2 + u[1] - lam, u[1] - 0.5 * u[0]])

        def jacobian(self, u, lam):
            return np.array([[2 * u[0], 1.0], [-0.5, 1.0]]).T

        def d_lam(self, u, lam):
            return np.array([-1.0, 0.0])

        def inner(self, u, v):
            return float(u @ v)

    with pytest.raises(ValueError, match="its transpose is"):
        rl.follow(rl.Point(Transposed(), 1.5, np.array([1.0, 0.5])), to=3.0)


def test_a_class_of_ten_lines_works_as_it_is():
    pair = Struts(rl.Strut(n=4), rl.Strut(n=4))
    b = rl.follow(rl.equilibrium(pair, lam=0.5, guess=np.zeros(8)), to=30, step=1.0)
    assert isinstance(pair, rl.Equations)
    assert [e.multiplicity for e in b.events[:-1]] == [2, 2]
