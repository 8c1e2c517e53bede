"""The process that answers: it takes a submission's source, then calls of its functions, and gives back plain values.

It holds no reference, no check and no grade; whatever a submission does in here, it can only answer. One line of JSON a
message. Started by `process` from the text of `plain`, `locks`, `guard` and this file, so that rodlab itself need not be there.
"""

import io
import json
import os
import sys
from typing import Any

from rodlab.grading.guard import guard, limit
from rodlab.grading.locks import lock
from rodlab.grading.plain import decode, encode, named

SHOWN = 2000  # characters of what was printed
NAME = "answer.py"


class Short(io.StringIO):
    """Keeps the first characters of what is printed; the rest is gone."""

    def write(self, text: str) -> int:
        if self.tell() < SHOWN:
            super().write(str(text)[: SHOWN - self.tell()])
        return len(text)


def serve() -> None:
    """Answer until the other side closes."""
    asked, said = os.fdopen(os.dup(0), "rb"), os.dup(1)
    quiet = os.open(os.devnull, os.O_RDWR)
    for fd in (0, 1, 2):
        os.dup2(quiet, fd)
    write, dumps, loads = os.write, json.dumps, json.loads

    def reply(message: dict[str, Any]) -> None:
        data = dumps(message).encode() + b"\n"
        while data:
            data = data[write(said, data) :]

    setup = loads(asked.readline())
    sys.stdout = sys.stderr = printed = Short()
    missing = limit(*setup["limits"])
    for name in setup["imports"]:
        __import__(name)
    for name in [name for name in sys.modules if name.split(".")[0] == "rodlab"]:
        del sys.modules[name]
    locks = lock(setup["readable"], setup["hidden"], setup["own"])
    guard(setup["readable"], setup["hidden"], setup["own"], setup["files"])
    reply({"started": True, "missing": missing, "locks": locks})  # what comes after it is an answer's, and may be anything
    source = setup["source"]
    names: dict[str, Any] = {"__name__": "answer", "__file__": NAME}
    try:
        exec(compile(source, NAME, "exec"), names)  # noqa: S102 what this process is for
        reply({"ready": True})
    except BaseException as error:  # noqa: BLE001 also SystemExit
        reply({"ready": False, **_said(error, source)})
    while line := asked.readline():
        request = loads(line)
        for number, given in enumerate(request["calls"]):
            answer: dict[str, Any] = {"id": [request["id"], number]}
            try:
                if not callable(names.get(request["name"])):
                    raise NotImplementedError(f"there is no function {request['name']}")
                answer["value"] = encode(names[request["name"]](*[decode(x) for x in given]))
            except BaseException as error:  # noqa: BLE001 also SystemExit
                answer |= _said(error, source)
            try:
                reply(answer)
            except (TypeError, ValueError, RecursionError, MemoryError):
                reply({"id": answer["id"], "value": {"other": "what cannot be written down"}})
            if "error" in answer:
                break
    printed.close()


def _said(error: BaseException, source: str) -> dict[str, Any]:
    """An exception as its name, its text and the line of the submission that it came from."""
    said: dict[str, Any] = {"error": named(error), "message": ""}
    try:
        line, trace = None, error.__traceback__
        while trace is not None:
            if trace.tb_frame.f_code.co_filename == NAME:
                line = trace.tb_lineno
            trace = trace.tb_next
        if isinstance(error, SyntaxError) and error.filename == NAME:
            line = error.lineno
        lines = source.splitlines()
        if type(line) is int and 0 < line <= len(lines):
            said |= {"line": line, "text": lines[line - 1].strip()[:120]}
        said["message"] = str.__str__(str(error))[:300]
    except BaseException:  # noqa: BLE001 its attributes and its __str__ are the submission's too
        pass
    return said
