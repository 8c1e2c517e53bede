r"""# A study of order

A method with $n$ intervals computes a number with the error $e(n) = C n^{-p} + \dots$: it is of order $p$ [N 2.8; this is how every scheme there
is tested]. Three tools tell from a sequence of $n$, of *any* ratios $n_{i+1}/n_i > 1$, what a method is worth:

$$p_i = - \frac{\ln |e_{i+1}| - \ln |e_i|}{\ln n_{i+1} - \ln n_i}$$

is the observed order; two values $v_i = v + C n_i^{-p}$ determine $v$ and $C$ (Richardson's extrapolation); and where the observed orders leave $p$
at large $n$, rounding has taken over, so that a larger $n$ is wasted.

**Write**

1. `orders(n, errors)`, the observed orders of neighbours, for arrays of equal length $l$: shape (l-1,); errors may be negative;
2. `extrapolated(n, values, p)`, for each pair of neighbours the value $v$ for $n \to \infty$, shape (l-1,);
3. `trusted(n, errors, p, within)`, the number of *errors* at the beginning of the sequence, all of whose observed orders differ from $p$ by at
   most `within`: a whole number, 1 if already the first order is off. What comes later does not count, even if by chance an order is $p$ again.
"""

# %% answer
import numpy as np


def orders(n, errors):
    """Observed orders, an array shorter by one."""
    ### BEGIN SOLUTION
    return -np.diff(np.log(np.abs(errors))) / np.diff(np.log(n))
    ### END SOLUTION


def extrapolated(n, values, p):
    """Richardson's extrapolation of each pair of neighbours, an array shorter by one."""
    ### BEGIN SOLUTION
    gain = (n[1:] / n[:-1]) ** p
    return values[1:] + np.diff(values) / (gain - 1)
    ### END SOLUTION


def trusted(n, errors, p, within):
    """The number of errors before rounding takes over."""
    ### BEGIN SOLUTION
    count = 1
    for order in orders(n, errors):
        if abs(order - p) > within:
            break
        count += 1
    return count
    ### END SOLUTION


# %% checks
import numpy as np

from rodlab.grading.exercise import Exercise, Mistake, Question
from rodlab.grading.properties import equals
from rodlab.grading.values import Array, Number


def sizes(draw, length):
    """A sequence of n with ratios between 1.4 and 2.6, none of them two."""
    ratios = np.where(draw.random(length) < 0.5, draw.uniform(1.4, 1.8, size=length), draw.uniform(2.2, 2.6, size=length))
    return np.round(50 * np.cumprod(ratios))


def slopes(n, errors):
    """Each by a straight line through two points."""
    return np.array([-np.polyfit(np.log(n[i : i + 2]), np.log(np.abs(errors[i : i + 2])), 1)[0] for i in range(len(n) - 1)])


def limits(n, values, p):
    """v and C from two linear equations, in units in which both unknowns are of the same size."""
    pairs = ((n[i : i + 2], values[i : i + 2]) for i in range(len(n) - 1))
    return np.array([np.linalg.solve(np.array([[1.0, 1.0], [1.0, (m[0] / m[1]) ** p]]), v)[0] for m, v in pairs])


def error_lists(draw):
    for p in (1, 2, 4):
        n = sizes(draw, 4)
        signs = np.append(-1.0, draw.choice([-1.0, 1.0], size=3))
        yield n, draw.uniform(1, 3) * signs * n**-p * (1 + draw.uniform(2, 9) / n)


def value_lists(draw):
    for p in (1, 2, 4):
        n = sizes(draw, 4)
        yield n, draw.uniform(1, 3) + draw.uniform(20, 40) * (n / 10) ** -p * (1 + draw.uniform(0.2, 0.5) / n), p


def floors(draw):
    """Errors of order p that at a place meet a floor of rounding which grows; behind it two orders are p by chance."""
    for p, good, first in ((2, 4, 0.4), (4, 2, 4.9), (1, 1, 0.4), (2, 6, 2.8)):
        n = sizes(draw, good + 6)
        errors = np.append(draw.uniform(1, 3) * n[:good] ** -p, np.zeros(6))
        for i, step in enumerate((first, 0.3, p, -1.0, p, -2.0), good):
            errors[i] = errors[i - 1] * (n[i] / n[i - 1]) ** -step
        yield n, errors * draw.choice([-1.0, 1.0], size=n.size), p, 0.2


def prefix(n, errors, p, within):
    """The longest beginning all of whose orders are near p."""
    return max(m for m in range(1, len(n) + 1) if np.all(np.abs(slopes(n[:m], errors[:m]) - p) <= within))


def two(n):
    return 2.0 ** np.arange(len(n))


exercise = Exercise(
    title="A study of order",
    source="N 2.8",
    questions=(
        Question(
            name="orders",
            calls=error_lists,
            returns=Array(lambda n, errors: (n.size - 1,)),
            properties=(equals(slopes, 1e-9, says="are the slopes in a plot of logarithms"),),
            mistakes=(
                Mistake("sign", "The errors fall, and an order is positive.", lambda n, e: -slopes(n, e)),
                Mistake(
                    "ratio two assumed",
                    "Is every n twice the one before? A logarithm to the base two is right then only.",
                    lambda n, e: slopes(two(n), e),
                ),
                Mistake(
                    "upside down",
                    "An error that falls by four when n doubles is of order two, not one half.",
                    lambda n, e: 1 / slopes(n, e),
                ),
                Mistake(
                    "logarithm of a negative number",
                    "An error may be negative; what counts is its size.",
                    when=lambda given: any(np.any(np.isnan(np.asarray(value, dtype=float))) for _, value in given),
                ),
                Mistake(
                    "ratios without logarithms",
                    "Powers become factors only after taking logarithms.",
                    lambda n, e: np.abs(e[:-1] / e[1:]) / (n[1:] / n[:-1]),
                ),
            ),
            hint="Take logarithms of sizes of errors and of n; an order is a slope.",
        ),
        Question(
            name="extrapolated",
            calls=value_lists,
            returns=Array(lambda n, values, p: (n.size - 1,)),
            properties=(equals(limits, 1e-11, says="solve the two equations", points=1.5),),
            mistakes=(
                Mistake(
                    "coarse for fine",
                    "The finer value is nearer to the limit; your extrapolation leads away from it.",
                    lambda n, v, p: v[:-1] - (v[1:] - v[:-1]) / ((n[1:] / n[:-1]) ** p - 1),
                ),
                Mistake(
                    "ratio two assumed",
                    "The formula with 2^p, and for p = 2 with 4 and 3, is for doubled n.",
                    lambda n, v, p: limits(two(n), v, p),
                ),
                Mistake(
                    "order one assumed",
                    "How strongly an error shrinks from one n to the next depends on p.",
                    lambda n, v, p: limits(n, v, 1),
                ),
                Mistake(
                    "minus one forgotten",
                    "Also the finer value has an error: eliminate C exactly.",
                    lambda n, v, p: v[1:] + (v[1:] - v[:-1]) / (n[1:] / n[:-1]) ** p,
                ),
                Mistake("mean", "The limit is not between the two values.", lambda n, v, p: (v[1:] + v[:-1]) / 2),
            ),
            hint="Two equations v_i = v + C n_i^(-p): eliminate C.",
        ),
        Question(
            name="trusted",
            calls=floors,
            returns=Number(whole=True),
            properties=(equals(prefix, 0.0, says="counts the errors before the floor", points=1.5),),
            mistakes=(
                Mistake(
                    "orders counted",
                    "Two errors make one order: how many errors make three?",
                    lambda *given: prefix(*given) - 1,
                ),
                Mistake(
                    "later ones counted too",
                    "Behind the floor an order can be p by chance; where do you stop counting?",
                    lambda n, e, p, within: 1 + int(np.sum(np.abs(slopes(n, e) - p) <= within)),
                ),
                Mistake(
                    "as long as errors fall",
                    "On the floor errors may still fall a little. Compare orders with p, not errors with each other.",
                    lambda n, e, p, within: 1 + int(np.argmax(np.append(slopes(n, e) < 0, True))),
                ),
                Mistake(
                    "up to the last good one",
                    "A chance hit after the floor must not carry you over it.",
                    lambda n, e, p, within: 2 + int(np.flatnonzero(np.abs(slopes(n, e) - p) <= within)[-1]),
                ),
            ),
            hint="Walk along the observed orders and stop at the first that is off.",
        ),
    ),
)

# %% proofs
PROOFS = {
    "orders: logarithm of a negative number": (
        "np.log(np.abs(errors))",
        "np.where(errors > 0, np.log(np.abs(errors)), np.nan)",
    ),
    "orders: sign": ("return -np.diff", "return np.diff"),
    "orders: ratio two assumed": ("/ np.diff(np.log(n))", "/ np.log(2)"),
    "orders: upside down": (
        "-np.diff(np.log(np.abs(errors))) / np.diff(np.log(n))",
        "-np.diff(np.log(n)) / np.diff(np.log(np.abs(errors)))",
    ),
    "orders: ratios without logarithms": (
        "-np.diff(np.log(np.abs(errors))) / np.diff(np.log(n))",
        "np.abs(errors[:-1] / errors[1:]) * n[:-1] / n[1:]",
    ),
    "extrapolated: coarse for fine": ("values[1:] + np.diff", "values[:-1] - np.diff"),
    "extrapolated: ratio two assumed": ("gain = (n[1:] / n[:-1]) ** p", "gain = 2**p"),
    "extrapolated: order one assumed": ("(n[1:] / n[:-1]) ** p", "n[1:] / n[:-1]"),
    "extrapolated: minus one forgotten": ("(gain - 1)", "gain"),
    "extrapolated: mean": ("values[1:] + np.diff(values) / (gain - 1)", "values[1:] - np.diff(values) / 2"),
    "trusted: orders counted": ("return count", "return count - 1"),
    "trusted: later ones counted too": ("            break\n", "            continue\n"),
    "trusted: as long as errors fall": ("abs(order - p) > within", "order < 0"),
    "trusted: up to the last good one": (
        "    return count\n",
        "    return 2 + int(np.flatnonzero(abs(orders(n, errors) - p) <= within)[-1])\n",
    ),
}
