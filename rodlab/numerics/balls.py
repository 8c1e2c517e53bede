"""Numbers that know how wrong they are: balls [Arb; Johansson 2017] and, where python-flint is missing, intervals of mpmath.

Every operation returns an enclosure of all results for all numbers in its operands. The two have one face, as far as a proof
needs it; both compute with `bits` of precision.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from threading import RLock
from typing import Any, Protocol


class Balls(Protocol):
    """Arithmetic with enclosures: + - * / of its numbers, and these."""

    name: str
    two_pi: Any

    def number(self, x: float, radius: float = 0.0) -> Any:
        """The ball of a float, which is exact unless a radius is given."""

    def sin_cos(self, x: Any) -> tuple[Any, Any]:
        """Both at once."""

    def hull(self, a: Any, b: Any) -> Any:
        """The least ball that holds both."""

    def meet(self, a: Any, b: Any) -> Any:
        """A ball that holds what both hold; they must have a number in common."""

    def holds(self, a: Any, b: Any) -> bool:
        """True when a certainly holds all of b."""

    def middle(self, x: Any) -> Any:
        """Its centre, as an exact number."""

    def value(self, x: Any) -> float:
        """Its centre, rounded to a float."""

    def radius(self, x: Any) -> float:
        """Half its width."""

    def sign(self, x: Any) -> int:
        """1 or -1 where every number in it has that sign, else 0."""

    def floor(self, x: Any) -> int | None:
        """The largest integer below, where that is the same for every number in it."""

    def has_integer(self, x: Any) -> bool:
        """True unless it certainly holds no integer."""


class Flint:
    """Arb's balls."""

    name = "ball arithmetic (python-flint)"

    def __init__(self) -> None:
        from flint import arb

        self.ball = arb
        self.two_pi = 2 * arb.pi()

    def number(self, x: float, radius: float = 0.0) -> Any:
        return self.ball(x, radius)

    def sin_cos(self, x: Any) -> tuple[Any, Any]:
        both: tuple[Any, Any] = x.sin_cos()
        return both

    def hull(self, a: Any, b: Any) -> Any:
        return a.union(b)

    def meet(self, a: Any, b: Any) -> Any:
        return a.intersection(b)

    def holds(self, a: Any, b: Any) -> bool:
        return bool(a.contains(b))

    def middle(self, x: Any) -> Any:
        return x.mid()

    def value(self, x: Any) -> float:
        return float(x)

    def radius(self, x: Any) -> float:
        return float(x.rad())

    def sign(self, x: Any) -> int:
        return 1 if x > 0 else -1 if x < 0 else 0

    def floor(self, x: Any) -> int | None:
        below = x.floor().unique_fmpz()
        return None if below is None else int(below)

    def has_integer(self, x: Any) -> bool:
        return bool(x.contains_integer())


class Mpmath:
    """Intervals of mpmath, some fifty times slower."""

    name = "interval arithmetic (mpmath)"

    def __init__(self) -> None:
        from mpmath import iv, mp

        self.iv, self.mp = iv, mp
        self.two_pi = 2 * iv.pi

    def number(self, x: float, radius: float = 0.0) -> Any:
        centre = self.iv.mpf(x)
        return centre + self.iv.mpf([-radius, radius]) if radius else centre

    def sin_cos(self, x: Any) -> tuple[Any, Any]:
        return self.iv.sin(x), self.iv.cos(x)

    def hull(self, a: Any, b: Any) -> Any:
        return self.iv.mpf([min(a.a, b.a), max(a.b, b.b)])

    def meet(self, a: Any, b: Any) -> Any:
        return self.iv.mpf([max(a.a, b.a), min(a.b, b.b)])

    def holds(self, a: Any, b: Any) -> bool:
        return bool(a.a <= b.a and b.b <= a.b)

    def middle(self, x: Any) -> Any:
        return self.iv.mpf(x.mid.a)

    def value(self, x: Any) -> float:
        return float(self.mp.mpf(x.mid.a))

    def radius(self, x: Any) -> float:
        return float(self.mp.mpf(x.delta.b)) / 2

    def sign(self, x: Any) -> int:
        return 1 if x.a > 0 else -1 if x.b < 0 else 0

    def floor(self, x: Any) -> int | None:
        low, high = (int(self.mp.floor(self.mp.mpf(end))) for end in (x.a, x.b))
        return low if low == high else None

    def has_integer(self, x: Any) -> bool:
        low, high = self.mp.mpf(x.a), self.mp.mpf(x.b)
        return bool(self.mp.ceil(low) <= high)


ENGINES = {"flint": Flint, "mpmath": Mpmath}


def engine_of(name: str | None = None) -> str:
    """The engine of this name, else the fastest one that is installed; `ValueError` for one that is not there."""
    if name is not None and (not isinstance(name, str) or name not in ENGINES):
        raise ValueError(f"engine must be one of {', '.join(ENGINES)}; it is {name!r}")
    if name == "flint" and not find_spec("flint"):
        raise ValueError("engine must be 'mpmath', as python-flint is not installed (pip install python-flint); it is 'flint'")
    return name or ("flint" if find_spec("flint") else "mpmath")


_ONE = RLock()  # the precision is a state of both packages: one proof at a time


@contextmanager
def balls(bits: int, engine: str | None = None) -> Iterator[Balls]:
    """Arithmetic of this precision; python-flint's where it is installed, unless the engine is named. One thread at a time.

    >>> with balls(80, "mpmath") as arithmetic:
    ...     x = arithmetic.number(1.0, 0.25)
    ...     arithmetic.sign(x), arithmetic.floor(x), arithmetic.has_integer(x)
    (1, None, True)
    """
    with _ONE:
        if engine_of(engine) == "flint":
            from flint import ctx

            with ctx.workprec(bits):
                yield Flint()
            return
        from mpmath import iv, mp

        before = iv.prec, mp.prec
        iv.prec = mp.prec = bits
        try:
            yield Mpmath()
        finally:
            iv.prec, mp.prec = before
