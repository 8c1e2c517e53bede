"""Diagrams and equilibria as answers: what `--json` says of them, and the tables that a person reads."""

from collections import Counter
from typing import Any

from rodlab.analysis.diagram import Diagram, Special
from rodlab.lab.answers import of_branch, of_point
from rodlab.lab.equilibria import Equilibria
from rodlab.lab.table import known_to, small, table

ROWS = 40  # rows of a table of equilibria


def of_diagram(d: Diagram) -> dict[str, Any]:
    """Branches, special points and numbers of solutions, at full precision."""
    about = zip(d.branches, d.copies, d.components, strict=True)
    return {
        "window": d.window,
        "branches": [{**of_branch(b), "begin": b.begin, "images": copies, "component": c} for b, copies, c in about],
        "table": [_of_special(row) for row in d.table],
        "counts": [{"from": low, "to": high, "solutions": count} for low, high, count in d.counts],
        "complete": d.complete,
    }


def _of_special(row: Special) -> dict[str, Any]:
    return {
        "kind": row.kind, "lam": row.lam, "error": row.error, "branch": row.branch, "index": row.index,
        "multiplicity": row.multiplicity, "leaving": row.leaving, "reason": row.reason,
    }  # fmt: skip


def diagram_tables(title: str, d: Diagram) -> str:
    """Special points, and how many solutions there are between them."""
    rows: list[list[Any]] = []
    for row in d.table:
        change = " -> ".join("?" if i is None else str(i) for i in row.index)
        load, error = known_to(row.lam, max(row.error, 1e-15)), small(row.error)
        if row.kind == "end":
            change, error = ("?" if row.index[0] is None else str(row.index[0])), ""
        rows.append([row.branch, row.kind, load, error, change, ", ".join(map(str, row.leaving)), row.reason])
    parts = [table(title, ["branch", "", "load", "+-", "index", "leaving", "why"], rows)]
    number: list[list[Any]] = [[f"{low:.6f}", f"{high:.6f}", count] for low, high, count in d.counts]
    parts.append(table("Solutions, mirror images among them", ["from", "to", "number"], number))
    images = [i for i, copies in enumerate(d.copies) if copies > 1]
    said = f"{d!r}"
    if images:
        said += f"\nmirror images, counted and not listed: of the branches {', '.join(map(str, images))}"
    loose = [str(i) for i, c in enumerate(d.components) if c]
    if loose:
        said += f"\nnot connected to the start: the branches {', '.join(loose)}"
    return "\n\n".join([*parts, said])


def of_equilibria(found: Equilibria, *, connected: bool) -> dict[str, Any]:
    """Every equilibrium with its angles, index, energy, symmetry class and, if asked for, how it stands to the unstressed one."""
    entries, connected = [], connected and not found.unconnected
    for i, p in enumerate(found.points):
        entry = {"phi": p.u, **of_point(p), "symmetry": found.symmetry(i), "image": found.images[i]}
        entry.pop("accepted")
        entries.append({**entry, "standing": found.standing(i)} if connected else entry)
    about = {"certified": found.certified, "method": found.method, "reason": found.reason, "index_sum": found.index_sum}
    return {"equilibria": entries, "count": len(found), **about}


def equilibria_table(found: Equilibria, *, connected: bool) -> str:
    """The lowest energies first; what is certified, and the sum that it must have."""
    rows: list[Any] = []
    told = connected and not found.unconnected
    for i, p in enumerate(found.points[:ROWS]):
        index = f"{p.index}" + ("" if p.index_verified else "?")
        row: list[Any] = [i, known_to(p.tip_angle, p.error), f"{p.energy:.9f}", f"{p.height:.6f}", index, found.symmetry(i)]
        rows.append([*row, *([found.standing(i)] if told else [])])
    columns = ["", "tip angle", "energy", "height", "index", "symmetry", *(["stands"] if told else [])]
    parts = [table(f"Equilibria of {found.strut!r} at lam = {found.lam:g}", columns, rows)]
    if len(found) > ROWS:
        parts.append(f"(the first {ROWS} of {len(found)})")
    by_index = Counter(p.index or 0 for p in found)
    said = ", ".join(f"{count} of index {index}" for index, count in sorted(by_index.items()))
    parts.append(f"{len(found)} in all: {said}; the sum of (-1)^index is {found.index_sum}")
    if connected:
        parts.append(_standing(found))
    parts.append(
        f"{'certified' if found.certified else 'not certified'}: {found.reason + '; ' if found.reason else ''}{found.method}"
    )
    return "\n".join(parts)


def _standing(found: Equilibria) -> str:
    if found.unconnected:
        return f"which are connected to the unstressed shape could not be told: {found.unconnected}"
    loose = len(found) - sum(found.connected)
    if not loose:
        return "all are connected to the unstressed shape"
    what = "parasites of the discretisation" if found.strut.is_straight else "cut off by the imperfection, or parasites"
    return f"{len(found) - loose} are connected to the unstressed shape; {loose} are not: {what}"
