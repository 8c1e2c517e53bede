"""Speed of other ends and of a foundation, as ratios in one run, and how they grow with n.

    python tests/benchmarks/ends.py [--quick]

A Newton iteration (residual, second variation, solve) and an index, between clamps and on a foundation, against those of the
cantilever with as many joints: one solve more for each reaction, and one to refine. Medians of ratios of runs taken in turn.
"""

import argparse
import sys

import numpy as np
from newton_and_index import paired

import rodlab as rl

SIZES = (10**3, 10**4, 10**5, 10**6)
MODELS = {
    "clamped-hinged": {"ends": ("clamped", "hinged")},
    "clamped-clamped": {"ends": ("clamped", "clamped")},
    "hinged-hinged": {"ends": ("hinged", "hinged")},
    "foundation": {"terms": rl.foundation(100.0)},
}
MOST = {"clamped-clamped": 6.0}  # of a Newton iteration at n = 10^6


def iterations(model, lam):
    """A Newton iteration from a new state each time, and the index of a second variation."""
    u, count = model.start(lambda s: np.sin(2 * np.pi * s)), iter(range(10**9))

    def newton():
        here = u + 1e-9 * next(count)
        model.jacobian(here, lam).solve(-model.residual(here, lam))

    return newton, model.jacobian(u, lam).inertia


def main():
    """Print the table; exit code 1 when a ratio at n = 10^6 is above its limit."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer repeats, n up to 10^4")
    quick = parser.parse_args().quick
    sizes, failed = SIZES[:2] if quick else SIZES, False
    print("ratios to the cantilever of n joints (limit at n = 10^6: Newton between clamps 6)")
    print(f"{'model':16} {'n':>8} {'Newton':>8} {'index':>8} {'ms':>9}")
    for name, more in MODELS.items():
        times = []
        for n in sizes:
            repeats = 3 if n > 10**5 else 15
            own, plain = (iterations(rl.Strut(n=n, rule="trapezoid", **given), 30.0) for given in (more, {}))
            newton, once = paired(own[0], plain[0], repeats)
            index, _ = paired(own[1], plain[1], repeats)
            times.append(once)
            failed |= n == SIZES[-1] and newton > MOST.get(name, np.inf)
            print(f"{name:16} {n:8} {newton:8.2f} {index:8.2f} {1e3 * once:9.3f}")
        if not quick:
            print(f"{'':16} grows like n^{np.polyfit(np.log(sizes[1:]), np.log(times[1:]), 1)[0]:.2f}")
    sys.exit(int(failed))


if __name__ == "__main__":
    main()
