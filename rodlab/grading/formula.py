"""A symbolic answer as a function of mpmath's numbers: its text is parsed by a whitelist, never evaluated as Python.

Two expressions are the same when they agree at random points to many more digits than chance allows; that needs no
simplification, and no form of the answer is preferred.
"""

import ast
from collections.abc import Mapping
from typing import Any

import mpmath

DIGITS = 40
LONGEST, HUGE = 20_000, 10**6
FUNCTIONS = (
    "sin", "cos", "tan", "exp", "log", "sqrt", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
    "cot", "sec", "csc", "cbrt", "re", "im", "conj",
)  # fmt: skip
OTHERS = {
    "Abs": mpmath.fabs,
    "abs": mpmath.fabs,
    "sign": mpmath.sign,
    "Rational": lambda p, q=1: mpmath.mpf(p) / q,
    "ln": mpmath.log,
}


class Unreadable(Exception):
    """An expression that is not one, in a sentence."""


class Formula:
    """The function of the variables that a text stands for.

    >>> Formula("(3 - sqrt(5))/2 + 0*lam", ("lam",)).at({"lam": 1})
    mpf('0.381966011250105...')
    >>> Formula("__import__('os')", ())
    Traceback (most recent call last):
    rodlab.grading.formula.Unreadable: the expression has __import__, which is not known; known are no variables, pi, E, ...
    """

    def __init__(self, text: str, variables: tuple[str, ...]) -> None:
        self.text, self.variables = text, variables
        if len(text) > LONGEST:
            raise Unreadable(f"the expression has {len(text)} characters; at most {LONGEST} are read")
        try:
            self._tree = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise Unreadable(f"the expression {text[:60]!r} cannot be read") from None
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Name) and node.id not in (*variables, "pi", "E", "I", *FUNCTIONS, *OTHERS):
                known = ", ".join(variables) if variables else "no variables"
                raise Unreadable(
                    f"the expression has {node.id}, which is not known; known are {known}, pi, E, and sin, cos, sqrt, ..."
                )

    def at(self, values: Mapping[str, Any], digits: int = DIGITS) -> Any:
        """The value at a point, in `digits` digits; raises `Unreadable` where it has none."""
        with mpmath.workdps(digits):
            names = {"pi": +mpmath.pi, "E": +mpmath.e, "I": mpmath.mpc(0, 1), **{key: mpmath.mpf(x) for key, x in values.items()}}
            try:
                found = _value(self._tree, names)
            except (ArithmeticError, ValueError, TypeError, RecursionError, MemoryError, mpmath.libmp.NoConvergence):
                raise Unreadable(f"the expression {self.text[:60]!r} has no value at {dict(values)}") from None
            return found


def _value(node: ast.AST, names: Mapping[str, Any]) -> Any:
    match node:
        case ast.Constant(value=bool()):
            raise Unreadable("the expression has True or False in it")
        case ast.Constant(value=int() | float() as x):
            return mpmath.mpf(x)
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.UnaryOp(op=ast.USub(), operand=x):
            return -_value(x, names)
        case ast.UnaryOp(op=ast.UAdd(), operand=x):
            return _value(x, names)
        case ast.BinOp(left=a, op=op, right=b):
            return _binary(op, _value(a, names), _value(b, names))
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in FUNCTIONS or name in OTHERS:
            given = [_value(x, names) for x in arguments]
            if any(abs(x) > HUGE for x in given):
                raise ArithmeticError
            return (OTHERS.get(name) or getattr(mpmath, name))(*given)
    raise Unreadable(f"the expression has {type(node).__name__} in it; numbers, names, + - * / ** and functions are read")


def _binary(op: ast.operator, a: Any, b: Any) -> Any:
    match op:
        case ast.Add():
            return a + b
        case ast.Sub():
            return a - b
        case ast.Mult():
            return a * b
        case ast.Div():
            return a / b
        case ast.Pow():
            if abs(b) > HUGE or (a != 0 and abs(b * mpmath.log(a)) > HUGE):
                raise ArithmeticError
            return a**b
    raise Unreadable(f"the expression has {type(op).__name__} in it; + - * / ** are read")
