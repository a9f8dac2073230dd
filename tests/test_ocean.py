"""
The frame: every field against the direct sum, at any time, on any grid; loops, seams, seeds,
threads and bad input.
"""

import copy
import dataclasses
import fractions
import math
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import fftocean as fo
from fftocean.computation import Computation
from fftocean.fields import EIGHT, FIELDS
from fftocean.kernels import passes

ALL = (*FIELDS, "normal", "jacobian")
DEEP = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
SHALLOW = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=5.0, direction=30.0)


def ocean(sea=DEEP, **arguments):
    """An ocean that is small unless told otherwise."""
    return fo.Ocean(sea, **{"n": 32, "size": 200.0, "seed": 3, "dtype": "float64", **arguments})


def worst(t, *oceans):
    """
    The largest difference from the direct sum over all fields, relative to each field's largest
    value; for oceans of the same waves.
    """
    grid = oceans[0].grid
    step = max(
        1, min(grid.shape) // 16
    )  # enough points to see every wave; the sum costs points times waves
    x, y = np.meshgrid(grid.x[::step], grid.y[::step])
    truth = fo.gerstner.surface(oceans[0], x, y, t)

    def apart(frame, name):
        return float(
            np.max(np.abs(frame[name][::step, ::step] - getattr(truth, name)))
            / np.max(np.abs(frame[name]))
        )

    return [max(apart(o.frame(t, fields=ALL), name) for name in ALL) for o in oceans]


@pytest.mark.parametrize("backend", ["pyfftw", "scipy"])
@pytest.mark.parametrize("loop", [None, 30.0])
@pytest.mark.parametrize("t", [0.0, 3.7, 1e6])
@pytest.mark.parametrize("sea", [DEEP, SHALLOW], ids=["deep", "5m"])
@pytest.mark.parametrize(
    "n", [*(pytest.param(n, marks=pytest.mark.slow) for n in (64, (48, 80))), 31]
)
def test_every_field_equals_the_direct_sum(n, sea, t, loop, backend):
    """
    float64: 1e-12 of the field's largest value, and the rounding of omega t in the direct sum;
        float32: 1e-6, about 8 eps.
    """
    double, single = (
        ocean(sea, n=n, size=(200.0, 150.0), loop=loop, backend=backend, dtype=d)
        for d in ("float64", "float32")
    )
    omega = float(np.max(double.modes().omega))
    errors = worst(t, double, single)
    assert errors[0] <= 1e-12 + 2 * np.finfo(float).eps * omega * t
    assert errors[1] <= 1e-6


@pytest.mark.parametrize("t", [-1e6, 1e7, 1e9])
def test_single_precision_is_as_good_after_years(t):
    """
    Against float64 at the same time: relative L2 error 2e-6 at most; phases are reduced before any
    cast.
    """
    single, double = ocean(dtype="float32").frame(t), ocean().frame(t)
    for name in EIGHT:
        assert np.linalg.norm(single[name] - double[name]) <= 2e-6 * np.linalg.norm(double[name])


@pytest.mark.nojit
@pytest.mark.parametrize("depth", [math.inf, 5.0])
def test_one_mode_in_closed_form(depth):
    """Amplitude, wavelength, direction of travel, phase speed, and every field of a single wave."""
    a, phase, m, n, size, t = 0.4, 0.6, (3, -2), (24, 20), (90.0, 70.0), 5.3
    o = fo.Ocean.from_modes([(*m, a, phase)], n=n, size=size, depth=depth, dtype="float64")
    kx, ky = 2 * math.pi * m[0] / size[0], 2 * math.pi * m[1] / size[1]
    k = math.hypot(kx, ky)
    omega = math.sqrt(9.80665 * k * math.tanh(k * depth))
    x, y = np.meshgrid(np.arange(n[0]) * size[0] / n[0], np.arange(n[1]) * size[1] / n[1])
    f = kx * x + ky * y - omega * t - phase
    b = a / math.tanh(k * depth)
    frame = o.frame(t, fields=ALL)
    closed = {
        "height": a * np.cos(f),
        "displace_x": -b * kx / k * np.sin(f),
        "displace_y": -b * ky / k * np.sin(f),
        "slope_x": -a * kx * np.sin(f),
        "slope_y": -a * ky * np.sin(f),
        "stretch_xx": -b * kx * kx / k * np.cos(f),
        "stretch_xy": -b * kx * ky / k * np.cos(f),
        "stretch_yy": -b * ky * ky / k * np.cos(f),
        "velocity_x": b * omega * kx / k * np.cos(f),
        "velocity_y": b * omega * ky / k * np.cos(f),
        "velocity_z": a * omega * np.sin(f),
        "jacobian": 1.0 - b * k * np.cos(f),
    }
    for name, value in closed.items():
        assert np.max(np.abs(frame[name] - value)) < 1e-13, name
    assert frame.height.shape == (20, 24)
    modes = o.modes()
    assert (modes.kx[0], modes.ky[0], modes.omega[0]) == pytest.approx((kx, ky, omega), rel=1e-15)
    assert (modes.amplitude[0], modes.phase[0]) == pytest.approx((a, phase), rel=1e-14)


@pytest.mark.nojit
@pytest.mark.parametrize("m", [(2, 0), (-2, 0), (0, 3), (1, -1)])
def test_waves_run_along_plus_k(m):
    """
    The crest moves by c dt along +k: e^{+i omega t} with e^{+i k.x}, as sometimes printed, runs it
    backwards.
    """
    o = fo.Ocean.from_modes([(*m, 1.0, 0.0)], n=64, size=100.0, dtype="float64")
    kx, ky = 2 * math.pi * m[0] / 100.0, 2 * math.pi * m[1] / 100.0
    k = math.hypot(kx, ky)
    speed, dt = math.sqrt(9.80665 / k), 0.7
    later = o.frame(dt).height
    x, y = np.meshgrid(o.grid.x, o.grid.y)
    moved = np.cos(kx * (x - speed * dt * kx / k) + ky * (y - speed * dt * ky / k))
    assert np.max(np.abs(later - moved)) < 1e-13


@pytest.mark.nojit
@pytest.mark.parametrize("n", [1, 2, 3, 7, 31, (1, 16), (13, 4), 50])
def test_any_n(n):
    """Odd, prime, tiny, oblong: finite everywhere, and right where there are waves."""
    o = ocean(n=n)
    frame = o.frame(2.0, fields=ALL)
    assert all(np.all(np.isfinite(frame[f])) for f in ALL)
    if min(np.atleast_1d(n)) > 2:
        assert worst(2.0, o)[0] < 1e-12
    else:
        assert not np.any(frame.height[..., 0] - frame.height[..., 0])


def test_frame_is_a_pure_function_of_time():
    """Frames in any order, alone or with others, new arrays or reused ones: the same bits."""
    o = ocean(dtype="float32")
    first = {t: o.frame(t, fields=ALL) for t in (0.0, 9.9, -4.0)}
    reused = None
    for t in (-4.0, 0.0, 9.9):
        reused = o.frame(t, fields=ALL, out=reused)
        for name in ALL:
            assert np.array_equal(reused[name], first[t][name])
            assert np.array_equal(o.frame(t, fields=(name,))[name], first[t][name])
    again = ocean(dtype="float32").frame(9.9)
    assert all(np.array_equal(again[name], first[9.9][name]) for name in EIGHT)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_loop_frames_close_to_the_bit(dtype):
    o = ocean(loop=32.0, dtype=dtype)
    for j in (0, 5, 47):
        frame = o.loop_frame(j, 48, fields=ALL)
        for same in (j + 48, j - 48, j + 48 * 10**9, np.int64(j + 48)):
            other = o.loop_frame(same, 48, fields=ALL)
            assert all(np.array_equal(frame[f], other[f]) for f in ALL)
    assert not np.array_equal(o.loop_frame(0, 48).height, o.loop_frame(1, 48).height)
    for t in (0.0, 5.0):
        one, two = o.frame(t), o.frame(t + 32.0)
        assert all(np.array_equal(one[f], two[f]) for f in EIGHT)


@pytest.mark.parametrize("count", [7, 2**20, 2**26, 2**26 + 1, 2**31 - 1, 2**32 - 5, 2**32])
@pytest.mark.parametrize(("size", "loop"), [(50.0, 16.0), (0.02, 1e9)])
def test_phases_of_a_loop_are_those_of_whole_numbers(count, size, loop):
    """
    a cos(k x - 2 pi (n j mod count)/count - phase) with Python's integers, which have no bounds: n
    reaches 1e12 turns here.

    Two numbers of 32 bits, multiplied in double precision, lose whole turns, and in 64 bits with a
    sign overflow.
    """
    modes = [(1, 0, 0.3, 0.4), (0, 2, 0.2, 1.0), (-3, 1, 0.1, 2.0)]
    ocean = fo.Ocean.from_modes(
        modes, n=16, size=size, loop=loop, surface_tension=0.074, dtype="float64"
    )
    waves = ocean.modes()
    turns = [round(omega * loop / (2.0 * math.pi)) for omega in waves.omega]
    assert max(turns) > (1e9 if loop > 1e3 else 1)
    x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
    for j in (0, 1, count // 3, count - 1, 2**31 + 7, 2**32 - 9, -5, 10**30 + 1):
        expected = np.zeros_like(x)
        for n, kx, ky, amplitude, phase in zip(
            turns, waves.kx, waves.ky, waves.amplitude, waves.phase, strict=True
        ):
            turned = float(fractions.Fraction((n * j) % count, count))
            expected += amplitude * np.cos(kx * x + ky * y - 2.0 * math.pi * turned - phase)
        frame = ocean.loop_frame(j, count, ("height",))
        assert np.max(np.abs(frame.height - expected)) < 1e-14 * 50
        assert frame.t == loop * (j % count) / count
        assert np.array_equal(frame.height, ocean.loop_frame(j + count, count, ("height",)).height)


def test_turns_beyond_2_to_53_are_turned_in_whole_numbers():
    """
    The two ways to turn agree where both hold, and the fine one holds for any whole double below
    2^63.
    """
    cycles = np.array(
        [[1.0, 3.0, 2.0**49 + 1.0, 2.0**53 + 2.0, 2.0**62 + 2.0**11, 2.0**63 - 2.0**10]]
    )
    for step, count in ((5, 7), (2**25 + 3, 2**26), (2**31 + 11, 2**32 - 5), (2**32 - 1, 2**32)):
        fine = np.empty_like(cycles)
        passes.phases_in_fine_loop(cycles, step, count, fine)
        exact = [float(fractions.Fraction(int(c) * step % count, count)) for c in cycles[0]]
        apart = fine[0] - exact
        assert np.max(np.abs(apart - np.rint(apart))) < 2e-16
        assert np.max(np.abs(fine)) <= 0.5
        if count <= 2**26:
            plain = np.empty((1, 3))
            passes.phases_in_loop(cycles[:, :3], float(step), float(count), plain)
            assert np.array_equal(plain, fine[:, :3])


def test_loop_frames_are_the_frames_at_their_times():
    """
    Two clocks, whole turns and seconds: apart by the rounding of n t/T, 1e-13 of the largest value.
    """
    o = ocean(loop=32.0)
    for j, count in ((7, 48), (11, 31)):
        a, b = o.loop_frame(j, count), o.frame(32.0 * j / count)
        assert a.t == b.t
        for name in EIGHT:
            assert np.max(np.abs(a[name] - b[name])) < 1e-12 * np.max(np.abs(a[name]))


def test_every_wave_turns_a_whole_number_of_times_in_a_loop():
    modes = ocean(loop=32.0).modes()
    turns = modes.omega * 32.0 / (2 * np.pi)
    assert np.max(np.abs(turns - np.rint(turns))) < 1e-12
    assert np.min(turns) > 0.5
    free = ocean().modes()
    assert np.max(np.abs(modes.omega - free.omega)) <= np.pi / 32.0 * (1 + 1e-12)
    assert np.array_equal(
        modes.amplitude, free.amplitude
    )  # energies come from the true omega, never the quantised one


def test_the_seam_is_closed():
    """
    One sample past the last is the first again: the exact surface at x + L and y + L equals the
    frame's own edge.
    """
    o = ocean(n=(40, 24), size=(200.0, 90.0))
    frame = o.frame(1.5)
    east = fo.gerstner.surface(o, 200.0, o.grid.y, 1.5)
    north = fo.gerstner.surface(o, o.grid.x, 90.0, 1.5)
    for name in EIGHT:
        scale = np.max(np.abs(frame[name]))
        assert np.max(np.abs(getattr(east, name) - frame[name][:, 0])) < 1e-12 * scale
        assert np.max(np.abs(getattr(north, name) - frame[name][0, :])) < 1e-12 * scale


def test_finer_samples_of_the_same_sea_show_the_same_waves():
    """
    n -> 2n keeps the waves: remove what only the finer grid can hold, and every second sample is
    the coarse frame.
    """
    coarse, fine = ocean(n=16), ocean(n=32)
    kept = np.fft.rfft2(fine.frame(2.0).height)
    my, mx = fine.grid.my[:, None], fine.grid.mx[None, :]
    kept[(np.abs(my) > 7) | (mx > 7)] = 0.0
    assert np.max(np.abs(np.fft.irfft2(kept)[::2, ::2] - coarse.frame(2.0).height)) < 1e-13


def test_zero_mean_and_zero_nyquist():
    frame = ocean(n=32).frame(1.0, fields=tuple(FIELDS))
    for name in FIELDS:
        spectrum = np.fft.rfft2(frame[name]) / frame[name].size
        scale = np.max(np.abs(spectrum))
        assert abs(spectrum[0, 0]) < 1e-15 * max(scale, 1.0)
        assert max(np.max(np.abs(spectrum[16])), np.max(np.abs(spectrum[:, 16]))) < 1e-15 * max(
            scale, 1.0
        )


@pytest.mark.parametrize(("dtype", "bound"), [("float32", 5e-7), ("float64", 1e-13)])
def test_parseval(dtype, bound):
    """
    Mean square in space = sum over the half plane of |h|^2, of what the evolution made: bounds as
    RELIABILITY's, 4 and 450 eps.
    """
    o = ocean(n=64, dtype=dtype)
    a, t = o.amplitudes, 4.4
    h = a.forward * np.exp(-1j * a.omega * t) + a.backward * np.exp(1j * a.omega * t)
    energy = np.sum(np.abs(h[:, 0]) ** 2) + 2 * np.sum(np.abs(h[:, 1:]) ** 2)
    assert np.mean(o.frame(t).height.astype(float) ** 2) == pytest.approx(energy, rel=bound)


def test_a_flat_sea_is_exactly_flat():
    with pytest.warns(fo.SeaWarning, match="flat"):
        calm = fo.Sea.from_wind(speed=0.0, fetch=100e3)
    for sea in (calm, fo.Sea()):
        frame = fo.Ocean(sea, n=16, size=50.0, loop=10.0).frame(3.0, fields=ALL)
        assert all(not np.any(frame[f]) for f in FIELDS)
        assert np.array_equal(
            frame.normal, np.broadcast_to(np.array([0, 0, 1], dtype="f4"), (16, 16, 3))
        )
        assert np.all(frame.jacobian == 1.0)


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("height", "m"),
        ("displace_x", "m"),
        ("displace_y", "m"),
        ("slope_x", "-"),
        ("slope_y", "-"),
        ("stretch_xx", "-"),
        ("stretch_xy", "-"),
        ("stretch_yy", "-"),
        ("velocity_x", "m/s"),
        ("velocity_y", "m/s"),
        ("velocity_z", "m/s"),
    ],
)
def test_fields_are_documented_with_their_units(name, unit):
    """A caption with a capital, but for the d of a derivative, which is a symbol."""
    caption = getattr(fo.Frame, name).__doc__
    assert re.match(r"[A-Z]|d [a-z_]+ / d", caption), caption
    assert caption.endswith(f" [{unit}].")


def test_only_what_is_asked_is_there():
    o = ocean()
    frame = o.frame(0.0, fields=("height", "height"))
    assert frame.fields == ("height",)
    assert hasattr(frame, "height")
    assert not hasattr(frame, "slope_x")
    with pytest.raises(fo.FFTOceanError, match="has height; for slope_x ask"):
        _ = frame.slope_x
    with pytest.raises(AttributeError, match=r"fo\.normals"):
        _ = frame.normal
    assert o.frame(0.0).fields == EIGHT
    for name in ALL:
        assert getattr(o.frame(0.0, fields=ALL), name).dtype == np.float64
    assert "Frame(t=0.0, 32 x 32, height)" in repr(frame)
    assert "32 x 32" in repr(o)


@pytest.mark.parametrize(
    ("call", "rule"),
    [
        (lambda o: o.frame(math.nan), "t must be"),
        (lambda o: o.frame(math.inf), "t must be"),
        (lambda o: o.frame("3"), "t must be"),
        (lambda o: o.frame(0.0, fields=("hieght",)), "a field must be one of"),
        (lambda o: o.loop_frame(0, 48), "loops"),
        (lambda _: ocean(loop=30.0).loop_frame(0.5, 48), "j must be"),
        (lambda _: ocean(loop=30.0).loop_frame(0, 0), "count must be"),
        (
            lambda _: ocean(loop=30.0).loop_frame(0, 2**32 + 1),
            "count must be a whole number between 1 and 42949672",
        ),
        (lambda o: o.frame(0.0, out=ocean(n=16).frame(0.0)), "out.height must be"),
        (lambda o: o.frame(0.0, out=ocean(dtype="float32").frame(0.0)), "out.height must be"),
        (
            lambda o: o.frame(0.0, out=o.frame(0.0, fields=("height",))),
            "out must be a frame that has height, displace_x",
        ),
        (lambda o: o.frame(0.0, out={}), "out must be a frame"),
    ],
)
def test_bad_calls_are_refused(call, rule):
    with pytest.raises(fo.FFTOceanError, match=rule):
        call(ocean())


BAD = [math.nan, math.inf, -math.inf, -1, 0, "5", True, None, 1e308, 1e-308]


@pytest.mark.parametrize("band", [(1.0, 1.0), (2.0, 1.0)])
def test_a_band_without_waves_is_refused(band):
    with pytest.raises(fo.ParameterError, match=rf"band must rise, got {band[0]:g} to 1 rad/m"):
        ocean(band=band)


def tried(make):
    """Return the result and "", or None and the message of the error."""
    try:
        return make(), ""
    except fo.ParameterError as error:
        return None, str(error)


@pytest.mark.parametrize("value", BAD, ids=repr)
@pytest.mark.parametrize(
    "key", ["n", "size", "seed", "loop", "choppiness", "dtype", "amplitudes", "backend", "planning"]
)
def test_bad_values_are_refused_or_finite(key, value):
    """Every key: a refusal that names it, or a finite sea."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        o, refusal = tried(lambda: ocean(n=8, **{key: value}) if key != "n" else ocean(n=value))
    if o is None:
        assert key in refusal
        assert str(value) in refusal or repr(value) in refusal
        return
    frame = o.frame(1.0, fields=ALL)
    assert all(np.all(np.isfinite(frame[f])) for f in ALL)


@pytest.mark.parametrize("value", BAD, ids=repr)
@pytest.mark.parametrize("key", ["depth", "speed", "fetch", "direction", "gamma"])
def test_bad_seas_are_refused_or_finite(key, value):
    arguments = {"speed": 10.0, "fetch": 1e5, key: value}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        o, refusal = tried(lambda: ocean(fo.Sea.from_wind(**arguments), n=16))
    if o is None:
        assert key in refusal
        return
    frame = o.frame(1.0, fields=ALL)
    assert all(np.all(np.isfinite(frame[f])) for f in ALL)


@pytest.mark.parametrize("depth", [1e-6, 1e-3, 0.1, 1e5, 1e308, math.inf])
@pytest.mark.parametrize("size", [1e-2, 1.0, 1e4, 1e6])
def test_extreme_depths_and_sizes_are_finite(depth, size):
    o = ocean(
        fo.Sea.from_wind(speed=10.0, fetch=1e5, depth=depth), n=16, size=size, dtype="float32"
    )
    frame = o.frame(10.0, fields=ALL)
    assert all(np.all(np.isfinite(frame[f])) for f in ALL)


def test_waves_that_would_overflow_are_refused():
    with pytest.raises(fo.ParameterError, match="float32"):
        ocean(
            fo.Sea(fo.WaveSystem(spectrum=fo.CustomSpectrum(lambda w: 1e42 + 0 * w, peak=1.0))),
            dtype="float32",
        )


def test_too_much_memory_is_refused_before_it_is_taken(monkeypatch):
    monkeypatch.setattr("fftocean.host.available_memory", lambda: 2.0**30)
    with pytest.raises(
        fo.ParameterError,
        match=r"n = 65536 x 65536 needs about \d+\.\d GiB of memory, but only 1.0 GiB",
    ):
        ocean(n=65536)


def test_a_loop_shorter_than_four_peak_periods_is_warned_of():
    with pytest.warns(fo.SeaWarning, match="four peak periods"):
        ocean(loop=10.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ocean(loop=60.0)


def test_sixteen_threads_on_one_ocean_get_right_data():
    o = ocean(dtype="float32", n=48)
    times = [0.37 * i for i in range(64)]
    expected = [o.frame(t, fields=("height", "normal")) for t in times]
    barrier = threading.Barrier(16)

    def work(worker):
        barrier.wait()
        return [(i, o.frame(times[i], fields=("height", "normal"))) for i in range(worker, 64, 16)]

    with ThreadPoolExecutor(16) as pool:
        for results in pool.map(work, range(16)):
            for i, frame in results:
                assert np.array_equal(frame.height, expected[i].height)
                assert np.array_equal(frame.normal, expected[i].normal)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this platform")
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
@pytest.mark.parametrize("backend", ["pyfftw", "scipy"])
@pytest.mark.process
def test_a_forked_child_has_threads_of_its_own(backend):
    """The parent's workers are not handed down to it: without new ones it would wait for ever."""
    o = ocean(dtype="float32", threads=2, backend=backend)
    expected = o.frame(1.0).height
    child = os.fork()
    if child == 0:
        signal.alarm(20)  # a hang is a failure, not a hanging suite
        os._exit(0 if np.array_equal(o.frame(1.0).height, expected) else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert np.array_equal(o.frame(1.0).height, expected)


def test_a_reused_frame_names_the_moment_that_it_shows():
    o = ocean(loop=30.0)
    first = o.frame(1.0)
    second = o.frame(2.0, ("height", "slope_x"), out=first)
    assert second is first
    assert (first.t, first.fields) == (2.0, ("height", "slope_x"))
    assert np.array_equal(first.height, o.frame(2.0).height)


@pytest.mark.parametrize(
    "make",
    [
        lambda: ocean(loop=30.0, threads=2),
        lambda: fo.Ocean.from_modes([(1, 2, 0.5, 0.1)], n=8, size=9.0),
    ],
)
def test_oceans_can_be_pickled_and_copied(make):
    o = make()
    for twin in (pickle.loads(pickle.dumps(o)), copy.copy(o), copy.deepcopy(o)):
        assert twin is not o
        assert twin.seed == o.seed
        assert all(np.array_equal(twin.frame(1.3)[name], o.frame(1.3)[name]) for name in EIGHT)


@pytest.mark.parametrize(
    ("name", "value"), [("choppiness", 0.5), ("dtype", "float32"), ("seed", 9), ("sea", None)]
)
def test_an_ocean_is_frozen(name, value):
    with pytest.raises(AttributeError, match=f"an ocean is frozen: make another with the {name}"):
        setattr(ocean(), name, value)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this platform")
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
@pytest.mark.process
def test_a_forked_child_does_not_hang_on_the_parent_s_lock():
    o = ocean(dtype="float32")
    expected = o.frame(1.0).height
    with o._lock:  # as if another thread were at work while we fork
        child = os.fork()
        if child == 0:
            os._exit(0 if np.array_equal(o.frame(1.0).height, expected) else 1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_values_are_frozen():
    o = ocean()
    with pytest.raises(ValueError, match="read-only"):
        o.amplitudes.forward[1, 1] = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        o.amplitudes.depth = 3.0
    swell = fo.Sea(fo.WaveSystem(spectrum=fo.JONSWAP(peak=1.0)), depth=5.0)
    assert dataclasses.replace(swell, depth=7.0).depth == 7.0
    with pytest.raises(
        fo.ParameterError, match=r"got 7 m for the sea and 5 m for systems\[0\].spectrum \(TMA\)"
    ):
        dataclasses.replace(SHALLOW, depth=7.0)


def test_capillary_waves_run_faster():
    """
    Wave of 5 mm, sigma = 0.074 N/m: omega^2 = g k + (sigma/rho) k^3 is 12 times what gravity alone
    gives.
    """
    args = {"n": 8, "size": 0.005, "dtype": "float64"}
    slow, fast = (
        fo.Ocean.from_modes([(1, 0, 1e-5, 0.0)], surface_tension=s, **args).modes().omega[0]
        for s in (0.0, 0.074)
    )
    k = 2 * math.pi / 0.005
    assert (fast / slow) ** 2 == pytest.approx(1.0 + 0.074 / 1025.0 * k**2 / 9.80665, rel=1e-12)


WATER = fo.Sea.from_wind(speed=9.0, fetch=100e3)


@pytest.mark.parametrize("ahead", [0, 1, 3])
@pytest.mark.parametrize("reuse", [False, True])
def test_frames_come_in_order_with_the_bits_of_frame(ahead, reuse):
    ocean = fo.Ocean(WATER, n=(24, 18), size=100.0, loop=30.0)
    times = [3.0, -1.0, 3.0, 1e6, 0.25]
    for t, frame in zip(
        times,
        ocean.frames(iter(times), ("height", "normal"), ahead=ahead, reuse=reuse),
        strict=True,
    ):
        assert frame.t == t
        assert all(
            np.array_equal(frame[name], ocean.frame(t, (name,))[name])
            for name in ("height", "normal")
        )
    for j, frame in enumerate(ocean.loop_frames(7, ahead=ahead, reuse=reuse)):
        assert all(
            np.array_equal(frame[name], ocean.loop_frame(j, 7)[name]) for name in frame.fields
        )
    assert j == 6


@pytest.mark.parametrize("ahead", [0, 1, 3])
def test_frames_reuse_arrays_only_when_told_to(ahead):
    """Frames that are kept go on showing their own times."""
    ocean = fo.Ocean(WATER, n=16, size=100.0)
    kept = list(ocean.frames(range(6), ("height",), ahead=ahead))
    assert [frame.t for frame in kept] == list(range(6))
    for frame in kept:
        assert np.array_equal(frame.height, ocean.frame(frame.t, ("height",)).height)
    assert len({frame.height.ctypes.data for frame in kept}) == 6
    reused = ocean.frames(range(40), ("height",), ahead=ahead, reuse=True)
    assert len({frame.height.ctypes.data for frame in reused}) <= 2 + ahead  # one is out


def test_an_endless_sea_can_be_left_at_any_time():
    ocean = fo.Ocean(WATER, n=16, size=100.0)
    taken = []

    def times():
        while True:
            taken.append(float(len(taken)))
            yield taken[-1]

    for frame in ocean.frames(times(), ("height",), ahead=2):
        if frame.t == 5.0:
            break
    assert len(taken) <= 9  # no further ahead than it was told
    assert ocean.frame(1.0).t == 1.0


def test_a_bad_time_comes_up_in_its_turn():
    ocean = fo.Ocean(WATER, n=16, size=100.0)
    frames = ocean.frames([1.0, math.nan, 2.0])
    assert next(frames).t == 1.0
    with pytest.raises(fo.ParameterError, match="t must be"):
        next(frames)
    for bad in (-1, 1.5, True, 1000):
        with pytest.raises(fo.ParameterError, match="ahead must be"):
            ocean.frames([1.0], ahead=bad)
    with pytest.raises(fo.ParameterError, match="needs an ocean that loops"):
        next(ocean.loop_frames(3))


def test_times_of_a_loop_are_reduced_before_they_are_multiplied():
    """A loop that is no power of two: t and t + loop, however far."""
    ocean = fo.Ocean(WATER, n=32, size=100.0, loop=30.0)
    for t in (5.0, 29.5):
        frame = ocean.frame(t)
        for later in (t + 30.0, t + 30.0 * 1024, t - 30.0):
            assert all(
                np.array_equal(ocean.frame(later)[name], frame[name]) for name in frame.fields
            )


def test_who_supplies_the_times_may_fail_and_no_frame_is_lost():
    def times():
        yield from (1.0, 2.0, 3.0)
        raise LookupError("no more times")

    ocean = fo.Ocean(WATER, n=16, size=100.0)
    for ahead in (0, 1, 3):
        frames = ocean.frames(times(), ("height",), ahead=ahead)
        assert [next(frames).t for _ in range(3)] == [1.0, 2.0, 3.0]
        with pytest.raises(LookupError, match="no more times"):
            next(frames)


def test_fields_may_come_from_a_generator():
    ocean = fo.Ocean(WATER, n=16, size=100.0)
    for frame in ocean.frames([1.0, 2.0], (name for name in ("height", "normal"))):
        assert frame.fields == ("height", "normal")


@pytest.mark.parametrize("fields", [None, 5, [["height"]], ["depth"]])
def test_what_is_no_field_is_refused(fields):
    ocean = fo.Ocean(WATER, n=16, size=100.0)
    with pytest.raises(fo.ParameterError, match="field"):
        ocean.frame(0.0, fields)


def test_out_refuses_what_it_cannot_fill():
    ocean = fo.Ocean(WATER, n=16, size=100.0)
    frame = ocean.frame(0.0, ("height", "slope_x"))
    shared = fo.Frame(0.0, frame.grid, 1.0, {"height": frame.height, "slope_x": frame.height})
    with pytest.raises(fo.ParameterError, match="array of its own"):
        ocean.frame(1.0, ("height", "slope_x"), out=shared)
    for wrong in (
        frame.height.tolist(),
        np.ma.masked_array(frame.height),
        frame.height.view(np.matrix),
    ):
        with pytest.raises(fo.ParameterError, match="plain array"):
            ocean.frame(1.0, ("height",), out=fo.Frame(0.0, frame.grid, 1.0, {"height": wrong}))


def test_arrays_of_an_unpickled_ocean_are_read_only():
    ocean = pickle.loads(pickle.dumps(fo.Ocean(WATER, n=16, size=100.0, loop=30.0)))
    a = ocean.amplitudes
    assert not any(
        array.flags.writeable
        for array in (a.forward, a.backward, a.variance_forward, a.variance_backward, a.cycles)
    )


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # Python 3.12 warns of what is tested
@pytest.mark.process
def test_frames_that_were_begun_before_a_fork_go_on_in_the_child():
    ocean = fo.Ocean(WATER, n=16, size=100.0)
    truth = [ocean.frame(float(t), ("height",)).height for t in range(4)]
    frames = ocean.frames(map(float, range(4)), ("height",), ahead=2)
    next(frames)
    child = os.fork()
    if child == 0:
        signal.alarm(20)
        good = all(
            np.array_equal(frame.height, h) for frame, h in zip(frames, truth[1:], strict=True)
        )
        os._exit(0 if good else 1)
    assert os.waitpid(child, 0)[1] == 0
    assert all(np.array_equal(frame.height, h) for frame, h in zip(frames, truth[1:], strict=True))


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.process
def test_a_thread_that_outlives_the_main_one_goes_on(threads):
    """
    While the interpreter shuts down a pool takes no new work: the calling thread does it itself.
    """
    script = f"""
import threading
import fftocean as fo
ocean = fo.Ocean.from_modes([(1, 2, 0.1, 0.0)], n=64, size=10.0, threads={threads})
ocean.frame(0.0)
def later():
    threading.main_thread().join()
    ocean.frame(1.0)
    print(len(list(ocean.frames([1.0, 2.0, 3.0]))))
threading.Thread(target=later).start()
"""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=600
    )
    assert done.stdout == "3\n", done.stderr


def test_with_amplitudes_shows_the_given_waves():
    """Half of each amplitude is half the height, by linearity; all else is the ocean's own."""
    original = ocean(fo.Sea.from_wind(speed=8.0, fetch=50e3), loop=30.0, choppiness=0.7, threads=2)
    a = original.amplitudes
    halved = dataclasses.replace(a, forward=0.5 * a.forward, backward=0.5 * a.backward)
    other = original.with_amplitudes(halved)
    assert other.amplitudes is halved
    assert (other.sea, other.seed, other.choppiness, other.dtype) == (
        original.sea,
        3,
        0.7,
        "float64",
    )
    truth = original.frame(4.2, ALL)
    frame = other.frame(4.2, ALL)
    for name in FIELDS:
        assert np.allclose(frame[name], 0.5 * truth[name], rtol=1e-12, atol=1e-14), name
    assert worst(4.2, other)[0] < 1e-12
    again = original.with_amplitudes(a, planning="estimate", threads=1).frame(4.2, ALL)
    assert all(np.array_equal(again[name], truth[name]) for name in ALL)
    twin = pickle.loads(pickle.dumps(other))
    assert all(np.array_equal(twin.frame(4.2)[name], other.frame(4.2)[name]) for name in EIGHT)


def test_with_amplitudes_of_another_sea():
    one, other = (fo.Sea.from_wind(speed=u, fetch=50e3) for u in (8.0, 12.0))
    wanted = ocean(other, choppiness=1.3)
    made = ocean(one, choppiness=0.7).with_amplitudes(wanted.amplitudes, sea=other, choppiness=1.3)
    assert (made.sea, made.choppiness, made.seed) == (other, 1.3, wanted.seed)
    for name in ("height", "jacobian"):
        assert np.array_equal(made.frame(4.2, (name,))[name], wanted.frame(4.2, (name,))[name])


def test_with_amplitudes_may_change_the_grid():
    """The same waves on twice the samples: every second sample is the old one."""
    given = fo.Ocean.from_modes([(1, 2, 0.5, 0.1), (0, -3, 0.2, 1.0)], n=8, size=9.0)
    finer = fo.Ocean.from_modes([(1, 2, 0.5, 0.1), (0, -3, 0.2, 1.0)], n=16, size=9.0)
    moved = given.with_amplitudes(finer.amplitudes)
    assert moved.grid.shape == (16, 16)
    assert np.allclose(moved.frame(1.0).height[::2, ::2], given.frame(1.0).height, atol=1e-6)


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        (lambda o: o.with_amplitudes(None), "amplitudes must be Amplitudes, got None"),
        (lambda o: o.with_amplitudes(o), "amplitudes must be Amplitudes, got"),
        (lambda o: o.with_amplitudes(o.amplitudes, sea="sea"), "sea must be a Sea, got "),
        (lambda o: o.with_amplitudes(o.amplitudes, choppiness=-1.0), "choppiness must be"),
        (lambda o: o.with_amplitudes(o.amplitudes, threads=0), "threads must be"),
        (lambda o: o.with_amplitudes(o.amplitudes, planning="best"), "planning must be one of"),
        (
            lambda o: o.with_amplitudes(
                dataclasses.replace(o.amplitudes, forward=1e200 * o.amplitudes.forward)
            ),
            "waves must keep every field below",
        ),
    ],
)
def test_with_amplitudes_refuses_what_it_cannot_compute(change, rule):
    with pytest.raises(fo.ParameterError, match=rule):
        change(ocean(n=16))


def test_with_amplitudes_asks_for_memory(monkeypatch):
    o = ocean(n=16)
    monkeypatch.setattr("fftocean.host.available_memory", lambda: 1000.0)
    with pytest.raises(fo.ParameterError, match="n = 16 x 16 needs about"):
        o.with_amplitudes(o.amplitudes)


def test_a_computation_is_checked_and_named_by_its_type():
    assert Computation(np.float64).dtype == "float64"
    for bad, rule in (({"dtype": "half"}, "dtype must be"), ({"threads": 0}, "threads must be")):
        with pytest.raises(fo.ParameterError, match=rule):
            Computation(**bad)
