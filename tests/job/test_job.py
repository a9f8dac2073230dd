"""Jobs: default and rule of every key, contents of job files, and refusals before computation."""

import contextlib
import itertools
import json
import math
import os
import re
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fftocean as fo
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import JobError, ParameterError, ReaderError
from fftocean.export.formats import FORMATS
from fftocean.export.profiles import PROFILES
from fftocean.fields import FIELDS
from fftocean.foam import Foam
from fftocean.job import job as job_module
from fftocean.job.job import Job, parse_setting, parse_value
from fftocean.job.parameters import BY_KEY, PARAMETERS
from fftocean.physics.spectra import SPECTRA as SPECTRUM_KINDS
from fftocean.physics.spreading import SPREADINGS as SPREADING_KINDS

pytestmark = [pytest.mark.nojit, pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")]

BAD = ["nan", "inf", "-1", "0", '"5"', "true", "1e308", "1e-308"]
SPECTRA_FILES = Path(__file__).parents[1] / "data" / "spectra"
SWELL = "spectrum = { kind = 'jonswap', hs = 1.5, tp = 14.0, gamma = 7.0 }"
GOOD = {
    **{
        "hs": "0.5",
        "tp": "8.0",
        "gamma": "2.0",
        "growth": "'kahma-calkoen'",
        "tail": "5.0",
        "speed": "9.0",
        "fetch": "1e5",
        "number": "4",
        "s": "9.0",
        "n": "4.0",
        "spread": "20.0",
    },
    **{"xi": "0.5", "weight": "0.5", "frequency": "[0.1, 0.2, 0.4]", "density": "[0.0, 1.0, 0.2]"},
    **{"t1": "6.0", "tz": "6.0", "tail": "5.0", "front": "4.0", "exact": "false", "member": "3"},
    **{"form": "'full'", "amplitude": "1e-3", "cutoff": "0.1", "s_max": "10.0"},
    **{"friction_velocity": "0.3", "both_ways": "true", "direction": "[0, 120, 240]"},
    **{"spectrum": "{ kind = 'bretschneider', hs = 0.5, tp = 8.0 }"},
    **dict.fromkeys(("base", "first", "second"), "{ kind = 'cosine-squared' }"),
    **{
        "hs_low": "0.5",
        "tp_low": "9.0",
        "lambda_low": "3.0",
        "hs_high": "0.4",
        "tp_high": "5.0",
        "lambda_high": "1.0",
    },
}
WAYS = [(name, tuple(way.keys)) for name, kind in SPECTRUM_KINDS.items() for way in kind.ways]
SPREADING_WAYS = [
    (name, tuple(way.keys))
    for name, kind in SPREADING_KINDS.items()
    for way in kind.ways
    if way.keys
]


def refused(text, *parts):
    """The message of the refusal of a job, which names the given parts and stands on one line."""
    with pytest.raises(JobError) as caught:
        Job.from_toml(text).ocean()
    message = str(caught.value)
    for part in parts:
        assert part in message
    assert "\n" not in message
    assert caught.value.exit_code == 2
    return message


def refused_or_finite(text, key, value):
    """
    A job is refused, with the key and what came, or makes a frame without a NaN. Returns whether it
    was refused.
    """
    message = None
    try:
        ocean = Job.from_toml(text).ocean()
    except JobError as error:
        message = str(error)
    if message is not None:
        for part in (key, value.strip('"').removesuffix(".0"), "must "):
            assert part in message.lower().replace("e+", "e")
        return True
    frame = ocean.frame(1.0, (*FIELDS, "normal", "jacobian"))
    for name in frame.fields:
        assert np.all(np.isfinite(frame[name])), name
    return False


def toml_of(key, value):
    table, _, name = key.rpartition(".")
    small = "" if key == "ocean.n" else "[ocean]\nn = 8\n" if table != "ocean" else ""
    return f"{small}[{table}]\n{name} = {value}\n" + (
        "n = 8\n" if table == "ocean" and key != "ocean.n" else ""
    )


# What each key makes of each of `BAD`, by hand from its meaning: r refused, a accepted.
VERDICTS = {
    #                         nan inf -1 0 "5" true 1e308 1e-308
    "sea.wind.speed":        "r   r   r  a r   r    r     a",
    "sea.wind.fetch":        "r   r   r  r r   r    r     r",
    "sea.wind.direction":    "r   r   a  a r   r    r     a",
    "sea.wind.gamma":        "r   r   r  r r   r    r     r",
    "sea.wind.growth":       "r   r   r  r r   r    r     r",
    "sea.wind.blend":        "r   r   r  a r   r    r     a",
    "sea.depth":             "r   a   r  r r   r    a     r",
    "ocean.band_low":        "r   r   r  a r   r    r     a",
    "ocean.band_high":       "r   a   r  r r   r    a     a",
    "sea.surface_tension":   "r   r   r  a r   r    r     a",
    "ocean.n":               "r   r   r  r r   r    r     r",
    "ocean.size":            "r   r   r  r r   r    r     r",
    "ocean.seed":            "r   r   r  a r   r    r     r",
    "ocean.loop":            "r   r   r  r r   r    r     r",
    "ocean.choppiness":      "r   r   r  a r   r    r     a",
    "ocean.amplitudes":      "r   r   r  r r   r    r     r",
    "ocean.order":           "r   r   r  r r   r    r     r",
    "ocean.bound":           "r   r   r  a r   r    r     r",
    "ocean.backend":         "r   r   r  r r   r    r     r",
    "bake.frames":           "r   r   r  r r   r    r     r",
    "bake.maps":             "r   r   r  r r   r    r     r",
    "bake.format":           "r   r   r  r r   r    r     r",
    "bake.engine":           "r   r   r  r r   r    r     r",
    "bake.lookup":           "r   r   r  r r   r    r     r",
    "bake.normals":         "r   r   r  r r   r    r     r",
    "bake.mips":             "r   r   r  r r   a    r     r",
    "bake.engine_files":     "r   r   r  r r   a    r     r",
    "bake.pictures":         "r   r   r  r r   r    r     r",
    "bake.foam.tau":         "r   r   r  r r   r    r     r",
    "bake.foam.threshold":   "r   r   a  a r   r    r     a",
    "bake.foam.strength":    "r   r   r  a r   r    r     a",
}  # fmt: skip


@pytest.mark.parametrize("key", BY_KEY)
def test_a_bad_value_of_any_key_is_refused_or_gives_finite_water(key):
    verdicts = VERDICTS[key].split()
    for value, verdict in zip(BAD, verdicts, strict=True):
        assert refused_or_finite(toml_of(key, value), key, value) == (verdict == "r"), value


def passes_at(kind, key, keys=()):
    """
    Return the values of `BAD` that a kind accepts, by the meaning of its keys: a height or a wind
    of 0 is flat water, and calm is number 0.
    """
    if key in ("number", "member"):
        return ("0",)
    if key in ("exact", "both_ways"):
        return ("true",)
    nothing = key in ("hs", "hs_low", "hs_high", "speed", "s", "n", "xi", "weight") or key in (
        "amplitude",
        "cutoff",
        "s_max",
        "friction_velocity",
    )
    unreachable = (kind, key) == ("phillips", "speed") and "hs" in keys
    return ("0", "1e-308") if nothing and not unreachable else ()


@pytest.mark.parametrize(("kind", "keys"), WAYS, ids=str)
def test_a_bad_value_in_a_spectrum_is_refused_or_gives_finite_water(kind, keys):
    for key, value in itertools.product(keys, BAD):
        table = ", ".join(f"{name} = {value if name == key else GOOD[name]}" for name in keys)
        text = f"[ocean]\nn = 8\n[[sea.systems]]\nspectrum = {{ kind = '{kind}', {table} }}\n"
        assert refused_or_finite(text, key, value) == (value not in passes_at(kind, key, keys)), (
            key,
            value,
        )


@pytest.mark.parametrize(("kind", "keys"), SPREADING_WAYS, ids=str)
def test_a_bad_value_in_a_spreading_is_refused_or_gives_finite_water(kind, keys):
    good = {**GOOD, "density": "[[1.0, 0.5, 0.5], [1.0, 0.2, 0.2], [1.0, 0.1, 0.1]]"}
    for key, value in itertools.product(keys, BAD):
        table = ", ".join(f"{name} = {value if name == key else good[name]}" for name in keys)
        text = (
            f"[ocean]\nn = 8\n[[sea.systems]]\n{SWELL}\n"
            f"spreading = {{ kind = '{kind}', {table} }}\n"
        )
        assert refused_or_finite(text, key, value) == (value not in passes_at(kind, key, keys)), (
            key,
            value,
        )


@pytest.mark.parametrize("value", [*BAD, "1.5", "1000000"])
@pytest.mark.parametrize("key", ["time", "site"])
def test_a_bad_place_in_a_measured_file_is_refused(key, value):
    """Counted from 0, or back from the end, as Python does."""
    text = (
        f"[ocean]\nn = 8\n[[sea.systems]]\nmeasured = {{ file = "
        f"'{SPECTRA_FILES / '41010.data_spec'}', {key} = {value} }}\n"
    )
    if value == "0" or (key, value) == ("time", "-1"):
        assert not refused_or_finite(text, key, value)
    else:
        with pytest.raises(ParameterError, match=key):
            Job.from_toml(text)


@pytest.mark.parametrize(
    "file",
    [
        "",
        ".",
        "..",
        "/dev/zero",
        "/dev/full",
        "none",
        "a\nb",
        "a\0b",
        "x" * 1900,
        "README.md",
        "/proc/self/mem",
    ],
)
def test_a_measured_file_that_is_none_is_an_input_error(file):
    """Exit 3, and at once."""
    start = time.process_time()
    with pytest.raises(ReaderError) as caught:
        Job.from_tree(
            {"sea": {"systems": [{"measured": {"file": file}}]}},
            source=str(SPECTRA_FILES / "job.toml"),
        )
    assert caught.value.exit_code == 3
    assert "\n" not in str(caught.value)
    assert time.process_time() - start < 2.0


@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("key", ["frequency", "density"])
@pytest.mark.parametrize("place", [0, 1, 2])
def test_a_bad_value_in_a_measured_spectrum_is_refused_or_gives_finite_water(key, value, place):
    columns = {"frequency": ["0.1", "0.2", "0.4"], "density": ["0.0", "1.0", "0.2"]}
    columns[key][place] = value
    table = ", ".join(f"{name} = [{', '.join(column)}]" for name, column in columns.items())
    text = f"[ocean]\nn = 8\n[[sea.systems]]\nspectrum = {{ kind = 'tabulated', {table} }}\n"
    assert refused_or_finite(text, f"{key}[{place}]", value) == (
        not (key == "density" and value in ("0", "1e-308"))
    )


@pytest.mark.parametrize("value", BAD)
def test_a_bad_direction_is_refused_or_gives_finite_water(value):
    job = f"[ocean]\nn = 8\n[[sea.systems]]\n{SWELL}\ndirection = {value}\n"
    assert refused_or_finite(job, "sea.systems[0].direction", value) == (
        value not in ("-1", "0", "1e-308")
    )


def test_no_wind_is_an_exactly_flat_sea_that_says_so():
    job = Job.from_toml("[sea.wind]\nspeed = 0\n[ocean]\nn = 16\n")
    with pytest.warns(fo.SeaWarning, match="exactly flat"):
        ocean = job.ocean()
    frame = ocean.frame(2.5, (*FIELDS, "normal", "jacobian"))
    for name in FIELDS:
        assert not frame[name].any()
    assert np.all(frame.normal == (0.0, 0.0, 1.0))
    assert np.all(frame.jacobian == 1.0)


def test_an_empty_file_is_all_defaults():
    job = Job.from_toml("")
    assert job.settings == {p.key: p.default for p in PARAMETERS}
    assert job.wind
    assert not job.systems
    assert Job.from_toml("# nothing\n\r\n  \n").settings == job.settings
    assert Job.from_toml("sea.systems = []\n").wind


def test_every_default_keeps_its_own_rule():
    for p in PARAMETERS:
        assert p.check(p.default) == p.default
        assert p.help
        assert p.rule
    assert len(BY_KEY) == len(PARAMETERS)
    assert set(BY_KEY["bake.maps"].choices) == set(MAPS)
    assert set(BY_KEY["bake.format"].choices) == set(FORMATS)
    assert set(BY_KEY["bake.engine"].choices) == set(PROFILES)


@pytest.mark.parametrize(
    ("sea", "wind"),
    [
        ("[sea.wind]\nspeed = 12.0\n", 12.0),
        (f"[[sea.systems]]\n{SWELL}\n", None),
        ("[[sea.systems]]\nspectrum = { kind = 'beaufort', number = 6 }\n", 12.3),
        ("[[sea.systems]]\nspectrum = { kind = 'elfouhaily', speed = 9.0, fetch = 1e5 }\n", 9.0),
        (
            "[[sea.systems]]\nspectrum = { kind = 'tma', spectrum = "
            "{ kind = 'jonswap', speed = 8.0, fetch = 1e5 } }\n",
            8.0,
        ),
    ],
)
def test_foam_follows_the_wind_that_a_job_names(sea, wind):
    """By speed or by a number; a swell alone has none, and the fixed threshold."""
    text = sea + "[ocean]\nn = 32\nsize = 80.0\n"
    job = Job.from_toml(text)
    assert job.wind_speed == (None if wind is None else pytest.approx(wind))
    ocean = job.ocean()
    told = job.describe_foam(ocean)
    assert told["wind"] == job.wind_speed
    if wind is None:
        assert job.foam_on(ocean) == Foam()
        assert told["threshold_from"] == "fixed, as the sea names no wind"
        return
    assert job.foam_on(ocean).threshold == pytest.approx(
        Foam.whitecaps(ocean, wind).threshold, abs=5.1e-5
    )
    # rounding the threshold by 5e-5 changes the coverage by less than 1 %
    assert told["coverage"] == pytest.approx(3.84e-6 * wind**3.41, rel=0.01)
    assert "whitecaps of" in told["threshold_from"]
    fixed = Job.from_toml(text + "[bake.foam]\nthreshold = 0.6\n")
    assert fixed.foam_on(ocean) == Foam(threshold=0.6)
    assert fixed.describe_foam(ocean)["threshold_from"] == "as the job has it"


def test_the_threshold_of_foam_is_a_number_or_follows_the_wind():
    refused("[bake.foam]\nthreshold = 'Monahan'\n", "bake.foam.threshold", "or 'wind'", "Monahan")
    assert Job.from_toml("[bake.foam]\nthreshold = 'Wind'\n").foam_follows_wind


def test_foam_is_that_of_the_library():
    """The same defaults, though the table of keys stands apart from what they mean."""
    assert Foam(**Job.default().foam) == Foam()


def test_the_embedded_job_is_the_one_in_the_package():
    job = Job.default()
    assert job.settings["sea.wind.direction"] == 25.0
    assert job.frames == 240
    assert job.maps == ("height", "displacement", "normal")
    assert fo.Job is Job


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_a_file_reads_as_its_text(tmp_path, ending):
    text = ending.join(
        [
            "[ocean]",
            "n = [48, 80]",
            "size = [30, 50.5]",
            "[bake]",
            "maps = ['normal', 'height', 'normal']",
            "",
        ]
    )
    path = tmp_path / "sea.toml"
    path.write_bytes(text.encode())
    job = Job.read(path)
    assert job.settings == Job.from_toml(text).settings
    assert job.settings["ocean.n"] == (48, 80)
    assert job.settings["ocean.size"] == (30.0, 50.5)
    assert job.maps == ("normal", "height")
    assert job.source == str(path)
    grid = job.ocean().grid
    assert (grid.nx, grid.ny, grid.lx, grid.ly) == (48, 80, 30.0, 50.5)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("[sea.wind]\nsped = 3\n", ["'sea.wind.sped'", "did you mean sea.wind.speed?"]),
        ("[ocean]\nchopiness = 3\n", ["'ocean.chopiness'", "did you mean ocean.choppiness?"]),
        ("[[sea.sytems]]\n", ["'sea.sytems'", "did you mean sea.systems?"]),
        ("xyzzy = 3\n", ["'xyzzy'", "known are sea.wind.speed, "]),
        ("[xyzzy.a.b]\nc = 3\n", ["'xyzzy'", "known are "]),
        ('"a\\nb" = 3\n', ["'a\\nb'"]),
        ('"" = 3\n', ["''"]),
        ("sea = 5\n", ["'sea'"]),
        ("[sea]\nwind = 5\n", ["'sea.wind'"]),
        ("[ocean]\nn = { x = 8 }\n", ["ocean.n", "whole number", "dict"]),
        ("[ocean]\nn = 8\nn = 9\n", ["TOML", "line 3"]),
        ("ocean.n = 8\n[ocean]\nsize = 9\n", ["TOML", "ocean", "line 2"]),
        ("[ocean]\nn = []\n", ["ocean.n", "two", "[]"]),
        ("[ocean]\nn = [8]\n", ["ocean.n", "two", "[8]"]),
        ("[ocean]\nn = [8, 8, 8]\n", ["ocean.n", "two", "[8, 8, 8]"]),
        ("[ocean]\nn = [8, 0]\n", ["ocean.n", "between 1 and 65536", "0"]),
        ("[ocean]\nn = 1.5\n", ["ocean.n", "whole number", "1.5"]),
        ("[ocean]\nn = 8.0\n", ["ocean.n", "whole number", "8.0"]),
        ("[ocean]\nn = 1_000_000_000\n", ["ocean.n", "between 1 and 65536", "1000000000"]),
        ("[ocean]\nseed = 18446744073709551616\n", ["ocean.seed", "18446744073709551616"]),
        ("[ocean]\nloop = 1979-05-27T07:32:00Z\n", ["ocean.loop", "number", "datetime"]),
        ("[bake]\nmaps = 'height'\n", ["bake.maps", "list", "'height'"]),
        ("[bake]\nmaps = []\n", ["bake.maps", "list", "[]"]),
        ("[bake]\nmaps = ['height', 'wrong']\n", ["bake.maps", "some of height", "'wrong'"]),
        ("[bake]\nmaps = [['height']]\n", ["bake.maps", "['height']"]),
        ("sea.systems = 5\n", ["sea.systems", "[[sea.systems]]", "5"]),
        ("sea.systems = [5]\n", ["sea.systems", "[[sea.systems]]", "[5]"]),
        (f"[sea.systems]\n{SWELL}\n", ["sea.systems", "must be tables, written [[sea.systems]]"]),
        ("[[sea.systems]]\n", ["sea.systems[0].spectrum", "must be given"]),
        (
            f"[[sea.systems]]\n{SWELL}\n[[sea.systems]]\n{SWELL}\nspeading = 3\n",
            ["sea.systems[1].speading", "sea.systems[1].spreading?"],
        ),
        (
            "[[sea.systems]]\nspectrum = 5\n",
            ["sea.systems[0].spectrum", "one of beaufort, bretschneider", "5"],
        ),
        (
            "[[sea.systems]]\nspectrum = { kind = 'jonswp' }\n",
            ["sea.systems[0].spectrum", "one of beaufort, bretschneider", "'jonswp'"],
        ),
        (
            "[[sea.systems]]\nspectrum = { kind = ['jonswap'] }\n",
            ["sea.systems[0].spectrum", "['jonswap']"],
        ),
        (
            "[[sea.systems]]\nspectrum = { kind = 'jonswap', hs = 1.0 }\n",
            ["{hs, tp, [gamma]} or {speed, fetch, [gamma], [growth]}", "got {hs}"],
        ),
        (
            "[[sea.systems]]\nspectrum = { kind = 'jonswap', hs = 1.0, tp = 9.0, speed = 9.0 }\n",
            ["got {hs, tp, speed}"],
        ),
        (
            "[[sea.systems]]\n"
            "spectrum = { kind = 'pierson-moskowitz', hs = 1.0, tp = 9.0, gamma = 2.0 }\n",
            ["got {hs, tp, gamma}"],
        ),
        (
            f"[[sea.systems]]\n{SWELL}\nspreading = {{ kind = 'cosine-power' }}\n",
            ["spreading", "{s}", "got {}"],
        ),
        (
            f"[[sea.systems]]\n{SWELL}\nspreading = {{ kind = 'cosine-squared', s = 3 }}\n",
            ["spreading", "got {s}"],
        ),
        (
            f"[[sea.systems]]\n{SWELL}\nspreading = 'blend'\n",
            ["spreading", "one of blend, cosine-n", "'blend'"],
        ),
        (
            "[[sea.systems]]\nspectrum = { kind = 'jonswap', hs = 50.0, tp = 2.0 }\n",
            ["sea.systems[0].spectrum", "50 m with 2 s"],
        ),
        (
            "sea.depth = 0.01\n[[sea.systems]]\nspectrum = { kind = 'tma', hs = 9.0, tp = 4.0 }\n",
            ["9 m with 4 s", "in 0.01 m of water"],
        ),
        (
            "[[sea.systems]]\n"
            "spectrum = { kind = 'tabulated', frequency = [0.1, 0.2], density = [1.0] }\n",
            ["sea.systems[0].spectrum"],
        ),
        (
            "[[sea.systems]]\n"
            "spectrum = { kind = 'tabulated', frequency = [0.2, 0.1], density = [1.0, 1.0] }\n",
            ["frequency"],
        ),
        (
            "[[sea.systems]]\nspectrum = { kind = 'tabulated', frequency = [], density = [] }\n",
            ["sea.systems[0].spectrum"],
        ),
        (
            f"[sea.wind]\nfetch = 1e4\n[[sea.systems]]\n{SWELL}\n",
            ["sea.wind.speed must be given", "sea.wind.fetch"],
        ),
        ("\0", ["TOML"]),
        ("[ocean]\rn = 8\n", ["TOML"]),
        ('a = """\n', ["TOML"]),
    ],
)
def test_what_a_job_may_not_say_is_refused(text, parts):
    refused(text, *parts)


@pytest.mark.parametrize(
    "text",
    [
        "a" * 60_000,
        ".".join("a" * 30_000) + " = 1",
        ".".join(['"\u2028"'] * 9_000) + " = 1",  # a line break for Unicode, and none for TOML
        ".".join(['"\x85"'] * 12_000) + " = 1",
        "\n".join(".".join(chr(97 + i) * 1000) + " = 1" for i in range(26)),
        "\n".join("[" + ".".join(chr(97 + i) * 1000) + "]" for i in range(26)),
        "#" * 66_000,
        "#\n" * 33_000,
        "é\n" * 30_000,
        "ocean.n = " + "[" * 2000,
        "ocean.n = [\n" + "[\n" * 30_000,
        "ocean.n = " + "[" * 300 + "]" * 300,
        "sea.systems = " + "[" * 300 + "]" * 300,
        "a = " + "{a=" * 500 + "1" + "}" * 500,
        "[[sea.systems]]\nspectrum = " + "{kind=" * 200 + "1" + "}" * 200,
        "[[sea.systems]]\n" * 4000,
        f"[[sea.systems]]\n{SWELL}\n" * 65,
        "ocean.seed = " + "9" * 2000,
        "ocean.seed = 0x" + "f" * 2000,
        "ocean.size = 0x" + "f" * 2000,
        "\n".join(f"k{i} = 1" for i in range(6000)),
    ],
    ids=lambda text: repr(text[:20]),
)
def test_hostile_text_is_refused_at_once(text):
    """
    Within 2 s, whatever the parser would make of it: size and line length are bounded first, depth
    by its recursion limit.
    """
    start = time.process_time()
    message = refused(text)
    assert time.process_time() - start < 2.0
    assert len(message) < 4000


@pytest.mark.parametrize(
    ("data", "part"),
    [
        (b"\xff\xfe\x00", "UTF-8 text, and is not at byte 0"),
        (b"# caf\xe9\n", "UTF-8 text, and is not at byte 5"),
        ("ocean.n = 8\n".encode("utf-16"), "UTF-8"),
        (b"#" * 100_000, "at most 65536 bytes"),
        (b"#\n" * 40_000, "at most 65536 bytes"),
    ],
)
def test_files_that_are_no_text_or_too_large_are_refused(tmp_path, data, part):
    path = tmp_path / "job.toml"
    path.write_bytes(data)
    with pytest.raises(JobError, match=part):
        Job.read(path)


def test_what_is_no_file_is_refused_at_once(tmp_path):
    """
    A folder, devices, a pipe without a writer, a missing file, an impossible name, a loop of links.
    """
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    start = time.process_time()  # of this process: the machine may be busy
    for path in (
        tmp_path,
        "/dev/zero",
        "/dev/full",
        "/dev/null",
        tmp_path / "pipe",
        tmp_path / "none",
        "x" * 5000,
        "",
        tmp_path / "loop",
    ):
        with pytest.raises(JobError) as caught:
            Job.read(path)
        assert str(path)[:20] in str(caught.value)
    assert time.process_time() - start < 2.0


def test_a_file_that_cannot_be_read_is_refused(tmp_path, monkeypatch):
    """As a disk that fails: the name and the system's words for it."""
    path = tmp_path / "job.toml"
    path.write_text("")

    def fail(*_, **__):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(type(path), "open", fail)
    with pytest.raises(JobError, match=r"job\.toml cannot be read: Input/output error"):
        Job.read(path)


def test_more_memory_than_there_is_is_refused_before_it_is_taken(monkeypatch):
    """The largest n, on a machine of 1 GiB: the message has the estimate."""
    monkeypatch.setattr("fftocean.host.available_memory", lambda: 2.0**30)
    message = refused("[ocean]\nn = 65536\n", "ocean", "n = 65536 x 65536", "1.0 GiB are free")
    estimate = float(message.split("about ")[1].split(" GiB")[0])
    assert 8 * 4 * 65536**2 / 2**30 < estimate < 1000.0  # at least the eight fields


trees = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.dates(),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3)
    ),
    max_leaves=6,
)
kinds = st.sampled_from(["jonswap", "tma", "pierson-moskowitz", "tabulated"])
keys = st.sampled_from([*BY_KEY, "sea.systems", "sea", "ocean", "sea.wind"]) | st.text(max_size=8)


def nested(flat):
    """Dotted keys as tables, as far as they do not contradict."""
    tree = {}
    for key, value in flat.items():
        *tables, name = key.split(".")
        inner = tree
        for table in tables:
            inner = inner.setdefault(table, {}) if isinstance(inner.get(table, {}), dict) else {}
        inner[name] = value
    return tree


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.dictionaries(keys, trees, max_size=3))
def test_any_tree_is_a_job_or_refused(flat):
    """
    Nothing but a JobError comes out of what a parser may hand in, and what is accepted can be
    described as JSON.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            job = Job.from_tree(nested(flat))
        except JobError:
            return
        json.dumps(job.describe(), allow_nan=False)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(
    st.dictionaries(
        st.sampled_from(
            ["kind", "hs", "tp", "gamma", "speed", "fetch", "frequency", "density", "x"]
        ),
        kinds | st.floats() | trees | st.lists(st.floats(1e-3, 1.0), max_size=4),
        min_size=1,
        max_size=4,
    )
)  # fmt: skip
def test_any_wave_system_is_made_or_refused(spectrum):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            job = Job.from_tree({"sea": {"systems": [{"spectrum": spectrum}]}})
        except JobError:
            return
        assert math.isfinite(job.sea().variance)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.text(max_size=200))
def test_any_text_is_a_job_or_refused(text):
    with contextlib.suppress(JobError):
        Job.from_toml(text)


# What is accepted means what it says.


def same_sea(one, other):
    omega = np.geomspace(0.1, 10.0, 200)
    assert one.depth == other.depth
    assert len(one.systems) == len(other.systems)
    for a, b in zip(one.systems, other.systems, strict=True):
        theta = np.linspace(-3.0, 3.0, 9)
        assert np.array_equal(a.density(omega[:, None], theta), b.density(omega[:, None], theta))


def test_the_wind_sea_is_that_of_the_library():
    job = Job.from_toml(
        "sea.depth = 30.0\n[sea.wind]\nspeed = 12.0\nfetch = 2e5\ndirection = 40.0\ngamma "
        "= 2.0\nblend = 0.3\n"
    )
    spreading = fo.Blend(fo.DonelanBanner(), fo.CosineSquared(), weight=0.3)
    same_sea(
        job.sea(),
        fo.Sea.from_wind(
            speed=12.0, fetch=2e5, depth=30.0, direction=40.0, gamma=2.0, spreading=spreading
        ),
    )


DEPTH = 20.0
SPECTRA = {
    "kind = 'jonswap', hs = 1.5, tp = 14.0, gamma = 7.0": lambda: fo.JONSWAP.from_sea_state(
        hs=1.5, tp=14.0, gamma=7.0
    ),
    "kind = 'jonswap', hs = 1.5, tp = 14.0": lambda: fo.JONSWAP.from_sea_state(hs=1.5, tp=14.0),
    "kind = 'jonswap', speed = 9.0, fetch = 1e5": lambda: fo.JONSWAP.from_wind(
        speed=9.0, fetch=1e5
    ),
    "kind = 'tma', hs = 1.5, tp = 9.0": lambda: fo.TMA.from_sea_state(hs=1.5, tp=9.0, depth=DEPTH),
    "kind = 'tma', speed = 9.0, fetch = 1e5, gamma = 1.5": lambda: fo.TMA.from_wind(
        speed=9.0, fetch=1e5, gamma=1.5, depth=DEPTH
    ),
    "kind = 'pierson-moskowitz', hs = 2.0, tp = 9.0": lambda: fo.PiersonMoskowitz.from_sea_state(
        hs=2.0, tp=9.0
    ),
    "kind = 'pierson-moskowitz', speed = 9.0": lambda: fo.PiersonMoskowitz.from_wind(speed=9.0),
    "kind = 'tabulated', frequency = [0.1, 0.2, 0.4], density = [0, 1.0, 0.2]": lambda: (
        fo.TabulatedSpectrum(frequency=(0.1, 0.2, 0.4), density=(0.0, 1.0, 0.2))
    ),
}
SPREADINGS = {
    "": fo.Blend(weight=0.5),
    "spreading = { kind = 'blend', weight = 0.9 }": fo.Blend(
        fo.DonelanBanner(), fo.CosineSquared(), weight=0.9
    ),
    "spreading = { kind = 'donelan-banner' }": fo.DonelanBanner(),
    "spreading = { kind = 'cosine-squared' }": fo.CosineSquared(),
    "spreading = { kind = 'cosine-power', s = 25.0 }": fo.CosinePower(s=25.0),
}


def wave_system(spectrum, spreading):
    """The sea of a job of one wave system."""
    job = Job.from_toml(
        f"sea.depth = {DEPTH}\n[[sea.systems]]\nspectrum = {{ {spectrum} "
        f"}}\n{spreading}\ndirection = 110\n"
    )
    assert not job.wind
    return job.sea()


@pytest.mark.parametrize("spectrum", SPECTRA)
def test_spectra_are_those_of_the_library(spectrum):
    system = fo.WaveSystem(spectrum=SPECTRA[spectrum](), spreading=SPREADINGS[""], direction=110.0)
    same_sea(wave_system(spectrum, ""), fo.Sea(system, depth=DEPTH))


@pytest.mark.parametrize("spreading", SPREADINGS)
def test_spreadings_are_those_of_the_library(spreading):
    spectrum = next(iter(SPECTRA))
    system = fo.WaveSystem(
        spectrum=SPECTRA[spectrum](), spreading=SPREADINGS[spreading], direction=110.0
    )
    same_sea(wave_system(spectrum, spreading), fo.Sea(system, depth=DEPTH))


def test_a_wind_sea_comes_with_the_wind_s_speed():
    swell = f"[[sea.systems]]\n{SWELL}\n"
    assert len(Job.from_toml(swell).sea().systems) == 1
    assert len(Job.from_toml("sea.wind.speed = 9.0\n" + swell).sea().systems) == 2
    job = Job.from_toml(swell)
    assert len(job.replaced({"sea.wind.speed": 9.0, "sea.wind.gamma": 2.0}).sea().systems) == 2
    assert len(job.replaced({"ocean.n": 8}).sea().systems) == 1
    with pytest.raises(JobError, match=r"sea\.wind\.speed must be given where sea\.wind\.gamma is"):
        job.replaced({"sea.wind.gamma": 2.0})  # a wind sea of 7 m/s that nobody ordered


def test_replaced_leaves_the_job_as_it_was():
    job = Job.default()
    before = dict(job.settings)
    changed = job.replaced({"ocean.n": (8, 9), "bake.maps": ["jacobian"]})
    assert changed.settings["ocean.n"] == (8, 9)
    assert changed.maps == ("jacobian",)
    assert dict(job.settings) == before
    with pytest.raises(JobError, match=r"unknown key 'ocean.m'; did you mean ocean\.n\?"):
        job.replaced({"ocean.m": 8})
    with pytest.raises(JobError, match=r"sea\.systems must be given in a job file"):
        job.replaced({"sea.systems": []})


@pytest.mark.parametrize(
    "text",
    [
        "",
        "sea.depth = 7.5\n",
        f"[[sea.systems]]\n{SWELL}\ndirection = 3\n",
        f"sea.wind.speed = 3\n[[sea.systems]]\n{SWELL}\n",
    ],
)
def test_a_description_is_json_and_gives_the_job_again(text):
    """Strictly: no NaN, no Infinity; `inf` is a word. Its keys, put back, are the same sea."""
    job = Job.from_toml(text)
    described = job.describe()
    assert json.loads(json.dumps(described, allow_nan=False)) == described
    assert ("sea.wind.speed" in described) == job.wind
    systems = described.pop("sea.systems")
    words = {
        key: float(described[key]) for key in ("sea.depth", "ocean.band_high")
    }  # inf is a word in JSON
    again = Job.from_tree(nested({**described, **words, "sea.systems": systems}))
    assert again.settings == job.settings
    same_sea(again.sea(), job.sea())


def test_choppiness_seed_and_draw_reach_the_ocean():
    ocean = Job.from_toml(
        "[ocean]\nn = 8\nseed = 5\nchoppiness = 0.25\namplitudes = 'fixed'\nloop = 20.0\n"
    ).ocean()
    assert ocean.choppiness == 0.25
    assert ocean.loop == 20.0
    assert ocean.dtype == "float32"
    assert ocean.amplitudes.draw == "fixed"
    other = Job.from_toml("[ocean]\nn = 8\nseed = 6\n").ocean()
    assert not np.array_equal(ocean.frame(0.0).height, other.frame(0.0).height)


# The command line's way of writing values.


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12", 12),
        ("1e3", 1000.0),
        ("-1", -1),
        ("inf", math.inf),
        ("true", True),
        ('"5"', "5"),
        ("fixed", "fixed"),
        ("48,80", [48, 80]),
        ("[48, 80]", [48, 80]),
        ("height,normal", ["height", "normal"]),
        ("height, normal", ["height", "normal"]),
        ("", []),
        ("8\nw = 9", "8\nw = 9"),  # not 8, and the rest forgotten
        ("8 # samples", 8),
        ("[" * 1000, "[" * 1000),
        ("9" * 3000, "9" * 3000),
    ],
)
def test_values_are_written_as_in_toml_or_bare(text, value):
    assert parse_value(text) == value
    assert type(parse_value(text)) is type(value)


def test_settings_are_key_equals_value():
    assert parse_setting("sea.wind.speed=12") == ("sea.wind.speed", 12)
    assert parse_setting(" ocean.n = 8,9 ") == ("ocean.n", [8, 9])
    assert parse_setting("a=b=c") == ("a", "b=c")
    for text in ("", "a", "=1", " = 1"):
        with pytest.raises(JobError, match="key=value"):
            parse_setting(text)


def test_limits_of_a_file_admit_every_honest_job():
    """A sea of 20 partitions, under 20 kB of comment."""
    text = ("# " + "x" * 200 + "\n") * 100 + f"[[sea.systems]]\n{SWELL}\n" * 20
    assert len(Job.from_toml(text).systems) == 20
    assert job_module.MAX_SYSTEMS >= 20


def test_refusals_are_value_errors():
    with pytest.raises(ValueError, match=r"ocean\.n"):
        Job.from_toml("ocean.n = 0")
    assert issubclass(JobError, ParameterError)


# --- measured files

WW3 = str(SPECTRA_FILES / "ww3file.nc")


def measured_job(*tables, **sea):
    return Job.from_tree({"sea": {"systems": [{"measured": table} for table in tables], **sea}})


def test_a_measured_system_has_the_tail_that_its_table_names():
    plain, tailed = measured_job({"file": WW3}), measured_job({"file": WW3, "tail": 5.0})
    made = tailed.measurements()["sea.systems[0]"]
    assert made.tail_variance > 0.0
    assert tailed.sea().variance == pytest.approx(
        plain.sea().variance + made.tail_variance, rel=1e-9
    )
    assert any("a tail f^-5" in note for note in tailed.measured_notes()["sea.systems[0]"])
    with pytest.raises(JobError, match=r"sea\.systems\[0\]\.measured\.tail must be between 1\.5"):
        measured_job({"file": WW3, "tail": 1.0})


def test_a_job_takes_the_depth_of_its_measured_file_unless_it_names_one():
    import xarray as xr

    with xr.open_dataset(WW3, engine="scipy") as raw:
        own = [float(d) for d in raw.dpt.values[0]]
    for site in (0, 1):
        job = measured_job({"file": WW3, "site": site})
        assert job.settings["sea.depth"] == job.sea().depth == own[site]
        assert job.describe()["sea.depth"] == own[site]  # what a manifest says
        assert (
            f"sea.depth is the file's own, {own[site]:g} m"
            in job.measured_notes()["sea.systems[0]"]
        )
    for named in (50.0, math.inf):
        job = measured_job({"file": WW3}, depth=named)
        assert job.sea().depth == named
        assert (
            f"sea.depth is {named:g} m; the file's own is {own[0]:g} m"
            in job.measured_notes()["sea.systems[0]"]
        )
    later = measured_job({"file": WW3}).replaced({"sea.depth": 50.0})
    assert later.sea().depth == 50.0
    assert measured_job({"file": WW3}).replaced({"ocean.n": 32}).sea().depth == own[0]


def test_the_wind_sea_stands_in_the_same_water():
    job = Job.from_tree(
        {"sea": {"wind": {"speed": 10.0}, "systems": [{"measured": {"file": WW3}}]}}
    )
    assert (
        job.sea().systems[0].spectrum.depth == job.sea().depth == pytest.approx(106.587, abs=1e-3)
    )


def test_measured_files_of_different_depths_need_one_named():
    with pytest.raises(
        JobError,
        match=r"sea\.depth must be given where measured files differ in it, got .* of "
        r"sea\.systems\[0\] and",
    ):
        measured_job({"file": WW3, "site": 0}, {"file": WW3, "site": 1})
    assert (
        measured_job({"file": WW3, "site": 0}, {"file": WW3, "site": 1}, depth=80.0).sea().depth
        == 80.0
    )
    assert measured_job({"file": WW3}, {"file": WW3, "time": 1}).sea().depth == pytest.approx(
        106.6, abs=0.5
    )


def test_a_file_without_depth_leaves_deep_water_and_says_so():
    job = measured_job({"file": str(SPECTRA_FILES / "swanfile.spec")})
    assert job.sea().depth == math.inf
    assert (
        "the file has no water depth; sea.depth is inf m" in job.measured_notes()["sea.systems[0]"]
    )


@pytest.mark.parametrize(
    ("table", "error", "message"),
    [
        (
            {"file": "none.nc"},
            ReaderError,
            r"sea\.systems\[1\]\.measured, file 'none\.nc': .* must be a file that exists",
        ),
        (
            {"file": WW3, "site": 2},
            JobError,
            r"sea\.systems\[1\]\.measured, file '.*ww3file\.nc': site must be .* got 2",
        ),
        (
            {"file": WW3, "time": 99},
            JobError,
            r"sea\.systems\[1\]\.measured, file '.*ww3file\.nc': time must be .* got 99",
        ),
        (
            {"file": str(SPECTRA_FILES / "44004w2000.txt")},
            JobError,
            r"sea\.systems\[1\]\.measured, file '.*44004w2000\.txt': the file has no directions; "
            r"beside `measured` a job must have direction",
        ),
        (
            {"file": str(SPECTRA_FILES / "README.md")},
            ReaderError,
            r"sea\.systems\[1\]\.measured, file '.*README\.md'",
        ),
        (
            {"file": str(SPECTRA_FILES)},
            ReaderError,
            r"sea\.systems\[1\]\.measured, file '.*': must be a file, got a directory",
        ),
    ],
)
def test_errors_of_measured_files_name_the_key_and_the_file(table, error, message):
    with pytest.raises(error, match=message):
        measured_job({"file": WW3}, table)


def test_what_was_assumed_of_a_measured_file_is_in_the_manifest_and_in_info(tmp_path, capsys):
    from fftocean.baking.finished.manifest import read_manifest
    from fftocean.cli import main

    tile = "[ocean]\nn = 16\nsize = 1000.0\nloop = 90.0\n[bake]\nframes = 1\nmaps = ['height']\n"
    (tmp_path / "job.toml").write_text(f"[[sea.systems]]\nmeasured = {{ file = '{WW3}' }}\n{tile}")
    job = Job.read(tmp_path / "job.toml")
    fo.bake(job, tmp_path / "out")
    manifest = read_manifest(tmp_path / "out")
    assert manifest["measured"] == job.measured_notes()
    assert "sea.depth is the file's own, 106.587 m" in manifest["measured"]["sea.systems[0]"]
    assert manifest["ocean"]["depth"] == job.settings["sea.depth"]
    assert fo.check(tmp_path / "out") == ()
    assert main(["info", str(tmp_path / "job.toml")]) == 0
    assert "sea.systems[0]: sea.depth is the file's own, 106.587 m" in " ".join(
        capsys.readouterr().out.split()
    )


# Files as editors write them


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_a_byte_order_mark_is_skipped(tmp_path, ending):
    """As Windows' editors write it; the job is the same, by file and by text."""
    text = ending.join(["# a comment", "[ocean]", "n = 48", ""])
    path = tmp_path / "job.toml"
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert (
        Job.read(path).settings
        == Job.from_toml(text).settings
        == Job.from_toml("\ufeff" + text).settings
    )


def test_a_byte_order_mark_elsewhere_is_no_toml(tmp_path):
    (tmp_path / "job.toml").write_bytes("[ocean]\n\ufeffn = 48\n".encode())
    with pytest.raises(JobError, match="must be TOML"):
        Job.read(tmp_path / "job.toml")


@pytest.mark.parametrize(
    ("key", "word", "meant"),
    [
        ("bake.engine", "godt", "godot"),
        ("bake.format", "EXR-Atls", "exr-atlas"),
        ("bake.maps", ["heigth"], "height"),
        ("ocean.amplitudes", "fixd", "fixed"),
    ],
)
def test_a_misspelt_value_is_answered_with_the_nearest(key, word, meant):
    with pytest.raises(JobError, match=rf"{key} must be .*; did you mean {meant}\?$"):
        Job.default().replaced({key: word})
    with pytest.raises(JobError, match=r"got 'xyzzy'$"):
        Job.default().replaced({key: ["xyzzy"] if isinstance(word, list) else "xyzzy"})


def test_settings_of_the_default_job_that_differ_from_the_defaults_are_stated():
    """The description of such a key, and the comment in the default job, name both values."""
    differing = {
        key: value for key, value in Job.default().settings.items() if value != BY_KEY[key].default
    }
    assert list(differing) == ["sea.wind.direction"]
    assert "the default job has 25" in BY_KEY["sea.wind.direction"].help
    text = Path(job_module.__file__).with_name("default.toml").read_text(encoding="utf-8")
    assert re.search(r"^direction = 25\.0 .* a job without it has 0$", text, re.MULTILINE)
