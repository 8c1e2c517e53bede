# Texts and symbols that look like code
# points: 0, by its values alone
import sympy as sp


def hessian(phi, lam):
    return [["__import__('os').abort()"] * 2] * 2


def branch_points():
    return [sp.Symbol("().__class__.__base__.__subclasses__()"), sp.Symbol("__import__('os').abort()")]


def modes():
    return sp.Symbol("[c for c in ().__class__.__mro__]"), sp.Symbol("(lambda: 0)()")


def index(lam):
    return sp.Symbol("x" * 10**5) if lam > 1 else sp.Symbol("1e400**1e400")
