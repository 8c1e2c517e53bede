"""What a symbolic derivation costs: a kernel of the house derived anew, in a process that has not seen SymPy."""

from typing import Any

from rodlab.lab.fresh import in_fresh_process

SCRIPT = """
import json, sys, time
from rodlab.mechanics import kernels, terms
begin = time.perf_counter()
import sympy
imported = time.perf_counter()
from rodlab.mechanics.derive import derive
from rodlab.mechanics.limit import limit
both = (terms.BENDING, terms.END_LOAD)
start = time.perf_counter()
known = limit(both) if sys.argv[1] == "rod" else derive(both, weighted=sys.argv[2] == "trapezoid")
source = known.source
derived = time.perf_counter()
kernels._compiled(known, both)
seconds = {"import": imported - begin, "derive": derived - start, "compile": time.perf_counter() - derived}
print(json.dumps({"kernel": known.name, "functions": source.count("def "), "cost": seconds}))
"""


def derived(model: str, rule: str) -> dict[str, Any]:
    """Name and number of functions of the kernel; seconds of importing SymPy, of deriving and of compiling it."""
    return in_fresh_process(SCRIPT, model, rule)
