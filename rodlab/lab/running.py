"""`rodlab run`: a scene's branches, tables for the terminal, picture and data for a folder; what it does not name is left out."""

import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rodlab.analysis.point import Point
from rodlab.files import write_whole
from rodlab.lab.answers import branches_table, of_branch
from rodlab.lab.branches import Shown
from rodlab.lab.scene import Scene, run, scene
from rodlab.lab.store import as_json, framed

if TYPE_CHECKING:
    from rodlab.lab.asked import Answer


FOLLOWED = {
    "lam": r"load $\lambda$", "u_hat": r"unstressed curvature $\hat u$", "shortening": "end shortening $d$",
    "offset": "offset $x_1$", "q": "weight $q$", "c": "foundation $c$", "tau": r"couple $\tau$", "N1": "force across $N_1$",
    "phi1": r"angle of the top $\phi_1$", "phi0": r"angle of the clamp $\phi_0$",
}  # fmt: skip


def run_scene(name: str, folder: Path | None, watch: Callable[[Point], Any] | None = None) -> tuple[dict[str, Any], str, bool]:
    """(answer for JSON, text for a person, whether every branch was followed to its end)."""
    start, chosen = time.perf_counter(), scene(name)
    shown = list(run(chosen, watch))
    said = [{"branch": s.name, "seconds": s.seconds, **of_branch(s.branch)} for s in shown]
    answers = answers_of(chosen)
    about = {"scene": chosen.name, "title": chosen.title, "source": chosen.source, "model": dict(chosen.model)}
    answer = framed("run", time.perf_counter() - start, {**about, "branches": said} | {k: a.said for k, a in answers.items()})
    if chosen.draw.get("shapes"):
        from rodlab.lab.shapes_picture import of_states, states

        answer["shapes"] = of_states(states(shown, chosen.draw["shapes"]), both=bool(chosen.draw.get("indices")))
    answer["files"] = [] if folder is None else [str(path) for path in _written(chosen, shown, answers, answer, folder)]
    title = f"{chosen.title} [{chosen.source}]" if chosen.source else chosen.title
    parts = [chosen.about] if chosen.about else []
    parts += [branches_table(title, shown)] if shown else [title]
    parts += [a.text for a in answers.values()]
    parts.append(f"in {answer['seconds']:.2f} s" + "".join(f"\n  {path}" for path in answer["files"]))
    return answer, "\n\n".join(parts), all([*(s.branch.completed for s in shown), *(a.complete for a in answers.values())])


def answers_of(chosen: Scene) -> "dict[str, Answer]":
    """What the scene asks about all of it; the room of questions is entered only if it does."""
    if not chosen.asks:
        return {}
    from rodlab.lab.asked import asked

    return asked(chosen)


def pictures(chosen: Scene, shown: Sequence[Shown], answers: "Mapping[str, Answer]") -> dict[str, bytes]:
    """The scene's pictures as PNG, by name."""
    from rodlab.lab.picture import branches_picture, png

    drawn = {name: png(answer.draw()) for name, answer in answers.items() if answer.draw is not None}
    if shown:
        drawn["diagram"] = png(branches_picture(shown, str(chosen.draw.get("y", "tip_angle")), _label(chosen)))
    if chosen.draw.get("shapes"):
        from rodlab.lab.shapes_picture import shapes_picture, states

        both = bool(chosen.draw.get("indices"))
        drawn["shapes"] = png(shapes_picture(states(shown, chosen.draw["shapes"]), both=both))
    return drawn


def _written(chosen: Scene, shown: list[Shown], answers: "dict[str, Answer]", answer: dict[str, Any], folder: Path) -> list[Path]:
    files = [Path(s.branch.save(folder / f"branch-{i}.json")) for i, s in enumerate(shown, start=1)]
    files.append(write_whole(folder / "scene.json", as_json(answer) + "\n"))
    drawn = pictures(chosen, shown, answers) if chosen.draw else {}
    return files + [write_whole(folder / f"{name}.png", content) for name, content in drawn.items()]


def _label(chosen: Scene) -> str:
    """What is followed: the load, or another thing by its name."""
    name = str(chosen.model.get("vary", "lam"))
    return FOLLOWED.get(name, name)
