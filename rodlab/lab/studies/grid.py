"""The declared grid of the stability study: groups of cells, each list multiplied out.

    [[stability.grid]]     case = "loads"     K = [1.0, {jump = 1e12, at = 0.5}]     n = [10, 1000]     mode = [1, "n"]

`case` is a kind (`rodlab.lab.studies.cases`, `rodlab.lab.studies.contrasts`), every other entry an argument of it. mode = "n" is
the last of n modes; modes above n, and cells that are already there, are left out. slow = true leaves a group out when quick.
"""

import inspect
import json
from collections.abc import Callable, Mapping
from itertools import product
from typing import Any

from rodlab.lab.studies import cases, contrasts, stiffness
from rodlab.mechanics.expression import Expression
from rodlab.mechanics.joints import RULES
from rodlab.numerics.arrays import number, whole

KINDS: dict[str, Callable[..., dict[str, Any]]] = {
    f.__name__: f
    for f in (
        cases.loads, cases.equilibrium, cases.index, cases.layer, cases.elastica, cases.rod_loads,
        contrasts.contrast_fold, contrasts.contrast_determinant, contrasts.contrast_zero_pivot, contrasts.contrast_residual_test,
        contrasts.contrast_sampling, contrasts.contrast_conjugate, contrasts.contrast_eigenvalues,
    )
}  # fmt: skip
WHERE = ("joint", "middle")


def cells(table: Mapping[str, Any], *, quick: bool = False) -> list[tuple[str, dict[str, Any]]]:
    """("room:kind", arguments) of every cell of the table [stability], in its order. `ValueError` in one sentence for a bad one.

    >>> cells({"grid": [{"case": "loads", "n": [1, 5], "mode": [1, 2, "n"]}]})[-1]
    ('cases:loads', {'n': 5, 'mode': 5})
    """
    groups: Any = table.get("grid")
    tables = isinstance(groups, list) and groups and all(isinstance(one, Mapping) for one in groups)
    if set(table) != {"grid"} or not tables:
        held = ", ".join(table) or "nothing"
        raise ValueError(f"[stability] must hold [[stability.grid]] tables and nothing else; it holds {held}")
    found: dict[str, tuple[str, dict[str, Any]]] = {}
    for group in groups:
        for kind, given in _multiplied(group):
            if not (quick and group.get("slow", False)):
                found.setdefault(json.dumps([kind, given], sort_keys=True), (kind, given))
    if not found:
        raise ValueError(
            "[stability] must leave at least one cell: every mode is above its n, or every group is slow and quick asked for"
        )
    return list(found.values())


def _multiplied(group: Mapping[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    given = {name: value for name, value in group.items() if name not in ("case", "slow")}
    kind = group.get("case")
    if not isinstance(kind, str) or kind not in KINDS:
        raise ValueError(f"case must be one of {', '.join(KINDS)}; it is {kind!r:.60}")
    if not isinstance(group.get("slow", False), bool):
        raise ValueError(f"slow must be true or false; it is {group['slow']!r:.60}")
    known = inspect.signature(KINDS[kind]).parameters
    for name in given:
        if name not in known:
            raise ValueError(f"case {kind} takes {', '.join(known)}; {name} is none of these")
    for name, parameter in known.items():
        if name not in given and parameter.default is inspect.Parameter.empty:
            raise ValueError(f"case {kind} needs {name}; it has {', '.join(given) or 'nothing'}")
    lists = [value if isinstance(value, list) else [value] for value in given.values()]
    if not all(lists):
        raise ValueError(f"a list of the case {kind} must hold at least one value; one of {', '.join(given)} is empty")
    every = (_checked(dict(zip(given, values, strict=True))) for values in product(*lists))
    room = KINDS[kind].__module__.rpartition(".")[2]
    return [(f"{room}:{kind}", one) for one in every if one.get("mode", 1) <= one.get("n", one.get("mode", 1))]


def _checked(given: dict[str, Any]) -> dict[str, Any]:
    """The arguments of one cell, each looked at by its name."""
    return {name: _value(name, value, given) for name, value in given.items()}


def _value(name: str, value: Any, given: Mapping[str, Any]) -> Any:
    if name in ("n", "most"):
        return whole(name, value, least=1)
    if name == "mode":
        if isinstance(value, str) and value != "n":
            raise ValueError(f'mode must be a whole number, at least 1, or "n"; it is {value!r}')
        return whole("n", given.get("n"), least=1) if value == "n" else whole("mode", value, least=1)
    if name == "K":
        return stiffness.checked(value)
    if name in ("rule", "where"):
        allowed = RULES if name == "rule" else WHERE
        if value not in allowed:
            raise ValueError(f"{name} must be one of {', '.join(allowed)}; it is {value!r}")
        return value
    if name == "guess":
        if not isinstance(value, str):
            raise ValueError(f"guess must be an expression in s; it is {value!r}")
        return Expression(value).text
    return number(name, value, above={"ratio": 1.0, "tolerance": 0.0, "jump": 0.0}.get(name))
