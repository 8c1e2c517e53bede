"""Files written whole or not at all: whatever kills the writer, a reader sees the old file or the new one."""

import contextlib
import os
import threading
from pathlib import Path


def write_whole(path: Path, content: bytes | str) -> Path:
    """Write a file beside its place and move it there: a reader, or a kill, sees the old file or the new one.

    Raises `ValueError` in one sentence when it cannot be written.
    """
    data = content.encode() if isinstance(content, str) else content
    temporary = path.with_name(f".{path.name}.{threading.get_ident()}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        raise ValueError(f"{path} cannot be written: {error.strerror or error}") from None
    finally:
        with contextlib.suppress(OSError):  # the folder itself may be missing
            temporary.unlink(missing_ok=True)
    return path


def swept(folder: Path) -> None:
    """Remove what killed writers left beside their files."""
    for path in folder.glob(".*"):
        name, _, writer = path.name.rpartition(".")
        if name.count(".") >= 2 and writer.isdecimal() and not _runs(int(writer)):
            with contextlib.suppress(OSError):
                path.unlink()


def _runs(process: int) -> bool:
    """True when a process of this number is running, or may be."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        pass
    return True
