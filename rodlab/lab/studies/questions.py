"""What a table or a command line asks, looked at before any work is done: one sentence for what is no question."""

from collections.abc import Mapping, Sequence
from typing import Any

from rodlab.lab.studies.asked import QUANTITIES, Question
from rodlab.lab.studies.every import method_named
from rodlab.lab.studies.reference import truth
from rodlab.mechanics.expression import Expression
from rodlab.mechanics.rod import Rod
from rodlab.numerics.arrays import number, whole

JOINTS, INTERVALS = tuple(2**i for i in range(4, 15)), (6, 8, 10, 12, 16, 24, 32, 48, 64)
MOST = {"joints": 10**8, "intervals": 10**5}
BUCKLED = ("tip_angle", "height", "energy")


def question_of(given: Mapping[str, Any]) -> dict[str, Any]:
    """A question as plain data, checked.

    >>> question_of({"quantity": "height", "lam": 5, "K": "1 + s"})
    {'quantity': 'height', 'mode': 1, 'lam': 5.0, 'K': '1 + s'}
    """
    quantity = given.get("quantity")
    if quantity not in QUANTITIES:
        raise ValueError(f"quantity must be one of {', '.join(QUANTITIES)}; it is {quantity!r:.60}")
    question: dict[str, Any] = {"quantity": quantity, "mode": whole("mode", given.get("mode", 1), least=1)}
    if quantity != "load":
        if given.get("lam") is None:
            raise ValueError(f"lam must be given for the quantity {quantity}; it is missing")
        question["lam"] = number("lam", given["lam"])
    question |= {name: _profile(name, given[name]) for name in ("K", "u_hat") if name in given}
    if given.get("breaks"):
        if not isinstance(given["breaks"], (list, tuple)):
            raise ValueError(f"breaks must be a list of numbers; it is {given['breaks']!r:.60}")
        question["breaks"] = [number("breaks", b) for b in given["breaks"]]
    straight = question.get("u_hat", 0.0) == 0
    if question["mode"] > 1 and not straight:
        raise ValueError(f"mode must be 1 with an unstressed curvature, whose branch has no number; it is {question['mode']}")
    if quantity == "fold" and straight:
        raise ValueError("u_hat must not be 0 for the quantity fold: the branch of a straight rod has none; it is 0")
    if quantity in ("load", "index") and not straight:
        raise ValueError(
            f"u_hat must be 0 for the quantity {quantity}, that of the straight rod; it is {question['u_hat']!r:.60}"
        )
    _possible(question, straight=straight)
    return question


def _profile(name: str, value: Any) -> float | str:
    """A number, or an expression in s; a number in quotes is one."""
    if not isinstance(value, str):
        return number(name, value)
    try:
        return number(name, float(value))
    except ValueError:
        return Expression(value).text


def _possible(question: Mapping[str, Any], *, straight: bool) -> None:
    """One sentence for a rod that there is none of, or a load at which it has not buckled in the mode."""
    Rod(K=question.get("K", 1.0), u_hat=question.get("u_hat", 0.0), breaks=question.get("breaks", ()))
    if question["quantity"] in BUCKLED and straight:
        load = truth(Question("load", question["mode"], K=question.get("K", 1.0), breaks=tuple(question.get("breaks", ())))).value
        if not question["lam"] > load:
            said = f"lam must be above the buckling load {load:.6g} of mode {question['mode']}"
            raise ValueError(f"{said} for the quantity {question['quantity']}; it is {question['lam']:g}")


def sizes_of(method: str, given: Mapping[str, Any]) -> list[float]:
    """The sizes that are given for a method, ascending and each once, or its own."""
    known = method_named(method)
    if known.order is None:
        return list(known.sizes)
    name, usual = ("joints", JOINTS) if method.startswith("strut") else ("intervals", INTERVALS)
    sizes = given.get(name, usual)
    if not isinstance(sizes, (list, tuple)) or not sizes:
        raise ValueError(f"{name} must be a list of numbers; it is {sizes!r:.60}")
    found = sorted({whole(name, size, least=1) for size in sizes})
    if found[-1] > MOST[name]:
        raise ValueError(f"{name} must be at most {MOST[name]}; the largest is {str(found[-1])[:20]}")
    return list(found)


def names(methods: Any) -> list[str]:
    """Names of methods, each once, checked."""
    if not isinstance(methods, (list, tuple)) or not methods or not all(isinstance(name, str) for name in methods):
        raise ValueError(f"methods must be a list of names; it is {methods!r:.60}")
    for name in methods:
        method_named(name)
    return list(dict.fromkeys(methods))


def only(what: str, given: Any, known: Sequence[str]) -> None:
    """`ValueError`, in one sentence, for a table with an entry that is not known."""
    wrong = sorted(set(given) - set(known)) if isinstance(given, Mapping) else [given]
    if wrong:
        raise ValueError(f"[{what}] takes {', '.join(known)}; {str(wrong[0])[:60]!r} is none of these")
