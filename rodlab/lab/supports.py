"""Rods to scale with what holds and loads them: supports, forces, springs, drawn in lengths of the rod (1), x right, z up."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon
from matplotlib.ticker import MultipleLocator

from rodlab.numerics.arrays import Array

KINDS = ("clamped", "hinged", "guided", "free")
SIZE = 0.1  # about half the width of a support; every other length of this room is a multiple of it
THIN, THICK = 0.8, 1.5  # strokes, in points
SHADE, SPRING = "0.86", "0.4"  # greys of blocks and of springs
CLEAR = {"free": (0.2, 0.25), "hinged": (0.45, 1.0), "clamped": (0.7, 1.4), "guided": (1.15, 0.8)}  # from tip to arrow: up, aside


@dataclass(frozen=True)
class Frame:
    """Strokes about (x, z) in lengths of `size`: v points at `angle` from the vertical, clockwise, and u to the right of v."""

    axes: Axes
    x: float
    z: float
    angle: float
    size: float

    def at(self, points: npt.ArrayLike) -> Array:
        """Points (u, v), shape (m, 2), as points (x, z)."""
        u, v = np.asarray(points, float).T
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([self.x, self.z]) + self.size * np.stack([c * u + s * v, c * v - s * u], axis=1)

    def block(self, wide: float, low: float, high: float) -> None:
        """A grey rectangle, u = -wide ... wide, v = low ... high."""
        corners = self.at([(-wide, low), (wide, low), (wide, high), (-wide, high)])
        self.axes.add_patch(Polygon(corners, fc=SHADE, ec="k", lw=THIN, zorder=1.6))

    def rollers(self, places: npt.ArrayLike, radius: float = 0.17) -> None:
        """Small white rollers."""
        for place in self.at(places):
            self.axes.add_patch(Circle((place[0], place[1]), radius * self.size, fc="w", ec="k", lw=THIN, zorder=1.7))

    def pin(self, radius: float) -> None:
        """The pin in which a rod ends, over the rod."""
        self.axes.add_patch(Circle((self.x, self.z), radius * self.size, fc="w", ec="k", lw=1.0, zorder=3))

    def wall(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """A line from start to end, hatched on the right of who walks along it."""
        a, b = np.array(start), np.array(end)
        length = np.hypot(*(b - a))
        along, n = (b - a) / length, max(3, round(length / 0.32))
        right = np.array([along[1], -along[0]])
        feet = a + (b - a) * ((np.arange(n) + 0.9) / n)[:, None]
        strokes = np.stack([feet, feet + 0.36 * (right - along), np.full((n, 2), np.nan)], axis=1).reshape(-1, 2)
        self.axes.plot(*self.at(strokes).T, color="k", lw=0.6, zorder=1.4)
        self.axes.plot(*self.at([a, b]).T, color="k", lw=THICK, solid_capstyle="butt", zorder=1.5)


def support(
    axes: Axes, kind: str, x: float, z: float, phi: float, *, top: bool = False, slides: bool = True, size: float = SIZE
) -> None:
    """What holds an end at (x, z), where the rod has the angle phi: at the foot ground, at the top a guide that lets the end
    come down, or, where it may not (slides=False), a ceiling. Clamped holds angle and x, hinged x, guided the angle.
    """
    if kind not in KINDS:
        raise ValueError(f"kind must be one of {', '.join(KINDS)}; it is {kind!r:.60}")
    if top and slides and kind != "free":
        _guide(Frame(axes, x, z, 0.0, size), kind)
    elif not (top and slides):
        _ground(Frame(axes, x, z, (phi if kind == "clamped" else 0.0) + np.pi * top, size), kind)


def _ground(f: Frame, kind: str) -> None:
    """A support on the ground, v < 0: a wall, a pin on a triangle, a block on rollers, or a ball."""
    low = {"clamped": 0.0, "hinged": -1.0, "guided": -0.79, "free": -0.42}[kind]
    f.wall((-1.15, low), (1.15, low))
    if kind == "hinged":
        f.axes.add_patch(Polygon(f.at([(0, 0), (0.6, low), (-0.6, low)]), fc="w", ec="k", lw=1.0, zorder=1.6))
        f.pin(0.2)
    elif kind == "guided":
        f.block(0.8, -0.45, 0.45)
        f.rollers([(-0.5, -0.62), (0, -0.62), (0.5, -0.62)])
    elif kind == "free":
        f.pin(0.42)
        f.axes.plot(f.x, f.z, "o", color="k", ms=1.6, zorder=3.1)


def _guide(f: Frame, kind: str) -> None:
    """A vertical guide: a block on rollers, a pin in a slot, or a block that also rolls sideways under such a carriage."""
    gap, low, high = {"clamped": (0.8, -1, 1), "hinged": (0.34, -0.7, 0.7), "guided": (1.55, 0.45, 1.4)}[kind]
    f.wall((gap, low), (gap, high))
    f.wall((-gap, high), (-gap, low))
    if kind == "clamped":
        f.block(0.46, -0.6, 0.6)
        f.rollers([(side * 0.63, v) for side in (-1, 1) for v in (-0.35, 0.35)])
    elif kind == "hinged":
        f.pin(0.3)
    else:
        f.block(0.6, -0.4, 0.4)
        f.rollers([(-0.35, 0.57), (0.35, 0.57), (-1.38, 0.9), (1.38, 0.9)])
        f.block(1.21, 0.74, 1.06)


def load(
    axes: Axes,
    x: float,
    z: float,
    *,
    lam: float = 0.0,
    N1: float = 0.0,
    tau: float = 0.0,
    phi: float = 0.0,
    on: str = "free",
    labels: bool = True,
    size: float = SIZE,
) -> None:
    """Arrows at the top (x, z), of one length whatever the force: lam > 0 down, N1 > 0 to the right, tau > 0 clockwise.

    They keep off the rod, which arrives at the angle phi, and off the sliding support of the kind `on`.
    """
    if on not in KINDS:
        raise ValueError(f"on must be one of {', '.join(KINDS)}; it is {on!r:.60}")
    up, aside = (max(clear, 1.65) if tau else clear for clear in CLEAR[on])
    tip, out = np.array([x, z]), np.array([np.sin(phi), np.cos(phi)] if on == "free" else [0.0, 1.0])
    for value, name, text, way, clear, least, place in (
        (lam, "lam", r"$\lambda$", (0.0, -1.0), up, 0.3, 0.6),
        (N1, "N1", "$N_1$", (1.0, 0.0), aside, -0.5, 1.0),
    ):
        if value:
            pull = np.array(way) * np.sign(value)
            begins = pull @ out > least  # a force along the rod begins at its tip, one against it ends there
            near, far = (tip + (1 if begins else -1) * size * away * pull for away in (clear, clear + 2.4))
            _arrow(axes, np.array([near, far] if begins else [far, near]), 0.55 * size, name)
            if labels:
                right = 1 if far[0] > near[0] else -1
                _text(axes, near + place * (far - near), (right, 0), text, size)
    if tau:
        turn = np.sign(tau) * np.linspace(-2.1, 2.1, 60) + phi
        _arrow(axes, tip + 1.25 * size * np.stack([np.sin(turn), np.cos(turn)], axis=1), 0.55 * size, "tau")
        if labels:  # on a diagonal, where no force is
            right, above = (-1 if part < -1e-9 else 1 for part in out)
            _text(axes, tip + 0.89 * size * np.array([right, above]), (right, above), r"$\tau$", size)


def weight(axes: Axes, x: npt.ArrayLike, z: npt.ArrayLike, q: float, *, count: int = 8, size: float = SIZE) -> None:
    """Self-weight q: small arrows down (up if q < 0) along the rod, hanging on its lower side."""
    p, phi = _spread(x, z, count)
    side = np.where(np.abs(np.sin(phi)) > 0.02, np.sign(np.sin(phi)), 1.0)
    middle = p + (0.45 * side * np.array([np.cos(phi), -np.sin(phi)]) - [np.zeros(count), 0.45 * np.abs(np.sin(phi))]).T * size
    half = np.array([0.0, -0.45 * size * np.sign(q)])
    for at in middle if q else ():
        _arrow(axes, np.array([at - half, at + half]), 0.35 * size, "weight", lw=THIN)


def foundation(axes: Axes, x: npt.ArrayLike, z: npt.ArrayLike, *, count: int = 8, size: float = SIZE) -> None:
    """A Winkler foundation, force -c x: springs from the line x = 0 to the rod; across both where the rod is on the line."""
    teeth = np.array([0, *np.linspace(0.18, 0.82, 8), 1])
    least, swing = 1.2 * size, 0.18 * size * np.array([0, 0, 1, -1, 1, -1, 1, -1, 0, 0])
    for px, pz in _spread(x, z, count)[0]:
        reach = max(abs(px), least) / 2
        axes.plot(px / 2 + reach * (2 * teeth - 1), pz + swing, color=SPRING, lw=0.7, solid_joinstyle="round", zorder=1.8)


def reference(axes: Axes) -> None:
    """The straight unloaded rod."""
    axes.plot([0, 0], [0, 1], color="0.6", lw=1.0, ls=(0, (4, 3)), zorder=1.2)


def shape_axes(*panels: Axes, margin: float = SIZE / 2) -> None:
    """Once all is drawn: one scale along x and z in all panels, each wide enough for the widest and centred on what it shows."""
    seen = [axes.dataLim for axes in panels]
    half = max(box.width for box in seen) / 2 + margin
    for axes, box in zip(panels, seen, strict=True):
        middle = (box.x0 + box.x1) / 2
        axes.set_aspect("equal")
        axes.set_xlim(middle - half, middle + half)
        axes.set_ylim(min(box.y0 for box in seen) - margin, max(box.y1 for box in seen) + margin)
        axes.xaxis.set_major_locator(MultipleLocator(0.5))
        axes.yaxis.set_major_locator(MultipleLocator(0.5))
        axes.set_xlabel("$x$")
        axes.set_ylabel("$z$")


def _spread(x: npt.ArrayLike, z: npt.ArrayLike, count: int) -> tuple[Array, Array]:
    """Points at equal distances along a rod, away from its supports, (count, 2), and its angles there."""
    p = np.stack([np.asarray(x, float), np.asarray(z, float)], axis=1)
    s = np.append(0.0, np.cumsum(np.hypot(*np.diff(p, axis=0).T)))
    low, at, high = (np.linspace(0.14, 0.88, count) * s[-1] + part for part in (-0.03, 0.0, 0.03))
    a, middle, b = (np.stack([np.interp(own, s, p[:, 0]), np.interp(own, s, p[:, 1])], axis=1) for own in (low, at, high))
    return middle, np.arctan2(*(b - a).T)


def _arrow(axes: Axes, path: Array, head: float, name: str, lw: float = 1.3) -> None:
    """A path, shape (m, 2), that ends in a filled head."""
    end = path[-1]
    body = path[np.hypot(*(path - end).T) > 0.8 * head]
    along = (end - body[-1]) / np.hypot(*(end - body[-1]))
    base, across = end - head * along, 0.34 * head * np.array([along[1], -along[0]])
    axes.plot(*np.vstack([body, end - 0.8 * head * along]).T, color="k", lw=lw, solid_capstyle="butt", zorder=4)
    axes.add_patch(Polygon([end, base + across, base - across], fc="k", ec="none", zorder=4, gid=name))


def _text(axes: Axes, at: Array, off: tuple[int, int], text: str, size: float) -> None:
    """A label beside a point, on the side `off`."""
    ha, va = {-1: "right", 0: "center", 1: "left"}[off[0]], {-1: "top", 0: "center", 1: "bottom"}[off[1]]
    far = 4 / np.hypot(*off)
    place = (float(at[0]), float(at[1]))
    axes.annotate(text, place, (far * off[0], far * off[1]), textcoords="offset points", fontsize=9, ha=ha, va=va, zorder=5)
    axes.update_datalim([at, at + 2 * size * np.array(off)])
