"""rodlab: a teaching laboratory for elastic rods.

    import rodlab as rl
    strut = rl.Strut(n=100)
    rl.buckling(strut, 3).loads
    p = rl.equilibrium(strut, lam=5.0, guess=lambda s: s)
    p.tip_angle, p.error, p.index, p.energy
    b = rl.follow(rl.equilibrium(strut, 0.0), to=30.0); b.points, b.events
    starts = rl.switch(b.events[0])
    rl.diagram(strut, lam=(0, 130)).table
    rl.all_equilibria(strut, lam=130.0).certified

Names are imported when they are first used: `import rodlab` brings in no other package.
"""

from rodlab.version import __version__ as __version__

TYPE_CHECKING = False  # what type checkers take for true; importing typing would double the time
if TYPE_CHECKING:
    from rodlab.analysis.continuation import branch
    from rodlab.analysis.deflation import deflation
    from rodlab.analysis.diagram import Diagram, diagram
    from rodlab.analysis.distinguished import Distinguished, distinguished
    from rodlab.analysis.downhill import steepest_descent
    from rodlab.analysis.equations import Equations
    from rodlab.analysis.equilibrium import equilibrium
    from rodlab.analysis.events import Event, branch_point, fold
    from rodlab.analysis.expansion import Expansion, expansion
    from rodlab.analysis.follow import Branch, follow
    from rodlab.analysis.imperfection import Imperfection, imperfection
    from rodlab.analysis.newton import Newton, NoConvergence
    from rodlab.analysis.point import Point, Shape
    from rodlab.analysis.switching import switch
    from rodlab.analysis.unfolding import branch_points, folds
    from rodlab.analysis.vary import vary
    from rodlab.lab.census import census
    from rodlab.lab.equilibria import Equilibria, all_equilibria
    from rodlab.lab.saved import read
    from rodlab.lab.studies.study import Study, study
    from rodlab.lab.teaching.course import check, hint
    from rodlab.mechanics.buckling import Buckling, buckling, buckling_loads
    from rodlab.mechanics.conjugate import conjugate_points
    from rodlab.mechanics.convexity import uniqueness
    from rodlab.mechanics.elastica import Elastica, elastica
    from rodlab.mechanics.indices import Indices, indices
    from rodlab.mechanics.invariants import Invariants, invariants
    from rodlab.mechanics.koiter import Koiter, koiter
    from rodlab.mechanics.rod import Rod
    from rodlab.mechanics.shear import ShearableRod, shear_loads, shearable_principle
    from rodlab.mechanics.strut import Strut
    from rodlab.mechanics.terms import Term, end_force, end_torque, foundation, potential, self_weight, shearable, term
    from rodlab.numerics.bordered import Bordered
    from rodlab.numerics.factor import factor
    from rodlab.numerics.tridiagonal import Tridiagonal

_HOME = {
    "Bordered": "numerics.bordered",
    "Branch": "analysis.follow",
    "Buckling": "mechanics.buckling",
    "Diagram": "analysis.diagram",
    "Distinguished": "analysis.distinguished",
    "Elastica": "mechanics.elastica",
    "Equations": "analysis.equations",
    "Equilibria": "lab.equilibria",
    "Event": "analysis.events",
    "Expansion": "analysis.expansion",
    "Imperfection": "analysis.imperfection",
    "Indices": "mechanics.indices",
    "Invariants": "mechanics.invariants",
    "Koiter": "mechanics.koiter",
    "Newton": "analysis.newton",
    "NoConvergence": "analysis.newton",
    "Point": "analysis.point",
    "Rod": "mechanics.rod",
    "Shape": "analysis.point",
    "ShearableRod": "mechanics.shear",
    "Strut": "mechanics.strut",
    "Study": "lab.studies.study",
    "Term": "mechanics.terms",
    "Tridiagonal": "numerics.tridiagonal",
    "all_equilibria": "lab.equilibria",
    "branch": "analysis.continuation",
    "branch_point": "analysis.events",
    "branch_points": "analysis.unfolding",
    "buckling": "mechanics.buckling",
    "buckling_loads": "mechanics.buckling",
    "census": "lab.census",
    "check": "lab.teaching.course",
    "conjugate_points": "mechanics.conjugate",
    "deflation": "analysis.deflation",
    "diagram": "analysis.diagram",
    "distinguished": "analysis.distinguished",
    "elastica": "mechanics.elastica",
    "end_force": "mechanics.terms",
    "end_torque": "mechanics.terms",
    "equilibrium": "analysis.equilibrium",
    "expansion": "analysis.expansion",
    "factor": "numerics.factor",
    "fold": "analysis.events",
    "folds": "analysis.unfolding",
    "follow": "analysis.follow",
    "foundation": "mechanics.terms",
    "hint": "lab.teaching.course",
    "imperfection": "analysis.imperfection",
    "indices": "mechanics.indices",
    "invariants": "mechanics.invariants",
    "koiter": "mechanics.koiter",
    "potential": "mechanics.terms",
    "read": "lab.saved",
    "self_weight": "mechanics.terms",
    "shear_loads": "mechanics.shear",
    "shearable": "mechanics.terms",
    "shearable_principle": "mechanics.shear",
    "steepest_descent": "analysis.downhill",
    "study": "lab.studies.study",
    "switch": "analysis.switching",
    "term": "mechanics.terms",
    "uniqueness": "mechanics.convexity",
    "vary": "analysis.vary",
}

__all__ = [  # the same names; a test compares
    "Bordered", "Branch", "Buckling", "Diagram", "Distinguished", "Elastica", "Equations", "Equilibria", "Event",
    "Expansion", "Imperfection", "Indices", "Invariants", "Koiter", "Newton", "NoConvergence", "Point", "Rod", "Shape",
    "ShearableRod", "Strut", "Study", "Term", "Tridiagonal", "all_equilibria", "branch", "branch_point", "branch_points",
    "buckling", "buckling_loads", "census", "check", "conjugate_points", "deflation", "diagram", "distinguished", "elastica",
    "end_force", "end_torque", "equilibrium", "expansion", "factor", "fold", "folds", "follow", "foundation",
    "hint", "imperfection", "indices", "invariants", "koiter", "potential", "read", "self_weight", "shear_loads", "shearable",
    "shearable_principle", "steepest_descent", "study", "switch", "term", "uniqueness", "vary",
]  # fmt: skip


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module 'rodlab' has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(f"rodlab.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOME])
