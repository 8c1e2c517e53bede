"""A pytest plugin: `pytest --exercises PATH...` tests every answer below these paths, one test an item.

Without `--exercises` it does nothing. Each answer runs in a process of its own, and a failed test says its sentence and hint.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """--exercises and --exercises-seed."""
    group = parser.getgroup("rodlab", "exercises of rodlab")
    group.addoption("--exercises", action="store_true", help="collect answers to rodlab's exercises and check them")
    group.addoption("--exercises-seed", type=int, default=None, metavar="N", help="check them on fresh parameters as well")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "Answer | None":
    """A script that says which exercise it is for, or lies in a folder of its name."""
    if not parent.config.getoption("--exercises", default=False) or file_path.suffix != ".py" or file_path.name == "check.py":
        return None
    from rodlab.lab.teaching.course import names
    from rodlab.lab.teaching.submissions import named

    name = named(file_path, names())
    if name is None or (file_path.parent.name == "teacher"):
        return None
    return Answer.from_parent(parent, path=file_path, exercise=name)


class Answer(pytest.File):
    """The answer to one exercise."""

    def __init__(self, *, exercise: str, **given: Any) -> None:
        super().__init__(**given)
        self.exercise = exercise

    def collect(self) -> Iterator["Item"]:
        """An item for each property of each question."""
        from rodlab.lab.teaching.course import check_source, exercise
        from rodlab.lab.teaching.submissions import read

        seed: int | None = self.config.getoption("--exercises-seed")
        try:
            report = check_source(exercise(self.exercise), read(self.path), seed=seed)
        except ValueError as why:
            raise self.CollectError(str(why)) from None
        for item in report.items:
            fresh = ", fresh parameters" if item.hidden else ""
            yield Item.from_parent(self, name=f"{item.question}: {item.says}{fresh}", item=item)


class Item(pytest.Item):
    """One property of one question."""

    def __init__(self, *, item: Any, **given: Any) -> None:
        super().__init__(**given)
        self.item = item

    def runtest(self) -> None:
        """Fail with the item's sentence."""
        if not self.item.passed:
            pytest.fail(self.item.sentence, pytrace=False)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Where it is."""
        return self.path, None, self.name
