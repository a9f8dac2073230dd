"""
Frames of a graphics processor beside those of the CPU in double precision, on whatever adapter
there is: lavapipe, a software one, will do.
"""

import os
import pickle
import signal
import threading
import warnings

import gpu_water
import numpy as np
import pytest
from builders import require
from gpu_water import ALL, GALE, apart, pair

import fftocean as fo
from fftocean.fields import EIGHT, FIELDS
from fftocean.gpu import device as devices
from fftocean.gpu import kernels

pytestmark = pytest.mark.client

# Relative error in the L2 norm. A field in single precision loses 6e-8 in each of its 10 to 24
# steps, and the rounding errors of those add up at random.
CLOSE = 5e-7
TILES = {**gpu_water.TILES, "two-steps-along-both": {"n": 1024, "size": 1000.0}}
TIMES = [0.0, 12.345, -1e9 - 1.0 / 3.0, 1e12]


@pytest.fixture(scope="module", autouse=True)
def adapter():
    """Return the adapter; skip or fail the tests if there is none."""
    try:
        return fo.gpu.adapter()
    except fo.ParameterError as error:
        require(False, str(error))


@pytest.fixture(autouse=True)
def _quiet():
    """Ignore warnings of tiles that are small for the waves."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        yield


@pytest.mark.parametrize("loop", [None, 64.0])
@pytest.mark.parametrize("tile", TILES)
def test_every_field_equals_that_of_the_cpu(tile, loop):
    """At times near and far, before and after zero; where phases are lost, errors are near 1."""
    gpu, cpu = pair(**TILES[tile], loop=loop)
    for t in TIMES if tile != "two-steps-along-both" else TIMES[1:2]:
        assert apart(gpu.frame(t, ALL), cpu.frame(t, ALL)) <= CLOSE


def test_moments_of_a_loop_are_exact():
    """Of the finest division of the longest loop, whose waves run for 10^9 cycles and more."""
    gpu, cpu = pair(n=32, size=30.0, loop=1e9)
    assert cpu.amplitudes.cycles.max() > 2**27
    for j in (1, 2**31 + 7, 2**32 - 1):
        seen = gpu.loop_frame(j, 2**32, ALL)
        assert apart(seen, cpu.loop_frame(j, 2**32, ALL)) <= CLOSE
        again = gpu.loop_frame(j - 5 * 2**32, 2**32, ALL)
        assert all(np.array_equal(seen[name], again[name]) for name in ALL)


def test_a_single_wave_is_its_closed_form():
    """Without any other code of this package: amplitude cos(k x - omega t - phase)."""
    wave, size, t = (3, -2, 0.5, 0.7), 100.0, 4321.0
    ocean = fo.Ocean.from_modes([wave], n=32, size=size, backend="gpu")
    x, y = np.meshgrid(*2 * [np.arange(32) * size / 32])
    kx, ky = 2 * np.pi / size * np.array(wave[:2])
    k = np.hypot(kx, ky)
    phase = kx * x + ky * y - np.sqrt(9.80665 * k) * t - 0.7
    frame = ocean.frame(t, ("height", "displace_x", "stretch_xy", "velocity_z", "slope_y"))
    expected = {
        "height": 0.5 * np.cos(phase),
        "displace_x": -0.5 * kx / k * np.sin(phase),
        "stretch_xy": -0.5 * kx * ky / k * np.cos(phase),
        "velocity_z": 0.5 * np.sqrt(9.80665 * k) * np.sin(phase),
        "slope_y": -0.5 * ky * np.sin(phase),
    }
    assert apart(frame, expected, expected) <= CLOSE


def test_a_field_has_the_same_bits_whatever_is_asked_beside_it():
    gpu, _ = pair(n=64, size=200.0)
    whole = gpu.frame(3.0, ALL)
    for name in ALL:
        assert np.array_equal(gpu.frame(3.0, (name,))[name], whole[name])


def test_second_order_waves_are_added():
    gpu, cpu = pair(n=64, size=200.0, order=2, bound=300)
    frame = cpu.frame(5.0, ALL)
    assert apart(gpu.frame(5.0, ALL), frame) <= CLOSE
    assert apart(pair(n=64, size=200.0)[0].frame(5.0, ALL), frame) > 1e-3


def test_flat_water_and_long_crests():
    """Fields without waves are 0 to the bit; those beside a larger one keep their digits."""
    flat = fo.Ocean.from_modes([], n=16, size=10.0, backend="gpu").frame(1.0, ALL)
    assert all(not np.any(flat[name]) for name in FIELDS)
    assert np.array_equal(flat.jacobian, np.ones((16, 16), np.float32))
    assert np.array_equal(flat.normal[..., 2], flat.jacobian)
    for mode in ((5, 0), (0, 5)):
        given = {"modes": [(*mode, 0.3, 0.1)], "n": 16, "size": 10.0}
        gpu = fo.Ocean.from_modes(**given, backend="gpu").frame(1.0, ALL)
        assert apart(gpu, fo.Ocean.from_modes(**given, dtype="float64").frame(1.0, ALL)) <= CLOSE


def test_frames_stay_on_the_device():
    """Buffers that other code of wgpu can bind; reading them gives the ordinary frame."""
    gpu, _ = pair(n=(64, 32), size=200.0)
    first, second = gpu.device_frame(1.0, ALL), gpu.device_frame(2.0, ("height",))
    assert first.fields == ALL
    assert first["height"].size == 4 * 64 * 32
    assert first["normal"].size == 3 * first["height"].size
    for held, t in ((first, 1.0), (second, 2.0)):  # the second has not overwritten the first
        frame, read = gpu.frame(t, held.fields), held.read()
        assert (read.t, read.fields, read.choppiness) == (t, held.fields, 0.9)
        assert all(np.array_equal(read[name], frame[name]) for name in held.fields)
    raw = second.device.queue.read_buffer(second["height"])
    assert np.array_equal(np.frombuffer(raw, np.float32).reshape(32, 64), second.read().height)
    assert first.read(["slope_x"]).fields == ("slope_x",)
    with pytest.raises(fo.FieldError, match=r"for slope_x ask device_frame\(t, fields"):
        second["slope_x"]
    with pytest.raises(fo.ParameterError, match="device_frame needs backend='gpu', got"):
        fo.Ocean(GALE, n=16, size=100.0).device_frame(0.0)


def test_normals_in_pieces(monkeypatch):
    """Large tiles have normals beyond what a kernel can bind, and take several dispatches."""
    gpu, _ = pair(n=64, size=200.0)
    whole = gpu.frame(3.0, ("normal", "jacobian"))
    monkeypatch.setattr("fftocean.gpu.synthesis._PIECE", 1024)
    pieces = pair(n=64, size=200.0)[0].frame(3.0, ("normal", "jacobian"))
    assert all(np.array_equal(whole[name], pieces[name]) for name in whole.fields)


def test_cascades_and_queries_stand_on_it():
    tiles = [(64, 400.0), (32, 57.0)]
    gpu, cpu = fo.Cascade(GALE, tiles, backend="gpu"), fo.Cascade(GALE, tiles, dtype="float64")
    assert [ocean.backend for ocean in gpu.oceans] == ["gpu", "gpu"]
    for seen, frame in zip(gpu.frame(9.0), cpu.frame(9.0), strict=True):
        assert apart(seen, frame, EIGHT) <= CLOSE
    x, y = np.random.default_rng(0).uniform(-500.0, 500.0, (2, 100))
    seen, found = (fo.Query(water).at(x, y, 9.0) for water in (gpu, cpu))
    # The iteration for the rest position ends within 1e-5 m of the point, and slopes are below 1.
    assert np.max(np.abs(seen.heights - found.heights)) < 5e-5


def test_copies_and_other_waves_stay_on_it():
    gpu, _ = pair(n=32, size=200.0)
    frame = gpu.frame(1.0)
    for other in (pickle.loads(pickle.dumps(gpu)), gpu.with_amplitudes(gpu.amplitudes)):
        assert other.backend == "gpu"
        assert np.array_equal(other.frame(1.0).height, frame.height)


def test_threads_share_the_device():
    oceans = [pair(n=32, size=200.0, seed=seed)[0] for seed in range(3)]
    expected = [ocean.frame(1.0).height for ocean in oceans]
    wrong = []

    def work(i):
        for _ in range(10):
            if not np.array_equal(oceans[i].frame(1.0).height, expected[i]):
                wrong.append(i)
            if not np.array_equal(oceans[i].device_frame(1.0).read().height, expected[i]):
                wrong.append(i)

    threads = [threading.Thread(target=work, args=(i % 3,)) for i in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


@pytest.mark.process
@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this platform")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_child_makes_a_device_of_its_own():
    gpu, _ = pair(n=32, size=200.0)
    expected, held = gpu.frame(1.0).height, gpu.device_frame(1.0)
    parents = devices.device()
    pid = os.fork()
    if pid == 0:
        signal.alarm(60)  # by the system's own clock, if the child hangs
        code = 99
        try:
            code = 0 if np.array_equal(gpu.frame(1.0).height, expected) else 1
            code += 2 * (devices.device() is parents)
            try:
                held.read()
                code += 4
            except fo.DeviceError:
                pass
        finally:
            os._exit(code)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0
    assert devices.device() is parents
    assert np.array_equal(gpu.frame(1.0).height, expected)


def test_a_lost_device_is_replaced():
    gpu, _ = pair(n=32, size=200.0)
    expected, held = gpu.frame(1.0).height, gpu.device_frame(1.0)
    lost = devices.device()
    lost.handle.destroy()
    assert np.array_equal(gpu.frame(1.0).height, expected)
    assert devices.device() is not lost
    with pytest.raises(fo.DeviceError, match="lost; compute the frame again"):
        held.read()


def test_a_device_that_is_lost_again_is_an_error(monkeypatch):
    gpu, _ = pair(n=32, size=200.0)
    submit, lost = kernels.Dispatches.submit, []

    def fail(dispatches):
        lost.append(dispatches._device)
        dispatches._device.handle.destroy()
        submit(dispatches)

    monkeypatch.setattr(kernels.Dispatches, "submit", fail)
    with pytest.raises(fo.DeviceError, match=r"failed, and again on a new device, with 32 x 32"):
        gpu.frame(1.0)
    assert len(set(map(id, lost))) == 2
    monkeypatch.undo()
    assert gpu.frame(1.0).height.std() > 0.0


def test_the_adapter_is_named(adapter):
    for part in (adapter.name, adapter.interface, adapter.driver, f"wgpu {adapter.wgpu}"):
        assert part
        assert part in str(adapter)
    assert adapter.is_software == ("in software" in str(adapter))
    if "llvmpipe" in adapter.name:
        assert adapter.is_software


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("frequency.y * moment.whole.x", "0u * moment.whole.x"),  # phases of far times
        ("+ upper(frequency.y, moment.part.y)", ""),  # of near ones
        ("return times(twiddle[turns", "return times(twiddle[0u * turns"),
        ("let mirrored = 2u * x > tile.n.x;", "let mirrored = false;"),
        ("quadrant & 2u) == 0u);\n}\n\n@compute", "quadrant & 2u) == 2u);\n}\n\n@compute"),
        ("a * d - b * b);\n    let square", "a * d + b * b);\n    let square"),
    ],
)
def test_a_wrong_kernel_is_seen(monkeypatch, right, wrong):
    """The comparison fails for each of several small faults in the shader."""
    text = kernels.source()
    assert text.count(right) == 1
    monkeypatch.setattr(kernels, "source", lambda: text.replace(right, wrong))
    devices.forget(devices.device())  # its pipelines are those of the right text
    try:
        gpu, cpu = pair(n=(1024, 4), size=(500.0, 5.0))
        worst = max(apart(gpu.frame(t, ALL), cpu.frame(t, ALL)) for t in (1.5, 1e8))
        assert not worst <= 100.0 * CLOSE
    finally:
        devices.forget(devices.device())
