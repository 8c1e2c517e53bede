"""A cell: one question of a study as plain data, answered in any process as plain data.

    Cell("measured:one", {...})  ->  {"value": ..., "error": ..., "cost": {"solve": ...}}

What changes from run to run, times and memory, stands under "cost"; all else is the same to the last bit wherever a cell
runs: libraries of linear algebra are held to one thread, and answers pass through JSON text.
"""

import json
import threading
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from typing import Any, NamedTuple

from rodlab.analysis.newton import NoConvergence

ONE = threading.Lock()  # cell at a time in a process: digits of mpmath, threads and traced memory are the process's own
ROOM = "rodlab.lab.studies"
VOLATILE = "cost"


class Cell(NamedTuple):
    """A function of this room, "module:name", and its arguments."""

    function: str
    given: Mapping[str, Any]

    @property
    def key(self) -> str:
        """The cell as text: equal for equal questions."""
        return json.dumps([self.function, self.given], sort_keys=True)


def answer(cell: Cell) -> dict[str, Any]:
    """The cell's answer; what cannot be answered says so under "failed", in one sentence, and "crashed" if nobody meant it.

    >>> found = answer(Cell("measured:one", {"question": {"quantity": "load"}, "method": "strut, end", "size": 2}))
    >>> round(found["value"], 12), found["source"]
    (1.527864045, 'closed form')
    """
    with ONE, _libraries().limit(limits=1):
        try:
            found = _function(cell.function)(**cell.given)
        except MemoryError:
            found = {"failed": "it does not fit into memory", "crashed": True}
        except Exception as error:  # noqa: BLE001  one cell must not take the others with it
            crash = {"failed": f"{type(error).__name__}: {error}", "crashed": True}
            found = {"failed": str(error)} if is_sentence(error) else crash
    plain: dict[str, Any] = json.loads(json.dumps(found))
    return plain


def is_sentence(error: Exception) -> bool:
    """True for what the house raises to say why there is no answer; anything else is a crash, of numpy's kinds of these too."""
    return type(error) in (ValueError, ArithmeticError, NoConvergence) and "broadcast" not in str(error)


def settled(found: Mapping[str, Any]) -> dict[str, Any]:
    """An answer without what changes from run to run."""
    return {name: value for name, value in found.items() if name != VOLATILE}


@cache
def _libraries() -> Any:
    """The libraries of linear algebra that numpy and scipy have loaded: looking for them takes a millisecond."""
    import numpy as np  # noqa: F401  what is limited must have been loaded
    import scipy.linalg  # noqa: F401
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


def _function(name: str) -> Callable[..., dict[str, Any]]:
    module, _, function = name.partition(":")
    found: Callable[..., dict[str, Any]] = getattr(import_module(f"{ROOM}.{module}"), function)
    return found
