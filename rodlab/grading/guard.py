"""What a process that answers may do: limits of the system, and an audit hook that cannot be taken off again.

The hook refuses what an answer has no need of: other processes, the network, files outside its own folder and Python's, raising
its limits, native code by ctypes. It stops what an answer written in Python does; it is no wall against native code. That wall
is bubblewrap, where it is installed. Standard library only, as this file is also run in the child.
"""

import os
import sys
from collections.abc import Callable, Sequence
from typing import Any

REFUSED = (
    "os.fork", "os.forkpty", "os.posix_spawn", "os.exec", "os.spawn", "os.system", "os.startfile", "os.kill", "os.killpg", "pty.spawn",
    "subprocess.Popen", "_winapi.CreateProcess", "os.setxattr", "os.chroot", "resource.setrlimit", "resource.prlimit", "sys.settrace",
    "gc.get_objects", "gc.get_referrers", "gc.get_referents", "sys._current_frames", "signal.pthread_kill", "syslog.syslog",
    "ctypes.dlsym", "ctypes.call_function", "ctypes.cdata", "ctypes.cdata/buffer", "ctypes.string_at", "ctypes.wstring_at",
    "ctypes.addressof", "ctypes.memoryview_at", "mmap.__new__",
)  # fmt: skip
CHANGES = (
    "os.remove", "os.rename", "os.rmdir", "os.mkdir", "os.chmod", "os.chown", "os.link", "os.symlink", "os.truncate", "os.utime",
    "shutil.rmtree", "os.mkfifo", "os.mknod",
)  # fmt: skip
LOOKS = ("os.listdir", "os.scandir", "os.chdir")


def limit(cpu: int, memory: int, file: int) -> list[str]:
    """Set the limits for good; returns the names of those that this system does not have."""
    try:
        import resource
    except ImportError:
        return ["CPU", "memory", "file size", "processes"]
    missing = []
    wanted = {
        "CPU": ("RLIMIT_CPU", cpu), "memory": ("RLIMIT_AS", memory), "file size": ("RLIMIT_FSIZE", file),
        "processes": ("RLIMIT_NPROC", 0), "core": ("RLIMIT_CORE", 0), "open files": ("RLIMIT_NOFILE", 256),
    }  # fmt: skip
    for name, (kind, most) in wanted.items():
        try:
            resource.setrlimit(getattr(resource, kind), (most, most))
        except (AttributeError, ValueError, OSError):
            missing.append(name)
    return missing


def guard(readable: Sequence[str], hidden: Sequence[str], own: str, files: int) -> None:
    """Refuse from now on what an answer has no need of.

    Parameters
    ----------
    readable : folders that may be read (Python and its libraries)
    hidden : folders in them that may not (rodlab itself, the exercises)
    own : the folder that may be written to, at most `files` files
    """
    sys.addaudithook(_hook(tuple(map(_folder, readable)), tuple(map(_folder, hidden)), _folder(own), files))


def _folder(path: str) -> str:
    return os.path.join(os.path.realpath(path), "")


def _hook(readable: tuple[str, ...], hidden: tuple[str, ...], own: str, files: int) -> Callable[[str, tuple[Any, ...]], None]:
    realpath, fspath, writes = os.path.realpath, os.fsdecode, os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
    refused, changes, looks = frozenset(REFUSED), frozenset(CHANGES), frozenset(LOOKS)
    left = [files]

    def place(path: Any) -> str:
        return realpath(fspath(path)) + "/"

    def read(path: Any) -> None:
        where = place(path)
        if where.startswith(hidden) or not where.startswith((*readable, own)):
            raise PermissionError("an answer may not read files other than Python's own")

    def change(path: Any) -> None:
        if not place(path).startswith(own):
            raise PermissionError("an answer may not write files other than in its own folder")

    def hook(event: str, given: tuple[Any, ...]) -> None:
        if event == "open":
            path, mode, flags = given
            if isinstance(path, int):
                return
            if (isinstance(mode, str) and set(mode) & set("wax+")) or (isinstance(flags, int) and flags & writes):
                if place(path) == "/dev/null/":
                    return
                change(path)
                left[0] -= 1
                if left[0] < 0:
                    raise PermissionError(f"an answer may not write more than {files} files")
            else:
                read(path)
        elif event == "import":
            name = str(given[0])
            if name == "rodlab" or name.startswith("rodlab."):
                raise ImportError("rodlab is not there for an answer: it is written with numpy, scipy, sympy and mpmath alone")
            if name == "_posixsubprocess":
                return
        elif event in refused or event.startswith("socket.") or (event == "ctypes.dlopen" and given[0] is not None):
            raise PermissionError(f"an answer may not do this: {event}")
        elif event in changes:
            for path in given[:2] if event in ("os.rename", "os.link", "os.symlink") else given[:1]:
                if not isinstance(path, int):
                    change(path)
        elif event in looks and given[0] is not None and not isinstance(given[0], int):
            read(given[0])

    return hook
