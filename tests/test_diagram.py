"""Diagrams: every branch once, kinds by name, counts against closed forms and against all equilibria; Koiter's coefficients."""

import itertools

import numpy as np
import pytest
from models import Scalar, transcritical

import rodlab as rl


class Even(Scalar):
    """A scalar equation that is odd in u."""

    symmetries = (np.negative,)


def pitchfork(sign, fifth=0.0, cls=Even):
    return cls(
        lambda u, lam: u * (sign * u * u + fifth * u**4 - lam),
        lambda u, lam: 3 * sign * u * u + 5 * fifth * u**4 - lam,
        lambda u, lam: -u,
    )


class Gradient:
    """F = dV/du in two unknowns, from its polynomials."""

    def __init__(self, F, J, Fl, symmetries=()):
        self.F, self.J, self.Fl, self.symmetries = F, J, Fl, symmetries

    def residual(self, u, lam):
        return np.array(self.F(*u, lam))

    def jacobian(self, u, lam):
        return np.array(self.J(*u, lam))

    def d_lam(self, u, lam):
        return np.array(self.Fl(*u, lam))

    def inner(self, u, v):
        return float(u @ v)


def flip(i):
    def g(u):
        v = u.copy()
        v[i] = -v[i]
        return v

    return g


def coupled(c=2.0, *, even=True):
    """x (lam - 1 - x^2 - c y^2) = 0, y (lam - 2 - y^2 - c x^2) = 0: two modes, and where they meet."""
    return Gradient(
        lambda x, y, lam: (x * (lam - 1 - x * x - c * y * y), y * (lam - 2 - y * y - c * x * x)),
        lambda x, y, lam: (
            (lam - 1 - 3 * x * x - c * y * y, -2 * c * x * y),
            (-2 * c * x * y, lam - 2 - 3 * y * y - c * x * x),
        ),
        lambda x, y, lam: (x, y),
        (flip(0), flip(1)) if even else (),
    )


def coupled_count(lam, c=2.0):
    a, b = lam - 1, lam - 2
    x2, y2 = (a - c * b) / (1 - c * c), (b - c * a) / (1 - c * c)
    return 1 + 2 * (a > 0) + 2 * (b > 0) + 4 * (x2 > 0 and y2 > 0)


# --- kinds -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("model", "kinds", "branches", "counts"),
    [
        (transcritical, ["transcritical"], 3, {-0.5: 2, 0.7: 2}),
        (pitchfork(1.0), ["supercritical pitchfork"], 2, {-0.5: 1, 0.7: 3}),
        (pitchfork(-1.0), ["subcritical pitchfork"], 2, {-0.5: 3, 0.7: 1}),
        (pitchfork(1.0, cls=Scalar), ["supercritical pitchfork"], 3, {-0.5: 1, 0.7: 3}),
        (pitchfork(-1.0, 1.0), ["subcritical pitchfork", "fold"], 2, {-0.5: 1, -0.1: 5, 0.7: 3}),
    ],
)
def test_kinds_by_their_names(model, kinds, branches, counts):
    d = rl.diagram(model, (-1.0, 1.0), [0.0])
    assert d.complete
    assert [row.kind for row in d.table if row.kind != "end"] == kinds
    assert len(d.branches) == branches
    assert {lam: d.count(lam) for lam in counts} == counts


def test_a_subcritical_pitchfork_turns_at_its_fold():
    d = rl.diagram(pitchfork(-1.0, 1.0), (-1.0, 1.0), [0.0])
    turn = next(row for row in d.table if row.kind == "fold")
    assert turn.lam == pytest.approx(-0.25, abs=1e-12)
    assert d.count(-0.2) == 5


def test_a_cusp_does_not_turn():
    d = rl.diagram(Scalar(lambda u, lam: u**3 - lam, lambda u, lam: 3 * u * u, lambda u, lam: -1.0), (-1.0, 1.0), [-1.0])
    assert [row.kind for row in d.table] == ["cusp", "end"]
    assert abs(d.table[0].lam) < 1e-6
    assert d.count(0.3) == 1


def test_two_modes_and_where_they_meet():
    d = rl.diagram(coupled(), (0.0, 6.0), np.zeros(2))
    assert d.complete
    rng = np.random.default_rng(1)
    for lam in rng.uniform(0, 6, 20):
        assert d.count(lam) == coupled_count(lam), lam
    plain = rl.diagram(coupled(even=False), (0.0, 6.0), np.zeros(2))
    for lam in rng.uniform(0, 6, 10):
        assert plain.count(lam) == coupled_count(lam), lam
    assert sum(d.copies) == len(plain.branches)


def test_a_bubble_between_two_branch_points_is_one_branch():
    """u (u^2 + (lam - 1)(lam - 2)) = 0: what leaves at 1 comes back at 2."""
    model = Even(
        lambda u, lam: u * (u * u + (lam - 1) * (lam - 2)),
        lambda u, lam: 3 * u * u + (lam - 1) * (lam - 2),
        lambda u, lam: u * (2 * lam - 3),
    )
    d = rl.diagram(model, (0.0, 3.0), [0.0])
    assert len(d.branches) == 2
    assert d.branches[1].reason.startswith("meets branch 0 at its branch point")
    assert [row.leaving for row in d.table if row.kind.endswith("pitchfork")] == [(1,), (1,)]
    assert [d.count(lam) for lam in (0.5, 1.5, 2.5)] == [1, 3, 1]


def test_a_closed_branch_and_a_start_inside():
    circle = Scalar(lambda u, lam: u * u + lam * lam - 1, lambda u, lam: 2 * u, lambda u, lam: 2 * lam)
    d = rl.diagram(circle, (-2.0, 2.0), rl.equilibrium(circle, 0.3, [1.0]))
    assert len(d.branches) == 1
    assert d.branches[0].reason.startswith("closed")
    assert [d.count(lam) for lam in (-1.5, 0.2, 0.9, 1.5)] == [0, 2, 2, 0]
    parabola = Scalar(lambda u, lam: u * u - lam, lambda u, lam: 2 * u, lambda u, lam: -1.0)
    d = rl.diagram(parabola, (-1.0, 2.0), rl.equilibrium(parabola, 1.0, [1.0]))
    assert len(d.branches) == 1
    assert [d.count(lam) for lam in (-0.5, 0.5, 1.5, 2.0)] == [0, 2, 2, 2]
    assert [row.kind for row in d.table] == ["fold", "end"]


def test_limits_are_said():
    d = rl.diagram(rl.Strut(n=5), (0.0, 60.0), most=2)
    assert not d.complete
    assert any("most, 2 branches" in row.reason for row in d.table)
    d = rl.diagram(rl.Strut(n=5), (0.0, 60.0), max_points=3)
    assert not d.complete
    for bad, words in (
        (lambda: rl.diagram(rl.Strut(n=2), (3.0, 1.0)), "low < high"),
        (lambda: rl.diagram(rl.Strut(n=2), 3.0), "pair of loads"),
        (lambda: rl.diagram(rl.Strut(n=2), (1.0, 2.0), rl.equilibrium(rl.Strut(n=2), 0.0)), "start must lie"),
        (lambda: rl.diagram(rl.Strut(n=2), (0.0, 2.0)).count(3.0), "window of the diagram"),
        (lambda: rl.diagram(rl.Strut(n=2), (0.0, 2.0), most=0), "most must"),
    ):
        with pytest.raises(ValueError, match=words):
            bad()


# --- struts ----------------------------------------------------------------------------------------------------------


def test_a_hundred_joints_have_one_and_four_branches():
    strut = rl.Strut(n=100)
    d = rl.diagram(strut, (0.0, 130.0))
    assert d.complete
    assert (len(d.branches), d.copies) == (5, [1, 2, 2, 2, 2])
    pitchforks = [row for row in d.table if row.kind == "supercritical pitchfork"]
    assert [row.lam for row in pitchforks] == pytest.approx(rl.buckling_loads(strut, 4), rel=1e-12)
    assert [row.index for row in pitchforks] == [(0, 1), (1, 2), (2, 3), (3, 4)]
    assert [row.leaving for row in pitchforks] == [(1,), (2,), (3,), (4,)]
    assert [count for _, _, count in d.counts] == [1, 3, 5, 7, 9]
    for lam in np.random.default_rng(2).uniform(0, 130, 20):
        found = rl.all_equilibria(strut, lam)
        assert found.certified
        assert d.count(lam) == len(found)


@pytest.mark.parametrize(("n", "top"), [(5, 110.0), (8, 170.0)])
def test_what_is_not_connected_is_a_parasite(n, top):
    """Counts of the diagram and of everything differ by what `connected` denies, at 20 loads."""
    strut = rl.Strut(n=n)
    d = rl.diagram(strut, (0.0, top))
    assert d.complete
    for lam in np.random.default_rng(n).uniform(0, top, 20):
        found = rl.all_equilibria(strut, lam)
        every = np.array([p.u for p in found])
        places = [np.abs(every - p.u).max(axis=1).argmin() for p in d.connected_at(lam)]
        assert len(set(places)) == len(places) == d.count(lam)
        assert all(np.abs(found.points[i].u - p.u).max() < 1e-9 for i, p in zip(places, d.connected_at(lam), strict=True))
        assert d.connected(found.points[places[0]])
        loose = len(found) - len(places)
        if lam < 20:
            assert loose == 0


def test_a_census_holds_everything():
    strut = rl.Strut(n=5)
    d = rl.census(strut, (0.0, 60.0))
    assert sorted(set(d.components)) == [0, 1, 2, 3]
    for lam in np.random.default_rng(3).uniform(0, 60, 20):
        assert d.count(lam) == len(rl.all_equilibria(strut, lam))


@pytest.mark.parametrize(
    ("beta", "known"),
    [
        (0.01, [0.401553289999, 2.66890508268, 4.38210604461, 4.38546791147]),
        (0.1, [0.478960114169, 2.86287076091, 4.36690950344, 4.40053013644, 4.98881843926]),
    ],
)
def test_all_folds_of_two_imperfect_joints(beta, known):
    """Every fold below 5, the detached ones too; each a double root of the scalar function to 30 digits, none between."""
    strut = rl.Strut.from_joints(k=[1, 1], beta=[beta, 0])
    d = rl.census(strut, (0.0, 5.0))
    rows = sorted((row for row in d.table if row.kind == "fold"), key=lambda row: row.lam)
    assert [row.lam for row in rows] == pytest.approx(known, rel=1e-11)
    exact = [two_joint_fold(beta, row) for row in rows]
    assert all(abs(row.lam - lam) <= row.error + 1e-14 for row, lam in zip(rows, exact, strict=True))
    edges = [0.0, *known, 5.0]
    for low, high in itertools.pairwise(edges):
        assert d.count((low + high) / 2) == len(rl.all_equilibria(strut, (low + high) / 2))


def two_joint_fold(beta, row):
    """phi_1 and lam of the fold to 30 digits, by the tip's recurrence and its derivative."""
    import mpmath as mp

    with mp.workdps(30):

        def equations(a, lam):
            m = lam * mp.sin(a)
            b, db = a - m, 1 - lam * mp.cos(a)
            m, dm = m + lam * mp.sin(b), lam * mp.cos(a) + lam * mp.cos(b) * db
            return b - mp.mpf(beta) - m, db - dm

        start = (mp.mpf(float(row.event.point.u[-1])), mp.mpf(row.lam))
        return float(mp.findroot(equations, start)[1])


def test_a_rod_and_its_mirror_images():
    d = rl.diagram(rl.Rod(), (0.0, 25.0))
    assert d.complete
    assert d.copies == [1, 2, 2]
    assert [count for _, _, count in d.counts] == [1, 3, 5]


def test_branches_are_joined_and_turned():
    strut = rl.Strut(n=20, u_hat=0.05)
    b = rl.follow(rl.equilibrium(strut, 10.0, lambda s: -3 * np.sin(np.pi * s / 2)), to=0.0)
    back = b.reversed()
    assert back.lam == pytest.approx(b.lam[::-1])
    assert [e.kind for e in back.events] == ["fold", "end"]
    assert back.events[0].where == pytest.approx(len(b) - 1 - b.events[0].where)
    assert back.indices() == b.indices()[::-1]
    assert back.points[0].tangent @ b.points[-1].tangent < 0
    again = back.reversed()
    assert [e.where for e in again.events] == pytest.approx([e.where for e in b.events])
    more = b.joined(rl.follow(b.points[-1], to=20.0))
    assert more.lam[-1] == 20.0
    assert [e.kind for e in more.events] == ["fold", "end"]
    assert b.at(5.0)[0].u == pytest.approx(back.at(5.0)[1].u, abs=1e-12)


def test_events_of_a_step_that_is_cut_are_where_they_are():
    b = rl.follow(rl.equilibrium(rl.Strut(n=100), 0.0), to=130)
    assert b.indices() == [0, 1, 2, 3, 4]
    for e in b.events[:-1]:
        assert b.along(e.where).lam == pytest.approx(e.lam, rel=1e-9)


def test_until_ends_a_branch_at_an_event():
    stop = lambda e: "second" if e.lam > 20 else None  # noqa: E731
    b = rl.follow(rl.equilibrium(rl.Strut(n=50), 0.0), to=100.0, until=stop)
    assert b.reason == "second"
    assert [e.kind for e in b.events] == ["branch point", "end"]
    assert b.points[-1].lam == pytest.approx(rl.buckling_loads(rl.Strut(n=50), 2)[1], rel=1e-12)
    both = rl.follow(b.points[1], to=(100.0, 0.0))
    assert both.reason == "lam = 100 reached"
    down = rl.follow(b.reversed().points[1], to=(0.0, 100.0))
    assert down.reason == "lam = 0 reached"


# --- Koiter's coefficients -------------------------------------------------------------------------------------------


def first_pitchforks(strut, modes):
    top = 1.1 * float(rl.buckling_loads(strut, [modes])[0])
    return [e for e in rl.follow(rl.equilibrium(strut, 0.0), to=top).events if e.kind == "branch point"]


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("rule", ["end", "trapezoid"])
def test_numbers_meet_closed_forms(n, rule):
    strut = rl.Strut(n=n, rule=rule)
    for mode, event in enumerate(first_pitchforks(strut, n), start=1):
        exact = rl.koiter(strut, mode, order=4).coefficients
        found = rl.expansion(event, 4, measure="tip_angle")
        for power in range(5):
            assert abs(found.load[power] - float(exact.get(power, 0))) <= found.error[power], (mode, power)
        assert found.error[2] < 1e-7 * event.lam


def test_two_joints_as_in_the_exercise():
    """lam = lam_j + (1/2 -+ 1/sqrt 5) eps^2, eps = |phi_2|."""
    events = first_pitchforks(rl.Strut.from_joints(k=[1, 1]), 2)
    for event, c in zip(events, (0.5 - 5**-0.5, 0.5 + 5**-0.5), strict=True):
        found = rl.expansion(event, 2, measure="tip_angle")
        assert abs(found.load[2] - c) <= found.error[2] < 1e-9
        assert abs(found.load[1]) <= found.error[1]


@pytest.mark.parametrize(("rule", "order"), [("end", 2), ("trapezoid", 2)])
def test_large_n_has_the_coefficient_of_the_rod(rule, order):
    """lam = lam_1 (1 + alpha^2 / 8 + ...) at the rule's order for the load; the ratio c_2 / c_0 converges faster than 'end'."""
    sizes = (20, 40, 80)
    series = [rl.expansion(first_pitchforks(rl.Strut(n=n, rule=rule), 1)[0], 2, measure="tip_angle").load for n in sizes]
    off = [abs(c[2] - np.pi**2 / 32) for c in series]
    slopes = [np.log2(a / b) for a, b in itertools.pairwise(off)]
    expected = {"end": 1, "trapezoid": 2}[rule]
    assert slopes[-1] == pytest.approx(expected, abs=0.1)
    ratio = [abs(c[2] / c[0] - 1 / 8) for c in series]
    assert max(ratio) < 1e-9 if rule == "trapezoid" else np.log2(ratio[-2] / ratio[-1]) == pytest.approx(order, abs=0.1)
    event = first_pitchforks(rl.Rod(), 1)[0]
    rod = rl.expansion(event, 2, measure="tip_angle")
    assert abs(rod.load[2] - np.pi**2 / 32) <= rod.error[2] < 1e-7


def test_a_transcritical_slope():
    event = rl.follow(rl.equilibrium(transcritical, -1.0, [0.0]), to=1.0).events[0]
    found = rl.expansion(event, 2)
    assert abs(abs(found.load[1]) - 1.0) <= found.error[1] < 1e-8
    assert found(0.1) == pytest.approx(found.load[1] * 0.1, abs=1e-9)


def test_an_expansion_needs_one_other_branch():
    fold = rl.follow(rl.equilibrium(rl.Strut(n=5, u_hat=0.1), 10.0, lambda s: -3 * s), to=0.0).events[0]
    with pytest.raises(ValueError, match="must be a branch point"):
        rl.expansion(fold)
    event = first_pitchforks(rl.Strut(n=5), 1)[0]
    with pytest.raises(ValueError, match="order must be at most 6"):
        rl.expansion(event, 9)


# --- what two adversaries found --------------------------------------------------------------------------------------


def polynomial(text, **symmetry):
    """A scalar model from its expression in u and lam, without bounds."""
    import sympy

    u, lam = sympy.symbols("u lam")
    F = sympy.sympify(text, locals={"u": u, "lam": lam})
    model = Scalar(*(sympy.lambdify((u, lam), f) for f in (F, sympy.diff(F, u), sympy.diff(F, lam))))
    for name, value in symmetry.items():
        setattr(model, name, value)
    return model


CASES = [
    # model, window, guess, {load: solutions}
    ("u*(u**2+lam*(lam-1))", (-1, 2), [0.0], {-0.5: 1, 0.5: 3, 1.5: 1}),  # sides end where they meet the trivial branch
    ("u*(lam-1-1000*u**2)", (0, 2), [0.0], {0.5: 1, 1.5: 3}),  # steep: starts must be near
    ("u*(lam-1-u**2)", (0, 1.0001), [0.0], {0.5: 1, 1.00005: 3}),  # at the edge of the window
    ("u*(lam-1+0.5*u**2-625*u**4)", (0, 2), [0.0], {0.99995: 5, 1.5: 3}),  # a fold right after the pitchfork
    ("100*u*(lam-1-(100*u)**2)", (0, 2), [0.0], {0.5: 1, 1.5: 3}),  # other units
    ("100*u*(lam-1-100*u)", (0, 2), [0.0], {0.5: 2, 1.5: 2}),
    ("(u-lam)*(u+2*lam)", (-1, 1), [-1.0], {-0.5: 2, 0.5: 2}),  # two sloped lines
    ("(u-lam+3)*(u+2*lam-6)", (2, 4), [-1.0], {2.5: 2, 3.5: 2}),
]


@pytest.mark.parametrize(("text", "window", "guess", "counts"), CASES)
def test_small_models_of_ones_own(text, window, guess, counts):
    d = rl.diagram(polynomial(text), window, guess)
    assert d.complete
    assert {lam: d.count(lam) for lam in counts} == counts


def test_a_start_on_a_side_branch():
    """Past the pitchfork a model without bounds must not be led onto the trivial branch."""
    model = polynomial("u*(lam-1-u**2)")
    d = rl.diagram(model, (-1, 5), rl.equilibrium(model, 4.0, [3**0.5]))
    assert [d.count(lam) for lam in (0.5, 2.0)] == [1, 3]
    kinds = [row.kind for row in d.table if row.kind != "end"]
    assert kinds == ["subcritical pitchfork"]  # the branch that opens upwards is the one of higher index
    strut = rl.Strut(n=3)
    for lam in (3.0, 8.0):
        d = rl.diagram(strut, (0, 40), rl.equilibrium(strut, lam, lambda s: 1.5 * s))
        assert d.complete
        assert d.count(20.0) == 5


def test_counts_at_points_and_next_to_special_loads():
    strut = rl.Strut(n=3)
    d = rl.diagram(strut, (0, 40))
    for lam in {p.lam for b in d.branches for p in b.points[1:-1]}:
        special = any(abs(lam - row.lam) < 1e-9 for row in d.table if row.kind != "end")
        if lam < 25 and not special:  # beyond there are parasites
            assert d.count(lam) == len(rl.all_equilibria(strut, lam)), lam
    bent = rl.census(rl.Strut(n=3, u_hat=0.1), (0, 20), looks=3)
    fold = min(row.lam for row in bent.table if row.kind == "fold")
    for off in (-3e-4, -1e-4, -1e-5, -1e-6, 1e-6, 1e-4):
        assert bent.count(fold + off) == (1 if off < 0 else 3), off


def test_branch_points_next_to_each_other_are_told_apart_or_said():
    from models import Struts

    apart = rl.diagram(Struts(rl.Strut(n=1), rl.Strut(n=1, K=1 + 1e-4)), (0, 3), np.zeros(2))
    assert apart.complete
    assert apart.count(2.5) == 9
    close = rl.diagram(Struts(rl.Strut(n=1), rl.Strut(n=1, K=1 + 1e-6)), (0, 3), np.zeros(2))
    assert not close.complete
    assert any("another branch point lies next to" in row.reason for row in close.table)


def test_a_start_that_is_singular_is_said():
    d = rl.diagram(polynomial("u*(lam-1-u**2)"), (1, 2), [0.0])
    assert not d.complete
    assert any("the start is singular" in row.reason for row in d.table)


def test_images_on_the_branch_itself_are_not_counted_twice():
    circle = polynomial("u**2+lam**2-1", symmetries=(np.negative,))
    for lam in (0.1, 0.2, 0.3, 0.5):
        d = rl.diagram(circle, (-2, 2), rl.equilibrium(circle, lam, [0.9]))
        assert d.copies == [1]
        assert d.count(0.21) == 2


def test_the_default_start_is_the_unstressed_shape():
    d = rl.diagram(rl.Strut(n=3, u_hat=3), (-30, 30))
    assert d.count(0.0) == 1
