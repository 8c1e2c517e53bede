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
    try:
        series = expansion(event, 2, starts=starts)
    except (NoConvergence, ValueError):
        return "branch point"
    if _certain(series, 1):
        return "transcritical"
    return f"{_direction(event, series, index)} pitchfork" if _certain(series, 2) else "branch point"


def _certain(series: Expansion, k: int) -> bool:
    return bool(abs(series.load[k]) > SURE * series.error[k])


def _direction(event: Event, series: Expansion, index: tuple[int | None, int | None]) -> str:
    """Supercritical or subcritical."""
    forward = event.point.tangent is None or event.point.tangent[-1] >= 0
    low, high = index if forward else index[::-1]  # at lower and higher loads
    gaining = 1 if low is None or high is None else high - low
    return "supercritical" if series.load[2] * gaining > 0 else "subcritical"
