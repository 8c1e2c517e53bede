"""Naive formulas beside ours, one a function: the same question, both answers, and what a class learns from it."""

from typing import Any

import mpmath as mp
import numpy as np

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.events import fold
from rodlab.analysis.follow import follow
from rodlab.lab.studies import naive, truths
from rodlab.lab.studies.cases import condition, index
from rodlab.lab.studies.judge import judged, judged_index, judged_naively
from rodlab.lab.studies.rod_truths import rod_load
from rodlab.lab.studies.stiffness import Given, in_words, strut_with
from rodlab.mechanics.buckling import buckling
from rodlab.mechanics.conjugate import conjugate_points
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import EPS, Array
from rodlab.numerics.bordered import Bordered

BENT = 3.0  # tip angle of the guess from which the detached branch is found


def contrast_fold(n: int = 40, u_hat: float = 0.01, start: float = 10.0) -> dict[str, Any]:
    """A bordered system at the fold of the detached branch: mixed block elimination, and plain."""
    strut = Strut(n=n, u_hat=u_hat)
    p = equilibrium(strut, start, lambda s: -BENT * np.sin(np.pi * s / 2))
    at = next(event.point for event in follow(p, 0.0, events=(fold,)).events if event.kind == "fold")
    H, b = strut.hessian(at.u, at.lam), strut.d_lam(at.u, at.lam)
    c = np.sin(np.pi * np.arange(1, n + 1) / (2 * n))
    f, g = np.cos(np.arange(1.0, n + 1)), 1.0
    dense = H.toarray()
    whole = np.block([[dense, b[:, None]], [c[None, :], np.zeros((1, 1))]])
    with mp.workdps(50):
        truth = mp.lu_solve(mp.matrix(whole.tolist()), mp.matrix([*f, g]))[n - 1]
    x, y = Bordered(H, H.factor(), B=b[:, None], C=c[:, None], D=np.zeros((1, 1))).solve(f, np.array([g]))
    kappa = float(np.linalg.cond(whole))
    claimed = 8 * EPS * kappa * float(np.hypot(np.linalg.norm(x), y[0]))
    left = whole @ np.append(x, y) - np.append(f, g)
    backward = float(np.linalg.norm(left) / (np.linalg.norm(whole, 2) * np.hypot(np.linalg.norm(x), y[0])))
    said = _head("block elimination at a fold", f"fold at lam = {at.lam:.6f}, u_hat = {u_hat:g}, n = {n}", "x at the tip", n)
    return {
        **said, "condition": float(np.linalg.cond(dense)), "backward": backward, **judged(float(x[-1]), truth, claimed),
        **judged_naively(lambda: float(naive.by_blocks(dense, b, c, 0.0, f, g)[0][-1]), truth),
        "lesson": "The block is singular at a fold and the whole is not: solve for the border by the transposed problem first.",
    }  # fmt: skip


def contrast_determinant(n: int, lam: float, K: Given = 1.0) -> dict[str, Any]:
    """Is the index odd? Sturm's count, and the sign of a determinant."""
    strut = strut_with(n, K, "end")
    H = strut.hessian(np.zeros(n), lam)
    truth = truths.exact_count(strut.joints.k, truths.times(lam, strut.joints.h * strut.joints.w))
    said = _head("sign of the determinant", f"{in_words(K)}, lam = {lam:g}, n = {n}", "index odd", n)
    found = judged_index(H.index % 2, (H.index + H.nullity) % 2, truth % 2)

    def odd() -> float:
        value = naive.determinant(H.diagonal, H.off_diagonal)
        return value if not np.isfinite(value) or value == 0 else float(value < 0)

    said |= {"condition": condition(strut, np.zeros(n), lam), "backward": 0.0}
    beside = judged_naively(odd, truth % 2, whole=True)
    if naive.determinant(H.diagonal, H.off_diagonal) == 0:
        beside |= {"naive_forward": float("inf"), "naive_verdict": "overflow", "naive_why": "its answer is 0, by underflow"}
    return {**said, **found, **beside, "lesson": "Count the signs of the pivots; do not multiply them."}


def contrast_zero_pivot(lam: float, n: int = 2) -> dict[str, Any]:
    """One step of Newton's method for n joints, k = h = 1: the structured solve, and L D L^T without exchanges."""
    strut = Strut.from_joints(k=np.ones(n))
    H, b = strut.hessian(np.zeros(n), lam), np.arange(1.0, n + 1) / 10
    with mp.workdps(50):
        A = mp.matrix(H.toarray().tolist())
        for i in range(n):
            A[i, i] = (1 if i == n - 1 else 2) - mp.mpf(lam)
        truth = mp.lu_solve(A, mp.matrix([mp.mpf(float(v)) for v in b]))[n - 1]
    x = H.solve(b)
    kappa = condition(strut, np.zeros(n), lam)
    left = float(np.abs(H @ x - b).max() / (float(np.abs(H.toarray()).sum(axis=1).max()) * np.abs(x).max()))
    said = _head("zero pivot", f"k = h = 1, lam = {_near(lam)}, n = {n}", "tip of H x = b", n)
    return {
        **said, "condition": kappa, "backward": left, **judged(float(x[-1]), truth, 8 * n * EPS * kappa * float(np.abs(x).max())),
        **judged_naively(lambda: float(naive.by_pivots(H.diagonal, H.off_diagonal, b)[-1]), truth),
        "lesson": "A pivot may vanish though the matrix is far from singular: exchange rows.",
    }  # fmt: skip


def contrast_residual_test(n: int, lam: float, u_hat: float, tolerance: float, K: Given = 1.0, most: int = 12) -> dict[str, Any]:
    """Newton's method stopped by its steps, and by the residual."""
    strut = strut_with(n, K, "end", u_hat)
    p = equilibrium(strut, lam)
    known = truths.refined(strut, p.u, lam, 1e-4 * p.error)
    tip = truths.many(known.angles.high[-1], known.angles.low[-1])
    case = f"{in_words(K)}, lam = {lam:g}, u_hat = {u_hat:g}, n = {n}, |F| <= {tolerance:g}"
    said = _head("residual test", case, "tip angle", n)
    return {
        **said, "condition": condition(strut, p.u, lam), "backward": EPS, "index": p.index,
        **judged(p.tip_angle, tip, p.error, verified=p.index_verified, unsure=known.step),
        **judged_naively(lambda: naive.newton_by_residual(strut, lam, tolerance, most), tip),
        "lesson": "A residual has the scale of k and the rounding of k phi: judge Newton's method by its step.",
    }  # fmt: skip


def contrast_sampling(n: int, jump: float, at: float = 0.5, where: str = "joint") -> dict[str, Any]:
    """Load 1 across a jump of K: springs by compliance, and by samples of K; ours claims what 3 n joints change, twice."""
    K, weights = {"jump": jump, "at": at}, np.append(np.ones(n - 1), 0.5)
    truth = rod_load([1.0, jump], [0.0, at, 1.0], 1)
    load, finer = (float(buckling(strut_with(m, K, "trapezoid"), [1]).loads[0]) for m in (n, 3 * n))
    said = _head("sampling across a jump", f"{in_words(K)} at s = {at:g}, n = {n}, K at each {where}", "load 1 of the rod", n)
    sampled = Strut.from_joints(k=naive.sampled_springs(jump, at, n, where), h=1 / n, weights=weights)
    found = judged(load, truth, 2 * abs(load - finer))
    return {
        **said, "condition": max(jump, 1.0) * (np.pi / 2) ** 2 / float(truth), "backward": found["forward"], **found,
        **_to_three_digits(judged_naively(lambda: float(buckling(sampled, [1]).loads[0]), truth)),
        "lesson": "Across a jump give a spring the exact compliance of its link: second order, whatever the mesh.",
    }  # fmt: skip


def contrast_conjugate(n: int, lam: float) -> dict[str, Any]:
    """The index of the straight strut by conjugate points: from the free end, rescaled, and from the clamp."""
    strut = Strut(n=n)
    p = equilibrium(strut, lam)
    truth = truths.uniform_count(n, "end", lam)
    said = _head("conjugate points from the clamp", f"straight, lam = {lam:g}, n = {n}", "index", n)
    found = len(conjugate_points(p))
    c = lam * strut.joints.h * strut.joints.w
    return {
        **said, "condition": condition(strut, p.u, lam), "backward": 0.0, **judged_index(found, found, truth),
        **judged_naively(lambda: naive.conjugate_points_from_clamp(strut.joints.k, c), truth, whole=True),
        "lesson": "March from the free end, where the moment vanishes, and scale the field back as it grows.",
    }  # fmt: skip


def contrast_eigenvalues(n: int, mode: int, off: float) -> dict[str, Any]:
    """The index next to a buckling load: a count with bounds, and the signs of computed eigenvalues."""
    ours = index(n, 1.0, "end", mode, off)
    strut = Strut(n=n)
    lam = truths.beside(truths.uniform_load(n, "end", mode), off)
    H: Array = strut.hessian(np.zeros(n), lam).toarray()
    beside = judged_naively(lambda: naive.negative_eigenvalues(H), ours["truth"], whole=True)
    lesson = "A computed eigenvalue is off by eps times the norm: count twice, with the rounding added and taken away."
    return {**ours, "kind": "contrast", "group": "signs of eigenvalues", **beside, "lesson": lesson}


def _head(group: str, case: str, asks: str, n: int) -> dict[str, Any]:
    return {"kind": "contrast", "group": group, "case": case, "asks": asks, "n": n, "cost": {}}


def _near(lam: float) -> str:
    short, whole = f"{lam:g}", round(lam)
    return short if float(short) == lam else f"{whole:g} {'-' if lam < whole else '+'} {abs(lam - whole):.2g}"


def _to_three_digits(beside: dict[str, Any]) -> dict[str, Any]:
    """A discretisation is wrong where not even three digits are right."""
    right = beside["naive_forward"] <= 1e-3
    return {**beside, "naive_verdict": "right" if right else beside["naive_verdict"]}
