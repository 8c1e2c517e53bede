"""The study of work and precision: one number by every method, its error against the time and the memory that it takes.

    [work-precision]                                ask = {quantity = "tip_angle", mode = 1, lam = 4.93}
    methods = ["strut, end", "rod, degree 4"]       repeats = 7         quick = {methods = [...], repeats = 3}

Three times stand apart: the derivation by SymPy, which is shipped for the standard terms and timed anew in a fresh process; the
set-up, once a model; the solve, the least and the median of repeats. Every method begins at the same modest guess.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from rodlab.lab.studies.asked import question_from
from rodlab.lab.studies.cells import Cell
from rodlab.lab.studies.convergence import OF_MODEL, rows_of, series, summary
from rodlab.lab.studies.every import HOUSE, method_named, others, rivals
from rodlab.lab.studies.questions import names, only, question_of, sizes_of
from rodlab.lab.studies.series import COSTS, exponent
from rodlab.lab.table import small, table
from rodlab.numerics.arrays import whole

USUAL = ("strut, end", "strut, trapezoid", "rod, degree 2", "rod, degree 4", "rod, degree 8", "rod, adapted")
COLUMNS = (
    "method", "order", "least error", "at size", "unknowns", "set-up ms", "solve ms", "median", "peak MB", "time", "memory",
)  # fmt: skip
DECADES = tuple(10.0**-i for i in range(2, 14))
NEARLY = 1.25  # ratio of times that is not told apart
DERIVED = (("strut", "end"), ("strut", "trapezoid"), ("rod", ""))  # kernels: model and rule


def cells(model: Mapping[str, Any], given: Mapping[str, Any], *, quick: bool = False) -> list[Cell]:
    """Every method at every size, the house's derivations, and, where asked for, the peers that are there."""
    short = given.get("quick", {}) if quick else {}
    only("work-precision.quick", short, ("methods", "repeats"))
    only("model of a study", model, OF_MODEL)
    own = {**given, **short}
    only("work-precision.ask", own.get("ask", {}), ("quantity", "mode", "lam", *OF_MODEL))
    question = {**question_of({**model, **own.get("ask", {})}), "guess": "modest"}
    repeats = whole("repeats", own.get("repeats", 5), least=1)
    found = [Cell("derivations:derived", {"model": kind, "rule": rule}) for kind, rule in DERIVED]
    for name in _asked(own.get("methods"), question, peers=bool(given.get("peers"))):
        for size in _sizes(name, own, quick=quick):
            cell = {"question": question, "method": name, "size": size, "repeats": repeats, "memory": not name.startswith("AUTO")}
            found.append(Cell("measured:one", cell))
    return found


def _asked(given: Any, question: Mapping[str, Any], *, peers: bool) -> list[str]:
    """The methods named, or all; the others and the peers know only the tip angle of the uniform rod."""
    uniform = question["quantity"] == "tip_angle" and question_from(question).uniform
    listed = names(given) if given else [*USUAL, *(method.name for method in others())]
    every = [*listed, *(method.name for method in rivals() if peers)]
    able = [name for name in every if name.startswith(HOUSE) or uniform]
    if not able:
        raise ValueError(f"methods must be struts or rods but for the tip angle of a uniform rod; they are {', '.join(every)}")
    return able


def _sizes(name: str, given: Mapping[str, Any], *, quick: bool) -> Sequence[float]:
    method = method_named(name)
    if method.missing:
        return method.sizes[:1]  # one row that says what is missing
    if method.order is not None and ("joints" if name.startswith("strut") else "intervals") in given:
        return sizes_of(name, given)
    return method.quick if quick else method.sizes


def answer(cells: Sequence[Cell], results: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """{"rows", "methods", "best", "derivations", "sentence"}."""
    pairs = list(zip(cells, results, strict=True))
    derived = [{**cell.given, **found} for cell, found in pairs if cell.function == "derivations:derived"]
    solved = [(cell, found) for cell, found in pairs if cell.function == "measured:one"]
    every = series([cell for cell, _ in solved], [found for _, found in solved])
    rows = [row for one in every for row in rows_of(one)]
    peers = {method.name for method in rivals()}
    closed = {method.name for method in others() if len(method.sizes) == 1}
    best = [_best(rows, wanted, peers, closed) for wanted in DECADES]
    methods = [{**summary(one), "least_error": min(one.column("error"), default=None)} for one in every]
    told = [entry for entry in best if entry["cost"]["method"]]
    crashed = sum("crashed" in found for found in results)
    tables = {"rows": rows, "methods": methods, "best": told, "derivations": derived}
    return {**tables, "crashed": crashed, "cost": {"sentence": sentence(told)}}


def _best(rows: Sequence[Mapping[str, Any]], wanted: float, peers: set[str], closed: set[str]) -> dict[str, Any]:
    """The fastest answer with an error of at most `wanted`, those nearly as fast, and the fastest peer.

    A closed form, which knows one rod only, is not among ours.
    """
    good = [row for row in rows if "value" in row and row["error"] <= wanted]
    ours = sorted((row for row in good if row["method"] not in peers | closed), key=_seconds)
    theirs = sorted((row for row in good if row["method"] in peers), key=_seconds)
    first = ours[0] if ours else None
    told: dict[str, Any] = {"method": None, "size": None, "solve": None}
    if first is not None:
        told = {"method": first["method"], "size": first["size"], "solve": _seconds(first)}
    near = [row["method"] for row in ours if first and _seconds(row) <= NEARLY * _seconds(first)]
    told["nearly"] = [name for name in dict.fromkeys(near) if name != told["method"]]
    told |= {"peer": theirs[0]["method"] if theirs else None, "peer_solve": _seconds(theirs[0]) if theirs else None}
    return {"error": wanted, "cost": told}


def _seconds(row: Mapping[str, Any]) -> float:
    return float(row["cost"]["solve"])


def sentence(best: Sequence[Mapping[str, Any]]) -> str:
    """Which method to use for which accuracy: neighbouring decades with one answer are one clause."""
    clauses: list[tuple[str, list[Mapping[str, Any]]]] = []
    for entry in best:
        if not clauses or clauses[-1][0] != entry["cost"]["method"]:
            clauses.append((entry["cost"]["method"], []))
        clauses[-1][1].append(entry)
    if not clauses:
        return "No method reached an error of 1e-2."
    return "For an error of " + "; ".join(f"{_span(entries)} {name} ({_times(entries)})" for name, entries in clauses) + "."


def _span(entries: Sequence[Mapping[str, Any]]) -> str:
    first, last = entries[0]["error"], entries[-1]["error"]
    return f"{first:.0e} use" if first == last else f"{first:.0e} to {last:.0e} use"


def _times(entries: Sequence[Mapping[str, Any]]) -> str:
    first, last = (f"{1e3 * entries[i]['cost']['solve']:.2g}" for i in (0, -1))
    return f"{first} ms" if first == last else f"{first} to {last} ms"


def text(found: Mapping[str, Any]) -> str:
    """Methods with what they reach and how they grow, the fastest for every accuracy, and the derivations."""
    lines: list[list[Any]] = []
    for row in found["methods"]:
        own = [r for r in found["rows"] if r["method"] == row["method"] and "value" in r]
        if not own:
            continue
        finest = min(own, key=lambda r: (r["error"], _seconds(r)))
        cost = finest["cost"]
        peak = "" if cost["peak_bytes"] is None else f"{cost['peak_bytes'] / 1e6:.2g}"
        order = "" if not row["clear"] else f"{row['order']:.2f}"
        times = [f"{1e3 * cost[name]:.2f}" for name in ("setup", "solve", "median")]
        growths = [exponent(row["cost"], what) for what in COSTS]
        size = [f"{finest['size']:g}", finest["unknowns"]]
        lines.append([row["method"], order, small(row["least_error"]), *size, *times, peak, *growths])
    first = next((row for row in found["rows"] if "truth" in row), None)
    title = "" if first is None else f"{first['quantity'].replace('_', ' ').capitalize()}: {first['truth']:.15g}"
    parts = [table(title, COLUMNS, lines)]
    parts.append(_fastest(found["best"]))
    parts.append(_derivations(found["derivations"]))
    left = dict.fromkeys(f"{row['method']}: {row['note']}" for row in found["rows"] if "value" not in row)
    left |= dict.fromkeys(f"derivation: {row['failed']}" for row in found["derivations"] if "failed" in row)
    return "\n\n".join([*parts, *left, str(found["cost"]["sentence"])])


def _fastest(best: Sequence[Mapping[str, Any]]) -> str:
    lines: list[list[Any]] = []
    for entry in best:
        cost = entry["cost"]
        peer = [cost["peer"] or "", "" if cost["peer_solve"] is None else f"{1e3 * cost['peer_solve']:.2f}"]
        ours = [f"{entry['error']:.0e}", cost["method"], f"{cost['size']:g}", f"{1e3 * cost['solve']:.2f}"]
        lines.append([*ours, "; ".join(cost["nearly"]), *peer])
    return table("The fastest for an error of at most", ["error", "method", "size", "ms", "nearly as fast", "peer", "ms"], lines)


def _derivations(rows: Sequence[Mapping[str, Any]]) -> str:
    lines: list[list[Any]] = [
        [row["kernel"], row["functions"], *(f"{1e3 * row['cost'][name]:.0f}" for name in ("import", "derive", "compile"))]
        for row in rows
        if "failed" not in row
    ]
    title = "Kernels, shipped, derived anew in a fresh process (ms)"
    return table(title, ["kernel", "functions", "import SymPy", "derive", "compile"], lines)


def complete(found: Mapping[str, Any]) -> bool:
    """True when every cell was answered, or says what is missing or why it is not an answer."""
    return not found["crashed"]
