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

from rodlab.lab.studies.asked import question_from
from rodlab.lab.studies.cells import Cell
from rodlab.lab.studies.every import method_named
from rodlab.lab.studies.questions import names, only, question_of, sizes_of
from rodlab.lab.studies.series import COSTS, COUNTED, Series, exponent
from rodlab.lab.table import known_to, small, table
from rodlab.numerics.arrays import whole

METHODS = ("strut, end", "strut, trapezoid", "rod, degree 1", "rod, degree 2", "rod, degree 3", "rod, degree 4")
ASKS = ("quantity", "mode", "lam", "K", "u_hat", "breaks", "methods", "joints", "intervals")
OF_MODEL = ("K", "u_hat", "breaks")
GROUP = ("quantity", "mode", "lam", "K", "u_hat")  # what one question of a table is known by


def cells(model: Mapping[str, Any], given: Mapping[str, Any], *, quick: bool = False) -> list[Cell]:
    """Every method at every size for every question. `ValueError`, in one sentence, for what is not of the form above."""
    short = given.get("quick", {}) if quick else {}
    only("convergence.quick", short, ("asks", "methods", "joints", "intervals"))
    only("model of a study", model, OF_MODEL)
    given_to_all, asks = {**given, **short}, given.get("ask")
    if not isinstance(asks, list) or not asks:
        raise ValueError(f"[[convergence.ask]] must be one table or more, each a question; it is {asks!r:.60}")
    if not isinstance(given.get("shapes", False), bool):
        raise ValueError(f"shapes must be true or false; it is {given['shapes']!r:.60}")
    stored = {"shape": True} if given.get("shapes") else {}
    found: dict[str, Cell] = {}
    for ask in asks[: whole("asks", short.get("asks", len(asks)), least=1)]:
        only("convergence.ask", ask, ASKS)
        own = {**model, **ask}
        question = question_of(own)
        for method in names(own.get("methods", given_to_all.get("methods", METHODS))):
            for size in sizes_of(method, {**given_to_all, **own}):
                asked = {"question": question, "method": method, "size": size, "repeats": 2, "memory": True, **stored}
                cell = Cell("measured:one", asked)
                found.setdefault(cell.key, cell)
    return list(found.values())


def series(cells: Sequence[Cell], results: Sequence[Mapping[str, Any]]) -> list[Series]:
    """The answers by question and method, in the order in which they were asked; Richardson's columns after their strut's."""
    groups: dict[str, list[tuple[Cell, Mapping[str, Any]]]] = {}
    for cell, result in zip(cells, results, strict=True):
        asked = Cell("", {name: cell.given[name] for name in ("question", "method")})
        groups.setdefault(asked.key, []).append((cell, result))
    found: list[Series] = []
    for group in groups.values():
        given = group[0][0].given
        if method_named(given["method"]).order is not None:  # tolerances stay as they are, coarse to fine
            group.sort(key=lambda pair: float(pair[0].given["size"]))
        sizes = tuple(cell.given["size"] for cell, _ in group)
        one = Series(question_from(given["question"]), given["method"], sizes, tuple(result for _, result in group))
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
    told["cost"] = one.growth
    return told


def text(found: Mapping[str, Any]) -> str:
    """One table a question: orders, floors, limits, growth."""
    parts = []
    for _, group in groupby(found["orders"], key=question_key):
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
        growths = ["" if "Richardson" in row["method"] else exponent(row["cost"], what) for what in COSTS]
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
    answered = {(row["method"], question_key(row)) for row in found["rows"] if "value" in row}
    return all((row["method"], question_key(row)) in answered for row in found["rows"]) and not found["crashed"]


def question_key(row: Mapping[str, Any]) -> tuple[Any, ...]:
    """What tells one question of a table from another: a row's entries of GROUP."""
    return tuple(row[name] for name in GROUP)
