# Expressions of SymPy that never end, and one nested deeply
# points: 0, by its values alone, in haste
import sympy as sp

x = sp.Symbol("x")


def hessian(phi, lam):
    found = x
    for _ in range(600):
        found = sp.sin(found, evaluate=False)
    return [[found, found], [found, found]]


def branch_points():
    nine = sp.Integer(9)
    tower = sp.Pow(nine, sp.Pow(nine, sp.Pow(nine, nine, evaluate=False), evaluate=False), evaluate=False)
    return [tower, sp.exp(tower, evaluate=False)]


def modes():
    return sp.Matrix([[sp.zoo, sp.nan], [sp.oo, sp.I]])


def index(lam):
    return sp.Function("__import__")(x)
