"""Branches as files: JSON to be read by anything, npz for long ones; both whole or not at all, and never pickled.

One record, two dresses. Arrays: lam (m,), u (m, n), tangent (m, n + 1) and, for each event, its own and the fence around it,
so that a branch that was read can be extended and switched from like the one that was followed. Where meshes differ along the
branch, u and tangent are laid end to end, `sizes` (m,) long, and each point names the recipe of its own equations.
"""

import io
import json
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rodlab.analysis.curve import Segment
from rodlab.analysis.equations import Equations
from rodlab.analysis.events import Event
from rodlab.analysis.follow import Branch
from rodlab.analysis.newton import Newton, NoConvergence
from rodlab.analysis.point import Point
from rodlab.files import write_whole
from rodlab.numerics.arrays import Array
from rodlab.numerics.inertia import Inertia
from rodlab.version import __version__

SCHEMA = 2
SUFFIXES = (".json", ".npz")


class Recorded:
    """Stands where a model was: it can say what was recorded, and no more."""

    def __init__(self, said: str) -> None:
        self.said = said

    def __repr__(self) -> str:
        return f"Recorded({self.said})"

    def _missing(self, *_: Any) -> Any:
        raise ValueError(f"the branch was read without its model; give it: rl.read(path, model=...). It was {self.said}")

    residual = jacobian = d_lam = inner = _missing


def save(branch: Branch, path: Any) -> Path:
    """Write a branch to a .json or .npz file, whole or not at all; `ValueError` when it cannot be written."""
    path = place(path)
    record, arrays = _record(branch)
    if path.suffix == ".json":
        whole = {**record, "arrays": {name: array.tolist() for name, array in arrays.items()}}
        return write_whole(path, json.dumps(whole, allow_nan=False) + "\n")
    out = io.BytesIO()
    np.savez_compressed(out, record=np.array(json.dumps(record, allow_nan=False)), **arrays)  # type: ignore[arg-type]
    return write_whole(path, out.getvalue())


def load(path: Any, model: Equations | None, rebuild: Callable[[Mapping[str, Any]], Equations]) -> Branch:
    """Read what `save` wrote. model: the equations; None asks `rebuild` with the recipe in the file, if it has one.

    Raises `ValueError`, in one sentence, for a file that is not a whole branch, or whose points do not solve the model.
    """
    record, arrays = _opened(place(path))
    try:
        if record["schema"] != SCHEMA:
            raise ValueError(f"{path} has schema {record['schema']}; this rodlab reads {SCHEMA}")
        models = _equations(record, model, rebuild)
        ends = np.cumsum(arrays["sizes"]).astype(int)
        points = [_point(models[entry["model"]], entry, i, arrays, ends) for i, entry in enumerate(record["points"])]
        events = [_event(models[entry["model"]], entry, i, arrays, points) for i, entry in enumerate(record["events"])]
    except (KeyError, IndexError, TypeError) as error:
        raise ValueError(f"{path} is not a whole branch: {error!r}") from None
    if not points or not events:
        raise ValueError(f"{path} is not a whole branch: it has no points or no end")
    if not isinstance(models[0], Recorded):
        _solves(points, path)
    return Branch(points, events, str(record.get("begin", "")))


def place(path: Any) -> Path:
    """The path of a branch's file; `ValueError` unless it ends in .json or .npz."""
    known = Path(path)
    if known.suffix not in SUFFIXES:
        raise ValueError(f"path must end in .json or .npz; it is {str(path)!r}")
    return known


# --- out ---------------------------------------------------------------------------------------------------------


def _record(branch: Branch) -> tuple[dict[str, Any], dict[str, Array]]:
    points = branch.points
    model, models = points[0].equations, _models(branch)
    arrays = {
        "lam": branch.lam,
        "sizes": np.array([p.u.size for p in points], dtype=np.float64),
        "u": np.concatenate([p.u for p in points]),
        "tangent": np.concatenate([np.zeros(p.u.size + 1) if p.tangent is None else p.tangent for p in points]),
    }
    for i, e in enumerate(branch.events):
        arrays[f"event{i}_y"] = np.append(e.point.u, e.point.lam)
        if e.point.tangent is not None:
            arrays[f"event{i}_tangent"] = e.point.tangent
        if e.null is not None:
            arrays[f"event{i}_null"] = e.null
        if e.fence is not None:
            arrays[f"event{i}_fence"] = np.array([e.fence.a, e.fence.ta, e.fence.b, e.fence.tb, e.fence.row])
    record = {
        "schema": SCHEMA, "rodlab": __version__, "what": "branch", "model": repr(model), "begin": branch.begin,
        "recipes": [getattr(own, "recipe", None) for own in models],
        "meshes": [None if getattr(own, "mesh", None) is None else np.asarray(own.mesh).tolist() for own in models],
        "points": [{**_said(p), "model": _place(models, p)} for p in points],
        "events": [
            {
                "kind": e.kind, "lam": e.lam, "error": e.error if np.isfinite(e.error) else None, "multiplicity": e.multiplicity,
                "reason": e.reason, "converged": e.converged, "where": e.where, "measures": _measures(e.point),
                "accepted": e.point.accepted, "model": _place(models, e.point),
            }
            for e in branch.events
        ],
    }  # fmt: skip
    return record, arrays


def _models(branch: Branch) -> list[Any]:
    """The equations of all points and events, each once."""
    models: list[Any] = []
    for p in [*branch.points, *(e.point for e in branch.events)]:
        if not any(own is p.equations for own in models):
            models.append(p.equations)
    return models


def _place(models: list[Any], p: Point) -> int:
    return next(i for i, own in enumerate(models) if own is p.equations)


def _said(p: Point) -> dict[str, Any]:
    known = p.inertia if not isinstance(p.equations, Recorded) else p.known_inertia
    return {
        "lam": p.lam, "accepted": p.accepted, "remaining": float(np.nan_to_num(p.remaining)), "tangent": p.tangent is not None,
        "inertia": None if known is None else list(known), "measures": _measures(p),
    }  # fmt: skip


def _measures(p: Point) -> dict[str, float]:
    names = p.recorded if isinstance(p.equations, Recorded) else getattr(p.equations, "measures", {})
    known = {name: p.measure(name) for name in names or {}}
    return {name: value for name, value in known.items() if np.isfinite(value)}


# --- in ----------------------------------------------------------------------------------------------------------


def _opened(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    try:
        if path.suffix == ".json":
            record = json.loads(path.read_text(encoding="utf-8"))
            arrays = {name: np.asarray(values, dtype=np.float64) for name, values in record["arrays"].items()}
            return record, arrays
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        return json.loads(str(arrays.pop("record"))), arrays
    except OSError as error:
        raise ValueError(f"{path} cannot be read: {error.strerror or error}") from None
    except (ValueError, KeyError, TypeError, AttributeError, EOFError, zipfile.BadZipFile, RecursionError) as error:
        raise ValueError(f"{path} is not a branch that rodlab saved: {str(error)[:80]}") from None


def _equations(record: Mapping[str, Any], model: Any, rebuild: Callable[[Mapping[str, Any]], Equations]) -> list[Any]:
    """The equations that the file's points name: the model given, on the recorded meshes if it has any, or made from recipes."""
    recipes = record["recipes"]
    if model is not None:
        on = getattr(model, "on_points", None)
        return [model if on is None or mesh is None else on(mesh) for mesh in record["meshes"]]
    return [Recorded(str(record["model"])) if recipe is None else rebuild(recipe) for recipe in recipes]


def _point(equations: Any, entry: Mapping[str, Any], i: int, arrays: Mapping[str, Array], ends: Any) -> Point:
    inertia = None if entry["inertia"] is None else Inertia(*entry["inertia"])
    stop, size = int(ends[i]), int(arrays["sizes"][i])
    tangent = np.array(arrays["tangent"][stop - size + i : stop + i + 1]) if entry["tangent"] else None
    return Point(
        equations, float(arrays["lam"][i]), np.array(arrays["u"][stop - size : stop]), (), float(entry["remaining"]), tangent,
        str(entry["accepted"]), inertia, dict(entry["measures"]) if isinstance(equations, Recorded) else None,
    )  # fmt: skip


def _event(equations: Any, entry: Mapping[str, Any], i: int, arrays: Mapping[str, Array], points: list[Point]) -> Event:
    y = arrays[f"event{i}_y"]
    fence = arrays.get(f"event{i}_fence")
    point = Point(
        equations, float(y[-1]), y[:-1].copy(), tangent=arrays.get(f"event{i}_tangent"), accepted=str(entry["accepted"]),
        recorded=dict(entry["measures"]) if isinstance(equations, Recorded) else None,
    )  # fmt: skip
    error = np.inf if entry["error"] is None else float(entry["error"])
    return Event(
        str(entry["kind"]), float(entry["lam"]), error, points[-1] if entry["kind"] == "end" else point,
        int(entry["multiplicity"]), str(entry["reason"]), bool(entry["converged"]), arrays.get(f"event{i}_null"),
        float(entry["where"]), None if fence is None else Segment(*fence),
    )  # fmt: skip


def _solves(points: list[Point], path: Any) -> None:
    """Raise unless Newton's method, from the first and the last point, stays there."""
    for p in (points[0], points[-1]):
        try:
            root = Newton.at(p.equations, p.lam, 20).solve(p.u)
            off = float(np.abs(root.u - p.u).max(initial=0.0))
        except (NoConvergence, ValueError, ArithmeticError) as error:
            raise ValueError(f"{path} does not hold solutions of this model: {error}") from None
        if off > 1e-6 * (1 + float(np.abs(p.u).max(initial=0.0))):
            raise ValueError(f"{path} does not hold solutions of this model: the nearest one is {off:.2g} away")
