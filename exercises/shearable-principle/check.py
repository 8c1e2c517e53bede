"""Checks of the exercise "The principle of a shearable, extensible rod"; made from the teacher's file."""

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals
from rodlab.grading.values import Parts, Symbolic

STIFF = {"K": (1, 2), "A_1": (3, 5), "A_3": (6, 9)}
REST = {"u_hat": (-1, 1), "v_1_hat": (0.1, 0.3), "v_3_hat": (0.9, 1.1)}
STATE = {"u": (2, 3), "v_1": (0.4, 0.7), "v_3": (1.2, 1.5)}
NAMES = {**STIFF, **REST, **STATE, "phi": (0.2, 1.3), "lam": (1, 3)}

STORED = "K*(u - u_hat)**2/2 + A_1*(v_1 - v_1_hat)**2/2 + A_3*(v_3 - v_3_hat)**2/2"
SHEAR, STRETCH = "(v_1_hat + lam*sin(phi)/A_1)", "(v_3_hat - lam*cos(phi)/A_3)"


def nothing(draw):
    yield ()


def text(expression):
    return lambda: expression


def rate(shear=SHEAR, stretch=STRETCH):
    return f"-lam*({stretch}*sin(phi) + {shear}*cos(phi))"


exercise = Exercise(
    title="The principle of a shearable, extensible rod",
    source="N 2.8",
    imports=("numpy", "sympy"),
    questions=(
        Question(
            name="density",
            calls=nothing,
            returns=Symbolic(NAMES),
            properties=(equals(text(f"{STORED} + lam*(v_3*cos(phi) - v_1*sin(phi))"), 1e-12, says="is the energy's density"),),
            mistakes=(
                Mistake(
                    "sign of the shear",
                    "The height's part is the vertical component of r'. Which way does d_1 point for a small positive phi?",
                    text(f"{STORED} + lam*(v_3*cos(phi) + v_1*sin(phi))"),
                ),
                Mistake(
                    "sideways for upwards",
                    "The load's potential is the height. Which component of r' is yours?",
                    text(f"{STORED} + lam*(v_3*sin(phi) + v_1*cos(phi))"),
                ),
                Mistake(
                    "sign of the load",
                    "The load presses down: does its potential grow or fall with the height?",
                    text(f"{STORED} - lam*(v_3*cos(phi) - v_1*sin(phi))"),
                ),
                Mistake(
                    "inextensible height",
                    "You let the rod shear and stretch in its energy; its height is still that of the old rod.",
                    text(f"{STORED} + lam*cos(phi)"),
                ),
                Mistake(
                    "factors one half",
                    "Differentiate your energy with respect to a strain: do you find the force of the law?",
                    text(f"2*({STORED}) + lam*(v_3*cos(phi) - v_1*sin(phi))"),
                ),
            ),
            hint="Three energies of springs, one a strain, and the load times the vertical component of r'.",
        ),
        Question(
            name="strains",
            calls=nothing,
            returns=Parts(Symbolic(NAMES), Symbolic(NAMES)),
            properties=(equals(text([SHEAR, STRETCH]), 1e-12, says="makes the density stationary in v_1 and v_3"),),
            mistakes=(
                Mistake(
                    "signs",
                    "At phi = 0 a pressed rod is shorter than at rest: is yours?",
                    text(["v_1_hat - lam*sin(phi)/A_1", "v_3_hat + lam*cos(phi)/A_3"]),
                ),
                Mistake(
                    "forces for strains",
                    "These are the forces n_1 and n_3; which strains does the law give for them?",
                    text(["lam*sin(phi)", "-lam*cos(phi)"]),
                ),
                Mistake(
                    "values at rest forgotten",
                    "Set lam = 0: your rod has no length.",
                    text(["lam*sin(phi)/A_1", "-lam*cos(phi)/A_3"]),
                ),
                Mistake("in the other order", "The shear v_1 comes first, then the stretch v_3.", text([STRETCH, SHEAR])),
            ),
            hint="The derivative of W with respect to a strain is the law's force and one component of the load.",
        ),
        Question(
            name="moment_rate",
            calls=nothing,
            returns=Symbolic(NAMES),
            properties=(equals(text(rate()), 1e-12, says="is the balance of moments", points=1.5),),
            mistakes=(
                Mistake(
                    "that of the inextensible rod",
                    "This is the balance of the rod that neither shears nor stretches: the strains depend on phi.",
                    text("-lam*sin(phi)"),
                ),
                Mistake(
                    "strains at rest",
                    "The strains are those at the equilibrium, not those without a load.",
                    text(rate("v_1_hat", "v_3_hat")),
                ),
                Mistake(
                    "strains not eliminated",
                    "The answer must have phi and constants only: put in what strains() gives.",
                    text(rate("v_1", "v_3")),
                ),
                Mistake(
                    "sign",
                    "The Euler-Lagrange equation equates the derivative of dW/du with dW/dphi: on which side is yours?",
                    text(f"-({rate()})"),
                ),
            ),
            hint="Stationarity in phi: (dW/du)' = dW/dphi, the derivative taken at fixed strains; then put in the strains.",
        ),
    ),
)
