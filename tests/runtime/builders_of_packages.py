"""Builders of the tests of run-time packages: small seas, and packages with one thing changed."""

import copy
import functools
import hashlib
import json

import fftocean as fo
from fftocean import runtime

SEA = fo.Sea.from_wind(speed=12.0, fetch=200e3, depth=30.0, direction=30.0)
TILES = [(32, 420.0), ((32, 16), (61.0, 40.0)), (16, 8.3)]


@functools.cache
def cascade(dtype="float32"):
    """Return a small cascade that loops."""
    return fo.Cascade(SEA, TILES, loop=64.0, seed=3, choppiness=0.9, dtype=dtype)


@functools.cache
def packed():
    """Return the package of that cascade; not to be changed."""
    return runtime.pack(cascade(), textures=True)


def changed(path, value):
    """Return the package with one entry of its document replaced."""
    document = copy.deepcopy(packed().document)
    *keys, last = path
    inner = document
    for key in keys:
        inner = inner[key]
    inner[last] = value
    return runtime.SeaPackage(document, dict(packed().files))


def without(key):
    """Return the package without an entry of its document."""
    document = copy.deepcopy(packed().document)
    del document[key]
    return runtime.SeaPackage(document, dict(packed().files))


def with_file(name, data):
    """Return the package with another file, and a document that lists it."""
    package = changed(["version"], 1)
    package.files[name] = data
    row = next(row for row in package.document["files"] if row["name"] == name)
    row["bytes"], row["sha256"] = len(data), hashlib.sha256(data).hexdigest()
    return package


def seal(document):
    """Return the bytes of a document as it is written: its checksum is that of all the rest."""

    def text(tree):
        return (json.dumps(tree, indent=2, ensure_ascii=False) + "\n").encode()

    tree = {key: value for key, value in document.items() if key != "check"}
    return text({**tree, "check": hashlib.sha256(text(tree)).hexdigest()})


def put(package, folder):
    """Write a package into a folder as it is, with right checksums."""
    folder.mkdir(exist_ok=True)
    for name, data in package.files.items():
        (folder / name).write_bytes(data)
    (folder / "sea.json").write_bytes(seal(package.document))
    return folder


def tree(folder):
    """Return the contents of every file in a folder and below it, by path with slashes."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
