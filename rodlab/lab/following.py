"""One branch of one strut, as `rodlab follow` asks for it."""

from collections.abc import Callable, Mapping
from typing import Any

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.follow import Branch, follow
from rodlab.analysis.point import Point
from rodlab.lab.branches import mode_starts
from rodlab.mechanics.buckling import buckling_loads, mode_numbers
from rodlab.mechanics.expression import Expression
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import number


def followed(
    arguments: Mapping[str, Any], start: float, to: float, *, mode: int | None, guess: str | None, step: float | None,
    max_points: int, watch: Callable[[Point], Any] | None = None,
) -> tuple[Strut, Branch]:  # fmt: skip
    """The strut, and the branch from its equilibrium at `start`, or from where a mode leaves the straight one."""
    strut, to = Strut(**arguments), number("to", to)
    options: dict[str, Any] = {"step": step, "max_points": max_points, "watch": watch}
    if mode is None:
        p = equilibrium(strut, number("from", start), None if guess is None else Expression(guess))
        return strut, follow(p, to, **options)
    if guess is not None:
        raise ValueError(f"guess must not be given with mode, which starts from its branch point; it is {guess!r}")
    if start != 0:
        raise ValueError(f"from must not be given with mode, which starts from its branch point; it is {start:g}")
    mode_numbers(strut, [mode])
    load = float(buckling_loads(strut, [mode])[0])
    if not to > load:
        raise ValueError(f"to must be above the load of mode {mode}, {load:.9g}, where its branch begins; it is {to:g}")
    return strut, follow(mode_starts(strut, mode)[0], to, **options)
