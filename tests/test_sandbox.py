"""Hostile and broken submissions: each gets the points it earned and a sentence, and leaves nothing behind."""

import ast
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from rodlab.grading import process, sandbox, walls
from rodlab.grading.formula import Formula, Unreadable
from rodlab.grading.plain import Code, Other, Written, decode, encode
from rodlab.grading.sandbox import Limits, Sandbox, Stopped
from rodlab.lab.teaching import course
from rodlab.lab.teaching.taught import taught

ROOT = Path(__file__).parents[1]
HOSTILE = sorted((ROOT / "tests" / "hostile").glob("*.py"))
SMALL = Limits(seconds=5.0, total=20.0, cpu=5, memory=1024 * 2**20)
HASTE = replace(SMALL, seconds=0.4, total=1.2)  # for those that would use up any time
LINUX = sys.platform == "linux"
pytestmark = pytest.mark.skipif(not LINUX, reason="what is left behind is looked for in /proc")


@pytest.fixture(params=["bubblewrap", "none"])
def walled(request, monkeypatch):
    """With bubblewrap, where it is there, and without."""
    if request.param == "bubblewrap" and walls.bubblewrap() is None:
        pytest.skip("bubblewrap is not there")
    if request.param == "none":
        monkeypatch.setenv("RODLAB_BUBBLEWRAP", "no")
        for module in (walls, process, sandbox):
            monkeypatch.setattr(module, "bubblewrap", lambda: None)
        walls.walls.cache_clear()
    yield request.param
    walls.walls.cache_clear()


def left_behind(folder):
    """Processes that this one started, by parent, and those that any of them did: by working folder or environment."""
    found, parents = set(), {}
    for place in Path("/proc").glob("[0-9]*"):
        try:
            stat = (place / "stat").read_text().rpartition(")")[2].split()
            if stat[0] != "Z":
                parents[int(place.name)] = int(stat[1])
                if str(folder) in os.readlink(place / "cwd") or os.fsencode(folder) in (place / "environ").read_bytes():
                    found.add(int(place.name))
        except (OSError, IndexError):
            continue
    mine = {os.getpid()}
    while more := {pid for pid, parent in parents.items() if parent in mine} - mine:
        mine |= more
    return (found | mine) - {os.getpid()}


def none_left(folder):
    until = time.monotonic() + 5.0
    while (left := left_behind(folder)) and time.monotonic() < until:
        time.sleep(0.02)
    return not left


def state():
    """What a submission might have changed: when, or whether it is there."""
    paths = [
        path for name in ("exercises", "rodlab/grading") for path in (ROOT / name).rglob("*") if "__pycache__" not in path.parts
    ]
    files = {path: path.stat().st_mtime_ns for path in [*paths, *ROOT.iterdir()] if path.is_file()}
    return files, [
        folder for folder in ("/tmp", "/var/tmp", "/dev/shm", "/", "/root") if os.path.exists(f"{folder}/rodlab-escaped")
    ]


def plain(sentence):
    return sentence.isprintable() and 0 < len(sentence) < 700


@pytest.mark.parametrize("path", HOSTILE, ids=lambda path: path.stem)
def test_a_hostile_submission_has_only_the_points_it_earned(path, walled, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    text = path.read_text(encoding="utf-8")
    earned, *marks = text.splitlines()[1].removeprefix("# points: ").split(", ")
    if "by its values alone" in marks and walled == "bubblewrap":
        pytest.skip("it asks the system for nothing that walls would refuse")
    before, start = state(), time.monotonic()
    report = course.check_source(
        course.exercise("two-joints"), text.replace("@ROOT@", str(ROOT)), seed=5, limits=HASTE if "in haste" in marks else SMALL
    )
    took = time.monotonic() - start
    assert took < 15.0
    most = float(earned.removeprefix("at most "))
    assert report.score <= most if "most" in earned else report.score == most, str(report)
    for item in report.items:
        assert plain(item.sentence), item.sentence
        assert item.passed or item.message
    assert none_left(tmp_path)
    assert state() == (before[0], [])
    assert not list(tmp_path.iterdir())


def test_there_are_many_and_each_says_what_it_tries():
    texts = [path.read_text(encoding="utf-8") for path in HOSTILE]
    assert len(texts) >= 36
    assert all(text.startswith("# ") and text.splitlines()[1].startswith("# points: ") for text in texts)


def test_a_good_submission_after_them_has_all_points(walled):
    source = taught(ROOT / "exercises" / "teacher" / "two-joints.py").reference
    report = course.check_source(course.exercise("two-joints"), source, seed=5)
    assert report.percent == 100.0
    assert report.protections.startswith("bubblewrap" if walled == "bubblewrap" else "no bubblewrap")
    assert "processes" in report.protections


SENTENCES = {
    "def f(): return open('/etc/passwd').read()": "an answer may not read files",
    "def f(): import rodlab": "rodlab is not there for an answer",
    "def f(): open('/tmp/rodlab-escaped', 'w')": "an answer may not write files",
    "def f(): import os; os.system('true')": "an answer may not do this: os.system",
    "def f():\n    while True: pass": "did not come back within 0.3 seconds: is there a loop that never ends?",
    "def f(): import os; os._exit(7)": "ended its own process (exit code 7)",
    "def f(): import os; os.abort()": "was ended by SIG",
    "def f(): raise NotImplementedError": "is not answered yet",
    "def g(): return 1": "is not answered yet: there is no function f",
    "def f(): return 'a' * 10**7": "returned more than 8 MiB",
    "def f(: pass": "cannot be loaded: it raises SyntaxError",
    "\0": "cannot be loaded: it raises",
    "\ud800": "cannot be loaded: it raises UnicodeEncodeError",
    "x = " + "(" * 10**5: "cannot be loaded: it",
    "while True: pass": "cannot be loaded: it did not come back within 0.3 seconds",
    "import sys; sys.exit()": "cannot be loaded: it raises SystemExit",
}


@pytest.mark.parametrize("source", SENTENCES, ids=range(len(SENTENCES)))
def test_what_went_wrong_is_one_sentence(source):
    limits = Limits(seconds=0.3 if "while" in source else 10.0, total=20.0)
    with Sandbox(source, limits, imports=()) as answer, pytest.raises(Stopped) as why:
        answer.ask("f", [()])
    assert SENTENCES[source] in str(why.value)
    assert plain(str(why.value))


def test_it_can_be_asked_again_after_it_raised_and_after_it_was_ended(walled):
    source = "def f(x):\n    if x == 1: raise ValueError\n    if x == 2:\n        while True: pass\n    return x\n"
    with Sandbox(source, Limits(seconds=0.5, total=20.0), imports=()) as answer:
        for x in (0, 1, 2, 3):
            try:
                assert answer.ask("f", [(x,)]) == [x]
            except Stopped as why:
                assert not why.lost
                assert x in (1, 2)


def test_starting_counts_neither_as_a_question_nor_in_all():
    with Sandbox("def f(): return 1", Limits(seconds=0.4, total=0.5), imports=("numpy", "scipy.linalg", "sympy")) as answer:
        assert answer.ask("f", [()]) == [1]


def test_what_it_says_is_the_same_in_every_run(walled):
    source = "import os\ndef f(): raise ValueError(object(), os.getcwd(), list(set('abcdefgh')))\n"
    said = set()
    for _ in range(3):
        with Sandbox(source, imports=()) as answer, pytest.raises(Stopped) as why:
            answer.ask("f", [()])
        said.add(str(why.value))
    assert len(said) == 1
    assert "<object object at 0x...>, '.'" in said.pop()


def test_what_is_left_of_the_time_is_not_said():
    source = "def f():\n    while True: pass\n"
    said = []
    with Sandbox(source, Limits(seconds=0.4, total=0.7), imports=()) as answer:
        for _ in range(3):
            with pytest.raises(Stopped) as why:
                answer.ask("f", [()])
            said.append(str(why.value))
    assert said[0].startswith("did not come back within 0.4 seconds")
    assert said[1:] == ["no time is left: the whole answer may take 0.7 seconds"] * 2


def test_python_may_be_started_by_a_path_with_dots(walled, monkeypatch):
    folder, name = os.path.split(sys.executable)
    monkeypatch.setattr(sys, "executable", f"{tempfile.gettempdir()}/../{folder.lstrip('/')}/{name}")
    with Sandbox("def f(): return 1", imports=()) as answer:
        assert answer.ask("f", [()]) == [1]


def test_libraries_can_still_be_imported():
    source = """
import numpy, sympy, mpmath, scipy.linalg, scipy.optimize, scipy.sparse.linalg, ctypes, random, time, decimal, concurrent.futures
import matplotlib.path
def f():
    A = numpy.diag([1.0, 2.0])
    root = scipy.optimize.brentq(lambda x: x * x - 2, 0, 2)
    return root, scipy.linalg.eigh(A)[0], sympy.sqrt(2), mpmath.mpf(2), scipy.sparse.csr_matrix(A), numpy.random.default_rng().normal()
"""
    with Sandbox(source) as answer:
        root, loads, exact, two, sparse, _ = answer.ask("f", [()])[0]
    assert root == pytest.approx(math.sqrt(2))
    assert list(loads) == [1.0, 2.0]
    assert (exact.text, two.text, sparse.shape) == ("sqrt(2)", "2.0", (2, 2))


# --- the kernel's locks, without the hook ----------------------------------------------------------------------------

NATIVE = """
import ctypes, os, sys
from rodlab.grading.locks import lock
own, parent, secret = sys.argv[1], os.getppid(), sys.argv[2]
held = lock([os.path.dirname(os.__file__), "/usr/lib"], [os.path.dirname(os.__file__) + "/json"], own)
libc = ctypes.CDLL(None, use_errno=True)
done = []
def tried(name, result):
    if result >= 0: done.append(name)
tried("fork", libc.fork()); tried("vfork", libc.syscall(58)); tried("clone3", libc.syscall(435, None, 0))
tried("exec", libc.execve(b"/bin/true", None, None))
tried("socket", libc.socket(1, 1, 0)); tried("kill", libc.kill(parent, 0)); tried("kill all", libc.kill(-1, 0))
tried("setowner", libc.fcntl(0, 8, parent)); tried("open", libc.open(secret.encode(), 0)); tried("proc", libc.open(b"/proc/self/maps", 0))
tried("mem", libc.open(b"/proc/%d/mem" % parent, 2)); tried("hidden", libc.open(os.fsencode(os.path.dirname(os.__file__)) + b"/json/decoder.py", 0))
tried("write", libc.open(b"/tmp/rodlab-escaped", 0o101, 0o600)); tried("shm", libc.open(b"/dev/shm/rodlab-escaped", 0o101, 0o600))
tried("symlink", libc.symlink(b"/etc", os.fsencode(own) + b"/etc")); tried("chmod", libc.chmod(secret.encode(), 0o777))
tried("mount", libc.mount(b"none", b"/mnt", b"tmpfs", 0, None)); tried("unshare", libc.unshare(0x10000000))
tried("ptrace", libc.ptrace(16, parent, 0, 0)); tried("setrlimit", libc.setrlimit(0, ctypes.create_string_buffer(bytes(16))))
tried("shmget", libc.shmget(0, 4096, 0o1600)); tried("memfd", libc.syscall(319, b"a", 0)); tried("ring", libc.syscall(425, 1, None))
import resource
resource.getrlimit(resource.RLIMIT_AS); os.kill(os.getpid(), 0)
with open(own + "/mine", "w") as file: file.write("a")
with open(own + "/mine") as file: assert file.read() == "a"
with open(os.__file__) as file: file.read(1)
print(",".join(held), "|", ",".join(done))
"""


@pytest.mark.skipif(not LINUX or os.uname().machine != "x86_64", reason="numbers of system calls")
def test_the_kernel_refuses_native_code(tmp_path):
    secret = tmp_path / "secret"
    secret.write_text("a")
    own = tmp_path / "own"
    own.mkdir()
    done = subprocess.run(
        [sys.executable, "-c", NATIVE, own, secret], capture_output=True, text=True, cwd=ROOT, timeout=20, check=False
    )
    held, _, succeeded = done.stdout.strip("\n").partition(" | ")
    if "files" not in held:
        pytest.skip(f"this kernel has only: {held}")
    assert (held, succeeded) == ("files,processes,network", ""), done.stderr


def test_it_dies_with_the_grader(tmp_path, walled):
    code = """if True:
        import os, sys, threading, time
        from rodlab.grading.sandbox import Sandbox
        answer = Sandbox("def f():\\n    while True: pass", imports=())
        threading.Timer(0.5, lambda: os.kill(os.getpid(), 9)).start()
        answer.ask("f", [()])
    """
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env={**os.environ, "TMPDIR": str(tmp_path)}, timeout=20, check=False
    )
    assert done.returncode == -signal.SIGKILL
    assert none_left(tmp_path)


def test_it_works_with_less_where_a_system_has_less():
    code = """if True:
        import os, sys
        import rodlab.grading.walls as walls
        walls.readable()
        sys.modules["resource"] = None
        del os.killpg
        sys.platform = "darwin"
        from rodlab.grading.guard import limit
        from rodlab.grading.locks import lock
        from rodlab.grading.sandbox import Sandbox
        assert limit(1, 1, 1) == ["CPU", "memory", "file size", "processes"]
        assert lock([], [], ".") == []
        walls.program.cache_clear()
        with Sandbox("def f(): return 1", imports=()) as answer:
            assert answer.ask("f", [()]) == [1]
    """
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, env={**os.environ, "RODLAB_BUBBLEWRAP": "no"}, check=True, timeout=20)


# --- values ----------------------------------------------------------------------------------------------------------

numbers = st.none() | st.booleans() | st.integers(-(2**1023), 2**1023) | st.floats() | st.text() | st.complex_numbers()
values = st.recursive(numbers, lambda x: st.lists(x, max_size=4) | st.dictionaries(st.text(), x, max_size=4), max_leaves=12)


def same(a, b):
    if isinstance(a, list | tuple):
        return isinstance(b, list) and len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, dict):
        return isinstance(b, dict) and list(a) == list(b) and all(same(a[key], b[key]) for key in a)
    if isinstance(a, complex):
        return same(a.real, b.real) and same(a.imag, b.imag)
    return type(a) is type(b) and (a == b or (a != a and b != b))


def through(x):
    import json

    return decode(json.loads(json.dumps(encode(x))), code=False)


@given(values)
def test_plain_values_come_back(x):
    assert same(x, through(x))


@given(st.lists(st.integers(0, 3), max_size=3), st.sampled_from([bool, int, np.int8, np.uint64, np.float32, float, complex]))
def test_arrays_come_back(shape, kind):
    x = np.arange(math.prod(shape)).reshape(shape).astype(kind)
    y = through(x)
    assert y.shape == x.shape
    assert np.all(x == y)


json_values = st.recursive(
    numbers.filter(lambda x: not isinstance(x, complex)),
    lambda x: (
        st.lists(x, max_size=3)
        | st.fixed_dictionaries(
            {}, optional=dict.fromkeys(("array", "shape", "imag", "complex", "dict", "expression", "code", "other"), x)
        )
    ),
    max_leaves=8,
)


@given(json_values)
@example({"array": [], "shape": [10**12, 0]})
@example({"array": [[1, 2]], "shape": [2]})
@example({"dict": [[[1], 2]]})
@example({"code": "1"})
def test_what_was_not_encoded_is_a_value_or_refused(x):
    try:
        found = decode(x, code=False)
    except (ValueError, TypeError, OverflowError):
        return
    left = [found]
    while left:
        y = left.pop()
        assert y is None or type(y) in (bool, int, float, str, complex, list, dict, np.ndarray, Written, Other)
        assert not isinstance(y, Code)
        left += y if isinstance(y, list) else y.values() if isinstance(y, dict) else []


WORDS = """x lam pi E I 0 1 2 9 9.5 1e400 9999999 ( ) ( ) , + - * / ** . [ ] : = == < if else lambda for in not and ~ % // @ 'a' f'{x}'
sin cos exp log sqrt Abs Rational atan2 __import__ __class__ ().__class__ eval open True None yield await \\ # ;"""
words = st.sampled_from([*WORDS.split(), "\n"])


@settings(max_examples=250)
@given(st.lists(words, max_size=12).map(" ".join) | st.text(max_size=20))
@example("9**9**9**9")
@example("exp(exp(exp(exp(9))))")
@example("(" * 200 + "x" + ")" * 200)
@example("-" * 9999 + "1")
@example("1+" * 9999 + "1")
@example("x**" * 5000 + "x")
@example("x" + "[0]" * 4000)
@example("sin(" * 90 + "x" + ")" * 90)
@example("0*9999999**9999999")
@example("9" * 5000)
@example("\0")
@example("\ud800")
@example("x if x else x")
@example("(lambda: 1)()")
@example("Rational(1, 0)")
@example("E**(E**(E**9))")
def test_a_formula_is_a_number_or_unreadable(text):
    start = time.monotonic()
    try:
        found = Formula(text, ("x", "lam")).at({"x": 0.5, "lam": 2.0})
    except Unreadable as why:
        assert "\n" not in str(why)
    else:
        allowed = ast.Name | ast.Constant | ast.BinOp | ast.UnaryOp | ast.Call | ast.operator | ast.unaryop | ast.expr_context
        assert all(isinstance(node, allowed) for node in ast.walk(ast.parse(text.strip(), mode="eval").body))
        assert type(found).__name__ in ("mpf", "mpc")
    assert time.monotonic() - start < 2.0
