"""What answers look like in a file: the frame that every JSON answer has, tidy CSV."""

import csv
import io
import json
from collections.abc import Mapping, Sequence
from typing import Any

from rodlab.version import __version__

SCHEMA = 1


def framed(verb: str, seconds: float, content: Mapping[str, Any]) -> dict[str, Any]:
    """One object with what every verb says: schema, version, verb and run time."""
    return {"schema": SCHEMA, "rodlab": __version__, "verb": verb, "seconds": seconds, **content}


def as_json(answer: Mapping[str, Any]) -> str:
    """JSON text with numbers at full precision; arrays as lists. NaN and infinities, which JSON lacks, become null."""
    return json.dumps(_plain(answer), indent=1, allow_nan=False)


def as_csv(columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """Tidy CSV text, numbers at full precision."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([[_plain(value) for value in row] for row in rows])
    return out.getvalue()


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not abs(value) < float("inf"):
        return None
    return value
