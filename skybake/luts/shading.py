"""Functions in GLSL, HLSL and WGSL, written from one text in the notation of Python.

Types of the text are ``float``, ``vec2``, ``vec3``, ``vec4``, ``plane`` (a texture) and ``volume``;
``sample(table, coordinates)`` reads a texture with linear filtering. Names in capitals are
constants, which get the prefix `PREFIX`.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass, field

LANGUAGES = ("glsl", "hlsl", "wgsl")
PREFIX = "LUTS_"

Constant = float | tuple[float, ...]

_PRECEDENCE = {ast.Mult: 3, ast.Div: 3, ast.Add: 2, ast.Sub: 2}
_SYMBOLS: dict[type[ast.AST], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Lt: "<",
    ast.Gt: ">",
    ast.LtE: "<=",
    ast.GtE: ">=",
}
_UNARY = 4
_TEXTURES = ("plane", "volume")


@dataclass(frozen=True, kw_only=True)
class Language:
    """How a language writes what differs.

    Attributes
    ----------
    types : mapping of str to str
        Its types, by those of the text.
    functions : mapping of str to str
        Its names of functions that have other ones.
    constant, local, parameter, sampler : str
        Declarations, to be formatted with ``type``, ``name`` and ``value``.
    header : str
        First line of a function, with ``returns``, ``name`` and ``parameters``.
    choice : str
        ``first if test else second``.
    sample : str
        A read of ``texture`` at ``place``.
    has_samplers : bool
        Whether a sampler goes with every texture.
    """

    types: Mapping[str, str]
    functions: Mapping[str, str] = field(default_factory=dict)
    constant: str
    local: str
    parameter: str
    sampler: str = ""
    header: str
    choice: str
    sample: str
    has_samplers: bool = True


_C_PARAMETER = "{type} {name}"
_C_HEADER = "{returns} {name}({parameters})"
_C_CHOICE = "({test} ? {first} : {second})"
_VECTORS = {"vec2": "vec2", "vec3": "vec3", "vec4": "vec4"}
_KINDS = {
    "glsl": Language(
        types={
            "float": "float",
            **_VECTORS,
            "plane": "highp sampler2D",
            "volume": "highp sampler3D",
        },
        functions={"atan2": "atan"},
        constant="const {type} {name} = {value};",
        sample="textureLod({texture}, {place}, 0.0)",
        local="{type} {name} = {value};",
        parameter=_C_PARAMETER,
        header=_C_HEADER,
        choice=_C_CHOICE,
        has_samplers=False,
    ),
    "hlsl": Language(
        types={
            "float": "float",
            "vec2": "float2",
            "vec3": "float3",
            "vec4": "float4",
            "plane": "Texture2D<float4>",
            "volume": "Texture3D<float4>",
        },
        constant="static const {type} {name} = {value};",
        sampler="SamplerState {name}_sampler",
        sample="{texture}.SampleLevel({texture}_sampler, {place}, 0.0)",
        local="const {type} {name} = {value};",
        parameter=_C_PARAMETER,
        header=_C_HEADER,
        choice=_C_CHOICE,
    ),
    "wgsl": Language(
        types={
            "float": "f32",
            "vec2": "vec2<f32>",
            "vec3": "vec3<f32>",
            "vec4": "vec4<f32>",
            "plane": "texture_2d<f32>",
            "volume": "texture_3d<f32>",
        },
        constant="const {name}: {type} = {value};",
        local="let {name}: {type} = {value};",
        parameter="{name}: {type}",
        sampler="{name}_sampler: sampler",
        header="fn {name}({parameters}) -> {returns}",
        choice="select({second}, {first}, {test})",
        sample="textureSampleLevel({texture}, {texture}_sampler, {place}, 0.0)",
    ),
}


def declare_constants(language: str, constants: Mapping[str, tuple[Constant, str]]) -> str:
    """Return declarations of constants.

    Parameters
    ----------
    language : str
        One of `LANGUAGES`.
    constants : mapping of str to (float or tuple of float, str)
        Value and meaning of each, by names in capitals.
    """
    kind = _KINDS[language]
    lines = []
    for name, (value, meaning) in constants.items():
        if isinstance(value, tuple):
            of_type = kind.types[f"vec{len(value)}"]
            text = f"{of_type}({', '.join(map(_number, value))})"
        else:
            of_type, text = kind.types["float"], _number(value)
        declared = kind.constant.format(type=of_type, name=PREFIX + name, value=text)
        lines.append(f"{declared} // {meaning}")
    return "\n".join(lines) + "\n"


def write_functions(language: str, text: str) -> str:
    """Return functions in a language.

    Parameters
    ----------
    language : str
        One of `LANGUAGES`.
    text : str
        The functions in the notation of Python, each with a docstring, which becomes a comment.
    """
    return "\n".join(
        _Writer(_KINDS[language], one).function()
        for one in ast.parse(text).body
        if isinstance(one, ast.FunctionDef)
    )


class _Writer:
    """Writes one function in one language."""

    def __init__(self, kind: Language, function: ast.FunctionDef) -> None:
        self._kind = kind
        self._function = function
        arguments = function.args.args
        self._types = {one.arg: ast.unparse(one.annotation or one) for one in arguments}
        self._textures = {name for name, kind in self._types.items() if kind in _TEXTURES}

    def function(self) -> str:
        """Return the function, with its comment above it."""
        kind, function = self._kind, self._function
        parameters = []
        for name, of_type in self._types.items():
            parameters.append(kind.parameter.format(type=kind.types[of_type], name=name))
            if name in self._textures and kind.has_samplers:
                parameters.append(kind.sampler.format(name=name))
        header = kind.header.format(
            returns=kind.types[ast.unparse(function.returns or function)],
            name=function.name,
            parameters=", ".join(parameters),
        )
        comment = "".join(
            f"// {line}\n" for line in (ast.get_docstring(function) or "").splitlines()
        )
        body = "".join(f"    {line}\n" for each in function.body if (line := self._line(each)))
        return f"{comment}{header} {{\n{body}}}\n"

    def _line(self, node: ast.stmt) -> str:
        match node:
            case ast.Expr(value=ast.Constant()):
                return ""
            case ast.Return(value=ast.expr() as value):
                return f"return {self._text(value)};"
            case ast.AnnAssign(
                target=ast.Name(id=name), annotation=of_type, value=ast.expr() as value
            ):
                declared = self._kind.types[ast.unparse(of_type)]
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                declared = self._kind.types["float"]
            case _:
                raise ValueError(f"function must not hold {ast.unparse(node)!r}")
        return self._kind.local.format(type=declared, name=name, value=self._text(value))

    def _text(self, node: ast.expr, outside: int = 0) -> str:  # noqa: PLR0911 - one for each kind of node
        """Return an expression, in brackets if what is around it binds more closely."""
        match node:
            case ast.Constant(value=float() | int() as number):
                return _number(float(number))
            case ast.Name(id=name):
                return PREFIX + name if name.isupper() else name
            case ast.Attribute(value=value, attr=name):
                return f"{self._text(value, _UNARY)}.{name}"
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _PRECEDENCE:
                inside = _PRECEDENCE[type(op)]
                # What is subtracted or divided by keeps its own brackets.
                sides = self._text(left, inside), self._text(right, inside + 1)
                text = f"{sides[0]} {_SYMBOLS[type(op)]} {sides[1]}"
                return f"({text})" if inside < outside else text
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                text = f"-{self._text(operand, _UNARY)}"
                return f"({text})" if outside > 0 else text
            case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _SYMBOLS:
                return f"{self._text(left)} {_SYMBOLS[type(op)]} {self._text(right)}"
            case ast.IfExp(test=test, body=body, orelse=orelse):
                first, second = self._text(body), self._text(orelse)
                return self._kind.choice.format(test=self._text(test), first=first, second=second)
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return self._call(name, arguments)
            case _:
                raise ValueError(f"function must not hold {ast.unparse(node)!r}")

    def _call(self, name: str, arguments: list[ast.expr]) -> str:
        kind = self._kind
        texts = [self._text(each) for each in arguments]
        if name == "sample":
            return kind.sample.format(texture=texts[0], place=texts[1])
        passed = []
        for text in texts:
            passed.append(text)
            if text in self._textures and kind.has_samplers:
                passed.append(f"{text}_sampler")
        called = kind.types.get(name) or kind.functions.get(name, name)
        return f"{called}({', '.join(passed)})"


def _number(value: float) -> str:
    text = f"{value:.9g}"
    return text if "." in text or "e" in text else f"{text}.0"
