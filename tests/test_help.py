"""
Text that `help()` shows of every public name: units, shapes, errors.

The rule is read from the code: a function that takes or returns numbers names a unit, one that
returns an array names its shape, one that raises or checks an argument has the section "Raises", in
which each error stands that it raises itself. A value names each of its fields.
"""

import ast
import dataclasses
import inspect
import re
import textwrap

import pytest

import fftocean as fo
from fftocean import errors

UNIT = re.compile(
    r"\[(?:-|[^\]]*\b(?:m|s|rad|degrees|Hz|N|Pa|kg|bytes)\b[^\]]*)\]|\bno unit\b|\bSI\b"
)
AXIS = r"(?:n[xy]\b|n\b|points|frames|rows|columns|times|waves|probes|levels|spans|\.\.\.|\d(?=,))"
SHAPE = re.compile(rf"\bshaped?\b|\({AXIS}[^()]*,[^()]*\)")
NUMBERS = re.compile(
    r"\bfloat\b|\bReal\b|RealLike|Complex|ndarray\[.*floating|_array_like|\bSize\b"
)
ARRAY = re.compile(r"\bReal\b|Complex|ndarray|NDArray")
ERRORS = {name for name in vars(errors) if name.endswith("Error")}
CHECKS = re.compile(r"(require_\w+|checked_\w+|keep_checked|path_of|check)$")
"""Functions that raise for their caller, by name."""


def raised_by(function):
    """Return the errors that a function raises itself, and True if it checks an argument."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    calls = [
        (node, getattr(node.func, "id", getattr(node.func, "attr", "")))
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
    ]
    raising = [node.exc for node in ast.walk(tree) if isinstance(node, ast.Raise)]
    own = {name for node, name in calls if name in ERRORS and node in raising}
    return own, any(CHECKS.match(name) for _, name in calls)


def missing_errors(function, text):
    """Return the errors that a docstring does not name."""
    own, checks = raised_by(function)
    section = text.partition("Raises:")[2]
    found = [f"raises {name}" for name in sorted(own) if name not in section]
    return found or (["Raises:"] if checks and not section else [])


def missing(function, text):
    """Return the parts that the docstring of a function lacks."""
    kinds = {name: str(kind) for name, kind in inspect.get_annotations(function).items()}
    found = []
    if any(NUMBERS.search(kind) for kind in kinds.values()) and not UNIT.search(text):
        found.append("unit")
    if ARRAY.search(kinds.get("return", "")) and not SHAPE.search(text):
        found.append("shape")
    return found + missing_errors(function, text)


def missing_of_class(value):
    """Return what the docstring of a class does not say of its fields and its constructor."""
    text = inspect.getdoc(value) or ""
    found = []
    if dataclasses.is_dataclass(value):
        fields = [field for field in dataclasses.fields(value) if not field.name.startswith("_")]
        found += [
            f"field {field.name}" for field in fields if not re.search(rf"\b{field.name}\b", text)
        ]
        if any(NUMBERS.search(str(field.type)) for field in fields) and not UNIT.search(text):
            found.append("unit")
        made = vars(value).get("__post_init__")
    else:
        made = vars(value).get("__init__")
        text += inspect.getdoc(made) or "" if made else ""
    return found + (missing_errors(made, text) if made else [])


def plain(member):
    """Return the function of a method or property, or None."""
    if isinstance(member, (classmethod, staticmethod)):
        member = member.__func__
    if isinstance(member, property):
        member = member.fget
    return member if inspect.isfunction(member) else None


def public_of(name):
    """Yield (dotted name, function) of a public name: itself, or what a class or module holds."""
    value = getattr(fo, name)
    if inspect.isfunction(value):
        yield name, value
        return
    listed = getattr(value, "__all__", None) or [n for n in vars(value) if n[0] != "_"]
    for member in listed:
        found = vars(value).get(member) if inspect.isclass(value) else getattr(value, member)
        function = plain(found)
        if function and (inspect.isclass(value) or function.__module__.startswith(value.__name__)):
            yield f"{name}.{member}", function


FUNCTIONS = dict(pair for name in fo.__all__ for pair in public_of(name))
CLASSES = [
    name
    for name in fo.__all__
    if inspect.isclass(getattr(fo, name)) and not issubclass(getattr(fo, name), Exception)
]


def test_functions_are_found():
    known = {"normals", "Ocean.frame", "Sea.hs", "dispersion.wavenumber", "Sea.from_wind"}
    assert known <= set(FUNCTIONS)
    assert len(FUNCTIONS) > 150


@pytest.mark.parametrize("name", FUNCTIONS)
def test_help_of_a_function(name):
    assert missing(FUNCTIONS[name], inspect.getdoc(FUNCTIONS[name]) or "") == []


@pytest.mark.parametrize("name", CLASSES)
def test_help_of_a_class(name):
    assert missing_of_class(getattr(fo, name)) == []


def test_the_rule_finds_what_is_missing():
    """Of a docstring whose units, shape and errors are taken away, one by one."""
    text = inspect.getdoc(fo.normals)
    assert missing(fo.normals, text) == []
    assert missing(fo.normals, text.replace("(ny, nx, 3)", "")) == ["shape"]
    assert missing(fo.normals, text.replace("[-]", "")) == ["unit"]
    assert missing(fo.Ocean.from_modes.__func__, "[m]") != []
    assert "Raises:" in missing(fo.JONSWAP.from_wind.__func__, "[m]")

    @dataclasses.dataclass
    class Value:
        """A value."""

        length: float

        def __post_init__(self):
            raise errors.ParameterError("no")

    assert missing_of_class(Value) == ["field length", "unit", "raises ParameterError"]
