"""
Every kind of wave system that a job can name becomes the model of that name, with the numbers that
were given.
"""

import shutil
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean.job.wave_systems import SPREADINGS, spectra_in

SPECTRA = {
    "jonswap": (
        "hs = 2.0, tp = 9.0, gamma = 5.0",
        fo.JONSWAP.from_sea_state(hs=2.0, tp=9.0, gamma=5.0),
    ),
    "tma": ("hs = 1.0, tp = 6.0", fo.TMA.from_sea_state(hs=1.0, tp=6.0, depth=30.0)),
    "pierson-moskowitz": ("speed = 9.0", fo.PiersonMoskowitz.from_wind(speed=9.0)),
    "bretschneider": ("hs = 2.0, tp = 9.0", fo.Bretschneider(hs=2.0, tp=9.0)),
    "ochi-hubble": ("hs = 4.0", fo.OchiHubble.most_probable(hs=4.0)),
    "torsethaugen": ("hs = 4.0, tp = 11.0", fo.Torsethaugen(hs=4.0, tp=11.0)),
    "phillips": ("hs = 1.0, speed = 8.0", fo.Phillips.from_height(hs=1.0, speed=8.0, depth=30.0)),
    "elfouhaily": (
        "speed = 8.0, fetch = 9e4",
        fo.Elfouhaily(speed=8.0, fetch=9e4, depth=30.0, surface_tension=0.0),
    ),
    "beaufort": ("number = 5", fo.presets.beaufort(5).spectrum(30.0)),
    "sea-state": ("number = 4", fo.presets.sea_state(4).spectrum(30.0)),
    "tabulated": (
        "frequency = [0.1, 0.2], density = [1.0, 2.0]",
        fo.TabulatedSpectrum([0.1, 0.2], [1.0, 2.0]),
    ),
}
SPREAD = {
    "cosine-squared": ("", fo.CosineSquared()),
    "cosine-power": ("s = 20.0", fo.CosinePower(s=20.0)),
    "cosine-n": ("n = 4.0", fo.CosineN(n=4.0)),
    "donelan-banner": ("", fo.DonelanBanner()),
    "mitsuyasu": ("speed = 9.0", fo.Mitsuyasu(speed=9.0)),
    "hasselmann": ("speed = 9.0", fo.Hasselmann(speed=9.0)),
    "long-crested": ("", fo.LongCrested()),
    "wrapped-normal": ("spread = 20.0", fo.WrappedNormal(spread=20.0)),
    "swell": ("xi = 0.7", fo.SwellElongation(fo.DonelanBanner(), xi=0.7)),
    "blend": ("weight = 0.2", fo.Blend(fo.DonelanBanner(), fo.CosineSquared(), weight=0.2)),
}
SPECTRA_FILES = Path(__file__).parents[1] / "data" / "spectra"


def table(kind, keys):
    return f"{{ kind = '{kind}'{', ' if keys else ''}{keys} }}"


def test_every_kind_is_tried_here():
    assert set(SPECTRA) == set(spectra_in(30.0, 0.0))
    assert set(SPREAD) == set(SPREADINGS)


@pytest.mark.parametrize("kind", SPECTRA)
def test_spectra(kind):
    keys, model = SPECTRA[kind]
    job = fo.Job.from_toml(
        f"[sea]\ndepth = 30.0\n[[sea.systems]]\ndirection = 40.0\nspectrum = {table(kind, keys)}"
    )
    (system,) = job.sea().systems
    assert system.direction == 40.0
    omega = model.peak * np.geomspace(0.3, 10.0, 50)
    assert np.array_equal(system.spectrum(omega), model(omega))


@pytest.mark.parametrize("kind", SPREAD)
def test_spreadings(kind):
    keys, model = SPREAD[kind]
    job = fo.Job.from_toml(
        f"[[sea.systems]]\nspectrum = {{ kind = 'jonswap', hs = 1.0, tp = 7.0 }}\nspreading = {table(kind, keys)}"
    )
    assert job.sea().systems[0].spreading == model


def test_a_calm_is_no_system():
    assert (
        fo.Job.from_toml("[[sea.systems]]\nspectrum = { kind = 'beaufort', number = 0 }")
        .sea()
        .systems
        == ()
    )


def test_a_measured_file_beside_the_job(tmp_path):
    """The file's name starts from the job's own folder; the sea is that of the reader."""
    name = "wavespectra.nc"
    shutil.copy(SPECTRA_FILES / name, tmp_path / name)
    job = tmp_path / "job.toml"
    job.write_text(f"[[sea.systems]]\nmeasured = {{ file = '{name}', time = 1 }}\n")
    assert fo.Job.read(job).sea().hs == pytest.approx(
        fo.Sea.from_spectrum(fo.readers.open(tmp_path / name), time=1).hs, rel=1e-12
    )


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("measured = { file = 'nowhere.nc' }", "nowhere.nc"),
        ("measured = { time = 1 }", r"sea.systems\[0\].measured must be a table with a file"),
        ("measured = { file = 3 }", "measured must be a table with a file"),
        ("measured = { file = 'x.nc', time = 0.5 }", "measured.time must be a whole number"),
        (
            "measured = { file = 'x.nc' }\nspectrum = { kind = 'tma', hs = 1.0, tp = 5.0 }",
            "not both",
        ),
        (
            "spectrum = { kind = 'beaufort', number = 13 }",
            "number must be a whole number between 0 and 12, got 13",
        ),
        ("spectrum = { kind = 'torsethaugen', hs = 3.0 }", "must have the keys {hs, tp}"),
    ],
)
def test_what_cannot_be_is_refused(text, rule):
    with pytest.raises(fo.ParameterError, match=rule):
        fo.Job.from_toml(f"[[sea.systems]]\n{text}\n")
