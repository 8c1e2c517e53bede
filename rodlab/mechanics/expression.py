"""A function of arclength written as text: "1 + s", "Piecewise((1, s < 1/2), (1000, True))".

Numbers, + - * / **, parentheses, pi, s, exp log sqrt sin cos tan, and Piecewise with ascending bounds on s, whose
breaks are read from it. The text is parsed by a whitelist of its syntax tree and never evaluated as Python.
"""

import ast
import math
import operator
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from rodlab.numerics.arrays import Array

Node = Callable[[Any], Any]  # of the values of the variables and the functions by name

ALLOWED = "numbers, {names}, pi, + - * / **, parentheses, exp log sqrt sin cos tan"
PIECES = " and Piecewise((value, s < a), ..., (value, True))"
FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    "exp": np.exp, "log": np.log, "sqrt": np.sqrt, "sin": np.sin, "cos": np.cos, "tan": np.tan,
}  # fmt: skip
BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: np.true_divide, ast.Pow: np.power,
}  # fmt: skip
UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {ast.UAdd: operator.pos, ast.USub: operator.neg}


class Expression:
    """The function of s, or of other variables, that a text stands for; `breaks` are the bounds of its pieces.

    >>> f = Expression("Piecewise((1, s < 1/2), (1 + s, True))")
    >>> f(np.array([0.25, 0.5])), f.breaks
    (array([1. , 1.5]), (0.5,))
    >>> Expression("__import__('os')")
    Traceback (most recent call last):
    ValueError: "__import__('os')" is not an expression in s: __import__ is not known; allowed are ...
    """

    def __init__(self, text: str, variables: tuple[str, ...] = ("s",)) -> None:
        self.text, self.variables = text, variables
        try:
            tree = ast.parse(text.strip(), mode="eval").body
            self._breaks: list[float] = []
            self._value = self._compile(tree)
        except _NotAllowed as error:
            raise self._refused(str(error)) from None
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise self._refused("it cannot be read") from None
        self.breaks = tuple(sorted(set(self._breaks)))

    def _refused(self, why: str) -> ValueError:
        shown = repr(self.text) if len(self.text) <= 60 else repr(self.text[:57] + "...")
        names = " and ".join(self.variables)
        allowed = ALLOWED.format(names=", ".join(self.variables)) + (PIECES if "s" in self.variables else "")
        return ValueError(f"{shown} is not an expression in {names}: {why}; allowed are {allowed}")

    def __call__(self, s: Array) -> Array:
        s = np.asarray(s, dtype=np.float64)
        with np.errstate(all="ignore"):
            return np.asarray(self._value({**FUNCTIONS, "s": s}) + np.zeros_like(s), dtype=np.float64)

    def of(self, **names: Any) -> Any:
        """The value for these values of the variables, by these functions: with SymPy's, a SymPy expression."""
        return self._value(names)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Expression, (self.text, self.variables))

    def __repr__(self) -> str:
        return f"Expression({self.text!r})"

    def _compile(self, node: ast.expr) -> Node:
        match node:
            case ast.Constant(value=bool() as x):
                raise _NotAllowed(f"{x} stands alone")
            case ast.Constant(value=int() | float() as x):
                return _constant(x)
            case ast.Name(id=name) if name in self.variables:
                return operator.itemgetter(name)
            case ast.Name(id="pi"):
                return _constant(math.pi)
            case ast.UnaryOp(op=op, operand=inner) if type(op) in UNARY:
                act, value = UNARY[type(op)], self._compile(inner)
                return lambda at: act(value(at))
            case ast.BinOp(op=op, left=left, right=right) if type(op) in BINARY:
                join, a, b = BINARY[type(op)], self._compile(left), self._compile(right)
                return lambda at: join(a(at), b(at))
            case ast.Call(func=ast.Name(id="Piecewise"), args=pieces, keywords=[]) if pieces and "s" in self.variables:
                return self._piecewise(pieces)
            case ast.Call(func=ast.Name(id=name), args=[inner], keywords=[]) if name in FUNCTIONS:
                value = self._compile(inner)
                return lambda at: at[name](value(at))
        raise _NotAllowed(f"{_name(node)} is not known")

    def _piecewise(self, pieces: list[ast.expr]) -> Node:
        values, bounds = zip(*self._pieces(pieces), strict=True)
        ends = np.array(bounds[:-1])
        if (np.diff(ends) <= 0).any():
            raise _NotAllowed("the bounds of Piecewise must ascend")

        def chosen(at: Any) -> Any:
            piece, out = np.searchsorted(ends, at["s"], side="right"), np.empty_like(at["s"])
            for i, value in enumerate(values):
                out = np.where(piece == i, value(at), out)
            return out

        return chosen

    def _pieces(self, pieces: list[ast.expr]) -> Iterator[tuple[Node, float]]:
        for piece in pieces:
            match piece:
                case ast.Tuple(elts=[value, ast.Constant(value=True)]) if piece is pieces[-1]:
                    yield self._compile(value), math.inf
                case ast.Tuple(
                    elts=[value, ast.Compare(left=ast.Name(id="s"), ops=[ast.Lt() | ast.LtE() as below], comparators=[bound])]
                ) if piece is not pieces[-1]:
                    a = float(self._compile(bound)({**FUNCTIONS, "s": np.nan}))
                    if not math.isfinite(a):
                        raise _NotAllowed("a bound of Piecewise must be a number")
                    self._breaks.append(a)  # for s < a the next piece begins at a itself
                    yield self._compile(value), a if isinstance(below, ast.Lt) else math.nextafter(a, math.inf)
                case _:
                    raise _NotAllowed("Piecewise takes (value, s < a) and, last, (value, True)")


class _NotAllowed(Exception):
    """A part of the text that the whitelist does not hold."""


def _constant(x: float) -> Node:
    value = np.float64(x) if abs(x) < 1e308 else np.float64(math.inf)
    return lambda _: value


def _name(node: ast.AST) -> str:
    match node:
        case ast.Call(func=ast.Name(id=name)) | ast.Name(id=name):
            return name
        case ast.Constant(value=value):
            return repr(value)
        case _:
            return ast.unparse(node)[:40] if isinstance(node, ast.expr) else type(node).__name__
