"""Files of the built page: the closed list, its sizes, and one script made of several."""

import json
import re
import shutil
import subprocess

import pytest

import fftocean as fo
from fftocean.errors import OutputError
from fftocean.runtime import pack
from fftocean.view import parameters, protocol
from fftocean.view.one_file import one_script
from fftocean.view.page_files import PARTS, TYPES, built_page, served_files
from fftocean.view.state import State
from fftocean.view.static_page import about_sea, make_exact

CORE = 60_000
"""Most bytes of minified script that a page needs to show the sea."""

WEB = built_page().parent / "web"


@pytest.fixture(scope="module")
def built():
    """Return the files of the built page by name."""
    folder = built_page()
    if not folder.joinpath("core.js").is_file():
        pytest.skip("the page is not built")
    return {file.name: file.read_text(encoding="utf-8") for file in folder.iterdir()}


def test_the_list_is_that_of_the_files(built):
    """The files are those that are served, and the two entries of pages that are one file."""
    assert set(built) == {*TYPES, "static.js", "widget.js"}


def test_each_file_has_the_type_of_its_ending(tmp_path):
    """Browsers run no script and apply no style of another type where sniffing is forbidden."""
    for name in TYPES:
        (tmp_path / name).write_text(name)
    served = served_files(tmp_path)
    types = {"html": "text/html", "js": "text/javascript", "css": "text/css"}
    assert set(served) == {"/", *(f"/{name}" for name in TYPES if name != "index.html")}
    for name in TYPES:
        file = served["/" if name == "index.html" else f"/{name}"]
        assert file.type == f"{types[name.rpartition('.')[2]]}; charset=utf-8"
        assert file.data == name.encode()


def test_what_shows_the_sea_is_small(built):
    """The served page's entry imports the core alone; both together keep the limit."""
    imported = {
        name: set(re.findall(r'from"\./(\w+\.js)"', text))
        for name, text in built.items()
        if name.endswith(".js")
    }
    assert imported["page.js"] == {"core.js"}
    assert imported["core.js"] == set()
    assert len(built["page.js"].encode()) + len(built["core.js"].encode()) <= CORE


def test_the_core_names_every_part(built):
    """Each part is asked for by name, so that the list of the server is all that is asked for."""
    assert set(re.findall(r'import\("\./(\w+\.js)"\)', built["core.js"])) == set(PARTS)
    for name in PARTS:
        assert "import(" not in built[name]


def test_no_name_of_a_message_is_made_short():
    """Properties that become short in the bundle are the page's own: no message has such a key."""
    if not WEB.joinpath("short_names.json").is_file():
        pytest.skip("the sources of the page are not here")
    short = set(json.loads(WEB.joinpath("short_names.json").read_text())["properties"])
    made = make_exact(State.default(n=16), 1, points=2)
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=5e4), n=16, size=60.0, loop=32.0)
    trees = [parameters.table(), made.document, about_sea(made), pack(ocean).document]
    trees.append(dict.fromkeys((*protocol.REFERENCE_FIELDS, *made.state.plain())))
    keys = set()
    while trees:
        tree = trees.pop()
        if isinstance(tree, dict):
            keys |= set(tree)
            trees += tree.values()
        elif isinstance(tree, (list, tuple)):
            trees += tree
    assert len(keys) > 80
    # the page asks for a parameter sun_elevation as sunElevation too
    names = [row["name"] for row in parameters.table()["parameters"]]
    keys |= {re.sub("_(.)", lambda found: found[1].upper(), name) for name in names}
    assert short & keys == set()


FILES = {
    "core.js": 'var a=2,b=(x)=>x*a,c=()=>import("./views.js");export{b as e0,c as e1};\n',
    "views.js": 'import{e0 as t}from"./core.js";var n=t(21);export{n as answer};\n',
    "static.js": 'import{e1 as u}from"./core.js";u().then(v=>console.log(v.answer));\n',
    "widget.js": 'import{e0 as t}from"./core.js";var r={render:()=>t(4)};export{r as default};\n',
    "worker.js": "postMessage('</script>');\n",
}


@pytest.fixture
def folder(tmp_path):
    """Write a page of three small modules."""
    for name in PARTS:
        (tmp_path / name).write_text("export{};\n")
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def ran(tmp_path, name, text):
    """Return what node prints when it runs a script."""
    if shutil.which("node") is None:
        pytest.skip("node is not installed")
    (tmp_path / name).write_text(text)
    return subprocess.run(
        ["node", str(tmp_path / name)], capture_output=True, text=True, check=True
    ).stdout


def test_modules_become_one_script(folder):
    """A part is run when it is wanted, with what it imports."""
    assert ran(folder, "one.cjs", one_script("static.js", folder=folder)) == "42\n"


def test_the_widget_stays_a_module(folder):
    script = one_script("widget.js", folder=folder)
    (folder / "made.mjs").write_text(script)
    text = "import made from './made.mjs'; console.log(made.render(), Object.keys(made));"
    assert ran(folder, "use.mjs", text) == "8 [ 'render' ]\n"


def test_a_module_of_another_form_is_refused(folder):
    (folder / "views.js").write_text('var n=1;import{e0 as t}from"./other/core.js";\n')
    with pytest.raises(OutputError, match=r"views\.js must import first and export last"):
        one_script("static.js", folder=folder)
