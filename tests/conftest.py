"""What the tests share: one thread each, and random struts."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as many workers as cores: threads of small matrices only wait for each other

import hypothesis
import numpy as np
from hypothesis import strategies as st

import rodlab as rl

collect_ignore = ["hostile"]  # data for test_sandbox: nothing there may be imported

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
