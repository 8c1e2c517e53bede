"""The mistakes of a class in one picture: what became of each exercise, and the classic mistakes, the most frequent first."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rodlab.lab.picture import figure
from rodlab.lab.teaching.tally import frequent

STATES = {  # of a submission: its name, grey, hatch
    "right": ("all right", "0.25", ""),
    "mistake": ("a classic mistake", "0.55", ""),
    "wrong": ("otherwise wrong", "0.8", ""),
    "unanswered": ("not all answered", "1.0", ""),
    "lost": ("did not run", "1.0", "////"),
}
MOST = 16  # mistakes that are named at least, or as many as there are exercises
LONGEST = 64  # letters of a name


def class_picture(records: Sequence[Mapping[str, Any]]) -> Figure:
    """Bars of the submissions of each exercise on the left, bars of the mistakes on the right."""
    exercises = sorted({r["exercise"] for r in records if r["exercise"]})
    mistakes = _mistakes(records)[: max(MOST, len(exercises))]
    rows = max(len(exercises), len(mistakes), 4)
    fig, (left, right) = figure(11.0, 1.6 + 0.26 * rows, ncols=2, width_ratios=(1.0, 1.0))
    _fates(left, records, exercises)
    _named(right, mistakes)
    for axes in (left, right):
        axes.set_ylim(rows - 0.5, -0.5)  # the first on top, bars of one width in both
    fig.legend(*left.get_legend_handles_labels(), loc="outside lower left", ncols=len(STATES), frameon=False, fontsize=8)
    return fig


def _fates(axes: Axes, records: Sequence[Mapping[str, Any]], exercises: Sequence[str]) -> None:
    start = [0] * len(exercises)
    for state, (name, grey, hatch) in STATES.items():
        counts = [sum(r["exercise"] == e and _state(r) == state for r in records) for e in exercises]
        axes.barh(exercises, counts, left=start, color=grey, hatch=hatch, edgecolor="0.2", linewidth=0.6, height=0.72, label=name)
        start = [a + b for a, b in zip(start, counts, strict=True)]
    axes.set_xlabel("submissions")
    axes.set_title("What became of each exercise", loc="left", fontsize=10)
    _plain(axes)


def _named(axes: Axes, mistakes: Sequence[tuple[str, int]]) -> None:
    axes.set_title("Classic mistakes, the most frequent first", loc="left", fontsize=10)
    if not mistakes:
        axes.text(0.0, 0.95, "none was recognised", va="top", transform=axes.transAxes)
        axes.set_axis_off()
        return
    names = [name if len(name) <= LONGEST else name[: LONGEST - 1] + "…" for name, _ in mistakes]
    axes.barh(range(len(names)), [count for _, count in mistakes], color="0.55", edgecolor="0.2", linewidth=0.6, height=0.72)
    axes.set_yticks(range(len(names)), names)
    axes.set_xlabel("submissions")
    _plain(axes)


def _mistakes(records: Sequence[Mapping[str, Any]]) -> list[tuple[str, int]]:
    """Mistakes with their exercise in front."""
    return frequent(
        [{"mistakes": "; ".join(_placed(r["exercise"], m) for m in filter(None, r["mistakes"].split("; ")))} for r in records]
    )


def _placed(exercise: str, mistake: str) -> str:
    return mistake if mistake.startswith(f"{exercise}: ") else f"{exercise}, {mistake}"


def _state(record: Mapping[str, Any]) -> str:
    return record["status"] if record["status"] in STATES else "lost"


def _plain(axes: Axes) -> None:
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.tick_params(axis="y", length=0, labelsize=8)
    axes.tick_params(axis="x", labelsize=8)
    axes.set_xlim(0.0, 1.01 * max(axes.dataLim.x1, 1.0))
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
