"""The exact elastica, clamped below and free above under its load: the yardstick [N 2.8.1; Love 1927, 262; Timoshenko and Gere].

    phi'' + (lam/K) sin(phi) = 0,   phi(0) = 0,   phi'(1) = 0,   w = sqrt(lam/K)

    sin(phi(s)/2) = k sn(w s, k)          k = sin(alpha/2), alpha the size of the tip's angle
    w = (2j - 1) Kell(k)                  mode j: the tip is at the (2j-1)-th quarter of the period; none below lam_j
    x(s) = 2k (1 - cn(w s)) / w           x(1) = 2k / w
    z(s) = 2 E(am(w s)) / w - s           z(1) = 2 Eell / Kell - 1
    V = lam (2 z(1) - cos(alpha))         by H = K phi'^2 / 2 - lam cos(phi) = -lam cos(alpha)
    index = j - 1                         it leaves the straight rod as the j-th eigenvalue crosses zero, and has no fold

Computed by mpmath with so many digits that twenty more change nothing: the error is that of rounding once, and is checked.
"""

from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import mpmath
import numpy as np

from rodlab.numerics.arrays import EPS, Array, number, whole

MEASURES = ("tip_angle", "height", "energy", "curvature", "moment", "deflection")
DIGITS = 30  # more than the solution's own


class Centreline(NamedTuple):
    """Arclength, angle and place along the elastica: arrays of one shape."""

    s: Array
    phi: Array
    x: Array
    z: Array


class Elastica:
    """Mode `mode` at the load `lam`, with phi'(0) > 0; made by `elastica`. Its measures are named as those of a point."""

    def __init__(self, lam: float, mode: int, K: float) -> None:
        self.lam, self.mode, self.K = lam, mode, K
        self._known = _modulus(lam, mode, K, 0)

    def __repr__(self) -> str:
        return f"Elastica(lam={self.lam:g}, mode={self.mode}, K={self.K:g}, tip_angle={self.tip_angle:.12g})"

    @cached_property
    def tip_angle(self) -> float:
        """Angle of the free end: alpha for mode 1, -alpha for mode 2, and so on."""
        return float(self._known["alpha"]) * (1 if self.mode % 2 else -1)

    @cached_property
    def height(self) -> float:
        """z of the free end."""
        return float(self._known["z"])

    @cached_property
    def deflection(self) -> float:
        """x of the free end."""
        return float(self._known["x"])

    @cached_property
    def energy(self) -> float:
        """V."""
        return float(self._known["V"])

    @cached_property
    def curvature(self) -> float:
        """phi'(0)."""
        return float(self._known["slope"])

    @property
    def moment(self) -> float:
        """m(0) = K phi'(0)."""
        return self.K * self.curvature

    @property
    def index(self) -> int:
        """Number of negative eigenvalues of the second variation, of conjugate points."""
        return self.mode - 1

    @property
    def index_verified(self) -> bool:
        """True: known by theory."""
        return True

    @property
    def nullity(self) -> int:
        """Zero above lam_j."""
        return 0

    @cached_property
    def error(self) -> float:
        """Bound on the error of the tip angle: one rounding, and the change with 20 digits more."""
        finer = _modulus(self.lam, self.mode, self.K, 20)
        with mpmath.workdps(DIGITS):
            change = float(abs(finer["alpha"] - self._known["alpha"]))
        return change + EPS / 2 * abs(self.tip_angle)

    @cached_property
    def condition(self) -> float:
        """|d(tip angle) / dlam| lam / |tip angle|: relative change for a relative change of the load."""
        with mpmath.workdps(int(self._known["digits"])):
            k, quarter = self._known["k"], self._known["quarter"]
            rest = (1 - k) * (1 + k)
            rate = quarter / 2 * k * rest / (mpmath.ellipe(k * k) - rest * quarter)  # lam dk/dlam, as w = (2j-1) Kell
            return float(2 * rate / mpmath.sqrt(rest) / self._known["alpha"])

    def measure(self, name: str) -> float:
        """A measure by its name: tip_angle, height, energy, curvature, moment, deflection."""
        if name not in MEASURES:
            raise AttributeError(f"the elastica has no measure {name}; it has {', '.join(MEASURES)}")
        return float(getattr(self, name))

    @cached_property
    def shape(self) -> Centreline:
        """s, phi, x, z at 65 places from the clamp to the tip; computed when first asked for, as are s, phi, x, z."""
        return self(np.linspace(0, 1, 65))

    @property
    def s(self) -> Array:
        """Arclength of the places of `shape`."""
        return self.shape.s

    @property
    def phi(self) -> Array:
        """Angles at `s`."""
        return self.shape.phi

    @property
    def x(self) -> Array:
        """Lateral place at `s`."""
        return self.shape.x

    @property
    def z(self) -> Array:
        """Height at `s`."""
        return self.shape.z

    def __call__(self, s: Any) -> Centreline:
        """(s, phi, x, z) at arclengths s, arrays of the shape of s; `ValueError` outside of the rod."""
        s = np.asarray(s, dtype=np.float64)
        if not ((s >= 0) & (s <= 1)).all():
            raise ValueError(f"s must lie between 0 and 1; it is {s!r:.60}")
        values = np.array([self._at(float(x)) for x in s.ravel()]).reshape(-1, 3)
        phi, x, z = (column.reshape(s.shape) for column in values.T)
        return Centreline(s, phi, x, z)

    def _at(self, s: float) -> tuple[float, float, float]:
        k, digits = self._known["k"], int(self._known["digits"])
        with mpmath.workdps(digits):
            w = mpmath.sqrt(mpmath.mpf(self.lam) / mpmath.mpf(self.K))
            u = w * mpmath.mpf(s)
            sn, cn, dn = (mpmath.ellipfun(name, u, m=k * k) for name in ("sn", "cn", "dn"))
            period = 4 * mpmath.ellipk(k * k)
            turns = mpmath.floor(u / period + mpmath.mpf(1) / 2)
            am = mpmath.atan2(sn, cn) + 2 * mpmath.pi * turns
            assert dn > 0
            return (
                float(2 * mpmath.asin(k * sn)),
                float(2 * k * (1 - cn) / w),
                float(2 * mpmath.ellipe(am, k * k) / w - mpmath.mpf(s)),
            )


def elastica(lam: float, mode: int = 1, K: float = 1.0) -> Elastica:
    """The exact buckled shape of a mode of the uniform rod at a load above its buckling load.

    Raises `ValueError` for a load that is not above ((2 mode - 1) pi / 2)^2 K, or above 10^7 K, where digits run out.

    >>> e = elastica(5.0)
    >>> e.tip_angle, e.error < 1e-15, e.index
    (2.1906624185899..., True, 0)
    """
    lam, mode, K = number("lam", lam), whole("mode", mode, least=1), number("K", K, above=0.0)
    with mpmath.workdps(DIGITS):
        least = ((2 * mode - 1) * mpmath.pi / 2) ** 2 * mpmath.mpf(K)
        if not mpmath.mpf(lam) > least:
            raise ValueError(f"lam must be above the buckling load {float(least):.17g} of mode {mode}; it is {lam!r}")
    if lam > 1e7 * K:
        raise ValueError(f"lam must be at most 1e7 K for the elastica; it is {lam!r}")
    return Elastica(lam, mode, K)


@lru_cache(maxsize=256)
def _modulus(lam: float, mode: int, K: float, more: int) -> dict[str, Any]:
    """k and the measures, by Newton's method on log k': Kell(k) = pi / (2 agm(1, k')) to relative accuracy at both ends."""
    ratio = float(np.sqrt(lam / K)) / (2 * mode - 1)
    digits = DIGITS + more + int(ratio)  # k' is as small as 4 exp(-ratio)
    with mpmath.workdps(digits):
        w = mpmath.sqrt(mpmath.mpf(lam) / mpmath.mpf(K))
        quarter = w / (2 * mode - 1)

        def off(t: Any) -> Any:
            return mpmath.pi / (2 * mpmath.agm(1, mpmath.exp(t))) - quarter

        over = float(quarter / (mpmath.pi / 2) - 1)
        start = mpmath.log(4) - quarter if over > 0.3 else -max(2 * (quarter / (mpmath.pi / 2) - 1), mpmath.mpf(10) ** (-digits))
        t = mpmath.findroot(
            off, (start, start * (1 + mpmath.mpf(10) ** -3)), tol=mpmath.mpf(10) ** (8 - 2 * digits), verify=False
        )
        complement = mpmath.exp(t)
        k = mpmath.sqrt((1 - complement) * (1 + complement))
        alpha = 2 * mpmath.atan2(k, complement)
        z = 2 * mpmath.ellipe(k * k) / quarter - 1
        return {
            "k": k, "alpha": alpha, "z": z, "x": 2 * k / w, "slope": 2 * k * w, "digits": digits, "quarter": quarter,
            "V": mpmath.mpf(lam) * (2 * z - 1 + 2 * k * k),
        }  # fmt: skip
