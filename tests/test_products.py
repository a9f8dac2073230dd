"""
Normals, Jacobian and smallest eigenvalue of the deformation gradient, in closed form on one wave
and from the tangents of a surface of many.
"""

import math

import numpy as np
import pytest

import fftocean as fo

A, M, L, C = 0.7, (2, 1), 60.0, 1.2


@pytest.fixture(scope="module")
def one_wave():
    """Return the frame of one wave, its phase [rad] at every sample (ny, nx), kx, ky, k [rad/m]."""
    ocean = fo.Ocean.from_modes([(*M, A, 0.4)], n=32, size=L, dtype="float64", choppiness=C)
    x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
    kx, ky = (2 * np.pi * m / L for m in M)
    k = math.hypot(kx, ky)
    t = 1.9
    return ocean.frame(t), kx * x + ky * y - math.sqrt(9.80665 * k) * t - 0.4, kx, ky, k


def test_closed_form_on_one_wave(one_wave):
    """
    For height a cos f: D = -a (k/|k|) sin f, so the deformation is 1 - c a |k| cos f along k and 1
    across it; its product is the Jacobian, its smaller value the smallest eigenvalue, and the
    normal leans along k by -slope/(1 - c a |k| cos f).
    """
    frame, f, kx, ky, k = one_wave
    along = 1.0 - C * A * k * np.cos(f)
    assert np.max(np.abs(fo.jacobian(frame) - along)) < 1e-13
    assert np.max(np.abs(fo.minimum_eigenvalue(frame) - np.minimum(along, 1.0))) < 1e-13
    lean = A * k * np.sin(f)
    length = np.sqrt(along**2 + lean**2)
    normal = np.stack([lean * kx / k / length, lean * ky / k / length, along / length], axis=-1)
    assert np.max(np.abs(fo.normals(frame) - normal)) < 1e-13


def test_fields_normal_and_jacobian_equal_the_functions(one_wave):
    frame = one_wave[0]
    ocean = fo.Ocean.from_modes([(*M, A, 0.4)], n=32, size=L, dtype="float64", choppiness=C)
    asked = ocean.frame(frame.t, fields=("normal", "jacobian"))
    assert asked.fields == ("normal", "jacobian")
    assert np.array_equal(asked.normal, fo.normals(frame))
    assert np.array_equal(asked.jacobian, fo.jacobian(frame))


def test_normal_is_square_to_the_displaced_surface():
    """
    Against differences of positions of the exact surface: neighbours h = 1e-4 m away on either side
    give the tangents to (k h)^2/6 = 1e-8 relative; nothing here uses slopes or stretches.
    """
    sea = fo.Sea.from_wind(speed=9.0, fetch=50e3, depth=20.0, direction=-40.0)
    ocean = fo.Ocean(sea, n=24, size=60.0, seed=4, dtype="float64", choppiness=0.9)
    x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
    h = 1e-4

    def position(x, y):
        s = fo.gerstner.surface(ocean, x, y, 2.0)
        return np.stack([s.x, s.y, s.z], axis=-1)

    cross = np.cross(
        position(x + h, y) - position(x - h, y), position(x, y + h) - position(x, y - h)
    )
    normal = fo.normals(ocean.frame(2.0))
    assert np.max(np.abs(normal - cross / np.linalg.norm(cross, axis=-1, keepdims=True))) < 1e-7
    assert np.max(np.abs(np.linalg.norm(normal, axis=-1) - 1.0)) < 1e-15 * 4
    assert np.max(np.abs(fo.jacobian(ocean.frame(2.0)) - cross[..., 2] / (4 * h * h))) < 1e-6


@pytest.mark.parametrize("choppiness", [0.0, 1.0, 1.6])
def test_mean_of_the_jacobian_is_one(choppiness):
    """
    The displaced tile has the area of the still one: a periodic map's Jacobian averages to 1
    (1e-12: roundings of 64^2 samples).
    """
    sea = fo.Sea.from_wind(speed=15.0, fetch=300e3)
    ocean = fo.Ocean(sea, n=64, size=300.0, dtype="float64", choppiness=choppiness)
    for t in (0.0, 7.7):
        assert abs(np.mean(fo.jacobian(ocean.frame(t))) - 1.0) < 1e-12


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_crests_have_a_jacobian_below_one(dtype):
    """
    Correlation(height, Jacobian) < 0: the sign of i in the displacement. -i, as often printed,
    gives it the other sign.
    """
    ocean = fo.Ocean(fo.Sea.from_wind(speed=10.0, fetch=100e3), n=64, size=150.0, dtype=dtype)
    frame = ocean.frame(1.0)
    assert np.corrcoef(frame.height.ravel(), fo.jacobian(frame).ravel())[0, 1] < -0.5
    # and crests of the displaced surface are sharper than its troughs: sampled evenly in x0, crests
    # get more than their share of y
    top, bottom = (
        frame.height > np.quantile(frame.height, 0.95),
        frame.height < np.quantile(frame.height, 0.05),
    )
    assert np.mean(fo.jacobian(frame)[top]) < 0.9 < 1.05 < np.mean(fo.jacobian(frame)[bottom])


def test_folded_water_has_a_negative_jacobian_and_a_normal_that_points_down():
    ocean = fo.Ocean.from_modes(
        [(1, 0, 2.0, 0.0)], n=16, size=10.0, dtype="float64"
    )  # a k = 1.26 > 1: folded at the crest
    frame = ocean.frame(0.0)
    assert fo.jacobian(frame)[0, 0] == pytest.approx(1.0 - 2.0 * 2 * np.pi / 10.0)
    assert fo.minimum_eigenvalue(frame)[0, 0] < 0.0
    assert np.allclose(fo.normals(frame)[0, 0], [0.0, 0.0, -1.0])


@pytest.mark.parametrize("steepness", [0.3, 0.9, 1.5])
def test_folds_of_one_wave(steepness):
    """
    D' = -a k cos f along the wave and 0 across: folded where c a k cos f > 1, which is arccos(1/(c
    a k))/pi of a period; the smallest Jacobian is 1 - c a k, and no fold is left at c = 1/(a k).
    Samples at 2 pi i/n miss each by their spacing.
    """
    n, k = 512, 2.0 * math.pi / 20.0
    ocean = fo.Ocean.from_modes(
        [(1, 0, steepness / k, 0.0)], n=(n, 4), size=20.0, dtype="float64", choppiness=1.0
    )
    found = fo.folding(ocean.frame(0.0))
    share = math.acos(1.0 / steepness) / math.pi if steepness > 1.0 else 0.0
    assert found.share == pytest.approx(share, abs=1.0 / n)
    assert found.min_jacobian == pytest.approx(1.0 - steepness, abs=1e-12)  # a crest is at a sample
    assert found.largest_choppiness == pytest.approx(1.0 / steepness, rel=1e-12)
    assert found.samples == 4 * n
    below, above = (
        fo.folding(ocean.frame(0.0), choppiness=found.largest_choppiness * f)
        for f in (1.0 - 1e-9, 1.0 + 1e-9)
    )
    assert below.share == 0.0 < above.share


def test_folds_of_a_sea_equal_those_of_the_direct_sum():
    """
    Over a loop, with some samples folded: against LAPACK's eigenvalues of the direct sum's
    displacement gradient.
    """
    sea = fo.Sea.from_wind(speed=12.0, fetch=100e3)
    ocean = fo.Ocean(sea, n=24, size=80.0, seed=3, loop=60.0, dtype="float64", choppiness=5.0)
    found = fo.folding(ocean.loop_frames(5))
    x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
    lowest, jacobian = [], []
    for j in range(5):
        s = fo.gerstner.surface(ocean, x, y, 60.0 * j / 5)
        gradient = np.stack(
            [s.stretch_xx, s.stretch_xy, s.stretch_xy, s.stretch_yy], axis=-1
        ).reshape(*x.shape, 2, 2)
        lowest.append(np.linalg.eigvalsh(gradient)[..., 0])
        jacobian.append(np.linalg.det(np.eye(2) + 5.0 * gradient))
    assert found.samples == 5 * 24 * 24
    assert found.share == np.mean(1.0 + 5.0 * np.array(lowest) < 0.0) > 0.0
    assert found.min_jacobian == pytest.approx(np.min(jacobian), rel=1e-9)
    assert found.largest_choppiness == pytest.approx(-1.0 / np.min(lowest), rel=1e-9)
    each = [fo.folding(ocean.loop_frame(j, 5)) for j in range(5)]
    assert sum(one.share for one in each) / 5 == pytest.approx(found.share)


def test_flat_water_never_folds_and_bad_frames_are_refused():
    flat = fo.Ocean.from_modes([], n=4, size=10.0).frame(0.0)
    found = fo.folding(flat)
    assert (found.share, found.min_jacobian, found.largest_choppiness) == (0.0, 1.0, math.inf)
    assert str(found) == "none of the water is folded, smallest Jacobian 1; no choppiness folds it"
    assert "up to 1.42 does not fold it" in str(
        fo.Folding(0.0, 0.3, 1.42999, 1)
    )  # never rounded up
    with pytest.raises(fo.ParameterError, match="got none"):
        fo.folding([])
    with pytest.raises(fo.FieldError, match="for stretch_xx ask"):
        fo.folding(fo.Ocean.from_modes([], n=4, size=10.0).frame(0.0, ("height",)))
    ocean = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=4, size=10.0)
    for wrong in (ocean, 3, None, flat.height):
        for make in (fo.folding, fo.normals, fo.jacobian, fo.minimum_eigenvalue):
            with pytest.raises(
                fo.ParameterError, match=r"frame must be a Frame, such as ocean.frame\(t\), got "
            ):
                make(wrong)
