"""The stability study: stiff and extreme cases, each judged against its truth, and naive formulas beside ours.

grid (TOML) -> cells -> results (`cases`, `contrasts`) -> summary -> tables. What it must show: no silent wrong cell, that is, no
answer whose true error exceeds the error it claims. Verdicts: `rodlab.lab.studies.judge`.
"""

import math
import statistics
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rodlab.lab.studies import grid
from rodlab.lab.studies.cells import Cell
from rodlab.lab.studies.judge import NAIVE, VERDICTS
from rodlab.lab.studies.series import COSTS, exponent, growth_of
from rodlab.lab.table import small, table

Row = Mapping[str, Any]
TITLES = {
    "loads": "Buckling loads of straight struts", "equilibrium": "Equilibria of struts: tip angle and index",
    "index": "Index next to a buckling load, lam = load (1 + off)", "layer": "Layers: rods held straight, bent at the free end",
    "elastica": "Far post-buckled: rods against elliptic functions", "rod_loads": "Buckling loads of rods across jumps of K",
    "contrast": "Ours, where a naive formula stands beside it",
}  # fmt: skip
LEFT = "failed"  # a cell that gave no verdict


def cells(_model: Mapping[str, Any], given: Mapping[str, Any], *, quick: bool = False) -> list[Cell]:
    """The cells of the declared grid; see `rodlab.lab.studies.grid`."""
    return [Cell(kind, arguments) for kind, arguments in grid.cells(given, quick=quick)]


def answer(asked: Sequence[Cell], results: Sequence[Row]) -> dict[str, Any]:
    """{"rows": one a cell, ...the summary}."""
    rows = [
        {"verdict": LEFT, "kind": "contrast" if ":contrast" in cell.function else cell.function.partition(":")[2], "group": LEFT,
         "case": cell.key, "why": result[LEFT], **result} if LEFT in result else dict(result)
        for cell, result in zip(asked, results, strict=True)
    ]  # fmt: skip
    return {"rows": rows, **summary(rows)}


def complete(found: Mapping[str, Any]) -> bool:
    """False when an answer is wrong without saying so, or a cell gave no verdict."""
    return not found["wrong"] and not found["verdicts"].get(LEFT)


# --- summary ---------------------------------------------------------------------------------------------------------


def summary(results: Sequence[Row]) -> dict[str, Any]:
    """Counts of verdicts, the worst of each group, what is wrong, what was refused, contrasts; seconds against n under "cost"."""
    beside = [row for row in results if "naive_verdict" in row]
    kinds = _grouped(results, "kind", "group")
    return {
        "verdicts": _counts(results, "verdict", (*VERDICTS, LEFT)), "naive": _counts(beside, "naive_verdict", NAIVE),
        "groups": [_worst(kind, group, rows) for (kind, group), rows in kinds.items()],
        "wrong": [dict(row) for row in results if row["verdict"] == "WRONG"],
        "refusals": _refusals(results),
        "contrasts": [dict(row) for row in _contrasts(beside)],
        "cost": {"growth": _growth(results)},
    }  # fmt: skip


def _counts(rows: Sequence[Row], name: str, known: Iterable[str]) -> dict[str, int]:
    seen = Counter(row[name] for row in rows)
    return {verdict: seen[verdict] for verdict in known if verdict != LEFT or seen[verdict]}


def _worst(kind: str, group: str, rows: Sequence[Row]) -> dict[str, Any]:
    """A group's verdicts, and its verified answer with the largest true error for its kind."""
    judged = [row for row in rows if row["verdict"] in ("right", "loose", "WRONG")]
    worst = max(judged, key=lambda row: (row["verdict"] == "WRONG", row["forward"], row["condition"]), default=None)
    named = () if worst is None else ("case", "asks", "condition", "backward", "forward", "claimed", "digits")
    counts = _counts(rows, "verdict", (*VERDICTS, LEFT))
    hardest = max((row["condition"] for row in rows if math.isfinite(row.get("condition", math.nan))), default=math.nan)
    return {"kind": kind, "group": group, "cells": len(rows), **counts, "hardest": hardest} | {
        name: worst[name] for name in named if worst
    }


def _refusals(results: Sequence[Row]) -> list[dict[str, Any]]:
    """Each sentence once, with how often it was said and the first case."""
    said = _grouped([row for row in results if row["verdict"] in ("refused", LEFT)], "verdict", "why")
    return [
        {"verdict": verdict, "why": why, "times": len(rows), "case": rows[0]["case"]} for (verdict, why), rows in said.items()
    ]


def _contrasts(beside: Sequence[Row]) -> list[Row]:
    """Every contrast that was asked for; of those that stand beside every cell the worst of each group."""
    asked = [row for row in beside if row["kind"] == "contrast"]
    others = _grouped([row for row in beside if row["kind"] != "contrast" and row["verdict"] != "refused"], "kind", "group")
    return [max(rows, key=lambda row: row["naive_forward"]) for rows in others.values()] + asked


def _growth(results: Sequence[Row]) -> list[dict[str, Any]]:
    """Median seconds and memory of our answers by n, and for each kind the exponents in n that they grow with."""
    found: list[dict[str, Any]] = []
    timed = [row for row in results if row.get("n") and "solve" in row.get("cost", {}) and row["kind"] != "contrast"]
    for (kind,), rows in _grouped(timed, "kind").items():
        sizes = sorted({row["n"] for row in rows})
        told: dict[str, Any] = {"kind": kind, "n": sizes}
        for what in COSTS:
            known = {n: [row["cost"][what] for row in rows if row["n"] == n and row["cost"][what]] for n in sizes}
            medians = {n: statistics.median(known[n]) if known[n] else None for n in sizes}
            told |= {what: list(medians.values()), **growth_of(medians, what)}
        found.append(told)
    return found


def _grouped(rows: Sequence[Row], *names: str) -> dict[tuple[str, ...], list[Row]]:
    found: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        found.setdefault(tuple(str(row[name]) for name in names), []).append(row)
    return found


# --- text ----------------------------------------------------------------------------------------------------------------


def text(found: Mapping[str, Any]) -> str:
    """The tables that a person reads: verdicts by group, refusals, contrasts, seconds against n."""
    parts = [_said(found)]
    parts += [_groups(title, [row for row in found["groups"] if row["kind"] == kind]) for kind, title in TITLES.items()]
    parts += [_sentences(found["refusals"]), _beside(found["contrasts"]), _seconds(found["cost"]["growth"])]
    return "\n\n".join(part for part in parts if part)


def _said(found: Mapping[str, Any]) -> str:
    ours, naive = (", ".join(f"{count} {name}" for name, count in found[who].items() if count) for who in ("verdicts", "naive"))
    wrong = [
        f"  WRONG: {row['case']}: {row['asks']} is {row['answer']!r}, truth {row['truth']!r}, claimed {row['claimed']:.1e}"
        for row in found["wrong"]
    ]
    silent = "\n".join(wrong) if wrong else "  No silent wrong cell."
    return f"Of {sum(found['verdicts'].values())} cells: {ours}.\n{silent}\nNaive formulas beside them: {naive}."


def _groups(title: str, rows: Sequence[Row]) -> str:
    columns = ["", "cells", *VERDICTS, "condition", "error", "claimed", "where the error is largest"]
    lines: list[list[Any]] = []
    for row in rows:
        worst = (
            [_size(row["forward"]), _size(row["claimed"]), f"{row['case']}: {row['asks']}"] if "forward" in row else [None] * 3
        )
        lines.append([row["group"], row["cells"], *(row[verdict] or None for verdict in VERDICTS), _size(row["hardest"]), *worst])
    return _table(title, columns, lines, 0, -1)


def _sentences(rows: Sequence[Row]) -> str:
    lines = [[row["verdict"], row["times"], row["case"]] for row in rows]
    noted = [entry for line, row in zip(lines, rows, strict=True) for entry in (line, [f"    {row['why']}"])]
    return _table("Refused: each sentence once", ["", "times", "first case"], noted, 0, 2)


def _beside(rows: Sequence[Row]) -> str:
    lines: list[list[Any]] = []
    shown = set()
    for lesson, own in _grouped(rows, "lesson").items():
        for row in own:
            group = row["group"] if row["kind"] == "contrast" else "loads from summed entries"
            first = "" if group in shown else group
            lines.append([first, row["case"], row["verdict"], small(row["forward"]), row["naive_verdict"], _naive(row)])
            shown.add(group)
        lines.append([f"    {lesson[0]}"])
    columns = ["contrast", "case", "ours", "error", "naive", "error"]
    return _table("Naive formulas beside ours", columns, lines, 0, 1, 2, 4, 5)


def _naive(row: Row) -> str:
    said = not math.isfinite(row["naive_forward"]) or row["naive_verdict"] == "never ends"
    return str(row["naive_why"]) if said else small(row["naive_forward"])


def _seconds(rows: Sequence[Row]) -> str:
    lines: list[list[Any]] = []
    for row in rows:
        for n, seconds, peak in zip(row["n"], row["solve"], row["peak_bytes"], strict=True):
            last = n == row["n"][-1]
            growths = [exponent(row, what) if last else "" for what in COSTS]
            memory = "" if peak is None else f"{peak / 1e6:.3g}"
            lines.append([row["kind"], n, f"{1e3 * seconds:.1f}", memory, *growths])
    title = "What an answer costs, its error and index with it: medians, and how they grow with n"
    return _table(title, ["", "n", "ms", "peak MB", "time", "memory"], lines, 0)


def _size(x: float) -> str | None:
    """An error of which only the size matters."""
    return None if math.isnan(x) else "0" if x == 0 else small(x)


def _table(title: str, columns: Sequence[str], lines: Sequence[Sequence[Any]], *left: int) -> str:
    """A table with some columns lined up on the left; nothing without lines."""
    full = [list(line) for line in lines if len(line) > 1]
    header = list(columns)
    for i in left:
        width = max((len(str(line[i] or "")) for line in [header, *full]), default=0)
        for line in [header, *full]:
            line[i] = str(line[i] or "").ljust(width)
    every = iter(full)
    return table(title, header, [next(every) if len(line) > 1 else line for line in lines]) if full else ""
