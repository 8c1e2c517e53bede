"""A verdict on an answer, from the truth and from what was claimed.

    of ours    "right"       true error <= claimed
               "loose"       the same, but claimed > 1000 true error and > 1e-8 of the answer, or > the answer itself
               "unverified"  answered, and said that its error or index is not verified
               "refused"     a sentence was raised
               "WRONG"       true error > claimed, or an index outside of the bounds that were given: must never happen
    of naive   "right"       eight digits, or the index itself;  "wrong, silently"  fewer;  "fails"  an exception;
               "overflow"    infinite or NaN, a product zero by underflow;  "never ends"  its own test is never satisfied

Errors are relative to the truth where it is not zero, and for an index absolute: `scale` says which. Half of the least float
above zero counts as no error: an answer of that size cannot be nearer.
"""

import math
from collections.abc import Callable
from typing import Any

import mpmath as mp

VERDICTS = ("right", "loose", "unverified", "refused", "WRONG")
NAIVE = ("right", "wrong, silently", "overflow", "never ends", "fails")
IDLE, USEFUL = 1000.0, 1e-8  # a claim is loose above both: so many true errors, so much of the answer
GOOD = 1e-8  # eight digits: what a naive answer must have
MOST = 17.0  # digits of a float
HALF_LEAST = mp.ldexp(1, -1075)


def judged(answer: float, truth: Any, claimed: float, *, verified: bool = True, unsure: float = 0.0) -> dict[str, Any]:
    """truth, forward, claimed, digits, scale and verdict of a number with its claimed absolute error.

    unsure: how far the truth may itself be off. Raises `ArithmeticError` where that decides the verdict.

    >>> judged(1.0, 1.0 + 1e-12, 1e-10)["verdict"], judged(1.0, 1.0 + 1e-12, 1e-13)["verdict"]
    ('right', 'WRONG')
    """
    with mp.workdps(60):
        exact = mp.mpf(truth)
        off, size = abs(mp.mpf(answer) - exact), abs(exact) or mp.mpf(1)
        if verified and off - unsure <= claimed < off + unsure - HALF_LEAST:
            raise ArithmeticError(f"the truth is known to {unsure:.1e} only, and the error claimed is {claimed:.1e}")
        forward, claim = float(off / size), float(mp.mpf(claimed) / size)
        return {
            "answer": float(answer), "truth": float(exact), "truth_digits": mp.nstr(exact, 20), "forward": forward,
            "claimed": claim, "digits": _digits(forward), "scale": "relative" if exact else "absolute",
            "verdict": _verdict(off, claimed, size, verified),
        }  # fmt: skip


def judged_index(least: int, most: int, truth: int) -> dict[str, Any]:
    """The same of an index between `least` and `most`, verified where these are one."""
    inside = least <= truth <= most
    verdict = "WRONG" if not inside else "right" if least == most else "unverified"
    return {
        "answer": least, "truth": truth, "forward": float(abs(least - truth)), "claimed": float(most - least),
        "digits": MOST if least == truth else 0.0, "scale": "absolute", "verdict": verdict,
    }  # fmt: skip


def unjudged(answer: float, error: Exception) -> dict[str, Any]:
    """The same of an answer that says it is not verified, and next to which no truth was found either."""
    return {
        "answer": float(answer), "truth": math.nan, "forward": math.nan, "claimed": math.inf, "digits": 0.0,
        "verdict": "unverified", "why": f"no truth is known: {error}",
    }  # fmt: skip


def refused(error: Exception, truth: Any = None) -> dict[str, Any]:
    """The same of an answer that was refused, with the sentence."""
    known = {} if truth is None else {"truth": float(truth), "truth_digits": mp.nstr(truth, 20)}
    told = {"answer": None, "forward": math.nan, "claimed": math.nan, "digits": 0.0, "verdict": "refused", "why": str(error)}
    return {**told, **known}


def judged_naively(formula: Callable[[], float], truth: Any, *, whole: bool = False) -> dict[str, Any]:
    """naive, naive_forward and naive_verdict of a formula that claims nothing; `whole` for an index, which is right or not.

    >>> judged_naively(lambda: 1e308 * 10, 1.0)["naive_verdict"], judged_naively(lambda: 1.001, 1.0)["naive_verdict"]
    ('overflow', 'wrong, silently')
    """
    try:
        answer = float(formula())
    except NeverEndsError as error:
        off = _off(error.last, truth, whole)
        return {"naive": error.last, "naive_forward": off, "naive_verdict": "never ends", "naive_why": str(error)}
    except (ArithmeticError, ValueError) as error:
        return {"naive": None, "naive_forward": math.inf, "naive_verdict": "fails", "naive_why": str(error)}
    if not math.isfinite(answer):
        return {"naive": answer, "naive_forward": math.inf, "naive_verdict": "overflow", "naive_why": f"its answer is {answer:g}"}
    off = _off(answer, truth, whole)
    verdict = "right" if off <= (0 if whole else GOOD) else "wrong, silently"
    return {"naive": answer, "naive_forward": off, "naive_verdict": verdict, "naive_why": ""}


class NeverEndsError(ArithmeticError):
    """An iteration whose own test is never satisfied; `last` is where it stood."""

    def __init__(self, message: str, last: float) -> None:
        super().__init__(message)
        self.last = last


def _off(answer: float, truth: Any, whole: bool) -> float:
    with mp.workdps(60):
        exact = mp.mpf(truth)
        return float(abs(mp.mpf(answer) - exact) / (1 if whole else abs(exact) or 1))


def _verdict(off: Any, claimed: float, size: Any, verified: bool) -> str:
    if not verified:
        return "unverified"
    if not mp.isfinite(off) or math.isnan(claimed):
        return "WRONG"
    if not off <= claimed + HALF_LEAST:
        return "WRONG"
    idle = (claimed > IDLE * off and claimed > USEFUL * size) or claimed > max(size, mp.mpf(5e-324))
    return "loose" if idle else "right"


def _digits(forward: float) -> float:
    return MOST if forward == 0 else round(min(MOST, max(0.0, -math.log10(forward))), 1) if math.isfinite(forward) else 0.0
