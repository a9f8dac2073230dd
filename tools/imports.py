"""
Figures of the source tree, read by syntax: imports, rings, line lengths, first words of docstrings.

    python tools/imports.py            # a summary
    python tools/imports.py --arrows   # every import between packages, too

Nothing is imported to be read, so a tree that does not even compile elsewhere can be measured.
"""

import argparse
import ast
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1] / "fftocean"
PRAGMA = re.compile(r"\s*# (type: ignore|noqa|fmt: skip).*$")
QUESTION = re.compile(r"(What|Whether|Where|Who|Whoever|Whose|Which|How)\b")


def modules_in(folder: Path) -> dict[str, str]:
    """
    Return the source of every module by its name within a package: `physics.sea`.

    A package has its folder's name, the whole has "".
    """
    found = {}
    for path in sorted(folder.rglob("*.py")):
        if "node_modules" in path.parts:  # npm packages of the page's tools
            continue
        parts = path.relative_to(folder).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path.read_text(
            encoding="utf-8"
        )
    return found


def packages_in(folder: Path) -> set[str]:
    """Return the modules that are packages."""
    return {".".join(p.parent.relative_to(folder).parts) for p in folder.rglob("__init__.py")}


def imports_in(
    module: str,
    source: str,
    known: Collection[str],
    is_package: bool = False,
    upward: Mapping[tuple[str, str], str] | None = None,
    *,
    inside: bool = True,
) -> set[str]:
    """
    Return the modules of the package that a source imports.

    These are imports at its head or inside a function, for run time or for types, absolute or
    relative, or by name through importlib. `from fftocean.physics import sea` is an import of
    `physics.sea` where that is a module; the package itself is "".

    Args:
        module: name of the importer.
        source: its text.
        known: names of modules.
        is_package: whether the importer is a package's `__init__.py`.
        upward: imports to leave out, by (module, function).
        inside: whether imports within functions count.
    """
    tree = ast.parse(source)
    skipped = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and (module, node.name) in (upward or {}):
            imported_there = f"fftocean.{(upward or {})[module, node.name]}"
            skipped |= {
                line
                for line in node.body
                if isinstance(line, ast.ImportFrom) and line.module == imported_there
            }
    if not inside:
        functions = (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
        skipped |= {node for function in functions for node in ast.walk(function)}
    here = [part for part in module.split(".") if part]
    found = set()

    def add(dotted: str, names: list[str]) -> None:
        if dotted.partition(".")[0] != "fftocean":
            return
        target = dotted.partition(".")[2]
        for name in names:
            inner = f"{target}.{name}".lstrip(".")
            found.add(inner if inner in known else target)

    for node in ast.walk(tree):
        if node in skipped:
            continue
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name != "fftocean":
                    add(alias.name, [""])
                elif attributes_used(tree, alias.asname or "fftocean") - {"__version__"}:
                    found.add("")  # of the whole, a part may know the version alone
        elif isinstance(node, ast.ImportFrom):
            names = [alias.name for alias in node.names]
            if node.level:
                up = here if is_package else here[:-1]
                base = ["fftocean", *up[: len(up) - node.level + 1]]
                add(".".join([*base, *([node.module] if node.module else [])]), names)
            elif node.module != "fftocean" or names != ["__version__"]:
                add(node.module or "", names)
        elif isinstance(node, ast.Call):
            called = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if called in ("import_module", "__import__"):
                for argument in node.args:
                    if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
                        add(argument.value, [""])
    return {name.rstrip(".") for name in found}


def attributes_used(tree: ast.AST, package: str) -> set[str]:
    """
    Return the attributes of the package object that a source uses, as in `fftocean.__version__`.

    A package that is passed on whole counts as "*".
    """
    asked, whole = set(), 0
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and getattr(node.value, "id", None) == package:
            asked.add(node.attr)
            whole -= 1
        if isinstance(node, ast.Name) and node.id == package:
            whole += 1
    return asked | ({"*"} if whole else set())


def reach(graph: Mapping[str, set[str]], start: str) -> set[str]:
    """Return every module that is imported with one, directly or through others."""
    seen, todo = set(), [start]
    while todo:
        for imported in graph.get(todo.pop(), set()) - seen:
            seen.add(imported)
            todo.append(imported)
    return seen


def between_packages(
    graph: Mapping[str, set[str]], packages: Collection[str]
) -> dict[str, set[str]]:
    """
    Return the imports between packages, in which a module of the top folder counts as one.

    The package's public names ("") import everything by purpose and are left out.
    """
    outer: dict[str, set[str]] = {}

    def package(module: str) -> str:
        while module not in packages and "." in module:
            module = module.rpartition(".")[0]
        return module

    for module, imported in graph.items():
        if module:
            targets = {package(name) for name in imported if name}
            outer.setdefault(package(module), set()).update(targets - {package(module)})
    return outer


def graph_of_modules(
    graph: Mapping[str, set[str]], packages: Collection[str]
) -> dict[str, set[str]]:
    """Return the imports between modules, without packages, which import their parts by purpose."""
    return {name: found - set(packages) for name, found in graph.items() if name not in packages}


def rings(graph: Mapping[str, set[str]]) -> list[tuple[str, str]]:
    """
    Return the imports that lie on a ring.

    Whatever the order of the floors, one of each ring goes up.
    """
    beyond = {name: reach(graph, name) for name in graph}
    return sorted((a, b) for a in graph for b in graph[a] if a in beyond.get(b, ()))


def docstrings(source: str) -> Iterator[tuple[int, str]]:
    """Yield line number and text of every docstring."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            text = ast.get_docstring(node, clean=True)
            if text:
                yield node.body[0].lineno, text


def questions(source: str) -> list[tuple[int, str]]:
    """Return line and first line of every docstring that begins with a question word."""
    return [
        (line, text.splitlines()[0]) for line, text in docstrings(source) if QUESTION.match(text)
    ]


def widths(source: str) -> list[int]:
    """Return the length of every line without its pragma, as the linter counts it."""
    return [len(PRAGMA.sub("", line)) for line in source.splitlines()]


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument("--arrows", action="store_true", help="list the imports between packages")
    parser.add_argument("folder", nargs="?", type=Path, default=PACKAGE, help="of the package")
    options = parser.parse_args()
    sources, packages = modules_in(options.folder), packages_in(options.folder)
    graph = {
        module: imports_in(module, source, sources, module in packages)
        for module, source in sources.items()
    }
    outer = between_packages(graph, packages)
    at_import = {
        module: imports_in(module, source, sources, module in packages, inside=False)
        for module, source in sources.items()
    }
    upward = rings(between_packages(at_import, {name.partition(".")[0] for name in packages}))
    upward += [(a, b) for a, b in rings(graph_of_modules(at_import, packages)) if a]
    if options.arrows:
        for name, imported in sorted(outer.items()):
            print(f"{name:22} -> {', '.join(sorted(imported)) or '-'}")
        print()
    longest = max(
        (width, f"{module}:{i}")
        for module, source in sources.items()
        for i, width in enumerate(widths(source), 1)
    )
    asked = [(module, *found) for module, source in sources.items() for found in questions(source)]
    print(f"modules                          {len(sources)}")
    print(f"lines                            {sum(s.count(chr(10)) for s in sources.values())}")
    print(f"imports between modules          {sum(len(v - {''}) for v in graph.values())}")
    print(f"packages and top-level modules   {len(outer)}")
    print(f"imports between them             {sum(map(len, outer.values()))}")
    print(f"imports on a ring                {len(upward)}")
    for one, other in upward:
        print(f"    {one} -> {other}")
    print(f"longest line                     {longest[0]} ({longest[1]})")
    print(f"docstrings with a question word  {len(asked)}")
    for module, line, text in asked:
        print(f"    {module}:{line}: {text}")


if __name__ == "__main__":
    main()
