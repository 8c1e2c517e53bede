"""Continuation against a bare loop: branch 1 of the strut from its branch point to lam = 25, n = 1000, index at every point.

    python tests/benchmarks/continuation.py            ratios, limit 1.5; cost per point against n
    python tests/benchmarks/continuation.py --quick    informs only

The bare loop below is what one writes in an afternoon: pseudo-arclength with a secant predictor and a banded solver, 93 steps. It
computes no index, checks nothing and would not notice a jump.
"""

import argparse
import sys
import time

import numpy as np
from scipy.linalg import solve_banded

import rodlab as rl

TO = 25.0


def bare_loop(n, first, steps=93):
    """(tip angles, loads) along the branch from the point `first`, steps of one length."""
    h, k = 1.0 / n, float(n)
    bands = np.zeros((3, n))
    bands[0, 1:] = bands[2, :-1] = -k

    def correct(u, lam, du, dlam, u0, lam0, ds):
        for _ in range(10):
            below = np.concatenate([[0.0], u[:-1]])
            m = k * (u - below)
            F = m - lam * h * np.sin(u)
            F[:-1] -= m[1:]
            bands[1] = 2 * k - lam * h * np.cos(u)
            bands[1, -1] -= k
            x = solve_banded((1, 1), bands, np.column_stack([F, -h * np.sin(u)]), check_finite=False)
            g = h * du @ (u - u0) + dlam * (lam - lam0) - ds
            step = (g - h * du @ x[:, 0]) / (dlam - h * du @ x[:, 1])
            u, lam = u - x[:, 0] + step * x[:, 1], lam - step
            if abs(step) + np.sqrt(h) * np.linalg.norm(x[:, 0] - step * x[:, 1]) < 1e-10:
                return u, lam
        raise RuntimeError("no convergence")

    u0, lam0, du, dlam = first.u, first.lam, first.tangent[:-1], first.tangent[-1]
    ds, tips, loads = 0.25, [u0[-1]], [lam0]
    for _ in range(steps):
        u, lam = correct(u0 + ds * du, lam0 + ds * dlam, du, dlam, u0, lam0, ds)
        du, dlam = u - u0, lam - lam0
        size = np.sqrt(h * du @ du + dlam**2)
        du, dlam, u0, lam0 = du / size, dlam / size, u, lam
        tips.append(u[-1])
        loads.append(lam)
    return np.array(tips), np.array(loads)


def start(n):
    """The start of branch 1, from its branch point."""
    strut = rl.Strut(n=n)
    trivial = rl.follow(rl.equilibrium(strut, 2.0), to=3.0, events=(rl.branch_point,))
    return rl.switch(trivial.events[0])[0]


def ours(first, most=1000):
    """The branch with the index of every point."""
    b = rl.follow(first, to=TO, max_points=most)
    assert all(p.index == 0 and p.index_verified and (p.proved or p.checked) for p in b.points)
    assert b.points[-1].lam == TO or len(b.points) == most
    return b


def seconds(run):
    begin = time.perf_counter()
    run()
    return time.perf_counter() - begin


def main():
    """Print ratios and growth; exit code 1 when the ratio at n = 1000 is above its limit."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer repeats, n up to 10^4")
    quick = parser.parse_args().quick
    first = start(1000)
    tips, loads = bare_loop(1000, first)
    b = ours(first)
    proved = sum(p.proved for p in b.points[1:])
    print(f"bare loop: 93 steps to lam = {loads[-1]:.3f}, tip {tips[-1]:.9f}, no index")
    print(f"follow:    {len(b.points) - 1} steps to lam = {TO:g}, {proved} of them proved, index at every point")
    repeats = 5 if quick else 25
    pairs = [(seconds(lambda: ours(first)), seconds(lambda: bare_loop(1000, first))) for _ in range(repeats)]
    ratio = float(np.median([a / c for a, c in pairs]))
    print(
        f"n = 1000: {1e3 * np.median([a for a, _ in pairs]):.1f} ms against {1e3 * np.median([c for _, c in pairs]):.1f} ms; ratio {ratio:.2f} (limit 1.5)"
    )
    sizes, costs = (10**3, 10**4) if quick else (10**3, 10**4, 10**5, 10**6), []
    for n in sizes:
        first = start(n)
        begin = time.perf_counter()
        b = ours(first, 15 if n < 10**6 else 4)
        costs.append((time.perf_counter() - begin) / (len(b.points) - 1))
        proved = sum(p.proved for p in b.points[1:])
        print(f"n = {n:8}: {len(b.points) - 1} points, {proved} proved, {1e3 * costs[-1]:9.2f} ms a point")
    slope = np.polyfit(np.log(sizes), np.log(costs), 1)[0]
    print(f"cost of a point grows as n^{slope:.2f}, from the last two n as n^{np.log(costs[-1] / costs[-2]) / np.log(10):.2f}")
    return int(ratio > 1.5 and not quick)


if __name__ == "__main__":
    sys.exit(main())
