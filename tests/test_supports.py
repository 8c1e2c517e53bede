"""Pictures of supports and loads: each kind draws within the limits, arrows point the way their signs say."""

import itertools

import numpy as np
import pytest
from matplotlib.figure import Figure

from rodlab.lab.supports import KINDS, SIZE, foundation, load, reference, shape_axes, support, weight


@pytest.fixture
def axes():
    return Figure().subplots()


def bounds(axes):
    return axes.dataLim.get_points()


def heads(axes, name):
    """Of every arrow of a name: its point, and the middle of its head's base."""
    found = [patch.get_xy() for patch in axes.patches if patch.get_gid() == name]
    return [(xy[0], (xy[1] + xy[2]) / 2) for xy in found]


def way(axes, name):
    (end, base), *others = heads(axes, name)
    assert not others
    return (end - base) / np.hypot(*(end - base))


def bow(rise=0.3):
    s = np.linspace(0, 1, 1001)
    return rise * np.sin(np.pi * s), s


@pytest.mark.parametrize(("kind", "top", "slides"), list(itertools.product(KINDS, (False, True), (False, True))))
@pytest.mark.parametrize("phi", [0.0, 0.7, -2.5])
def test_every_support_is_drawn_around_its_end_and_within_the_limits(axes, kind, top, slides, phi):
    support(axes, kind, 0.4, 0.8, phi, top=top, slides=slides)
    if (kind, top, slides) == ("free", True, True):
        assert not axes.lines
        assert not axes.patches
        return
    low, high = bounds(axes)
    assert np.all(low <= [0.4, 0.8])
    assert np.all(high >= [0.4, 0.8])
    assert np.all(high - low < 4 * SIZE)
    shape_axes(axes)
    axes.figure.canvas.draw()
    frame = axes.get_window_extent()
    for artist in (*axes.lines, *axes.patches):
        box = artist.get_window_extent()
        assert frame.x0 <= box.x0 <= box.x1 <= frame.x1
        assert frame.y0 <= box.y0 <= box.y1 <= frame.y1


@pytest.mark.parametrize("kind", KINDS)
def test_ground_is_below_the_foot_and_a_ceiling_above_the_top(axes, kind):
    support(axes, kind, 0.0, 0.0, 0.0)
    assert -bounds(axes)[0, 1] > bounds(axes)[1, 1]
    above = axes.figure.add_subplot()
    support(above, kind, 0.0, 0.0, 0.0, top=True, slides=False)
    assert bounds(above) == pytest.approx(-bounds(axes)[::-1])


def test_a_clamp_turns_with_its_rod_and_nothing_else_does(axes):
    support(axes, "clamped", 0.0, 0.0, np.pi / 2)  # the rod leaves to the right: the wall stands on its left
    wall = axes.lines[-1].get_xydata()
    assert wall[:, 0] == pytest.approx(0)
    for kind in ("hinged", "guided", "free"):
        support(axes, kind, 0.0, 0.0, np.pi / 2)
        ground = [line.get_xydata() for line in axes.lines if len(line.get_xydata()) == 2][-1]
        assert np.ptp(ground[:, 1]) == pytest.approx(0)


@pytest.mark.parametrize("call", [lambda axes, kind: support(axes, kind, 0, 0, 0), lambda axes, kind: load(axes, 0, 0, on=kind)])
def test_an_unknown_kind_is_refused(axes, call):
    with pytest.raises(ValueError, match=r"^(kind|on) must be one of clamped, hinged, guided, free; it is 'welded'$"):
        call(axes, "welded")


@pytest.mark.parametrize("phi", [-3.0, -1.5, 0.0, 0.4, 1.5, 3.0])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("on", KINDS)
def test_forces_point_as_their_signs_say_and_stay_clear_of_the_tip(axes, phi, sign, on):
    load(axes, 0.3, 0.6, lam=5 * sign, N1=0.1 * sign, phi=phi, on=on)
    assert way(axes, "lam") == pytest.approx([0, -sign])
    assert way(axes, "N1") == pytest.approx([sign, 0])
    for line in axes.lines:
        assert np.min(np.hypot(*(line.get_xydata() - [0.3, 0.6]).T)) >= 0.2 * SIZE * (1 - 1e-9)
    assert [text.get_text() for text in axes.texts] == [r"$\lambda$", "$N_1$"]


@pytest.mark.parametrize("phi", [-3.0, -1.5, 0.0, 0.4, 1.5, 3.0])
def test_no_force_lies_on_the_rod(axes, phi):
    load(axes, 0.0, 0.0, lam=1, N1=1, tau=1, phi=phi)
    rod = -np.array([np.sin(phi), np.cos(phi)])
    for line in axes.lines:
        directions = line.get_xydata() / np.hypot(*line.get_xydata().T)[:, None]
        assert np.max(directions @ rod) < np.cos(0.5)


@pytest.mark.parametrize("phi", [-2.0, 0.0, 1.0])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_positive_torque_turns_clockwise(axes, phi, sign):
    load(axes, 0.3, 0.6, tau=sign, phi=phi)
    x, z = (axes.lines[0].get_xydata() - [0.3, 0.6]).T
    assert np.all(sign * np.diff(np.unwrap(np.arctan2(x, z))) > 0)
    (end, base), *_ = heads(axes, "tau")
    a, b = base - [0.3, 0.6], end - [0.3, 0.6]
    assert sign * (a[1] * b[0] - a[0] * b[1]) > 0


def test_no_load_draws_nothing_and_labels_are_optional(axes):
    load(axes, 0, 1)
    weight(axes, *bow(), 0.0)
    assert not axes.lines
    load(axes, 0, 1, lam=1, N1=1, tau=1, labels=False)
    assert axes.lines
    assert not axes.texts


@pytest.mark.parametrize("q", [2.0, -2.0])
@pytest.mark.parametrize("rise", [0.0, 0.3, -0.3])
def test_weight_is_small_arrows_along_the_rod_but_not_on_it(axes, q, rise):
    x, z = bow(rise)
    weight(axes, x, z, q)
    arrows = heads(axes, "weight")
    assert len(arrows) == 8
    for end, base in arrows:
        assert end[0] == pytest.approx(base[0])
        assert np.sign(base[1] - end[1]) == np.sign(q)
        gap = np.min(np.hypot(x - end[0], z - end[1]))
        assert 0.2 * SIZE < gap < 1.2 * SIZE


def test_springs_reach_from_the_line_to_the_rod(axes):
    x, z = bow(0.4)
    foundation(axes, x, z)
    springs = [line.get_xydata() for line in axes.lines]
    assert len(springs) == 8
    for spring in springs:
        assert spring[0] == pytest.approx([0, spring[-1, 1]], abs=1e-12)
        assert np.min(np.hypot(x - spring[-1, 0], z - spring[-1, 1])) < 1e-3


def test_springs_are_seen_where_the_rod_is_on_the_line(axes):
    foundation(axes, *bow(0.0))
    widths = [np.ptp(line.get_xdata()) for line in axes.lines]
    assert widths == pytest.approx([1.2 * SIZE] * 8)


def test_panels_share_one_scale_and_hold_all_that_they_show():
    panels = Figure().subplots(ncols=2)
    for axes in panels:
        reference(axes)
    support(panels[0], "hinged", -0.8, 0, 0)
    load(panels[1], 0.7, 1, lam=1, N1=1, tau=1)
    shape_axes(*panels)
    for axes in panels:
        assert axes.get_aspect() == 1
        assert np.ptp(axes.get_xlim()) == pytest.approx(np.ptp(panels[0].get_xlim()))
        assert axes.get_ylim() == panels[0].get_ylim()
    assert panels[0].get_xlim()[0] < -0.8 - SIZE
    assert panels[1].get_xlim()[1] > 0.7 + 4 * SIZE
    assert (panels[0].get_xlabel(), panels[0].get_ylabel()) == ("$x$", "$z$")
