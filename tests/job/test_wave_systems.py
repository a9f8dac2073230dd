"""Wave systems of a job: each kind of spectrum and spreading with its keys, and measured files."""

import inspect
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean.limits import FRACTION, PERIOD
from fftocean.physics import spectra, spreading
from fftocean.physics.kinds import Choice, Kind, Part, Registry, Way
from fftocean.physics.spectra import SPECTRA, GammaSpectrum
from fftocean.physics.spreading import SPREADINGS, ElfouhailySpreading, TabulatedSpreading

DEPTH, TENSION = 30.0, 0.05
WATER = {"depth": DEPTH, "surface_tension": TENSION}
TABLE = [[1.0, 0.5, 0.2], [2.0, 0.1, 0.1]]
JONSWAP = "{ kind = 'jonswap', hs = 2.0, tp = 9.0 }"

# kind, keys as in a job file, and the same model of the library
SPECTRUM_CASES = [
    ("jonswap", "hs = 2, tp = 9, gamma = 5", fo.JONSWAP.from_sea_state(hs=2.0, tp=9.0, gamma=5.0)),
    ("jonswap", "speed = 9, fetch = 1e5", fo.JONSWAP.from_wind(speed=9.0, fetch=1e5)),
    (
        "jonswap",
        "speed = 9, fetch = 1e5, gamma = 2, growth = 'kahma-calkoen'",
        fo.JONSWAP.from_wind(speed=9.0, fetch=1e5, gamma=2.0, growth="kahma-calkoen"),
    ),
    ("tma", "hs = 1, tp = 6", fo.TMA.from_sea_state(hs=1.0, tp=6.0, depth=DEPTH)),
    (
        "tma",
        "hs = 1, tp = 6, gamma = 2",
        fo.TMA.from_sea_state(hs=1.0, tp=6.0, gamma=2.0, depth=DEPTH),
    ),
    (
        "tma",
        "speed = 9, fetch = 1e5, gamma = 2, growth = 'kahma-calkoen'",
        fo.TMA.from_wind(speed=9.0, fetch=1e5, gamma=2.0, depth=DEPTH, growth="kahma-calkoen"),
    ),
    (
        "tma",
        "spectrum = { kind = 'ochi-hubble', hs = 2 }",
        fo.TMA(fo.OchiHubble.most_probable(hs=2.0), DEPTH),
    ),
    ("pierson-moskowitz", "speed = 9", fo.PiersonMoskowitz.from_wind(speed=9.0)),
    ("pierson-moskowitz", "hs = 2, tp = 9", fo.PiersonMoskowitz.from_sea_state(hs=2.0, tp=9.0)),
    ("bretschneider", "hs = 2, tp = 9", fo.Bretschneider(hs=2.0, tp=9.0)),
    ("bretschneider", "hs = 2, t1 = 7", fo.Bretschneider.from_mean_period(hs=2.0, t1=7.0)),
    ("bretschneider", "hs = 2, tz = 7", fo.Bretschneider.from_zero_crossing_period(hs=2.0, tz=7.0)),
    (
        "gamma",
        "hs = 2, tp = 9, tail = 4, front = 3, gamma = 2, exact = false",
        GammaSpectrum(hs=2.0, tp=9.0, tail=4.0, front=3.0, gamma=2.0, exact=False),
    ),
    ("ochi-hubble", "hs = 4", fo.OchiHubble.most_probable(hs=4.0)),
    *(
        ("ochi-hubble", f"hs = 4, member = {i}", model)
        for i, model in enumerate(fo.OchiHubble.family(hs=4.0))
    ),
    (
        "ochi-hubble",
        "hs_low = 2, tp_low = 14, lambda_low = 3, hs_high = 1, tp_high = 6, lambda_high = 1",
        fo.OchiHubble(
            hs_low=2.0, tp_low=14.0, lambda_low=3.0, hs_high=1.0, tp_high=6.0, lambda_high=1.0
        ),
    ),
    ("torsethaugen", "hs = 4, tp = 11", fo.Torsethaugen(hs=4.0, tp=11.0)),
    (
        "torsethaugen",
        "hs = 4, tp = 11, form = 'full', exact = false",
        fo.Torsethaugen(hs=4.0, tp=11.0, form="full", exact=False),
    ),
    (
        "phillips",
        "hs = 1, speed = 8, cutoff = 0.1",
        fo.Phillips.from_height(hs=1.0, speed=8.0, cutoff=0.1, **WATER),
    ),
    (
        "phillips",
        "amplitude = 1e-3, speed = 8, cutoff = 0.1",
        fo.Phillips(amplitude=1e-3, speed=8.0, cutoff=0.1, **WATER),
    ),
    ("elfouhaily", "speed = 8", fo.Elfouhaily(speed=8.0, **WATER)),
    ("elfouhaily", "speed = 8, fetch = 9e4", fo.Elfouhaily(speed=8.0, fetch=9e4, **WATER)),
    ("beaufort", "number = 5", fo.presets.beaufort(5).spectrum(DEPTH)),
    ("sea-state", "number = 4", fo.presets.sea_state(4).spectrum(DEPTH)),
    (
        "tabulated",
        "frequency = [0.1, 0.2], density = [1.0, 2.0], tail = 4",
        fo.TabulatedSpectrum([0.1, 0.2], [1.0, 2.0], tail=4.0),
    ),
]
SPREADING_CASES = [
    ("cosine-squared", "", fo.CosineSquared()),
    ("cosine-power", "s = 20", fo.CosinePower(s=20.0)),
    ("cosine-n", "n = 4", fo.CosineN(n=4.0)),
    ("donelan-banner", "", fo.DonelanBanner()),
    ("mitsuyasu", "speed = 9", fo.Mitsuyasu(speed=9.0)),
    ("goda-suzuki", "s_max = 25", fo.GodaSuzuki(s_max=25.0)),
    ("hasselmann", "speed = 9", fo.Hasselmann(speed=9.0)),
    ("long-crested", "", fo.LongCrested()),
    ("wrapped-normal", "spread = 20", fo.WrappedNormal(spread=20.0)),
    ("swell", "", fo.SwellElongation(fo.DonelanBanner(), xi=0.5)),
    (
        "swell",
        "xi = 0.7, base = { kind = 'hasselmann', speed = 9 }",
        fo.SwellElongation(fo.Hasselmann(speed=9.0), xi=0.7),
    ),
    ("blend", "weight = 0.2", fo.Blend(fo.DonelanBanner(), fo.CosineSquared(), weight=0.2)),
    (
        "blend",
        "first = { kind = 'long-crested' }, second = { kind = 'swell', xi = 1 }",
        fo.Blend(fo.LongCrested(), fo.SwellElongation(xi=1.0), weight=0.5),
    ),
    (
        "tabulated",
        f"frequency = [0.1, 0.2], direction = [-90, 0, 90], density = {TABLE}",
        TabulatedSpreading(frequency=[0.1, 0.2], direction=[-90.0, 0.0, 90.0], density=TABLE),
    ),
    (
        "elfouhaily",
        "speed = 8, both_ways = true",
        ElfouhailySpreading(
            friction_velocity=fo.Elfouhaily(speed=8.0).friction_velocity, both_ways=True, **WATER
        ),
    ),
    (
        "elfouhaily",
        "friction_velocity = 0.3, both_ways = true",
        ElfouhailySpreading(friction_velocity=0.3, both_ways=True, **WATER),
    ),
]
SPECTRA_FILES = Path(__file__).parents[1] / "data" / "spectra"
SHALLOW = f"[sea]\ndepth = {DEPTH}\nsurface_tension = {TENSION}\n[[sea.systems]]\n"


def table(kind, keys):
    return f"{{ kind = '{kind}'{', ' if keys else ''}{keys} }}"


def keys_of(toml):
    """Return the keys of an inline table, without those of the tables within."""
    return set(tomllib.loads(f"x = {{ {toml} }}")["x"])


# One model of each kind


@pytest.mark.parametrize(("kind", "keys", "model"), SPECTRUM_CASES)
def test_a_named_spectrum_is_the_one_of_the_library(kind, keys, model):
    job = fo.Job.from_toml(f"{SHALLOW}direction = 40.0\nspectrum = {table(kind, keys)}")
    (system,) = job.sea().systems
    assert system.direction == 40.0
    assert system.spectrum == model
    omega = model.peak * np.geomspace(0.3, 10.0, 50)
    assert np.array_equal(system.spectrum(omega), model(omega))


@pytest.mark.parametrize(("kind", "keys", "model"), SPREADING_CASES)
def test_a_named_spreading_is_the_one_of_the_library(kind, keys, model):
    job = fo.Job.from_toml(f"{SHALLOW}spectrum = {JONSWAP}\nspreading = {table(kind, keys)}")
    assert job.sea().systems[0].spreading == model


@pytest.mark.parametrize(
    ("kinds", "cases"), [(SPECTRA, SPECTRUM_CASES), (SPREADINGS, SPREADING_CASES)]
)
def test_every_key_of_every_way_is_tried_above(kinds, cases):
    tried = [(kind, keys_of(keys)) for kind, keys, _ in cases]
    for name, kind in kinds.items():
        for way in kind.ways:
            fitting = [keys for other, keys in tried if other == name and way.fits(keys)]
            assert fitting, f"{name} {way}"
            assert set().union(*fitting) == set(way.keys), f"{name} {way}"
    assert {type(model) for _, _, model in cases} == {kind.model for kind in kinds.values()}


def models_of(package, protocol):
    """Return the public classes of a package, and of `fftocean`, that are called like a model."""
    places = [vars(package), {name: getattr(fo, name) for name in fo.__all__}]
    classes = {value for place in places for value in place.values() if inspect.isclass(value)}
    own = {c for c in classes if c.__module__.startswith(f"{package.__name__}.")}
    return {c for c in own if any("__call__" in vars(base) for base in c.__mro__)} - {protocol}


@pytest.mark.parametrize(
    ("package", "kinds", "unnamed"),
    [
        (spectra, SPECTRA, {fo.CustomSpectrum}),  # TOML has no functions
        (spreading, SPREADINGS, {fo.CustomSpreading}),
    ],
)
def test_every_public_model_can_be_named(package, kinds, unnamed):
    protocol = spectra.FrequencySpectrum if package is spectra else spreading.Spreading
    classes = models_of(package, protocol)
    assert len(classes) > 10
    assert classes - unnamed == {kind.model for kind in kinds.values()}


def test_every_part_has_a_role_that_is_known():
    for kinds in (SPECTRA, SPREADINGS):
        for kind in kinds.values():
            for way in kind.ways:
                parts = [rule.role for rule in way.keys.values() if isinstance(rule, Part)]
                assert set(parts) <= {"spectrum", "spreading"}


# An incomplete kind


def make(*, hs: float, gamma: float = 3.3, depth: float = 1.0) -> float:
    return hs + gamma + depth


@pytest.mark.parametrize(
    "keys", [{}, {"gamma": FRACTION}, {"hs": FRACTION, "gama": FRACTION}, {"water": ("wind",)}]
)
def test_a_way_must_have_the_parameters_of_its_constructor(keys):
    with pytest.raises(TypeError, match="make must take the keys"):
        Way(make, **{"hs": FRACTION, **keys} if "water" in keys else keys)


def test_the_keys_of_a_way_with_defaults_are_optional():
    way = Way(make, water=("depth",), hs=FRACTION, gamma=FRACTION)
    assert way.required == {"hs"}
    assert str(way) == "{hs, [gamma]}"
    fitting = [set(), {"hs"}, {"hs", "gamma"}, {"gamma"}, {"hs", "depth"}]
    assert [way.fits(keys) for keys in fitting] == [False, True, True, False, False]


def test_a_kind_must_be_complete():
    way = Way(make, hs=FRACTION)
    with pytest.raises(TypeError, match="must have a way to be made"):
        Kind("thing", float)
    with pytest.raises(TypeError, match=r"'thing' must tell \{hs, \[gamma\]\} from \{hs\}"):
        Kind("thing", float, way, Way(make, hs=FRACTION, gamma=FRACTION))
    for name in ("", "Thing", "a thing", "-thing"):
        with pytest.raises(TypeError, match="must be lower-case words"):
            Kind(name, float, way)


def test_a_name_is_registered_once():
    kinds = Registry("thing")
    kinds.add("one", float, Way(make, hs=FRACTION))
    with pytest.raises(TypeError, match="the thing 'one' must be registered once"):
        kinds.add("one", float, Way(make, hs=FRACTION))
    assert dict(kinds) == {"one": kinds["one"]}
    assert len(kinds) == 1


def test_a_registered_spectrum_can_be_named(monkeypatch):
    """One call of `add` beside a new family is all that a job file needs."""
    monkeypatch.setattr(SPECTRA, "_kinds", dict(SPECTRA))

    def narrow(*, tp: float) -> fo.CustomSpectrum:
        peak = 2.0 * np.pi / tp
        return fo.CustomSpectrum(lambda omega: np.exp(-((omega / peak - 1.0) ** 2)), peak=peak)

    SPECTRA.add("narrow", fo.CustomSpectrum, Way(narrow, tp=PERIOD))
    job = fo.Job.from_toml("[[sea.systems]]\nspectrum = { kind = 'narrow', tp = 8.0 }")
    assert job.sea().systems[0].spectrum.peak == 2.0 * np.pi / 8.0


def test_a_choice_is_one_of_its_words_in_any_case():
    choice = Choice(("simplified", "full"))
    assert choice.check("form", " Full ") == "full"
    for bad in ("half", 5, None, ["full"]):
        with pytest.raises(fo.ParameterError, match="form must be one of simplified, full, got "):
            choice.check("form", bad)


# The tables of a job


def test_a_calm_is_no_system():
    job = fo.Job.from_toml("[[sea.systems]]\nspectrum = { kind = 'beaufort', number = 0 }")
    assert job.sea().systems == ()


def test_a_measured_file_is_looked_up_beside_the_job(tmp_path):
    """The file's name starts from the job's own folder; the sea is that of the reader."""
    name = "wavespectra.nc"
    shutil.copy(SPECTRA_FILES / name, tmp_path / name)
    job = tmp_path / "job.toml"
    job.write_text(f"[[sea.systems]]\nmeasured = {{ file = '{name}', time = 1 }}\n")
    assert fo.Job.read(job).sea().hs == pytest.approx(
        fo.Sea.from_spectrum(fo.readers.open(tmp_path / name), time=1).hs, rel=1e-12
    )


def nested(levels):
    return table("swell", f"base = {nested(levels - 1)}" if levels else "")


def test_models_are_nested_only_so_deep():
    job = f"[[sea.systems]]\nspectrum = {JONSWAP}\nspreading = "
    fo.Job.from_toml(job + nested(3))
    with pytest.raises(fo.JobError, match="must have at most 8 models within one another"):
        fo.Job.from_toml(job + nested(12))


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
        (
            "spectrum = { kind = 'torsethaugen', hs = 3.0 }",
            r"must have the keys \{hs, tp, \[form\], \[exact\]\}, got \{hs\}",
        ),
        (
            "spectrum = { kind = 'ochi-hubble', hs = 3.0, member = 11 }",
            "spectrum.member must be a whole number between 0 and 10, got 11",
        ),
        (
            "spectrum = { kind = 'torsethaugen', hs = 3.0, tp = 9.0, form = 'half' }",
            "spectrum.form must be one of simplified, full, got 'half'",
        ),
        (
            "spectrum = { kind = 'tma', spectrum = { kind = 'beaufort', number = 0 } }",
            r"sea.systems\[0\].spectrum.spectrum must have waves, got a calm",
        ),
        (
            f"spectrum = {JONSWAP}\nspreading = {{ kind = 'blend', first = {{ kind = 'jon' }} }}",
            r"spreading.first must be a table whose kind is one of blend, .*, got 'jon'",
        ),
        (
            f"spectrum = {JONSWAP}\nspreading = {{ kind = 'swell', base = 'blend' }}",
            r"spreading.base must be a table whose kind is one of blend, .*, got 'blend'",
        ),
    ],
)
def test_an_impossible_system_is_refused(text, rule):
    with pytest.raises(fo.ParameterError, match=rule):
        fo.Job.from_toml(f"[[sea.systems]]\n{text}\n")
