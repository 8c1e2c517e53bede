"""A class of students for tests and benchmarks: right, mistaken, unanswered, broken and hostile submissions, by a seed."""

import random
from pathlib import Path

from rodlab.lab.teaching.taught import taught

ROOT = Path(__file__).parents[1]
TEACHER = sorted((ROOT / "exercises" / "teacher").glob("*.py"))
HOSTILE = sorted((ROOT / "tests" / "hostile").glob("*.py"))
BROKEN = ("def hessian(phi, lam:\n", "import os\nos._exit(0)\n", "while True:\n    pass\n", "raise SystemExit\n", "\x00")


def write_class(folder, count, *, exercises=None, broken=0, seed=0):
    """`count` submissions STUDENT/EXERCISE/answer.py, of which the first `broken` are broken; returns what each is."""
    draw, kinds = random.Random(seed), {}
    files = [path for path in TEACHER if exercises is None or path.stem in exercises]
    found = [taught(path) for path in files]
    for i in range(count):
        own = found[i % len(found)]
        student = f"student-{i // len(found):03}"
        if i < broken:
            kind, source = "broken", BROKEN[i % len(BROKEN)]
        else:
            kind = draw.choices(["right", "mistake", "stub"], [5, 4, 1])[0]
            mistaken = list(own.mistaken().values())
            likely = draw.choices(mistaken, [1 / (k + 1) ** 2 for k in range(len(mistaken))])[0]  # some are more frequent
            source = {"right": own.reference, "stub": own.stub}.get(kind, likely)
        path = Path(folder) / student / own.name / "answer.py"
        path.parent.mkdir(parents=True)
        path.write_text(f"# rodlab exercise: {own.name}\n{source}")
        kinds[student, own.name] = kind
    return kinds
