"""An answer in a process of its own: asked for values, under limits, and stopped when it does not come back.

What is given into the process is the submission and the arguments; what comes out are plain values (`plain`). Around it are
limits of the system and an audit hook (`guard`), on Linux what the kernel refuses (`locks`), and bubblewrap where it is installed
(`walls`).
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rodlab.grading.process import STARTUP, Gone, Process, Raised, raised
from rodlab.grading.walls import MIB, bubblewrap, readable

__all__ = ["Limits", "NotStarted", "Sandbox", "Stopped", "bubblewrap"]

PACKAGE = Path(__file__).resolve().parents[1]
EXERCISES = (PACKAGE / "exercises", PACKAGE.parent / "exercises", PACKAGE.parent / "tests", PACKAGE.parent / ".git")


class Stopped(Exception):
    """An answer that gave no values, with the reason in one sentence, and the line if it raised; `lost` if it never will."""

    def __init__(self, sentence: str, *, unanswered: bool = False, lost: bool = False) -> None:
        super().__init__(sentence)
        self.unanswered, self.lost = unanswered, lost


class NotStarted(ValueError):
    """No process to answer in: a fault of this machine or of the exercise, and nobody's points."""


@dataclass(frozen=True)
class Limits:
    """What an answer may use: wall-clock seconds a question and in all, CPU seconds, bytes of memory, of a file, of a reply.

    `seconds` holds for loading it and, where limits are given to a `Sandbox`, for every question; else each has its own.
    """

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
        self.hidden = [str(path.resolve()) for path in (PACKAGE, *EXERCISES, *hidden) if path.exists()]
        self.most = float("inf") if limits is None else limits.seconds
        self.until = time.monotonic() + self.limits.total
        self.dead: str | None = None  # why it cannot be asked again
        self.missing: tuple[str, ...] = ()
        self.locks: tuple[str, ...] = ()
        self._process: Process | None = None

    def __enter__(self) -> "Sandbox":
        return self

    def __exit__(self, *_: object) -> None:
        self._close()

    @property
    def protections(self) -> str:
        """What this machine protects itself by, in a few words; all of them once it was asked."""
        said = ["bubblewrap: no network, read-only files" if bubblewrap() else "no bubblewrap"]
        said.append(f"the kernel's locks: {', '.join(self.locks)}" if self.locks else "audit hook only")
        missing = [name for name in self.missing if name not in self.locks]
        return "; ".join([*said, *([f"no limit of {', '.join(missing)}"] if missing else [])])

    def ask(self, name: str, calls: Sequence[tuple[Any, ...]], seconds: float | None = None) -> list[Any]:
        """The values of the submission's function `name` for each tuple of arguments; raises `Stopped`."""
        if self.dead is not None:
            raise Stopped(self.dead, lost=True)
        process = self._started()
        allowed = self.limits.seconds if seconds is None else min(seconds, self.most)
        try:
            return process.ask(name, calls, min(allowed, self._left()))
        except Gone as gone:
            self._close()
            if self.until <= time.monotonic():  # not how much of it was left, which is never the same
                raise Stopped(self._too_long) from None
            self.dead = gone.sentence if gone.forged else None  # who forges replies is not asked again
            raise Stopped(gone.sentence, lost=gone.forged) from None
        except Raised as error:
            raise Stopped(error.sentence, unanswered=error.unanswered) from None

    def _left(self) -> float:
        left = self.until - time.monotonic()
        if left <= 0:
            self._close()
            raise Stopped(self._too_long)
        return left

    @property
    def _too_long(self) -> str:
        return f"no time is left: the whole answer may take {self.limits.total:g} seconds"

    def _started(self) -> Process:
        if self._process is None:
            self._left()
            before = time.monotonic()
            try:
                process = self._process = Process(self._setup(), self.limits.reply)
                held = process.read(STARTUP)  # before the submission runs, so that this one is ours
            except (OSError, Gone) as why:
                self._close()
                said = f"it {why.sentence}" if isinstance(why, Gone) else why.strerror or str(why)
                needs = f"; it imports {', '.join(self.imports)}" if isinstance(why, Gone) and self.imports else ""
                raise NotStarted(f"the process for an answer does not start here: {said}{needs}") from None
            self.until += time.monotonic() - before
            self.missing, self.locks = tuple(held["missing"]), tuple(held["locks"])
            try:
                ready = process.read(min(self.limits.seconds, self._left()), self.limits.seconds)
            except Gone as gone:
                raise self._lost(f"cannot be loaded: it {gone.sentence}") from None
            if ready.get("ready") is not True:
                raise self._lost(f"cannot be loaded: it {raised(ready)}")
        return self._process

    def _lost(self, why: str) -> Stopped:
        self._close()
        self.dead = why
        return Stopped(why, lost=True)

    def _setup(self) -> dict[str, Any]:
        own = self.limits
        return {
            "source": self.source, "imports": self.imports, "limits": [own.cpu, own.memory, own.file], "files": own.files,
            "readable": list(readable()), "hidden": self.hidden,
        }  # fmt: skip

    def _close(self) -> None:
        if self._process is not None:
            self._process.close()
            self._process = None
