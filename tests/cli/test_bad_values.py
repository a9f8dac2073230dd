"""Refusal of bad values: in a job file, by --set, by a flag."""

import json
import time
from pathlib import Path

import numpy as np
import pytest
from command_line import SMALL, SWELL, refusal

import fftocean as fo
from fftocean.job.parameters import BY_KEY, PARAMETERS

BAD = ["nan", "inf", "-1", "0", '"5"', "true", "1e308", "1e-308"]


def refused_or_finite(result, key, value):
    """
    Assert a refusal with key, rule and value, or a bake without a NaN; return True if refused.
    """
    if result[0] == 2:
        message = refusal(result).lower().replace("e+", "e")
        for part in (key, "must ", value.strip('"').removesuffix(".0")):
            assert part in message
        return True
    assert result[0] == 0
    manifest = json.loads(Path("out/manifest.json").read_text(), parse_constant=pytest.fail)
    for values in fo.load("out").maps.values():
        assert np.all(np.isfinite(values))
    assert len(manifest["frames"]) >= 1
    return False


ACCEPTED = {
    "ocean.band_low": ("0", "1e-308"),
    "ocean.band_high": ("inf", "1e308", "1e-308"),
    "sea.wind.speed": ("0", "1e-308"),
    "sea.wind.direction": ("-1", "0", "1e-308"),
    "sea.wind.blend": ("0", "1e-308"),
    "sea.depth": ("inf", "1e308"),
    "sea.surface_tension": ("0", "1e-308"),
    "ocean.seed": ("0",),
    "ocean.choppiness": ("0", "1e-308"),
    "ocean.bound": ("0",),
    "bake.mips": ("true",),
    "bake.engine_files": ("true",),
    "bake.foam.threshold": ("-1", "0", "1e-308"),
    "bake.foam.strength": ("0", "1e-308"),
}


FLAGGED = [p for p in PARAMETERS if p.flag and not p.switch]  # a switch takes no value


def others(key):
    """
    Return flags that keep a bake small, but for the key in question; mip levels need a format that
    has room for them.
    """
    return [*(["--format", "ktx2"] if key == "bake.mips" else []), *_small(key)]


def _small(key):
    return [
        part
        for flag, small in (("n", "8"), ("frames", "1"))
        if key not in (f"ocean.{flag}", f"bake.{flag}")
        for part in (f"--{flag}", small)
    ]


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("key", BY_KEY)
def test_a_bad_value_by_set(run, key, value):
    assert refused_or_finite(
        run("bake", "-o", "out", *others(key), "--set", f"{key}={value}"), key, value
    ) == (value not in ACCEPTED.get(key, ()))


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("key", BY_KEY)
def test_a_bad_value_in_a_file(run, key, value):
    table, _, name = key.rpartition(".")
    Path("job.toml").write_text(f"[{table}]\n{name} = {value}\n")
    assert refused_or_finite(run("bake", "job.toml", "-o", "out", *others(key)), key, value) == (
        value not in ACCEPTED.get(key, ())
    )


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("parameter", FLAGGED, ids=lambda p: p.flag)
def test_a_bad_value_by_flag(run, parameter, value):
    key = parameter.key
    assert refused_or_finite(
        run("bake", "-o", "out", *others(key), f"--{parameter.flag}", value), key, value
    ) == (value not in ACCEPTED.get(key, ()))


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize(
    "key", ["spectrum.hs", "spectrum.tp", "spectrum.gamma", "spreading.s", "direction"]
)
def test_a_bad_value_in_a_wave_system(run, key, value):
    """One spectrum represents all here; tests/job/test_job.py tests each."""
    values = {
        "spectrum.hs": "0.5",
        "spectrum.tp": "4.0",
        "spectrum.gamma": "2.0",
        "spreading.s": "9.0",
        "direction": "30.0",
        key: value,
    }
    v = {k.replace(".", "_"): text for k, text in values.items()}
    text = "[[sea.systems]]\nspectrum = {{ kind = 'jonswap', hs = {spectrum_hs}, "
    text += "tp = {spectrum_tp}, gamma = {spectrum_gamma} }}\n"
    text += "spreading = {{ kind = 'cosine-power', s = {spreading_s} }}\ndirection = {direction}\n"
    Path("job.toml").write_text(text.format(**v))
    accepted = {
        "spectrum.hs": ("0", "1e-308"),
        "spreading.s": ("0", "1e-308"),
        "direction": ("-1", "0", "1e-308"),
    }.get(key, ())
    assert refused_or_finite(
        run("bake", "job.toml", "-o", "out", *SMALL), f"sea.systems[0].{key}", value
    ) == (value not in accepted)


@pytest.mark.parametrize("command", ["bake", "info", "verify", "plot"])
def test_every_command_refuses_the_same_values(run, command):
    assert "sea.wind.speed must be between 0 and 150 m/s, got -1.0" in refusal(
        run(command, "--set", "sea.wind.speed=-1")
    )


@pytest.mark.parametrize("command", ["bake", "info", "verify", "plot"])
def test_more_samples_than_memory_are_refused_before_they_are_allocated(run, command, monkeypatch):
    monkeypatch.setattr("fftocean.host.available_memory", lambda: 2.0**30)
    start = time.process_time()
    assert "n = 65536 x 65536 needs about " in refusal(run(command, "--n", "65536"))
    assert "between 1 and 65536, got 1000000000" in refusal(run(command, "--n", "1000000000"))
    assert "whole number" in refusal(run(command, "--n", "1e9"))
    assert "whole number" in refusal(run(command, "--n", "1.5"))
    assert time.process_time() - start < 2.0


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (
            "[sea.wind]\nsped = 3\n",
            ["job.toml", "unknown key 'sea.wind.sped'", "did you mean sea.wind.speed?"],
        ),
        ("[ocean]\nn = 8\nn = 9\n", ["job.toml", "TOML", "line 3"]),
        (f"[sea.wind]\nfetch = 1e4\n{SWELL}", ["sea.wind.speed must be given"]),
        ("ocean = 5\n", ["'ocean'"]),
        (
            "[[sea.systems]]\nspectrum = { kind = 'jonswap', \"a\\nb\\u001b[31m\" = 1.0 }\n",
            ["a\\nb\\x1b[31m"],
        ),
        ("a" * 100_000, ["at most 65536 bytes"]),
        (".".join("a" * 30_000) + " = 1", ["line 1", "at most 2048 characters"]),
        (".".join(['"\u2028"'] * 9000) + " = 1", ["line 1", "at most 2048 characters"]),
        ("#\n" * 40_000, ["at most 65536 bytes"]),
        ("n = " + "[" * 2000, ["nested"]),
        ("n = " + "{a = " * 400, ["nested"]),
        (b"\xff\xfe", ["UTF-8", "byte 0"]),
        (b"\0", ["TOML"]),
    ],
    ids=lambda v: repr(v[:20]),
)
def test_bad_files_are_refused_within_two_seconds(run, text, parts):
    Path("job.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
    start = time.process_time()
    message = refusal(run("bake", "job.toml", "-o", "out"))
    assert time.process_time() - start < 2.0
    for part in parts:
        assert part in message


@pytest.mark.parametrize(
    "path",
    [
        "/dev/zero",
        "/dev/full",
        "/dev/null",
        ".",
        "none.toml",
        "a\nb",
        "\udcff",
        "x" * 5000,
        "/dev/full/x",
        "[/red].toml",
        "",
    ],
)
def test_a_path_without_a_job_file_is_refused(run, path):
    refusal(run("bake", path, "-o", "out"))


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["--set", "a"], "a setting must be key=value"),
        (["--set", "=1"], "a setting must be key=value"),
        (["--set", "ocean.m=1"], "did you mean ocean.n?"),
        (["--set", "sea.systems=1"], "sea.systems must be given in a job file"),
        (["--set", "ocean.n=8\nocean.size=9"], "ocean.n must be a whole number"),
        (["--set", "ocean.n="], "ocean.n must be one value or two"),
        (["--set", "ocean.n=" + "[" * 1000], "ocean.n must be a whole number"),
        (["--n", ""], "ocean.n must be one value or two"),
        (["--n", "abc"], "got 'abc'"),
        (["--n", "8,0"], "between 1 and 65536, got 0"),
        (["--n", "8,8,8"], "one value or two"),
        (["--size=-inf"], "got -inf"),
        (["--maps", ""], "bake.maps must be a list"),
        (["--maps", "height,wrong"], "got 'wrong'"),
        (["--set", "bake.maps=wrong"], "got 'wrong'"),
        (["--seed", "18446744073709551616"], "got 18446744073709551616"),
    ],
)
def test_bad_arguments_are_refused(run, arguments, part):
    assert part in refusal(run("bake", "-o", "out", *arguments))


def test_a_key_of_a_wind_without_its_speed_is_refused(run):
    Path("swell.toml").write_text(SWELL)
    assert "sea.wind.speed must be given where sea.wind.gamma is" in refusal(
        run("bake", "swell.toml", "-o", "out", "--set", "sea.wind.gamma=2")
    )
