"""An answer in this process, as a notebook has it: the same questions and the same plain values, but no limits and no walls."""

import traceback
from collections.abc import Mapping, Sequence
from typing import Any

from rodlab.grading.plain import decode, encode
from rodlab.grading.process import clean
from rodlab.grading.sandbox import Stopped


class Directly:
    """Functions by name that can be asked for values; what they return is made plain before it is judged.

    >>> Directly({"square": lambda x: x * x}).ask("square", [(3,)])
    [9]
    """

    protections = "none: the answer ran in this process"

    def __init__(self, functions: Mapping[str, Any]) -> None:
        self.functions = functions

    def ask(self, name: str, calls: Sequence[tuple[Any, ...]], seconds: float | None = None) -> list[Any]:  # noqa: ARG002 no clock here
        """The values of the function `name`; raises `Stopped`."""
        function = self.functions.get(name)
        if not callable(function):
            raise Stopped(f"is not answered yet: there is no function {name}", unanswered=True)
        values = []
        for given in calls:
            try:
                values.append(decode(encode(function(*[decode(encode(x)) for x in given]))))
            except NotImplementedError as error:
                raise Stopped(f"is not answered yet: {_said(error)}".rstrip(": "), unanswered=True) from None
            except (Exception, SystemExit) as error:  # noqa: BLE001 whatever an answer raises
                where = traceback.extract_tb(error.__traceback__)
                line = f" (line {where[-1].lineno}: {where[-1].line})" if len(where) > 1 else ""
                raise Stopped(f"raises {type(error).__name__}: {_said(error)}{line}") from None
        return values


def _said(error: BaseException) -> str:
    """What an exception says, in one line; its __str__ is the answer's too."""
    try:
        return clean(str(error))
    except Exception:  # noqa: BLE001
        return ""
