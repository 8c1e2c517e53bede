"""Where numbers are from: versions, machine, threads, seed, time."""

import hashlib
import os
import platform
import sys
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from rodlab.version import __version__

LIBRARIES = ("numpy", "scipy", "sympy", "mpmath", "matplotlib", "python-flint", "bifpy")
HOUSE = Path(__file__).parents[2]
SEED = 0  # of every generator of random numbers in a study


def provenance(jobs: str) -> dict[str, Any]:
    """Versions, machine, threads and seed of this run."""
    from threadpoolctl import threadpool_info

    libraries = {f"{own['internal_api']} {own.get('version') or ''}".strip() for own in threadpool_info()}
    return {
        "rodlab": __version__,
        "python": platform.python_version(),
        "versions": {name: found for name in LIBRARIES if (found := _version(name))},
        "linear_algebra": sorted(libraries),
        "system": platform.platform(),
        "machine": platform.machine(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "threads": 1,
        "jobs": jobs,
        "seed": SEED,
        "command": [Path(sys.argv[0]).name, *sys.argv[1:]],
        "at": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def fingerprint() -> str:
    """A name for all that numbers depend on besides the question: code, libraries, kind of machine."""
    parts = [__version__, platform.python_version(), platform.machine(), *(f"{name} {_version(name)}" for name in LIBRARIES)]
    named = hashlib.sha256("; ".join(parts).encode())
    for path in sorted(HOUSE.rglob("*.py")):
        if not path.stem.endswith("picture"):
            named.update(path.read_bytes())
    return named.hexdigest()[:16]


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _processor() -> str:
    """The processor's name, as far as the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.processor())
    except OSError:
        return platform.processor()
