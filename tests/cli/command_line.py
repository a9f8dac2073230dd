"""Builders of the tests of the command line: small jobs, refusals, events."""

import dataclasses
import functools
import json
from pathlib import Path

import fftocean as fo

SHEETS = "fftocean.baking.previews.sheets"
SMALL = ("--n", "8", "--frames", "1")


SWELL = "[[sea.systems]]\nspectrum = { kind = 'jonswap', hs = 1.5, tp = 4.0 }\n"


def no_pictures(monkeypatch, size=7):
    """Replace each preview of a bake by some zeros."""
    monkeypatch.setattr(f"{SHEETS}.contact_sheet", lambda *_, **__: bytes(size))
    monkeypatch.setattr(f"{SHEETS}.animation", lambda *_, **__: bytes(size))


@functools.cache
def some_statistics(m0):
    """Return the statistics of one wave, as if a sea of variance m0 [m^2] had been specified."""
    from fftocean.statistics import SeaState  # slow to import: not while collecting

    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    return dataclasses.replace(
        still, specified=SeaState(m0=m0, hs=4.0 * m0**0.5, tp=5.0, mean_direction=0.0, spread=30.0)
    )


def refusal(result, folder="out"):
    """Return the message of a refusal: exit code 2, one line on stderr, no output, no folder."""
    code, out, err = result
    assert code == 2
    assert not out
    assert err.startswith("fftocean: ")
    assert err.endswith("\n")
    assert err.count("\n") == 1
    assert err.rstrip("\n").isprintable()
    assert not Path(folder).exists()
    return err


def events(out):
    """Return the events of a command's lines of JSON."""
    return [json.loads(line) for line in out.splitlines()]
