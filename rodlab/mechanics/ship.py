"""The kernels of the standard terms and of their limits as source: `python -m rodlab.mechanics.ship` writes `standard.py`."""

import inspect

from rodlab.mechanics.derive import HEADER, derive
from rodlab.mechanics.limit import limit
from rodlab.mechanics.link import Link
from rodlab.mechanics.terms import BENDING, BENDING_WITH_REST, END_LOAD, Term


def standard_source() -> str:
    """The text of `standard.py`: bending and load, with and without rest angles and weights, and their limits."""
    sums: list[tuple[tuple[Term, ...], bool]] = [((bend,), False) for bend in (BENDING, BENDING_WITH_REST)]
    sums += [((bend, END_LOAD), weighted) for bend in (BENDING, BENDING_WITH_REST) for weighted in (False, True)]
    derivations = [derive(terms, weighted=weighted) for terms, weighted in sums]
    table = "".join(f'    "{d.name}": {d.name},\n' for d in derivations)
    table += "".join(f'    "{d.name}_weighted": {d.name},\n' for d in derivations[:2])  # without load no weight occurs
    classes = "\n\n".join(d.source for d in derivations)
    limits = [limit(terms) for terms, weighted in sums if not weighted]
    densities = "\n\n".join(known.source for known in limits)
    listed = "".join(f'    "{known.name}": {known.name},\n' for known in limits)
    kernels = f"KERNELS: dict[str, Any] = {{\n{table}}}\n"
    return f"{HEADER}\n{classes}\n\n{densities}\n\n{kernels}\nDENSITIES: dict[str, Any] = {{\n{listed}}}\n"


if __name__ == "__main__":
    import pathlib

    pathlib.Path(inspect.getfile(Link)).with_name("standard.py").write_text(standard_source())
