"""
Scripts of the page put together as one, for pages that can load nothing: a file, a notebook.

The bundler writes modules that import at their beginning, export at their end, and load parts by
name in between. Here each becomes a function that is run when it is first wanted.
"""

import json
import re
from importlib.resources.abc import Traversable
from typing import Final

from fftocean.errors import OutputError
from fftocean.view.page_files import PARTS, read_text

_IMPORTS: Final = re.compile(r'import\{([\w$ ,]*)\}from"\./(\w+)\.js";')
_EXPORTS: Final = re.compile(r"export\{([\w$ ,]*)\};\s*$")
_PART: Final = re.compile(r'import\("\./(\w+)\.js"\)')
_LEFT: Final = re.compile(r"(?:^|[;}])(?:im|ex)port\b")


def one_script(entry: str, *, folder: Traversable | None = None) -> str:
    """
    Return an entry of the page, with all that it may load, as one script.

    Args:
        entry: "static.js", which starts itself, or "widget.js", which is a module.
        folder: that of the built page; None for the package's.

    Raises:
        OutputError: the page is not built, or its files have another form.
    """
    names = ("core.js", *PARTS, entry)
    modules = ",".join(_function(name, read_text(name, folder)) for name in names)
    worker = json.dumps(read_text("worker.js", folder).strip())
    made = (
        f'"use strict";const WORKER_SOURCE={worker},modules_={{{modules}}},made_={{}},'
        "load_=name=>made_[name]??=modules_[name](),"
        "part_=async name=>load_(name);"
    )
    start = f"load_({json.dumps(_stem(entry))})"
    if entry == "widget.js":
        return f"{made}const widget_={start};export default widget_.default;"
    return f"(()=>{{{made}{start}}})();"


def _stem(name: str) -> str:
    """Return the name of a file without its ending."""
    return name.removesuffix(".js")


def _function(name: str, text: str) -> str:
    """Return a module as a function of the same name, which returns what the module exports."""
    imports = "".join(
        f"const{{{_renamed(names)}}}=load_({json.dumps(module)});"
        for names, module in _IMPORTS.findall(text)
    )
    body = _IMPORTS.sub("", text).strip()
    exports = _EXPORTS.search(body)
    body = _PART.sub(r'part_("\1")', body[: exports.start()] if exports else body)
    if _LEFT.search(body):
        raise OutputError(f"the page's {name} must import first and export last")
    returned = f"return{{{_exported(exports[1])}}}" if exports else ""
    return f"{_stem(name)}(){{{imports}{body}{returned}}}"


def _renamed(names: str) -> str:
    """Return the list of an import as a pattern: `a as b` as `a:b`."""
    return ",".join(":".join(name.split(" as ")) for name in names.split(",") if name.strip())


def _exported(names: str) -> str:
    """Return the list of an export as members: `a as b` as `b:a`."""
    pairs = (name.strip().split(" as ") for name in names.split(",") if name.strip())
    return ",".join(f"{pair[-1]}:{pair[0]}" for pair in pairs)
