"""What is around a process that answers: the text of its program, the folders it may read, and bubblewrap where it is installed.

Bubblewrap gives it processes, a network and a file system of its own: no network, nobody else's processes, Python's folders to
read, and 16 MiB of memory to write files to.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
from functools import cache
from importlib.resources import files
from pathlib import Path

MIB = 2**20
TEXTS = ("plain", "locks", "guard", "child")
SYSTEM = (  # what Python and its libraries read besides themselves
    "/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/share/fonts", "/usr/share/zoneinfo", "/lib", "/lib64",
    "/System/Library", "/etc/ld.so.cache", "/etc/ld.so.conf", "/etc/ld.so.conf.d", "/etc/alternatives", "/etc/fonts",
    "/etc/localtime", "/etc/mime.types", "/dev/urandom", "/dev/null",
)  # fmt: skip


@cache
def program() -> str:
    """The child's program: four of this folder's files, so that rodlab itself need not be readable there.

    Each has builtins of its own, so that a submission that replaces isinstance does not replace the guard's.
    """
    here = files("rodlab.grading")
    texts = {name: (here / f"{name}.py").read_text(encoding="utf-8") for name in TEXTS}
    return "\n".join([
        "import builtins, sys, types",
        "for name in ('rodlab', 'rodlab.grading'): sys.modules[name] = types.ModuleType(name)",
        f"texts = {texts!r}",
        f"for name in {TEXTS!r}:",
        "    module = sys.modules['rodlab.grading.' + name] = types.ModuleType('rodlab.grading.' + name)",
        "    module.__dict__['__builtins__'] = dict(vars(builtins))",
        "    exec(compile(texts[name], name, 'exec'), module.__dict__)",
        "serve = module.serve",
        "del texts, module, name, sys, types, builtins",
        "serve()",
    ])  # fmt: skip


@cache
def readable() -> tuple[str, ...]:
    """Where Python and its libraries are, and what they read of the system."""
    paths = [*sysconfig.get_paths().values(), sys.prefix, sys.base_prefix, sys.exec_prefix, *SYSTEM]
    paths.append(str(Path(sys.executable).resolve().parent))
    found = {os.path.realpath(path) for path in paths if os.path.exists(path)}  # noqa: PTH110
    return tuple(sorted(found - {os.sep}))


@cache
def bubblewrap() -> str | None:
    """The path of bubblewrap where it is installed and works."""
    path = shutil.which("bwrap")
    if path is None or os.environ.get("RODLAB_BUBBLEWRAP") == "no":
        return None
    test = [path, "--ro-bind", "/", "/", "--unshare-all", "--die-with-parent", "--proc", "/proc", "--dev", "/dev", "true"]
    try:
        done = subprocess.run(test, capture_output=True, check=False, timeout=10)  # noqa: S603
    except (OSError, subprocess.TimeoutExpired):
        return None
    return path if done.returncode == 0 else None


@cache
def walls(hidden: tuple[str, ...]) -> list[str]:
    """The command that builds walls around the process; nothing where there is no bubblewrap."""
    path = bubblewrap()
    if path is None:
        return []
    binds: list[str] = []
    for folder in dict.fromkeys(["/usr", "/lib", "/lib64", "/bin", *SYSTEM, *readable(), sys.prefix, sys.base_prefix]):
        if os.path.exists(folder) and not folder.startswith("/dev"):  # noqa: PTH110
            binds += ["--ro-bind", folder, folder]
    roots = ("/usr", *readable())
    covered = [folder for folder in hidden if any(folder.startswith(root + os.sep) for root in roots)]
    return [
        path, "--unshare-all", "--die-with-parent", "--new-session", "--cap-drop", "ALL", *binds, "--proc", "/proc",
        "--dev", "/dev", *(part for folder in covered for part in ("--tmpfs", folder)),
        "--size", str(MIB), "--tmpfs", "/dev/shm",  # noqa: S108 the inner one
        "--size", str(16 * MIB), "--tmpfs", "/answer", "--remount-ro", "/", "--chdir", "/answer",
    ]  # fmt: skip
