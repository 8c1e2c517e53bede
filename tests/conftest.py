"""What the tests share: random struts, and truths in more digits than a float has."""

from fractions import Fraction

import hypothesis
import mpmath as mp
import numpy as np
from hypothesis import strategies as st

import rodlab as rl

hypothesis.settings.register_profile("rodlab", deadline=None, max_examples=60, derandomize=True)
hypothesis.settings.load_profile("rodlab")

angle = st.floats(-4, 4, allow_nan=False)
decade = st.floats(-6, 6)


@st.composite
def struts(draw, most=8, terms=True):
    """A strut of any kind that the public face makes."""
    n = draw(st.integers(1, most))
    some_terms = st.sampled_from(
        [(), (rl.self_weight(2.0),), (rl.foundation("1 + s"),), (rl.end_torque(0.3), rl.self_weight(lambda s: s))]
    )
    return rl.Strut(
        n=n,
        K=draw(st.sampled_from([1.0, "1 + s", np.exp, "Piecewise((1, s < 1/3), (20, True))"])),
        u_hat=draw(st.sampled_from([0.0, 0.7, "sin(5*s)", lambda s: 1 - s])),
        rule=draw(st.sampled_from(["end", "trapezoid"])),
        phi0=draw(st.sampled_from([0.0, 0.4])),
        terms=draw(some_terms) if terms else (),
    )


@st.composite
def states(draw, most=8, terms=True):
    """A strut, angles and a load."""
    strut = draw(struts(most, terms))
    phi = np.array(draw(st.lists(angle, min_size=strut.n, max_size=strut.n)))
    return strut, phi, draw(st.floats(-50, 50))


def exact_index(diagonal, off_diagonal):
    """(negative, zero) eigenvalues of a tridiagonal matrix of floats, exactly: Sturm's sequence in fractions."""
    d, e = [Fraction(float(x)) for x in diagonal], [Fraction(float(x)) for x in off_diagonal]
    minors = [Fraction(1), d[0]]
    for i in range(1, len(d)):
        minors.append(d[i] * minors[-1] - e[i - 1] ** 2 * minors[-2])
    negative, last = 0, 1
    for minor in minors[1:]:  # a zero takes the sign opposite to the minor before it, if it is followed by another
        sign = (minor > 0) - (minor < 0) or -last
        negative += sign != last
        last = sign
    return (negative - 1, 1) if minors[-1] == 0 else (negative, 0)


def exact_loads(k, hw, numbers, digits=50):
    """Buckling loads of springs k and weights hw (floats, taken as exact) by bisection of Sturm counts in `digits`."""
    with mp.workdps(digits):
        K, W = [mp.mpf(float(x)) for x in k], [mp.mpf(float(x)) for x in hw]

        def below(lam):
            # the pivots of elimination from the free end, k_i - r_i: no sum of springs is ever formed
            count, r = 0, mp.mpf(0)
            for i in reversed(range(len(K))):
                r = lam * W[i] + r
                if r >= K[i]:
                    count += 1
                r = K[i] * r / (K[i] - r) if r != K[i] else mp.mpf(10) ** 200
            return count

        top = 4 * max(a / w for a, w in zip(K, W, strict=True)) * (1 + max(K) / min(K)) * len(K)
        loads = []
        for j in numbers:
            low, high = mp.mpf(0), top
            while high - low > mp.mpf(10) ** -25 * high:
                middle = (low + high) / 2 if low == 0 or high < 4 * low else mp.sqrt(low * high)
                middle = mp.mpf(10) ** -60 if middle == 0 else middle
                low, high = (low, middle) if below(middle) >= j else (middle, high)
            loads.append((low + high) / 2)
        return loads


def exact_tip(strut, phi, lam, digits=40):
    """Tip angle of the exact solution next to phi: Newton's method in `digits` on the strut's own floats."""
    with mp.workdps(digits):
        j = strut.joints
        n, h = j.n, mp.mpf(j.h)
        k, beta, w = ([mp.mpf(float(x)) for x in a] for a in (j.k, j.beta, j.w))
        u, lam = [mp.mpf(float(x)) for x in phi], mp.mpf(lam)
        for _ in range(60):
            a = [mp.mpf(j.phi0), *u[:-1]]
            m = [k[i] * (u[i] - a[i] - beta[i]) for i in range(n)] + [mp.mpf(0)]
            F = [m[i] - m[i + 1] - lam * h * w[i] * mp.sin(u[i]) for i in range(n)]
            d = [k[i] + (k[i + 1] if i + 1 < n else 0) - lam * h * w[i] * mp.cos(u[i]) for i in range(n)]
            for i in range(1, n):
                q = -k[i] / d[i - 1]
                d[i], F[i] = d[i] + q * k[i], F[i] - q * F[i - 1]
            step = [mp.mpf(0)] * n
            for i in reversed(range(n)):
                step[i] = (-F[i] + (k[i + 1] * step[i + 1] if i + 1 < n else 0)) / d[i]
            u = [x + s for x, s in zip(u, step, strict=True)]
            if max(abs(s) for s in step) < mp.mpf(10) ** (4 - digits):
                return u[-1]
        raise AssertionError("the exact solution was not found")
