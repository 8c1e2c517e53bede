"""Branches read back from files, with their model where the file says how to make it."""

from typing import Any

from rodlab.analysis.equations import Equations
from rodlab.analysis.follow import Branch
from rodlab.analysis.saved import load
from rodlab.mechanics.recipe import build


def read(path: Any, model: Equations | None = None) -> Branch:
    """The branch that `Branch.save` wrote to a .json or .npz file. Nothing in the file is run.

    model: its equations; None makes a strut again from what the file says. Of a model made of functions only what was
    recorded can be asked then: measures, index. The branch can be extended and switched from like a new one.
    Raises `ValueError` for a file that is not a whole branch, or whose points do not solve the model.
    """
    return load(path, model, build)
