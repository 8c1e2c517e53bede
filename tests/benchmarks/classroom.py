"""Speed of grading a class, against the limit of its kind: starting one Python that imports numpy.

    python tests/benchmarks/classroom.py [--quick] [--picture FILE]

200 submissions of all exercises (right, mistaken, unanswered, 10 of them broken), each in its own process, two at a time; then
the same killed half way and resumed: the tables must be equal to the last byte. Quick: 40 submissions. The picture is that of
the class.
"""

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from classes import TEACHER, write_class
from newton_and_index import paired

from rodlab.lab.teaching.course import check, check_source, exercise
from rodlab.lab.teaching.taught import taught

MOST = 300.0  # seconds for 200 submissions on 2 cores


def one_answer():
    """One submission in a process, in this process, and a bare Python with numpy."""
    source = taught(next(path for path in TEACHER if path.stem == "two-joints")).reference
    names, asked = {}, exercise("two-joints")
    exec(source, names)

    def bare():
        subprocess.run([sys.executable, "-I", "-c", "import numpy"], check=True)

    ratio, apart = paired(lambda: check_source(asked, source, seed=1), bare, 7)
    _, here = paired(lambda: check("two-joints", names, seed=1), bare, 7)
    print(f"one submission: {1e3 * apart:.0f} ms, {ratio:.2f} times a bare Python with numpy")
    print(f"                judged in this process, as a notebook does: {1e3 * here:.1f} ms")


def main():
    """Print seconds; exit code 1 when 200 submissions take longer than 5 minutes, or a resumed run differs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="40 submissions")
    parser.add_argument("--picture", help="where to keep the picture of the class")
    asked = parser.parse_args()
    count = 40 if asked.quick else 200
    one_answer()
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        write_class(here / "class", count, broken=count // 20, seed=1)
        command = [sys.executable, "-m", "rodlab", "check", "--class", str(here / "class"), "--seed", "7", "--jobs", "2", "--out"]
        start = time.perf_counter()
        done = subprocess.run([*command, str(here / "whole")], check=True, stdout=subprocess.PIPE, text=True)
        whole = time.perf_counter() - start
        print(done.stdout.split("  /")[0])
        print(f"{count} submissions, 2 at a time: {whole:.1f} s, {whole / count:.2f} s each (limit for 200: {MOST:g} s)")
        process = subprocess.Popen([*command, str(here / "killed")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(whole / 2)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        subprocess.run([*command, str(here / "killed")], check=True, stdout=subprocess.DEVNULL)
        tables = ("grades.csv", "students.csv", "mistakes.png")
        same = all((here / "whole" / name).read_bytes() == (here / "killed" / name).read_bytes() for name in tables)
        print(f"killed after {whole / 2:.1f} s and resumed: the tables are {'the same' if same else 'NOT THE SAME'}")
        if asked.picture:
            Path(asked.picture).parent.mkdir(parents=True, exist_ok=True)
            Path(asked.picture).write_bytes((here / "whole" / "mistakes.png").read_bytes())
    sys.exit(int(not same or whole > MOST * count / 200))


if __name__ == "__main__":
    main()
