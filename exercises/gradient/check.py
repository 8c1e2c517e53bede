"""Checks of the exercise "The gradient of the strut's energy"; made from the teacher's file."""

import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals, gradient_of
from rodlab.grading.values import Array, Number


def calls(draw):
    for n in (1, 2, 7):
        yield draw.normal(size=n), draw.uniform(2, 9), draw.uniform(1, 3, size=n), draw.normal(size=n), draw.uniform(0.1, 0.9)


def V(phi, lam, k, beta, h):
    bend = phi - np.append(0.0, phi[:-1]) - beta
    return np.sum(k * bend**2) / 2 + lam * h * np.sum(np.cos(phi))


def moments(phi, lam, k, beta, h, *, load=1.0, end=0.0):
    moment = k * (phi - np.append(0.0, phi[:-1]) - beta)
    return moment - np.append(moment[1:], end * moment[-1]) - load * lam * h * np.sin(phi)


exercise = Exercise(
    title="The gradient of the strut's energy",
    source="N 2.7",
    questions=(
        Question(
            name="energy",
            calls=calls,
            returns=Number(),
            properties=(equals(V, 1e-12, says="is the energy"),),
            mistakes=(
                Mistake(
                    "rest angles forgotten",
                    "At which difference of angles is a spring at rest? Your energy is lowest elsewhere.",
                    lambda phi, lam, k, beta, h: V(phi, lam, k, 0 * beta, h),
                ),
                Mistake(
                    "factor one half",
                    "What is the energy of a spring whose moment is k times its bend? Integrate.",
                    lambda phi, lam, k, beta, h: 2 * V(phi, 0.0, k, beta, h) + lam * h * np.sum(np.cos(phi)),
                ),
                Mistake(
                    "h forgotten",
                    "A link of length h stands at the angle phi_i: how much higher is its upper end than its lower one?",
                    lambda phi, lam, k, beta, h: V(phi, lam, k, beta, 1.0),
                ),
            ),
            hint="Two sums: what each spring stores, and the load times the height of the strut.",
        ),
        Question(
            name="gradient",
            calls=calls,
            returns=Array(lambda phi, *_: phi.shape),
            properties=(gradient_of(V, 1e-12, points=2.0),),
            mistakes=(
                Mistake(
                    "sign of the load",
                    "The derivative of a cosine: which sign does the load's moment have? At lam = 0 your gradient is right.",
                    lambda *given: moments(*given, load=-1.0),
                ),
                Mistake(
                    "upper spring forgotten",
                    "Angle i occurs in two springs: the one below link i and the one above it.",
                    lambda phi, lam, k, beta, h: k * (phi - np.append(0.0, phi[:-1]) - beta) - lam * h * np.sin(phi),
                ),
                Mistake(
                    "a spring above the last link",
                    "Link n is free at its upper end: how many springs does phi_n occur in? (The natural boundary condition.)",
                    lambda *given: moments(*given, end=1.0),
                ),
                Mistake(
                    "rest angles forgotten",
                    "Is your gradient zero where no spring is stretched and there is no load?",
                    lambda phi, lam, k, beta, h: moments(phi, lam, k, 0 * beta, h),
                ),
                Mistake(
                    "h forgotten",
                    "The load's moment about a joint has an arm: how long is the link?",
                    lambda phi, lam, k, beta, h: moments(phi, lam, k, beta, 1.0),
                ),
            ),
            hint="Each angle occurs in the two springs at the ends of its link and in one cosine; the first and last joint are special.",
        ),
    ),
)
