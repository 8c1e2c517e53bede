"""A study: many cells, one answer, its tables and pictures; from a scene's TOML, resumed where it was killed.

scene -> cells -> answers (journal, executor) -> one answer for JSON, a text, tidy CSV, npz of shapes, pictures
"""

import io
import time
from collections.abc import Mapping
from concurrent.futures import Executor
from contextlib import nullcontext
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from rodlab.files import swept, write_whole
from rodlab.lab.scene import ASKS, FORMATS, Scene, scene, scenes
from rodlab.lab.store import as_csv, as_json, framed
from rodlab.lab.studies.asked import QUANTITIES
from rodlab.lab.studies.cells import VOLATILE, Cell
from rodlab.lab.studies.execution import Watch, answers, workers
from rodlab.lab.studies.journal import Journal
from rodlab.lab.studies.provenance import fingerprint, provenance
from rodlab.lab.studies.questions import only

KINDS = {"convergence": "convergence", "work-precision": "precision", "stability": "stability"}


@dataclass(frozen=True)
class Study:
    """What a study found. `answer`: for JSON; `text`: for a person; `write`: tables, shapes and pictures into a folder."""

    kind: str
    scene: Scene
    cells: tuple[Cell, ...]
    results: tuple[Mapping[str, Any], ...]
    seconds: float
    runs: tuple[Mapping[str, Any], ...]
    quick: bool = False

    def __repr__(self) -> str:
        return f"Study({self.kind!r}, {len(self.cells)} cells, {self.seconds:.1f} s)"

    @cached_property
    def found(self) -> dict[str, Any]:
        """The study's own part of the answer: its tables as lists of rows, and what they say."""
        said: dict[str, Any] = _room(self.kind).answer(list(self.cells), list(self.results))
        return said

    @cached_property
    def answer(self) -> dict[str, Any]:
        """Everything, as `--json` prints it."""
        about = {"study": self.kind, "scene": self.scene.name, "title": self.scene.title, "source": self.scene.source}
        return framed("study", self.seconds, {**about, "provenance": self.runs, **self.found})

    @cached_property
    def said(self) -> str:
        """The tables that a person reads."""
        return str(_room(self.kind).text(self.found))

    @property
    def text(self) -> str:
        """The same with the study's title."""
        title = f"{self.scene.title} [{self.scene.source}]" if self.scene.source else self.scene.title
        return "\n\n".join([title, *([self.scene.about] if self.scene.about else []), self.said])

    @property
    def complete(self) -> bool:
        """False when an answer is wrong without saying so, or a cell failed that should not."""
        return bool(_room(self.kind).complete(self.found))

    def figure(self) -> Any:
        """The picture, a matplotlib figure."""
        return import_module(f"rodlab.lab.studies.{KINDS[self.kind]}_picture").picture(self.found)

    def tables(self) -> dict[str, str]:
        """Tidy CSV by name: every list of rows in the answer."""
        lists = {name: rows for name, rows in self.found.items() if isinstance(rows, list) and rows and isinstance(rows[0], dict)}
        return {name: _csv(rows) for name, rows in lists.items()}

    def write(self, folder: Path) -> list[Path]:
        """Write JSON and CSV, shapes if the scene stores them, and pictures if it draws; of these one format if quick."""
        swept(folder)
        files: dict[str, bytes | str] = {f"{self.kind}.json": as_json(self.answer) + "\n"}
        files |= {f"{self.kind}-{name}.csv": text for name, text in self.tables().items()}
        if shapes := self._shapes():
            files[f"{self.kind}-shapes.npz"] = shapes
        if formats := self.scene.draw.get("formats"):
            from rodlab.lab.picture import drawn

            figure = self.figure()
            figure.draw_without_rendering()
            figure.set_layout_engine("none")  # laid out once for all formats
            files |= {
                f"{self.kind}.{suffix}": drawn(figure, f"{self.kind}.{suffix}") for suffix in formats[: 1 if self.quick else None]
            }
        written = [write_whole(folder / name, content) for name, content in files.items()]
        own = {f"{self.kind}.{suffix}" for suffix in FORMATS} | {path.name for path in folder.glob(f"{self.kind}-*.*")}
        for name in own - set(files):  # of an earlier run: not of this answer
            (folder / name).unlink(missing_ok=True)
        return written

    def _shapes(self) -> bytes | None:
        """Arrays s, phi, x, z of every stored shape, named by its cell's place; `cells` are the questions as JSON text."""
        own = {i: found["shape"] for i, found in enumerate(self.results) if "shape" in found}
        if not own:
            return None
        arrays: dict[str, Any] = {f"{i}/{name}": np.array(values) for i, shape in own.items() for name, values in shape.items()}
        arrays |= {"places": np.array(list(own)), "cells": np.array([self.cells[i].key for i in own])}
        out = io.BytesIO()
        np.savez_compressed(out, **arrays)
        return out.getvalue()


def study(
    kind: str | Scene = "convergence", *, quick: bool = False, peers: bool = False, jobs: int = 1,
    executor: Executor | None = None, cluster: str | None = None, out: str | Path | None = None,
    ask: Mapping[str, Any] | None = None, watch: Watch | None = None,
) -> Study:  # fmt: skip
    """Run a study: "convergence", "work-precision", "stability", or a scene that asks for one, or its file's path.

    quick: fewer cells, seconds; peers: beside scipy's solve_bvp and AUTO where installed (work-precision). Cells run here, in
    `jobs` processes, on a Dask `cluster` ("local", or a scheduler's address), or in any `concurrent.futures.Executor`. out: a
    folder for tables, shapes and pictures, and for the journal by which a killed study goes on. ask: changes of the scene's
    table. watch: called with (cells finished, cells in all). Raises `ValueError`, in one sentence, for a study that is none.

    >>> found = study("convergence", ask={"ask": [{"quantity": "load"}], "methods": ["strut, end"], "joints": [64, 128, 256]})
    >>> row = found.answer["orders"][0]
    >>> row["method"], row["theory"], round(row["order"], 2), row["clear"]
    ('strut, end', 1, 1.0, True)
    """
    start = time.perf_counter()
    chosen = _chosen(kind)
    kinds = [name for name in KINDS if name in chosen.asks]
    if ask is not None:
        only(kinds[0], ask, (*ASKS[kinds[0]], "joints", "intervals"))
    if out is not None and not (isinstance(out, (str, Path)) and str(out)):
        raise ValueError(f"out must name a folder; it is {out!r:.60}")
    if peers and kinds[0] != "work-precision":
        raise ValueError(f"peers must be asked for with work-precision only; the study is {kinds[0]}")
    table = {**chosen.asks[kinds[0]], **(ask or {}), **({"peers": True} if peers else {})}
    cells = _room(kinds[0]).cells(chosen.model, table, quick=quick)
    folder = None if out is None else Path(out)
    where = type(executor).__name__ if executor is not None else f"{cluster or 'processes'}: {jobs}"
    this = provenance(where)
    pool = workers(jobs, cluster) if executor is None else nullcontext(executor)
    with nullcontext() if folder is None else Journal(folder, fingerprint(), this) as journal, pool as those:
        results = answers(cells, those, journal, watch)
        runs = [{**this, "cells": len(cells)}] if journal is None else journal.runs(cells)
    return Study(kinds[0], chosen, tuple(cells), tuple(results), time.perf_counter() - start, tuple(runs), quick)


def _chosen(kind: Any) -> Scene:
    """The scene of a study, which asks for one of them."""
    if isinstance(kind, str) and not kind.endswith(".toml") and kind not in {known.name for known in scenes()}:
        raise ValueError(f"a study must be one of {', '.join(KINDS)}, or the path of a scene's .toml; it is {kind!r:.80}")
    if not isinstance(kind, (str, Path, Scene)):
        raise ValueError(f"a study must be given by its name or its file; it is {kind!r:.80}")
    chosen = kind if isinstance(kind, Scene) else scene(str(kind))
    if sum(name in chosen.asks for name in KINDS) != 1:
        raise ValueError(f"a study must be one of {', '.join(KINDS)}, or a scene that asks for one of them; {kind!r:.80} is not")
    return chosen


def question_instead(kind: str, asked: Mapping[str, Any], sizes: Mapping[str, Any]) -> dict[str, Any] | None:
    """`ask` of `study` for one question in the place of a scene's; None where nothing is asked. None stands for not given."""
    own, given = ({k: v for k, v in table.items() if v is not None} for table in (asked, sizes))
    if not own and not given:
        return None
    if "quantity" not in own:
        named = ", ".join([*own, *given])
        raise ValueError(f"quantity must be given with {named}: one of {', '.join(QUANTITIES)}; it is missing")
    if kind == "work-precision":
        return {"ask": own, **given}
    if kind == "convergence":
        return {"ask": [{**own, **given}], "quick": {}}
    raise ValueError(f"quantity must be given with convergence or work-precision; the study is {kind!r:.80}")


def _room(kind: str) -> Any:
    """The module of a kind of study: cells, answer, text, complete."""
    return import_module(f"rodlab.lab.studies.{KINDS[kind]}")


def _csv(rows: list[dict[str, Any]]) -> str:
    """Rows as tidy CSV, costs as columns of their own; a column that only some rows have is empty in the others."""
    flat = [{**{k: v for k, v in row.items() if k != VOLATILE}, **row.get(VOLATILE, {})} for row in rows]
    columns = list(dict.fromkeys(name for row in flat for name in row))
    return as_csv(columns, [[row.get(name) for name in columns] for row in flat])
