"""What Linux refuses a process for good, whatever code asks for it: system calls (seccomp), files (Landlock), privileges.

    seccomp    no other processes or threads, no program, no network, no signal to others, no limit raised, nothing mounted
    Landlock   no file but those below some folders to read, and one to write to
    capset     none of the rights of root, where the grader is root

They need no right and no installation. Calls of libc by ctypes, so the audit hook of `guard` must come after them. Elsewhere than
on Linux with x86-64 or ARM (64 bits) there are fewer or none. Standard library only, as this file is also run in the child.
"""

import os
import struct
import sys
from collections.abc import Sequence
from typing import Any

# --- seccomp ------------------------------------------------------------------------------------------------------

REFUSED = {  # system calls: their numbers on x86_64 and aarch64, -1 where there is none
    "clone": (56, 220), "fork": (57, -1), "vfork": (58, -1), "execve": (59, 221), "execveat": (322, 281),
    "socket": (41, 198), "socketpair": (53, 199), "connect": (42, 203), "bind": (49, 200), "ptrace": (101, 117),
    "process_vm_readv": (310, 270), "process_vm_writev": (311, 271), "process_madvise": (440, 440), "tkill": (200, 130),
    "rt_sigqueueinfo": (129, 138), "rt_tgsigqueueinfo": (297, 240), "pidfd_send_signal": (424, 424),
    "pidfd_open": (434, 434), "pidfd_getfd": (438, 438), "setrlimit": (160, 164), "setpgid": (109, 154),
    "setsid": (112, 157), "setpriority": (141, 140), "sched_setscheduler": (144, 119), "sched_setattr": (314, 274),
    "mount": (165, 40), "umount2": (166, 39), "pivot_root": (155, 41), "chroot": (161, 51), "unshare": (272, 97),
    "setns": (308, 268), "open_tree": (428, 428), "move_mount": (429, 429), "fsopen": (430, 430), "fsconfig": (431, 431),
    "fsmount": (432, 432), "fspick": (433, 433), "mount_setattr": (442, 442), "init_module": (175, 105),
    "delete_module": (176, 106), "finit_module": (313, 273), "kexec_load": (246, 104), "kexec_file_load": (320, 294),
    "reboot": (169, 142), "swapon": (167, 224), "swapoff": (168, 225), "settimeofday": (164, 170),
    "clock_settime": (227, 112), "adjtimex": (159, 171), "clock_adjtime": (305, 266), "sethostname": (170, 161),
    "setdomainname": (171, 162), "bpf": (321, 280), "perf_event_open": (298, 241), "userfaultfd": (323, 282),
    "io_uring_setup": (425, 425), "io_uring_enter": (426, 426), "io_uring_register": (427, 427), "add_key": (248, 217),
    "request_key": (249, 218), "keyctl": (250, 219), "ioperm": (173, -1), "iopl": (172, -1), "acct": (163, 89),
    "quotactl": (179, 60), "name_to_handle_at": (303, 264), "open_by_handle_at": (304, 265), "fanotify_init": (300, 262),
    "syslog": (103, 116), "shmget": (29, 194), "shmat": (30, 196), "msgget": (68, 186), "semget": (64, 190),
    "mq_open": (240, 180), "memfd_create": (319, 279), "memfd_secret": (447, 447), "personality": (135, 92),
    "move_pages": (279, 239), "migrate_pages": (256, 238), "chmod": (90, -1), "fchmod": (91, 52), "fchmodat": (268, 53),
    "fchmodat2": (452, 452), "chown": (92, -1), "fchown": (93, 55), "lchown": (94, -1), "fchownat": (260, 54),
    "utime": (132, -1), "utimes": (235, -1), "futimesat": (261, -1), "utimensat": (280, 88), "setxattr": (188, 5),
    "lsetxattr": (189, 6), "fsetxattr": (190, 7), "setxattrat": (463, 463), "removexattr": (197, 14),
    "lremovexattr": (198, 15), "fremovexattr": (199, 16), "truncate": (76, 45), "link": (86, -1), "linkat": (265, 37),
    "symlink": (88, -1), "symlinkat": (266, 36), "mknod": (133, -1), "mknodat": (259, 33),
}  # fmt: skip
SIGNALS = {"kill": (62, 129), "tgkill": (234, 131)}  # to itself alone, as abort() does
CLONE3, PRLIMIT, FCNTL, SECCOMP, CAPSET = (435, 435), (302, 261), (72, 25), (317, 277), (126, 91)
MACHINES = {"x86_64": (0, 0xC000003E), "aarch64": (1, 0xC00000B7)}  # the column, and what the kernel calls it
ALLOW, KILL, NO, UNKNOWN = 0x7FFF0000, 0x80000000, 0x00050001, 0x00050026  # NO is EPERM, UNKNOWN is ENOSYS
LOAD, EQUAL, LEAST, RETURN = 0x20, 0x15, 0x35, 0x06  # of the filter's small machine
NUMBER, MACHINE, FIRST, SECOND, THIRD = 0, 4, 16, 24, 32  # where it finds the call, the machine, and the arguments

# --- Landlock -----------------------------------------------------------------------------------------------------

RULESET, RULE, RESTRICT = 444, 445, 446  # everywhere the same
EXECUTE, WRITE, READ, LIST, NO_FOLDER, NO_FILE = (1 << bit for bit in range(6))
MAKE_FOLDER, MAKE_FILE, TRUNCATE = 1 << 7, 1 << 8, 1 << 14
ALL = {1: 0x1FFF, 2: 0x3FFF, 3: 0x7FFF, 4: 0x7FFF, 5: 0xFFFF}  # rights that a version knows
OWN = WRITE | READ | LIST | NO_FOLDER | NO_FILE | MAKE_FOLDER | MAKE_FILE | TRUNCATE


def lock(readable: Sequence[str], hidden: Sequence[str], own: str) -> list[str]:
    """Close all locks that this system has, for good; returns what each of them holds back."""
    here = MACHINES.get(os.uname().machine) if sys.platform == "linux" and sys.maxsize > 2**32 else None
    if here is None:
        return []
    try:
        import ctypes

        libc = ctypes.CDLL(None, use_errno=True)
    except (ImportError, OSError):
        return []
    column, machine = here
    closed = []
    libc.prctl(1, 9, 0, 0, 0)  # PR_SET_PDEATHSIG: it dies with the grader
    if libc.prctl(38, 1, 0, 0, 0) != 0:  # PR_SET_NO_NEW_PRIVS
        return []
    header, none = struct.pack("Ii", 0x20080522, 0), bytes(24)
    libc.syscall(CAPSET[column], header, none)
    rules = [(path, READ | LIST) for path in _besides(readable, hidden)]
    if _files(libc, rules + _listed(readable, hidden), own):
        closed.append("files")
    code = _filter(column, machine, os.getpid())
    buffer = ctypes.create_string_buffer(code, len(code))
    program = struct.pack("HxxxxxxQ", len(code) // 8, ctypes.addressof(buffer))
    if libc.syscall(SECCOMP[column], 1, 1, program) == 0:
        closed += ["processes", "network"]
    return closed


def _filter(column: int, machine: int, own: int) -> bytes:
    """The program that the kernel runs at each system call."""

    def step(what: int, value: int, then: int = 0, otherwise: int = 0) -> bytes:
        return struct.pack("HBBI", what, then, otherwise, value & 0xFFFFFFFF)

    yes, no = step(RETURN, ALLOW), step(RETURN, NO)

    def case(number: int, *steps: bytes) -> list[bytes]:
        return [step(EQUAL, number, 0, len(steps)), *steps] if number >= 0 else []

    code = [step(LOAD, MACHINE), step(EQUAL, machine, 1, 0), step(RETURN, KILL), step(LOAD, NUMBER)]
    code += [step(LEAST, 0x40000000, 0, 1), no]  # x86 has a second set of numbers there
    for numbers in REFUSED.values():
        code += case(numbers[column], no)
    code += case(CLONE3[column], step(RETURN, UNKNOWN))  # so that libc falls back to clone, and is refused that
    for numbers in SIGNALS.values():
        code += case(numbers[column], step(LOAD, FIRST), step(EQUAL, own, 0, 1), yes, no)
    asks = [step(LOAD, THIRD), step(EQUAL, 0, 0, 3), step(LOAD, THIRD + 4), step(EQUAL, 0, 0, 1), yes, no]
    code += case(PRLIMIT[column], *asks)  # a limit may be asked for, not set
    code += case(FCNTL[column], step(LOAD, SECOND), step(EQUAL, 8, 1, 0), step(EQUAL, 15, 0, 1), no, yes)  # no F_SETOWN: signals
    return b"".join([*code, yes])


def _files(libc: Any, rules: Sequence[tuple[str, int]], own: str) -> bool:
    """True if from now on only files of the rules can be read, and only those below `own` be written to."""
    version = libc.syscall(RULESET, None, 0, 1)
    if version < 1:
        return False
    handled = ALL[min(version, 5)]
    attributes = struct.pack("QQQ", handled, 3, 3)[: 8 if version < 4 else 16 if version < 6 else 24]
    ruleset = libc.syscall(RULESET, attributes, len(attributes), 0)
    if ruleset < 0:
        return False
    for path, rights in [*rules, (own, OWN), (os.devnull, READ | WRITE)]:
        try:
            place = os.open(path, getattr(os, "O_PATH", 0))
        except OSError:
            continue
        of_file = rights if os.path.isdir(path) else rights & (READ | WRITE)
        libc.syscall(RULE, ruleset, 1, struct.pack("=Qi", of_file & handled, place), 0)
        os.close(place)
    done = bool(libc.syscall(RESTRICT, ruleset, 0) == 0)
    os.close(ruleset)
    return done


def _besides(folders: Sequence[str], hidden: Sequence[str]) -> list[str]:
    """The folders, but where one holds a hidden one, what is beside that: Landlock can only add."""
    secret = [os.path.join(os.path.realpath(path), "") for path in hidden]
    found, left = [], [os.path.realpath(folder) for folder in folders]
    while left:
        path = left.pop()
        if any(os.path.join(path, "").startswith(inner) for inner in secret):
            continue
        if any(inner.startswith(os.path.join(path, "")) for inner in secret):
            left += [entry.path for entry in os.scandir(path) if not entry.is_symlink()]
        else:
            found.append(path)
    return found


def _listed(folders: Sequence[str], hidden: Sequence[str]) -> list[tuple[str, int]]:
    """The folders whose names alone may be listed, as imports do."""
    return [(folder, LIST) for folder in folders if folder not in _besides([folder], hidden)]
