"""The block scheme is the table in `fields.py`, whatever is asked of it."""

import math
import threading
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fftocean as fo
from fftocean import synthesis
from fftocean.fields import FIELDS, multiplier
from fftocean.frame import Frame
from fftocean.synthesis import PAIRS, plan_fields
from fftocean.transforms import BACKENDS, library

SEA = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=12.0, direction=30.0)
FULL = ("height", "displace_x", "displace_y", "normal", "jacobian")


def by_the_table(ocean, name, t):
    """
    A field as `fields.py` reads: h(k, t), or its rate, times the multiplier, and numpy's inverse
    transform.
    """
    a = ocean.amplitudes
    phase = np.exp(-1j * a.running_omega * t)
    h = a.forward * phase + a.backward * np.conj(phase)
    if FIELDS[name].dt:
        h = -1j * a.running_omega * (a.forward * phase - a.backward * np.conj(phase))
    kx, ky = np.broadcast_arrays(ocean.grid.kx[None, :], ocean.grid.ky[:, None])
    return np.fft.irfft2(
        multiplier(FIELDS[name], kx, ky, ocean.depth) * h, s=ocean.grid.shape, norm="forward"
    )


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("n", [(128, 72), (72, 128), (130, 70)])
@pytest.mark.parametrize("threads", [1, 2, 3])
def test_arrays_written_past_the_caches_have_the_same_bytes(n, threads, dtype, monkeypatch):
    """Of any length of rows: only those of whole cache lines are written so."""
    ocean = fo.Ocean(SEA, n=n, size=(150.0, 90.0), dtype=dtype, threads=threads)
    fields = (*FIELDS, "normal", "jacobian")
    usual = ocean.frame(3.0, fields)
    out = ocean.frame(1.0, fields)
    monkeypatch.setattr(synthesis, "STREAMED_FROM", 0)
    streamed = ocean.frame(3.0, fields, out=out)
    whole_lines = n[0] * np.dtype(dtype).itemsize % 64 == 0
    assert synthesis._are_streamed({name: out[name] for name in fields}) == whole_lines
    for name in fields:
        assert streamed[name].tobytes() == usual[name].tobytes(), name


def test_arrays_that_start_amid_a_cache_line_are_written_too(monkeypatch):
    ocean = fo.Ocean(SEA, n=64, size=100.0)
    usual = ocean.frame(3.0)
    monkeypatch.setattr(synthesis, "STREAMED_FROM", 0)
    odd = {name: np.empty(64 * 64 + 1, np.float32)[1:].reshape(64, 64) for name in usual.fields}
    assert not synthesis._are_streamed(odd)
    out = Frame(0.0, usual.grid, usual.choppiness, odd)
    frame = ocean.frame(3.0, out=out)
    for name in usual.fields:
        assert frame[name].tobytes() == usual[name].tobytes()


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
    Heights of metres beside slopes of 1e-5, or of 0.1 mm beside slopes of 1: in float32 each field
    is good to 1e-6 of its own largest value. Two share a complex row and its rounding errors;
    without their weights this fails by a factor of thousands.
    """
    waves = [
        (1, 0, 1e-3 * size, 0.3),
        (3, 2, 5e-4 * size, 1.0),
        (-2, 5, 3e-4 * size, 2.0),
        (0, -4, 2e-4 * size, 4.0),
    ]
    single, double = (
        fo.Ocean.from_modes(waves, n=24, size=size, depth=depth, dtype=dtype)
        for dtype in ("float32", "float64")
    )
    a, b = single.frame(1.0, tuple(FIELDS)), double.frame(1.0, tuple(FIELDS))
    for name in FIELDS:
        assert np.max(np.abs(a[name] - b[name])) < 1e-6 * np.max(np.abs(b[name])), name
        truth = by_the_table(double, name, 1.0)
        assert np.max(np.abs(b[name] - truth)) < 1e-13 * np.max(np.abs(truth)), name


@pytest.mark.parametrize("backend", [name for name in BACKENDS if library(name)])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_any_number_of_threads_gives_the_same_bytes(dtype, backend):
    oceans = [
        fo.Ocean(SEA, n=(130, 70), size=150.0, dtype=dtype, backend=backend, threads=threads)
        for threads in (1, 2, 3, 5)
    ]
    frames = [ocean.frame(8.1, (*FIELDS, "normal", "jacobian")) for ocean in oceans]
    for frame in frames[1:]:
        assert all(np.array_equal(frame[name], frames[0][name]) for name in frame.fields)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("backend", [name for name in BACKENDS if library(name)])
@pytest.mark.parametrize("n", [(64, 48), 33, (7, 50), (100, 18), 61, 1, (2, 200)])
@pytest.mark.parametrize("threads", [1, 3])
def test_transforms_called_from_python_give_the_same_frames(
    n, threads, backend, dtype, monkeypatch
):
    """
    Plans without addresses are called between the loops from Python: the same fields to the
    rounding of the transforms.
    """
    make = {
        "n": n,
        "size": (150.0, 90.0),
        "dtype": dtype,
        "backend": backend,
        "threads": threads,
        "order": 2,
    }
    fields = (*FIELDS, "normal", "jacobian")
    usual = fo.Ocean(SEA, **make)
    monkeypatch.setattr(synthesis, "row_plan", lambda *_: None)
    other = fo.Ocean(SEA, **make)
    assert usual._synthesis._workspaces[0].compiled == (backend != "scipy")
    assert not other._synthesis._workspaces[0].compiled
    a, b = usual.frame(3.3, fields), other.frame(3.3, fields)
    eps = {"float32": 1e-6, "float64": 2e-15}[dtype]
    for name in fields:
        apart = np.max(np.abs(a[name] - b[name]))
        assert apart <= 2.0 * eps * np.max(np.abs(b[name]), initial=0.0), name


@pytest.mark.parametrize(
    ("wave", "size"),
    [((1, 100), 60.0), ((100, 1), 60.0), ((3, 5), (1e5, 10.0)), ((3, 5), (10.0, 1e5))],
)
def test_waves_nearly_along_an_axis_do_not_spoil_the_derivatives_along_the_other(wave, size):
    """
    kx and ky of one wave a factor of a hundred or of ten thousand apart: float32 is good to 1e-6 of
    each field's largest value.
    """
    waves = [(*wave, 1e-4, 0.3)]
    single, double = (
        fo.Ocean.from_modes(waves, n=256, size=size, dtype=dtype)
        for dtype in ("float32", "float64")
    )
    a, b = single.frame(1.0, tuple(FIELDS)), double.frame(1.0, tuple(FIELDS))
    for name in FIELDS:
        assert np.max(np.abs(a[name] - b[name])) < 1e-6 * np.max(np.abs(b[name])), name


def test_weights_are_powers_of_two():
    """Powers of two round nothing."""
    weights = fo.Ocean(SEA, n=16, size=100.0)._synthesis._weights
    assert all(math.log2(weight).is_integer() for weight in weights.values())


def test_no_wave_is_subnormal():
    """
    A narrow swell on a large tile has waves far below what float32 can hold; as subnormal numbers
    they would cost ten times the time.
    """
    swell = fo.WaveSystem(
        spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=12.0), spreading=fo.CosinePower(s=1000.0)
    )
    waves = np.abs(fo.Ocean(fo.Sea(swell), n=64, size=5000.0)._synthesis._waves)
    assert np.count_nonzero(waves) > 100
    assert np.min(waves[waves > 0.0]) > np.finfo(np.float32).tiny
    tiny = fo.Ocean.from_modes([(1, 2, 1e-30, 0.0)], n=16, size=1.0).frame(0.0, ("height",))
    assert np.max(tiny.height) == pytest.approx(1e-30, rel=1e-2)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("n", [(64, 40), (7, 50)])
def test_a_field_has_the_same_bits_whatever_is_asked_beside_it(n, dtype):
    ocean = fo.Ocean(SEA, n=n, size=(150.0, 90.0), dtype=dtype)
    together = ocean.frame(2.5, (*FIELDS, "normal", "jacobian"))
    for name in together.fields:
        assert np.array_equal(ocean.frame(2.5, (name,))[name], together[name]), name


def test_five_passes_then_four_for_eight_fields():
    plan = plan_fields(
        (
            "height",
            "displace_x",
            "displace_y",
            "slope_x",
            "slope_y",
            "stretch_xx",
            "stretch_xy",
            "stretch_yy",
        )
    )
    assert (len(plan.half_spectra), len(plan.rows)) == (5, 4)
    full = plan_fields(FULL)
    assert (len(full.half_spectra), len(full.rows), len(full.linear)) == (5, 4, 8)
    height = plan_fields(("height",))
    assert (len(height.half_spectra), len(height.rows)) == (1, 1)
    assert sorted(name for pair in PAIRS for name in pair) == sorted(FIELDS)


def test_buffers_do_not_depend_on_what_is_asked():
    ocean = fo.Ocean(SEA, n=16, size=100.0)
    workspace = ocean._synthesis._workspaces[0]
    for name in FIELDS:
        ocean.frame(0.0, (name,))
    assert ocean._synthesis._workspaces == [workspace]


def test_what_a_narrow_block_leaves_behind_is_harmless():
    """
    The last block is narrower than its buffers: the rows beyond it stay finite, and frames stay the
    same.
    """
    ocean = fo.Ocean(SEA, n=(90, 70), size=100.0, dtype="float32")
    first = ocean.frame(1.0)
    for t in range(50):
        ocean.frame(float(t))
    again = ocean.frame(1.0)
    assert all(np.array_equal(first[name], again[name]) for name in first.fields)
    workspace = ocean._synthesis._workspaces[0]
    assert np.all(np.isfinite(workspace._results))
    assert np.all(np.isfinite(workspace._result))


def test_an_interrupted_thread_waits_for_the_others():
    """If one thread raises, the lock must stay taken while another still writes."""
    tile = fo.Ocean(SEA, n=256, size=100.0, threads=2)._synthesis
    first = tile._workspaces[0]
    still_at_it, begun = [], threading.Event()

    def work(workspace, _):
        if workspace is first:
            begun.wait(600.0)
            raise KeyboardInterrupt
        still_at_it.append(True)
        begun.set()
        time.sleep(0.2)
        still_at_it.pop()

    with pytest.raises(KeyboardInterrupt):
        tile._run_blocks(2, 1, work)
    assert not still_at_it


@pytest.mark.parametrize("failing", [0, 1])
def test_a_thread_that_fails_keeps_no_other_waiting(failing, monkeypatch):
    """Its blocks of the first pass will never be done; the error is raised, and all goes on."""
    ocean = fo.Ocean(SEA, n=64, size=100.0, threads=2)
    usual = ocean.frame(2.0)
    fails = ocean._synthesis._workspaces[failing]
    first_pass = type(fails).first_pass

    def broken(workspace, counter, *rest):
        if workspace is fails:
            counter[0] += 1  # takes a block, and leaves it
            raise MemoryError("no room")
        while not counter[0]:
            time.sleep(1e-3)  # so that the other takes one
        first_pass(workspace, counter, *rest)

    monkeypatch.setattr(type(fails), "first_pass", broken)
    with pytest.raises(MemoryError, match="no room"):
        ocean.frame(2.0)
    monkeypatch.undo()
    assert all(np.array_equal(ocean.frame(2.0)[name], usual[name]) for name in usual.fields)


def test_the_second_pass_waits_for_blocks_that_others_are_at():
    """However long they take: the pauses between two looks grow, to a thousandth of a second."""
    done = np.zeros(1, np.int64)
    waiting = threading.Thread(target=synthesis._wait_for, args=(done, 3))
    waiting.start()
    waiting.join(0.1)
    assert waiting.is_alive()
    done[0] = 3
    waiting.join(60.0)
    assert not waiting.is_alive()


@pytest.mark.parametrize("threads", [0, -1, 1.5, "2", True])
def test_bad_thread_counts_are_refused(threads):
    with pytest.raises(fo.ParameterError, match="threads must be"):
        fo.Ocean(SEA, n=8, size=10.0, threads=threads)


def fields_against_the_direct_sum(ocean):
    """
    Hold every field to 1e-6 (1e-12 in double precision) of its own largest value; return the
    largest value of each.
    """
    omega = float(np.max(ocean.modes().omega, initial=1.0))
    t = 0.37 / omega
    x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
    truth = fo.gerstner.surface(ocean, x, y, t)
    frame = ocean.frame(t, (*FIELDS, "normal", "jacobian"))
    assert all(np.all(np.isfinite(frame[name])) for name in frame.fields)
    top = {name: float(np.max(np.abs(getattr(truth, name)))) for name in FIELDS}
    # Waves below 1e-30 of the largest are left out in single precision (1e-154 in double), and so
    # is what they make of a field, be it
    # all of it; 1e-22 (1e-140) of its partner in the complex row or its kind allows for wavenumbers
    # far apart.
    bound, floor, least = (
        (1e-6, 1e-22, 1e-36) if ocean.dtype == "float32" else (1e-12, 1e-140, 1e-302)
    )
    for pair in PAIRS:
        for name in pair:
            near = {
                *pair,
                *(other for other in FIELDS if other.partition("_")[0] == name.partition("_")[0]),
            }
            allowed = max(bound * top[name], floor * max(top[other] for other in near), least)
            assert (
                np.max(np.abs(frame[name].astype(np.float64) - getattr(truth, name))) <= allowed
            ), (name, ocean.dtype)
    c, xx, xy, yy = ocean.choppiness, truth.stretch_xx, truth.stretch_xy, truth.stretch_yy
    largest = np.max(
        (1.0 + c * np.abs(xx)) * (1.0 + c * np.abs(yy)) + (c * xy) ** 2
    )  # a difference of two products
    assert (
        np.max(np.abs(frame.jacobian - ((1.0 + c * xx) * (1.0 + c * yy) - (c * xy) ** 2)))
        <= 4.0 * bound * largest
    )
    assert np.linalg.norm(frame.normal.astype(np.float64), axis=-1) == pytest.approx(1.0, rel=1e-5)
    return top


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("beside", [0.0, 1e-300, 1e-200, 1e-60, 1e-40, 1e-30, 1e-20, 1e-10, 1e-3])
@pytest.mark.parametrize("along", ["x", "y"])
def test_a_field_that_is_tiny_beside_its_partner_is_finite_and_right(along, beside, dtype):
    """
    One wave along an axis, another along the other one of any size: single precision overflowed
    where they were 1e-38 apart.
    """
    a, b = (
        [(3, 0, 1.0, 0.3), (0, 2, beside, 1.0)]
        if along == "x"
        else [(0, 3, 1.0, 0.3), (2, 0, beside, 1.0)]
    )
    top = fields_against_the_direct_sum(
        fo.Ocean.from_modes([a, b], n=(16, 12), size=(60.0, 90.0), dtype=dtype)
    )
    assert top["slope_y" if along == "x" else "slope_x"] <= beside


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("amplitude", [1e-310, 1e-300, 1e-44, 1e-38, 1e-20, 1e4])
def test_waves_at_the_ends_of_the_range(amplitude, dtype):
    fields_against_the_direct_sum(
        fo.Ocean.from_modes(
            [(1, 2, amplitude, 0.3), (-3, 1, 0.1 * amplitude, 2.0)], n=16, size=1e3, dtype=dtype
        )
    )


def test_no_wave_across_makes_no_field_across():
    frame = fo.Ocean.from_modes([(3, 0, 1.0, 0.3), (-5, 0, 0.3, 1.0)], n=16, size=60.0).frame(
        1.0, tuple(FIELDS)
    )
    assert not any(
        np.any(frame[name])
        for name in ("slope_y", "displace_y", "stretch_xy", "stretch_yy", "velocity_y")
    )


SAMPLES = st.one_of(st.sampled_from([1, 2, 3, 5, 8, 13]), st.integers(1, 24))
SPREADINGS = st.one_of(
    st.floats(-1.0, 2.2).map(lambda x: fo.WrappedNormal(spread=10.0**x)),
    st.floats(-3.0, 6.0).map(lambda x: fo.CosinePower(s=10.0**x)),
    st.floats(0.0, 1.0).map(lambda w: fo.Blend(fo.LongCrested(), fo.CosineSquared(), weight=w)),
    st.sampled_from(
        [fo.LongCrested(), fo.DonelanBanner(), fo.CosineN(n=0.0), fo.Mitsuyasu(speed=10.0)]
    ),
)
DEPTHS = st.sampled_from([math.inf, 1e-6, 0.01, 1.0, 30.0])


def widths(low, high):
    return st.floats(math.log10(low), math.log10(high)).map(lambda x: 10.0**x)


@settings(max_examples=20, deadline=None, derandomize=True)
@given(
    n=st.tuples(SAMPLES, SAMPLES),
    lengths=widths(0.3, 30.0),
    aspect=st.one_of(st.just(1.0), widths(1e-3, 1e3)),
    spreading=SPREADINGS,
    direction=st.one_of(st.sampled_from([0.0, 90.0, 45.0, 180.0, 1e6]), st.floats(-400.0, 400.0)),
    tp=widths(0.05, 900.0),
    depth=DEPTHS,
    choppiness=st.floats(0.0, 10.0),
    draw=st.sampled_from(["gaussian", "fixed"]),
)
def test_every_sea_has_finite_fields_that_are_right(
    n, lengths, aspect, spreading, direction, tp, depth, choppiness, draw
):
    """
    Any tile, odd, prime, oblong or of one sample; any spreading and direction: a refusal, or fields
    that are the direct sum's.
    """
    wavelength = 9.80665 * tp**2 / (2.0 * math.pi)
    hs = min(0.02 * wavelength, 0.5 * depth, 100.0)
    spectrum = fo.JONSWAP.from_sea_state(hs=hs, tp=tp)
    sea = fo.Sea(
        fo.WaveSystem(spectrum=spectrum, spreading=spreading, direction=direction), depth=depth
    )
    size = tuple(min(max(lengths * wavelength * a, 1e-3), 1e7) for a in (1.0, aspect))
    for dtype in ("float32", "float64"):
        fields_against_the_direct_sum(
            fo.Ocean(sea, n=n, size=size, choppiness=choppiness, dtype=dtype, amplitudes=draw)
        )


WAVES = st.lists(
    st.tuples(
        st.integers(-11, 11),
        st.integers(-11, 11),
        st.one_of(st.just(0.0), widths(1e-300, 1e4)),
        st.floats(-7.0, 7.0),
    ),
    max_size=6,
)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    n=st.tuples(SAMPLES, SAMPLES),
    size=st.tuples(widths(1e-3, 1e7), widths(1e-3, 1e7)),
    depth=DEPTHS,
    waves=WAVES,
)
def test_all_given_waves_have_finite_fields_that_are_right(n, size, depth, waves):
    """
    Waves of any size beside each other: a refusal where a field would overflow, or fields that are
    the direct sum's.
    """
    held = [
        w
        for w in waves
        if (w[0] or w[1])
        and all(abs(m) <= (samples - 1) // 2 for m, samples in zip(w[:2], n, strict=True))
    ]
    for dtype in ("float32", "float64"):
        try:
            ocean = fo.Ocean.from_modes(held, n=n, size=size, depth=depth, dtype=dtype)
        except fo.ParameterError as error:
            if "waves must keep" not in str(error):
                raise
        else:
            fields_against_the_direct_sum(ocean)
