"""The command line: one verb a function, each importing its room when it is called.

Exit codes: 0 done, 1 a check failed, 2 bad usage or input, 3 not converged. Answers go to stdout, all else to stderr.
"""

from __future__ import annotations

import argparse
import sys
import time

from rodlab.arguments import jobs_of, model_of, parser, question_of
from rodlab.version import __version__

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
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
    verbs = (tour, buckling, follow, diagram, equilibria, study, scenes, run, check, exercises)
    chosen = parser({verb.__name__: verb for verb in verbs}).parse_args(arguments)
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
    asked = model_of(chosen)
    model: Any = build(asked)
    most = getattr(model, "n", 3)
    numbers = mode_numbers(model, min(3, most) if chosen.modes is None else chosen.modes)
    each = _progress(buckling_each(model, numbers), "buckling loads", len(numbers), asked.get("n", 10_000) * len(numbers))
    loads, error = zip(*_as_many_as(each, all_of_them=chosen.modes is not None), strict=True)
    numbers = numbers[: len(loads)]
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
    asked = model_of(chosen)
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
    asked = model_of(chosen)
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
    asked = model_of(chosen)
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
    bar, watch = _counted("cells")
    try:
        found = study(
            chosen.study, quick=chosen.quick, peers=chosen.peers, jobs=jobs_of(chosen), cluster=chosen.cluster, out=chosen.out,
            ask=question_of(chosen), watch=watch,
        )  # fmt: skip
    finally:
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
    return (
        0
        if completed
        else _complain(
            "run", "a branch could not be followed to its end, or an answer is wrong or missing: the tables say which", 3
        )
    )


def check(chosen: argparse.Namespace) -> int:
    """rodlab check"""
    from pathlib import Path

    from rodlab.lab.store import as_json, framed
    from rodlab.lab.teaching.checking import check_class, check_one

    start = time.perf_counter()
    if chosen.folder is not None:
        bar, watch = _counted("submissions")
        try:
            answer, text, code = check_class(chosen, watch)
        finally:
            bar.close()
    elif chosen.what is None:
        return exercises(chosen)
    else:
        answer, text, code = check_one(chosen, Path(chosen.what))
    seconds = time.perf_counter() - start
    print(as_json(framed("check", seconds, answer)) if chosen.json else f"{text}\nin {seconds:.1f} s")
    return code


def exercises(chosen: argparse.Namespace) -> int:
    """rodlab exercises"""
    from rodlab.lab.store import as_json, framed
    from rodlab.lab.teaching.checking import listed, made

    answer, text = made(chosen) if getattr(chosen, "make", None) else listed(chosen)
    print(as_json(framed("exercises", 0.0, answer)) if chosen.json else text)
    return 0


def _as_many_as(each: Iterable[tuple[float, float]], *, all_of_them: bool) -> Iterator[tuple[float, float]]:
    """Loads up to the last that there is: a model between ends, or one that would be crushed, may have fewer than asked for."""
    known = False
    try:
        for load in each:
            yield load
            known = True
    except ValueError:
        if all_of_them or not known:
            raise


def _watched(what: str, work: int) -> Any:
    """A callback that counts on stderr what may take longer than two seconds."""
    if work < 10_000:
        return None
    from tqdm import tqdm

    bar = tqdm(desc=what, delay=2, leave=False)
    return lambda _: bar.update()


def _counted(what: str) -> tuple[Any, Any]:
    """A bar on stderr with the remaining time, and a callback of (done, in all) that moves it."""
    from tqdm import tqdm

    bar = tqdm(desc=what, delay=2, leave=False)

    def watch(done: int, total: int) -> None:
        if bar.total is None:
            bar.total, bar.initial, bar.n = total, done, done  # what a journal knows took no time
        bar.update(done - bar.n)

    return bar, watch


def _progress(entries: Any, what: str, total: int, work: int) -> Any:
    """A progress bar for what may take longer than two seconds."""
    if work < 1_000_000:
        return entries
    from tqdm import tqdm

    return tqdm(entries, desc=what, total=total, delay=2, leave=False)


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


def _complain(verb: str | None, message: str, code: int) -> int:
    print(f"rodlab{f' {verb}' if verb else ''}: {message}", file=sys.stderr)
    return code
