"""The command line: one verb a function, each importing its room when it is called.

Exit codes: 0 done, 1 a check failed, 2 bad usage or input, 3 not converged. Answers go to stdout, all else to stderr.
"""

from __future__ import annotations

import argparse
import sys
import time

from rodlab.version import __version__

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

WELCOME = f"""rodlab {__version__}: a teaching laboratory for elastic rods

Five commands to try:
  rodlab tour                                     the strut: branches, buckling loads and shapes, as n grows
  rodlab buckling --model rod --K "(1+s)**2"      buckling loads, with error bounds; -n 400 for a strut
  rodlab diagram -n 100 --to 130 --out all.png    every branch up to a load, special points, number of solutions
  rodlab study convergence --quick                orders, rounding floors and limits; work-precision and stability likewise
  rodlab run imperfect --out imperfect            a scene: branches, events, picture and data; rodlab scenes lists them
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code."""
    parser = _parser()
    chosen = parser.parse_args(arguments)
    try:
        code = welcome(chosen) if chosen.verb is None else int(chosen.run(chosen))
        sys.stdout.flush()
        return code
    except (ValueError, MemoryError, OverflowError) as error:
        large = isinstance(error, MemoryError) or "allowed size" in str(error) or "allowed dimension" in str(error)
        return _complain(chosen.verb, "n must be a number of joints that fits into memory" if large else str(error), 2)
    except ArithmeticError as error:  # NoConvergence among them
        return _complain(chosen.verb, str(error), 3)
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except OSError as error:
        return _complain(chosen.verb, f"the answer cannot be written: {error.strerror or error}", 2)
    except KeyboardInterrupt:
        return _complain(chosen.verb, "interrupted", 130)


def welcome(chosen: argparse.Namespace) -> int:
    """rodlab"""
    if chosen.json:
        from rodlab.lab.store import as_json, framed

        print(as_json(framed("", 0.0, {"welcome": WELCOME.splitlines()})))
    else:
        print(WELCOME, end="")
    return 0


def tour(chosen: argparse.Namespace) -> int:
    """rodlab tour"""
    from pathlib import Path

    from rodlab.lab.store import as_json
    from rodlab.lab.tour import tour

    answer, text = tour(Path(chosen.out))
    print(as_json(answer) if chosen.json else text)
    return 0


def buckling(chosen: argparse.Namespace) -> int:
    """rodlab buckling"""
    from rodlab.lab.store import as_json, framed
    from rodlab.lab.table import known_to, small, table
    from rodlab.mechanics.buckling import buckling_each, mode_numbers
    from rodlab.mechanics.recipe import build

    start = time.perf_counter()
    asked = _model(chosen)
    model: Any = build(asked)
    most = getattr(model, "n", 3)
    numbers = mode_numbers(model, min(3, most) if chosen.modes is None else chosen.modes)
    found = list(_progress(buckling_each(model, numbers), "buckling loads", len(numbers), asked.get("n", 10_000) * len(numbers)))
    loads, error = zip(*found, strict=True)
    seconds = time.perf_counter() - start
    if chosen.json:
        answer = framed("buckling", seconds, {**asked, "K": chosen.K, "modes": list(numbers), "loads": loads, "error": error})
        print(as_json(answer))
    else:
        rows: list[list[Any]] = [[j, known_to(load, e), small(e)] for j, load, e in zip(numbers, loads, error, strict=True)]
        print(table(f"Buckling loads of {model!r}", ["mode", "load", "error at most"], rows))
        print(f"in {1e3 * seconds:.1f} ms")
    return 0


def follow(chosen: argparse.Namespace) -> int:
    """rodlab follow"""
    from rodlab.analysis.saved import place
    from rodlab.lab import answers
    from rodlab.lab.following import followed
    from rodlab.lab.store import as_json, framed

    start = time.perf_counter()
    if chosen.out:
        place(chosen.out)  # a wrong name is said before the work, not after it
    asked = _model(chosen)
    model, branch = followed(
        asked, chosen.start, chosen.to, mode=chosen.mode, guess=chosen.guess,
        step=chosen.step, max_points=chosen.max_points, watch=_watched("points", asked.get("n", 100)),
    )  # fmt: skip
    written = [str(branch.save(chosen.out))] if chosen.out else []
    seconds = time.perf_counter() - start
    if chosen.json:
        asked |= {"from": chosen.start, "to": chosen.to, "mode": chosen.mode}
        print(as_json(framed("follow", seconds, {**asked, **answers.of_branch(branch), "files": written})))
    else:
        title = f"{'Main branch' if chosen.mode is None else f'Branch of mode {chosen.mode}'} of {model!r}"
        print(answers.points_table(title, branch), answers.events_table(branch), sep="\n\n")
        print(f"in {1e3 * seconds:.0f} ms" + "".join(f"; written: {path}" for path in written))
    return 0 if branch.completed else _complain("follow", branch.reason, 3)


def diagram(chosen: argparse.Namespace) -> int:
    """rodlab diagram"""
    from rodlab.analysis.diagram import diagram
    from rodlab.lab.charts import diagram_tables, of_diagram
    from rodlab.lab.store import as_json, framed
    from rodlab.mechanics.recipe import build

    start = time.perf_counter()
    asked = _model(chosen)
    model: Any = build(asked)
    _check_picture(chosen.out)
    draw: Any = diagram
    if chosen.detached:
        from rodlab.lab.census import census as draw
    found = draw(model, (chosen.start, chosen.to), step=chosen.step, watch=_watched("points", 10**6))
    written = []
    if chosen.out is not None:
        from rodlab.lab.diagram_picture import diagram_picture

        written = [_drawn(diagram_picture(found, chosen.y), chosen.out)]
    seconds = time.perf_counter() - start
    if chosen.json:
        asked |= {"from": chosen.start, "to": chosen.to}
        print(as_json(framed("diagram", seconds, {**asked, **of_diagram(found), "files": written})))
    else:
        print(diagram_tables(f"Special points of {model!r}", found))
        print(f"in {seconds:.2f} s" + "".join(f"; written: {path}" for path in written))
    return 0 if found.complete else _complain("diagram", "the diagram is not complete: the table says where", 3)


def equilibria(chosen: argparse.Namespace) -> int:
    """rodlab equilibria"""
    from rodlab.lab.charts import equilibria_table, of_equilibria
    from rodlab.lab.equilibria import all_equilibria
    from rodlab.lab.store import as_json, framed
    from rodlab.mechanics.recipe import build

    start = time.perf_counter()
    asked = _model(chosen)
    strut: Any = build(asked)
    _check_picture(chosen.out)
    if chosen.out is not None:
        from rodlab.lab.standard_map import parameter

        parameter(strut, chosen.lam)
    found = all_equilibria(strut, chosen.lam, certify=chosen.certify is not False, engine=chosen.engine)
    written = []
    if chosen.out is not None:
        from rodlab.lab.map_picture import map_picture

        written = [_drawn(map_picture(found), chosen.out)]
    if chosen.json:
        said = of_equilibria(found, connected=chosen.connected)
        print(as_json(framed("equilibria", time.perf_counter() - start, {**asked, "lam": chosen.lam, **said, "files": written})))
    else:
        print(equilibria_table(found, connected=chosen.connected))
        print(f"in {time.perf_counter() - start:.2f} s" + "".join(f"; written: {path}" for path in written))
    return 0 if found.certified or not chosen.certify else _complain("equilibria", f"not certified: {found.reason}", 1)


def study(chosen: argparse.Namespace) -> int:
    """rodlab study"""
    from pathlib import Path

    from rodlab.lab.store import as_json
    from rodlab.lab.studies.study import study

    start = time.perf_counter()
    bar = _counted("cells")
    found = study(
        chosen.study, quick=chosen.quick, peers=chosen.peers, jobs=_jobs(chosen), cluster=chosen.cluster, out=chosen.out,
        ask=_question(chosen), watch=bar,
    )  # fmt: skip
    bar.close()
    written = [str(path) for path in found.write(Path(chosen.out))] if chosen.out else []
    if chosen.json:
        print(as_json({**found.answer, "files": written}))
    else:
        print(found.text)
        print(f"in {time.perf_counter() - start:.1f} s" + "".join(f"\n  {path}" for path in written))
    return 0 if found.complete else _complain("study", "an answer is wrong or missing: the tables say which", 1)


def scenes(chosen: argparse.Namespace) -> int:
    """rodlab scenes"""
    from rodlab.lab.scene import scenes
    from rodlab.lab.store import as_json, framed

    known = scenes()
    if chosen.json:
        said = [{"name": s.name, "title": s.title, "source": s.source, "about": s.about} for s in known]
        print(as_json(framed("scenes", 0.0, {"scenes": said})))
    else:
        for s in known:
            print(f"{s.name:22} {s.title} [{s.source}]\n{'':22} {s.about}")
        print("\nrodlab run NAME, or the path of your own: the house's files are in the folder rodlab/lab/scenes")
    return 0


def run(chosen: argparse.Namespace) -> int:
    """rodlab run"""
    from pathlib import Path

    from rodlab.lab.running import run_scene
    from rodlab.lab.store import as_json, framed

    if chosen.account:
        from rodlab.lab.account import account, account_table

        start, found = time.perf_counter(), account(chosen.scene)
        print(as_json(framed("run", time.perf_counter() - start, found)) if chosen.json else account_table(found))
        return 0
    answer, text, completed = run_scene(chosen.scene, Path(chosen.out) if chosen.out else None, watch=_watched("points", 10**6))
    print(as_json(answer) if chosen.json else text)
    return 0 if completed else _complain("run", "a branch of the scene could not be followed to its end", 3)


def _watched(what: str, work: int) -> Any:
    """A callback that counts on stderr what may take longer than two seconds."""
    if work < 10_000:
        return None
    from tqdm import tqdm

    bar = tqdm(desc=what, delay=2, leave=False)
    return lambda _: bar.update()


def _counted(what: str) -> Any:
    """A bar on stderr with the remaining time, as a callback of (done, in all)."""
    from tqdm import tqdm

    bar = tqdm(desc=what, delay=2, leave=False)

    def watch(done: int, total: int) -> None:
        if bar.total is None:
            bar.total, bar.initial, bar.n = total, done, done  # what a journal knows took no time
        bar.update(done - bar.n)

    watch.close = bar.close  # type: ignore[attr-defined]
    return watch


def _jobs(chosen: argparse.Namespace) -> int:
    """As many processes as asked for; without a word all cores, but one where run time is what is measured."""
    import os

    if chosen.jobs is not None:
        return int(chosen.jobs)
    return 1 if chosen.study == "work-precision" else os.cpu_count() or 1


def _question(chosen: argparse.Namespace) -> dict[str, Any] | None:
    """One question of one's own in the place of the scene's, of what was given on the command line."""
    from rodlab.lab.studies.study import question_instead

    asked = {name: getattr(chosen, name) for name in ("quantity", "mode", "lam", "K", "u_hat", "breaks")}
    for name in ("K", "u_hat"):
        asked[name] = asked[name] and _number_or_text(asked[name])
    sizes = {name: getattr(chosen, name) for name in ("methods", "joints", "intervals")}
    return question_instead(chosen.study, asked, sizes)


def _progress(entries: Any, what: str, total: int, work: int) -> Any:
    """A progress bar for what may take longer than two seconds."""
    if work < 1_000_000:
        return entries
    from tqdm import tqdm

    return tqdm(entries, desc=what, total=total, delay=2, leave=False)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="rodlab", description="A teaching laboratory for elastic rods.")
    parser.add_argument("--json", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--version", action="version", version=f"rodlab {__version__}")
    verbs = parser.add_subparsers(dest="verb", metavar="VERB")

    verb = _verb(verbs, tour, "the main job: the strut at several n, tables, pictures and data, in seconds")
    verb.add_argument("--out", default="rodlab-tour", metavar="DIR", help="folder for pictures and data (default: %(default)s)")

    verb = _verb(verbs, buckling, "buckling loads of a straight strut or rod, with error bounds")
    _model_options(verb, 1000, straight=True)
    verb.add_argument("--modes", type=int, help="how many loads (default: 3)")

    verb = _verb(verbs, follow, "follow a branch of a strut or rod to a load, with its folds and branch points")
    _model_options(verb, 100)
    verb.add_argument("--from", dest="start", type=float, default=0.0, metavar="LAM", help="load to start at (default: 0)")
    verb.add_argument("--to", type=float, required=True, metavar="LAM", help="load to end at")
    verb.add_argument("--mode", type=int, help="the branch that buckles in this mode, from its branch point")
    verb.add_argument("--guess", help='first guess at --from, --guess="-3*sin(pi*s/2)" (default: unstressed)')
    verb.add_argument("--step", type=float, help="first and longest length of a step (default: by error)")
    verb.add_argument("--max-points", type=int, default=10_000, help="points at most (default: %(default)s)")
    verb.add_argument("--out", metavar="FILE", help="also save the branch, to a .json or .npz file")

    verb = _verb(verbs, diagram, "every branch connected to the unstressed shape in a window of loads, and all special points")
    _model_options(verb, 100)
    verb.add_argument("--from", dest="start", type=float, default=0.0, metavar="LAM", help="lower edge (default: 0)")
    verb.add_argument("--to", type=float, required=True, metavar="LAM", help="upper edge of the window")
    verb.add_argument("--detached", action="store_true", help="also the branches that are not connected")
    verb.add_argument("--step", type=float, help="first and longest length of a step (default: by error)")
    verb.add_argument("--y", choices=["tip_angle", "height", "energy"], default="tip_angle", help="what the picture shows")
    verb.add_argument("--out", metavar="FILE", help="draw it, to a .png, .pdf or .svg file")

    verb = _verb(verbs, equilibria, "every equilibrium of a strut at a load, certified to be all")
    _model_options(verb, 5, models=("strut",))
    verb.add_argument("--lam", type=float, required=True, help="the load")
    certify = argparse.BooleanOptionalAction
    verb.add_argument("--certify", action=certify, help="prove that these are all (default); given, it is a check that may fail")
    verb.add_argument("--connected", action=certify, default=True, help="say which are connected to the unstressed shape")
    verb.add_argument("--engine", choices=["flint", "mpmath"], help="arithmetic of the proof (default: flint if installed)")
    verb.add_argument("--out", metavar="FILE", help="draw them on the standard map, to a .png, .pdf or .svg file")

    verb = _verb(verbs, study, "error against n, against run time, and where it is hard: orders, floors, limits, verdicts")
    what = "convergence, work-precision, stability, or the path of a scene's .toml that asks for one of them"
    verb.add_argument("study", metavar="STUDY", help=what)
    verb.add_argument("--quick", action="store_true", help="fewer cells, in seconds")
    verb.add_argument("--peers", action="store_true", help="work-precision: beside scipy's solve_bvp and AUTO, where installed")
    verb.add_argument("--out", metavar="DIR", help="folder for tables, shapes, pictures, and to go on from when killed")
    verb.add_argument("--jobs", type=int, help="processes (default: all cores; 1 for work-precision, whose run times count)")
    verb.add_argument("--cluster", metavar="ADDRESS", help="a Dask scheduler's address, or local, with --jobs workers")
    _question_options(verb)

    _verb(verbs, scenes, "the situations of the notes by name")

    verb = _verb(verbs, run, "run a scene: its branches, events, picture and data")
    verb.add_argument("scene", metavar="SCENE", help="a name that `rodlab scenes` lists, or the path of a .toml file")
    verb.add_argument("--out", metavar="DIR", help="folder for the picture and the data (default: nothing is written)")
    verb.add_argument(
        "--account", action="store_true", help="say instead what it costs, and what it is spared: imports, kernels, seconds"
    )
    return parser


def _model(chosen: argparse.Namespace) -> dict[str, Any]:
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
    return recipe


def _model_options(
    verb: argparse.ArgumentParser, n: int, models: Sequence[str] = ("strut", "rod"), *, straight: bool = False
) -> None:
    verb.add_argument("--model", choices=models, default="strut", help="the model (default: %(default)s)")
    verb.add_argument("-n", type=int, help=f"of a strut: number of joints (default: {n})")
    verb.set_defaults(joints=n)
    verb.add_argument("--rule", help="of a strut: end or trapezoid (default: end)")
    verb.add_argument("--breaks", type=float, nargs="+", default=[], metavar="S", help="where K or u_hat jumps")
    verb.add_argument("--K", default="1", help='bending stiffness: a number or an expression in s, "1+s" (default: 1)')
    verb.set_defaults(degree=None, mesh=None, tol=None, u_hat=None)
    if not straight:
        verb.add_argument("--u-hat", default="0", help="unstressed curvature: a number or an expression in s (default: 0)")
    if "rod" not in models:
        return
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


def _verb(verbs: Any, run: Any, what: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = verbs.add_parser(run.__name__, help=what, description=what[0].upper() + what[1:] + ".")
    parser.add_argument("--json", action="store_true", help="one JSON object on stdout, numbers at full precision")
    parser.set_defaults(run=run)
    return parser


def _check_picture(out: str | None) -> None:
    """A wrong name of a picture is said before the work, not after it; without one nothing that draws is imported."""
    if out is None:
        return
    from rodlab.lab.picture import FORMATS

    if not out.endswith(FORMATS):
        raise ValueError(f"out must end in {', '.join(FORMATS)}; it is {out!r}")


def _drawn(figure: Any, out: str) -> str:
    from pathlib import Path

    from rodlab.files import write_whole
    from rodlab.lab.picture import drawn

    return str(write_whole(Path(out), drawn(figure, out)))


def _number_or_text(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _complain(verb: str | None, message: str, code: int) -> int:
    print(f"rodlab{f' {verb}' if verb else ''}: {message}", file=sys.stderr)
    return code
