"""
Imports point down the floors of docs/architecture.md.

They are read from the source by syntax (tools/imports.py): a module need not be importable, nor
even finished, to be held to it.
"""

import ast
import re
from functools import cache
from pathlib import Path

import pytest
from imports import imports_in, modules_in, packages_in, reach

PACKAGE = Path(__file__).resolve().parents[1] / "fftocean"

FLOORS = {
    0: [
        *("constants", "errors", "host", "forks", "arrays", "limits", "files"),
        *("example_projects", "engine_projects", "notebook_html", "shader_files"),
    ],
    1: ["physics", "grid", "noise"],
    2: ["cells", "amplitudes", "readers", "fields", "fixed_values"],
    3: ["kernels", "wisdom", "transforms", "export"],
    4: [
        "computation",
        "phases",
        "bound_waves",
        "synthesis",
        "gpu",
        "frame",
        "lookahead",
        "ocean",
        "gerstner",
        "cell_lattice",
    ],
    5: ["cascade", "moving_amplitudes", "wave_list", "window", "points", "point_results"],
    6: [
        *("products", "foam_coverage", "foam", "slope_variance", "eulerian", "mips"),
        *("kinematics", "statistics", "blend_loss", "constraints", "mean_motion"),
        *("summed_waves", "interpolated_tiles", "wave_rings", "query", "query_budget"),
        *("polar_spectrum", "realised_spectrum", "measured_dispersion"),
        *("wave_files", "probe_series"),
    ],
    7: ["job", "proof"],
    8: ["baking", "runtime"],
    9: ["view", "plots", "science", "bench", "report"],
    10: ["cli", "__main__"],
}
FLOOR = {part: floor for floor, parts in FLOORS.items() for part in parts}

# The stairs within a floor, lowest step first. Elsewhere the parts of a floor do not import each
# other, and the modules of one part may.
STAIRS = [
    [
        ["constants", "errors"],
        [*("arrays", "host", "files"), *("example_projects", "engine_projects")],
        ["limits", "notebook_html"],
    ],
    [
        [
            *("physics", "physics.units", "physics.dispersion", "physics.moments"),
            *("physics.water", "physics.second_order"),
        ],
        ["physics.kinds"],
        ["physics.spreading"],
        ["physics.spectra"],
        ["physics.presets"],
        ["physics.sea"],
        ["physics.panels"],
        ["physics.plausibility"],
    ],
    [["cells", "fields"], ["fixed_values"], ["amplitudes"]],
    [["wisdom"], ["transforms"]],
    [["kernels"], ["export"]],
    [
        ["computation", "phases", "frame", "bound_waves"],
        ["synthesis", "lookahead"],
        ["gpu"],
        ["ocean"],
    ],
    [["cascade"], ["moving_amplitudes", "wave_list", "window"]],
    [["summed_waves", "interpolated_tiles", "query_budget"], ["query"]],
    [["products"], ["statistics", "polar_spectrum"]],
    [
        ["mean_motion", "summed_waves", "interpolated_tiles", "wave_rings", "query_budget"],
        ["kinematics", "query"],
        ["constraints"],
    ],
    [["products"], ["statistics", "polar_spectrum"]],
    [["foam_coverage"], ["foam"]],
    [["realised_spectrum"], ["measured_dispersion"]],
    [["baking"], ["runtime"]],
    [["plots.theme"], ["plots"], ["bench.charts", "report"]],
    [["cli"], ["__main__"]],
]
STEP = {
    module: (stair, step)
    for stair, steps in enumerate(STAIRS)
    for step, modules in enumerate(steps)
    for module in modules
}

# The floors within packages, lowest first; the parts of one floor do not know each other.
INNER = {
    "job": [
        ["parameters"],
        ["wave_systems", "fixed_tables"],
        ["job"],
        ["frame_rate", "job_text", "reference", "sources"],
    ],
    "baking": [
        ["folder"],
        ["scene"],
        ["finished", "previews", "workers"],
        ["survey"],
        ["bake"],
        ["cascade_setup", "estimate"],
        ["cascade"],
        ["dry_run", "repair"],
    ],
    "gpu": [
        ["device", "stages", "readback"],
        ["kernels", "device_frame"],
        ["synthesis"],
    ],
    "runtime": [
        ["layout", "shaders"],
        ["contents", "planes", "source", "engines", "textures", "project"],
        ["records"],
        ["describe", "reference"],
        ["document"],
        ["package", "readme"],
        ["container", "decode"],
        ["folder"],
        ["check"],
    ],
}

ONLY = {
    "kernels": {"arrays", "errors", "forks"},
    "export": {"arrays", "errors", "files", "kernels"},
}  # bare arrays in, bare arrays out
ONLY |= {"wisdom": {"errors", "host"}, "transforms": {"arrays", "errors", "forks", "wisdom"}}
NEVER = {
    "gerstner": {"fields", "transforms", "synthesis", "ocean", "kernels", "amplitudes"}
}  # a check must not share code with the checked
# Public methods of a low module whose work is done by a higher one: each is one import inside the
# method of that name.
UPWARD = {
    ("physics.sea", "from_spectrum"): "readers.realise",
    ("ocean", "to_spectrum"): "science",
    ("baking.finished.check", "check"): "runtime.check",
    ("baking.previews.previews", "_spectrum"): "plots",
}
PRINTERS = {"cli"}
# the package itself: its public names, which may import anything and which only the top floor may
# use
ROOF = ""


def part_of(module: str) -> str:
    return module.partition(".")[0]


def declared(module: str) -> str:
    """
    Return the name under which a module stands on the stairs: its own, or that of the package
    within its part, such as `physics.spectra` for `physics.spectra.jonswap`.
    """
    while module not in STEP and module.count(".") > 1:
        module = module.rpartition(".")[0]
    return module


def step_of(module: str, *, across: bool) -> tuple[int, int] | None:
    """
    Return the stair and the step of a module; across packages, that of its package if it has none.
    """
    return STEP.get(module) or (STEP.get(part_of(module)) if across else None)


def imports(module: str, source: str, known: set[str], is_package: bool = False) -> set[str]:
    """Return the modules of the package that a source imports, but for its declared upward ones."""
    return imports_in(module, source, known | FLOOR.keys(), is_package, UPWARD)


def objection(importer: str, imported: str) -> str | None:
    """Why one module may not import another, or None."""
    if importer == ROOF:
        return None
    if imported == ROOF:
        return (
            None
            if FLOOR[part_of(importer)] == max(FLOORS)
            else "the public names are for those outside"
        )
    a, b = part_of(importer), part_of(imported)
    importer, imported = declared(importer), declared(imported)
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
    if importer == imported:  # the modules of one package
        return None
    above, below = (step_of(module, across=a != b) for module in (importer, imported))
    if above and below and above[0] == below[0]:
        return None if below[1] < above[1] else "it is no step further down"
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
            part_of(module) not in FLOOR
            or (part_of(module) == "physics" and declared(module) not in STEP)
        ):
            found.append(f"{name} has no declared floor")
            continue
        for imported in sorted(imports(module, source, set(sources), module in packages)):
            if reason := objection(module, imported):
                found.append(f"{name} must not import {imported or 'the package'}: {reason}")
        calls = (node.func for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call))
        if part_of(module) not in PRINTERS and any(
            isinstance(called, ast.Name) and called.id == "print" for called in calls
        ):
            found.append(f"{name} must not print")
    return found


@cache
def sources() -> dict[str, str]:
    """Return the source of every module, read once."""
    return modules_in(PACKAGE)


@cache
def packages() -> set[str]:
    """Return the names that are folders."""
    return packages_in(PACKAGE)


@cache
def graph() -> dict[str, set[str]]:
    """Return the modules that each module imports."""
    return {
        module: imports(module, source, set(sources()), module in packages())
        for module, source in sources().items()
    }


# The package as it is


def test_imports_point_down_and_only_the_command_line_prints():
    assert objections(sources(), packages()) == []


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
    } <= sources().keys()
    assert {"", "physics"} <= packages()
    assert {
        "physics.spectra",
        "physics.spreading",
        "physics.moments",
        "limits",
        "errors",
        "arrays",
    } <= graph()["physics.sea"]
    assert graph()["constants"] == graph()["errors"] == set()
    assert len(reach(graph(), "physics.sea")) >= 7


def test_the_check_shares_no_code_with_the_checked_even_through_others():
    for checker, checked in NEVER.items():
        along = {
            part_of(imported)
            for module in sources()
            if part_of(module) == checker
            for imported in reach(graph(), module)
        }
        assert not along & checked


def test_upward_imports_hold_for_one_method_only():
    """
    Such an import stands inside its own method; anywhere else in that module it is a breach, and so
    is another module's import there.
    """
    known = {"physics.sea", "readers.realise", "readers.dataset_layout"}
    method = "class Sea:\n    def {}(cls):\n        from fftocean.{} import x\n"
    assert imports("physics.sea", method.format("from_spectrum", "readers.realise"), known) == set()
    assert imports("physics.sea", method.format("from_wind", "readers.realise"), known) == {
        "readers.realise"
    }
    assert imports(
        "physics.sea", method.format("from_spectrum", "readers.dataset_layout"), known
    ) == {"readers.dataset_layout"}
    assert imports("physics.sea", "from fftocean.readers.realise import x", known) == {
        "readers.realise"
    }


def test_no_module_waits_for_itself():
    """
    Within a part modules may import each other, but not in a ring: one of them would be imported
    half-made.
    """
    bare = {
        module: imported - packages()
        for module, imported in graph().items()
        if module not in packages()
    }
    assert [module for module in bare if module in reach(bare, module)] == []


def box(module: str, package: str) -> str | None:
    """Return the part of a package that a module belongs to: a folder, or the module itself."""
    inner = module.removeprefix(f"{package}.")
    return None if inner == module else inner.partition(".")[0]


def arrows(imported_by: dict[str, set[str]], package: str) -> set[tuple[str, str]]:
    """Return (importer, imported) of the parts of a package that import each other."""
    found = {
        (box(importer, package), box(module, package))
        for importer, modules in imported_by.items()
        for module in modules
    }
    return {(a, b) for a, b in found if a and b and a != b}


def upward(imported_by: dict[str, set[str]], package: str) -> list[tuple[str, str]]:
    """Return the arrows of a package that do not lead to a lower floor of `INNER`."""
    floor = {name: i for i, names in enumerate(INNER[package]) for name in names}
    return sorted((a, b) for a, b in arrows(imported_by, package) if not floor[b] < floor[a])


@pytest.mark.parametrize("package", INNER)
def test_imports_within_a_package_point_down(package):
    parts = {box(module, package) for module in sources()} - {None}
    assert parts == {name for names in INNER[package] for name in names}
    assert upward(graph(), package) == []


def test_an_upward_import_within_a_package_is_caught():
    forged = {**graph(), "baking.folder.layout": {"baking.scene.maps"}}
    assert upward(forged, "baking") == [("folder", "scene")]
    forged = {**graph(), "baking.workers.local": {"baking.finished.load"}}
    assert upward(forged, "baking") == [("workers", "finished")]


def test_names_on_the_stairs_belong_to_the_floor():
    for stair in STAIRS:
        modules = [module for steps in stair for module in steps]
        assert len({FLOOR[part_of(module)] for module in modules}) == 1
        assert len(set(modules)) == len(modules)


def test_the_page_shows_the_floors():
    """docs/architecture.md has the same modules on the same floors as the table above."""
    page = (PACKAGE.parent / "docs" / "architecture.md").read_text(encoding="utf-8")
    table = page.partition("<!-- floors -->")[2].partition("\n\n")[0]
    rows = re.findall(r"^\| (\d+) \| (.*?) \|", table, re.MULTILINE)
    assert {int(floor): re.findall(r"`(\w+)`", names) for floor, names in rows} == FLOORS


# The checker itself: forged sources that it must catch, and honest ones that it must not

KNOWN = {
    "physics",
    "physics.sea",
    "physics.spectra",
    "physics.spectra.jonswap",
    "physics.dispersion",
    "kernels",
    "kernels.passes",
    "kernels.compiler",
    "job.job",
}


def complaints(module: str, source: str) -> list[str]:
    """Return the objections to one forged module among the known ones."""
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
            "from fftocean.view.server import serve",
            "must not import view.server: floor 9 lies above floor 2",
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
            "physics.spreading.blend",
            "from fftocean.physics.spectra.jonswap import JONSWAP",
            "must not import physics.spectra.jonswap: it is no step further down",
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
            "must not import physics.sea: export sees arrays and errors and files and kernels only",
        ),
        (
            "export.exr",
            "from fftocean.transforms import library",
            "must not import transforms: export sees arrays and errors and files and kernels only",
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
            "import numpy as np\n"
            "from fftocean.arrays import Real\n"
            "from fftocean.physics import sea, dispersion",
        ),
        (
            "ocean",
            "from fftocean.kernels import passes\n"
            "from fftocean.physics.sea import Sea\n"
            "from .amplitudes import Amplitudes",
        ),
        (
            "physics.sea",
            "from . import spectra, dispersion\n"
            "from .spreading import Blend\n"
            "from ..limits import DEPTH",
        ),
        (
            "kernels.passes",
            "from fftocean.kernels.compiler import compiled\n"
            "from . import compiler\n"
            "from fftocean.arrays import Real",
        ),
        (
            "readers.swan",
            "from fftocean.readers import bounded_reads\n"
            "from fftocean.physics.sea import Sea\n"
            "from fftocean import limits",
        ),
        (
            "gerstner.direct",
            "from fftocean.physics import dispersion\n"
            "from fftocean.grid import Grid\n"
            "from fftocean import errors",
        ),
        (
            "job.job",
            "import fftocean\n"
            "from fftocean import __version__\n"
            "fftocean.__version__\n"
            "from fftocean.statistics import measure",
        ),
        (
            "cli",
            "import fftocean\nfrom fftocean import dispersion, Sea\nfftocean.bake()\nprint('done')",
        ),
        (
            "physics.spectra.tma",
            "from fftocean.physics.spectra.jonswap import JONSWAP\n"
            "from .jonswap import fetch_limited",
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
