"""Tables for a terminal: a title, a header, columns lined up on the right."""

from collections.abc import Sequence

Cell = str | int | float | None


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    """The text of a table; None is an empty cell, a row of one cell is a note under the rows before it.

    >>> print(table("Loads", ["n", "load"], [[10, 2.2], [100, None]]))
    Loads
      n  load
     10   2.2
    100
    """
    cells = [[_shown(c) for c in row] for row in rows]
    full = [row for row in cells if len(row) == len(columns)]
    widths = [max(len(row[i]) for row in [list(columns), *full]) for i in range(len(columns))]
    lines = [title] if title else []
    for row in [list(columns), *cells]:
        aligned = [text.rjust(width) for text, width in zip(row, widths, strict=True)] if len(row) == len(columns) else row
        lines.append("  ".join(aligned).rstrip())
    return "\n".join(lines)


def small(x: float | None) -> str:
    """A number of which only the size matters: an error."""
    return "" if x is None else f"{x:.1e}"


def known_to(x: float, error: float) -> str:
    """A number with the digits that its error leaves, at least 3 decimals and at most 13.

    >>> known_to(2.4674011, 1e-5), known_to(0.0, 0.0)
    ('2.46740', '0.000')
    """
    decimals = next((d for d in range(3, 13) if 10.0**-d <= max(error, 1e-13)), 13) if error > 0 else 3
    return f"{x:.{decimals}f}"


def _shown(cell: Cell) -> str:
    return "" if cell is None else f"{cell:g}" if isinstance(cell, float) else str(cell)
