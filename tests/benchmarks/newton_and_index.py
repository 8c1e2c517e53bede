"""Speed as ratios in one run: a Newton iteration and an index against sin + cos + one dgtsv of the same size.

    python tests/benchmarks/newton_and_index.py [--quick]

The limit is what any implementation pays: sin and cos of n angles and one tridiagonal solve by LAPACK. Each figure is the
median of the ratios of paired runs, taken in turn so that the machine's drift cancels. Costs are fitted against n.
"""

import argparse
import sys
import time

import numpy as np
from scipy.linalg import lapack

import rodlab as rl

SIZES = (10**3, 10**4, 10**5, 10**6)
STATES = {  # name: load, guess
    "straight, index 1": (5.0, None),
    "mode 1, index 0": (5.0, lambda s: 2 * np.sin(np.pi * s / 2)),
    "mode 2, index 1": (30.0, lambda s: 1.5 * np.sin(3 * np.pi * s / 2)),
    "straight, index 32": (1e4, None),
}


def seconds(run):
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def paired(run, limit, repeats):
    """Median of run / limit, and the median time of a run."""
    pairs = [(seconds(run), seconds(limit)) for _ in range(repeats)]
    return float(np.median([a / b for a, b in pairs])), float(np.median([a for a, _ in pairs]))


def measure(n, name, repeats):
    """(Newton ratio, index of a Hessian ratio, index of a point ratio, seconds of a Newton iteration)."""
    lam, guess = STATES[name]
    strut = rl.Strut(n=n)
    phi = strut.start(guess) if guess else np.zeros(n)
    p = rl.equilibrium(strut, lam, phi)
    H = strut.hessian(phi, lam)
    d, e, b = H.diagonal, H.off_diagonal, np.ones(n)

    bent = strut.start(lambda s: 2 * np.sin(np.pi * s / 2))  # sin and cos of zeros would be cheaper

    def limit():
        np.sin(bent)
        np.cos(bent)
        lapack.dgtsv(e, d, e, b)

    def newton():
        rl.equilibrium(strut, lam, 0.7 * p.u if guess else phi + 1e-3)

    iterations = len(rl.equilibrium(strut, lam, 0.7 * p.u if guess else phi + 1e-3).newton)
    ratio, time_of_run = paired(newton, limit, repeats)
    of_hessian, _ = paired(H.inertia, limit, repeats)
    of_point, _ = paired(lambda: rl.Point(strut, lam, p.u).index, limit, repeats)
    return ratio / iterations, of_hessian, of_point, time_of_run / iterations


def main():
    """Print the table; exit code 1 when a ratio at n = 10^6 is above its limit."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer repeats, n up to 10^5")
    quick = parser.parse_args().quick
    sizes, failed = SIZES[:3] if quick else SIZES, False
    print("ratios to sin + cos + dgtsv of n numbers (limits at n = 10^6: Newton 1.5, index 1.0)")
    print(f"{'state':20} {'n':>8} {'Newton':>8} {'index':>8} {'p.index':>8} {'ms':>9}")
    for name in STATES:
        times = []
        for n in sizes:
            newton, of_hessian, of_point, once = measure(n, name, 5 if quick else max(5, min(15, 10**7 // n)))
            times.append(once)
            failed |= n == SIZES[-1] and (newton > 1.5 or of_hessian > 1.0 or of_point > 1.0)
            print(f"{name:20} {n:8} {newton:8.2f} {of_hessian:8.2f} {of_point:8.2f} {1e3 * once:9.3f}")
        slope = np.polyfit(np.log(sizes[1:]), np.log(times[1:]), 1)[0]
        print(f"{name:20} cost of a Newton iteration grows as n^{slope:.2f} (from n = {sizes[1]})")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
