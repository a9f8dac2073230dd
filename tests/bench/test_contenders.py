"""Contenders compute the ocean's own fields, and the lower bound is eight inverse transforms."""

import numpy as np
import pytest

import fftocean as fo
from fftocean import transforms
from fftocean.bench import contenders
from fftocean.bench.contenders import (
    Careful,
    DirectSum,
    Fast,
    Textbook,
    floor,
    require_same_water,
    same_water,
)
from fftocean.bench.quick import WITHIN, ocean
from fftocean.errors import ParameterError
from fftocean.fields import EIGHT

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.SeaWarning")
SHALLOW = {"n": (24, 31), "size": (300.0, 200.0), "seed": 3}


def shallow(dtype="float64"):
    return fo.Ocean(
        fo.Sea.from_wind(speed=10.0, fetch=1e5, depth=8.0), **SHALLOW, dtype=dtype, choppiness=0.7
    )


@pytest.mark.parametrize(
    "make", [lambda: ocean(32, dtype="float64"), shallow], ids=["deep square", "shallow oblong"]
)
def test_all_compute_the_same_fields(make):
    own = make()
    assert same_water(own, Textbook(own)) < 1e-13  # two double-precision transforms of 1e3 points
    assert same_water(own, DirectSum(own)) < 1e-12  # the bound of the chain in float64
    assert same_water(own, Careful(own)) < 1e-6  # it is float32 itself
    assert same_water(own, Fast(own)) == 0.0


def test_waves_without_an_opposite_wave_are_the_same_too():
    """
    Of each pair k and -k only one wave is there: its other half in the spectrum turns with it, not
    with a wave of its own.
    """
    waves = [(1, 0, 0.5, 0.3), (-2, 3, 0.2, 1.0), (0, -4, 0.1, 2.0)]
    own = fo.Ocean.from_modes(waves, n=16, size=100.0, dtype="float64")
    for kind in (Textbook, DirectSum):
        assert same_water(own, kind(own)) < 1e-12
    assert same_water(own, Careful(own)) < 1e-6


def test_all_compute_the_same_fields_in_single_precision():
    own = ocean(32)
    assert (
        require_same_water(
            own, {"t": Textbook(own), "c": Careful(own), "d": DirectSum(own)}, within=WITHIN
        )
        < 1e-6
    )


def test_a_part_of_the_points_is_compared_where_it_is():
    own = ocean(16, dtype="float64")
    part = DirectSum(own, points=40)
    assert part.share == 40 / 256
    assert same_water(own, part) < 1e-12
    assert DirectSum(own, points=10**6).share == 1.0


@pytest.mark.parametrize("kind", [Textbook, Careful, DirectSum])
def test_other_fields_are_detected(kind):
    own, other = ocean(32), ocean(32, size=310.0)
    with pytest.raises(AssertionError, match="computes other fields"):
        require_same_water(own, {"it": kind(other)}, within=WITHIN)


def test_a_wrong_sign_is_detected():
    own = ocean(32)
    textbook = Textbook(own)
    textbook._filters[1] = -textbook._filters[1]
    with pytest.raises(AssertionError, match="textbook computes other fields"):
        require_same_water(own, {"textbook": textbook}, within=WITHIN)


@pytest.mark.parametrize("kind", [Fast, Textbook, Careful, DirectSum])
def test_no_two_calls_make_the_same_frame(kind, monkeypatch):
    own = ocean(8)
    seen = []
    contender = kind(own)
    if kind is Fast:
        real = fo.Ocean.frame
        monkeypatch.setattr(
            fo.Ocean, "frame", lambda self, t, *a, **k: (seen.append(t), real(self, t, *a, **k))[1]
        )
    else:
        real = kind.at
        monkeypatch.setattr(kind, "at", lambda self, t: (seen.append(t), real(self, t))[1])
    for _ in range(3):
        contender()
    assert len(set(seen)) == 3


def test_the_ocean_streams_into_its_own_arrays():
    fast = Fast(ocean(8), EIGHT)
    first = fast().height
    assert fast().height is first


LIBRARIES = [name for name in contenders._PLANNERS if transforms.loaded(name) is not None]


@pytest.mark.parametrize("library", LIBRARIES)
@pytest.mark.parametrize("n", [32, 45])
def test_the_lower_bound_is_eight_inverse_transforms_and_a_copy(library, n):
    """
    Filled with the spectra of known fields, it must give these fields back, n^2 times, and copy
    them.
    """
    bare = floor(n, library)
    fields = np.random.default_rng(n).standard_normal((8, n, n))
    bare.spectra[:] = np.fft.rfft2(fields)
    copied = bare()
    assert copied is bare.copied
    assert copied is not bare.fields
    np.testing.assert_array_equal(copied, bare.fields)
    assert np.max(np.abs(copied / n**2 - fields)) < 5e-7 * np.max(
        np.abs(fields)
    )  # Parseval's bound of float32 in RELIABILITY


@pytest.mark.parametrize("library", LIBRARIES)
@pytest.mark.parametrize("how", ["all at once", "one by one"])
def test_the_faster_of_two_plans_is_kept_and_both_are_right(library, how, monkeypatch):
    """The stop watch is artificial: it names the faster plan."""
    ways = iter(("all at once", "one by one"))
    monkeypatch.setattr(
        contenders.timeit, "repeat", lambda *_, **__: [1.0, 0.5 if next(ways) == how else 0.75]
    )
    bare = floor(20, library, count=3)
    assert bare.how == how
    fields = np.random.default_rng(2).standard_normal((3, 20, 20))
    bare.spectra[:] = np.fft.rfft2(fields)
    assert np.max(np.abs(bare() / 400.0 - fields)) < 5e-7 * np.max(np.abs(fields))


@pytest.mark.parametrize("library", LIBRARIES)
def test_buffers_of_the_lower_bound_stay_zero(library):
    bare = floor(16, library, count=2)
    for _ in range(3):
        bare()
    assert not bare.spectra.any()
    assert not bare.fields.any()
    assert (
        bare.spectra.ctypes.data % 64
        == bare.fields.ctypes.data % 64
        == bare.copied.ctypes.data % 64
        == 0
    )


def test_buffers_hold_zeros_after_planning(monkeypatch):
    def overwrite(spectra, _):
        spectra[:] = 7.0
        return lambda: None

    monkeypatch.setitem(contenders._PLANNERS, "scipy", lambda _: overwrite)
    assert not floor(8, "scipy", count=2).spectra.any()


def test_an_unknown_or_absent_library_is_refused(monkeypatch):
    with pytest.raises(
        ParameterError, match="library must be one of pyfftw, mkl, scipy, got 'fftpack'"
    ):
        floor(16, "fftpack")
    monkeypatch.setattr(contenders.transforms, "loaded", lambda _: None)
    with pytest.raises(ParameterError, match="'mkl' must be installed"):
        floor(16, "mkl")


def test_the_lower_bound_uses_the_library_of_oceans():
    """Of each backend that an ocean has there is a lower bound, and of no other."""
    for library in contenders._PLANNERS:
        installed = transforms.library(library) is not None
        assert (transforms.loaded(library) is not None) == installed
