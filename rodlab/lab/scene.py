"""A scene: a model, the branches to follow on it, and what to draw, as a small TOML file.

    title = "..."                       [model]  n = 50          [[follow]]  name = "detached"
    source = "N 2.7"                             u_hat = 0.01                from = 10.0
    about = "..."                                                            guess = "-3*sin(pi*s/2)"
                                        [draw]   y = "tip_angle"             to = 0.0
                                             shapes = [{of = "detached", at = 5.0}]

[model] is a recipe (`rodlab.mechanics.recipe`). [[follow]] takes name, from, guess (an expression in s), to, step, events,
within, max_points, and switch: from how many branch points the half-branches are followed as well. [draw] takes y, a measure,
formats, shapes, states to draw to scale with their supports and loads, and indices, whether both indices of each are told
(`rodlab.mechanics.indices`). Without [draw] nothing is drawn.
Scenes of the house are called by name, your own by path. In place of [[follow]] one question about all of it:

    [diagram]       from, to, detached            every branch in a window of loads
    [equilibria]    lam, n                        every equilibrium at a load, for several n, on the standard map
    [breaking]      parameter, most, show         a pitchfork and its imperfection
    [agreement]     case, joints                  strut against rod, in one table of orders
    [convergence], [work-precision], [stability]  a study: see `rodlab.lab.studies`; [stability] needs no [model]
"""

import time
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.events import branch_point, fold
from rodlab.analysis.follow import Branch, follow
from rodlab.analysis.point import Point
from rodlab.analysis.switching import switch
from rodlab.lab.answers import MEASURES, OF_ENDS
from rodlab.lab.branches import Shown
from rodlab.mechanics.expression import Expression
from rodlab.mechanics.recipe import build
from rodlab.numerics.arrays import number, whole

HOUSE = Path(__file__).with_name("scenes")
FORMATS = ("png", "pdf", "svg")
EVENTS = {"fold": fold, "branch point": branch_point}
ASKS = {
    "diagram": ("from", "to", "detached"),
    "equilibria": ("lam", "n"),
    "breaking": ("parameter", "most", "show"),
    "agreement": ("case", "joints"),
    "convergence": ("methods", "joints", "intervals", "ask", "quick", "shapes"),
    "work-precision": ("ask", "methods", "repeats", "quick"),
    "stability": ("grid",),
}
DRAWN = ("y", "formats", "shapes", "indices")
OPTIONS = ("name", "from", "to", "guess", "step", "events", "within", "max_points", "switch")


@dataclass(frozen=True)
class Scene:
    """What a scene's file says, checked; the model is made when it is asked for."""

    name: str
    title: str
    source: str
    about: str
    model: Mapping[str, Any]
    follow: tuple[Mapping[str, Any], ...] = ()
    draw: Mapping[str, Any] = field(default_factory=dict)
    asks: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


def scenes() -> list[Scene]:
    """The scenes of the house, by name.

    >>> [scene.name for scene in scenes()][:3]
    ['agreement', 'bend', 'clamped-hinged']
    """
    return [read_scene(path) for path in sorted(HOUSE.glob("*.toml"))]


def scene(name: str) -> Scene:
    """A scene by its name in the house, or by the path of its file; `ValueError` in one sentence where there is none."""
    path = Path(name)
    if path.suffix == ".toml":
        return read_scene(path)
    known = [scene.name for scene in scenes()]
    if name not in known:
        raise ValueError(f"scene must be one of {', '.join(known)}, or the path of a .toml file; it is {name!r}")
    return read_scene(HOUSE / f"{name}.toml")


def read_scene(path: Path) -> Scene:
    """The scene in a file, checked as far as that needs no computing."""
    try:
        given = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(f"{path} cannot be read: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path} is not TOML: {error}") from None
    known = ("title", "source", "about", "model", "follow", "draw", *ASKS)
    unknown = sorted(set(given) - set(known))
    if unknown:
        raise ValueError(f"{path}: a scene is made of {', '.join(known)}; {unknown[0]} is none of these")
    if not isinstance(given.get("model", {} if "stability" in given else None), dict):
        raise ValueError(f"{path}: a scene needs a [model] table")
    asks = {name: _asked(path, name, given[name]) for name in ASKS if name in given}
    runs = given.get("follow", [] if asks else None)
    if not isinstance(runs, list) or not (runs or asks) or not all(isinstance(run, dict) for run in runs):
        raise ValueError(f"{path}: a scene needs at least one [[follow]] table, or one of [{'], ['.join(ASKS)}]")
    for run in runs:
        wrong = sorted(set(run) - set(OPTIONS))
        if wrong or "to" not in run:
            said = f"{wrong[0]} is none of these" if wrong else "to is missing"
            raise ValueError(f"{path}: [[follow]] takes {', '.join(OPTIONS)}; {said}")
    texts = {name: str(given.get(name, "")) for name in ("title", "source", "about")}
    return Scene(
        path.stem, **texts, model=given.get("model", {}), follow=tuple(runs), draw=_drawn(path, given.get("draw", {})), asks=asks
    )


def run(scene: Scene, watch: Callable[[Point], Any] | None = None) -> Iterator[Shown]:
    """The branches of a scene, one after the other, with the time each took."""
    model = build(scene.model)
    for i, options in enumerate(scene.follow):
        name = str(options.get("name", f"branch {i + 1}"))
        own, to, given = _options(options, watch)
        start = time.perf_counter()
        p = equilibrium(model, number("from", options.get("from", getattr(model, "value", 0.0))), _guess(options))
        branch = follow(p, to, **given)
        yield Shown(name, branch, time.perf_counter() - start)
        yield from _switched(name, branch, own, to, given)


def _switched(name: str, branch: Branch, most: int, to: float, options: dict[str, Any]) -> Iterator[Shown]:
    points = [event for event in branch.events if event.kind == "branch point"]
    for j, event in enumerate(points[:most], start=1):
        for k, start in enumerate(switch(event), start=1):
            begin = time.perf_counter()
            yield Shown(f"{name} / {j}.{k}", follow(start, to, **options), time.perf_counter() - begin)


def _options(options: Mapping[str, Any], watch: Callable[[Point], Any] | None) -> tuple[int, float, dict[str, Any]]:
    given: dict[str, Any] = {"watch": watch}
    if "step" in options:
        given["step"] = options["step"]
    if "max_points" in options:
        given["max_points"] = options["max_points"]
    if "within" in options:
        within = options["within"]
        if not isinstance(within, dict):
            raise ValueError(f"within must be a table of measures and their limits; it is {within!r:.60}")
        given["within"] = within
    if "events" in options:
        names = options["events"]
        if not isinstance(names, list) or not all(name in EVENTS for name in names):
            raise ValueError(f"events must be a list of {', '.join(map(repr, EVENTS))}; it is {names!r:.60}")
        given["events"] = tuple(EVENTS[event] for event in options["events"])
    return whole("switch", options.get("switch", 0), least=0), number("to", options["to"]), given


def _guess(options: Mapping[str, Any]) -> Any:
    if "guess" not in options:
        return None
    guess = options["guess"]
    if not isinstance(guess, str):
        return np.asarray(guess, dtype=np.float64)
    return Expression(guess)


def _asked(path: Path, name: str, options: Any) -> Mapping[str, Any]:
    wrong = sorted(set(options) - set(ASKS[name])) if isinstance(options, dict) else [options]
    if wrong:
        raise ValueError(f"{path}: [{name}] takes {', '.join(ASKS[name])}; {wrong[0]} is none of these")
    return dict(options)


def _drawn(path: Path, draw: Any) -> Mapping[str, Any]:
    if not isinstance(draw, dict) or set(draw) - set(DRAWN) or draw.get("y", "tip_angle") not in (*MEASURES, *OF_ENDS):
        ys = ", ".join((*MEASURES, *OF_ENDS))
        raise ValueError(f"{path}: [draw] takes y, one of {ys}, formats, shapes and indices; it is {draw!r:.60}")
    shapes = draw.get("shapes", [])
    if not isinstance(shapes, list) or not all(isinstance(one, dict) and {"at"} <= set(one) <= {"of", "at"} for one in shapes):
        raise ValueError(f"{path}: shapes must be a list of tables of at and, it may be, of; it is {shapes!r:.60}")
    formats = draw.get("formats", ["png"])
    if not isinstance(formats, list) or not all(name in FORMATS for name in formats):
        raise ValueError(f"{path}: formats must be a list of {', '.join(FORMATS)}; it is {formats!r:.60}")
    return draw
