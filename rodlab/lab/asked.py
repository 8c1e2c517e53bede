"""What a scene asks about all of it: every branch, every equilibrium, a pitchfork and its imperfection. One function a question.

Each gives (answer for JSON, text, a function that draws, whether it is complete).
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from rodlab.analysis.diagram import diagram
from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.follow import Branch, follow
from rodlab.lab.branches import detached, mode_branch, trivial
from rodlab.lab.breaking import Breaking, breaking
from rodlab.lab.census import census
from rodlab.lab.charts import diagram_tables, equilibria_table, of_diagram, of_equilibria
from rodlab.lab.equilibria import all_equilibria
from rodlab.lab.scene import Scene
from rodlab.lab.table import table
from rodlab.mechanics.joints import RULES
from rodlab.mechanics.recipe import build
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import number


class Answer(NamedTuple):
    """What a question of a scene came to."""

    said: dict[str, Any]
    text: str
    draw: Callable[[], Any] | None
    complete: bool


def asked(scene: Scene) -> dict[str, Answer]:
    """The answers to a scene's questions, by name."""
    every = {"diagram": _diagram, "equilibria": _equilibria, "breaking": _breaking, "agreement": _agreement}
    return {name: every.get(name, _study)(scene, options) for name, options in scene.asks.items()}


def _diagram(scene: Scene, options: Mapping[str, Any]) -> Answer:
    model: Any = build(scene.model)
    window = number("from", options.get("from", 0.0)), number("to", options.get("to"))
    found = (census if options.get("detached") else diagram)(model, window)

    def draw() -> Any:
        from rodlab.lab.diagram_picture import diagram_picture

        return diagram_picture(found, str(scene.draw.get("y", "tip_angle")))

    return Answer(of_diagram(found), diagram_tables(f"Special points of {model!r}", found), draw, found.complete)


def _equilibria(scene: Scene, options: Mapping[str, Any]) -> Answer:
    strut = _strut(scene, "equilibria")
    sizes = options.get("n", [strut.n])
    if not isinstance(sizes, list):
        raise ValueError(f"n must be a list of numbers of joints; it is {sizes!r:.60}")
    found = [all_equilibria(strut.replace(n=n), number("lam", options.get("lam"))) for n in sizes]

    def draw() -> Any:
        from rodlab.lab.map_picture import map_picture

        return map_picture(*found)

    said = {"struts": [{"n": one.strut.n, **of_equilibria(one, connected=True)} for one in found]}
    text = "\n\n".join(equilibria_table(one, connected=True) for one in found)
    return Answer(said, text, draw, all(one.certified for one in found))


def _breaking(scene: Scene, options: Mapping[str, Any]) -> Answer:
    strut = _strut(scene, "breaking")
    if not strut.is_straight:
        raise ValueError(f"[breaking] asks of a straight strut; {strut!r} is not")
    name, show = str(options.get("parameter", "u_hat")), options.get("show", [0.1, 0.01])
    found = breaking(strut, name, number("most", options.get("most", 0.1)))

    def draw() -> Any:
        from rodlab.lab.cusp_picture import cusp_picture

        top = 2 * found.event.lam
        perfect = [trivial(strut, 1), mode_branch(strut, 1, top)]
        return cusp_picture(found, perfect, [(beta, _bent(strut.replace(**{name: beta}), top)) for beta in show])

    columns = {"off": found.off, "beta": found.beta, "exponent": found.exponent}
    tips = {"imperfection": found.small, "tip_angle": found.tips, "root": found.root}
    said = {"lam": found.event.lam, "strength": found.imperfection.strength, "cusp": columns, "tips": tips}
    return Answer(said, _laws(found), draw, complete=True)


def _agreement(_: Scene, options: Mapping[str, Any]) -> Answer:
    from rodlab.lab.agreement import agreement, agreement_table, of_agreement

    found = agreement(options.get("case", []), options.get("joints", [50, 100, 200, 400]))
    return Answer(
        {"cases": of_agreement(found)}, agreement_table(found), None, all(one.holds(rule) for one in found for rule in RULES)
    )


def _study(scene: Scene, _: Mapping[str, Any]) -> Answer:
    from rodlab.lab.studies.study import study

    found = study(scene)
    return Answer(found.answer, found.said, found.figure, found.complete)


def _strut(scene: Scene, name: str) -> Strut:
    strut = build(scene.model)
    if not isinstance(strut, Strut):
        raise ValueError(f"[{name}] asks of a strut; the model is {strut!r:.60}")
    return strut


def _bent(strut: Any, top: float) -> list[Branch]:
    return [follow(equilibrium(strut, 0.0), to=top), follow(detached(strut, top), to=0.0)]


def _laws(b: Breaking) -> str:
    name = b.imperfection.name
    slopes = ["", *(f"{x:.5f}" for x in b.exponent)]
    rows = [[f"{x:.0e}", f"{beta:.9e}", slope] for x, beta, slope in zip(b.off, b.beta, slopes, strict=True)]
    first = table(f"Folds above the pitchfork at {b.event.lam:.12g}", ["load above", name, "exponent"], rows)
    roots = ["", *(f"{x:.5f}" for x in b.root)]
    rows = [[f"{x:.0e}", f"{tip:.9e}", slope] for x, tip, slope in zip(b.small, b.tips, roots, strict=True)]
    second = table("Tip angle at the load of the pitchfork", [name, "tip angle", "exponent"], rows)
    cusps = [f"{e.lam:.12g}" for e in b.curve.events if e.kind == "fold"]
    return f"{first}\n\n{second}\n\n{b.imperfection!r}; cusp of the curve of folds at {', '.join(cusps)}"
