"""The block scheme is the table in `fields.py`, whatever is asked of it."""

import numpy as np
import pytest

import fftocean as fo
from fftocean.fields import FIELDS, multiplier
from fftocean.synthesis import plan_of

SEA = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=12.0, direction=30.0)
FULL = ("height", "displace_x", "displace_y", "normal", "jacobian")


def by_the_table(ocean, name, t):
    """A field as `fields.py` reads: h(k, t), or its rate, times the multiplier, and numpy's inverse transform."""
    a = ocean.amplitudes
    phase = np.exp(-1j * a.running_omega * t)
    h = a.forward * phase + a.backward * np.conj(phase)
    if FIELDS[name].dt:
        h = -1j * a.running_omega * (a.forward * phase - a.backward * np.conj(phase))
    kx, ky = np.broadcast_arrays(ocean.grid.kx[None, :], ocean.grid.ky[:, None])
    return np.fft.irfft2(multiplier(FIELDS[name], kx, ky, ocean.depth) * h, s=ocean.grid.shape, norm="forward")


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("n", [(64, 40), 33, (7, 50), (100, 18)])
def test_every_field_is_its_row_of_the_table(n, threads):
    """Alone, and with all others: 1e-13 of the largest value; n is not a multiple of the blocks."""
    ocean = fo.Ocean(SEA, n=n, size=(150.0, 90.0), dtype="float64", threads=threads)
    together = ocean.frame(2.5, tuple(FIELDS))
    for name in FIELDS:
        truth = by_the_table(ocean, name, 2.5)
        scale = np.max(np.abs(truth))
        assert np.max(np.abs(together[name] - truth)) < 1e-13 * scale, name
        assert np.max(np.abs(ocean.frame(2.5, (name,))[name] - truth)) < 1e-13 * scale, name


@pytest.mark.parametrize("depth", [np.inf, 0.05])
@pytest.mark.parametrize("size", [0.02, 1.0, 1e3, 1e5])
def test_fields_of_unlike_size_do_not_spoil_each_other(size, depth):
    """
    Heights of metres beside slopes of 1e-5, or of 0.1 mm beside slopes of 1: in float32 each field is good to 1e-6 of its own largest
    value. Two share a complex row and its rounding errors; without their weights this fails by a factor of thousands.
    """
    waves = [(1, 0, 1e-3 * size, 0.3), (3, 2, 5e-4 * size, 1.0), (-2, 5, 3e-4 * size, 2.0), (0, -4, 2e-4 * size, 4.0)]
    single, double = (fo.Ocean.from_modes(waves, n=24, size=size, depth=depth, dtype=dtype) for dtype in ("float32", "float64"))
    a, b = single.frame(1.0, tuple(FIELDS)), double.frame(1.0, tuple(FIELDS))
    for name in FIELDS:
        assert np.max(np.abs(a[name] - b[name])) < 1e-6 * np.max(np.abs(b[name])), name
        truth = by_the_table(double, name, 1.0)
        assert np.max(np.abs(b[name] - truth)) < 1e-13 * np.max(np.abs(truth)), name


@pytest.mark.parametrize("backend", ["pyfftw", "scipy"])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_any_number_of_threads_gives_the_same_bytes(dtype, backend):
    oceans = [fo.Ocean(SEA, n=(130, 70), size=150.0, dtype=dtype, backend=backend, threads=threads) for threads in (1, 2, 5)]
    frames = [ocean.frame(8.1, (*FIELDS, "normal", "jacobian")) for ocean in oceans]
    for frame in frames[1:]:
        assert all(np.array_equal(frame[name], frames[0][name]) for name in frame.fields)


def test_five_passes_then_four_for_eight_fields():
    plan = plan_of(("height", "displace_x", "displace_y", "slope_x", "slope_y", "stretch_xx", "stretch_xy", "stretch_yy"))
    assert (len(plan.columns), len(plan.pairs)) == (5, 4)
    full = plan_of(FULL)
    assert (len(full.columns), len(full.pairs), len(full.linear)) == (5, 4, 8)
    height = plan_of(("height",))
    assert (len(height.columns), len(height.pairs)) == (1, 1)


def test_many_different_requests_do_not_pile_up():
    """Buffers of the last few field sets are kept, no more."""
    ocean = fo.Ocean(SEA, n=16, size=100.0)
    names = list(FIELDS)
    for i in range(len(names)):
        for j in range(i):
            ocean.frame(0.0, (names[i], names[j]))
    assert len(ocean._synthesis._desks) <= 8


def test_thousands_of_frames_do_not_grow():
    """What is left in the buffers of the last, narrow block must not be transformed over and over."""
    ocean = fo.Ocean(SEA, n=18, size=100.0, dtype="float32")
    for _ in range(300):
        frame = ocean.frame(1.0)
    desk = next(iter(ocean._synthesis._desks.values()))[0]
    assert np.max(np.abs(desk.first.rows)) < 1e3
    assert np.max(np.abs(desk.second.rows)) < 1e3
    assert np.all(np.isfinite(frame.height))


@pytest.mark.parametrize("threads", [0, -1, 1.5, "2", True])
def test_bad_thread_counts_are_refused(threads):
    with pytest.raises(fo.ParameterError, match="threads must be"):
        fo.Ocean(SEA, n=8, size=10.0, threads=threads)
