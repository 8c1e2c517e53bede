"""Files written whole or not at all."""

import contextlib
import os
from pathlib import Path


def write_whole(path: Path, content: bytes | str) -> Path:
    """Write a file beside its place and move it there: a reader, or a kill, sees the old file or the new one.

    Raises `ValueError` in one sentence when it cannot be written.
    """
    data = content.encode() if isinstance(content, str) else content
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
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
