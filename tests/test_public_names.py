"""Public names: `__all__`, the names for type checkers and the documentation agree."""

import ast
import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import fftocean as fo

ROOT = Path(__file__).parent.parent
PAGES = {
    path.name: path.read_text(encoding="utf-8")
    for path in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
}


def names_for_type_checkers():
    """Return {public name: (module, name there)} of the TYPE_CHECKING block."""
    tree = ast.parse(Path(fo.__file__).read_text(encoding="utf-8"))
    (block,) = [
        node
        for node in tree.body
        if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING"
    ]
    return {alias.asname: (line.module, alias.name) for line in block.body for alias in line.names}


def test_type_checkers_see_all_public_names():
    assert sorted(names_for_type_checkers()) == sorted(set(fo.__all__)) == fo.__all__


@pytest.mark.parametrize("name", fo.__all__)
def test_a_public_name_is_the_object_that_type_checkers_see(name, monkeypatch):
    """Looked up anew: an import elsewhere sets a module's name, too."""
    module, there = names_for_type_checkers()[name]
    scope = {}
    exec(f"from {module} import {there} as found", scope)
    monkeypatch.delitem(vars(fo), name, raising=False)
    assert getattr(fo, name) is scope["found"]
    if inspect.ismodule(scope["found"]):
        assert scope["found"].__name__ == f"{module}.{there}"


def test_dir_lists_the_public_names():
    assert set(fo.__all__) <= set(dir(fo))


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'fftocean' has no attribute 'oceans'"):
        fo.oceans  # noqa: B018 - the access is the test


def test_the_list_of_public_names_is_complete():
    """Every name has one row in docs/api.md, and every row is a public name."""
    listed = re.findall(r"^\| `fo\.(\w+)` \| \S", PAGES["api.md"], re.MULTILINE)
    assert sorted(listed) == fo.__all__


@pytest.mark.parametrize("page", PAGES)
def test_names_in_the_documentation_exist(page):
    """Each `fo.a.b` of a page resolves, as far as it names modules and classes."""
    for dotted in re.findall(r"\bfo\.([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)", PAGES[page]):
        found = fo
        for part in dotted.split("."):
            assert hasattr(found, part), f"{page}: fo.{dotted}"
            found = getattr(found, part)
            if not (inspect.ismodule(found) or inspect.isclass(found)):
                break


def documented(name):
    """Return the docstring of a public name with those of a class's constructor and attributes."""
    found = getattr(fo, name)
    parts = [inspect.getdoc(found) or ""]
    if inspect.isclass(found):
        parts += [inspect.getdoc(found.__init__) or "", inspect.getsource(found)]
    return "\n".join(parts)


@pytest.mark.parametrize("name", fo.__all__)
def test_a_public_name_has_a_docstring(name):
    assert len(inspect.getdoc(getattr(fo, name)) or "") > 10


UNIT = r"\[(?:-|[^\]]*\b(?:m|s|rad|degrees|Hz|N|Pa|kg)\b[^\]]*)\]"
SHAPE = r"\((?:ny, nx|rows, columns|frames, ny, nx|[^()]*\bnx\b[^()]*)\)"
ARRAYS = re.compile(r"\b(?:Real|Complex|Integer|ArrayLike|NDArray|ndarray)\b")


def functions_with_arrays():
    """Return the public functions that take or return arrays."""
    return [
        name
        for name in fo.__all__
        if inspect.isfunction(getattr(fo, name))
        and any(ARRAYS.search(str(a)) for a in inspect.get_annotations(getattr(fo, name)).values())
    ]


def test_functions_with_arrays_are_found():
    assert {"normals", "jacobian", "minimum_eigenvalue"} <= set(functions_with_arrays())


@pytest.mark.parametrize("name", functions_with_arrays())
def test_functions_with_arrays_state_units_and_shapes(name):
    text = documented(name)
    assert re.search(SHAPE, text), f"{name}: no shape such as (ny, nx)"
    assert re.search(UNIT, text) or "unit" in text, f"{name}: no unit such as [m]"


CLASSES_WITH_ARRAYS = ["Answer", "Bake", "EulerianFrame", "Frame"]


@pytest.mark.parametrize("name", CLASSES_WITH_ARRAYS)
def test_classes_of_arrays_state_units_and_shapes(name):
    text = documented(name)
    assert re.search(SHAPE, text) or "shape" in text, f"{name}: no shape such as (ny, nx)"
    assert re.search(UNIT, text) or "SI" in text, f"{name}: no unit such as [m]"


def public_members(name):
    """Return the (name, docstring) of the public methods and properties of a class."""
    return [
        (member, inspect.getdoc(found))
        for member, found in vars(getattr(fo, name)).items()
        if not member.startswith("_")
        and (inspect.isfunction(found) or isinstance(found, (property, classmethod, staticmethod)))
    ]


@pytest.mark.parametrize("name", [n for n in fo.__all__ if inspect.isclass(getattr(fo, n))])
def test_public_methods_and_properties_have_docstrings(name):
    assert [member for member, doc in public_members(name) if not doc] == []


@pytest.mark.process
def test_importing_the_package_loads_no_heavy_library():
    """Public names are imported on first use."""
    heavy = {"numba", "pyfftw", "OpenEXR", "scipy", "numpy", "matplotlib", "xarray"}
    program = f"import sys, fftocean; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=600,
        check=True,
    )
    assert done.stdout == "[]\n"
