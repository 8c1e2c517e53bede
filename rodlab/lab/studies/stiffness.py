"""Stiffness as a grid declares it, plain data, and the strut or rod that has it.

1.0                           a number
"exp(20*s)"                   an expression in s
{jump = 1e12, at = 0.5}       K = 1 below s = at, jump above
{decades = 12, seed = 3}      springs k_i = 10^u n, u uniform in (-6, 6): rough, and different at every joint
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from rodlab.mechanics.expression import Expression
from rodlab.mechanics.rod import Rod
from rodlab.mechanics.strut import Strut
from rodlab.numerics.arrays import number, whole

Given = float | str | Mapping[str, Any]
KINDS = ({"jump", "at"}, {"decades", "seed"})


def checked(K: Any) -> Given:
    """K itself, or `ValueError` in one sentence."""
    known: Given = K
    if isinstance(K, Mapping):
        if set(K) not in KINDS:
            raise ValueError(f"K, where it is a table, must have jump and at, or decades and seed; it is {dict(K)!r}")
        if "jump" in K:
            number("jump of K", K["jump"], above=0.0)
            if not 0 < number("at of K", K["at"]) < 1:
                raise ValueError(f"at of K must lie between 0 and 1; it is {K['at']!r}")
        else:
            if number("decades of K", K["decades"], above=0.0) > 600:
                raise ValueError(f"decades of K must be at most 600, what floats span; it is {K['decades']!r}")
            whole("seed of K", K["seed"], least=0)
    elif isinstance(K, str):
        Expression(K)
    else:
        number("K", K, above=0.0)
    return known


def in_words(K: Given) -> str:
    """K as the tables name it.

    >>> in_words({"jump": 1e12, "at": 0.5}), in_words("exp(20*s)"), in_words({"decades": 12, "seed": 3})
    ('K jumps to 1e+12', 'K = exp(20*s)', 'springs over 12 decades')
    """
    if isinstance(K, Mapping):
        return f"K jumps to {K['jump']:g}" if "jump" in K else f"springs over {K['decades']:g} decades"
    return f"K = {K}" if isinstance(K, str) else f"K = {K:g}"


def strut_with(n: int, K: Given, rule: str, u_hat: float = 0.0) -> Strut:
    """The strut of n joints with this stiffness."""
    if isinstance(K, Mapping) and "decades" in K:
        half = K["decades"] / 2
        k = n * 10.0 ** np.random.default_rng(K["seed"]).uniform(-half, half, n)
        weights = np.append(np.ones(n - 1), 0.5) if rule == "trapezoid" else None
        return Strut.from_joints(k=k, beta=np.full(n, u_hat / n), h=1 / n, weights=weights)
    return Strut(n=n, K=_profile(K), u_hat=u_hat, rule=rule)


def rod_with(K: Given, u_hat: float) -> Rod:
    """The rod with this stiffness."""
    return Rod(K=_profile(K), u_hat=u_hat)


def edges(K: Given) -> tuple[list[float], list[float]]:
    """Values and edges of the pieces on which K is constant. `ValueError` for another K.

    >>> edges({"jump": 1000.0, "at": 0.5})
    ([1.0, 1000.0], [0.0, 0.5, 1.0])
    """
    if isinstance(K, Mapping) and "jump" in K:
        return [1.0, float(K["jump"])], [0.0, float(K["at"]), 1.0]
    return [number("K of a rod, piecewise constant,", K, above=0.0)], [0.0, 1.0]


def _profile(K: Given) -> float | str:
    if isinstance(K, Mapping):
        if "jump" not in K:
            raise ValueError(f"K must not be rough, but a number, an expression or a jump, here; it is {dict(K)!r}")
        return f"Piecewise((1, s < {K['at']!r}), ({K['jump']!r}, True))"
    return K
