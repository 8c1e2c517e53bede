"""An answer in a process of its own: asked for values, under limits, and stopped when it does not come back.

What is given into the process is the submission and the arguments; what comes out are plain values (`plain`). Where bubblewrap
is installed the process has no network, a read-only file system without rodlab and the exercises, and processes of its own.
"""

import contextlib
import itertools
import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import IO, Any

from rodlab.grading.plain import decode, encode

MIB = 2**20
PACKAGE = Path(__file__).resolve().parents[1]
EXERCISES = (PACKAGE / "exercises", PACKAGE.parent / "exercises", PACKAGE.parent / "tests", PACKAGE.parent / ".git")


class Stopped(Exception):
    """An answer that gave no values, with the reason in one sentence; `line` and `text` are where, if it raised."""

    def __init__(self, sentence: str, *, unanswered: bool = False, lost: bool = False) -> None:
        super().__init__(sentence)
        self.unanswered, self.lost = unanswered, lost


@dataclass(frozen=True)
class Limits:
    """What an answer may use: wall-clock seconds a question and in all, CPU seconds, bytes of memory, of a file, of a reply."""

    seconds: float = 10.0
    total: float = 60.0
    cpu: int = 60
    memory: int = 2048 * MIB
    file: int = MIB
    files: int = 50
    reply: int = 8 * MIB


class Sandbox:
    """A submission that can be asked for values; a context manager that leaves no process behind.

    >>> with Sandbox("def square(x): return x*x") as answer:
    ...     answer.ask("square", [(3,), (0.5,)])
    [9, 0.25]
    >>> with Sandbox("def square(x): return 1/0") as answer:
    ...     answer.ask("square", [(3,)])
    Traceback (most recent call last):
    rodlab.grading.sandbox.Stopped: raises ZeroDivisionError: division by zero (line 1: def square(x): return 1/0)

    Parameters
    ----------
    source : the submission's text
    limits : what it may use
    imports : modules that are there before the clock starts
    hidden : more folders that it may not read
    """

    def __init__(
        self, source: str, limits: Limits | None = None, imports: Sequence[str] = ("numpy",), hidden: Sequence[Path] = ()
    ) -> None:
        self.source, self.limits, self.imports = source, limits or Limits(), tuple(imports)
        self.hidden = [str(path) for path in (PACKAGE, *EXERCISES, *hidden) if path.exists()]
        self.until = time.monotonic() + self.limits.total
        self.dead: str | None = None  # why it cannot be asked again
        self.missing: tuple[str, ...] = ()
        self._child: _Child | None = None

    def __enter__(self) -> "Sandbox":
        return self

    def __exit__(self, *_: object) -> None:
        self._close()

    @property
    def protections(self) -> str:
        """What this machine protects itself by, in a few words."""
        walls = "bubblewrap: no network, read-only files" if bubblewrap() else "no bubblewrap: audit hook only"
        return walls + (f"; no limit of {', '.join(self.missing)}" if self.missing else "")

    def ask(self, name: str, calls: Sequence[tuple[Any, ...]], seconds: float | None = None) -> list[Any]:
        """The values of the submission's function `name` for each tuple of arguments; raises `Stopped`."""
        if self.dead is not None:
            raise Stopped(self.dead, lost=True)
        left = self.until - time.monotonic()
        allowed = min(self.limits.seconds if seconds is None else seconds, left)
        if allowed <= 0:
            raise Stopped(f"no time is left: the whole answer may take {self.limits.total:g} seconds")
        child = self._started()
        try:
            return child.ask(name, calls, allowed, self.limits.reply)
        except _Gone as gone:
            self._close()
            raise Stopped(gone.sentence) from None

    def _started(self) -> "_Child":
        if self._child is None:
            child = self._child = _Child(self._setup())
            try:
                ready = child.read(
                    min(self.limits.seconds, self.until - time.monotonic()) + 20.0 * (not child.warm), self.limits.reply
                )
            except _Gone as gone:
                self._close()
                self.dead = f"cannot be loaded: it {gone.sentence}"
                raise Stopped(self.dead, lost=True) from None
            if not ready.get("ready"):
                self._close()
                self.dead = f"cannot be loaded: it {_raised(ready)}"
                raise Stopped(self.dead, lost=True)
            self.missing = tuple(str(name) for name in ready.get("missing", ()))
        return self._child

    def _setup(self) -> dict[str, Any]:
        own = self.limits
        return {
            "source": self.source, "imports": self.imports, "limits": [own.cpu, own.memory, own.file], "files": own.files,
            "readable": list(readable()), "hidden": self.hidden,
        }  # fmt: skip

    def _close(self) -> None:
        if self._child is not None:
            self._child.close()
            self._child = None


class _Gone(Exception):
    def __init__(self, sentence: str) -> None:
        super().__init__(sentence)
        self.sentence = sentence


class _Child:
    """The process and the two threads that carry lines to and from it."""

    warm = False

    def __init__(self, setup: dict[str, Any]) -> None:
        self.folder = tempfile.mkdtemp(prefix="rodlab-answer-")
        self.lines: queue.Queue[bytes | None] = queue.Queue(maxsize=64)
        self.numbers = itertools.count(1)
        own = "/answer" if bubblewrap() else self.folder  # the first is bubblewrap's, in memory
        environment = {
            "PATH": os.defpath, "HOME": own, "TMPDIR": own, "MPLCONFIGDIR": own, "MPLBACKEND": "Agg", "LANG": "C.UTF-8",
            "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1",
            **{name: os.environ[name] for name in ("SYSTEMROOT",) if name in os.environ},
        }  # fmt: skip
        self.process = subprocess.Popen(  # noqa: S603 the command is ours, the submission goes through the pipe
            [*walls(tuple(setup["hidden"])), sys.executable, "-I", "-B", "-c", program()],
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
            while line := pipe.readline(64 * MIB):
                self.lines.put(line)
        self.lines.put(None)

    def ask(self, name: str, calls: Sequence[tuple[Any, ...]], seconds: float, most: int) -> list[Any]:
        number = next(self.numbers)
        request = {"id": number, "name": name, "calls": [[encode(x) for x in given] for given in calls]}
        self.outgoing.put(json.dumps(request).encode() + b"\n")
        until, values = time.monotonic() + seconds, []
        for i, given in enumerate(calls):
            reply = self.read(until - time.monotonic(), most, seconds)
            if reply.get("id") != [number, i]:
                raise _Gone("broke off: what it wrote is no answer")
            if "error" in reply:
                raise Stopped(_raised(reply, given), unanswered=reply["error"] == "NotImplementedError")
            values.append(_value(reply.get("value")))
        return values

    def read(self, seconds: float, most: int, allowed: float | None = None) -> dict[str, Any]:
        """The next line as an object; raises `_Gone` with what happened instead."""
        try:
            line = self.lines.get(timeout=max(seconds, 0.0))
        except queue.Empty:
            raise _Gone(f"did not come back within {allowed or seconds:.3g} seconds: is there a loop that never ends?") from None
        if line is None:
            raise _Gone(self._ended())
        if len(line) > most:
            raise _Gone(f"returned more than {most // MIB} MiB")
        try:
            found = json.loads(line)
        except (ValueError, RecursionError):
            found = None
        if not isinstance(found, dict):
            raise _Gone("broke off: what it wrote is no answer")
        return found

    def _ended(self) -> str:
        try:
            code = self.process.wait(timeout=2.0)
        except subprocess.TimeoutExpired:
            return "closed its connection"
        code = 128 - code if code > 128 else code  # bubblewrap gives a signal as 128 + its number
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
            else:
                self.process.kill()
        self.process.wait()
        self.outgoing.put(None)
        until = time.monotonic() + 1.0
        while self.reader.is_alive() and time.monotonic() < until:  # it may wait for room
            with contextlib.suppress(queue.Empty):
                self.lines.get(timeout=0.05)
        self.writer.join(1.0)
        for thread, pipe in ((self.reader, self.process.stdout), (self.writer, self.process.stdin)):
            if pipe is not None and not thread.is_alive():  # else what it started holds it open; the thread is a daemon's
                with contextlib.suppress(OSError):
                    pipe.close()
        shutil.rmtree(self.folder, ignore_errors=True)


def _value(x: Any) -> Any:
    try:
        return decode(x)
    except (ValueError, TypeError, OverflowError, RecursionError):
        raise _Gone("broke off: what it wrote is no value") from None


def _raised(reply: dict[str, Any], given: tuple[Any, ...] = ()) -> str:
    """What an answer raised, in one sentence of plain text."""
    error, message, line, text = (_clean(reply.get(name)) for name in ("error", "message", "line", "text"))
    if error == "NotImplementedError":
        return f"is not answered yet: {message}" if message else "is not answered yet"
    where = f" (line {line}: {text})" if line else ""
    asked = (
        f" for the arguments {_clean(', '.join(map(repr, given)), 160)}"
        if given and error != "PermissionError" and not line
        else ""
    )
    return f"raises {error}{': ' if message else ''}{message}{where}{asked}"


def _clean(text: Any, most: int = 300) -> str:
    """One line of printable characters."""
    said = " ".join(str("" if text is None else text).split())
    return "".join(c if c.isprintable() else "?" for c in said)[:most]


@cache
def program() -> str:
    """The child's program: this folder's three files, so that rodlab itself need not be readable there."""
    here = files("rodlab.grading")
    texts = {name: (here / f"{name}.py").read_text(encoding="utf-8") for name in ("plain", "guard", "child")}
    return "\n".join([
        "import sys, types",
        "for name in ('rodlab', 'rodlab.grading'): sys.modules[name] = types.ModuleType(name)",
        f"texts = {texts!r}",
        "for name in ('plain', 'guard', 'child'):",
        "    module = sys.modules['rodlab.grading.' + name] = types.ModuleType('rodlab.grading.' + name)",
        "    exec(compile(texts[name], name, 'exec'), module.__dict__)",
        "serve = module.serve",
        "del texts, module, name, sys, types",
        "serve()",
    ])  # fmt: skip


@cache
def readable() -> tuple[str, ...]:
    """Where Python and its libraries are, and what they read of the system."""
    paths = [
        *sysconfig.get_paths().values(),
        sys.prefix,
        sys.base_prefix,
        sys.exec_prefix,
        str(Path(sys.executable).resolve().parent),
    ]
    paths += ["/usr/lib", "/usr/lib64", "/usr/share", "/lib", "/lib64", "/etc", "/dev/urandom", "/dev/null"]
    return tuple(sorted({os.path.realpath(path) for path in paths if os.path.exists(path)}))  # noqa: PTH110


@cache
def bubblewrap() -> str | None:
    """The path of bubblewrap where it is installed and works."""
    path = shutil.which("bwrap")
    if path is None or os.environ.get("RODLAB_BUBBLEWRAP") == "no":
        return None
    test = [path, "--ro-bind", "/", "/", "--unshare-all", "--die-with-parent", "--proc", "/proc", "--dev", "/dev", "true"]
    done = subprocess.run(test, capture_output=True, check=False)  # noqa: S603
    return path if done.returncode == 0 else None


@cache
def walls(hidden: tuple[str, ...]) -> list[str]:
    """The command that builds walls around the process; nothing where there is no bubblewrap."""
    path = bubblewrap()
    if path is None:
        return []
    binds = []
    for folder in ["/usr", "/lib", "/lib64", "/bin", "/etc", *readable()]:
        if os.path.exists(folder) and not folder.startswith("/dev"):  # noqa: PTH110
            binds += ["--ro-bind", folder, folder]
    covered = [folder for folder in hidden if any(folder.startswith(root + os.sep) for root in readable())]
    return [
        path, "--unshare-all", "--die-with-parent", "--new-session", "--cap-drop", "ALL", *binds, "--proc", "/proc", "--dev", "/dev",
        *(part for folder in covered for part in ("--tmpfs", folder)), "--size", str(16 * MIB), "--tmpfs", "/answer", "--chdir", "/answer",
    ]  # fmt: skip
