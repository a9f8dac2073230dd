"""Verification: right oceans pass every check, and each fault fails the check of its quantity."""

import math
import sys

import numpy as np
import pytest

import fftocean as fo
from fftocean import noise, proof
from fftocean.cells import Cells
from fftocean.cli import main
from fftocean.fields import FIELDS

pytestmark = [pytest.mark.nojit, pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")]

DEEP = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
SHALLOW = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=5.0, direction=-160.0)
SWELL = fo.Sea(
    fo.WaveSystem(
        spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=11.0, gamma=7.0),
        spreading=fo.CosinePower(s=40.0),
        direction=110.0,
    ),
    fo.WaveSystem(
        spectrum=fo.TMA.from_sea_state(hs=1.0, tp=5.0, depth=30.0),
        spreading=fo.CosineSquared(),
        direction=-20.0,
    ),
    depth=30.0,
)
BOX = fo.Sea(
    fo.WaveSystem(
        spectrum=fo.TabulatedSpectrum([0.1, 0.2], [1.0, 2.0]),
        spreading=fo.CosinePower(s=20.0),
        direction=34.0,
    )
)
WAVES = [
    (1, 0, 0.5, 0.3),
    (0, 2, 0.2, -1.0),
    (-3, 1, 0.1, 2.0),
    (2, -4, 0.05, 0.7),
    (-1, -1, 0.3, 0.0),
    (-1, 0, 0.2, 1.0),
]


def ocean(sea=DEEP, **arguments):
    return fo.Ocean(
        sea, **{"n": 16, "size": 150.0, "seed": 3, "loop": 60.0, "dtype": "float64", **arguments}
    )


def few(**arguments):
    """Return an ocean of six given waves, on which all but the sea's energy is verified quickly."""
    return fo.Ocean.from_modes(
        WAVES,
        **{"n": (16, 12), "size": (80.0, 60.0), "loop": 20.0, "dtype": "float64", **arguments},
    )


def failed(ocean, t=3.7):
    return [c.name for c in fo.verify(ocean, t) if not c.passed]


POINTWISE = {
    "normal": ("slope_x", "slope_y", "stretch_xx", "stretch_xy", "stretch_yy"),
    "jacobian": ("stretch_xx", "stretch_xy", "stretch_yy"),
}
NAMES = [
    *FIELDS,
    "jacobian",
    "normal",
    "seam",
    "loop, frame j + F",
    "loop, frame j",
    "loop, t = T",
    "loop of the waves",
    "Parseval",
    "mean level",
]
ENERGY = ["m0 of the frame", "energy resolved + lost", "m0 of this realisation"]


# Right oceans


@pytest.mark.parametrize(
    "case",
    [
        lambda: ocean(dtype="float32", n=40),
        lambda: ocean(n=64, loop=None),
        lambda: ocean(n=31, size=97.0),
        lambda: ocean(SHALLOW, n=(48, 80), size=(100.0, 230.0)),
        lambda: ocean(SHALLOW, n=(48, 80), dtype="float32", loop=None, amplitudes="fixed"),
        lambda: ocean(SWELL, n=32, size=500.0, amplitudes="fixed"),
        lambda: ocean(n=2),
        lambda: ocean(n=3),
        lambda: ocean(n=(1, 33)),
        lambda: ocean(fo.Sea.from_wind(speed=0.0, fetch=1e4), dtype="float32"),
        lambda: ocean(BOX, n=64, size=63.3),
    ],
    ids=[
        "float32",
        "free",
        "31",
        "48x80 5 m",
        "float32 5 m fixed",
        "swell",
        "2",
        "3",
        "1x33",
        "flat",
        "cut",
    ],
)
def test_an_ocean_of_a_sea_passes(case):
    assert failed(case()) == []


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize(
    "arguments",
    [
        {},
        {"loop": None},
        {"depth": 2.0},
        {"n": 31},
        {"n": (48, 80), "choppiness": 0.0},
        {"surface_tension": 0.074, "size": 0.1},
        {"choppiness": 10.0},  # folded in many places
        {"backend": "scipy"},
    ],
    ids=str,
)
@pytest.mark.parametrize("t", [0.0, -1e6, 1e12])
def test_an_ocean_of_given_waves_passes(arguments, dtype, t):
    """
    The tolerance covers the rounding of omega t in the direct sum, at any time and precision.
    """
    assert failed(few(dtype=dtype, **arguments), t) == []


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("n", [1, 2, 7])
def test_an_ocean_without_waves_passes(n, dtype):
    assert failed(fo.Ocean.from_modes([], n=n, size=10.0, loop=3.0, dtype=dtype)) == []


@pytest.mark.parametrize("scale", [1e-20, 1e-35, 1e-50, 1e-200])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_waves_below_the_precision_of_the_type_count_as_none(dtype, scale):
    """
    float32 rounds such amplitudes to 0 or to a few bits; a tile far from its sea's peak has them.
    """
    tiny = fo.Ocean.from_modes(
        [(mx, my, a * scale, p) for mx, my, a, p in WAVES],
        n=(16, 12),
        size=80.0,
        loop=20.0,
        dtype=dtype,
    )
    assert failed(tiny) == []


def test_a_tile_that_holds_nothing_of_its_sea_passes():
    """
    Ripples of a wind of 2 m/s on a tile of a kilometre are below the least number of float32.
    """
    for size in (400.0, 1348.0):
        assert (
            failed(
                ocean(fo.Sea.from_wind(speed=2.0, fetch=2000.0), n=8, size=size, dtype="float32")
            )
            == []
        )


@pytest.mark.parametrize("seed", range(60))
def test_folds_do_not_fail_the_normals(seed):
    """
    At the edge of a fold a rounding turns the normal; its error is weighted with the area there.
    """
    rng = np.random.default_rng(seed)
    waves = [
        (int(mx), int(my), 0.02, float(p))
        for mx, my, p in zip(
            rng.integers(1, 8, 20), rng.integers(-5, 6, 20), rng.uniform(0, 6, 20), strict=True
        )
    ]
    folded = fo.Ocean.from_modes(waves, n=(16, 12), size=3.0, choppiness=3.0, dtype="float32")
    (check,) = [c for c in proof._fields(folded, 1.0) if c.name == "normal"]
    assert check.passed, check


@pytest.mark.parametrize("tile", [(8, 60.0), (16, 150.0)])
def test_the_tolerance_of_m0_covers_2000_realisations(tile):
    """
    Energies are exponential: m0 of 2000 realisations is within the tolerance, which is at most 3
    times the 99.9th percentile of the errors.
    """
    base = ocean(n=tile[0], size=tile[1])
    tolerance, _ = proof._likely(base)
    a = base.amplitudes
    energy = np.concatenate([a.variance_forward.ravel(), a.variance_backward[:, 1:].ravel()])
    m0 = np.random.default_rng(1).exponential(size=(2000, energy.size)) @ energy / a.variance
    assert np.all(np.abs(m0 - 1.0) <= tolerance)
    assert tolerance < 3.0 * np.quantile(np.abs(m0 - 1.0), 0.999)


def test_checks_have_names_reasons_and_small_tolerances():
    """
    Fields have 1e-12 (1e-6 in float32), and only the check of a random quantity has more than 1e-2.
    """
    double, single = fo.verify(ocean()), fo.verify(ocean(dtype="float32"))
    assert [c.name for c in double] == [c.name for c in single]
    assert sorted(c.name for c in double) == sorted([*NAMES, *ENERGY])
    for c in (*double, *single):
        assert c.against
        assert c.reason
        assert c.tolerance < 1e-2 or c.name == "m0 of this realisation"
    assert max(c.tolerance for c in double if c.name in FIELDS) < 2e-12
    assert max(c.tolerance for c in single if c.name in FIELDS) < 1.01e-6


def test_nan_does_not_pass():
    assert not proof.Check("name", "against", math.nan, 1.0, "reason").passed
    assert not proof.Check("name", "against", math.inf, 1.0, "reason").passed
    assert proof.Check("name", "against", 1.0, 1.0, "reason").passed


def test_the_earlier_names_of_error_and_tolerance_remain():
    check = proof.Check("name", "against", 0.25, 1.0, "reason")
    assert (check.figure, check.bound) == (check.error, check.tolerance) == (0.25, 1.0)


# Faults


def rendered(patch, change):
    """
    Pass every frame of every ocean through `change(ocean, frame)`.
    """
    for name in ("frame", "loop_frame"):
        real = getattr(fo.Ocean, name)

        def render(self, *arguments, real=real, **how):
            result = real(self, *arguments, **how)
            change(self, result)
            return result

        patch.setattr(fo.Ocean, name, render)


def forget_plans():
    """Clear all caches of the package, which hold results of the table of signs."""
    for name, module in list(sys.modules.items()):
        if name.startswith("fftocean"):
            for value in list(vars(module).values()):
                if hasattr(value, "cache_clear"):
                    value.cache_clear()


@pytest.fixture
def table(monkeypatch):
    """Give a function that replaces a row of the table of signs."""
    forget_plans()
    yield lambda name, row: monkeypatch.setitem(FIELDS, name, row)
    monkeypatch.undo()
    forget_plans()


WRONG_ROWS = {
    "height": "displace_x",
    "displace_x": "displace_y",
    "displace_y": "slope_y",
    "slope_x": "slope_y",
    "slope_y": "stretch_yy",
    "stretch_xx": "stretch_yy",
    "stretch_xy": "stretch_xx",
    "stretch_yy": "stretch_xy",
    "velocity_x": "displace_x",
    "velocity_y": "velocity_x",
    "velocity_z": "height",
}


@pytest.mark.parametrize("name", FIELDS)
def test_a_wrong_row_in_the_table_of_signs_fails_its_field(name, table):
    """The field fails, its pointwise products fail, and no other field does."""
    of_it = {name, *(product for product, parts in POINTWISE.items() if name in parts)}
    table(name, FIELDS[WRONG_ROWS[name]])
    assert set(failed(few())) & {*FIELDS, *POINTWISE} == of_it


@pytest.mark.parametrize("name", FIELDS)
def test_a_flipped_sign_fails_its_field(name, monkeypatch):
    """The frame is as a flipped sign in that row would leave it, with its pointwise products."""
    of_it = {name, *(product for product, parts in POINTWISE.items() if name in parts)}
    of_it -= {"jacobian"} if name == "stretch_xy" else set()  # which has its square

    def flip(_, frame):
        if name in frame.fields:
            frame[name][:] *= -1.0
        if "normal" in frame.fields:
            frame.normal[:] = fo.normals(frame)
            frame.jacobian[:] = fo.jacobian(frame)

    rendered(monkeypatch, flip)
    assert set(failed(few())) & {*FIELDS, *POINTWISE} == of_it


def linear(change):
    """Pass every linear field through `change(array)`, in place."""

    def apply(_, frame):
        for name in set(frame.fields) - set(POINTWISE):
            frame[name][:] = change(frame[name])

    return lambda patch: rendered(patch, apply)


def lifted(_, frame):
    if "height" in frame.fields:
        frame.height[:] += 0.01


def product(name, change):
    """Pass one pointwise field through `change(ocean, frame)`."""

    def apply(ocean, frame):
        if name in frame.fields:  # and so are all linear fields, where the proof asks for it
            frame[name][:] = change(ocean, frame)

    return lambda patch: rendered(patch, apply)


def with_choppiness(factor, make):
    """Return a change of a product to another choppiness than the ocean's."""

    def change(_, frame):
        linear = {name: frame[name] for name in frame.fields if name in FIELDS}
        return make(fo.Frame(frame.t, frame.grid, factor * frame.choppiness, linear))

    return change


def one_nan(_, frame):
    frame[frame.fields[0]][-2, -3] = np.nan


def method(name, make):
    """Replace a method of all oceans by `make(method)`."""
    return lambda patch: patch.setattr(fo.Ocean, name, make(getattr(fo.Ocean, name)))


def drifting(modes):
    """Return waves whose frequencies are not whole numbers of cycles in the loop."""

    def changed(self):
        waves = modes(self)
        return waves._replace(omega=waves.omega * (1.0 + 1e-9))

    return changed


BROKEN = {
    "1/N^2 in the transform": (
        linear(lambda a: a / a.size),
        [*FIELDS, "seam", "Parseval", "m0 of the frame", "loop, frame j"],
    ),
    "a millionth too high": (
        linear(lambda a: a * 1.000001),
        [*FIELDS, "seam", "Parseval", "m0 of the frame", "loop, frame j"],
    ),
    "a doubled amplitude": (
        linear(lambda a: 2.0 * a),
        [*FIELDS, "seam", "Parseval", "m0 of the frame", "loop, frame j"],
    ),
    "one sample to the east": (
        linear(lambda a: np.roll(a, 1, axis=1)),
        [*FIELDS, "seam", "loop, frame j"],
    ),
    "the northmost row on top": (
        linear(lambda a: a[::-1].copy()),
        [*FIELDS, "seam", "loop, frame j"],
    ),
    "a mean level": (
        lambda patch: rendered(patch, lifted),
        ["mean level", "height", "Parseval", "seam", "loop, frame j"],
    ),
    "one NaN": (
        lambda patch: rendered(patch, one_nan),
        ["height", "seam", "loop, frame j + F", "loop, t = T", "Parseval", "mean level"],
    ),
    "e^{+i omega t}": (
        method("frame", lambda real: lambda self, t, *a, **k: real(self, -t, *a, **k)),
        [*FIELDS, "normal", "jacobian", "seam", "Parseval"],
    ),
    "frames of the loop too far apart": (
        method(
            "loop_frame",
            lambda real: lambda self, j, count, *a, **k: real(self, j % count, count - 1, *a, **k),
        ),
        ["loop, frame j"],
    ),
    "the loop runs backwards": (
        method(
            "loop_frame",
            lambda real: lambda self, j, count, *a, **k: real(self, -j, count, *a, **k),
        ),
        ["loop, frame j"],
    ),
    "the loop's frames by the second": (  # right at first, worn after a few billion frames
        method(
            "loop_frame",
            lambda _: lambda self, j, count, *a, **k: self.frame(self.loop * j / count, *a, **k),
        ),
        ["loop, frame j + F"],
    ),
    "a clock that does not come round": (
        method(
            "frame", lambda real: lambda self, t, *a, **k: real(self, t * (1.0 + 1e-7), *a, **k)
        ),
        ["loop, t = T"],
    ),
    "waves that do not close": (method("modes", drifting), ["loop of the waves"]),
    "choppiness twice in the normals": (
        product("normal", with_choppiness(2.0, fo.normals)),
        ["normal"],
    ),
    "choppiness forgotten in the normals": (
        product("normal", with_choppiness(0.0, fo.normals)),
        ["normal"],
    ),
    "choppiness forgotten in the Jacobian": (
        product("jacobian", with_choppiness(0.0, fo.jacobian)),
        ["jacobian"],
    ),
    "normals that point down": (product("normal", lambda _, frame: -frame.normal), ["normal"]),
    "normals of one unit too long": (
        product("normal", lambda _, frame: 1.00001 * frame.normal),
        ["normal"],
    ),
    "no Jacobian off the diagonal": (
        product(
            "jacobian",
            lambda _, f: (1.0 + f.choppiness * f.stretch_xx) * (1.0 + f.choppiness * f.stretch_yy),
        ),
        ["jacobian"],
    ),
}


FAINT = "a millionth too high"  # below what float32 can show


@pytest.mark.parametrize(
    ("what", "dtype"),
    [(w, d) for w in BROKEN for d in ("float32", "float64") if (w, d) != (FAINT, "float32")],
)
def test_a_fault_fails_under_its_name(what, dtype, monkeypatch):
    patch, names = BROKEN[what]
    assert failed(few(dtype=dtype, depth=6.0)) == []
    patch(monkeypatch)
    assert set(names) <= set(failed(few(dtype=dtype, depth=6.0)))


@pytest.mark.parametrize(
    "what",
    ["choppiness twice in the normals", "no Jacobian off the diagonal", "the loop runs backwards"],
)
def test_a_fault_in_one_quantity_fails_that_check_alone(what, monkeypatch):
    """Quantities beside the faulty one still pass."""
    BROKEN[what][0](monkeypatch)
    assert failed(few()) == BROKEN[what][1]


def twice(real, factor=2.0):
    return lambda *a: factor * real(*a)


ENERGY_BROKEN = {
    "h0 twice too high": (
        lambda patch: patch.setattr(noise, "complex_normals", twice(noise.complex_normals)),
        {"amplitudes": "gaussian", "n": 48, "size": 300.0},
        "m0 of this realisation",
    ),
    "a fixed amplitude a millionth too high": (
        lambda patch: patch.setattr(noise, "unit_phasors", twice(noise.unit_phasors, 1.000001)),
        {"amplitudes": "fixed"},
        "m0 of this realisation",
    ),
    "cells with a hundredth too much": (
        lambda patch: (
            patch.setattr(Cells, "variances", twice(Cells.variances, 1.01)),
            patch.setattr(Cells, "require_energy", lambda *_: None),
        ),
        {},
        "energy resolved + lost",
    ),
    "energy lost and not told": (
        lambda patch: patch.setattr("fftocean.statistics.outside_band", lambda *_: (0.0, 0.0)),
        {"n": 12, "size": 30.0},
        "energy resolved + lost",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", ENERGY_BROKEN)
def test_wrong_energy_fails_under_its_name(what, monkeypatch):
    """The fields agree with their waves; only the checks of energy fail."""
    patch, arguments, name = ENERGY_BROKEN[what]
    patch(monkeypatch)
    assert failed(ocean(**arguments)) == [name]


def test_every_check_fails_for_some_fault():
    seen = {name for _, names in BROKEN.values() for name in names} | {
        name for *_, name in ENERGY_BROKEN.values()
    }
    assert seen == {*NAMES, *ENERGY}


# From the command line


def test_the_command_passes_the_default_sea(capsys):
    assert main(["verify", "--n", "16"]) == 0
    out, err = capsys.readouterr()
    assert "23 of 23 checks passed\n" in out
    assert "FAILED" not in out
    assert not err


@pytest.mark.parametrize(
    "what", ["choppiness twice in the normals", "frames of the loop too far apart"]
)
def test_the_command_fails_with_5_and_the_name(what, monkeypatch, capsys):
    BROKEN[what][0](monkeypatch)
    assert main(["verify", "--n", "16", "--dtype", "float32", "--t", "1e6"]) == 5
    out, _ = capsys.readouterr()
    assert out.endswith(f"22 of 23 checks passed; failed: {BROKEN[what][1][0]}\n")
    assert out.count("FAILED") == 1
