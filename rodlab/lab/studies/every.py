"""Every method by its name: the house's, the others', and the peers that are installed."""

from rodlab.lab.studies.asked import Method
from rodlab.lab.studies.methods import house_method

HOUSE = ("strut, end", "strut, trapezoid", "rod, ")  # how the names of those begin that answer any question


def method_named(name: str) -> Method:
    """A method by its name. `ValueError` for one that nobody has."""
    if name.startswith(HOUSE):
        return house_method(name)
    known = {method.name: method for method in (*others(), *rivals())}
    if name not in known:
        told = "; ".join(["strut, end", "strut, trapezoid", "rod, degree m", "rod, adapted", *known])
        raise ValueError(f"a method must be one of {told}; it is {name!r:.60}")
    return known[name]


def others() -> list[Method]:
    """The house's other ways to a tip angle."""
    from rodlab.lab.studies.other_methods import other_methods

    return other_methods()


def rivals() -> list[Method]:
    """What people use today."""
    from rodlab.lab.studies.peers import peers

    return peers()
