"""Packages that are read back: the same frames, and refusals of what no package holds."""

import contextlib
import struct

import builders_of_packages as build
import numpy as np
import pytest

import fftocean as fo
from fftocean import noise, runtime
from fftocean.errors import IntegrityError
from fftocean.fields import EIGHT
from fftocean.runtime.contents import Contents

TICKS = 2**20


def relative(found, expected):
    """Return the relative L2 error of a field."""
    return np.linalg.norm(found.astype(float) - expected) / np.linalg.norm(expected.astype(float))


def no_random_numbers(monkeypatch):
    def refuse(*_):
        raise AssertionError("a random number was made")

    for name in ("complex_normals", "unit_phasors", "philox"):
        monkeypatch.setattr(noise, name, refuse)


def test_a_package_gives_the_frames_of_its_cascade(tmp_path, monkeypatch):
    """
    To 2e-7 in float32 of both, of which the rounding of h0 is 3e-8 and that of each frame 1e-7; no
    wave is made from the seed.
    """
    cascade = build.cascade()
    fo.export_sea(cascade, tmp_path)
    no_random_numbers(monkeypatch)
    loaded = fo.load_sea(tmp_path)
    assert isinstance(loaded, fo.Cascade)
    assert (loaded.choppiness, loaded.depth, loaded.loop) == (0.9, 30.0, 64.0)
    assert loaded.bands == cascade.bands
    for tick in (0, 1, 123456, TICKS - 1):
        frames = cascade.loop_frame(tick, TICKS), loaded.loop_frame(tick, TICKS)
        for expected, found in zip(*frames, strict=True):
            for name in EIGHT:
                assert relative(found[name], expected[name]) <= 2e-7, (tick, name)


def test_in_float64_only_the_amplitudes_are_rounded(tmp_path):
    """Each part of h0 by up to 2^-25, relative to the larger: in the mean square 3e-8."""
    fo.export_sea(build.cascade("float64"), tmp_path)
    loaded = fo.load_sea(tmp_path, dtype="float64")
    frames = build.cascade("float64").loop_frame(77, TICKS), loaded.loop_frame(77, TICKS)
    errors = [
        relative(found[name], expected[name])
        for expected, found in zip(*frames, strict=True)
        for name in EIGHT
    ]
    assert 1e-9 < max(errors) < 6e-8


def test_a_loaded_package_is_packed_to_the_same_bytes():
    """A package of a loaded sea has the same bytes: nothing is lost again."""
    first = build.packed()
    again = runtime.pack(runtime.ocean_of(first), textures=True)
    waves = [name for name in first.files if name.endswith((".waves", ".bin"))]
    assert len(waves) == 10
    assert all(again.files[name] == first.files[name] for name in waves)
    assert again.document["tiles"] == first.document["tiles"]


def test_one_tile_is_an_ocean():
    ocean = fo.Ocean.from_modes(
        [(2, -1, 0.5, 0.3), (-2, 1, 0.2, 1.0), (0, 3, 0.1, 0.0), (0, -3, 0.3, 2.0)],
        n=16,
        size=(50.0, 40.0),
        loop=20.0,
        dtype="float64",
    )
    loaded = runtime.ocean_of(runtime.pack(ocean), dtype="float64")
    assert isinstance(loaded, fo.Ocean)
    for name in EIGHT:
        error = relative(loaded.loop_frame(3, 16)[name], ocean.loop_frame(3, 16)[name])
        assert error < 6e-8


def test_a_flat_sea_is_a_package_without_waves():
    ocean = fo.Ocean.from_modes([], n=8, size=50.0, loop=20.0)
    package = runtime.pack(ocean, textures=True)
    assert package.document["tiles"][0]["waves"] == 0
    assert package.document["spectrum"] is None
    loaded = runtime.ocean_of(runtime.from_bytes(runtime.to_bytes(package)))
    assert not np.any(loaded.frame(1.0).height)


def test_a_loaded_sea_is_used_as_any_other():
    loaded = runtime.ocean_of(build.packed())
    expected = fo.Query(build.cascade(), mode="exact").at(3.0, 4.0, 5.0)
    found = fo.Query(loaded, mode="exact").at(3.0, 4.0, 5.0)
    assert found.heights == pytest.approx(expected.heights, abs=1e-6)
    assert fo.measure(loaded).hs == pytest.approx(fo.measure(build.cascade()).hs, rel=1e-6)
    assert fo.Window(loaded, n=8, size=20.0).frame(1.0, ("normal",)).normal.shape == (8, 8, 3)
    assert next(fo.Foam().loop(loaded, 4)).shape == (32, 32)


def test_cycles_are_those_of_the_package():
    """A machine that rounds the fastest wave down keeps the stored cycle all the same."""
    package = build.packed()
    data = bytearray(package.files["tile2.waves"])
    most = package.document["tiles"][2]["most_cycles"]
    records = list(struct.iter_unpack("<hhHff", data))
    rarest = min({r[2] for r in records}, key=lambda c: sum(r[2] == c for r in records))
    assert rarest != most
    for i, (mx, my, cycles, re, im) in enumerate(records):
        if cycles == rarest:
            struct.pack_into("<hhHff", data, 14 * i, mx, my, cycles - 1, re, im)
    loaded = runtime.ocean_of(build.with_file("tile2.waves", bytes(data)))
    a, b = loaded.oceans[2].amplitudes, build.cascade().oceans[2].amplitudes
    changed = a.cycles != b.cycles
    assert np.array_equal(a.cycles[changed], b.cycles[changed] - 1)
    assert np.any(changed)
    assert np.all(b.cycles[changed] == rarest)


# Refusals of the exporter


@pytest.mark.parametrize(("n", "larger"), [(3, 4), (100, 128), (1000, 1024), (1, 2)])
def test_samples_that_are_no_power_of_two_are_refused_with_the_next_one(n, larger):
    ocean = fo.Ocean.from_modes([], n=(n, 8), size=50.0, loop=20.0)
    with pytest.raises(
        fo.ParameterError, match=f"power of two .* got {n}; the next one is {larger}"
    ):
        runtime.pack(ocean)


def test_the_largest_tile_is_1024():
    ocean = fo.Ocean.from_modes([], n=(2, 2048), size=50.0, loop=20.0)
    with pytest.raises(fo.ParameterError, match="got 2048; the largest is 1024"):
        runtime.pack(ocean)


def test_what_has_no_linear_waves_is_refused_by_name():
    ocean = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=50.0, loop=20.0)

    class SecondOrder(fo.Ocean):
        pass

    second = SecondOrder.from_modes([], n=8, size=50.0, loop=20.0)
    for source, words in (
        (fo.Eulerian(ocean), "an Eulerian, whose fields over places are not linear; give its"),
        (fo.Window(ocean), "a Window, which .* give its source"),
        (fo.Query(ocean), "a Query; give"),
        (build.SEA, "a Sea, which has no waves yet"),
        (fo.Job.default(), r"a Job; give job.ocean\(\)"),
        (fo.gerstner.pms, "module"),
        ("sea", "'sea'"),
        (second, "SecondOrder"),
    ):
        with pytest.raises(fo.ParameterError, match=words):
            runtime.pack(source)


def test_water_that_never_repeats_is_refused():
    ocean = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=50.0)
    with pytest.raises(fo.ParameterError, match=r"must repeat .* such as loop=\d+(\.\d+)?, whose"):
        runtime.pack(ocean)
    with pytest.raises(fo.ParameterError, match="must repeat"):
        runtime.amplitude_planes(ocean)
    with pytest.warns(fo.SeaWarning):
        cascade = fo.Cascade(build.SEA, build.TILES[:2], loop=[64.0, 8.0])
    with pytest.raises(fo.ParameterError, match="one loop in common"):
        runtime.pack(cascade)


def waves_of_period(cycles):
    """Return an ocean whose one wave makes about this many cycles in the loop."""
    loop = min(1e5, 100.0 * cycles)
    omega = 2.0 * np.pi * cycles / loop
    return fo.Ocean.from_modes(
        [(1, 0, 0.1, 0.0)], n=8, size=2.0 * np.pi * 9.80665 / omega**2, loop=loop
    )


def test_ticks_are_the_most_that_keep_phases_exact():
    """The largest power of two up to 2^20 for which cycles times ticks stay below 2^32."""
    for cycles, ticks in ((1, 2**20), (4095, 2**20), (4096, 2**19), (65535, 2**16)):
        package = runtime.pack(waves_of_period(cycles))
        assert package.document["tiles"][0]["most_cycles"] == cycles
        assert package.document["ticks"] == ticks
    with pytest.raises(fo.ParameterError, match="at most 65535 cycles in a loop, got 65536"):
        runtime.pack(waves_of_period(65536))


def test_ticks_that_were_asked_for_are_checked():
    assert runtime.pack(waves_of_period(4096), ticks=1024).document["ticks"] == 1024
    with pytest.raises(
        fo.ParameterError,
        match=r"below 2\^32 for exact phases, got 4096 cycles .* 1048576 ticks; at most 524288",
    ):
        runtime.pack(waves_of_period(4096), ticks=2**20)
    for wrong in (0, 1, 1000, 2**21, 16.0, True, "16"):
        with pytest.raises(fo.ParameterError, match="ticks must be a power of two between 2 and"):
            runtime.pack(waves_of_period(4096), ticks=wrong)


def test_waves_on_the_nyquist_column_are_refused():
    """Two real fields in one complex transform cannot be separated there."""
    from dataclasses import replace

    ocean = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=50.0, loop=20.0)
    for place in ((0, 4), (4, 1), (0, 0)):
        forward = ocean.amplitudes.forward.copy()
        forward[place] = 0.1
        waves = replace(ocean.amplitudes, forward=forward)
        source = runtime.Source(tiles=(waves,), choppiness=1.0)
        with pytest.raises(fo.ParameterError, match="the Nyquist row and column must have no"):
            runtime.pack(source)


# Refusals of the reader


def refused(package, words):
    """Check that a package is refused, both as it is and as a container."""
    with pytest.raises(IntegrityError, match=words):
        runtime.ocean_of(package)
    with pytest.raises(IntegrityError):
        runtime.ocean_of(runtime.from_bytes(runtime.to_bytes(package)))


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        (["format"], "other", "format must be 'fftocean-runtime', got 'other'"),
        (["version"], 2, "version must be 1, got 2"),
        (["version"], True, "version must be 1, got True"),
        (["loop"], -1.0, "loop must be"),
        (["loop"], "64", "loop must be a number"),
        (["loop"], 10**400, "loop must be"),
        (["ticks"], 1000, "ticks must be a power of two"),
        (["ticks"], 2**30, "ticks must be a power of two"),
        (["choppiness"], 1e9, "choppiness must be"),
        (["depth"], 0.0, "depth must be"),
        (["surface_tension"], None, "surface_tension must be"),
        (["tiles"], [], "tiles must be a list of 1 to 16 items, got 0"),
        (["tiles"], {}, "tiles must be a list of 1 to 16 items"),
        (["tiles", 1], 7, r"tiles\[1\] must be an object, got 7"),
        (["tiles", 0, "n"], [32, 2**40], r"tiles\[0\].n\[1\] must be a whole number between 2"),
        (["tiles", 0, "n"], [32, 33], r"n of tiles\[0\].n must be a power of two"),
        (["tiles", 0, "n"], [32.0, 32], r"tiles\[0\].n\[0\] must be a whole number"),
        (["tiles", 0, "n"], [32], r"tiles\[0\].n must be a list of 2 to 2 items"),
        (["tiles", 0, "size"], [0.0, 1.0], r"tiles\[0\].size\[0\] must be"),
        (["tiles", 0, "band"], [1.0, 0.5], r"tiles\[0\].band must rise"),
        (["tiles", 0, "band"], [0.5, 0.5], r"tiles\[0\].band must rise"),
        (["tiles", 0, "seed"], -1, r"tiles\[0\].seed must be"),
        (["tiles", 0, "waves"], 1e3, r"tiles\[0\].waves must be a whole number"),
        (["tiles", 0, "waves"], 5, "tile0.waves must have 70 bytes for 5 waves"),
        (["tiles", 0, "waves"], 2**19, r"tiles\[0\].waves must fit the tile"),
        (["tiles", 0, "most_cycles"], 0, r"tiles\[0\].waves must fit"),
        (["tiles", 0, "most_cycles"], 3, "record .* of tile0.waves must have 1 to 3 cycles"),
        (["tiles", 0, "most_cycles"], 99, "the fastest wave of tile0.waves must have 99 cycles"),
        (["tiles", 0, "mixed"], 3.0, r"tiles\[0\].mixed must be a power of two, got 3.0"),
        (["tiles", 0, "mixed"], 0, r"tiles\[0\].mixed must be between"),
        (["files"], [], "files must be a list of 1"),
        (["files", 0, "name"], "tile1.waves", "files must have names of their own"),
        (["files", 0, "name"], "TILE1.waves", "files must have names of their own"),
        (["files", 0, "name"], "other.waves", "files must list tile0.waves"),
        (["files", 0, "bytes"], -1, r"files\[0\].bytes must be"),
        (["files", 0, "bytes"], 2**70, r"files\[0\].bytes must be"),
        (["files", 0, "sha256"], "0", r"files\[0\].sha256 must be 64 hexadecimal digits"),
        (["files", 0], [[[[]]]], r"files\[0\] must be an object"),
    ],
)
def test_a_document_that_no_package_has_is_refused_by_its_entry(path, value, words):
    refused(build.changed(path, value), words)


@pytest.mark.parametrize(
    "name",
    [
        *("../tile9.waves", "a/b", "a\\b", "/etc/passwd", "C:x", "..", ".", "", ".hidden", "a..b"),
        *("sea.json", "con", "NUL.txt", "x" * 81, "a\0b", "ä.bin", "a b", "a.", 7, None, ["x"]),
    ],
)
def test_a_file_outside_the_package_is_refused(name):
    package = build.changed(["files", 2, "name"], name)
    refused(package, r"files\[2\].name must be a plain file name without folders")


@pytest.mark.parametrize(
    "key", ["format", "loop", "ticks", "tiles", "files", "depth", "choppiness", "surface_tension"]
)
def test_a_missing_entry_is_named(key):
    refused(build.without(key), f"{key} is missing")


def record(i, **changes):
    """Return the waves of tile 0 with one record changed."""
    data = bytearray(build.packed().files["tile0.waves"])
    found = struct.unpack_from("<hhHff", data, 14 * i)
    values = dict(zip(("mx", "my", "cycles", "re", "im"), found, strict=True))
    struct.pack_into("<hhHff", data, 14 * i, *{**values, **changes}.values())
    return bytes(data)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mx": 16}, r"record 5 of tile0.waves must have \|mx\| <= 15"),
        ({"my": -16}, r"record 5 of tile0.waves must have \|mx\| <= 15"),
        ({"mx": 0, "my": 0}, "record 5 of tile0.waves must have .*not both 0"),
        ({"mx": 1, "my": 0}, "record 5 of tile0.waves must follow the one before"),
        ({"re": float("nan")}, "record 5 of tile0.waves must have a finite amplitude"),
        ({"im": float("inf")}, "record 5 of tile0.waves must have a finite amplitude"),
        ({"re": 0.0, "im": 0.0}, "record 5 of tile0.waves must have a finite amplitude, not 0"),
        ({"cycles": 0}, "record 5 of tile0.waves must have 1 to"),
        ({"cycles": 65535}, "record 5 of tile0.waves must have 1 to"),
        ({"re": 1e38}, "tile0.waves has waves of no sea"),
    ],
)
def test_a_record_that_no_package_has_is_refused_by_its_number(changes, words):
    refused(build.with_file("tile0.waves", record(5, **changes)), words)


def test_a_wave_that_is_there_twice_is_refused():
    """The second would take the place of the first in the plane."""
    mx, my, *_ = struct.unpack_from("<hhHff", build.packed().files["tile0.waves"], 14 * 4)
    data = record(5, mx=mx, my=my)
    words = "record 5 of tile0.waves must follow the one before"
    refused(build.with_file("tile0.waves", data), words)


def test_cycles_that_are_not_those_of_the_dispersion_relation_are_refused():
    records = list(struct.iter_unpack("<hhHff", build.packed().files["tile0.waves"]))
    i = next(i for i, r in enumerate(records) if r[2] > 4)
    data = record(i, cycles=records[i][2] - 2)
    refused(build.with_file("tile0.waves", data), r"along \(mx, my\) = .* must have .* cycles")


def test_cycles_of_both_waves_of_a_pair_may_be_off_by_one_and_no_more():
    """Both agree with each other: only the dispersion relation tells."""
    data = build.packed().files["tile0.waves"]
    records = list(struct.iter_unpack("<hhHff", data))
    most = max(r[2] for r in records)
    mx, my, cycles, *_ = next(r for r in records if 4 < r[2] < most - 4)
    for change in (-2, -1, 1, 2):
        changed = bytearray(data)
        for i, (x, y, found, *_) in enumerate(records):
            if (x, y) in ((mx, my), (-mx, -my)):
                assert found == cycles
                struct.pack_into("<H", changed, 14 * i + 4, cycles + change)
        package = build.with_file("tile0.waves", bytes(changed))
        if abs(change) == 1:
            assert runtime.ocean_of(package).oceans[0].modes().kx.size == len(records)
        else:
            refused(package, rf"must have {cycles} cycles in the loop, got {cycles + change}")


ODD = [None, True, -1, 0, 7, 0.5, 1e308, 2**70, -(2**70), "", "../x", [], {}, [[None]], [1, 2]]


def paths(tree, at=()):
    """Yield the path of every entry of a document."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in items:
        yield (*at, key)
        if isinstance(value, (dict, list)):
            yield from paths(value, (*at, key))


@pytest.mark.parametrize("value", ODD, ids=repr)
def test_any_entry_of_any_kind_is_taken_or_refused(value):
    """No value in any place of the document is another error, or a crash."""
    document = build.packed().document
    for path in paths({key: document[key] for key in document if key != "spectrum"}):
        with contextlib.suppress(IntegrityError):
            Contents.of(build.changed(path, value).document)


# Containers


def test_a_container_gives_the_package_back():
    package = build.packed()
    again = runtime.from_bytes(bytearray(runtime.to_bytes(package)))
    assert again.document == package.document
    assert again.files == package.files


def test_every_flipped_byte_of_a_container_is_noticed_or_harmless():
    """A byte of the waves changes their SHA-256; one of the text may be a digit of a statistic."""
    data = runtime.to_bytes(runtime.pack(build.cascade(), reference=False))
    (length,) = struct.unpack_from("<I", data, 8)
    start = 16 + length
    for at in [*range(16), *range(start, len(data), 97), len(data) - 1]:
        broken = bytearray(data)
        broken[at] ^= 0x40
        with pytest.raises(IntegrityError):
            runtime.from_bytes(broken)
    for at in range(16, start, 41):
        broken = bytearray(data)
        broken[at] ^= 0x40
        try:
            package = runtime.from_bytes(broken)
            runtime.ocean_of(package)
        except IntegrityError:
            continue
        assert {k: v for k, v in package.files.items() if k.endswith(".waves")} == {
            f"tile{i}.waves": build.packed().files[f"tile{i}.waves"] for i in range(3)
        }


def test_padding_of_a_container_is_zeros():
    """A byte between two files, and one after the last."""
    package = runtime.pack(build.cascade(), reference=False)
    data = runtime.to_bytes(package)
    at, found = 16 + struct.unpack_from("<I", data, 8)[0], 0
    for name, content in package.files.items():
        at += len(content)
        for place in range(at, at + -at % 16):
            broken = bytearray(data)
            broken[place] = 1
            with pytest.raises(IntegrityError, match=f"{name} must be followed by zeros"):
                runtime.from_bytes(broken)
            found += 1
        at += -at % 16
    assert at == len(data)
    assert found


@pytest.mark.parametrize("length", [0, 3, 15, 16, 100, -1, -16])
def test_a_container_that_was_cut_is_refused(length):
    data = runtime.to_bytes(build.packed())
    with pytest.raises(IntegrityError):
        runtime.from_bytes(data[:length])
    with pytest.raises(IntegrityError, match=r"the container must have \d+ bytes"):
        runtime.from_bytes(data + bytes(16))


def container(document):
    """Return a container of some JSON text and nothing else."""
    document += b" " * (-len(document) % 16)
    return struct.pack("<4sIII", b"FFTO", 1, len(document), 0) + document


@pytest.mark.parametrize(
    "text",
    [
        *(b"", b"{", b"null", b"[]", b"7", b"\xff\xfe", b'{"format": NaN}', b"[" * 100_000),
        b'{"loop": 1' + b"0" * 5000 + b"}",
        b'{"a":' * 50_000 + b"1" + b"}" * 50_000,
    ],
)
def test_a_container_whose_document_is_none_is_refused(text):
    with pytest.raises(IntegrityError):
        runtime.from_bytes(container(text))
