"""Checks of the exercise "The imperfect strut near a buckling load"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.plain import Code
from rodlab.grading.properties import holds
from rodlab.grading.values import Array, Number, Parts


def euler(j):
    return np.square((j - 0.5) * np.pi)


def integral(f, eps, j, *, slope=True, factor=True):
    """By Gauss and Legendre's rule with 60 nodes."""
    x, weights = np.polynomial.legendre.leggauss(60)
    s, w = (x + 1) / 2, np.sqrt(euler(j))
    wave = np.cos(w * s) if slope else np.sin(w * s)
    return eps * np.sum(weights / 2 * f(s) * wave) * (w if slope and factor else 1.0)


def reduced(A, lam, j, delta):
    return (euler(j) - lam) / 2 * A + euler(j) / 16 * A**3 - delta


def number_of_roots(lam, j, delta):
    """By the values of the cubic at its two extrema."""
    if lam <= euler(j):
        return 1
    extreme = np.sqrt(8 / 3 * (lam / euler(j) - 1))
    return 3 if reduced(extreme, lam, j, delta) * reduced(-extreme, lam, j, delta) < 0 else 1


def off_roots(A, *given):
    if A.size != number_of_roots(*given) or not np.all(np.diff(A) > 1e-6):
        return np.inf
    return np.max(np.abs(reduced(A, *given))) / abs(given[-1])


def off_fold(value, j, delta):
    lam, A = value
    slope = (euler(j) - lam) / 2 + 3 / 16 * euler(j) * A**2
    return (abs(reduced(A, lam, j, delta)) + abs(slope * A)) / abs(delta)


def imperfections(draw):
    for j in (1, 2, 3):
        a, b = draw.uniform(0.5, 2, size=2)
        yield Code(f"lambda s: {a:.4f} + {b:.4f} * s**2"), draw.uniform(0.05, 0.3), j
    yield Code("lambda s: np.cos(3 * np.pi * s / 2)"), draw.uniform(0.05, 0.3), 1


def states(draw):
    for j in (1, 2):
        size, sign = draw.uniform(0.02, 0.1), draw.choice([-1.0, 1.0])
        far = euler(j) + 1.5 * np.cbrt(euler(j)) * size ** (2 / 3)
        yield euler(j) * draw.uniform(0.5, 0.95), j, size * sign
        yield far + draw.uniform(0.4, 2), j, size * sign
        yield (far + euler(j)) / 2, j, -size * sign


def defects(draw):
    for j, sign in ((1, 1.0), (1, -1.0), (2, -1.0)):
        yield j, sign * draw.uniform(0.02, 0.3)


def folded(A, j, delta):
    """The load at which the curve A -> lam passes A."""
    return euler(j) * (1 + A**2 / 8) - 2 * delta / A


def lowest(j, delta):
    A = -2 * np.sign(delta) * np.exp(np.log(np.abs(delta) / euler(j)) / 3)
    return folded(A, j, delta), A


def cube(j, delta, factor=16.0):
    return np.sign(delta) * np.exp(np.log(np.abs(factor * delta) / euler(j)) / 3)


def complex_roots(lam, j, delta):
    return np.sort(np.roots([euler(j) / 16, 0.0, (euler(j) - lam) / 2, -delta]).real)


def real_roots(lam, j, delta, cubic=16.0):
    roots = np.roots([euler(j) / cubic, 0.0, (euler(j) - lam) / 2, -delta])
    return np.sort(roots[np.abs(roots.imag) < 1e-9].real)


def complex_kept(given):
    """All three roots, as they come from a solver or by their real parts."""
    found = [(complex_roots(*a), np.sort(np.real(np.asarray(value, dtype=complex)))) for a, value in given]
    return all(right.shape == value.shape and np.max(np.abs(right - value)) < 1e-6 for right, value in found)


def not_real(value):
    return isinstance(value, complex) or np.isnan(float(value))


def no_number(given):
    return any(not_real(value) for _, value in given)


def no_numbers(given):
    return any(not_real(x) for _, pair in given for x in pair)


exercise = Exercise(
    title="The imperfect strut near a buckling load",
    source="N 2.8",
    imports=("numpy", "scipy.integrate"),
    questions=(
        Question(
            name="delta",
            calls=imperfections,
            returns=Number(),
            properties=(holds("is the integral", lambda value, *given: abs(value - integral(*given)), 1e-7, 1.5),),
            mistakes=(
                Mistake(
                    "mode for its slope",
                    "Which factor of phi' - eps f does eps f multiply in the energy?",
                    when=lambda given: all(abs(v - integral(*a, slope=False)) < 1e-6 for a, v in given),
                ),
                Mistake(
                    "inner derivative forgotten",
                    "Differentiate sin(w s): a factor is missing that grows with j.",
                    when=lambda given: all(abs(v - integral(*a, factor=False)) < 1e-6 for a, v in given),
                ),
                Mistake(
                    "eps forgotten",
                    "An imperfection twice as large must give twice the delta.",
                    when=lambda given: all(abs(v - integral(a[0], 1.0, a[2])) < 1e-6 for a, v in given),
                ),
                Mistake(
                    "always the first mode",
                    "Each buckling load has a mode of its own: does your answer depend on j?",
                    when=lambda given: all(abs(v - integral(a[0], a[1], 1)) < 1e-6 for a, v in given),
                ),
            ),
            hint="Differentiate the mode first, then integrate numerically; f may be called with a number or an array.",
        ),
        Question(
            name="amplitudes",
            calls=states,
            returns=Array(),
            properties=(holds("are all real roots, ascending", off_roots, 1e-7, 2.0),),
            mistakes=(
                Mistake(
                    "complex roots kept",
                    "Before the fold the cubic has one real root only; how do you tell the complex ones?",
                    when=complex_kept,
                ),
                Mistake(
                    "sign of delta",
                    "The strut bends to the side to which it is bent at rest: below lam_j, A has the sign of delta.",
                    lambda lam, j, delta: real_roots(lam, j, -delta),
                ),
                Mistake(
                    "one half for one sixteenth",
                    "Without the imperfection lam = lam_j (1 + A^2/8) must come out.",
                    lambda *given: real_roots(*given, cubic=2.0),
                ),
                Mistake("descending", "The smallest root first.", lambda *given: real_roots(*given)[::-1]),
            ),
            hint="A cubic in A without a quadratic term; roots of a polynomial come as complex numbers.",
        ),
        Question(
            name="at_buckling",
            calls=defects,
            returns=Number(),
            properties=(
                holds(
                    "satisfies the reduced equation at lam_j",
                    lambda A, j, delta: abs(reduced(A, euler(j), j, delta) / delta),
                    1e-7,
                ),
            ),
            mistakes=(
                Mistake(
                    "cube root of a negative number", "A power 1/3 of a negative number is complex in Python.", when=no_number
                ),
                Mistake(
                    "square root",
                    "At lam_j the linear term vanishes: which power of A is left?",
                    lambda j, delta: np.sign(delta) * np.sqrt(16 * np.abs(delta) / euler(j)),
                ),
                Mistake(
                    "sign lost", "A strut bent the other way at rest buckles the other way.", lambda j, d: np.abs(cube(j, d))
                ),
                Mistake(
                    "16 forgotten",
                    "Put your amplitude into the reduced equation: a factor is left.",
                    lambda j, d: cube(j, d, 1.0),
                ),
            ),
            hint="What is left of the equation at lam = lam_j?",
        ),
        Question(
            name="fold",
            calls=defects,
            returns=Parts(Number(), Number()),
            properties=(holds("is a double root of the reduced equation", off_fold, 1e-5, 2.0),),
            mistakes=(
                Mistake(
                    "sign of the amplitude",
                    "The two roots that meet are on the side away from the imperfection.",
                    lambda j, delta: (lowest(j, delta)[0], -lowest(j, delta)[1]),
                ),
                Mistake(
                    "below the buckling load",
                    "The detached branch exists for loads above its fold: is that above or below lam_j?",
                    lambda j, delta: (2 * euler(j) - lowest(j, delta)[0], lowest(j, delta)[1]),
                ),
                Mistake(
                    "power of a negative number",
                    "delta may be negative: which of your powers of it is not a real number?",
                    when=no_numbers,
                ),
                Mistake("amplitude first", "The load comes first, then the amplitude.", lambda *given: lowest(*given)[::-1]),
                Mistake(
                    "point at the buckling load",
                    "This point lies on the other branch; at the fold also the derivative with respect to A vanishes.",
                    lambda j, delta: (euler(j), cube(j, delta)),
                ),
            ),
            hint="Two roots meet where the equation and its derivative with respect to A vanish: two equations for lam and A.",
        ),
    ),
)
