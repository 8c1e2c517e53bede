"""What the command line takes: the parser, and what was given as a model's recipe, a study's question, a number of processes."""

from __future__ import annotations

import argparse
import re

from rodlab.version import __version__

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import Any


def parser(verbs: Mapping[str, Callable[..., int]]) -> argparse.ArgumentParser:
    """The parser of the command line; `verbs` are its functions by name."""
    parser = argparse.ArgumentParser(prog="rodlab", description="A teaching laboratory for elastic rods.")
    parser.add_argument("--json", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--version", action="version", version=f"rodlab {__version__}")
    known = parser.add_subparsers(dest="verb", metavar="VERB")

    verb = _verb(known, verbs["tour"], "the main job: the strut at several n, tables, pictures and data, in seconds")
    verb.add_argument("--out", default="rodlab-tour", metavar="DIR", help="folder for pictures and data (default: %(default)s)")

    verb = _verb(known, verbs["buckling"], "buckling loads of a straight strut or rod, with error bounds")
    _model_options(verb, 1000, straight=True)
    verb.add_argument("--modes", type=int, help="how many loads (default: 3)")

    verb = _verb(known, verbs["follow"], "follow a branch of a strut or rod to a load, with its folds and branch points")
    _model_options(verb, 100)
    verb.add_argument("--from", dest="start", type=float, default=0.0, metavar="LAM", help="load to start at (default: 0)")
    verb.add_argument("--to", type=float, required=True, metavar="LAM", help="load to end at")
    verb.add_argument("--mode", type=int, help="the branch that buckles in this mode, from its branch point")
    verb.add_argument("--guess", help='first guess at --from, --guess="-3*sin(pi*s/2)" (default: unstressed)')
    verb.add_argument("--step", type=float, help="first and longest length of a step (default: by error)")
    verb.add_argument("--max-points", type=int, default=10_000, help="points at most (default: %(default)s)")
    verb.add_argument("--out", metavar="FILE", help="also save the branch, to a .json or .npz file")

    verb = _verb(
        known, verbs["diagram"], "every branch connected to the unstressed shape in a window of loads, and all special points"
    )
    _model_options(verb, 100)
    verb.add_argument("--from", dest="start", type=float, default=0.0, metavar="LAM", help="lower edge (default: 0)")
    verb.add_argument("--to", type=float, required=True, metavar="LAM", help="upper edge of the window")
    verb.add_argument("--detached", action="store_true", help="also the branches that are not connected")
    verb.add_argument("--step", type=float, help="first and longest length of a step (default: by error)")
    verb.add_argument("--y", choices=["tip_angle", "height", "energy"], default="tip_angle", help="what the picture shows")
    verb.add_argument("--out", metavar="FILE", help="draw it, to a .png, .pdf or .svg file")

    verb = _verb(known, verbs["equilibria"], "every equilibrium of a strut at a load, certified to be all")
    _model_options(verb, 5, models=("strut",))
    verb.add_argument("--lam", type=float, required=True, help="the load")
    certify = argparse.BooleanOptionalAction
    verb.add_argument("--certify", action=certify, help="prove that these are all (default); given, it is a check that may fail")
    verb.add_argument("--connected", action=certify, default=True, help="say which are connected to the unstressed shape")
    verb.add_argument("--engine", choices=["flint", "mpmath"], help="arithmetic of the proof (default: flint if installed)")
    verb.add_argument("--out", metavar="FILE", help="draw them on the standard map, to a .png, .pdf or .svg file")

    verb = _verb(
        known, verbs["study"], "error against n, against run time, and where it is hard: orders, floors, limits, verdicts"
    )
    what = "convergence, work-precision, stability, or the path of a scene's .toml that asks for one of them"
    verb.add_argument("study", metavar="STUDY", help=what)
    verb.add_argument("--quick", action="store_true", help="fewer cells, in seconds")
    verb.add_argument("--peers", action="store_true", help="work-precision: beside scipy's solve_bvp and AUTO, where installed")
    verb.add_argument("--out", metavar="DIR", help="folder for tables, shapes, pictures, and to go on from when killed")
    verb.add_argument("--jobs", type=int, help="processes (default: all cores; 1 for work-precision, whose run times count)")
    verb.add_argument("--cluster", metavar="ADDRESS", help="a Dask scheduler's address, or local, with --jobs workers")
    _question_options(verb)

    _verb(known, verbs["scenes"], "the situations of the notes by name")

    verb = _verb(known, verbs["run"], "run a scene: its branches, events, picture and data")
    verb.add_argument("scene", metavar="SCENE", help="a name that `rodlab scenes` lists, or the path of a .toml file")
    verb.add_argument("--out", metavar="DIR", help="folder for the picture and the data (default: nothing is written)")
    verb.add_argument(
        "--account", action="store_true", help="say instead what it costs, and what it is spared: imports, kernels, seconds"
    )
    _exercise_verbs(known, verbs)
    return parser


def model_of(chosen: argparse.Namespace) -> dict[str, Any]:
    """The recipe of the model that is asked for; one sentence for an option that the model does not have."""
    recipe: dict[str, Any] = {"model": chosen.model, "K": _number_or_text(chosen.K), "breaks": list(chosen.breaks)}
    own = {"strut": ("n", "rule"), "rod": ("degree", "mesh", "tol")}
    for name in (name for names in own.values() for name in names):
        value = getattr(chosen, name)
        if value is not None and name not in own[chosen.model]:
            raise ValueError(f"{name} must not be given for a {chosen.model}, which has none; it is {value!r}")
        if value is not None:
            recipe[name] = value
    if chosen.model == "strut":
        recipe = {"n": chosen.joints, "rule": "end", **recipe}
    if chosen.u_hat is not None:
        recipe["u_hat"] = _number_or_text(chosen.u_hat)
    if chosen.ends is not None:
        recipe["ends"] = [end.strip() for end in chosen.ends.split(",")]
    if chosen.term:
        recipe["terms"] = _terms(chosen.term)
    return recipe


def _terms(given: Sequence[str]) -> dict[str, dict[str, float | str]]:
    """Loads by name, each with its parameters, of texts such as "self_weight q=2"."""
    terms: dict[str, dict[str, float | str]] = {}
    for text in given:
        name, *parts = re.split(r"(?:^|\s+)([A-Za-z_]\w*)\s*=(?!=)", text.strip())
        parameters = {p: _number_or_text(value.strip()) for p, value in zip(parts[::2], parts[1::2], strict=True)}
        if not re.fullmatch(r"\w+", name) or not parameters or not all(value.strip() for value in parts):
            raise ValueError(f'term must be a name and its parameters, such as "self_weight q=2"; it is {text!r:.60}')
        if 2 * len(parameters) < len(parts):
            raise ValueError(f"term must give each parameter once; it is {text!r:.60}")
        if name in terms:
            raise ValueError(f"term must name each load once; {name} is given twice, the second time as {text!r:.60}")
        terms[name] = parameters
    return terms


def _model_options(
    verb: argparse.ArgumentParser, n: int, models: Sequence[str] = ("strut", "rod"), *, straight: bool = False
) -> None:
    verb.add_argument("--model", choices=models, default="strut", help="the model (default: %(default)s)")
    verb.add_argument("-n", type=int, help=f"of a strut: number of joints (default: {n})")
    verb.set_defaults(joints=n)
    verb.add_argument("--rule", help="of a strut: end or trapezoid (default: end)")
    verb.add_argument("--breaks", type=float, nargs="+", default=[], metavar="S", help="where K or u_hat jumps")
    verb.add_argument("--K", default="1", help='bending stiffness: a number or an expression in s, "1+s" (default: 1)')
    what = 'a load by its name and parameters, "self_weight q=2", "foundation c=1+s", "shearable A3=50"; again for another'
    verb.add_argument("--term", action="append", metavar="TERM", help=what)
    verb.set_defaults(degree=None, mesh=None, tol=None, u_hat=None, ends=None)
    if not straight:
        verb.add_argument("--u-hat", default="0", help="unstressed curvature: a number or an expression in s (default: 0)")
    if "rod" not in models:
        return
    what = "two of clamped, hinged, guided, free (default: clamped,free)"
    verb.add_argument("--ends", metavar="FOOT,TOP", help=what)
    verb.add_argument("--degree", type=int, help="of a rod: degree of the collocated polynomials (default: 6)")
    verb.add_argument("--mesh", type=int, help="of a rod: number of intervals (default: adapted)")
    verb.add_argument("--tol", type=float, help="of a rod: error of the angles that the mesh is adapted to (default: 1e-10)")


def _question_options(verb: argparse.ArgumentParser) -> None:
    own = verb.add_argument_group("a question of one's own, in place of those of the file")
    own.add_argument("--quantity", help="load, tip_angle, height, energy, index or fold")
    own.add_argument("--mode", type=int, help="buckling mode (default: 1)")
    own.add_argument("--lam", type=float, help="the load, for all but a buckling load")
    own.add_argument("--K", help='bending stiffness: a number or an expression in s, "1+s"')
    own.add_argument("--u-hat", help="unstressed curvature, likewise")
    own.add_argument("--breaks", type=float, nargs="+", metavar="S", help="where K or u_hat jumps")
    own.add_argument(
        "--methods", nargs="+", metavar="NAME", help='"strut, end", "strut, trapezoid", "rod, degree 4", "rod, adapted"'
    )
    own.add_argument("-n", "--joints", type=int, nargs="+", metavar="N", help="numbers of joints of the struts")
    own.add_argument("--intervals", type=int, nargs="+", metavar="N", help="numbers of intervals of the rods")


def _verb(known: Any, run: Any, what: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = known.add_parser(run.__name__, help=what, description=what[0].upper() + what[1:] + ".")
    parser.add_argument("--json", action="store_true", help="one JSON object on stdout, numbers at full precision")
    parser.set_defaults(run=run)
    return parser


def _exercise_verbs(known: Any, verbs: Mapping[str, Callable[..., int]]) -> None:
    verb = _verb(known, verbs["check"], "check an answer to an exercise, or those of a class")
    what = "an exercise's folder, or a .py or .ipynb file (default: list the exercises)"
    verb.add_argument("what", nargs="?", metavar="ANSWER", help=what)
    verb.add_argument(
        "--exercise", metavar="NAME", help="which exercise it answers (default: as its first line or its folder says)"
    )
    verb.add_argument("--exercises", metavar="DIR", help="a folder of exercises of one's own")
    verb.add_argument("--seed", type=int, help="check also on fresh parameters, each part for half of the points")
    verb.add_argument(
        "--gradescope", metavar="FILE", help="write Gradescope's results.json, with hidden tests on fresh parameters"
    )
    verb.add_argument("--class", dest="folder", metavar="DIR", help="grade every submission in a folder of students")
    verb.add_argument("--out", metavar="DIR", help="of a class: tables, Gradescope's files, picture (default: rodlab-class)")
    verb.add_argument("--jobs", type=int, help="of a class: submissions at a time (default: all cores)")

    verb = _verb(known, verbs["exercises"], "the exercises of the course; for teachers: make their folders from one file each")
    verb.add_argument("--exercises", metavar="DIR", help="a folder of exercises of one's own")
    verb.add_argument("--make", nargs="+", metavar="FILE", help="teachers' files, each to be made a folder")
    verb.add_argument("--out", metavar="DIR", help="where to (default: beside the folder of the teachers' files)")
    what = "make notebooks with solutions instead, as nbgrader or otter assign take them"
    verb.add_argument("--notebooks", choices=["nbgrader", "otter"], help=what)


def jobs_of(chosen: argparse.Namespace) -> int:
    """As many processes as asked for; without a word all cores, but one where run time is what is measured."""
    import os

    if chosen.jobs is not None:
        return int(chosen.jobs)
    return 1 if chosen.study == "work-precision" else os.cpu_count() or 1


def question_of(chosen: argparse.Namespace) -> dict[str, Any] | None:
    """One question of one's own in the place of the scene's, of what was given on the command line."""
    from rodlab.lab.studies.study import question_instead

    asked = {name: getattr(chosen, name) for name in ("quantity", "mode", "lam", "K", "u_hat", "breaks")}
    for name in ("K", "u_hat"):
        asked[name] = asked[name] and _number_or_text(asked[name])
    sizes = {name: getattr(chosen, name) for name in ("methods", "joints", "intervals")}
    return question_instead(chosen.study, asked, sizes)


def _number_or_text(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
