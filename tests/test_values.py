"""
Public values show themselves briefly, and public functions refuse what is none of theirs by its
name.
"""

import warnings
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean.physics.spreading import TabulatedSpreading

TABLE = fo.TabulatedSpectrum(np.linspace(0.05, 0.5, 64), np.ones(64))
ROSE = TabulatedSpreading(
    frequency=np.linspace(0.05, 0.5, 32).tolist(),
    direction=np.arange(0.0, 360.0, 5.0).tolist(),
    density=np.ones((32, 72)).tolist(),
)


@pytest.fixture(scope="module")
def values(tmp_path_factory):
    """One of each public kind, larger than it need be."""
    system = fo.WaveSystem(spectrum=TABLE, spreading=ROSE)
    wind = fo.Sea.from_wind(speed=9.0, fetch=1e5).systems[0]
    sea = fo.Sea(*[system, wind] * 8)
    ocean = fo.Ocean(fo.Sea(system), n=32, size=60.0, loop=200.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        cascade = fo.Cascade(fo.Sea(wind), [(32, 60.0 * 0.31**i) for i in range(5)])
    folder = tmp_path_factory.mktemp("bake") / "out"
    changes = {
        "ocean.n": 16,
        "bake.frames": 3,
        "bake.pictures": [],
        "bake.maps": ["height", "normal", "jacobian"],
    }
    job = fo.Job.default().replaced(changes)
    fo.bake(job, folder, executor="serial")
    points = np.zeros((40, 30))
    return {
        "sea": sea,
        "system": system,
        "table": TABLE,
        "rose": ROSE,
        "ocean": ocean,
        "cascade": cascade,
        "amplitudes": ocean.amplitudes,
        "modes": ocean.modes(),
        "grid": ocean.grid,
        "frame": ocean.frame(0.0),
        "eulerian": fo.Eulerian(ocean),
        "eulerian frame": fo.Eulerian(ocean).frame(0.0),
        "query": fo.Query(cascade),
        "query of modes": fo.Query(ocean.modes()),
        "answer": fo.Query(ocean).at(points, points, 0.0),
        "statistics": fo.measure(ocean),
        "folding": fo.folding(ocean.frame(0.0)),
        "kinematics": fo.kinematics.at(ocean, points, points, -1.0, 0.0),
        "surface": fo.gerstner.surface(ocean, points, points, 0.0),
        "one place": fo.gerstner.surface(ocean, 0.0, 0.0, 0.0),
        "foam": fo.Foam(),
        "live foam": fo.Foam().live(ocean),
        "check": fo.verify(ocean)[0],
        "preset": fo.presets.beaufort(5),
        "job": job,
        "bake": fo.load(folder),
    }


KINDS = [
    *["sea", "system", "table", "rose", "ocean", "cascade", "amplitudes", "modes", "grid", "frame"],
    *["eulerian", "eulerian frame", "query", "query of modes", "answer", "statistics", "folding"],
    *["kinematics", "surface", "one place", "foam", "live foam", "check", "preset", "job", "bake"],
]


@pytest.mark.parametrize("kind", KINDS)
def test_values_show_themselves_briefly(values, kind):
    text = repr(values[kind])
    assert text.startswith(type(values[kind]).__name__ + "(")
    assert text.endswith(")")
    assert len(text) <= 300
    assert "\n" not in text
    assert " object at 0x" not in text


def test_what_they_show(values):
    assert "3 frames of height 3 x 16 x 16 x 1, normal 3 x 16 x 16 x 3" in repr(values["bake"])
    assert "forward=<32 x 17 complex128>" in repr(values["amplitudes"])
    assert "13 more systems" in repr(values["sea"])
    assert (
        "a wind sea, n=16, size=100.0, 3 frames of height, normal, jacobian as exr for canonical"
        in repr(values["job"])
    )
    assert "TabulatedSpectrum(64 frequencies, 0.05 to 0.5 Hz" in repr(values["system"])


CALLS = {
    "measure": (fo.measure, ("ocean", "cascade")),
    "Query": (fo.Query, ("ocean", "cascade", "modes")),
    "Ocean": (lambda v: fo.Ocean(v, n=8, size=50.0), ("sea",)),
    "Ocean.from_modes": (lambda v: fo.Ocean.from_modes(v, n=8, size=50.0), ("modes",)),
    "Ocean amplitudes": (lambda v: fo.Ocean(fo.Sea(), n=8, size=50.0, amplitudes=v), ()),
    "Ocean.frames": (
        lambda v: next(fo.Ocean.from_modes([], n=8, size=50.0).frames(v, ahead=0)),
        ("list", "bytes"),
    ),
    "Cascade": (lambda v: fo.Cascade(v, [(32, 60.0), (32, 20.0)]), ("sea",)),
    "Eulerian": (fo.Eulerian, ("ocean",)),
    "to_xarray": (lambda v: fo.to_xarray(v, [0.0]), ("ocean", "cascade")),
    "verify": (fo.verify, ("ocean",)),
    "normals": (fo.normals, ("frame", "eulerian frame")),
    "jacobian": (fo.jacobian, ("frame",)),
    "folding": (fo.folding, ("frame",)),
    "gerstner.surface": (lambda v: fo.gerstner.surface(v, 0.0, 0.0, 0.0), ("ocean", "cascade")),
    "kinematics.at": (
        lambda v: fo.kinematics.at(v, 0.0, 0.0, -1.0, 0.0),
        ("ocean", "cascade", "modes"),
    ),
    "moments.moment": (lambda v: fo.moments.moment(v, 0), ("sea", "table")),
    "moments.peak_period": (fo.moments.peak_period, ("sea", "table")),
    "Sea": (fo.Sea, ("system",)),
    "WaveSystem": (lambda v: fo.WaveSystem(spectrum=v), ("sea", "table")),
    "TMA": (lambda v: fo.TMA(v, 10.0), ("sea", "table")),
    "bake": (lambda v: fo.bake(v, "never"), ("job",)),
    "load": (fo.load, ()),
    "check": (fo.check, ()),
    "repair": (fo.repair, ()),
    "Job.read": (fo.Job.read, ()),
    "Job.from_toml": (fo.Job.from_toml, ()),
    "Job.replaced": (fo.Job.default().replaced, ()),
}


@pytest.mark.parametrize("name", CALLS)
def test_wrong_objects_are_refused_by_name(values, name, tmp_path, monkeypatch):
    """
    Anything that is not theirs: an error of the package's own, on one line, that says what it got.
    """
    monkeypatch.chdir(tmp_path)
    call, welcome = CALLS[name]
    others = {
        "none": None,
        "number": 3,
        "array": np.zeros((3, 3)),
        "class": fo.Ocean,
        "list": [1, 2],
        "bytes": b"sea",
    }
    for kind, value in {**values, **others}.items():
        if kind in welcome:
            continue
        with pytest.raises((fo.ParameterError, fo.FieldError)) as refused:
            call(value)
        message = str(refused.value)
        assert "\n" not in message, kind
        assert len(message) < 400, kind
    assert not list(Path().iterdir())


def test_messages_name_what_came(values):
    with pytest.raises(
        fo.ParameterError, match=r"must be an Ocean or a Cascade, got Sea\(TabulatedSpectrum"
    ):
        fo.measure(values["sea"])
    with pytest.raises(fo.ParameterError, match="sea must be a Sea, got TabulatedSpectrum"):
        fo.Ocean(TABLE, n=8, size=50.0)
    with pytest.raises(
        fo.ParameterError,
        match=r"frame must be a Frame, such as ocean.frame\(t\), got Ocean\(32 x 32",
    ):
        fo.normals(values["ocean"])
    with pytest.raises(fo.ParameterError, match="got the class Ocean"):
        fo.measure(fo.Ocean)
    with pytest.raises(fo.ParameterError, match=r"folder must be a path, .* got 3 \(int\)"):
        fo.load(3)
    with pytest.raises(fo.ParameterError, match=r"take system\.spectrum"):
        fo.moments.moment(values["system"], 0)
