"""
Public values show themselves briefly, and public functions refuse what is none of theirs by its
name.
"""

import warnings
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean.baking.cascade import bake_tiles
from fftocean.physics.spreading import TabulatedSpreading

TABLE = fo.TabulatedSpectrum(np.linspace(0.05, 0.5, 64), np.ones(64))


def DISH(omega, theta, peak):  # noqa: ARG001 - a spreading of one's own
    return np.cos(theta) ** 2


ROSE = TabulatedSpreading(
    frequency=np.linspace(0.05, 0.5, 32).tolist(),
    direction=np.arange(0.0, 360.0, 5.0).tolist(),
    density=np.ones((32, 72)).tolist(),
)
PEAK = fo.JONSWAP(peak=1.0)
MODELS = (
    *(PEAK, fo.PiersonMoskowitz(peak=1.0), fo.TMA(PEAK, 10.0), fo.Bretschneider(hs=1.0, tp=5.0)),
    *(fo.Elfouhaily(speed=9.0), fo.Phillips(speed=9.0, amplitude=1e-3)),
    *(fo.Torsethaugen(hs=3.0, tp=9.0), fo.CustomSpectrum(PEAK, peak=1.0)),
    fo.OchiHubble(
        hs_low=1.0, tp_low=9.0, lambda_low=3.0, hs_high=1.0, tp_high=5.0, lambda_high=1.0
    ),
    *(fo.CosineN(n=4.0), fo.CosinePower(8.0), fo.CosineSquared(), fo.DonelanBanner()),
    *(fo.GodaSuzuki(10.0), fo.Hasselmann(9.0), fo.LongCrested(), fo.Mitsuyasu(9.0)),
    *(fo.SwellElongation(), fo.WrappedNormal(20.0), fo.Blend(), fo.CustomSpreading(DISH)),
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
    tiles = [(16, 60.0), (16, 17.0)]
    bake_tiles(job.replaced({"bake.maps": ["height"]}), tiles, folder / "tiles", executor="serial")
    fixes = [fo.Fix("height", 20.0, 12.0 * i, 0.0, 0.1) for i in range(4)]
    rogue = fo.constrained(ocean, fo.Crest(height=1.0), *fixes)
    fo.export_sea(ocean, folder / "package")
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
        "baked cascade": fo.load(folder / "tiles"),
        "rarity": rogue.rarity,
        "crest": fo.Crest(height=1.0),
        "fix": fixes[0],
        "series": fo.series(ocean, np.zeros(40), np.zeros(40), np.arange(99.0)),
        "window": fo.Window(cascade, n=8, size=10.0),
        "window frame": fo.Window(cascade, n=8, size=10.0).frame(0.0),
        "finding": fo.Finding("missing", "height/0000.exr", "does not exist"),
        "sea state": fo.measure(ocean).specified,
        "loop error": fo.measure(ocean).loop,
        "read package": fo.load_sea(folder / "package"),
        "grid of OpenFAST": fo.export.SeaStateGrid(
            x_half_width=10, y_half_width=5, z_depth=4, nx=2, ny=2, nz=2
        ),
        **{type(model).__name__: model for model in MODELS},
    }


KINDS = [
    *["sea", "system", "table", "rose", "ocean", "cascade", "amplitudes", "modes", "grid", "frame"],
    *["eulerian", "eulerian frame", "query", "query of modes", "answer", "statistics", "folding"],
    *["kinematics", "surface", "one place", "foam", "live foam", "check", "preset", "job", "bake"],
]
WRONG = tuple(KINDS)  # what functions are given that is none of theirs
KINDS += [
    *["baked cascade", "rarity", "crest", "fix", "series", "window", "window frame", "finding"],
    *["sea state", "loop error", "read package", "grid of OpenFAST"],
    *(type(model).__name__ for model in MODELS),
]


def test_every_public_kind_is_among_them(values):
    """All classes of the package's own names, but for its exceptions and warnings."""
    public = {getattr(fo, name) for name in fo.__all__}
    kinds = {kind for kind in public if isinstance(kind, type)}
    kinds -= {kind for kind in kinds if issubclass(kind, (Exception, Warning))}
    assert kinds - {type(value) for value in values.values()} == set()
    assert set(KINDS) == set(values)


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
    "minimum_eigenvalue": (fo.minimum_eigenvalue, ("frame",)),
    "constrained": (lambda v: fo.constrained(v, fo.Crest(height=1.0)), ("ocean", "cascade")),
    "constrained values": (
        lambda v: fo.constrained(fo.Ocean(fo.Sea(), n=8, size=50.0), v),
        (),
    ),
    "crest_height": (lambda v: fo.crest_height(v, 3600.0), ("ocean", "cascade")),
    "export_sea": (lambda v: fo.export_sea(v, "never"), ("ocean", "cascade")),
    "load_sea": (fo.load_sea, ("path",)),
    "series": (lambda v: fo.series(v, 0.0, 0.0, [0.0]), ("ocean", "cascade", "modes")),
    "series fields": (lambda v: fo.series(fo.Ocean(fo.Sea(), n=8, size=50.0), 0, 0, [0.0], v), ()),
    "from_compass": (fo.from_compass, ("number",)),
    "Window": (lambda v: fo.Window(v, n=8, size=10.0), ("ocean", "cascade")),
    "Foam.live": (lambda v: fo.Foam().live(v), ("ocean", "cascade")),
    "Foam.whitecaps": (lambda v: fo.Foam.whitecaps(v, 9.0), ("ocean", "cascade")),
    "Foam.covering": (lambda v: fo.Foam.covering(v, 0.1), ("ocean", "cascade")),
    "stokes_drift": (lambda v: fo.kinematics.stokes_drift(v, 0.0), ("ocean", "cascade", "modes")),
    "readers.open": (fo.readers.open, ()),
    "readers.nearest_time": (lambda v: fo.readers.nearest_time(v, "2020-01-01"), ()),
    "Sea.from_spectrum": (fo.Sea.from_spectrum, ()),
    "export.swd": (lambda v: fo.export.swd(v, "never.swd"), ("ocean", "cascade")),
    "export.components": (
        lambda v: fo.export.components(v, "never.csv"),
        ("ocean", "cascade", "modes"),
    ),
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
    "load": (fo.load, ("path",)),
    "check": (fo.check, ("path",)),
    "repair": (fo.repair, ("path",)),
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
        "path": "never/sea.toml",
        "bytes": b"sea",
    }
    for kind, value in {**{kind: values[kind] for kind in WRONG}, **others}.items():
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
