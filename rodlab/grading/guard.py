"""What a process that answers may do, by Python's means: limits of the system, and an audit hook that is not taken off again.

The hook refuses, with a sentence, what an answer has no need of: other processes, the network, files outside its own folder
and Python's, raising its limits, native code by ctypes. It calls nothing that an answer could have replaced, and is given its
rules as arguments: what frames and tracebacks hand out of them is a copy.

It does not protect from native code. NumPy alone can be made to write to any address (`__array_interface__`, `as_strided`), as
can made-up bytecode and what is left of ctypes: who does that on purpose takes the hook off. Nor does it see threads, or os.stat
and os.readlink, which tell whether a file is there. Against native code there are only the kernel's walls: `locks` on Linux, and
bubblewrap where it is installed. Standard library only, as this file is also run in the child.
"""

import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from itertools import count
from typing import Any

REFUSED = (
    "os.fork", "os.forkpty", "os.posix_spawn", "os.exec", "os.spawn", "os.system", "os.startfile", "os.kill", "os.killpg",
    "pty.spawn", "subprocess.Popen", "_winapi.CreateProcess", "_winapi.TerminateProcess", "_winapi.OpenProcess",
    "os.setxattr", "os.removexattr", "os.chroot", "os.chdir", "resource.setrlimit", "resource.prlimit", "sys.settrace",
    "sys.setprofile", "sys.addaudithook", "cpython.PyInterpreterState_New", "gc.get_objects", "gc.get_referrers",
    "gc.get_referents", "sys._current_frames", "sys._current_exceptions", "sys.remote_exec", "signal.pthread_kill",
    "syslog.syslog", "syslog.openlog", "fcntl.fcntl", "fcntl.ioctl", "fcntl.lockf", "fcntl.flock", "sqlite3.connect",
    "ctypes.dlsym", "ctypes.dlsym/handle", "ctypes.call_function", "ctypes.cdata", "ctypes.cdata/buffer", "ctypes.string_at",
    "ctypes.wstring_at", "ctypes.addressof", "ctypes.memoryview_at", "mmap.__new__", "os.chmod", "os.chown", "os.chflags",
    "os.lchmod", "os.lchown", "os.link", "os.symlink", "os.mkfifo", "os.mknod", "os.add_dll_directory", "webbrowser.open",
    "winreg.ConnectRegistry", "winreg.OpenKey", "winreg.CreateKey",
)  # fmt: skip
CHANGES = {  # how many paths they are given, and where the folder's number stands that these are relative to
    "os.remove": (1, (1,)), "os.rename": (2, (2, 3)), "os.rmdir": (1, (1,)), "os.mkdir": (1, (2,)), "os.truncate": (1, ()),
    "os.utime": (1, (3,)), "shutil.rmtree": (1, (1,)),
}  # fmt: skip
LOOKS = ("os.listdir", "os.scandir")
MODULES = (  # with doors of their own, which no hook sees
    "_xxsubinterpreters", "_interpreters", "_testcapi", "_testinternalcapi", "_testlimitedcapi", "_ctypes_test",
    "_cffi_backend", "cffi",
    "_sqlite3", "_dbm", "_gdbm", "_posixshmem", "_tkinter", "readline", "numba", "llvmlite",
)  # fmt: skip

DOORS = {  # functions that no hook hears of; who finds another way to them than their modules is not stopped by this
    "_posixsubprocess": ("fork_exec",), "subprocess": ("_fork_exec",), "posix": ("mkfifo", "mknod", "pidfd_open"),
    "os": ("mkfifo", "mknod", "pidfd_open"), "_signal": ("pidfd_send_signal",), "signal": ("pidfd_send_signal",),
}  # fmt: skip


def limit(cpu: int, memory: int, file: int) -> list[str]:
    """Set the limits for good; returns the names of those that this system does not have, or not for this user."""
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
    if os.geteuid() == 0 and "processes" not in missing:
        missing.append("processes")  # the system does not count those of root
    return missing


def guard(readable: Sequence[str], hidden: Sequence[str], own: str, files: int) -> None:
    """Refuse from now on what an answer has no need of.

    Parameters
    ----------
    readable : folders that may be read (Python and its libraries)
    hidden : folders in them that may not (rodlab itself, the exercises)
    own : the folder that may be written to, at most `files` files and folders; the working folder
    """
    for module, names in DOORS.items():
        with suppress(ImportError):
            loaded = __import__(module)
            for name in names:
                if hasattr(loaded, name):
                    setattr(loaded, name, _refused)
    own = _folder(own)
    path = partial(_path, (isinstance, str, str.__str__, bytes, bytes.decode, sys.getfilesystemencoding(), PermissionError))
    place = partial(_place, (path, os.readlink, OSError, PermissionError, os.sep, own))  # realpath could be replaced in parts
    change = partial(_change, (place, own, os.devnull + os.sep, count(1).__next__, files, PermissionError))
    read = partial(_read, (place, tuple(map(_folder, hidden)), (*map(_folder, readable), own), PermissionError))
    writes = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND | getattr(os, "O_TMPFILE", 0)
    absolute = os.sep == "/"  # elsewhere no folder is given by a number
    tools = (type, int, str, isinstance, str.__str__, PermissionError, ImportError, bytes)
    rules = (frozenset(REFUSED), dict(CHANGES).get, frozenset(LOOKS), frozenset(MODULES))
    sys.addaudithook(partial(_hook, tools, rules, read, change, path, writes, absolute))


def _refused(*_: Any, **__: Any) -> None:
    raise PermissionError("an answer may not do this")


def _folder(path: str) -> str:
    return os.path.join(os.path.realpath(path), "")


# Each of these is given all that it uses: globals, builtins and cells can be reached from a traceback and written to


def _path(tools: tuple[Any, ...], path: Any) -> str:
    """A path as exactly a text, whatever its class says that it is."""
    is_a, text, exact, octets, decode, encoding, no = tools
    if is_a(path, text):
        return exact(path)  # type: ignore[no-any-return]
    if is_a(path, octets):
        return decode(path, encoding, "surrogateescape")  # type: ignore[no-any-return]
    raise no("an answer must give a path as a text")


def _place(tools: tuple[Any, ...], given: Any) -> str:
    """Where a path leads to, all links followed, with a separator at its end."""
    path, link, missing, no, sep, own = tools
    whole = path(given)
    if sep != "/":  # Windows: no link can be made there without a right
        import os.path

        return os.path.join(os.path.realpath(whole), "")
    if not whole.startswith("/"):
        whole = own + whole
    if whole.startswith(own) and ".." in whole.split("/"):
        raise no("an answer may not leave its folder by ..")
    parts, at, links = whole.split("/")[::-1], "", 0
    while parts:
        part = parts.pop()
        if part in ("", "."):
            continue
        if part == "..":
            at = at.rpartition("/")[0]
            continue
        try:
            target = link(at + "/" + part)
        except missing:
            at += "/" + part
            continue
        links += 1
        if links > 40:
            raise no("an answer may not follow so many links")
        at = "" if target.startswith("/") else at
        parts += target.split("/")[::-1]
    return at + "/"


def _read(tools: tuple[Any, ...], path: Any) -> None:
    place, hidden, readable, no = tools
    where = place(path)
    if where.startswith(hidden) or not where.startswith(readable):
        raise no("an answer may not read files other than Python's own")


def _change(tools: tuple[Any, ...], path: Any, new: bool) -> None:
    place, own, nothing, number, files, no = tools
    where = place(path)
    if where == nothing:
        return
    if not where.startswith(own):
        raise no("an answer may not write files other than in its own folder")
    if new and number() > files:
        raise no(f"an answer may not write more than {files} files")


def _hook(
    tools: tuple[Any, ...],
    rules: tuple[Any, ...],
    read: Any,
    change: Any,
    path: Any,
    writes: int,
    absolute: bool,
    event: str,
    given: Any,
) -> None:
    kind, whole, text, is_a, exact, no, no_module, octets = tools
    refused, changes, looks, modules = rules
    if event == "open":
        where, mode, flags = given
        if kind(where) is whole:
            return
        where = path(where)
        if absolute and mode is None and not where.startswith("/"):  # os.open may be given another folder to start from
            raise no("an answer must give os.open a whole path")
        if (is_a(mode, text) and not {*exact(mode)}.isdisjoint("wax+")) or (kind(flags) is whole and flags & writes):
            change(where, True)
        else:
            read(where)
    elif event == "import":
        name = exact(given[0]).partition(".")[0]
        if name == "rodlab":
            raise no_module("rodlab is not there for an answer: it is written with numpy, scipy, sympy and mpmath alone")
        if name in modules:
            raise no_module(f"an answer may not import {name}")
    elif event in refused or event.startswith("socket.") or (event == "ctypes.dlopen" and given[0] is not None):
        raise no(f"an answer may not do this: {event}")
    elif changes(event) is not None:
        paths, folders = changes(event)
        for at in folders:
            if at < given.__len__() and given[at] not in (-1, None):
                raise no("an answer must give whole paths")
        for one in given[:paths]:
            change(one, event == "os.mkdir")
    elif event in looks and (is_a(given[0], text) or is_a(given[0], octets)):
        read(given[0])
