"""The strut as a function of what is given at its ends: its energy's derivatives in the boundary values [N 2.6].

    value           V in it                                  its partner, given where the value is not
    lam  N1         z(1)  -x(1)                              the end's place
    tau             -phi_n                                   the end's angle
    phi0            -moment in the foot                      that moment, zero in a hinge
    x0              force of the terms of the place          that force, zero where the foot slides

With these, and their derivatives in the angles and in each other, every end is a boundary value (`rodlab.mechanics.held`).
The foot's own link, of weight 1 - w_n, counts here: with angle phi0 above and below it has no spring to bend.
"""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rodlab.mechanics.assembly import balance, full
from rodlab.numerics.arrays import Array

if TYPE_CHECKING:
    from rodlab.mechanics.strut_energy import StrutEnergy

FORCES = ("lam", "N1")


class Foot(NamedTuple):
    """The energy of the foot's link and its derivatives in phi0, in the loads, and in its place."""

    energy: float = 0.0
    moment: float = 0.0
    stiffness: float = 0.0
    reach: tuple[float, float] = (0.0, 0.0)
    moment_by: tuple[float, float] = (0.0, 0.0)  # in lam, N1
    yielding: tuple[float, float, float] = (0.0, 0.0, 0.0)
    force: tuple[float, float] = (0.0, 0.0)
    hardening: float = 0.0


def foot(strut: "StrutEnergy", lam: float) -> Foot:
    """The foot's link; nothing where the rule gives it no length. Kept for the last load that was asked for."""
    if strut.joints.last_weight == 1:
        return Foot()
    if strut.last_foot is None or strut.last_foot[0] != lam:
        strut.last_foot = lam, _foot(strut, lam)
    return strut.last_foot[1]


def _foot(strut: "StrutEnergy", lam: float) -> Foot:
    j, link = strut.joints, strut.kernel()
    at = {**strut.at_foot, "h": j.h, "w": 1 - j.last_weight, "k": 0.0, "beta": 0.0}
    given: dict[str, Any] = {name: at.get(name, strut.parameters.get(name)) for name in link.parameters}
    angle, place = np.full(1, j.phi0), (np.full(1, strut.x0), np.zeros(1))
    _, above, below = link.stiffness(angle, angle, lam, **given)
    pushed = link.moments_N1(angle, angle, lam, **given)[1] if "N1" in link.parameters else 0.0
    force, hardening = (link.forces(*place, **given), link.hardening(*place, **given)) if link.places else ((0.0, 0.0), (0.0,))
    return Foot(
        _number(link.energy(angle, angle, *(place if link.places else ()), lam, **given)),
        _number(link.moments(angle, angle, lam, **given)[1]),
        -_number(above) - _number(below),
        tuple(map(_number, link.reach(angle, angle, lam, **given))),  # type: ignore[arg-type]
        (_number(link.moments_lam(angle, angle, lam, **given)[1]), _number(pushed)),
        tuple(map(_number, link.yielding(angle, angle, lam, **given))),  # type: ignore[arg-type]
        tuple(map(_number, force)),  # type: ignore[arg-type]
        _number(hardening[0]),
    )


def reach(strut: "StrutEnergy", u: Array, lam: float) -> tuple[Array, Array]:
    """x, z of the joints 1..n from the foot: what the links reach, those of a strut that shears and extends as well."""
    link, own = strut.kernel(), foot(strut, lam)
    parts = link.reach(strut.below(u), u, lam, **strut.given(link))
    x, z = (strut.places.along(full(part, strut.n), first) for part, first in zip(parts, own.reach, strict=True))
    return x + strut.x0, z


def boundary(strut: "StrutEnergy", name: str, u: Array, lam: float) -> float:
    """dV/d(name) of a boundary value."""
    if name in FORCES:
        parts = strut.kernel().reach(strut.below(u), u, lam, **strut.given(strut.kernel()))
        x, z = (float(np.sum(part)) + first for part, first in zip(parts, foot(strut, lam).reach, strict=True))
        return z if name == "lam" else -x - strut.x0
    if name == "tau":
        return -float(u[-1])
    X, Z = _forces(strut, u)
    own, link = foot(strut, lam), strut.kernel(lam)
    if name == "x0":
        return float(X.sum()) + own.force[0] - float(strut.parameters.get("N1", 0.0))
    m = full(link.moments(strut.below(u), u, lam, **strut.given(link))[0], strut.n)
    dx, dz = strut.places.by_foot
    return float(own.moment - m[0] - strut.parameters.get("tau", 0.0) + dx * X.sum() + dz * Z.sum())


def column(strut: "StrutEnergy", name: str, u: Array, lam: float) -> Array:
    """d(gradient)/d(name), shape (n,)."""
    link = strut.kernel()
    given = strut.given(link)
    out = np.zeros(strut.n)
    if name in FORCES:
        m, f = getattr(link, f"moments_{name}")(strut.below(u), u, lam, **given)
        return balance(m, f, u)
    if name == "tau":
        out[-1] = -1.0
        return out
    dx, dz = (1.0, 0.0) if name == "x0" else strut.places.by_foot
    if name == "phi0":
        out[0] = -full(link.stiffness(strut.below(u), u, lam, **given)[0], strut.n)[0]
    if link.places and link.hardens:
        xx, xz, zz = _hardening(strut, u)
        out += strut.places.moments(u, xx * dx + xz * dz, xz * dx + zz * dz)
    return out


def second(strut: "StrutEnergy", one: str, other: str, u: Array, lam: float) -> float:
    """d2V/d(one) d(other) of two boundary values."""
    pair = {one, other}
    if "tau" in pair or pair == {"x0", "lam"}:
        return 0.0
    if pair == {"x0", "N1"}:
        return -1.0
    link, own = strut.kernel(), foot(strut, lam)
    if pair <= set(FORCES) and not link.yields:
        return 0.0
    given, below = strut.given(link), strut.below(u)
    if pair <= set(FORCES):
        which = len(pair - {"lam"}) + (one == other == "N1")
        return float(np.sum(full(link.yielding(below, u, lam, **given)[which], strut.n))) + own.yielding[which]
    if pair & set(FORCES):
        name = "lam" if "lam" in pair else "N1"
        m = full(getattr(link, f"moments_{name}")(below, u, lam, **given)[0], strut.n)
        return float(own.moment_by[FORCES.index(name)] - m[0])
    xx, xz, zz = (np.sum(part) for part in _hardening(strut, u))
    dx, dz = strut.places.by_foot
    if pair == {"x0"}:
        return float(xx) + own.hardening
    if pair == {"x0", "phi0"}:
        return float(dx * xx + dz * xz)
    k, _, c_below = (full(part, strut.n)[0] for part in link.stiffness(below, u, lam, **given))
    X, Z = (float(np.sum(part)) for part in _forces(strut, u))
    turned = dz * X - dx * Z  # the foot's link turns by its angle: (dx, dz) to (dz, -dx)
    return float(k - c_below + own.stiffness + turned + dx * dx * xx + 2 * dx * dz * xz + dz * dz * zz)


def _forces(strut: "StrutEnergy", u: Array) -> tuple[Array, Array]:
    link = strut.kernel()
    if not link.places:
        return np.zeros(1), np.zeros(1)
    X, Z = link.forces(*strut.places.of(u, strut.x0), **strut.given(link))
    return full(X, strut.n), full(Z, strut.n)


def _hardening(strut: "StrutEnergy", u: Array) -> tuple[Array, Array, Array]:
    link = strut.kernel()
    if not link.places:
        return np.zeros(1), np.zeros(1), np.zeros(1)
    xx, xz, zz = (full(part, strut.n) for part in link.hardening(*strut.places.of(u, strut.x0), **strut.given(link)))
    return xx, xz, zz


def _number(value: Any) -> float:
    return float(np.ravel(value)[0])
