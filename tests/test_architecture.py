"""
Imports point down only. The contract is DESIGN's list of rooms; it is read off the source itself,
by syntax, so that a module need not be importable, nor even finished, to be held to it.
"""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "fftocean"

FLOORS = {
    0: ["constants", "errors", "host", "forks", "arrays", "limits", "files"],
    1: ["physics", "grid", "noise"],
    2: ["cells", "amplitudes", "readers", "fields"],
    3: ["kernels", "wisdom", "transforms", "export"],
    4: ["synthesis", "frame", "ocean", "gerstner"],
    5: ["cascade", "trains", "window"],
    6: [
        *("products", "foam", "eulerian", "mips", "kinematics", "query", "statistics"),
        *("blend_loss", "polar_spectrum", "realised_spectrum", "measured_dispersion"),
    ],
    7: ["job", "proof"],
    8: ["baking"],
    9: ["viewer", "plots", "science", "bench"],
    10: ["cli", "__main__"],
}
FLOOR = {room: floor for floor, rooms in FLOORS.items() for room in rooms}

# The stairs within a floor, lowest step first. Elsewhere the rooms of a floor do not know each
# other, and the modules of one room may.
STAIRS = [
    [["constants", "errors"], ["arrays", "files"], ["limits"]],
    [
        ["physics", "physics.units", "physics.dispersion", "physics.moments", "physics.water"],
        ["physics.spectra", "physics.spreading", "physics.tabulated"],
        ["physics.double_peaked", "physics.spreading_laws"],
        ["physics.wind_wavenumber"],
        ["physics.presets"],
        ["physics.sea"],
        ["physics.panels"],
    ],
    [["cells"], ["amplitudes"]],
    [["wisdom"], ["transforms"]],
    [["synthesis", "frame"], ["ocean"]],
    [["cascade"], ["trains", "window"]],
    [["products"], ["statistics"]],
    [["realised_spectrum"], ["measured_dispersion"]],
    [["plots.theme"], ["plots"], ["bench.pictures"]],
    [["cli"], ["__main__"]],
]
STEP = {
    module: (stair, step)
    for stair, steps in enumerate(STAIRS)
    for step, modules in enumerate(steps)
    for module in modules
}

ONLY = {
    "kernels": {"arrays", "errors", "forks"},
    "export": {"arrays", "errors"},
}  # bare arrays in, bare arrays out
ONLY |= {"wisdom": {"errors", "host"}, "transforms": {"arrays", "errors", "forks", "wisdom"}}
NEVER = {
    "gerstner": {"fields", "transforms", "synthesis", "ocean", "kernels", "amplitudes"}
}  # a check must not share code with the checked
# Public names that DESIGN hangs on a low room, though a higher one does the work: each is one
# import inside the method of that name.
DOORS = {
    ("physics.sea", "from_spectrum"): "readers.realise",
    ("ocean", "to_spectrum"): "science",
    ("baking.previews.previews", "_spectrum"): "plots",
}
PRINTERS = {"cli"}
# the package itself: its public names, which may import anything and which only the top floor may
# use
ROOF = ""


def room(module: str) -> str:
    return module.partition(".")[0]


def modules_in(folder: Path) -> dict[str, str]:
    """
    Every module of the package by its name within it (`physics.sea`; a package by its folder's, the
    whole by ""), and its source.
    """
    found = {}
    for path in sorted(folder.rglob("*.py")):
        parts = path.relative_to(folder).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path.read_text(
            encoding="utf-8"
        )
    return found


def imports(module: str, source: str, known: set[str], is_package: bool = False) -> set[str]:
    """
    Which modules of the package a source imports: at its head or inside a function, for run time or
    for types, absolute or relative, or by name through importlib. `from fftocean.physics import
    sea` is an import of `physics.sea` where that is a module.
    """
    tree = ast.parse(source)
    for function in [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and (module, node.name) in DOORS
    ]:
        door = f"fftocean.{DOORS[module, function.name]}"
        function.body = [
            node
            for node in function.body
            if not (isinstance(node, ast.ImportFrom) and node.module == door)
        ]
    here = [part for part in module.split(".") if part]
    found = set()

    def add(dotted: str, names: list[str]) -> None:
        if dotted.partition(".")[0] != "fftocean":
            return
        target = dotted.partition(".")[2]
        for name in names:
            inner = f"{target}.{name}".lstrip(".")
            found.add(inner if inner in known or inner in FLOOR else target)

    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name != "fftocean":
                    add(alias.name, [""])
                elif any(
                    name != "__version__"
                    for name in attributes_used(tree, alias.asname or "fftocean")
                ):
                    found.add(
                        ROOF
                    )  # the version is the one thing that the whole package may tell its parts
        elif isinstance(node, ast.ImportFrom):
            names = [alias.name for alias in node.names]
            if node.level:
                up = here if is_package else here[:-1]
                base = [
                    "fftocean",
                    *up[: len(up) - node.level + 1],
                    *([node.module] if node.module else []),
                ]
                add(".".join(base), names)
            elif node.module == "fftocean" and names == ["__version__"]:
                continue
            else:
                add(node.module or "", names)
        elif isinstance(node, ast.Call) and getattr(
            node.func, "attr", getattr(node.func, "id", "")
        ) in ("import_module", "__import__"):
            for argument in node.args:
                if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
                    add(argument.value, [""])
    return {name.rstrip(".") for name in found}


def attributes_used(tree: ast.AST, package: str) -> set[str]:
    """
    What is asked of the package object itself, as in `fftocean.__version__`; passing it on whole
    counts as everything.
    """
    asked, whole = set(), 0
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Name)
            and node.value.id == package
        ):
            asked.add(node.attr)
            whole -= 1
        if isinstance(node, ast.Name) and node.id == package:
            whole += 1
    return asked | ({"*"} if whole else set())


def objection(importer: str, imported: str) -> str | None:
    """Why one module may not import another, or None."""
    if importer == ROOF:
        return None
    if imported == ROOF:
        return (
            None
            if FLOOR[room(importer)] == max(FLOORS)
            else "the public names are for those outside"
        )
    a, b = room(importer), room(imported)
    if b not in FLOOR or (b == "physics" and imported not in STEP):
        return "no floor is declared for it"
    if a == b and a in ONLY:
        return None
    if a in ONLY and b not in ONLY[a]:
        return f"{a} sees {' and '.join(sorted(ONLY[a]))} only"
    if b in NEVER.get(a, ()):
        return "a check must not share code with the checked"
    if FLOOR[b] < FLOOR[a]:
        return None
    if FLOOR[b] > FLOOR[a]:
        return f"floor {FLOOR[b]} lies above floor {FLOOR[a]}"
    if importer in STEP and imported in STEP and STEP[importer][0] == STEP[imported][0]:
        return None if STEP[imported][1] < STEP[importer][1] else "it is no step further down"
    return None if a == b else f"both are on floor {FLOOR[a]}"


def objections(sources: dict[str, str], packages: set[str]) -> list[str]:
    """
    Every breach in a set of sources: an undeclared floor, an import that does not point down, a
    print() below the top floor.
    """
    found = []
    for module, source in sources.items():
        name = module or "the package"
        if module != ROOF and (
            room(module) not in FLOOR or (room(module) == "physics" and module not in STEP)
        ):
            found.append(f"{name} has no declared floor")
            continue
        for imported in sorted(imports(module, source, set(sources), module in packages)):
            if reason := objection(module, imported):
                found.append(f"{name} must not import {imported or 'the package'}: {reason}")
        calls = (node.func for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call))
        if room(module) not in PRINTERS and any(
            isinstance(called, ast.Name) and called.id == "print" for called in calls
        ):
            found.append(f"{name} must not print")
    return found


def reach(graph: dict[str, set[str]], start: str) -> set[str]:
    """Every module that comes along when one is imported."""
    seen, todo = set(), [start]
    while todo:
        for imported in graph.get(todo.pop(), set()) - seen:
            seen.add(imported)
            todo.append(imported)
    return seen


SOURCES = modules_in(PACKAGE)
PACKAGES = {
    module for module in SOURCES if (PACKAGE.joinpath(*module.split(".")) / "__init__.py").exists()
}
GRAPH = {
    module: imports(module, source, set(SOURCES), module in PACKAGES)
    for module, source in SOURCES.items()
}

# The package as it is


def test_imports_point_down_and_only_the_command_line_prints():
    assert objections(SOURCES, PACKAGES) == []


def test_the_tree_was_really_read():
    """Nothing is proved by an empty folder, nor by a reader that sees no imports."""
    assert {
        "",
        "constants",
        "errors",
        "arrays",
        "limits",
        "physics",
        "physics.sea",
        "grid",
        "amplitudes",
    } <= SOURCES.keys()
    assert {"", "physics"} <= PACKAGES
    assert {
        "physics.spectra",
        "physics.spreading",
        "physics.moments",
        "limits",
        "errors",
        "arrays",
    } <= GRAPH["physics.sea"]
    assert GRAPH["constants"] == GRAPH["errors"] == set()
    assert len(reach(GRAPH, "physics.sea")) >= 7


def test_the_check_shares_no_code_with_the_checked_even_through_others():
    for checker, checked in NEVER.items():
        along = {
            room(imported)
            for module in SOURCES
            if room(module) == checker
            for imported in reach(GRAPH, module)
        }
        assert not along & checked


def test_doors_open_upward_for_one_name_only():
    """
    A door is an import inside its own method; anywhere else in that room it is a breach, and so is
    another room's import there.
    """
    known = {"physics.sea", "readers.realise", "readers.layout"}
    method = "class Sea:\n    def {}(cls):\n        from fftocean.{} import x\n"
    assert imports("physics.sea", method.format("from_spectrum", "readers.realise"), known) == set()
    assert imports("physics.sea", method.format("from_wind", "readers.realise"), known) == {
        "readers.realise"
    }
    assert imports("physics.sea", method.format("from_spectrum", "readers.layout"), known) == {
        "readers.layout"
    }
    assert imports("physics.sea", "from fftocean.readers.realise import x", known) == {
        "readers.realise"
    }


def test_no_module_waits_for_itself():
    """
    Within a room modules may know each other, but not in a ring: one of them would be imported
    half-made.
    """
    bare = {
        module: imported - PACKAGES for module, imported in GRAPH.items() if module not in PACKAGES
    }
    assert [module for module in bare if module in reach(bare, module)] == []


def test_names_on_the_stairs_belong_to_the_floor():
    for stair in STAIRS:
        modules = [module for steps in stair for module in steps]
        assert len({FLOOR[room(module)] for module in modules}) == 1
        assert len(set(modules)) == len(modules)


# The checker itself: forged sources that it must catch, and honest ones that it must not

KNOWN = {
    "physics",
    "physics.sea",
    "physics.spectra",
    "physics.dispersion",
    "kernels",
    "kernels.passes",
    "kernels.compiler",
    "job.job",
}


def complaints(module: str, source: str) -> list[str]:
    """What is said of one forged module among the known ones."""
    return objections({**dict.fromkeys(KNOWN, ""), module: source}, {"physics", "kernels"})


@pytest.mark.parametrize(
    ("module", "source", "says"),
    [
        (
            "fields",
            "from fftocean.ocean import Ocean",
            "must not import ocean: floor 4 lies above floor 2",
        ),
        (
            "fields",
            "from fftocean import ocean",
            "must not import ocean: floor 4 lies above floor 2",
        ),
        ("fields", "import fftocean.ocean", "must not import ocean: floor 4 lies above floor 2"),
        (
            "fields",
            "import math, fftocean.ocean as o",
            "must not import ocean: floor 4 lies above floor 2",
        ),
        ("fields", "from .ocean import Ocean", "must not import ocean: floor 4 lies above floor 2"),
        ("fields", "from . import ocean as o", "must not import ocean: floor 4 lies above floor 2"),
        (
            "physics.sea",
            "from ..ocean import Ocean",
            "must not import ocean: floor 4 lies above floor 1",
        ),
        (
            "physics.sea",
            "from .. import ocean",
            "must not import ocean: floor 4 lies above floor 1",
        ),
        (
            "fields",
            "def f():\n    from fftocean.ocean import Ocean",
            "must not import ocean: floor 4 lies above floor 2",
        ),
        (
            "fields",
            "if TYPE_CHECKING:\n    from fftocean.ocean import Ocean",
            "must not import ocean: floor 4 lies above floor 2",
        ),
        (
            "fields",
            "import importlib\nimportlib.import_module('fftocean.ocean')",
            "must not import ocean: floor 4 lies above floor 2",
        ),
        (
            "fields",
            "__import__('fftocean.ocean')",
            "must not import ocean: floor 4 lies above floor 2",
        ),
        (
            "ocean",
            "from fftocean.job.job import Job",
            "must not import job.job: floor 7 lies above floor 4",
        ),
        (
            "ocean",
            "from fftocean.job import Job",
            "must not import job: floor 7 lies above floor 4",
        ),
        (
            "job.job",
            "from fftocean.cli import main",
            "must not import cli: floor 10 lies above floor 7",
        ),
        (
            "cascade",
            "from fftocean.query import Query",
            "must not import query: floor 6 lies above floor 5",
        ),
        (
            "readers.swan",
            "from fftocean.viewer.server import serve",
            "must not import viewer.server: floor 9 lies above floor 2",
        ),
        (
            "readers.swan",
            "from fftocean.amplitudes import Amplitudes",
            "must not import amplitudes: both are on floor 2",
        ),
        (
            "grid",
            "from fftocean.physics.dispersion import wavenumber",
            "must not import physics.dispersion: both are on floor 1",
        ),
        (
            "physics.sea",
            "from fftocean.grid import Grid",
            "must not import grid: both are on floor 1",
        ),
        (
            "physics.spectra",
            "from fftocean.physics.sea import Sea",
            "must not import physics.sea: it is no step further down",
        ),
        (
            "physics.spectra",
            "from fftocean.physics import sea",
            "must not import physics.sea: it is no step further down",
        ),
        (
            "physics.spectra",
            "from . import sea",
            "must not import physics.sea: it is no step further down",
        ),
        (
            "physics.moments",
            "from fftocean.physics import dispersion",
            "must not import physics.dispersion: it is no step further down",
        ),
        (
            "errors",
            "from fftocean.limits import Quantity",
            "must not import limits: it is no step further down",
        ),
        (
            "limits",
            "from fftocean.physics.dispersion import wavenumber",
            "must not import physics.dispersion: floor 1 lies above floor 0",
        ),
        (
            "kernels.passes",
            "from fftocean.constants import GRAVITY",
            "must not import constants: kernels sees arrays and errors and forks only",
        ),
        (
            "transforms",
            "from fftocean.limits import SAMPLES",
            "must not import limits: transforms sees arrays and errors and forks and wisdom only",
        ),
        (
            "export.exr",
            "from fftocean.physics.sea import Sea",
            "must not import physics.sea: export sees arrays and errors only",
        ),
        (
            "export.exr",
            "from fftocean.kernels import passes",
            "must not import kernels.passes: export sees arrays and errors only",
        ),
        (
            "gerstner.direct",
            "from fftocean.kernels import passes",
            "must not import kernels.passes: a check must not share code",
        ),
        (
            "gerstner.direct",
            "from fftocean.fields import FIELDS",
            "must not import fields: a check must not share code",
        ),
        (
            "gerstner.direct",
            "from fftocean.transforms import inverse_transform",
            "must not import transforms: a check must not share code",
        ),
        (
            "gerstner.direct",
            "from fftocean.ocean import Ocean",
            "must not import ocean: a check must not share code",
        ),
        (
            "gerstner.direct",
            "from ..amplitudes import Amplitudes",
            "must not import amplitudes: a check must not share code",
        ),
        (
            "ocean",
            "from fftocean.mystery import x",
            "must not import mystery: no floor is declared for it",
        ),
        (
            "ocean",
            "from fftocean.physics.mystery import x",
            "must not import physics.mystery: no floor is declared for it",
        ),
        (
            "ocean",
            "from fftocean import Sea",
            "must not import the package: the public names are for those outside",
        ),
        (
            "ocean",
            "from fftocean import *",
            "must not import the package: the public names are for those outside",
        ),
        (
            "ocean",
            "import fftocean\nfftocean.Sea()",
            "must not import the package: the public names are for those outside",
        ),
        (
            "ocean",
            "import fftocean as fo\nf(fo)",
            "must not import the package: the public names are for those outside",
        ),
        ("mystery", "", "has no declared floor"),
        ("physics.mystery", "", "has no declared floor"),
        ("ocean", "def f():\n    print('hello')", "must not print"),
        ("job.job", "print()", "must not print"),
    ],
)
def test_a_forged_breach_is_caught(module, source, says):
    (said,) = complaints(module, source)
    assert said.startswith(f"{module} {says}")


@pytest.mark.parametrize(
    ("module", "source"),
    [
        (
            "fields",
            "import numpy as np\nfrom fftocean.arrays import Real\nfrom fftocean.physics import sea, dispersion",
        ),
        (
            "ocean",
            "from fftocean.kernels import passes\nfrom fftocean.physics.sea import Sea\nfrom .amplitudes import Amplitudes",
        ),
        (
            "physics.sea",
            "from . import spectra, dispersion\nfrom .spreading import Blend\nfrom ..limits import DEPTH",
        ),
        (
            "kernels.passes",
            "from fftocean.kernels.compiler import compiled\nfrom . import compiler\nfrom fftocean.arrays import Real",
        ),
        (
            "readers.swan",
            "from fftocean.readers import files, layout\nfrom fftocean.physics.sea import Sea\nfrom fftocean import limits",
        ),
        (
            "gerstner.direct",
            "from fftocean.physics import dispersion\nfrom fftocean.grid import Grid\nfrom fftocean import errors",
        ),
        (
            "job.job",
            "import fftocean\nfrom fftocean import __version__\nfftocean.__version__\nfrom fftocean.statistics import measure",
        ),
        (
            "cli",
            "import fftocean\nfrom fftocean import dispersion, Sea\nfftocean.bake()\nprint('done')",
        ),
        ("__main__", "from fftocean.cli import main"),
        ("limits", "from fftocean.errors import ParameterError"),
        ("ocean", "import fftoceanography\nfrom ast import print_tree\nsomething.print()"),
        ("", "from fftocean.cli import main\nfrom fftocean.physics.sea import Sea"),
    ],
)
def test_an_honest_import_is_not(module, source):
    assert complaints(module, source) == []


def test_relative_imports_count_from_the_package_they_stand_in():
    """
    One dot in `physics/__init__.py` is `physics`; in `physics/sea.py` it is the same; in
    `fields.py` the whole package.
    """
    assert imports("physics", "from .sea import Sea", KNOWN, is_package=True) == {"physics.sea"}
    assert imports("physics.sea", "from .spectra import TMA", KNOWN) == {"physics.spectra"}
    assert imports("kernels", "from .. import arrays", KNOWN, is_package=True) == {"arrays"}
    assert imports("", "from . import arrays, Sea", KNOWN, is_package=True) == {"arrays", ""}


def test_a_roundabout_way_is_followed():
    graph = {"a": {"b"}, "b": {"c"}, "c": {"a", "d"}, "d": set()}
    assert reach(graph, "a") == {"a", "b", "c", "d"}
    assert reach(graph, "d") == set()
