"""Reports as other programs read them: Gradescope's results.json, and the JSON of the command line."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from rodlab.grading.grade import Item, Report


def results(said: Mapping[str, Any], seconds: float | None = None) -> str:
    """Gradescope's results.json of a report's data: one test an item, those on fresh parameters hidden from the student."""
    content: dict[str, Any] = {
        "score": round(said["score"], 6),
        "output": "\n".join(said["hints"]),
        "output_format": "text",
        "stdout_visibility": "hidden",
        "tests": [_test(item) for item in said["items"]],
    }
    return json.dumps(content if seconds is None else {**content, "execution_time": round(seconds, 3)}, indent=1) + "\n"


def unreadable(sentence: str, points: float) -> str:
    """The same for a submission that could not be read."""
    test = {
        "name": "submission",
        "score": 0.0,
        "max_score": points,
        "status": "failed",
        "output": sentence,
        "visibility": "visible",
    }
    return json.dumps({"score": 0.0, "output": sentence, "stdout_visibility": "hidden", "tests": [test]}, indent=1) + "\n"


def _test(item: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "name": f"{item['question']}: {item['says']}",
        "score": round(item["score"], 6),
        "max_score": round(item["max_score"], 6),
        "status": "passed" if item["status"] == "right" else "failed",
        "output": item["sentence"],
        "output_format": "text",
        "visibility": "hidden" if item["hidden"] else "visible",
    }


def of_report(report: Report) -> dict[str, Any]:
    """A report as plain data."""
    return {
        "exercise": report.exercise, "title": report.title, "score": report.score, "max_score": report.max_score,
        "percent": report.percent, "passed": report.passed, "mistakes": list(report.mistakes), "seed": report.seed,
        "hints": list(dict.fromkeys(_hint(item) for item in report.items if item.hint and not item.hidden)),
        "protections": report.protections, "items": [{**asdict(item), "sentence": item.sentence} for item in report.items],
    }  # fmt: skip


def _hint(item: Item) -> str:
    return f"{item.mistake}: {item.hint}" if item.mistake else item.hint
