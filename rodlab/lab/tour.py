"""The tour, rodlab's main job: the strut at several n, before and after buckling, on its way to the rod, which it meets.

Tables for the terminal; pictures and data for a folder.
"""

import time
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from tqdm import tqdm

from rodlab.analysis.equilibrium import equilibrium
from rodlab.analysis.follow import Branch, follow
from rodlab.files import write_whole
from rodlab.lab.answers import branches_table
from rodlab.lab.branches import Found, Shown, detached, mode_branch, on, straight, timed, trivial
from rodlab.lab.limits import loads_against_n, routes, rows_of_limits, rows_of_loads, rows_of_routes
from rodlab.lab.picture import diagram_picture, loads_picture, png, routes_picture, shapes_picture
from rodlab.lab.store import as_csv, as_json, framed
from rodlab.lab.studies.reference import exact_load
from rodlab.lab.table import known_to, small, table
from rodlab.mechanics.buckling import Buckling, buckling, buckling_loads
from rodlab.mechanics.joints import RULES
from rodlab.mechanics.rod import Rod
from rodlab.mechanics.strut import Strut

SIZES = tuple(8 * 2**i for i in range(10))
MODES = (1, 2, 3)
JOINTS = 100
INTERVALS = tuple(2 * 2**i for i in range(6))
ROUTED = 2.0  # load of the three routes, over the first buckling load
IMPERFECTION = 0.1  # u_hat of the imperfect strut
TO = 4.0  # end of the bifurcation diagram, over the first buckling load
SHAPES = (1.02, 1.1, 1.3, 1.7, 2.5, 5.0)  # loads over the buckling load


def tour(folder: Path) -> tuple[dict[str, Any], str]:
    """Compute everything, write the folder, and return the answer for JSON and the text for the terminal."""
    start = time.perf_counter()
    loads = list(_progress(loads_against_n(SIZES, MODES), "buckling loads", len(RULES) * len(MODES)))
    rod = buckling(Rod(), len(MODES))
    routed = list(_progress(routes(ROUTED * exact_load(1), SIZES, INTERVALS), "routes", None))
    strut = Strut(n=JOINTS)
    known = [float(load) for load in buckling_loads(strut, len(MODES))]
    shown = list(_progress(diagram(strut, known), "branches", len(MODES) + 3))
    columns = [(m, list(shapes(shown[m].branch, m, known[m - 1])), known[m - 1]) for m in MODES]
    states = list(before_and_after(strut, known, shown))
    answer = framed("tour", time.perf_counter() - start, _answer(states, shown))
    answer |= {"loads": rows_of_loads(loads), "extrapolated": rows_of_limits(loads), "routes": rows_of_routes(routed)}
    answer["rod"] = [{"mode": j, "load": x, "error": e} for j, x, e in zip(rod.numbers, rod.loads, rod.error, strict=True)]
    files: dict[str, bytes | str] = {
        "diagram.png": png(diagram_picture(shown, known)),
        "loads.png": png(loads_picture(loads)),
        "shapes.png": png(shapes_picture(columns)),
        "routes.png": png(routes_picture(routed)),
        "routes.csv": as_csv(*_columns(answer["routes"])),
        "loads.csv": as_csv(*_columns(answer["loads"])),
        "equilibria.csv": as_csv(*_columns(answer["equilibria"])),
        "branches.csv": as_csv(*_columns(answer["branches"])),
        "tour.json": as_json(answer) + "\n",
    }
    answer["files"] = [str(write_whole(folder / name, content)) for name, content in files.items()]
    answer["seconds"] = time.perf_counter() - start
    return answer, _text(answer, states, shown, rod)


def diagram(strut: Strut, known: Sequence[float]) -> Iterator[Shown]:
    """The branches of the picture: straight, the first modes, and an imperfect strut with the branch it detaches."""
    ends = [max(SHAPES[: len(SHAPES) + 1 - m][-1] * known[m - 1], 1.1 * known[1]) for m in MODES]
    yield timed("straight", lambda: trivial(strut, MODES[-1]))
    for mode, end in zip(MODES, ends, strict=True):
        yield timed(f"mode {mode}", partial(mode_branch, strut, mode, end))
    bent = strut.replace(u_hat=IMPERFECTION)
    yield timed("imperfect", lambda: follow(equilibrium(bent, 0.0), to=TO * known[0]))
    yield timed("detached", lambda: follow(detached(bent, TO * known[0]), to=0.0))


def before_and_after(strut: Strut, known: Sequence[float], shown: Sequence[Shown]) -> Iterator[Found]:
    """The straight strut around its first two loads, and every shape that has buckled by then."""
    first, second = known[:2]
    for load in (0.8 * first, 1.1 * first, 2 * first, 1.1 * second):
        yield straight(strut, load)
        for mode in (1, 2):
            if load > known[mode - 1]:
                yield from on(shown[mode].branch, f"mode {mode}", [load])


def shapes(branch: Branch, mode: int, own: float) -> Iterator[Found]:
    """The shapes of a mode for the picture; a higher mode fills its panel at a lower load."""
    return on(branch, f"mode {mode}", [ratio * own for ratio in SHAPES[: len(SHAPES) + 1 - mode]])


def _progress(entries: Iterable[Any], what: str, total: int | None) -> Iterable[Any]:
    return tqdm(entries, desc=what, total=total, delay=2, leave=False)


def _answer(states: Sequence[Found], shown: Sequence[Shown]) -> dict[str, Any]:
    return {
        "joints": JOINTS,
        "equilibria": [
            {
                "branch": e.branch, "lam": e.point.lam, "tip_angle": e.point.tip_angle, "error": e.point.error,
                "height": e.point.height, "energy": e.point.energy, "index": e.point.index,
                "index_verified": e.point.index_verified, "newton": len(e.point.newton), "seconds": e.seconds,
            }
            for e in states
        ],
        "branches": [
            {
                "branch": s.name, "from": s.branch.points[0].lam, "to": s.branch.points[-1].lam, "points": len(s.branch),
                "proved": sum(p.proved for p in s.branch.points), "checked": sum(p.checked for p in s.branch.points),
                "events": "; ".join(f"{e.kind} {e.lam:.12g}" for e in s.branch.events[:-1]), "end": s.branch.reason,
                "seconds": s.seconds,
            }
            for s in shown
        ],
    }  # fmt: skip


def _columns(rows: Sequence[dict[str, Any]]) -> tuple[list[str], list[list[Any]]]:
    return list(rows[0]), [list(row.values()) for row in rows]


def _text(answer: dict[str, Any], states: Sequence[Found], shown: Sequence[Shown], rod: Buckling) -> str:
    parts = [*(_loads_table(rule, answer, rod) for rule in RULES), _routes_table(answer["routes"])]
    parts.append(
        table(
            f"Equilibria of the strut, n = {JOINTS}, before and after buckling",
            ["load", "branch", "tip angle", "+-", "height", "energy", "index", "Newton", "ms"],
            [
                [
                    f"{e.point.lam:.4f}", e.branch, f"{e.point.tip_angle:.12f}", small(e.point.error),
                    f"{e.point.height:.6f}", f"{e.point.energy:.6f}",
                    f"{e.point.index}" + ("" if e.point.index_verified else "?"), len(e.point.newton), f"{1e3 * e.seconds:.1f}",
                ]
                for e in states
            ],
        )
    )  # fmt: skip
    parts.append(branches_table(f"Branches of the strut, n = {JOINTS}, perfect and with u_hat = {IMPERFECTION}", shown))
    parts.append(
        "index: negative eigenvalues of the second variation, verified by inertia (? where it is not); 0 is stable.\n"
        "+-: error of the tip angle against the exact solution, estimated from above; height and energy have no estimate.\n"
        "proved: steps proved to stay on their branch; checked: by every test short of a proof, as around branch points."
    )
    written = "\n".join(f"  {path}" for path in answer["files"])
    parts.append(f"Written in {answer['seconds']:.1f} s:\n{written}")
    return "\n\n".join(parts)


def _routes_table(routed: Sequence[dict[str, Any]]) -> str:
    """Each method at its coarsest, its best, and in between; the orders above rounding."""
    rows: list[list[Any]] = []
    for method in dict.fromkeys(route["method"] for route in routed):
        own = [route for route in routed if route["method"] == method]
        orders = [f"{route['observed']:.2f}" for route in own if route["observed"] is not None]
        best = min(own, key=lambda route: float(route["error"]))
        known = [own[0]["order"], " ".join(orders[-3:]), best["unknowns"], small(best["error"]), f"{1e3 * best['seconds']:.1f}"]
        rows.append([method, *known])
    title = f"Three routes to the tip angle of mode 1 at {ROUTED:g} times its load: errors against the exact elastica"
    return table(title, ["method", "order", "last observed", "unknowns", "error", "ms"], rows)


def _loads_table(rule: str, answer: dict[str, Any], rod: Buckling) -> str:
    rows: list[list[Any]] = []
    loads, best = ([e for e in answer[name] if e["rule"] == rule] for name in ("loads", "extrapolated"))
    for n in SIZES:
        at = [e for e in loads if e["n"] == n]
        orders = ["" if e["order"] is None else f"{e['order']:.2f}" for e in at]
        cells = [c for e, order in zip(at, orders, strict=True) for c in (f"{e['load']:.9f}", small(e["error"]), order)]
        rows.append([n, *cells, f"{1e3 * sum(e['seconds'] for e in at):.2f}"])
    rows.append(
        ["extrapolated", *(c for e in best for c in (known_to(e["load"], e["estimate"])[:14], small(e["error"]), "")), ""]
    )
    rows.append(["its estimate", *(c for e in best for c in ("", small(e["estimate"]), "")), ""])
    both = list(zip(rod.loads, rod.error, best, strict=True))
    rows.append(["rod, collocated", *(c for x, _, e in both for c in (f"{x:.11f}", small(abs(x - e["limit"])), "")), ""])
    rows.append(["its bound", *(c for _, bound, _ in both for c in ("", small(bound), "")), ""])
    rows.append(["rod, exact", *(c for e in best for c in (f"{e['limit']:.11f}", "", "")), ""])
    header = ["n", *(c for m in MODES for c in (f"load {m}", "error", "order")), "ms"]
    return table(f'Buckling loads of the uniform strut, rule "{rule}", and their limit', header, rows)
