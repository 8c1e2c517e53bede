"""What an answer costs: seconds of set-up and solve apart, the least and the median of repeats, and peak memory.

Each repeat sets up anew, so that nothing of the last is left to help it; a set-up that is slow itself (a compiler's) is kept.
Memory is what Python and numpy ask for, told by tracemalloc in a run of its own, which is not timed.
"""

import statistics
import time
import tracemalloc
from collections.abc import Callable
from functools import partial
from typing import Any

SLOW = 0.5  # seconds of a solve above which it is not repeated
TRACED = 4.0  # and above which its memory is not traced
KEPT = 0.1  # seconds of a set-up above which it is made once
ENOUGH = 0.4  # seconds of all repeats together


def spent(
    setup: Callable[[], Any], solve: Callable[[Any], Any], repeats: int = 1, *, memory: bool = False
) -> tuple[Any, dict[str, Any]]:
    """The last answer, and {"setup", "solve", "median", "repeats", "peak_bytes"}: seconds, bytes or None.

    >>> found, cost = spent(lambda: 3, lambda n: n * n, repeats=3)
    >>> found, cost["repeats"], cost["solve"] <= cost["median"], cost["peak_bytes"]
    (9, 3, True, None)
    """
    made: list[float] = []
    solved: list[float] = []
    while len(solved) < repeats and sum(solved) < ENOUGH and (not solved or solved[-1] < SLOW):
        if not made or made[-1] < KEPT:
            ready, seconds = timed(setup)
            made.append(seconds)
        found, seconds = timed(partial(solve, ready))
        solved.append(seconds)
    cost = {"setup": min(made), "solve": min(solved), "median": statistics.median(solved), "repeats": len(solved)}
    return found, {**cost, "peak_bytes": _peak(setup, solve) if memory and solved[-1] < TRACED else None}


def timed(run: Callable[[], Any]) -> tuple[Any, float]:
    """What a call returns, and its seconds."""
    start = time.perf_counter()
    found = run()
    return found, time.perf_counter() - start


def _peak(setup: Callable[[], Any], solve: Callable[[Any], Any]) -> int | None:
    if tracemalloc.is_tracing():
        return None
    tracemalloc.start()
    try:
        solve(setup())
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
