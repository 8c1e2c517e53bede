"""The journal of a study: every finished cell, kept the moment it is finished, so that a killed study goes on where it was.

An SQLite file: a cell is in it whole or not at all, whatever kills the process. Cells count only for the same code and
libraries (`fingerprint`): numbers of two versions are never mixed.
"""

import json
import sqlite3
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

TABLES = """
CREATE TABLE IF NOT EXISTS runs (id INTEGER PRIMARY KEY, provenance TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS cells (fingerprint TEXT, key TEXT, run INTEGER, answer TEXT NOT NULL, PRIMARY KEY (fingerprint, key));
"""


class Kept(Protocol):
    """What has an answer that can be kept: a cell, a submission."""

    @property
    def key(self) -> str:
        """Equal for what has equal answers."""


class Journal:
    """Finished cells in a folder; `fingerprint` names the code and libraries that they hold for. A context manager."""

    def __init__(self, folder: Path, fingerprint: str, provenance: Mapping[str, Any]) -> None:
        self.path, self.fingerprint = folder / "cells.sqlite", fingerprint
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ValueError(f"{folder} cannot be written: {error.strerror or error}") from None
        with self._said():
            self.file = sqlite3.connect(self.path, timeout=60.0, check_same_thread=False)
            self.file.execute("PRAGMA synchronous = NORMAL")
            self.file.executescript(TABLES)
            with self.file:
                self.run = self.file.execute("INSERT INTO runs (provenance) VALUES (?)", (json.dumps(provenance),)).lastrowid

    @contextmanager
    def _said(self) -> Iterator[None]:
        """What SQLite cannot do, in one sentence with the remedy."""
        try:
            yield
        except sqlite3.Error as error:
            said = f"{self.path} is not a journal of rodlab's, or cannot be written: {error}"
            raise ValueError(f"{said}; remove it to begin anew, or name another folder") from None

    def __enter__(self) -> "Journal":
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def known(self, cells: Sequence[Kept]) -> dict[int, dict[str, Any]]:
        """The answers that are there already, by their place in the list."""
        with self._said():
            own = self.file.execute("SELECT key, answer FROM cells WHERE fingerprint = ?", (self.fingerprint,))
            there = dict(own.fetchall())
        found = {i: _read(there[cell.key]) for i, cell in enumerate(cells) if cell.key in there}
        return {i: answer for i, answer in found.items() if answer is not None}

    def keep(self, cell: Kept, answer: Mapping[str, Any]) -> None:
        """Write one answer, whole."""
        row = (self.fingerprint, cell.key, self.run, json.dumps(answer))
        with self._said(), self.file:
            self.file.execute("INSERT OR REPLACE INTO cells VALUES (?, ?, ?, ?)", row)

    def runs(self, cells: Sequence[Kept]) -> list[dict[str, Any]]:
        """Where and when these cells were computed, each run with their number."""
        with self._said():
            rows = self.file.execute("SELECT key, run FROM cells WHERE fingerprint = ?", (self.fingerprint,)).fetchall()
            said = dict(self.file.execute("SELECT id, provenance FROM runs").fetchall())
        wanted = {cell.key for cell in cells}
        counts = Counter(run for key, run in rows if key in wanted)
        return [{**json.loads(said[run]), "cells": counts[run]} for run in sorted(counts)]


def _read(text: str) -> dict[str, Any] | None:
    """An answer; None for what is none, which is as if it had not been finished."""
    try:
        found = json.loads(text)
    except ValueError:
        return None
    return found if isinstance(found, dict) and found else None
