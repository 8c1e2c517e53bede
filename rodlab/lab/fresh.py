"""A process that has imported nothing: what an import, a derivation or a whole scene costs is told there."""

import json
import subprocess
import sys
from typing import Any


def in_fresh_process(script: str, *arguments: str) -> dict[str, Any]:
    """The JSON object that a script of ours prints. Raises `ArithmeticError` with its last words where it fails.

    >>> in_fresh_process("import json, sys; print(json.dumps({'numpy': 'numpy' in sys.modules}))")
    {'numpy': False}
    """
    done = subprocess.run([sys.executable, "-c", script, *arguments], capture_output=True, text=True, check=False)  # noqa: S603
    if done.returncode:
        raise ArithmeticError(f"a process of its own failed: {done.stderr.strip().rpartition(chr(10))[2]}")
    found: dict[str, Any] = json.loads(done.stdout)
    return found
