"""
All of `fftocean.gpu` but its shaders, on a device in NumPy: frames beside those of the CPU in
double precision.
"""

import pickle
import sys
import warnings
from fractions import Fraction

import gpu_in_numpy
import numpy as np
import pytest
from gpu_water import ALL, TILES, apart, pair

import fftocean as fo
from fftocean.fields import EIGHT, FIELDS
from fftocean.gpu import device as devices
from fftocean.gpu import kernels, readback, stages, synthesis
from fftocean.phases import AtTime, InLoop

# Relative error in the L2 norm: tables, spectra and fields are rounded to single precision, 6e-8
# each; the kernels themselves compute in double precision.
CLOSE = 4e-7


@pytest.fixture(autouse=True)
def adapter(monkeypatch):
    """Return the adapter, which is the only one; forget its devices afterwards."""
    adapter = gpu_in_numpy.Adapter()
    monkeypatch.setattr(devices, "_current", None)
    monkeypatch.setitem(sys.modules, "wgpu", gpu_in_numpy.module(adapter))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)  # of tiles that are small for the waves
        yield adapter


@pytest.mark.parametrize("loop", [None, 64.0])
@pytest.mark.parametrize("tile", TILES)
def test_every_field_equals_that_of_the_cpu(tile, loop):
    """At times near and far, before and after zero, in any order."""
    gpu, cpu = pair(**TILES[tile], loop=loop)
    for t in (12.345, -1e9 - 1.0 / 3.0, 0.0, 1e12, 12.345):
        assert apart(gpu.frame(t, ALL), cpu.frame(t, ALL)) <= CLOSE


@pytest.mark.parametrize("n", [(16, 64), (64, 16), (32, 32)])
def test_two_steps_along_sides_that_differ(n, monkeypatch):
    """Steps as of long lines; both sides take their twists from the table of the longer one."""
    monkeypatch.setattr(stages, "MOST", 8)
    gpu, cpu = pair(n=n, size=(250.0, 90.0))
    assert [stage.n for stage in gpu._synthesis._stages] == [n[0], 1, n[1], 1]
    assert apart(gpu.frame(12.345, ALL), cpu.frame(12.345, ALL)) <= CLOSE


def test_moments_of_a_loop_are_exact():
    gpu, cpu = pair(n=32, size=30.0, loop=1e9)
    for j in (1, 2**31 + 7, 2**32 - 1):
        seen = gpu.loop_frame(j, 2**32, ALL)
        assert apart(seen, cpu.loop_frame(j, 2**32, ALL)) <= CLOSE
        again = gpu.loop_frame(j - 5 * 2**32, 2**32, ALL)
        assert all(np.array_equal(seen[name], again[name]) for name in ALL)


def test_a_field_has_the_same_bits_whatever_is_asked_beside_it():
    gpu, _ = pair(n=(64, 32), size=200.0)
    whole = gpu.frame(3.0, ALL)
    for name in ALL:
        assert np.array_equal(gpu.frame(3.0, (name,))[name], whole[name])


def test_second_order_waves_are_added():
    gpu, cpu = pair(n=(64, 32), size=(200.0, 150.0), order=2, bound=300)
    frame = cpu.frame(5.0, ALL)
    assert apart(gpu.frame(5.0, ALL), frame) <= CLOSE
    assert apart(pair(n=(64, 32), size=(200.0, 150.0))[0].frame(5.0, ALL), frame) > 1e-3


def test_flat_water_and_long_crests():
    """Fields without waves are 0 to the bit; those beside a larger one keep their digits."""
    flat = fo.Ocean.from_modes([], n=16, size=10.0, backend="gpu").frame(1.0, ALL)
    assert all(not np.any(flat[name]) for name in FIELDS)
    assert np.array_equal(flat.jacobian, np.ones((16, 16), np.float32))
    for x, y in ((1, 0), (0, 1)):
        waves = [(m * x, m * y, 0.3 / m, 0.1 * m) for m in (1, 3, 5, 7, 11)]
        given = {"modes": waves, "n": 64, "size": 10.0}
        gpu = fo.Ocean.from_modes(**given, backend="gpu").frame(1.0, ALL)
        cpu = fo.Ocean.from_modes(**given, dtype="float64").frame(1.0, ALL)
        assert apart(gpu, cpu) <= CLOSE
        none = [f for f in FIELDS if not np.any(cpu[f])]
        assert none
        assert not any(np.any(gpu[f]) for f in none)


def test_frames_stay_on_the_device():
    gpu, _ = pair(n=(64, 32), size=200.0)
    first, second = gpu.device_frame(1.0, ALL), gpu.device_frame(2.0, ("height",))
    assert first.fields == ALL
    assert first["height"].size == 4 * 64 * 32
    assert first["normal"].size == 3 * first["height"].size
    for held, t in ((first, 1.0), (second, 2.0)):  # the second has not overwritten the first
        frame, read = gpu.frame(t, held.fields), held.read()
        assert (read.t, read.fields, read.choppiness) == (t, held.fields, 0.9)
        assert (held.t, held.choppiness) == (t, 0.9)
        assert all(np.array_equal(read[name], frame[name]) for name in held.fields)
    assert repr(second) == "DeviceFrame(t=2.0, 64 x 32, height)"
    assert first.read(["slope_x"]).fields == ("slope_x",)
    with pytest.raises(fo.FieldError, match=r"for slope_x ask device_frame\(t, fields"):
        second["slope_x"]
    with pytest.raises(fo.FieldError, match="this frame has height; for normal ask"):
        second.read(["height", "normal"])


@pytest.mark.parametrize("at_once", [1, 4 * 64 * 32, 9 * 4 * 64 * 32, 2**28])
def test_fields_are_read_together_up_to_a_limit(monkeypatch, at_once):
    """As few copies as hold the limit, with every field in its own array."""
    gpu, _ = pair(n=(64, 32), size=200.0)
    expected = {name: gpu.device_frame(1.0, (name,)).read()[name] for name in ALL}
    held = gpu.device_frame(1.0, ALL)
    sizes, together = [], readback._read_together

    def counted(device, total, pairs):
        assert total == sum(array.nbytes for _, array in pairs)
        sizes.append((total, len(pairs)))
        together(device, total, pairs)

    monkeypatch.setattr(readback, "_AT_ONCE", at_once)
    monkeypatch.setattr(readback, "_read_together", counted)
    frame = held.read()
    assert all(np.array_equal(frame[name], expected[name]) for name in ALL)
    assert all(total <= at_once or count == 1 for total, count in sizes)
    following = [size for size, _ in sizes[1:]]
    field = 4 * 64 * 32
    assert all(total + field > at_once for (total, _), _ in zip(sizes, following, strict=False))


@pytest.mark.parametrize("piece", [1024, 1536])
def test_normals_in_pieces(monkeypatch, piece):
    """Of 4096 samples, whether the last piece is whole or not."""
    gpu, _ = pair(n=64, size=200.0)
    whole = gpu.frame(3.0, ("normal", "jacobian"))
    monkeypatch.setattr(synthesis, "_PIECE", piece)
    pieces = pair(n=64, size=200.0)[0].frame(3.0, ("normal", "jacobian"))
    assert all(np.array_equal(whole[name], pieces[name]) for name in whole.fields)


def test_bindings_of_kept_buffers_are_made_once(adapter):
    """And those of a frame's own buffers each time: another frame's may have their numbers."""
    gpu, _ = pair(n=16, size=200.0)
    gpu.frame(0.0, ALL)
    made, kept = adapter.devices[0].groups_made, len(gpu._synthesis._tables.kept.groups)
    assert made > 0
    gpu.frame(1.0, ALL)
    assert adapter.devices[0].groups_made == made
    for t in range(20):  # the buffers of one may lie where those of the last one lay
        seen, expected = gpu.device_frame(float(t)).read(EIGHT), gpu.frame(float(t))
        assert all(np.array_equal(seen[name], expected[name]) for name in EIGHT)
    assert adapter.devices[0].groups_made > made
    assert len(gpu._synthesis._tables.kept.groups) == kept


def test_oceans_share_a_device_and_take_turns(adapter):
    oceans = [pair(n=32, size=200.0, seed=seed) for seed in range(3)]
    for t in (1.0, 2.0):
        for gpu, cpu in oceans:
            assert apart(gpu.frame(t, ALL), cpu.frame(t, ALL)) <= CLOSE
    copied = pickle.loads(pickle.dumps(oceans[0][0]))
    assert np.array_equal(copied.frame(1.0).height, oceans[0][0].frame(1.0).height)
    assert len(adapter.devices) == 1


def test_a_lost_device_is_replaced_once(adapter, monkeypatch):
    gpu, _ = pair(n=32, size=200.0)
    expected, held = gpu.frame(1.0).height, gpu.device_frame(1.0)
    adapter.devices[0].destroy()
    assert np.array_equal(gpu.frame(1.0).height, expected)
    assert len(adapter.devices) == 2
    with pytest.raises(fo.DeviceError, match="was lost; compute the frame again"):
        held.read()
    submit = kernels.Dispatches.submit

    def fail(dispatches):
        dispatches._device.handle.destroy()
        submit(dispatches)

    monkeypatch.setattr(kernels.Dispatches, "submit", fail)
    with pytest.raises(fo.DeviceError, match="NumPy failed, and again on a new device, with 32 x"):
        gpu.frame(1.0)
    assert len(adapter.devices) == 3
    monkeypatch.undo()


def test_a_frame_of_the_process_before_a_fork_is_not_read(monkeypatch):
    gpu, _ = pair(n=16, size=200.0)
    held = gpu.device_frame(1.0)
    monkeypatch.setattr("os.getpid", lambda: -1)
    with pytest.raises(fo.DeviceError, match="cannot be read in a forked child"):
        held.read()


def test_the_adapter_is_named(monkeypatch):
    named = fo.gpu.adapter()
    assert (named.name, named.interface, named.driver) == ("NumPy", "Vulkan", np.__version__)
    assert named.is_software
    assert str(named).startswith(f"NumPy by Vulkan, driver {np.__version__}, in software on the p")
    card = gpu_in_numpy.Adapter(device="", vendor="", description="", adapter_type="DiscreteGPU")
    others = gpu_in_numpy.Adapter(backend_type="OpenGL"), card
    monkeypatch.setattr(devices, "_current", None)
    monkeypatch.setitem(sys.modules, "wgpu", gpu_in_numpy.module(*others))
    assert str(fo.gpu.adapter()).startswith("unnamed by Vulkan, driver unnamed; wgpu ")
    assert not fo.gpu.adapter().is_software


@pytest.mark.parametrize("n", [(2, 2), (4, 64), (512, 16), (1024, 8), (8, 1024), (1024, 2048)])
def test_each_step_reads_and_writes_every_sample_once(n):
    """So no sample is left from the tile before, and no two threads write to one place."""
    nx, ny = n
    for stage in stages.stages(nx, ny):
        line, sample = np.arange(stage.lines)[:, None], np.arange(stage.length)
        assert stage.length <= stages.MOST
        assert stage.groups * stages.PLACES >= stage.lines * stage.length
        assert (stage.groups - 1) * stages.PLACES < stage.lines * stage.length
        for element, out, within in (stage.read, stage.write):
            at = element * sample + out * (line // stage.inner) + within * (line % stage.inner)
            assert np.all(np.bincount(at.ravel(), minlength=nx * ny) == 1)
            assert at.size == nx * ny


def test_time_is_split_exactly():
    """Whole and 2^-64 parts of a moment, two's complement, and in 2^-32 of a loop."""

    def value(moment, loop):
        words = np.frombuffer(synthesis._block(moment, loop, 0, False, 1.0), np.uint32)[:4]
        low, high, part_low, part_high = (int(word) for word in words)
        whole = low + (high << 32)
        whole -= 2**64 if whole >= 2**63 else 0
        return whole + Fraction(part_low + (part_high << 32), 2**64)

    for t in (0.0, 1.5, -1.5, -1e12 + 0.25, 1e12 - 0.125):
        assert value(AtTime(t), None) == Fraction(t)
    assert value(InLoop(3, 2**32, True), 10.0) == 3
    third = value(InLoop(1, 3, True), 10.0)
    assert abs(third - Fraction(2**32, 3)) <= Fraction(1, 2**65)
