"""The branches that the tour shows: the straight strut, what buckles from it, and an imperfect strut beside them."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.events import branch_point
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


def trivial(strut: Model, modes: int) -> Branch:
    """The straight branch from no load to beyond the branch point of the last mode asked for."""
    most = strut.n if isinstance(strut, Strut) else modes + 1
    last = buckling_loads(strut, [modes, min(modes + 1, most)])
    return follow(equilibrium(strut, 0.0), to=float(last.mean()) if len(last) > 1 else 1.1 * float(last[0]), events=branch_point)


def mode_starts(strut: Model, mode: int) -> list[Point]:
    """The two starts where a mode leaves the straight branch, phi'(0) > 0 first."""
    load = float(buckling_loads(strut, [mode])[0])
    branch = trivial(strut, mode)
    own = [e for e in branch.events if e.kind == "branch point" and abs(e.lam - load) <= e.error + 1e-9 * load]
    if not own:
        raise NoConvergence(f"the branch point of mode {mode} at {load:.9g} was not met: {branch.reason}", ())
    return switch(own[0])


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
