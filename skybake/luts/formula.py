"""Formulas as text, which numpy evaluates and other languages are written from.

A formula is a few lines ``name = expression`` in the notation of Python: numbers, names,
``+ - * /``, comparisons, ``a if condition else b``, and the functions of `FUNCTIONS`. Names in
capitals are constants.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sqrt": np.sqrt,
    "sin": np.sin,
    "cos": np.cos,
    "acos": np.arccos,
    "atan2": np.arctan2,
    "abs": np.abs,
    "min": np.minimum,
    "max": np.maximum,
}
"""What formulas may call."""

_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.USub: operator.neg,
    ast.Lt: operator.lt,
    ast.Gt: operator.gt,
    ast.LtE: operator.le,
    ast.GtE: operator.ge,
}


def evaluate(formula: str, values: Mapping[str, npt.ArrayLike]) -> dict[str, Any]:
    """Evaluate a formula.

    Parameters
    ----------
    formula : str
        Its lines.
    values : mapping of str to array_like
        Constants and what it is a formula of; all are broadcast.

    Returns
    -------
    dict of str to ndarray
        The given values and those of all lines. Of a condition both branches are evaluated, and
        what is not finite in the one that does not hold is dropped.

    Raises
    ------
    KeyError
        If a name has no value.
    ValueError
        For what is no formula.
    """
    known: dict[str, Any] = {name: np.asarray(value, float) for name, value in values.items()}
    with np.errstate(divide="ignore", invalid="ignore"):
        for line in ast.parse(formula).body:
            if not (isinstance(line, ast.Assign) and isinstance(line.targets[0], ast.Name)):
                raise ValueError(f"formula must be lines of name = expression, got {formula!r}")
            known[line.targets[0].id] = _value(line.value, known)
    return known


def _value(node: ast.AST, known: Mapping[str, Any]) -> Any:  # noqa: PLR0911 - one for each kind of node
    match node:
        case ast.Constant(value=float() | int() as number):
            return float(number)
        case ast.Name(id=name):
            return known[name]
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_value(left, known), _value(right, known))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand, known)
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_value(left, known), _value(right, known))
        case ast.IfExp(test=test, body=body, orelse=orelse):
            return np.where(*(_value(each, known) for each in (test, body, orelse)))
        case ast.Call(func=ast.Name(id=name), args=arguments) if name in FUNCTIONS:
            return FUNCTIONS[name](*(_value(each, known) for each in arguments))
        case _:
            raise ValueError(f"formula must not hold {ast.unparse(node)!r}")
