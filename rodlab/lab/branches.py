"""The branches that the tour shows: the straight strut, what buckles from it, and an imperfect strut beside them."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.events import Event, branch_point
from rodlab.analysis.follow import Branch, follow
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.switching import switch
from rodlab.mechanics.buckling import buckling_loads
from rodlab.mechanics.rod import Rod
from rodlab.mechanics.strut import Strut


@dataclass(frozen=True)
class Found:
    """An equilibrium, the branch it is on ("straight", "mode 1", ...) and the run time of finding it."""

    branch: str
    point: Point
    seconds: float


@dataclass(frozen=True)
class Shown:
    """A branch with its name and the run time of following it."""

    name: str
    branch: Branch
    seconds: float


def timed(name: str, run: Callable[[], Branch]) -> Shown:
    """The branch that `run` follows, with the time it took."""
    start = time.perf_counter()
    branch = run()
    return Shown(name, branch, time.perf_counter() - start)


Model = Strut | Rod
STILL = 1e-9  # a load that is none, times the flexibility


def trivial(strut: Model, modes: int) -> Branch:
    """The straight branch from no load to beyond the branch point of the last mode asked for."""
    most = strut.n if isinstance(strut, Strut) else modes + 1
    last = buckling_loads(strut, [modes, min(modes + 1, most)])
    return follow(equilibrium(strut, 0.0), to=float(last.mean()) if len(last) > 1 else 1.1 * float(last[0]), events=branch_point)


def mode_point(model: Model, mode: int) -> Event:
    """The branch point of a mode on the straight branch, which is followed past it alone, whatever the sign of its load."""
    below, load = _loads_to(model, mode)
    if abs(load) * getattr(model, "base", model).flexibility < STILL:
        raise ValueError(f"mode must be one that has a load; mode {mode} is at no load, where the ends let all of it turn")
    gap = max(load - below, 0.01 * abs(load))
    branch = follow(equilibrium(model, load - gap / 2), to=load + gap / 100, events=branch_point)
    own = [e for e in branch.events if e.kind == "branch point" and abs(e.lam - load) <= e.error + 1e-9 * abs(load)]
    if not own:
        raise NoConvergence(f"the branch point of mode {mode} at {load:.9g} was not met: {branch.reason}", ())
    return own[0]


def _loads_to(model: Model, mode: int) -> tuple[float, float]:
    """The load of the mode before, and that of a mode; before the first one as far below it as it is from no load."""
    if mode > 1:
        below, load = buckling_loads(model, [mode - 1, mode])
        return float(below), float(load)
    load = float(buckling_loads(model, [mode])[0])
    return load - abs(load), load


def mode_starts(model: Model, mode: int) -> list[Point]:
    """The two starts where a mode leaves the straight branch, phi'(0) > 0 first."""
    return switch(mode_point(model, mode))


def mode_branch(strut: Model, mode: int, to: float) -> Branch:
    """The half-branch of a mode with phi'(0) > 0, followed to a load."""
    return follow(mode_starts(strut, mode)[0], to=to)


def detached(strut: Model, near: float) -> Point:
    """A stable state on the branch that an imperfection cuts off: bent against the imperfection at the load `near`."""
    own = follow(equilibrium(strut, 0.0), to=near).points[-1]
    return equilibrium(own.equations, near, -own.u)


def straight(strut: Model, load: float) -> Found:
    """The straight equilibrium."""
    start = time.perf_counter()
    point = equilibrium(strut, load)
    return Found("straight", point, time.perf_counter() - start)


def on(branch: Branch, name: str, loads: Sequence[float]) -> Iterator[Found]:
    """The points of a branch at loads it passes once."""
    for load in loads:
        start = time.perf_counter()
        point = branch.at(load)[0]
        yield Found(name, point, time.perf_counter() - start)
