"""The kinds of ends a strut or rod may have, and what they ask for: see `rodlab.mechanics.held`, which holds them."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from rodlab.mechanics.terms import END_FORCE, Term, end_torque

KINDS = ("clamped", "hinged", "guided", "free")
CANTILEVER = ("clamped", "free")
TURNS, SLIDES = ("hinged", "free"), ("guided", "free")  # whose angle, and whose place, is not held


def checked_ends(ends: Any) -> tuple[str, str]:
    """Two kinds of ends, the foot's first; `ValueError` for others."""
    if not isinstance(ends, (tuple, list)) or len(ends) != 2 or any(end not in KINDS for end in ends):
        raise ValueError(f"ends must be two of {', '.join(map(repr, KINDS))}, the foot first; they are {ends!r:.60}")
    return str(ends[0]), str(ends[1])


def refuse_held(name: str, model: Any) -> None:
    """`ValueError`, in one sentence, for a strut or rod between other ends than clamped and free."""
    if hasattr(model, "unknowns"):
        raise ValueError(f"{name} must be clamped at the foot and free at the top for this; its ends are {model.ends}")


def needs_reactions(ends: Any, given: Mapping[str, Any]) -> bool:
    """True for other ends than clamped and free, or anything that is held at the top."""
    usual = ends is None or (isinstance(ends, (tuple, list)) and tuple(ends) == CANTILEVER)
    return not usual or any(not np.array_equal(given.get(name, 0.0), 0.0) for name in ("phi1", "offset"))


def reactions_of(ends: tuple[str, str], terms: Any) -> tuple[Term, ...]:
    """The terms by which the reactions of the top act, none of which may be given."""
    top = ends[1]
    wanted = [END_FORCE] * (top not in SLIDES) + [end_torque(0.0)] * (top not in TURNS)
    for reaction in wanted:
        if any(term.name == reaction.name for term in terms):
            raise ValueError(
                f"{next(iter(reaction.parameters))} must not be given where the top is {top}: there it is a reaction"
            )
    return tuple(wanted)


def held_arguments(ends: tuple[str, str], phi1: float, offset: float) -> dict[str, Any]:
    """What a model was made with besides: the kinds of its ends, and what they hold."""
    return {"ends": ends} | {name: value for name, value in (("phi1", phi1), ("offset", offset)) if value}
