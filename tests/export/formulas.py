"""
Evaluator of the formulas in sidecars: numbers, names, + - * /, floor, mod, an index; nothing else.
"""

import ast
import functools
import operator

import numpy as np

OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
FUNCTIONS = {"floor": np.floor, "mod": lambda a, b: a - b * np.floor(a / b)}


@functools.cache
def parsed(formula):
    return ast.parse(formula, mode="eval").body


def value_of(formula, names):
    """
    Return the value of a formula: numbers, names, + - * /, floor, mod, an index; nothing else.
    """

    def of(node):
        match node:
            case ast.Constant(value=value):
                return value
            case ast.Name(id=name):
                return names[name]
            case ast.BinOp(left=left, op=op, right=right):
                return OPERATORS[type(op)](of(left), of(right))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -of(operand)
            case ast.Subscript(value=value, slice=index):
                return of(value)[of(index)]
            case ast.Call(func=ast.Name(id=name), args=args):
                return FUNCTIONS[name](*map(of, args))
        raise AssertionError(f"{formula} holds {ast.dump(node)}")

    return of(parsed(formula))
