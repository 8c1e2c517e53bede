"""The stability study: its truths against independent ones, its judge, its naive formulas, its grid; no silent wrong cell."""

import json
import math
import tomllib
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import rodlab
from rodlab.lab.studies import cases, contrasts, grid, naive, rod_truths, stability, truths
from rodlab.lab.studies.cells import Cell, answer
from rodlab.lab.studies.judge import NAIVE, VERDICTS, NeverEndsError, judged, judged_index, judged_naively
from rodlab.lab.studies.pairs import Pair, sine_and_cosine
from rodlab.lab.studies.stability_picture import picture
from rodlab.mechanics.elastica import elastica
from rodlab.mechanics.strut import Strut

TABLE = tomllib.loads((Path(rodlab.__file__).parent / "lab/scenes/stability.toml").read_text())["stability"]


def off(a, b):
    with mp.workdps(50):
        return float(abs(a - b) / abs(b))


def exactly(n, rule, j):
    """The closed form for k = n and h = 1, where nothing of the strut is rounded."""
    with mp.workdps(50):
        return 4 * n * mp.sin((2 * j - 1) * mp.pi / (2 * (2 * n + 1) if rule == "end" else 4 * n)) ** 2


# --- truths ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", ["end", "trapezoid"])
@pytest.mark.parametrize("n", [1, 2, 7, 128])
def test_loads_by_counts_are_the_closed_form(n, rule):
    strut = Strut(n=n, rule=rule)
    numbers = sorted({1, n})
    found = truths.exact_loads(n * np.ones(n), strut.joints.w, numbers)  # h = 1: no rounding of 1/n
    for load, j in zip(found, numbers, strict=True):
        assert off(load, exactly(n, rule, j)) < 1e-24


def test_loads_by_counts_against_dense_eigenvalues_in_mpmath():
    k = 10.0 ** np.random.default_rng(5).uniform(-6, 6, 8)
    with mp.workdps(50):
        A = mp.zeros(8)
        for i in range(8):
            A[i, i] = mp.mpf(k[i]) + (mp.mpf(k[i + 1]) if i < 7 else 0)
            if i < 7:
                A[i, i + 1] = A[i + 1, i] = -mp.mpf(k[i + 1])
        w = sorted(mp.eigsy(A, eigvals_only=True))
    for j, load in zip((1, 4, 8), truths.exact_loads(k, np.ones(8), [1, 4, 8]), strict=True):
        assert off(load, w[j - 1]) < 1e-24


def test_counts_against_fractions():
    rng = np.random.default_rng(2)
    for n in (1, 2, 5, 12):
        for _ in range(20):
            k, c = np.exp2(rng.integers(-3, 4, n)), rng.integers(-9, 10, n) / 4.0
            d, e = k + np.append(k[1:], 0) - c, -k[1:]
            assert truths.exact_count(k, c) == truths.exact_index(d, e)[0]


def test_counts_of_the_uniform_strut():
    for lam in (0.0, 2.0, 5.0, 400.0, 4e4, 1e6):
        loads = [truths.uniform_load(100, "end", j) for j in range(1, 101)]
        assert truths.uniform_count(100, "end", lam) == sum(load < lam for load in loads)


def test_pairs_keep_thirty_digits():
    x = Pair(np.linspace(-9.3, 7.7, 101), np.full(101, 3e-18))
    sin, cos = sine_and_cosine(x)
    y = x * sin - cos
    with mp.workdps(50):
        for i in range(0, 101, 10):
            v = mp.mpf(x.high[i]) + mp.mpf(x.low[i])
            assert abs(mp.mpf(y.high[i]) + mp.mpf(y.low[i]) - (v * mp.sin(v) - mp.cos(v))) < 1e-30


@pytest.mark.parametrize(("u_hat", "lam"), [(1.0, 30.0), (0.01, 2.4), (1.0, -1e4)])
def test_angles_in_pairs_are_those_of_mpmath(u_hat, lam):
    strut = Strut(n=60, u_hat=u_hat)
    phi = rodlab.equilibrium(strut, lam).u
    exact, pair = truths.exact_angles(strut, phi, lam, 50), truths.refined(strut, phi, lam, 1e-24)
    with mp.workdps(50):
        assert abs(exact.angles[-1] - truths.many(pair.angles.high[-1], pair.angles.low[-1])) < 1e-26
    counts = [truths.exact_count(strut.joints.k, truths.pressed(strut, one, lam)) for one in (exact, pair)]
    assert counts[0] == counts[1] == rodlab.equilibrium(strut, lam).index
    assert exact.residual == pytest.approx(pair.residual, rel=1e-9, abs=1e-25)


def test_a_truth_that_is_not_found_says_so():
    with pytest.raises(ArithmeticError, match="no truth is known"):
        truths.refined(Strut(n=50, u_hat=1.0), np.linspace(0, 40.0, 50), 200.0, 1e-24)


def test_loads_of_rods_across_a_jump_are_the_transcendental_root():
    """K = 1 below 1/2 and a above: tan(q/2) tan(q / (2 sqrt a)) = 1 / sqrt a."""
    for a in (1e3, 1e12):
        with mp.workdps(60):
            root = mp.sqrt(mp.mpf(a))
            load = rod_truths.rod_load([1.0, a], [0, 0.5, 1], 1)
            q = mp.sqrt(load)
            assert abs(mp.tan(q / 2) * mp.tan(q / 2 / root) * root - 1) < 1e-24
        assert 0 < load < 4 * (math.pi / 2) ** 2
    assert off(rod_truths.rod_load([4.0], [0, 1], 3), 25 * mp.mpf(math.pi) ** 2) < 1e-15


@pytest.mark.parametrize(("u_hat", "lam"), [(1.0, -100.0), (3.0, -60.0)])
def test_the_layer_is_that_of_the_quadrature(u_hat, lam):
    """1 = integral of dphi / sqrt(c^2 + 4 |lam| sin^2(phi/2)), c = phi'(0), c^2 + 4 |lam| sin^2(tip/2) = u_hat^2."""
    rate = math.sqrt(-lam)

    def tip_at(c):
        return 2 * math.asin(math.sqrt(u_hat**2 - c * c) / (2 * rate))

    def length(log_c):
        c = math.exp(log_c)

        def slowness(t):  # phi = (c / rate) sinh(t): smooth, however small c is
            phi = c / rate * math.sinh(t)
            return c / rate * math.cosh(t) / math.sqrt(c * c + 4 * rate**2 * math.sin(phi / 2) ** 2)

        return quad(slowness, 0, math.asinh(tip_at(c) * rate / c), epsabs=1e-12)[0]

    c = math.exp(brentq(lambda t: length(t) - 1, -25, math.log(u_hat) - 1e-3, xtol=1e-13))
    tip, clamp = rod_truths.layer_tip(u_hat, lam)
    change = float(abs(tip_at(c) - tip))
    assert clamp / 100 < change <= clamp


def test_layers_wound_too_far_are_refused():
    with pytest.raises(ValueError, match="u_hat must be at most"):
        rod_truths.layer_tip(30.0, -100.0)


# --- the judge ---------------------------------------------------------------------------------------------------------


def test_every_verdict_is_reachable():
    assert judged(1.0, 1.0, 1e-12)["verdict"] == "right"
    assert judged(1.0 + 1e-12, 1.0, 1e-6)["verdict"] == "loose"
    assert judged(1e-30, 1e-31, 1e-28)["verdict"] == "loose"  # a claim above the answer itself says nothing of it
    assert judged(1.0, 2.0, 0.1, verified=False)["verdict"] == "unverified"
    assert judged(1.0 + 1e-12, 1.0, 1e-13)["verdict"] == "WRONG"
    assert judged(5e-324, 1e-323, 0.0)["verdict"] == "WRONG"
    assert judged(0.0, mp.mpf(10) ** -330, 0.0)["verdict"] == "right"  # no float is nearer
    assert judged(math.nan, 1.0, 1e-3)["verdict"] == "WRONG"
    assert [judged_index(*bounds, 2)["verdict"] for bounds in ((2, 2), (1, 2), (2, 3), (3, 3), (0, 1))] == [
        "right", "unverified", "unverified", "WRONG", "WRONG",
    ]  # fmt: skip


def test_a_truth_too_coarse_to_judge_is_not_used():
    with pytest.raises(ArithmeticError, match="the truth is known to"):
        judged(1.0, 1.0 + 1e-10, 1e-10, unsure=1e-12)


def test_a_falsified_answer_is_called_wrong(monkeypatch):
    """The whole way: a load off by more than it claims, and an index that is not the exact one."""
    own = cases.buckling

    def falsified(model, modes):
        found = own(model, modes)
        return type(found)(found.model, found.numbers, found.loads * (1 + 1e-11), found.error)

    monkeypatch.setattr(cases, "buckling", falsified)
    found = cases.loads(10)
    assert found["verdict"] == "WRONG"
    assert found["forward"] == pytest.approx(1e-11, rel=1e-3)
    monkeypatch.setattr(truths, "exact_count", lambda *_: 7)
    assert cases.equilibrium(10, 1.0, u_hat=0.1)["verdict"] == "WRONG"
    said = stability.text(stability.answer([Cell("cases:loads", {})], [found]))
    assert "WRONG: K = 1, n = 10, end: load 1" in said
    assert "No silent wrong cell" not in said


def test_every_verdict_of_a_naive_formula_is_reachable():
    def never():
        raise NeverEndsError("after 3 steps", 1.0)

    formulas = (lambda: 1.0, lambda: 1.1, lambda: math.inf, never, lambda: 1 / 0)
    assert tuple(judged_naively(formula, 1.0)["naive_verdict"] for formula in formulas) == NAIVE


# --- naive formulas fail as they are said to ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("found", "naive_verdict"),
    [
        (lambda: cases.loads(10), "right"),
        (lambda: cases.loads(100, {"jump": 1e12, "at": 0.5}), "wrong, silently"),
        (lambda: contrasts.contrast_fold(40), "wrong, silently"),
        (lambda: contrasts.contrast_determinant(1000, 5.0), "overflow"),
        (lambda: contrasts.contrast_determinant(1000, 5e-6, 1e-6), "overflow"),
        (lambda: contrasts.contrast_determinant(10, 5.0), "right"),
        (lambda: contrasts.contrast_zero_pivot(1.0), "fails"),
        (lambda: contrasts.contrast_zero_pivot(1.0 + 2.0**-52), "wrong, silently"),
        (lambda: contrasts.contrast_residual_test(30000, 2.4, 0.01, 1e-14, most=8), "never ends"),
        (lambda: contrasts.contrast_residual_test(100, 2.4e-10, 0.01, 1e-10, 1e-10), "wrong, silently"),
        (lambda: contrasts.contrast_sampling(401, 1e3), "wrong, silently"),
        (lambda: contrasts.contrast_conjugate(100, 5.0), "wrong, silently"),
        (lambda: contrasts.contrast_conjugate(10000, -1e6), "overflow"),
        (lambda: contrasts.contrast_eigenvalues(300, 1, 1e-12), "wrong, silently"),
    ],
)
def test_naive_beside_ours(found, naive_verdict):
    result = found()
    assert result["naive_verdict"] == naive_verdict
    assert result["verdict"] == "right"
    assert result["lesson"].endswith(".")


def test_the_naive_load_loses_digits_in_proportion_to_the_condition_number():
    for n in (10, 100, 1000):
        result = cases.loads(n, {"jump": 1e6, "at": 0.3})
        assert 1e-3 < result["naive_forward"] / (result["condition"] * 2.2e-16) < 10
        assert result["forward"] < 1e-13


def test_the_naive_formulas_are_right_where_nothing_is_hard():
    d, e, b = np.array([4.0, 5.0, 6.0]), np.array([-1.0, 2.0]), np.array([1.0, 2.0, 3.0])
    A = np.diag(d) + np.diag(e, 1) + np.diag(e, -1)
    assert naive.by_pivots(d, e, b) == pytest.approx(np.linalg.solve(A, b))
    assert naive.determinant(d, e) == pytest.approx(np.linalg.det(A))
    x, y = naive.by_blocks(A, b, d, 2.0, b, 1.0)
    assert A @ x + b * y == pytest.approx(b)
    assert d @ x + 2 * y == pytest.approx(1.0)
    strut = Strut(n=10, u_hat=0.1)
    assert naive.newton_by_residual(strut, 1.0, 1e-12, 20) == pytest.approx(rodlab.equilibrium(strut, 1.0).tip_angle)


# --- the grid ------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def quick():
    asked = stability.cells({}, TABLE, quick=True)
    return asked, [answer(cell) for cell in asked]


def test_the_quick_grid_has_no_silent_wrong_cell(quick):
    found = stability.answer(*quick)
    assert "failed" not in found["verdicts"], found["refusals"]
    assert found["wrong"] == []
    assert stability.complete(found)
    assert found["verdicts"]["right"] > 400
    assert found["verdicts"]["refused"] >= 1
    assert found["verdicts"]["unverified"] >= 1
    assert all(row["why"] for row in found["rows"] if row["verdict"] == "refused")
    assert {row["verdict"] for row in found["rows"]} <= set(VERDICTS)


def test_the_index_is_verified_until_rounding_hides_it(quick):
    rows = [row for row in quick[1] if row.get("kind") == "index" and row["case"].startswith("K = 1,")]
    assert all(row["verdict"] == "right" for row in rows if row["condition"] < 1e15)
    assert {row["verdict"] for row in rows if "1e-16" in row["case"]} == {"unverified"}


def test_results_are_plain_and_the_same_every_time(quick):
    asked, results = quick
    for cell, result in list(zip(asked, results, strict=True))[::25]:
        again = answer(cell)
        assert json.dumps({**again, "cost": 0}) == json.dumps({**result, "cost": 0})


def test_the_text_and_the_picture_say_what_was_found(quick):
    found = stability.answer(*quick)
    said = stability.text(found)
    for phrase in (
        "Buckling loads of straight struts",
        "Refused: each sentence once",
        "Naive formulas beside ours",
        "never ends",
    ):
        assert phrase in said
    assert max(len(line) for line in said.splitlines()) < 210
    left, right = picture(found).axes
    assert left.get_xscale() == right.get_yscale() == "log"
    assert sum(len(line.get_xdata()) for line in left.lines) > 200


def test_lists_are_multiplied_out_once_each():
    table = {"grid": [{"case": "loads", "n": [1, 3], "mode": [1, 2, "n"]}, {"case": "loads", "n": 3, "mode": 3, "slow": True}]}
    assert grid.cells(table) == [("cases:loads", {"n": n, "mode": j}) for n, j in ((1, 1), (3, 1), (3, 2), (3, 3))]
    assert len(stability.cells({}, TABLE)) > len(stability.cells({}, TABLE, quick=True)) > 400


@pytest.mark.parametrize(
    ("group", "says"),
    [
        ({"case": "load"}, "case must be one of loads, .*; it is 'load'"),
        ({"n": 3}, "case must be one of"),
        ({"case": "loads"}, "case loads needs n"),
        ({"case": "loads", "n": 0}, "n must be a whole number, at least 1; it is 0"),
        ({"case": "loads", "n": [1, 2.5]}, "n must be a whole number, at least 1; it is 2.5"),
        ({"case": "loads", "n": []}, "must hold at least one value"),
        ({"case": "loads", "n": 3, "m": 1}, "case loads takes n, K, rule, mode; m is none of these"),
        ({"case": "loads", "n": 3, "mode": "m"}, "mode must be a whole number, at least 1, or"),
        ({"case": "loads", "n": 3, "rule": "mid"}, "rule must be one of end, trapezoid; it is 'mid'"),
        ({"case": "loads", "n": 3, "K": -1.0}, "K must be a finite number above 0; it is -1.0"),
        ({"case": "loads", "n": 3, "K": {"jump": 2.0}}, "K, where it is a table, must have jump and at"),
        ({"case": "loads", "n": 3, "K": {"jump": 2.0, "at": 1.0}}, "at of K must lie between 0 and 1; it is 1.0"),
        ({"case": "loads", "n": 3, "slow": 1}, "slow must be true or false; it is 1"),
        ({"case": "equilibrium", "n": 3, "lam": "big"}, "lam must be a finite number; it is 'big'"),
        ({"case": "elastica", "ratio": 1.0}, "ratio must be a finite number above 1; it is 1.0"),
        ({"case": "layer", "lam": -1.0, "guess": 3}, "guess must be an expression in s; it is 3"),
        ({"case": "contrast_sampling", "n": 3, "jump": 2.0, "where": "top"}, "where must be one of joint, middle; it is 'top'"),
    ],
)
def test_a_bad_grid_says_so_in_one_sentence(group, says):
    with pytest.raises(ValueError, match=says):
        grid.cells({"grid": [group]})


@pytest.mark.parametrize("table", [{}, {"grid": []}, {"grid": [1]}, {"grid": [{"case": "loads", "n": 1}], "n": 3}])
def test_a_bad_table_says_so(table):
    with pytest.raises(ValueError, match=r"\[stability\] must hold"):
        grid.cells(table)


def test_the_elastica_far_out_is_judged_by_elliptic_functions():
    found = cases.elastica(10.0)
    assert found["truth"] == elastica(10.0 * (math.pi / 2) ** 2).tip_angle
    assert found["verdict"] == "right"
    assert found["condition"] < 0.1
