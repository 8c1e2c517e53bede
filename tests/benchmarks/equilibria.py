"""All equilibria and diagrams: how cost grows, and against what cannot be had for less.

a box          against the ball arithmetic that it needs: twice n sin_cos of arb at the same precision, nothing else
a diagram      against following its branches one by one from known starts
"""

import argparse
import time

import numpy as np

import rodlab as rl
from rodlab.mechanics.enumerate import cover
from rodlab.mechanics.recurrence import precision
from rodlab.numerics.balls import balls


def seconds(run, repeats=1):
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        result = run()
        times.append(time.perf_counter() - start)
    return min(times), result


def slope(x, y):
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def least(strut, lam):
    """Seconds of 2 n sin_cos of a ball, at the precision of the proof."""
    with balls(precision(strut, lam)) as numbers:
        x = numbers.number(1.0, 1e-3)
        return seconds(lambda: [numbers.sin_cos(x) for _ in range(2 * strut.n)], 5)[0]


def covers(cases):
    print(f"{'n':>6} {'load':>7} {'equilibria':>11} {'boxes':>8} {'seconds':>9} {'per box, over 2 n sin_cos':>26}")
    rows = []
    for n, lam in cases:
        strut = rl.Strut(n=n)
        took, found = seconds(lambda strut=strut, lam=lam: cover(strut, lam, most=10**6))
        assert found.complete
        rows.append((n, lam, len(found.roots), found.boxes, took))
        print(
            f"{n:6d} {lam:7g} {len(found.roots):11d} {found.boxes:8d} {took:9.3f} {took / found.boxes / least(strut, lam):26.1f}"
        )
    return np.array(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    sizes = [25, 50, 100] if quick else [50, 100, 200, 400, 800, 1600]
    rows = covers([(n, 130.0) for n in sizes])
    print(
        f"long struts: boxes grow like n^{slope(rows[:, 0], rows[:, 3]):.2f}, seconds like n^{slope(rows[:, 0], rows[:, 4]):.2f}\n"
    )
    loads = [100.0, 130.0] if quick else [100.0, 150.0, 200.0, 256.0, 300.0]
    rows = covers([(8, lam) for lam in loads])
    print(f"eight joints: seconds grow like equilibria^{slope(rows[:, 2], rows[:, 4]):.2f}\n")
    if not quick:
        rows = covers([(100, lam) for lam in (130.0, 250.0, 500.0)])
        print(f"loads: boxes grow like load^{slope(rows[:, 1], rows[:, 3]):.2f}\n")
    strut, top = rl.Strut(n=100), 30.0 if quick else 130.0
    whole, d = seconds(lambda: rl.diagram(strut, (0.0, top)))
    trivial, main_branch = seconds(lambda: rl.follow(rl.equilibrium(strut, 0.0), to=top))
    starts = [rl.switch(e)[0] for e in main_branch.events if e.kind == "branch point"]
    alone = trivial + sum(seconds(lambda p=p: rl.follow(p, to=top))[0] for p in starts)
    print(f"{d!r}: {whole:.2f} s, {whole / alone:.2f} times following its branches from known starts")


if __name__ == "__main__":
    main()
