"""The strut's boundary value problem, whole: trivial branch, branch point, switch, branch 1 to lam = 25, against AUTO and solve_bvp.

    python tests/benchmarks/rod.py            a table of times, errors and ratios
    python tests/benchmarks/rod.py --quick    ours and solve_bvp only, informs

AUTO is AUTO-07p's own compiled program as the package bifpy installs it (pip install bifpy, apt-get install gfortran; without
them its rows are left out), run twice, as switching asks for. Its time is its own "Total Time", without process start and files.
"tuned" settings came from a random search of thousands for this one end point (4 points, no accuracy in between), "usual" are those of
a careful user; both meet the error asked for. Ours: `bare` takes steps as AUTO does; `shown` proves or checks every step, knows
the index and the error of every point and adapts its mesh. Limits asked for: 1.0 (bare) and 2.0 (shown) times AUTO, 0.05 times
solve_bvp; where a ratio is above its limit the table says so, and where the time goes (--profile).
"""

import argparse
import math
import sys
import time
from contextlib import closing

import numpy as np
from scipy.integrate import solve_bvp

import rodlab as rl
from rodlab.analysis.continuation import Walk
from rodlab.analysis.crossings import Locator
from rodlab.analysis.stops import passages
from rodlab.lab.studies.peers import Auto, AutoSettings, auto_missing

TO = 25.0

SETTINGS = {
    "AUTO, tuned, 1e-9": AutoSettings(4, 5, 1, 9, 2, 1.03e-5, 7.6e-7, 4.6686, 4.3303, 0.87125, 0),
    "AUTO, tuned, 1e-10": AutoSettings(4, 6, 3, 9, 3, 5.07e-3, 4.8e-8, 2.24572, 0.567436, 3.36243e-3, 0.1),
    "AUTO, usual, 1e-9": AutoSettings(10, 4, 3, 5, 3, 1e-7, 1e-9, 0.5, 0.5),
    "AUTO, usual, 1e-10": AutoSettings(20, 4, 3, 5, 3, 1e-7, 1e-9, 0.5, 0.5),
}


def bare(intervals):
    """The task with nothing shown: steps, the branch point where the index changes, a start aside, steps again."""
    rod = rl.Rod(mesh=intervals)
    walk = Walk(rl.equilibrium(rod, 0.0), step=3.0, toward=3.0, bare=True)
    first = walk.here
    last = walk.advance().b
    locator = Locator(walk.curve)
    ends = (locator.curve.index(place.y) for place in (first, last))
    a, b = (type(first)(place.y, place.tangent, index) for place, index in zip((first, last), ends, strict=True))
    crossing = locator.between(a, b)[0]
    event = rl.Event("branch point", float(crossing.y[-1]), crossing.error, rl.Point(rod, float(crossing.y[-1]), crossing.y[:-1]),
                     1, null=crossing.null.right, fence=crossing.fence)  # fmt: skip
    walk = Walk(rl.switch(event)[0], step=3.0, toward=TO, bare=True)
    points = 0
    while walk.here.y[-1] < TO:
        step = walk.advance()
        points += 1
    guess = step.segment.at(passages(step.segment, TO)[0] * step.segment.length)
    guess[-1] = TO
    found = walk.curve.correct(guess, np.append(np.zeros(guess.size - 1), 1.0))
    return found.y[-2], points


def shown():
    """The task as a user asks for it."""
    straight = rl.follow(rl.equilibrium(rl.Rod(), 0.0), to=3.0, step=3.0)
    branch = rl.follow(rl.switch(straight.events[0])[0], to=TO)
    return branch.points[-1].tip_angle, len(branch), branch


def scipys(tol, steps=50):
    """Branch 1 at 50 loads; the last solution, scaled lest it falls to zero, is the next guess. No branch point is looked for."""
    A, B = np.diag([1.0, 0.0]), np.diag([0.0, 1.0])
    x, last = np.linspace(0, 1, 11), 1.0
    y = np.array([np.sin(np.pi / 2 * x), np.pi / 2 * np.cos(np.pi / 2 * x)])
    for lam in np.linspace(2.5, TO, steps):
        size = min(2.0, math.sqrt(8 * (lam / (math.pi**2 / 4) - 1)))
        y, last = y * (size / last), size

        def jacobian(x, y, lam=lam):
            J = np.zeros((2, 2, x.size))
            J[0, 1], J[1, 0] = 1, -lam * np.cos(y[0])
            return J

        found = solve_bvp(
            lambda x, y, lam=lam: np.array([y[1], -lam * np.sin(y[0])]), lambda a, b: np.array([a[0], b[1]]), x, y,
            fun_jac=jacobian, bc_jac=lambda a, b: (A, B), tol=tol, max_nodes=200_000,
        )  # fmt: skip
        x, y = found.x, found.y
    return abs(y[0, -1]), steps


def best(run, repeats):
    """(the last answer, least seconds)."""
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        answer = run()
        seconds.append(time.perf_counter() - start)
    return answer, min(seconds)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--profile", action="store_true")
    chosen = parser.parse_args()
    exact, repeats = rl.elastica(TO).tip_angle, 3 if chosen.quick else 15
    rows, times = [], {}

    def row(name, tip, points, seconds):
        times[name] = seconds
        rows.append(f"{name:34} {points:6d} {abs(abs(tip) - exact):10.1e} {1e3 * seconds:10.2f}")

    for name, intervals in (("rodlab, bare, 6 intervals", 6), ("rodlab, bare, 8 intervals", 8)):
        (tip, points), seconds = best(lambda n=intervals: bare(n), repeats)
        row(name, tip, points, seconds)
    (tip, points, _), seconds = best(shown, repeats)
    row("rodlab, shown", tip, points, seconds)
    if not chosen.quick:
        why = auto_missing()
        if why:
            rows.append(why)
        else:
            with closing(Auto()) as program:
                for name, setting in SETTINGS.items():
                    runs = [program.follow(TO, setting) for _ in range(repeats)]
                    assert not runs[0].note, runs[0].note
                    row(name, runs[0].tip_angle, runs[0].points, min(run.seconds for run in runs))
    for name, tol in (("solve_bvp, 1e-9", 7e-7), ("solve_bvp, 1e-10", 2e-7)):
        (tip, points), seconds = best(lambda t=tol: scipys(t), 1 if chosen.quick else 3)
        row(name, tip, points, seconds)
    print(f"{'':34} {'points':>6} {'tip error':>10} {'ms':>10}", *rows, sep="\n")
    print("\nratios (limit):")
    for ours, limit in (("rodlab, bare, 8 intervals", 1.0), ("rodlab, shown", 2.0)):
        for name, peer in times.items():
            allowed = 0.05 if name.startswith("solve_bvp") else limit
            if not name.startswith("rodlab"):
                ratio = times[ours] / peer
                print(f"  {ours:28} / {name:22} {ratio:7.2f}  ({allowed:g}){'' if ratio <= allowed else '  above its limit'}")
    if chosen.profile:
        import cProfile
        import pstats

        for name, run in (("bare", lambda: bare(8)), ("shown", shown)):
            profile = cProfile.Profile()
            profile.runcall(run)
            print(f"\nprofile, {name}")
            pstats.Stats(profile).sort_stats("tottime").print_stats(12)


if __name__ == "__main__":
    sys.exit(main())
