"""Grades of a class counted: exercise by exercise, and the classic mistakes by how often they were made."""

from collections.abc import Mapping, Sequence
from typing import Any


def summary(records: Sequence[Mapping[str, Any]]) -> tuple[Sequence[str], list[list[Any]]]:
    """Exercise by exercise: how many handed in, all points, mean, and the most frequent classic mistake."""
    rows: list[list[Any]] = []
    for name in sorted({r["exercise"] for r in records}):
        own = [r for r in records if r["exercise"] == name]
        counts = frequent(own)
        worst = f"{counts[0][0]} ({counts[0][1]})" if counts else None
        mean = sum(r["percent"] for r in own) / len(own)
        rows.append([name or "(no exercise)", len(own), sum(r["status"] == "right" for r in own), f"{mean:.0f} %", worst])
    return ("exercise", "handed in", "all right", "mean", "most frequent mistake"), rows


def frequent(records: Sequence[Mapping[str, Any]]) -> list[tuple[str, int]]:
    """The classic mistakes of these records, the most frequent first."""
    counts: dict[str, int] = {}
    for record in records:
        for name in filter(None, record["mistakes"].split("; ")):
            counts[name] = counts.get(name, 0) + 1
    return sorted(counts.items(), key=lambda entry: (-entry[1], entry[0]))
