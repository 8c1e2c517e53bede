"""One branch of one strut or rod, as `rodlab follow` asks for it."""

from collections.abc import Callable, Mapping
from typing import Any

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.follow import Branch, follow
from rodlab.analysis.point import Point
from rodlab.lab.branches import mode_starts
from rodlab.mechanics.buckling import buckling_loads, mode_numbers
from rodlab.mechanics.expression import Expression
from rodlab.mechanics.recipe import build
from rodlab.numerics.arrays import number


def followed(
    arguments: Mapping[str, Any], start: float, to: float, *, mode: int | None, guess: str | None, step: float | None,
    max_points: int, watch: Callable[[Point], Any] | None = None,
) -> tuple[Any, Branch]:  # fmt: skip
    """The model of a recipe, and the branch from its equilibrium at `start`, or from where a mode leaves the straight one."""
    model: Any = build(arguments)
    to = number("to", to)
    options: dict[str, Any] = {"step": step, "max_points": max_points, "watch": watch}
    if mode is None:
        p = equilibrium(model, number("from", start), None if guess is None else Expression(guess))
        return model, follow(p, to, **options)
    if guess is not None:
        raise ValueError(f"guess must not be given with mode, which starts from its branch point; it is {guess!r}")
    if start != 0:
        raise ValueError(f"from must not be given with mode, which starts from its branch point; it is {start:g}")
    mode_numbers(model, [mode])
    load = float(buckling_loads(model, [mode])[0])
    if not to > load:
        raise ValueError(f"to must be above the load of mode {mode}, {load:.9g}, where its branch begins; it is {to:g}")
    return model, follow(mode_starts(model, mode)[0], to, **options)
