"""Stiff and extreme cases, one kind a function: plain data in, a verdict with its numbers out.

    condition   of the problem asked, 2-norm:  equilibrium, index  |H| / least |eigenvalue| of the second variation H, estimated
                from below by a few steps of power and inverse iteration;  loads  |A| / load, A = (hW)^{-1/2} D^T k D (hW)^{-1/2};
                rod loads  (load of the largest K everywhere) / load;  layers, elastica  |d tip / d lam| |lam / tip|
    backward    least relative change of the data that makes the answer exact:  equilibrium  of the terms of every balance of
                moments, max |F_i| / sum of their sizes [Oettli and Prager 1964], F in higher precision;  loads
                |A x - load x| / (|A| |x|) for the mode x;  index  0 where it is right, else 1 / condition (a singular
                matrix is that near);  rod loads  of K;  layers, elastica  of lam
    forward     true error, relative where the truth is not zero (`scale` says which);  claimed  our own estimate of it

Verdicts: see `rodlab.lab.studies.judge`. Times stand under "cost" alone; all else is the same in every run and process.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import mpmath as mp
import numpy as np

from rodlab.analysis.equilibrium import equilibrium as solved
from rodlab.lab.studies import costs, truths
from rodlab.lab.studies.cells import is_sentence
from rodlab.lab.studies.judge import judged, judged_index, judged_naively, refused, unjudged
from rodlab.lab.studies.naive import load_from_entries
from rodlab.lab.studies.reference import exact_load, loads_below
from rodlab.lab.studies.rod_truths import layer_tip, rod_load
from rodlab.lab.studies.stiffness import Given, edges, in_words, rod_with, strut_with
from rodlab.mechanics.buckling import buckling
from rodlab.mechanics.elastica import elastica as exact_elastica
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import Array

FEW = 100  # joints up to which truths are found in mpmath, in pairs of floats beyond
TINY_DATA, SMALL = 1e-290, "next to underflow"
SUMMING = "Summing k_i + k_{i+1} rounds off what the soft springs say; singular values of the bidiagonal form keep every digit."


def loads(n: int, K: Given = 1.0, rule: str = "end", mode: int = 1) -> dict[str, Any]:
    """A buckling load of a straight strut against counts in whole numbers or 4 n^2 sin^2(...); naively from the entries."""
    strut, words = strut_with(n, K, rule), in_words(K)
    k, hw = strut.joints.k, strut.joints.h * strut.joints.w
    said = {**_head("loads", words, f"{words}, n = {n}, {rule}", f"load {mode}", n), "lesson": SUMMING}
    truth, cost = costs.timed(lambda: truths.uniform_load(n, rule, mode) if _is_one(K) else truths.exact_loads(k, hw, [mode])[0])
    with np.errstate(over="ignore"):
        size = float(np.max((k + np.append(k[1:], 0.0)) / hw)) * (2 if n > 1 else 1)
    said |= {"condition": size / float(truth), **judged_naively(lambda: load_from_entries(k, hw, mode), truth)}
    try:
        found, spent = _spent(lambda: buckling(strut, [mode]))
    except (ValueError, ArithmeticError) as error:
        _meant(error)
        return {**said, **refused(error, truth), "cost": {"truth": cost}}
    load = float(found.loads[0])
    verdict = judged(load, truth, float(found.error[0]))
    backward = _eigen_residual(k, hw, load, found.modes[0], size)
    return {**said, "backward": backward, **verdict, "cost": {**spent, "truth": cost}}


def equilibrium(
    n: int, lam: float, K: Given = 1.0, u_hat: float = 0.0, rule: str = "end", guess: str | None = None
) -> dict[str, Any]:
    """The tip angle of an equilibrium of a strut, and its index, against Newton's method in many digits."""
    strut, words = strut_with(n, K, rule, u_hat), in_words(K)
    case = f"lam = {lam:g}, u_hat = {u_hat:g}, {words}, n = {n}, {rule}{_from(guess)}"
    least = min(x for x in (strut.joints.k.min(), abs(u_hat), abs(lam)) if x)
    group = SMALL if least < TINY_DATA else f"lam = {lam:g}" if _is_one(K) else words
    said = _head("equilibrium", group, case, "tip angle", n)
    try:
        p, spent = _spent(lambda: _with_answers(solved(strut, lam, _function(guess))))
    except (ValueError, ArithmeticError) as error:
        _meant(error)
        return {**said, **refused(error), "condition": math.nan, "cost": {}}
    said |= {"condition": condition(strut, p.u, lam), "index": p.index, "index_verified": p.index_verified}
    try:
        (tip, unsure, residual, index), cost = costs.timed(lambda: _exact(strut, p.u, lam, p.error))
    except ArithmeticError as error:
        if p.index_verified:
            raise
        return {**said, **unjudged(p.tip_angle, error), "cost": spent}
    found = judged(p.tip_angle, tip, p.error, verified=p.index_verified, unsure=unsure)
    if judged_index(p.index, p.index + p.nullity, index)["verdict"] == "WRONG":
        found["verdict"] = "WRONG"
    said |= {"index_truth": index, "backward": _oettli_prager(strut, p.u, lam, residual)}
    return {**said, **found, "cost": {**spent, "truth": cost}}


def index(n: int, K: Given = 1.0, rule: str = "end", mode: int = 1, off: float = 0.0) -> dict[str, Any]:
    """The index of the straight strut at lam = load (1 + off) of a mode, against the exact number of loads below lam."""
    strut, words = strut_with(n, K, rule), in_words(K)
    k, hw, uniform = strut.joints.k, strut.joints.h * strut.joints.w, _is_one(K)
    load = truths.uniform_load(n, rule, mode) if uniform else truths.exact_loads(k, hw, [mode])[0]
    lam = truths.beside(load, off)
    case = f"{words}, n = {n}, {rule}, lam = load {mode} (1 {'-' if off < 0 else '+'} {abs(off):g})"
    said = _head("index", f"|off| = {abs(off):g}", case, "index", n)
    truth, cost = costs.timed(
        lambda: truths.uniform_count(n, rule, lam) if uniform else truths.exact_count(k, truths.times(lam, hw))
    )
    kappa = condition(strut, np.zeros(n), lam)
    known, spent = _spent(lambda: strut.hessian(np.zeros(n), lam).inertia())
    found = judged_index(known.negative, known.negative + known.unclear, truth)
    backward = 0.0 if known.negative == truth else 1 / kappa
    return {**said, "condition": kappa, "backward": backward, **found, "cost": {**spent, "truth": cost}}


def layer(lam: float, u_hat: float = 1.0, K: float = 1.0, guess: str | None = None) -> dict[str, Any]:
    """The tip angle of a rod that a load lam < 0 holds straight but for a layer at its free end, against the closed form."""
    said = _head(
        "layer", "layer at the free end", f"lam = {lam:g}, u_hat = {u_hat:g}, K = {K:g}{_from(guess)}", "tip angle", None
    )
    truth, unsure = layer_tip(u_hat, lam, K)
    with mp.workdps(40):
        upper = 2 * mp.pi - truth  # the saddle between this layer and one turn more
    half = u_hat / 2 * math.sqrt(K / -lam)
    kappa = half / math.sqrt(1 - half * half) / abs(float(truth))
    rod = rod_with(K, u_hat)
    return _of_rod(said, lambda: _with_answers(solved(rod, lam, _function(guess))), ((truth, 0), (upper, 1)), unsure, kappa)


def elastica(ratio: float, mode: int = 1) -> dict[str, Any]:
    """The tip angle of the uniform rod buckled in a mode, at `ratio` times the buckling load, against elliptic functions."""
    lam = ratio * exact_load(mode)
    known = exact_elastica(lam, mode)
    said = _head("elastica", f"mode {mode}", f"mode {mode}, lam = {ratio:g} lam_{mode}", "tip angle", None)
    rod = rod_with(1.0, 0.0)
    size, places = min(1.0, abs(known.tip_angle)), known.shape.s
    guess = size * (known.shape.phi / size).round(2)  # to a hundredth: near the branch, no nearer
    others = [exact_elastica(lam, j) for j in range(1, 1 + loads_below(lam))]
    return _of_rod(
        said, lambda: _with_answers(solved(rod, lam, lambda s: np.interp(s, places, guess))),
        [(side * one.tip_angle, one.index) for one in others for side in (1, -1)], known.error, known.condition,
    )  # fmt: skip


def rod_loads(K: Given = 1.0, mode: int = 1) -> dict[str, Any]:
    """A buckling load of a straight rod whose K is piecewise constant, against the root of its transcendental equation."""
    words, (values, at) = in_words(K), edges(K)
    said = _head("rod_loads", words, words, f"load {mode}", None)
    truth, cost = costs.timed(lambda: rod_load(values, at, mode))
    said["condition"] = max(values) * ((mode - 0.5) * math.pi) ** 2 / float(truth)
    try:
        found, spent = _spent(lambda: buckling(rod_with(K, 0.0), [mode]))
    except (ValueError, ArithmeticError) as error:
        _meant(error)
        return {**said, **refused(error, truth), "cost": {"truth": cost}}
    verdict = judged(float(found.loads[0]), truth, float(found.error[0]))
    return {**said, "backward": verdict["forward"], **verdict, "cost": {**spent, "truth": cost}}


# --- parts -----------------------------------------------------------------------------------------------------------


def condition(strut: Strut, phi: Array, lam: float, steps: int = 5) -> float:
    """|H| / least |eigenvalue| of the second variation, from below, by power and inverse iteration."""
    H, n = strut.hessian(phi, lam), strut.n
    most, least = np.cos(np.pi * np.arange(1, n + 1)) + 0.1, np.sin(np.arange(1.0, n + 1))
    factor = H.factor()
    with np.errstate(all="ignore"):
        for _ in range(steps):
            most, least = H @ (most / _norm(most)), factor.solve(least / _norm(least))
        kappa = _norm(most) * _norm(least)
    return kappa if math.isfinite(kappa) else math.inf


def _exact(strut: Strut, phi: Array, lam: float, error: float) -> tuple[Any, float, Array, int]:
    """Exact tip, how far it may be off, the residual at phi, and the exact index."""
    if strut.n <= FEW:
        known = truths.exact_angles(strut, phi, lam, 60)
        tip, unsure = known.angles[-1], 0.0
    else:
        known = truths.refined(strut, phi, lam, 1e-4 * error if 0 < error < math.inf else 1e-18)
        tip, unsure = truths.many(known.angles.high[-1], known.angles.low[-1]), known.step
    return tip, unsure, known.residual, truths.exact_count(strut.joints.k, truths.pressed(strut, known, lam))


def _of_rod(
    said: dict[str, Any], solve: Callable[[], Any], known: Sequence[tuple[Any, int]], unsure: float, kappa: float
) -> dict[str, Any]:
    """Judge a rod's tip angle and index by the nearest of the solutions (tip angle, index) that are known."""
    said["condition"] = kappa
    try:
        p, spent = _spent(solve)
    except (ValueError, ArithmeticError) as error:
        _meant(error)
        return {**said, **refused(error, known[0][0]), "cost": {}}
    truth, index = min(known, key=lambda one: abs(float(one[0]) - p.tip_angle))
    verdict = judged(p.tip_angle, truth, p.error, verified=p.index_verified, unsure=unsure)
    if judged_index(p.index, p.index + p.nullity, index)["verdict"] == "WRONG":
        verdict["verdict"] = "WRONG"
    told = {"index": p.index, "index_verified": p.index_verified, "index_truth": index}
    return {**said, **told, "backward": verdict["forward"] / kappa, **verdict, "cost": spent}


def _oettli_prager(strut: Strut, phi: Array, lam: float, residual: Array) -> float:
    j = strut.joints
    terms = j.k * (np.abs(phi) + np.abs(strut.below(phi)) + np.abs(j.beta))
    size = terms + np.append(terms[1:], 0.0) + np.abs(lam * j.h * j.w * np.sin(phi))
    off = np.abs(residual)
    return float(np.max(np.divide(off, size, out=np.where(off > 0, np.inf, 0.0), where=size > 0)))


def _eigen_residual(k: Array, hw: Array, load: float, mode: Array, size: float) -> float:
    """|A x - load x| / (|A| |x|) with x = W^{1/2} mode."""
    root, moment = np.sqrt(hw), k * np.diff(mode, prepend=0.0)
    residual = (moment - np.append(moment[1:], 0.0)) / root - load * root * mode
    return _norm(residual) / (size * _norm(root * mode))


def _head(kind: str, group: str, case: str, asks: str, n: int | None) -> dict[str, Any]:
    return {"kind": kind, "group": group, "case": case, "asks": asks, "n": n}


def _with_answers(p: Any) -> Any:
    """The point, asked for what is timed with it: its error and its index."""
    assert p.error >= 0
    assert p.index_verified is not None
    return p


def _meant(error: Exception) -> None:
    """Raise it again unless it is a sentence of the house's: a crash is no refusal."""
    if not is_sentence(error):
        raise error


def _spent(question: Callable[[], Any]) -> tuple[Any, dict[str, Any]]:
    """An answer of ours, with its seconds and peak memory."""
    found, cost = costs.spent(lambda: None, lambda _: question(), memory=True)
    return found, {name: cost[name] for name in ("solve", "peak_bytes")}


def _norm(x: Array) -> float:
    size = float(np.abs(x).max())
    return size * math.sqrt(float((x / size) @ (x / size))) if 0 < size < math.inf else size


def _is_one(K: Given) -> bool:
    return K in (1, "1")


def _from(guess: str | None) -> str:
    return "" if guess is None else f", from {guess}"


def _function(guess: str | None) -> Any:
    from rodlab.mechanics.expression import Expression

    return None if guess is None else Expression(guess)
