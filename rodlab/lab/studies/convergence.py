"""The study of convergence: any quantity against n or the mesh, each method's order, floor and limit, the truth beside it.

[convergence]                                   [[convergence.ask]]        [model]
methods = ["strut, end", "rod, degree 2"]       quantity = "tip_angle"     K = "1 + s"
joints = [16, 32, 64]                           mode = 1                   u_hat = 0.0
intervals = [6, 8, 12]                          lam = 5.0
quick = {asks = 2, methods = [...]}             methods, joints, intervals, u_hat, K: of this question alone
shapes = true                                   --quick asks the first questions only, of these methods
"""

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

from rodlab.lab.studies.asked import QUANTITIES, Question
from rodlab.lab.studies.cells import Cell
from rodlab.lab.studies.every import method_named
from rodlab.lab.studies.series import COUNTED, Series, exponent
from rodlab.lab.table import known_to, small, table
from rodlab.mechanics.expression import Expression
from rodlab.numerics.arrays import number, whole

JOINTS, INTERVALS = tuple(2**i for i in range(4, 15)), (6, 8, 10, 12, 16, 24, 32, 48, 64)
METHODS = ("strut, end", "strut, trapezoid", "rod, degree 1", "rod, degree 2", "rod, degree 3", "rod, degree 4")
ASKS = ("quantity", "mode", "lam", "K", "u_hat", "breaks", "methods", "joints", "intervals")
OF_MODEL = ("K", "u_hat", "breaks")
GROUP = ("quantity", "mode", "lam", "K", "u_hat")  # what one question of a table is known by


def cells(model: Mapping[str, Any], given: Mapping[str, Any], *, quick: bool = False) -> list[Cell]:
    """Every method at every size for every question. `ValueError`, in one sentence, for what is not of the form above."""
    short = given.get("quick", {}) if quick else {}
    only("convergence.quick", short, ("asks", "methods", "joints", "intervals"))
    given_to_all, asks = {**given, **short}, given.get("ask")
    if not isinstance(asks, list) or not asks:
        raise ValueError("convergence must ask at least one question, [[convergence.ask]]")
    found = []
    stored = {"shape": True} if given.get("shapes") else {}
    for ask in asks[: short.get("asks")]:
        only("convergence.ask", ask, ASKS)
        own = {**{name: model[name] for name in OF_MODEL if name in model}, **ask}
        question = question_of(own)
        for method in names(own.get("methods", given_to_all.get("methods", METHODS))):
            for size in sizes_of(method, {**given_to_all, **own}):
                cell = {"question": question, "method": method, "size": size, "repeats": 2, "memory": True, **stored}
                found.append(Cell("measured:one", cell))
    return found


def question_of(given: Mapping[str, Any]) -> dict[str, Any]:
    """A question as plain data, checked."""
    quantity = given.get("quantity")
    if quantity not in QUANTITIES:
        raise ValueError(f"quantity must be one of {', '.join(QUANTITIES)}; it is {quantity!r:.60}")
    question: dict[str, Any] = {"quantity": quantity, "mode": whole("mode", given.get("mode", 1), least=1)}
    if quantity != "load":
        if "lam" not in given or given["lam"] is None:
            raise ValueError(f"lam must be given for the quantity {quantity}; it is missing")
        question["lam"] = number("lam", given["lam"])
    for name in ("K", "u_hat"):
        if name in given:
            question[name] = Expression(given[name]).text if isinstance(given[name], str) else number(name, given[name])
    if given.get("breaks"):
        question["breaks"] = [number("breaks", b) for b in given["breaks"]]
    if question["mode"] > 1 and question.get("u_hat", 0.0) != 0:
        raise ValueError(f"mode must be 1 with an unstressed curvature, whose branch has no number; it is {question['mode']}")
    if quantity == "fold" and question.get("u_hat", 0.0) == 0:
        raise ValueError("u_hat must not be 0 for the quantity fold: the branch of a straight rod has none; it is 0")
    if quantity in ("load", "index") and question.get("u_hat", 0.0) != 0:
        raise ValueError(
            f"u_hat must be 0 for the quantity {quantity}, that of the straight rod; it is {question['u_hat']!r:.60}"
        )
    return question


def sizes_of(method: str, given: Mapping[str, Any]) -> list[float]:
    """The sizes that are given for a method, or its own."""
    known = method_named(method)
    if known.order is None:
        return list(known.sizes)
    name, usual = ("joints", JOINTS) if method.startswith("strut") else ("intervals", INTERVALS)
    sizes = given.get(name, usual)
    if not isinstance(sizes, (list, tuple)) or not sizes:
        raise ValueError(f"{name} must be a list of numbers; it is {sizes!r:.60}")
    return sorted(whole(name, size, least=1) for size in sizes)


def series(cells: Sequence[Cell], results: Sequence[Mapping[str, Any]]) -> list[Series]:
    """The answers by question and method, in the order in which they were asked; Richardson's columns after their strut's."""
    found: list[Series] = []
    pairs = list(zip(cells, results, strict=True))
    for _, group in groupby(pairs, key=lambda pair: Cell("", {k: pair[0].given[k] for k in ("question", "method")}).key):
        own = list(group)
        given = own[0][0].given
        question = Question(**{**given["question"], "breaks": tuple(given["question"].get("breaks", ()))})
        one = Series(question, given["method"], tuple(cell.given["size"] for cell, _ in own), tuple(result for _, result in own))
        found += [one, *one.extrapolated]
    return found


def answer(cells: Sequence[Cell], results: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """{"rows": one a cell, "orders": one a question and method}: everything that tables, pictures and files are made of."""
    every = series(cells, results)
    rows, orders = [row for one in every for row in rows_of(one)], [summary(one) for one in every]
    return {"rows": rows, "orders": orders, "crashed": sum("crashed" in found for found in results)}


def rows_of(one: Series) -> list[dict[str, Any]]:
    """Tidy: one answer a row, what failed among them."""
    about, local = _about(one), iter(one.observed.local)
    since, good = one.observed.floor_from, [size for size, _ in one.good]
    rows = []
    for size, found in zip(one.sizes, one.results, strict=True):
        if "failed" in found:
            rows.append({**about, "size": size, "note": found["failed"]})
            continue
        at_floor = since is not None and size >= good[since]
        rows.append(
            {
                **about, "size": size, **{k: found[k] for k in ("unknowns", "value", "truth", "truth_error", "error")},
                "order": next(local), "at_floor": at_floor, "bound": found["bound"], "claimed": found["claimed"],
                "note": found["note"], "cost": found["cost"],
            }
        )  # fmt: skip
    return rows


def _about(one: Series) -> dict[str, Any]:
    q = one.question
    return {"quantity": q.quantity, "mode": q.mode, "lam": q.lam, "K": q.K, "u_hat": q.u_hat, "method": one.method}


def summary(one: Series) -> dict[str, Any]:
    """What one method's answers say together."""
    seen, limit = one.observed, one.limit
    sizes = [size for size, _ in one.good]
    truth = one.good[0][1] if one.good else {}
    known = {name: truth.get(name) for name in ("truth", "source", "truth_error")}
    told: dict[str, Any] = {
        **_about(one), "theory": one.order, "order": seen.order, "uncertainty": seen.uncertainty, "clear": seen.clear,
        "from": None if seen.first is None else sizes[seen.first], "to": None if seen.last is None else sizes[seen.last],
        "floor": one.floor or None, **known,
    }  # fmt: skip
    if limit is not None:
        told |= {"limit": limit.value, "limit_estimate": limit.estimate, "limit_error": abs(limit.value - told["truth"])}
    if one.question.quantity == COUNTED:
        told["settled_from"] = one.settled_from
    told["failed"] = len(one.failed)
    told["cost"] = {
        f"{name}_{what}": value for what in ("solve", "peak_bytes") for name, value in one.grows(what)._asdict().items()
    }
    return told


def names(methods: Any) -> list[str]:
    """Names of methods, checked."""
    if not isinstance(methods, (list, tuple)) or not methods or not all(isinstance(name, str) for name in methods):
        raise ValueError(f"methods must be a list of names; it is {methods!r:.60}")
    for name in methods:
        method_named(name)
    return list(methods)


def only(what: str, given: Any, known: Sequence[str]) -> None:
    """`ValueError`, in one sentence, for a table with an entry that is not known."""
    wrong = sorted(set(given) - set(known)) if isinstance(given, Mapping) else [given]
    if wrong:
        raise ValueError(f"[{what}] takes {', '.join(known)}; {str(wrong[0])[:60]!r} is none of these")


def text(found: Mapping[str, Any]) -> str:
    """One table a question: orders, floors, limits, growth."""
    parts = []
    for _, group in groupby(found["orders"], key=_title_key):
        rows = list(group)
        parts.append(_counted(rows) if rows[0]["quantity"] == COUNTED else _converging(rows))
    failed = [row for row in found["rows"] if "value" not in row]
    parts += [f"failed: {row['method']}, size {row['size']:g}: {row['note']}" for row in failed]
    parts.append(
        "order: the last observed one, extrapolated; ~ where rounding leaves it open. sizes: those at which it is within 0.1.\n"
        "limit: Richardson's, with its estimate; off: its distance from the truth. time, memory: exponents in the unknowns;\n"
        "empty where overhead hides them (work-precision goes further). Every answer is in the CSV."
    )
    return "\n\n".join(parts)


def _converging(rows: Sequence[Mapping[str, Any]]) -> str:
    columns = ["method", "theory", "order", "+-", "sizes", "limit", "+-", "off", "time", "memory", "floor"]
    cells: list[list[Any]] = []
    for row in rows:
        order = "" if row["order"] is None else f"{'' if row['clear'] else '~'}{row['order']:.{3 if row['clear'] else 1}f}"
        sizes = "" if row["from"] is None or not row["clear"] else f"{row['from']:g} .. {row['to']:g}"
        limit = ["", "", ""]
        if "limit" in row:
            limit = [known_to(row["limit"], row["limit_estimate"]), small(row["limit_estimate"]), small(row["limit_error"])]
        growths = ["" if "Richardson" in row["method"] else exponent(row["cost"], what) for what in ("solve", "peak_bytes")]
        theory = "" if row["theory"] is None else row["theory"]
        cells.append([row["method"], theory, order, small(row["uncertainty"]), sizes, *limit, *growths, row["floor"] or ""])
    return table(_title(rows[0]), columns, cells)


def _counted(rows: Sequence[Mapping[str, Any]]) -> str:
    cells: list[list[Any]] = [
        [row["method"], "never" if row["settled_from"] is None else f"{row['settled_from']:g}"] for row in rows
    ]
    return table(_title(rows[0]), ["method", "right from size"], cells)


def _title(row: Mapping[str, Any]) -> str:
    at = "" if row["quantity"] == "load" else f" at load {row['lam']:g}"
    of = "" if row["u_hat"] != 0 or row["quantity"] == COUNTED else f" of mode {row['mode']}"
    made = "".join(f", {name} = {row[name]}" for name, usual in (("K", 1.0), ("u_hat", 0.0)) if row[name] != usual)
    truth = "no truth" if row["truth"] is None else f"{row['truth']:.13g} +- {row['truth_error']:.0e} ({row['source']})"
    return f"{row['quantity'].replace('_', ' ').capitalize()}{of}{at}{made}: {truth}"


def complete(found: Mapping[str, Any]) -> bool:
    """True when every method answered some of its cells, and none crashed."""
    answered = {(row["method"], _title_key(row)) for row in found["rows"] if "value" in row}
    return all((row["method"], _title_key(row)) in answered for row in found["rows"]) and not found["crashed"]


def _title_key(row: Mapping[str, Any]) -> tuple[Any, ...]:
    return tuple(row[name] for name in GROUP)
