"""A model as plain data: what a scene's [model] table and a saved branch hold, numbers, text and lists.

{"n": 100, "u_hat": 0.01, "terms": {"self_weight": {"q": 2.0}}}        a Strut; several of one name as a list
{"k": [1, 1], "beta": [0.1, 0]}                                        Strut.from_joints
{"model": "rod", "K": "1 + s", "degree": 6}                            a Rod; with "points" on that mesh
{..., "vary": "u_hat", "lam": 5.0}                                     the same, followed in u_hat at a load
"""

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from rodlab.mechanics.terms import Term, end_force, end_torque, foundation, potential, self_weight, shearable

if TYPE_CHECKING:
    from rodlab.mechanics.rod import Rod
    from rodlab.mechanics.strut import Strut
    from rodlab.mechanics.varied import VariedStrut
    from rodlab.mechanics.varied_rod import VariedRod

TERMS: dict[str, Callable[..., Term]] = {
    make.__name__: make for make in (self_weight, foundation, end_torque, end_force, shearable, potential)
}
HELD = ("ends", "phi1", "offset")
BY_RULE = ("n", "K", "u_hat", "rule", "phi0", "breaks", *HELD)
BY_JOINT = ("k", "beta", "h", "beta0", "weights", *HELD)
OF_ROD = ("K", "u_hat", "phi0", "breaks", "degree", "mesh", "tol", "points", *HELD)


def build(recipe: Mapping[str, Any]) -> "Strut | Rod | VariedStrut | VariedRod":
    """The model of a recipe; `ValueError`, in one sentence, for what is none.

    >>> build({"n": 3, "terms": {"self_weight": {"q": 2.0}}})
    Strut(n=3, K=1.0, u_hat=0.0, rule='end', terms=(self_weight(q=2.0),))
    >>> build({"model": "rod", "u_hat": 0.5})
    Rod(K=1.0, u_hat=0.5)
    """
    given = dict(recipe)
    kind, vary, lam = given.pop("model", "strut"), given.pop("vary", None), given.pop("lam", None)
    if kind not in ("strut", "rod"):
        raise ValueError(f"model must be 'strut' or 'rod'; it is {kind!r}")
    listed = _table("terms", given.pop("terms", {})).items()
    terms = tuple(_term(name, each) for name, said in listed for each in (said if isinstance(said, list) else [said]))
    joints = kind == "strut" and "k" in given
    known = OF_ROD if kind == "rod" else BY_JOINT if joints else BY_RULE
    unknown = [name for name in given if name not in known]
    if unknown:
        allowed = ", ".join(["model", *known, "terms", "vary", "lam"])
        raise ValueError(f"a model must be made of {allowed}; {unknown[0]} is none of these")
    model = _rod(given, terms) if kind == "rod" else _strut(given, terms, joints=joints)
    if vary is None:
        if lam is not None:
            raise ValueError("lam must be given in a model only with vary, the name of the parameter that is followed")
        return model
    varied: Strut | Rod | VariedStrut | VariedRod = model.vary(vary, lam)
    return varied


def _strut(given: Mapping[str, Any], terms: tuple[Term, ...], *, joints: bool) -> "Strut":
    from rodlab.mechanics.strut import Strut

    return Strut.from_joints(**given, terms=terms) if joints else Strut(**given, terms=terms)


def _rod(given: dict[str, Any], terms: tuple[Term, ...]) -> "Rod":
    from rodlab.mechanics.rod import Rod

    points = given.pop("points", None)
    rod = Rod(**given, terms=terms)
    return rod if points is None else rod.on_points(points)


def recipe_of(arguments: Mapping[str, Any], terms: Sequence[Term]) -> dict[str, Any] | None:
    """The recipe of a strut's arguments; None where one of them is a function."""
    recipe = {name: _plain(value) for name, value in arguments.items() if name != "terms" and value is not None}
    said: dict[str, Any] = {}
    for term in terms:
        said.setdefault(term.name, []).append({name: _plain(value) for name, value in term.arguments.items()})
    values = [*recipe.values(), *(value for each in said.values() for parameters in each for value in parameters.values())]
    said = {name: each[0] if len(each) == 1 else each for name, each in said.items()}
    if any(callable(value) for value in values) or any(term.own for term in terms):
        return None
    return {**recipe, "terms": said} if said else recipe


def changed(arguments: Mapping[str, Any], terms: Sequence[Term], changes: Mapping[str, Any]) -> dict[str, Any]:
    """A strut's arguments with some of them, or of its terms' parameters, replaced."""
    given, own = dict(arguments), list(terms)
    for name, value in changes.items():
        owner = next((i for i, term in enumerate(own) if name in term.parameters), None)
        if owner is not None:
            own[owner] = replace(own[owner], parameters={**own[owner].parameters, name: value})
        elif name in given or name in HELD:
            given[name] = value
        else:
            known = list(dict.fromkeys([*given, *HELD, *(p for term in own for p in term.parameters)]))
            raise ValueError(f"the model has no argument {name}; it has {', '.join(known)}")
    if "terms" not in changes:
        given["terms"] = tuple(own)
    return given


def said_of(arguments: Mapping[str, Any], n: int, terms: Sequence[Term]) -> str:
    """A strut's arguments as its repr says them."""
    if "n" not in arguments:
        said = f"n={n}, from joints"
    else:
        said = ", ".join(f"{name}={arguments[name]!r}" for name in ("n", "K", "u_hat", "rule"))
        said += f", phi0={arguments['phi0']!r}" if arguments["phi0"] else ""
    return said + (f", terms={tuple(terms)!r}" if terms else "")


def rod_recipe_of(arguments: Mapping[str, Any], terms: Sequence[Term]) -> dict[str, Any] | None:
    """The recipe of a rod's arguments, marked as that of a rod; None where one of them is a function."""
    recipe = recipe_of(arguments, terms)
    return None if recipe is None else {"model": "rod", **recipe}


def said_of_rod(arguments: Mapping[str, Any], terms: Sequence[Term]) -> str:
    """A rod's arguments as its repr says them: K, u_hat, and what is not as usual."""
    usual: dict[str, Any] = {"phi0": 0.0, "degree": 6, "mesh": None, "tol": 1e-10}
    said = [f"{name}={arguments[name]!r}" for name in ("K", "u_hat")]
    said += [f"{name}={arguments[name]!r}" for name, value in usual.items() if not np.array_equal(arguments[name], value)]
    return ", ".join(said) + (f", terms={tuple(terms)!r}" if terms else "")


def kept(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments with arrays copied, so that they stay what they were."""
    return {name: value.copy() if isinstance(value, np.ndarray) else value for name, value in arguments.items()}


def _term(name: str, parameters: Any) -> Term:
    if name not in TERMS:
        raise ValueError(f"terms must be among {', '.join(TERMS)}; one is {name!r}")
    try:
        return TERMS[name](**_table(f"terms.{name}", parameters))
    except TypeError as error:
        takes = ", ".join(inspect.signature(TERMS[name]).parameters)
        raise ValueError(f"terms.{name} has the wrong parameters: {error}; it takes {takes}") from None


def _table(name: str, value: Any) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise ValueError(f"{name} must be a table; it is {value!r:.60}")
    return value


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value
