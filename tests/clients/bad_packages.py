"""A small package, packages with one fault each, and what a reader must say of them."""

import functools
import hashlib
import json
import math
import re
import struct

import fftocean as fo
from fftocean import runtime

SEA = fo.Sea.from_wind(speed=12.0, fetch=200e3, depth=30.0, direction=30.0)
TILES = [(32, 420.0), ((32, 16), (61.0, 40.0)), (16, 8.3)]
RECORD = "<hhHff"


@functools.cache
def files():
    """Return the files of a package by name; not to be changed."""
    cascade = fo.Cascade(SEA, TILES, loop=64.0, seed=3, choppiness=0.9)
    package = runtime.pack(cascade)
    return {"sea.json": sealed(package.document), **package.files}


def sealed(document):
    """Return the bytes of a document as they are written: the checksum is that of all the rest."""

    def text(tree):
        return (json.dumps(tree, indent=2, ensure_ascii=False) + "\n").encode()

    tree = {key: value for key, value in document.items() if key != "check"}
    return text({**tree, "check": hashlib.sha256(text(tree)).hexdigest()})


def document():
    """Return the document, to be changed."""
    return json.loads(files()["sea.json"])


def entry(*path_and_value):
    """Return the files with one entry of the document replaced, under its own checksum."""
    *path, last, value = path_and_value
    tree = inner = document()
    for key in path:
        inner = inner[key]
    inner[last] = value
    return {**files(), "sea.json": sealed(tree)}


def written(name, data):
    """Return the files with another one, and a document that lists it."""
    tree = document()
    row = next(row for row in tree["files"] if row["name"] == name)
    row["bytes"], row["sha256"] = len(data), hashlib.sha256(data).hexdigest()
    return {**files(), name: data, "sea.json": sealed(tree)}


def record(index, **changes):
    """Return the files with one record of the second tile changed, under a right checksum."""
    data = bytearray(files()["tile1.waves"])
    values = dict(
        zip(
            ("mx", "my", "cycles", "re", "im"),
            struct.unpack_from(RECORD, data, 14 * index),
            strict=True,
        )
    )
    struct.pack_into(RECORD, data, 14 * index, *{**values, **changes}.values())
    return written("tile1.waves", bytes(data))


def text(data):
    """Return the files with another sea.json."""
    return {**files(), "sea.json": data}


def twice():
    """Return the files with the first record of the second tile in the place of the next, too."""
    data = files()["tile1.waves"]
    return written("tile1.waves", data[:14] + data[:14] + data[28:])


def without(name):
    """Return all files but one."""
    return {key: data for key, data in files().items() if key != name}


def replaced(name, data):
    """Return the files with other bytes in one of them, which the document does not know."""
    return {**files(), name: data}


def flipped(name, place):
    """Return the files with one bit of one of them changed."""
    data = bytearray(files()[name])
    data[place] ^= 1
    return replaced(name, bytes(data))


def unlisted():
    """Return the files with a document that does not list the waves of the first tile."""
    tree = document()
    tree["files"] = tree["files"][1:]
    return {**files(), "sea.json": sealed(tree)}


def _exactly(words):
    return f"^{re.escape(words)}$"


_SIDES = "n of tile 0 in sea.json must be two powers of two from 2 to 1024"
_LISTED = r"^sea.json must list tile0\.waves with \d+ bytes and its SHA-256$"
_PLACE = "record 3 of tile1.waves must have |mx| < 16 and |my| < 8, not both 0"
_AMPLITUDE = "record 3 of tile1.waves must have a finite amplitude, not 0"

CASES = {
    # the document as a file
    "no document": (lambda: without("sea.json"), _exactly("sea.json does not exist")),
    "a long document": (
        lambda: text(files()["sea.json"] + b" " * 2**20),
        "^sea.json must have at most 1048576 bytes, got ",
    ),
    "deep lists": (
        lambda: text(b'{"a": ' + b"[" * 100_000),
        _exactly("sea.json must nest at most 32 deep"),
    ),
    "deep objects": (
        lambda: text(b'{"a":' * 100_000),
        _exactly("sea.json must nest at most 32 deep"),
    ),
    "deep and closed": (
        lambda: text(b"[" * 50_000 + b"]" * 50_000),
        _exactly("sea.json must nest at most 32 deep"),
    ),
    "an empty document": (lambda: text(b""), "sea.json must"),
    "a cut document": (
        lambda: text(files()["sea.json"][:2000]),
        _exactly("sea.json must be JSON"),
    ),
    "not a number": (lambda: text(b'{"loop": NaN}'), _exactly("sea.json must be JSON")),
    "a bare word": (lambda: text(b'{"loop": sea}'), _exactly("sea.json must be JSON")),
    "words after the end": (lambda: text(b"{} {}"), _exactly("sea.json must be JSON")),
    "a list": (lambda: text(b"[]"), "sea.json must be"),
    # its entries
    "another format": (
        lambda: entry("format", "other"),
        _exactly("format of sea.json must be fftocean-runtime, got other"),
    ),
    "another version": (lambda: entry("version", 2), "^version of sea.json must be 1, got 2"),
    "a version in words": (lambda: entry("version", "1"), "^version of sea.json must be 1, got "),
    "a changed document": (
        lambda: text(files()["sea.json"].replace(b'"loop": 64.0', b'"loop": 65.0')),
        _exactly("sea.json was changed after it was written"),
    ),
    "a document without its checksum": (
        lambda: text(json.dumps(document() | {"check": 0}, indent=2).encode()),
        _exactly("sea.json was changed after it was written"),
    ),
    "ticks": (
        lambda: entry("ticks", 1000),
        _exactly("ticks of sea.json must be a power of two from 2 to 1048576"),
    ),
    "a negative loop": (
        lambda: entry("loop", -1.0),
        _exactly("loop of sea.json must be a positive number"),
    ),
    "a loop in words": (
        lambda: entry("loop", "64"),
        _exactly("loop of sea.json must be a positive number"),
    ),
    "no choppiness": (
        lambda: entry("choppiness", None),
        _exactly("choppiness of sea.json must be a number"),
    ),
    "no depth": (
        lambda: entry("depth", 0.0),
        _exactly("depth of sea.json must be null or a positive number"),
    ),
    "no tiles": (
        lambda: entry("tiles", []),
        _exactly("tiles of sea.json must be a list of 1 to 16"),
    ),
    "too many tiles": (
        lambda: entry("tiles", document()["tiles"][:1] * 17),
        _exactly("tiles of sea.json must be a list of 1 to 16"),
    ),
    "files in words": (
        lambda: entry("files", "all"),
        _exactly("files of sea.json must be a list"),
    ),
    "a tile that is a number": (lambda: entry("tiles", 0, 7), _exactly(_SIDES)),
    "33 samples": (lambda: entry("tiles", 0, "n", [32, 33]), _exactly(_SIDES)),
    "very many samples": (lambda: entry("tiles", 0, "n", [32, 2**40]), _exactly(_SIDES)),
    "one side": (lambda: entry("tiles", 0, "n", [32]), _exactly(_SIDES)),
    "no size": (
        lambda: entry("tiles", 0, "size", [0.0, 1.0]),
        _exactly("size of tile 0 in sea.json must be two positive numbers"),
    ),
    "more waves than texels": (
        lambda: entry("tiles", 0, "waves", 1025),
        _exactly("waves of tile 0 in sea.json must fit its n and most_cycles"),
    ),
    "half a wave": (
        lambda: entry("tiles", 0, "waves", 0.5),
        _exactly("waves of tile 0 in sea.json must fit its n and most_cycles"),
    ),
    "very many cycles": (
        lambda: entry("tiles", 0, "most_cycles", 65536),
        _exactly("waves of tile 0 in sea.json must fit its n and most_cycles"),
    ),
    "waves that are not listed": (unlisted, _LISTED),
    "waves of another number": (lambda: entry("files", 0, "bytes", 15), _LISTED),
    "no checksum": (lambda: entry("files", 0, "sha256", None), _LISTED),
    # the files of waves
    "no waves": (lambda: without("tile1.waves"), _exactly("tile1.waves does not exist")),
    "a short file": (
        lambda: replaced("tile1.waves", files()["tile1.waves"][:-3]),
        r"^tile1\.waves must have \d+ bytes, got \d+$",
    ),
    "a long file": (
        lambda: replaced("tile1.waves", files()["tile1.waves"] + b"\0"),
        r"^tile1\.waves must have \d+ bytes, got (\d+|more)$",
    ),
    "a changed file": (
        lambda: flipped("tile1.waves", 100),
        _exactly("tile1.waves was changed after it was written"),
    ),
    # the waves
    "a wave on the Nyquist column": (lambda: record(3, mx=16), _exactly(_PLACE)),
    "a wave outside the grid": (lambda: record(3, mx=-30000), _exactly(_PLACE)),
    "a wave on the Nyquist row": (lambda: record(3, my=-8), _exactly(_PLACE)),
    "a wave without a direction": (lambda: record(3, mx=0, my=0), _exactly(_PLACE)),
    "a wave twice": (
        twice,
        _exactly("record 1 of tile1.waves must follow the one before in the plane"),
    ),
    "not a number in a wave": (lambda: record(3, re=math.nan), _exactly(_AMPLITUDE)),
    "an infinite wave": (lambda: record(3, im=-math.inf), _exactly(_AMPLITUDE)),
    "a wave of no height": (lambda: record(3, re=0.0, im=-0.0), _exactly(_AMPLITUDE)),
    "a wave that rests": (
        lambda: record(3, cycles=0),
        r"^record 3 of tile1\.waves must have 1 to \d+ cycles$",
    ),
    "a wave that is too fast": (
        lambda: record(3, cycles=65535),
        r"^record 3 of tile1\.waves must have 1 to \d+ cycles$",
    ),
}
"""By name: a function that gives the files, and the words of the refusal."""
