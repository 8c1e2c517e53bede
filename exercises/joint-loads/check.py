"""Checks of the exercise "The buckling loads of n joints"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import banded, complex_jacobian, equals, holds, observed_order, symmetric
from rodlab.grading.values import Array


def gradient(phi, n, lam, last):
    moment = n * np.diff(np.append(0.0, phi))
    weight = np.append(np.ones(n - 1), last)
    return moment - np.append(moment[1:], 0.0) - lam / n * weight * np.sin(phi)


def second(n, lam, last):
    return complex_jacobian(gradient, np.zeros(n), n, lam, last)


def dense(n, last):
    """Eigenvalues of the stiffness against the weights, scaled to a symmetric matrix."""
    scale = np.append(np.ones(n - 1), last**-0.5)
    return np.linalg.eigvalsh(scale[:, None] * second(n, 0.0, last) * scale * n)


def sines(n, part):
    """4 n^2 sin^2 of multiples of an angle."""
    return 4 * n**2 * np.sin(part) ** 2


def odd(n):
    return 2 * np.arange(1, n + 1) - 1


def struts(draw):
    for n in (2, int(draw.integers(3, 6)), int(draw.integers(7, 12))):
        yield n, draw.uniform(2, 9), draw.uniform(0.4, 0.9)


def joints(draw):
    yield (int(draw.integers(2, 5)),)
    for n in (10, 20, 40):
        yield (n + int(draw.integers(0, 4)),)


def against(last):
    return equals(lambda n: dense(n, last), 1e-9, says="are eigenvalues of the second derivative", points=2.0)


def off_rod(found, n):
    return abs(found[0] - np.pi**2 / 4)


def tends(order):
    return observed_order(
        f"has an error of order {order:g} in the rod's first load", lambda _, n: 1 / n, off_rod, order, 0.2, 0.5
    )


exercise = Exercise(
    title="The buckling loads of n joints",
    source="N 2.7",
    questions=(
        Question(
            name="hessian",
            calls=struts,
            returns=Array(lambda n, *_: (n, n)),
            properties=(
                symmetric(points=0.25),
                banded(points=0.25),
                equals(second, 1e-12, says="is the gradient's derivative (complex steps)", points=1.5),
            ),
            mistakes=(
                Mistake(
                    "missing end joint",
                    "How many springs act on the last link?",
                    lambda n, lam, last: second(n, lam, last) + n * np.diag(np.eye(n)[-1]),
                ),
                Mistake(
                    "load without h",
                    "By how much does a link of length h lower the load when it turns?",
                    lambda n, lam, last: second(n, n * lam, last),
                ),
                Mistake(
                    "springs without h",
                    "Shorter pieces of a rod are stiffer springs.",
                    lambda n, lam, last: second(n, n * lam, last) / n,
                ),
                Mistake(
                    "sign between neighbours",
                    "If one link turns with its neighbour, does their common spring resist?",
                    lambda n, lam, last: 2 * np.diag(np.diag(second(n, lam, last))) - second(n, lam, last),
                ),
            ),
            hint="The springs give a tridiagonal matrix over h, the load a diagonal one times h; the last link is special twice.",
        ),
        Question(
            name="loads",
            calls=joints,
            returns=Array(lambda n: (n,)),
            properties=(against(1.0), tends(1)),
            mistakes=(
                Mistake(
                    "eigenvalues of the springs alone",
                    "The load stands beside a factor h in the second derivative: at your loads, is its determinant zero?",
                    lambda n: dense(n, 1.0) / n,
                ),
                Mistake(
                    "loads of a strut of length n",
                    "Your loads tend to zero as n grows. How long is a link, and how stiff is a spring?",
                    lambda n: dense(n, 1.0) / n**2,
                ),
                Mistake(
                    "loads of the rod",
                    "n joints have n loads of their own; the rod's are their limits.",
                    lambda n: (odd(n) * np.pi / 2) ** 2,
                ),
                Mistake(
                    "half the last weight",
                    "The last link carries its whole weight here: insert sin(n theta) into the last equation again.",
                    lambda n: sines(n, odd(n) * np.pi / (4 * n)),
                ),
                Mistake(
                    "every j instead of the odd ones",
                    "Your strut is held at the upper end too. Which end is free?",
                    lambda n: sines(n, np.arange(1, n + 1) * np.pi / (2 * n + 1)),
                ),
            ),
            hint="Two cosines differ by a product of sines: the inner equations give lam h^2 = 2 - 2 cos(theta).",
        ),
        Question(
            name="loads_half",
            calls=joints,
            returns=Array(lambda n: (n,)),
            properties=(against(0.5), tends(2)),
            mistakes=(
                Mistake(
                    "whole last weight",
                    "These are the loads of the strut whose weights are all one.",
                    lambda n: sines(n, odd(n) * np.pi / (4 * n + 2)),
                ),
                Mistake(
                    "sine not squared",
                    "How does 1 - cos(theta) depend on a small theta?",
                    lambda n: 4 * n**2 * np.sin(odd(n) * np.pi / (4 * n)),
                ),
            ),
            hint="The last equation is now the inner one halved, if you think of a link n + 1 that mirrors link n - 1.",
        ),
    ),
)
