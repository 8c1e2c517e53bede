"""Values as plain data: what goes between the process that grades and the process that answers.

Numbers, texts, lists, dictionaries, arrays, complex numbers, expressions (as text) and the source of functions; whatever
else an answer returns arrives as the name of its type. Nothing is pickled: an object that lies about itself cannot travel.
Standard library only, as this file is also run in the child.
"""

import sys
from typing import Any

DEEPEST = 12
LARGEST = 10**6  # numbers of an array
WIDEST = 1024  # bits of a whole number: those of a float
BASES: dict[type, Any] = {str: str.__str__, int: int.__int__, float: float.__float__}


class Code:
    """A function given by its source, so that it can be called here and there.

    >>> Code("lambda x: x - 1")(3)
    2
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self._function: Any = None

    def __call__(self, *arguments: Any) -> Any:
        if self._function is None:
            self._function = compiled(self.text)
        return self._function(*arguments)

    def __repr__(self) -> str:
        return self.text


class Written:
    """An expression as text, such as SymPy prints it; only `formula` gives it a value."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text


class Other:
    """What is no plain value: only the name of its type arrived."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __repr__(self) -> str:
        return f"an object of type {self.name}"


def compiled(text: str) -> Any:
    """The function of a teacher's source: one expression, with numpy as np."""
    import numpy as np

    return eval(compile(text, "given", "eval"), {"np": np})  # noqa: S307 the checker's own text


def encode(x: Any, depth: int = 0) -> Any:
    """A value as what JSON can carry.

    >>> encode((1, 2.5, "a", None, 1j))
    [1, 2.5, 'a', None, {'complex': [0.0, 1.0]}]
    >>> encode(object())
    {'other': 'object'}
    >>> encode(10**5000)
    {'other': 'a whole number of 16610 bits'}
    """
    try:
        return _encode(x, depth)
    except Exception:  # noqa: BLE001 a hostile object may raise anything
        return {"other": named(x)}


def named(x: Any) -> str:
    """The name of a type, whatever its metaclass says that it is."""
    return str.__str__(type.__dict__["__name__"].__get__(type(x)))[:60]


def _encode(x: Any, depth: int) -> Any:
    if depth > DEEPEST:
        return {"other": "nested too deeply"}
    if type(x) is int and x.bit_length() > WIDEST:
        return {"other": f"a whole number of {x.bit_length()} bits"}
    if x is None or type(x) in (bool, int, float, str):
        return x
    np: Any = sys.modules.get("numpy")
    if np is not None and isinstance(x, np.generic):
        return _encode(x.item(), depth + 1)
    if np is not None and isinstance(x, np.ndarray):
        return _array(np, x, depth)
    for base, value in BASES.items():  # a subclass gives its value as its base class has it
        if isinstance(x, base):
            return _encode(value(x), depth + 1)
    if isinstance(x, complex):
        return {"complex": [complex.__complex__(x).real, complex.__complex__(x).imag]}
    if isinstance(x, list | tuple | range):
        return [encode(y, depth + 1) for y in x]
    if isinstance(x, dict):
        return {"dict": [[str(key), encode(y, depth + 1)] for key, y in x.items()]}
    return _known(x, depth)


def _array(np: Any, x: Any, depth: int) -> Any:
    if max(x.size, *x.shape, 0) > LARGEST:
        return {"other": f"an array of shape {x.shape}"}
    if x.dtype.kind == "c":
        return {
            "array": x.real.astype(float).ravel().tolist(),
            "imag": x.imag.astype(float).ravel().tolist(),
            "shape": list(x.shape),
        }
    if x.dtype.kind in "biuf":
        return {"array": np.asarray(x, dtype=float).ravel().tolist(), "shape": list(x.shape)}
    return encode(x.tolist(), depth + 1)


def _known(x: Any, depth: int) -> Any:
    """What the libraries of the course return, and the classes of this file."""
    if isinstance(x, Code):
        return {"code": x.text}
    if isinstance(x, Written):
        return {"expression": x.text}
    module = type(x).__module__
    if module.startswith("mpmath"):
        import mpmath

        return {"expression": mpmath.nstr(x, 60)}
    if module.startswith("sympy"):
        return encode(x.tolist(), depth + 1) if hasattr(x, "tolist") else {"expression": str(x)}
    if module.startswith("scipy.sparse"):
        return encode(x.toarray(), depth + 1)
    return {"other": named(x)}


def decode(x: Any, *, code: bool = True) -> Any:
    """The value again: arrays are numpy's, and what was no plain value is an `Other`.

    What an answer returned is decoded without `code`: its texts are never functions here. `ValueError` for what `encode` does not
    write: lists without end, arrays of other shapes than their numbers fill.
    """
    return _decode(x, code, 0)


def _decode(x: Any, code: bool, depth: int) -> Any:
    if depth > 2 * DEEPEST:
        raise ValueError("nested too deeply")
    if isinstance(x, list):
        return [_decode(y, code, depth + 1) for y in x]
    if isinstance(x, int) and x.bit_length() > WIDEST:
        return Other(f"a whole number of {x.bit_length()} bits")
    if not isinstance(x, dict):
        return x
    match x:
        case {"array": list(entries), "shape": list(shape)}:
            return _filled(entries, x.get("imag"), shape)
        case {"complex": [int() | float() as re, int() | float() as im]}:
            return complex(re, im)
        case {"dict": list(pairs)}:
            return {str(key): _decode(y, code, depth + 1) for key, y in pairs if isinstance(key, str)}
        case {"expression": str(text)}:
            return Written(text)
        case {"code": str(text)} if code:
            return Code(text)
        case {"other": str(text)}:
            return Other(text[:80])
    return Other("unknown")


def _filled(entries: list[Any], imag: Any, shape: list[Any]) -> Any:
    import numpy as np

    if not all(type(n) is int and 0 <= n <= LARGEST for n in shape):
        raise ValueError("no shape")
    values: Any = np.array(entries, dtype=float)
    if imag is not None:
        values = values + 1j * np.array(imag, dtype=float)
    if values.ndim != 1:
        raise ValueError("no list of numbers")
    return values.reshape(shape)
