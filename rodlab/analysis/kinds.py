"""The kind of a branch point, by its name in the field [Crandall and Rabinowitz 1971; Golubitsky and Schaeffer 1985].

    c_1 != 0                   transcritical
    c_1 = 0, c_2 != 0          pitchfork: supercritical where the other branch lies on the side on which the followed one has lost
                               stability (the higher index), subcritical on the other; without an index by the sign of c_2
    neither is certain         branch point

c_1, c_2: Koiter's coefficients of the load along the other branch.
"""

from rodlab.analysis.events import Event
from rodlab.analysis.expansion import Expansion, expansion
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point

SURE = 10.0  # a coefficient counts beyond so many times its error


def kind_of(event: Event, starts: list[Point], index: tuple[int | None, int | None]) -> str:
    """The kind of a branch point from what leaves it and the index before and after along the followed branch."""
    if event.multiplicity != 1 or len(starts) != 2:
        return "branch point"
    way = _turns(event)
    if way:  # met on the side branch of a pitchfork; the other one passes
        low, high = sorted(starts, key=lambda p: p.lam)
        return f"{_direction(way, (low.index, high.index))} pitchfork" if low.lam < event.lam < high.lam else "branch point"
    try:
        series = expansion(event, 2, starts=starts)
    except (NoConvergence, ValueError):  # the other branch has no part along the null vector: it passes as well
        passes = (starts[0].lam - event.lam) * (starts[1].lam - event.lam) < 0
        return "transcritical" if passes else "branch point"
    if _certain(series, 1):
        return "transcritical"
    if not _certain(series, 2):
        return "branch point"
    forward = event.point.tangent is None or event.point.tangent[-1] >= 0
    return f"{_direction(series.load[2], index if forward else index[::-1])} pitchfork"


def _turns(event: Event) -> float:
    """Where the load turns on the followed branch: 1 if it is least there, -1 if greatest; else 0."""
    fence = event.fence
    if fence is None or fence.ta[-1] * fence.tb[-1] >= 0:
        return 0.0
    return 1.0 if fence.tb[-1] > 0 else -1.0


def _certain(series: Expansion, k: int) -> bool:
    return bool(abs(series.load[k]) > SURE * series.error[k])


def _direction(way: float, index: tuple[int | None, int | None]) -> str:
    """Of a pitchfork that opens to higher loads (way > 0) or lower ones, from the index of what passes below and above it."""
    low, high = index
    gaining = 1 if low is None or high is None else high - low
    return "supercritical" if way * gaining > 0 else "subcritical"
