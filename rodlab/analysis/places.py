"""Is this solution on that branch? What a diagram compares, and the images of a solution under the model's symmetries."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from rodlab.analysis.continuation import carried
from rodlab.analysis.curve import Curve
from rodlab.analysis.follow import Branch
from rodlab.analysis.newton import NoConvergence
from rodlab.analysis.point import Point
from rodlab.analysis.stops import piece

SAME = 1e-6  # relative distance of solutions that are the same
ROUNDING = 1e-9  # relative distance of a solution from its image that is rounding
NEAR = 0.1  # distance from the cubic, as a part of its step, within which a solution may be on it
MOST = 64  # images


def images(p: Point) -> list[Point]:
    """The other solutions that the symmetries of the model make of p, each once; their tangents with them."""
    maps = getattr(p.equations, "symmetries", ())
    found, new = [p], [p]
    while new and len(found) < MOST:
        made = [_mapped(q, g) for q in new for g in maps]
        new = []
        for q in made:
            if not any(same(q, other) for other in found):
                found.append(q)
                new.append(q)
    return found[1:]


def symmetric(p: Point) -> Point:
    """The same solution, exactly its own image under every symmetry of which it is one up to rounding."""
    for g in getattr(p.equations, "symmetries", ()):
        q = _mapped(p, g)
        if same(p, q, ROUNDING):
            t = None if p.tangent is None or q.tangent is None else (p.tangent + q.tangent) / 2
            p = replace(p, u=(p.u + q.u) / 2, tangent=t)
    return p


def _mapped(p: Point, g: Any) -> Point:
    t = None if p.tangent is None else np.append(g(p.tangent[:-1]), p.tangent[-1])
    return Point(p.equations, p.lam, np.asarray(g(p.u)), (), p.remaining, t, p.accepted, p.known_inertia)


def same(p: Point, q: Point, within: float = SAME) -> bool:
    """True when two solutions are one, up to the distance `within` relative to their size."""
    curve = Curve(q.equations, abs(q.lam) or 1.0)
    yp, yq = carried(p.equations, q.equations, np.append(p.u, p.lam)), np.append(q.u, q.lam)
    return yp.size == yq.size and curve.norm(yp - yq) <= within * (1e-3 + curve.norm(yq))


def lies_on(branch: Branch, p: Point) -> bool:
    """True when the solution p is a point of the branch, or between two of them."""
    lows, highs = _range(branch)
    return lows <= p.lam <= highs and any(_between(a, b, p) for a, b in pairwise(branch.points))


def _range(branch: Branch) -> tuple[float, float]:
    lam = branch.lam
    slack = SAME * (1e-3 + float(np.abs(lam).max())) + float(np.abs(np.diff(lam)).max(initial=0.0))
    return float(lam.min()) - slack, float(lam.max()) + slack


def _between(a: Point, b: Point, p: Point) -> bool:
    curve = Curve(b.equations, max(abs(a.lam), abs(b.lam)) or 1.0)
    y = carried(p.equations, b.equations, np.append(p.u, p.lam))
    yb = np.append(b.u, b.lam)
    ya = carried(a.equations, b.equations, np.append(a.u, a.lam))
    if y.size != yb.size or min(curve.norm(y - ya), curve.norm(y - yb)) > 1.5 * curve.norm(yb - ya):
        return False
    segment = piece(a, b)
    sigma = float(segment.row @ (y - segment.a))
    slack = SAME * (1e-3 + curve.norm(y))
    if not -slack <= sigma <= segment.length + slack:
        return False
    guess = segment.at(sigma)
    if curve.norm(guess - y) > NEAR * segment.length + slack:
        return False
    try:
        exact = curve.correct(guess, segment.row).y
    except NoConvergence:  # at a branch point, say
        exact = guess
    return curve.norm(exact - y) <= slack


def orbit(branch: Branch) -> int:
    """How many branches the symmetries make of this one, itself among them: images of a point on it, over those on it too."""
    p = branch.points[len(branch.points) // 2]
    every = images(p)
    return (1 + len(every)) // (1 + sum(lies_on(branch, image) for image in every))
