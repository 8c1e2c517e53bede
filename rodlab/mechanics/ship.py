"""The kernels of the standard terms and of their limits as source: `python -m rodlab.mechanics.ship` writes `standard.py`
and `standard_loads.py`.
"""

import inspect
from collections.abc import Sequence

from rodlab.mechanics.derive import HEADER, LinkDerivation, derive
from rodlab.mechanics.limit import Limit, limit
from rodlab.mechanics.link import Link
from rodlab.mechanics.terms import (
    BENDING,
    BENDING_WITH_REST,
    END_FORCE,
    END_LOAD,
    Term,
    end_torque,
    foundation,
    self_weight,
    shearable,
)

BENT = (BENDING, BENDING_WITH_REST)
MORE: tuple[tuple[Term, ...], ...] = (
    (END_FORCE,), (end_torque(0.0),), (END_FORCE, end_torque(0.0)), (self_weight(0.0),), (foundation(0.0),), (shearable(),),
)  # fmt: skip


def standard_source() -> str:
    """The text of `standard.py`: bending and load, with and without rest angles and weights, and their limits."""
    unloaded = [derive((bend,), weighted=False) for bend in BENT]
    loaded = _derived(())
    names = [f"{d.name}_weighted" for d in unloaded]  # without load no weight occurs
    limits = [limit(terms) for terms in [*((bend,) for bend in BENT), *((bend, END_LOAD) for bend in BENT)]]
    return _text([*unloaded, *loaded], limits, dict(zip(names, [d.name for d in unloaded], strict=True)))


def loads_source() -> str:
    """The text of `standard_loads.py`: the same with one standard term more, or the reactions of a held end."""
    limits = [limit((bend, END_LOAD, *more)) for more in MORE for bend in BENT]
    return _text([d for more in MORE for d in _derived(more)], limits, {})


def _derived(more: tuple[Term, ...]) -> list[LinkDerivation]:
    return [derive((bend, END_LOAD, *more), weighted=weighted) for bend in BENT for weighted in (False, True)]


def _text(links: Sequence[LinkDerivation], limits: Sequence[Limit], again: dict[str, str]) -> str:
    classes = "\n\n".join([*(link.source for link in links), *(known.source for known in limits)])
    names = {d.name: d.name for d in links} | again
    tables = (("KERNELS", names), ("DENSITIES", {known.name: known.name for known in limits}))
    listed = "\n".join(
        f"{table}: dict[str, Any] = {{\n{''.join(f'    {name!r}: {own},{chr(10)}' for name, own in held.items())}}}\n"
        for table, held in tables
    )
    return f"{HEADER}\n{classes}\n\n{listed}"


if __name__ == "__main__":
    import pathlib

    home = pathlib.Path(inspect.getfile(Link))
    home.with_name("standard.py").write_text(standard_source())
    home.with_name("standard_loads.py").write_text(loads_source())
