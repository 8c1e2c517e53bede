"""What a scene costs, and what it is spared: the scene run in fresh processes, as it stands and with what it does not name.

    as named          model, branches, events: what the file asks for
    its picture       matplotlib, and drawing
    SymPy             the kernels derived anew, where shipped ones serve
    a weight q = 0    one term more in the energy of a strut: kernels of loads are read, and every Newton iteration computes it

Seconds are those of a whole process, the least of some runs; what something saves is what the process takes more with it.
"""

import sys
from collections.abc import Mapping
from typing import Any

from rodlab.lab.fresh import in_fresh_process
from rodlab.lab.running import answers_of, pictures
from rodlab.lab.scene import Scene, run, scene
from rodlab.lab.table import table

EXTRAS = {"picture": "its picture", "sympy": "SymPy's derivation", "weight": "a weight q = 0"}
PACKAGES = (
    "numpy", "scipy.linalg", "scipy.sparse", "scipy.optimize", "scipy.interpolate", "mpmath", "sympy", "matplotlib", "flint",
)  # fmt: skip
CHILD = """
import sys, time
begin = time.perf_counter()
import json
from rodlab.lab import account
print(json.dumps(account.once(sys.argv[1], sys.argv[2], begin)))
"""


def once(name: str, extra: str, begin: float) -> dict[str, Any]:
    """Run a scene in this process with one thing more, or with "nothing": seconds since `begin`, imports, kernels."""
    import time
    from dataclasses import replace

    chosen = scene(name)
    if extra == "weight":
        chosen = replace(chosen, model={**chosen.model, "terms": {**chosen.model.get("terms", {}), "self_weight": {"q": 0.0}}})
    if extra == "sympy":
        from rodlab.mechanics import standard

        standard.KERNELS.clear()
        standard.DENSITIES.clear()
    shown, answers = list(run(chosen)), answers_of(chosen)
    if extra == "picture":
        pictures(chosen, shown, answers)
    seconds = time.perf_counter() - begin
    there = [package for package in PACKAGES if package in sys.modules]
    return {"seconds": seconds, "imports": there, **_kernel(chosen)}


def _kernel(chosen: Scene) -> dict[str, Any]:
    """The kernel of the scene's model, and the seconds of a residual and a Jacobian with it."""
    import time

    import numpy as np

    from rodlab.mechanics.recipe import build

    if not chosen.model:
        return {"kernel": None, "iteration": None}
    model: Any = build(chosen.model)
    known: Any = model.kernel(1.0) if hasattr(model, "kernel") else None
    u, seconds = np.asarray(model.start(None)), []
    for _ in range(200):
        start = time.perf_counter()
        model.residual(u, 1.0)
        model.jacobian(u, 1.0)
        seconds.append(time.perf_counter() - start)
    return {"kernel": None if known is None else known.__name__, "iteration": min(seconds)}


def account(name: str, runs: int = 3) -> dict[str, Any]:
    """{"scene", "rows"}: as named first, then with each thing that the scene leaves out, with the seconds saved by that."""
    from rodlab.lab.studies.study import KINDS

    chosen = scene(name)
    if set(chosen.asks) & set(KINDS):
        raise ValueError(f"account must be asked of a scene that is no study, which tells its own costs; it is {name!r}")
    extras = [extra for extra in EXTRAS if _spared(chosen, extra)]
    rows = [{"with": "as named", **_least(name, "nothing", runs)}]
    rows += [{"with": EXTRAS[extra], **_least(name, extra, runs)} for extra in extras]
    for row in rows:
        row["saved"] = row["seconds"] - rows[0]["seconds"]
        row["more_imports"] = [package for package in row["imports"] if package not in rows[0]["imports"]]
    return {"scene": chosen.name, "runs": runs, "rows": rows}


def _spared(chosen: Scene, extra: str) -> bool:
    """Whether the scene is spared this: a strut without weight; anything that SymPy need not derive; any picture."""
    strut = chosen.model.get("model", "strut") == "strut" and bool(chosen.model)
    weighted = "self_weight" in chosen.model.get("terms", {})
    own_terms = bool(chosen.model.get("terms"))
    return {"picture": True, "sympy": bool(chosen.model) and not own_terms, "weight": strut and not weighted}[extra]


def _least(name: str, extra: str, runs: int) -> dict[str, Any]:
    """The quickest of the runs."""
    found = [in_fresh_process(CHILD, name, extra) for _ in range(runs)]
    return min(found, key=lambda one: float(one["seconds"]))


def account_table(found: Mapping[str, Any]) -> str:
    """The account as a person reads it."""
    lines: list[list[Any]] = []
    for row in found["rows"]:
        first = row is found["rows"][0]
        iteration = "" if row["iteration"] is None else f"{1e6 * row['iteration']:.0f}"
        imports = ", ".join(row["imports"]) if first else ", ".join(f"+ {package}" for package in row["more_imports"])
        saved = "" if first else f"{row['saved']:.2f}"
        lines.append([row["with"], f"{row['seconds']:.2f}", saved, iteration, row["kernel"] or "", imports])
    title = f"Scene {found['scene']}: what it costs, and what it is spared (whole processes, the least of {found['runs']})"
    return table(title, ["", "seconds", "saved", "F and J, us", "kernel", "imports"], lines)
