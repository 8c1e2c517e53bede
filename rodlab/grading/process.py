"""The process that answers, seen from outside: its pipes, the questions on the one and what it says on the other, and its end.

What it says is never trusted: a line has a largest length, must be an object of JSON with the question's number, and becomes a
plain value or a sentence.
"""

import contextlib
import itertools
import json
import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from typing import IO, Any

from rodlab.grading.plain import decode, encode
from rodlab.grading.walls import MIB, bubblewrap, program, walls

STARTUP = 60.0  # seconds until Python has imported what an exercise imports, which are no answer's
ADDRESS = re.compile(r"0x[0-9a-fA-F]{6,}")
NO_ANSWER = "broke off: what it wrote is no answer"


class Gone(Exception):
    """It has to be ended, and why in one sentence; `forged` if it wrote what the child does not write."""

    def __init__(self, sentence: str, *, forged: bool = False) -> None:
        super().__init__(sentence)
        self.sentence, self.forged = sentence, forged


class Raised(Exception):
    """It answered with an exception; it can be asked again."""

    def __init__(self, sentence: str, unanswered: bool) -> None:
        super().__init__(sentence)
        self.sentence, self.unanswered = sentence, unanswered


class Process:
    """The process and the two threads that carry lines to and from it."""

    def __init__(self, setup: dict[str, Any], most: int) -> None:
        self.folder = os.path.realpath(tempfile.mkdtemp(prefix="rodlab-answer-"))
        self.lines: queue.Queue[bytes | None] = queue.Queue(maxsize=4)
        self.numbers, self.most = itertools.count(1), most
        self.walled = bubblewrap() is not None
        self.own = own = "/answer" if self.walled else self.folder  # the first is bubblewrap's, in memory
        environment = {
            "PATH": os.defpath, "HOME": own, "TMPDIR": own, "MPLCONFIGDIR": own, "MPLBACKEND": "Agg", "LANG": "C.UTF-8",
            "PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1",
            **{name: os.environ[name] for name in ("SYSTEMROOT",) if name in os.environ},
        }  # fmt: skip
        self.process = subprocess.Popen(  # noqa: S603 the command is ours, the submission goes through the pipe
            [*walls(tuple(setup["hidden"])), os.path.abspath(sys.executable), "-s", "-P", "-B", "-c", program()],  # noqa: PTH100 not resolved
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, cwd=self.folder, env=environment,
            start_new_session=True,
        )  # fmt: skip
        self.outgoing: queue.Queue[bytes | None] = queue.Queue()
        self.outgoing.put(json.dumps({**setup, "own": own}).encode() + b"\n")
        self.reader, self.writer = (threading.Thread(target=carry, daemon=True) for carry in (self._read, self._write))
        self.reader.start()
        self.writer.start()

    def _write(self) -> None:
        pipe: IO[bytes] = self.process.stdin  # type: ignore[assignment] # it is a pipe
        with contextlib.suppress(OSError, ValueError):
            while (line := self.outgoing.get()) is not None:
                pipe.write(line)
                pipe.flush()

    def _read(self) -> None:
        pipe: IO[bytes] = self.process.stdout  # type: ignore[assignment] # it is a pipe
        with contextlib.suppress(OSError, ValueError):
            while line := pipe.readline(self.most + 1):
                self.lines.put(line)
        self.lines.put(None)

    def ask(self, name: str, calls: Sequence[tuple[Any, ...]], seconds: float) -> list[Any]:
        """The values for each tuple of arguments."""
        number = next(self.numbers)
        request = {"id": number, "name": name, "calls": [[encode(x) for x in given] for given in calls]}
        self.outgoing.put(json.dumps(request).encode() + b"\n")
        until, values = time.monotonic() + seconds, []
        for i, given in enumerate(calls):
            reply = self.read(until - time.monotonic(), seconds)
            if reply.get("id") != [number, i]:
                raise Gone(NO_ANSWER, forged=True)
            if "error" in reply:
                raise Raised(raised(reply, given), reply["error"] == "NotImplementedError")
            values.append(_value(reply.get("value")))
        return values

    def read(self, seconds: float, allowed: float | None = None) -> dict[str, Any]:
        """The next line as an object; raises `Gone` with what happened instead."""
        try:
            line = self.lines.get(timeout=max(seconds, 0.0))
        except queue.Empty:
            raise Gone(f"did not come back within {allowed or seconds:.3g} seconds: is there a loop that never ends?") from None
        if line is None:
            raise Gone(self._ended())
        if len(line) > self.most:
            raise Gone(f"returned more than {self.most / MIB:.3g} MiB")
        try:
            found = json.loads(line)
        except (ValueError, RecursionError, MemoryError):
            found = None
        if not isinstance(found, dict):
            raise Gone(NO_ANSWER, forged=True)
        if isinstance(found.get("message"), str):  # the same in every run
            found["message"] = found["message"].replace(self.own, ".")
        return found

    def _ended(self) -> str:
        try:
            code = self.process.wait(timeout=2.0)
        except subprocess.TimeoutExpired:
            return "closed its connection"
        code = 128 - code if self.walled and code > 128 else code  # bubblewrap gives a signal as 128 + its number
        if code >= 0:
            return f"ended its own process (exit code {code})"
        name = signal.Signals(-code).name if -code in list(signal.Signals) else str(-code)
        said = {"SIGXCPU": ": it used more CPU time than allowed", "SIGKILL": ": it was killed, for time or memory"}
        return f"was ended by {name}{said.get(name, ': it crashed')}"

    def close(self) -> None:
        """End the process and all that it started."""
        with contextlib.suppress(OSError):
            if hasattr(os, "killpg"):
                os.killpg(self.process.pid, signal.SIGKILL)
        with contextlib.suppress(OSError):
            self.process.kill()
        self.process.wait()
        self.outgoing.put(None)
        until = time.monotonic() + 1.0
        while self.reader.is_alive() and time.monotonic() < until:  # it may wait for room
            with contextlib.suppress(queue.Empty):
                self.lines.get(timeout=0.02)
        self.writer.join(1.0)
        for thread, pipe in ((self.reader, self.process.stdout), (self.writer, self.process.stdin)):
            if pipe is not None and not thread.is_alive():  # else what it started holds it open; the thread is a daemon's
                with contextlib.suppress(OSError):
                    pipe.close()
        shutil.rmtree(self.folder, ignore_errors=True)


def _value(x: Any) -> Any:
    try:
        return decode(x, code=False)
    except (ValueError, TypeError, OverflowError, RecursionError, MemoryError):
        raise Gone("broke off: what it wrote is no value", forged=True) from None


def raised(reply: dict[str, Any], given: tuple[Any, ...] = ()) -> str:
    """What an answer raised, in one sentence of plain text."""
    error, message, line, text = (clean(reply.get(name)) for name in ("error", "message", "line", "text"))
    if error == "NotImplementedError":
        return f"is not answered yet: {message}" if message else "is not answered yet"
    where = f" (line {line}: {text})" if line else ""
    asked = (
        f" for the arguments {clean(', '.join(map(repr, given)), 160)}"
        if given and error != "PermissionError" and not line
        else ""
    )
    return f"raises {error}{': ' if message else ''}{message}{where}{asked}"


def clean(text: Any, most: int = 300) -> str:
    """One line of printable characters, without addresses; of what is neither a text nor a number, nothing."""
    said = " ".join(ADDRESS.sub("0x...", str(text)[: 8 * most]).split()) if isinstance(text, str | int) else ""
    return "".join(c if c.isprintable() else "?" for c in said)[:most]
