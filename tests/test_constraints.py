"""
Seas with given crests and values: the direct sum, the conditional law over seeds, rarity by closed
forms, cascades, values that exclude each other, and what follows from the waves.
"""

import copy
import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

import fftocean as fo
from fftocean.moving_amplitudes import MovingAmplitudes

SEA = fo.Sea(
    fo.WaveSystem(
        spectrum=fo.JONSWAP.from_sea_state(hs=3.0, tp=8.0),
        spreading=fo.CosinePower(s=2.0 / math.radians(25.0) ** 2 - 1.0),
        direction=20.0,
    )
)
CREST = fo.Crest(height=3.3, x=123.4, y=77.7, t=13.1)
AT_REST = ("slope_x", "slope_y", "velocity_z", "displace_x", "displace_y")


def ocean(**arguments):
    return fo.Ocean(SEA, **{"n": 48, "size": 500.0, "seed": 5, "dtype": "float64", **arguments})


def cascade(**arguments):
    tiles = [(32, 500.0), (32, 90.0)]
    return fo.Cascade(SEA, tiles, **{"seed": 2, "dtype": "float64", **arguments})


def still_height(sea, *at):
    """The height above the still-water level, of the exact sum."""
    return fo.Query(sea, mode="exact").at(*at, "heights").heights


# What the waves have


@pytest.mark.parametrize("loop", [None, 40.0])
@pytest.mark.parametrize("made", [ocean, cascade])
def test_the_direct_sum_has_the_crest(made, loop):
    """3.3 m, level, at rest and in its place: to roundings of some thousand waves."""
    sea = fo.constrained(made(loop=loop), CREST)
    found = fo.gerstner.surface(sea, CREST.x, CREST.y, CREST.t)
    assert float(found.height) == pytest.approx(3.3, abs=3e-14)
    for name in AT_REST:
        assert abs(float(getattr(found, name))) < 3e-14, name
    assert type(sea) is type(made(loop=loop))


def test_the_loop_stays_exact():
    sea = fo.constrained(ocean(loop=40.0, dtype="float32"), CREST)
    assert np.array_equal(sea.loop_frame(0, 8).height, sea.loop_frame(8, 8).height)
    assert np.array_equal(sea.frame(0.0).height, sea.frame(40.0).height)
    back = fo.gerstner.surface(sea, CREST.x + 500.0, CREST.y - 1000.0, CREST.t + 80.0)
    assert float(back.height) == pytest.approx(3.3, abs=1e-11)  # on every tile and loop


def test_frames_and_queries_show_it_where_it_stands():
    """
    At a sample of the grid the frame has it; the query of the choppy surface has it at that place
    of the world, with a normal straight up, and water that does not rise.
    """
    free = ocean(n=64, choppiness=1.1)
    x, y = float(free.grid.x[20]), float(free.grid.y[41])
    sea = fo.constrained(free, fo.Crest(height=3.0, x=x, y=y, t=-7.0))
    assert sea.frame(-7.0).height[41, 20] == pytest.approx(3.0, abs=1e-12)
    for mode in ("bicubic", "exact"):
        found = fo.Query(sea, mode=mode, level="frame").at(x, y, -7.0)
        assert found.heights == pytest.approx(3.0, abs=1e-9)
        assert np.hypot(found.x0 - x, found.y0 - y) < 1e-9
        assert abs(found.velocities[2]) < 1e-9
        if mode == "exact":
            assert found.normals == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    around = fo.Query(sea, level="frame").at(
        x + np.linspace(-40.0, 40.0, 81)[:, None], y + np.linspace(-40.0, 40.0, 81), -7.0, "heights"
    )
    assert np.max(around.heights) < 3.05  # a value is fixed there, not the maximum


def test_far_away_and_years_later():
    """Phases are those of frames: reduced in cycles, with the same rounding of the frequency."""
    free = ocean(n=32)
    x, y, t = float(free.grid.x[7]) + 500.0 * 2e5, float(free.grid.y[3]) - 500.0 * 3e5, 1e8 + 0.25
    sea = fo.constrained(free, fo.Crest(height=2.0, x=x, y=y, t=t))
    frame = sea.frame(t, ("height", "slope_x", "displace_y", "velocity_z"))
    assert frame.height[3, 7] == pytest.approx(2.0, abs=1e-6)  # 5e7 m has 1e-8 m a digit
    for name in ("slope_x", "displace_y", "velocity_z"):
        assert abs(frame[name][3, 7]) < 1e-6


@pytest.mark.parametrize("amplitudes", ["gaussian", "fixed"])
@pytest.mark.parametrize("n", [(32, 27), (33, 32)])
def test_the_sea_passes_its_verification(amplitudes, n):
    """All fields against the direct sum: both signs of the column mx = 0, even and odd n."""
    free = ocean(n=n, size=(400.0, 370.0), amplitudes=amplitudes, dtype="float32", loop=50.0)
    sea = fo.constrained(free, fo.Crest(height=3.5, x=60.0, y=50.0, t=1.0))
    checks = {check.name: check for check in fo.verify(sea)}
    assert [name for name, check in checks.items() if not check.passed] == []
    assert checks["fixed values"].error < 1e-13
    assert "given the fixed values" in checks["m0 of this realisation"].against
    assert sea.amplitudes.draw == "constrained"
    assert not np.array_equal(sea.amplitudes.squares, free.amplitudes.squares)
    assert np.array_equal(sea.amplitudes.variance_forward, free.amplitudes.variance_forward)


def test_verification_finds_a_crest_that_is_gone():
    sea = fo.constrained(ocean(), CREST)
    waves = replace(sea.amplitudes, forward=0.9 * sea.amplitudes.forward)
    checks = fo.verify(sea.with_amplitudes(waves))
    assert "fixed values" in [check.name for check in checks if not check.passed]


def test_every_linear_field_can_be_fixed():
    """Eleven values at eleven places, by the direct sum."""
    names = (
        *("height", "displace_x", "displace_y", "slope_x", "slope_y", "stretch_xx", "stretch_xy"),
        *("stretch_yy", "velocity_x", "velocity_y", "velocity_z"),
    )
    fixes = [fo.Fix(name, 40.0 * i, 300.0 - 25.0 * i, i, 0.05) for i, name in enumerate(names)]
    sea = fo.constrained(ocean(n=32), *fixes)
    for fix in fixes:
        found = getattr(fo.gerstner.surface(sea, fix.x, fix.y, fix.t), fix.field)
        assert float(found) == pytest.approx(0.05, abs=1e-13), fix.field
    assert sea.rarity.degrees == len(names)
    assert sea.rarity.exceedance is None


# The law over seeds


def test_mean_and_variance_over_seeds_are_those_of_the_gaussian_law():
    """
    300 seeds: the mean height is cov Lambda^-1 b, its variance m0 - cov Lambda^-1 cov, at every
    sample. Both come from dense matrices of all waves here. z is the mean in standard errors: of
    256 correlated values, its rms is 1 to 0.2; the ratio of variances is 1 to sqrt(2/300) = 0.08
    over the root of the some 20 waves in the tile.
    """
    free = ocean(n=16, size=250.0, choppiness=0.0, backend="scipy")  # which is made soonest
    a, grid = free.amplitudes, free.grid
    crest = fo.Crest(height=3.0, x=110.0, y=90.0, t=4.0)
    rng, what = np.random.default_rng(8), crest.fixes(choppiness=1.0)
    half, heights = grid.nx // 2, []
    energy = np.zeros(grid.shape)  # at all (my, mx)
    energy[:, : half + 1] = a.variance_forward
    for mx in range(1, half):
        energy[:, -mx] = a.variance_backward[-np.arange(grid.ny) % grid.ny, mx]
    for _ in range(300):
        h0 = 0.5 * np.sqrt(energy) * (rng.normal(size=(16, 16)) + 1j * rng.normal(size=(16, 16)))
        backward = np.conj(h0[-np.arange(16) % 16][:, -np.arange(16) % 16])[:, : half + 1]
        waves = replace(a, forward=h0[:, : half + 1].copy(), backward=backward.copy())
        sea = fo.constrained(free.with_amplitudes(waves), *what)
        heights.append(sea.frame(4.0, ("height",)).height)
    iy, ix = np.nonzero(energy > 0.0)
    wavenumbers = np.fft.fftfreq(16, 250.0 / 16 / (2 * np.pi))
    kx, ky, energy = wavenumbers[ix], wavenumbers[iy], energy[iy, ix]
    k = np.hypot(kx, ky)
    omega = np.sqrt(9.80665 * k)
    x, y = (p.ravel() for p in np.meshgrid(grid.x, grid.y))
    functionals = np.array([0 * kx + 1, 1j * kx, 1j * ky, -1j * omega, 1j * kx / k, 1j * ky / k])
    functionals = functionals * np.exp(1j * (kx * 110.0 + ky * 90.0 - omega * 4.0))
    samples = np.exp(1j * (np.outer(x, kx) + np.outer(y, ky) - omega * 4.0))
    among = np.real((functionals * energy) @ functionals.conj().T)
    across = np.real((samples * energy) @ functionals.conj().T)
    inverse = np.linalg.inv(among)
    mean = across @ inverse @ np.array([3.0, 0, 0, 0, 0, 0])
    variance = np.sum(energy) - np.einsum("pi,ij,pj->p", across, inverse, across)
    found = np.array(heights).reshape(300, -1)
    away = variance > 0.05 * np.sum(energy)
    z = (found.mean(axis=0) - mean)[away] / np.sqrt(variance[away] / 300)
    assert 0.7 < np.sqrt(np.mean(z**2)) < 1.3
    ratio = found.var(axis=0, ddof=1)[away] / variance[away]
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.06)


def test_far_from_the_crest_the_sea_is_that_of_the_seed():
    """The mean wave of a crest dies off over some wavelengths; what is left is the seed's own."""
    free = ocean(n=128, size=1500.0)
    sea = fo.constrained(free, fo.Crest(height=4.0, x=750.0, y=750.0))
    change = sea.frame(0.0).height - free.frame(0.0).height
    distance = np.hypot(*np.meshgrid(free.grid.x - 750.0, free.grid.y - 750.0))
    near, far = np.std(change[distance < 60.0]), np.std(change[distance > 600.0])
    assert far < 0.1 * near


# Rarity


def test_rarity_of_one_height():
    """
    The height alone: b^2/m0 and (b - l)^2/m0, the tail of a normal distribution, Rayleigh's law.
    """
    free, b = ocean(n=32), 2.5
    own = float(fo.gerstner.surface(free, 40.0, 50.0, 3.0).height)
    m0 = free.amplitudes.variance
    rarity = fo.constrained(free, fo.Fix("height", 40.0, 50.0, 3.0, b)).rarity
    assert rarity.chi2_of_values == pytest.approx(b**2 / m0, rel=1e-12)
    assert rarity.chi2 == pytest.approx((b - own) ** 2 / m0, rel=1e-9)
    assert rarity.probability == pytest.approx(math.erfc(b / math.sqrt(2.0 * m0)), rel=1e-9)
    assert rarity.degrees == 1
    crest = fo.constrained(free, fo.Crest(height=b, x=40.0, y=50.0, t=3.0)).rarity
    assert crest.exceedance == pytest.approx(math.exp(-(b**2) / (2.0 * m0)), rel=1e-12)
    assert crest.m0 == pytest.approx(m0, rel=1e-12)
    assert "crest of 2.5 m at (40, 50) m, 3 s" in str(crest)
    share = math.exp(b**2 / (2.0 * m0))
    assert f"1 in {share:,.0f} crests" in str(crest)
    assert crest.as_plain()["values"][0] == {
        "field": "height", "x": 40.0, "y": 50.0, "t": 3.0, "value": 2.5
    }  # fmt: skip


def test_a_change_of_nothing_takes_nothing():
    """A sea that is made to have what it has anyhow stays as it is."""
    free = ocean(n=24)
    own = float(fo.gerstner.surface(free, 9.0, 8.0, 7.0).height)
    sea = fo.constrained(free, fo.Fix("height", 9.0, 8.0, 7.0, own))
    assert sea.rarity.chi2 < 1e-20
    assert np.max(np.abs(sea.amplitudes.forward - free.amplitudes.forward)) < 1e-15


@pytest.mark.parametrize("made", [ocean, cascade])
def test_the_crest_of_a_period_has_that_period(made):
    free = made()
    period = 3600.0 * 24.0 * 365.25 * 1000.0
    height = fo.crest_height(free, period)
    waves = free.modes()
    assert 1.5 * 3.0 < height < 1.8 * 3.0  # sqrt(2 ln(5e9))/4 = 1.67 Hs
    rarity = fo.constrained(free, fo.Crest(height=height)).rarity
    assert rarity.return_period == pytest.approx(period, rel=1e-6)
    assert "1,000 years" in str(rarity)
    assert 4.5 < rarity.period < 8.0  # between that of the shortest waves and the peak's
    assert waves.omega.size


# Several values, cascades, tiles


def test_a_trough_beside_a_crest():
    sea = fo.constrained(
        ocean(),
        fo.Crest(height=3.0, x=100.0, y=100.0, t=5.0),
        fo.Crest(height=-2.0, x=140.0, y=100.0, t=6.0),
    )
    for height, x, t in ((3.0, 100.0, 5.0), (-2.0, 140.0, 6.0)):
        found = fo.gerstner.surface(sea, x, 100.0, t)
        assert float(found.height) == pytest.approx(height, abs=1e-12)
    assert str(sea.rarity).startswith("crest of 3 m at (100, 100) m, 5 s, trough of 2 m at (140,")


def test_values_of_before_are_kept():
    """In two steps or in one: the same sea."""
    first, second = CREST, fo.Fix("height", 300.0, 200.0, 20.0, -1.0)
    one = fo.constrained(ocean(n=32), first, second)
    two = fo.constrained(fo.constrained(ocean(n=32), first), second)
    assert np.max(np.abs(one.amplitudes.forward - two.amplitudes.forward)) < 1e-13
    assert two.rarity.crests == (CREST,)
    assert two.rarity.fixes[-1] == second
    assert two.rarity.chi2_of_values == pytest.approx(one.rarity.chi2_of_values, rel=1e-9)


def test_a_tile_with_its_share_is_the_tile_of_the_cascade():
    """Each tile, made alone to have what it has of the sum, is that tile: so cascades are baked."""
    free = cascade(loop=60.0)
    sea = fo.constrained(free, CREST)
    total = 0.0
    for tile, own in zip(free.oceans, sea.oceans, strict=True):
        alone = fo.constrained(tile, *own.amplitudes.fixed)
        assert np.max(np.abs(alone.amplitudes.forward - own.amplitudes.forward)) < 1e-12
        assert np.max(np.abs(alone.amplitudes.backward - own.amplitudes.backward)) < 1e-12
        total += own.amplitudes.fixed[0].value
        assert all(check.passed for check in fo.verify(own))
    assert total == pytest.approx(3.3, abs=1e-13)
    assert sea.rarity.fixes[0].value == 3.3
    assert sea.oceans[1].rarity == sea.rarity


def test_without_choppiness_the_displacement_is_free():
    assert [fix.field for fix in CREST.fixes(0.0)] == ["height", *AT_REST[:3]]
    assert [fix.field for fix in CREST.fixes(0.5)] == ["height", *AT_REST]
    flat = fo.constrained(ocean(n=32, choppiness=0.0), CREST)
    assert flat.rarity.min_jacobian == 1.0
    assert flat.rarity.degrees == 4


def test_a_long_crested_sea_can_have_a_crest():
    """Its two slopes say the same: one condition fewer, and no refusal."""
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=7.0),
            spreading=fo.LongCrested(),
            direction=0.0,
        )
    )
    along = fo.constrained(
        fo.Ocean(sea, n=64, size=400.0, dtype="float64"), fo.Crest(height=2.0, x=50.0)
    )
    assert along.rarity.degrees == 4  # no slope and no displacement across
    assert float(fo.gerstner.surface(along, 50.0, 0.0, 0.0).height) == pytest.approx(2.0)
    waves = [(m, m, 0.1, 0.3 * m) for m in range(1, 9)]
    free = fo.Ocean.from_modes(waves, n=24, size=100.0, dtype="float64")
    diagonal = fo.constrained(free, fo.Crest(height=0.8, x=20.0, y=30.0))
    assert diagonal.rarity.degrees == 4
    found = fo.gerstner.surface(diagonal, 20.0, 30.0, 0.0)
    assert float(found.height) == pytest.approx(0.8, abs=1e-12)
    assert abs(float(found.slope_x)) + abs(float(found.slope_y)) < 1e-12
    with pytest.raises(fo.ParameterError, match=r"slope_y must be 0 at every place"):
        fo.constrained(
            fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=10.0),
            fo.Fix("slope_y", 0.0, 0.0, 0.0, 0.1),
        )


def test_what_excludes_itself_is_refused():
    """Two heights a hair apart, with both places in the message; the same one twice is one."""
    free = ocean(n=32)
    with pytest.raises(fo.ParameterError) as refused:
        fo.constrained(
            free,
            fo.Fix("height", 40.0, 50.0, 0.0, 1.0),
            fo.Fix("height", 200.0, 50.0, 0.0, 1.0),
            fo.Fix("height", 40.0 + 1e-7, 50.0, 0.0, 1.1),
        )
    message = str(refused.value)
    assert "height = 1 m at (40, 50) m, 0 s" in message
    assert "height = 1.1 m at (40, 50) m, 0 s" in message
    assert "too near each other" in message
    assert "200" not in message
    twice = fo.constrained(free, *2 * [fo.Fix("height", 40.0, 50.0, 0.0, 1.0)])
    assert twice.rarity.degrees == 1
    with pytest.raises(fo.ParameterError, match=" excludes ") as both:
        fo.constrained(free, *(fo.Crest(height=h, x=40.0, y=50.0) for h in (3.0, -3.0)))
    assert {"height = 3 m", "height = -3 m"} <= {
        part.partition(" at ")[0] for part in str(both.value).split(" excludes ")
    }
    with pytest.raises(fo.ParameterError, match="too few to have both"):
        fo.constrained(
            fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=10.0),
            fo.Fix("height", 1.0, 1.0, 0.0, 0.1),
            fo.Fix("stretch_xx", 1.0, 1.0, 0.0, 0.1),  # of one deep wave it is -k height
        )


# The whole surface


def test_the_height_of_another_surface():
    """
    Above the still-water level, which the set-down of the same waves moves; of a surface with a
    square; of two crests at once.
    """
    sea = fo.constrained(ocean(n=32), CREST, height_of=still_height)
    assert still_height(sea, CREST.x, CREST.y, CREST.t) == pytest.approx(3.3, rel=1e-9)
    assert 3.2 < sea.rarity.linear_heights[0] < 3.3
    assert sea.rarity.crests == (CREST,)

    def squared(sea, x, y, t):
        height = float(fo.gerstner.surface(sea, x, y, t).height)
        return height + 0.05 * height**2

    other = fo.Crest(height=-1.5, x=300.0, y=300.0, t=2.0)
    both = fo.constrained(ocean(n=32), CREST, other, height_of=squared)
    for crest, linear in zip((CREST, other), both.rarity.linear_heights, strict=True):
        assert linear + 0.05 * linear**2 == pytest.approx(crest.height, rel=1e-9)
    more = fo.constrained(both, fo.Fix("height", 0.0, 0.0, 0.0, 0.5), height_of=squared)
    assert more.rarity.linear_heights == pytest.approx(both.rarity.linear_heights, rel=1e-12)


def test_a_crest_of_second_order_has_its_height_with_the_bound_waves():
    """
    In the frame, by the transform of both orders; the linear part is lower, level and at rest, by
    the direct sum of the linear waves. A single value is that of the linear waves.
    """
    free = ocean(n=64, order=2, bound=80)
    x, y = float(free.grid.x[20]), float(free.grid.y[41])
    sea = fo.constrained(free, fo.Crest(height=4.5, x=x, y=y, t=6.0))
    assert sea.order == 2
    assert sea.frame(6.0, ("height",)).height[41, 20] == pytest.approx(4.5, abs=1e-8)
    linear = fo.gerstner.surface(sea.linear(), x, y, 6.0)
    assert float(linear.height) == pytest.approx(sea.rarity.linear_heights[0], abs=1e-12)
    assert 3.9 < float(linear.height) < 4.4
    assert abs(float(linear.slope_x)) + abs(float(linear.displace_y)) < 1e-12
    checks = {check.name: check.passed for check in fo.verify(sea)}
    assert checks["fixed values"]
    fixed = fo.constrained(free, fo.Fix("height", x, y, 6.0, 1.0))
    assert float(fo.gerstner.surface(fixed.linear(), x, y, 6.0).height) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("height_of", "says"),
    [
        (lambda *_: 1.0, "must lead to a height"),
        (lambda *_: math.nan, "must return a finite number"),
        (lambda *_: "high", "must return one number"),
    ],
)
def test_a_height_that_cannot_be_reached_is_refused(height_of, says):
    with pytest.raises(fo.ParameterError, match=says):
        fo.constrained(ocean(n=16), CREST, height_of=height_of)


def test_a_fold_is_said():
    with pytest.warns(fo.SeaWarning, match=r"folds at the time of the crest .*lower choppiness"):
        sea = fo.constrained(ocean(choppiness=6.0), fo.Crest(height=5.5, x=50.0, y=50.0))
    assert sea.rarity.min_jacobian < 0.0
    frame = sea.frame(0.0, ("jacobian",)).jacobian
    assert sea.rarity.min_jacobian == pytest.approx(float(frame.min()))


# As a value


def test_a_constrained_sea_is_a_frozen_value_like_any():
    """Equal bits at every making; pickled, copied, with other settings, exported."""
    sea = fo.constrained(cascade(loop=60.0, dtype="float32"), CREST)
    again = fo.constrained(cascade(loop=60.0, dtype="float32"), CREST)
    for other in (again, pickle.loads(pickle.dumps(sea)), copy.copy(sea)):
        assert other.rarity == sea.rarity
        for one, two in zip(sea.frame(5.0), other.frame(5.0), strict=True):
            assert np.array_equal(one.height, two.height)
    tile = sea.oceans[0]
    calm = tile.with_amplitudes(tile.amplitudes, choppiness=0.0)
    assert calm.rarity == sea.rarity
    assert tile.seed == 2
    assert fo.measure(sea).hs > 0.0
    with pytest.raises(AttributeError):
        tile.rarity = None
    assert ocean().rarity is None
    assert cascade().rarity is None


def test_the_waves_of_a_package_have_the_crest(tmp_path):
    """
    A package has single precision: 1e-7 of each wave, of which there are some thousand. Its
    document says how rare the crest is.
    """
    sea = fo.constrained(cascade(loop=60.0), CREST)
    document = fo.export_sea(sea, tmp_path)
    found = fo.gerstner.surface(fo.load_sea(tmp_path), CREST.x, CREST.y, CREST.t)
    assert float(found.height) == pytest.approx(3.3, abs=1e-5)
    assert '"in_words": "crest of 3.3 m' in (tmp_path / "sea.json").read_text("utf-8")
    assert document is None or document
    data = fo.to_xarray(sea.oceans[0], [0.0], maps=("height",))
    assert data.attrs["constrained"] == str(sea.rarity)


def test_waves_of_a_moving_sea_cannot_be_constrained_ones():
    with pytest.raises(fo.ParameterError, match="must not be constrained"):
        MovingAmplitudes(fo.constrained(cascade(), CREST))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: fo.constrained(SEA, CREST), "source must be an Ocean or a Cascade"),
        (lambda: fo.constrained(ocean(n=8)), "at least one Crest or Fix"),
        (lambda: fo.constrained(ocean(n=8), 3.0), "what must be Crest or Fix"),
        (lambda: fo.Crest(height=math.nan), "height must be"),
        (lambda: fo.Crest(height=0.0), "height must not be 0"),
        (lambda: fo.Crest(height=1.0, t=1e13), "t must be"),
        (lambda: fo.Crest(height=1.0, x=math.inf), "x must be"),
        (lambda: fo.Fix("normal", 0.0, 0.0, 0.0, 1.0), "field must be one of height"),
        (lambda: fo.Fix("height", 0.0, 0.0, 0.0, math.inf), "value must be"),
        (lambda: fo.crest_height(ocean(n=8), 1.0), "return_period must be longer"),
        (lambda: fo.crest_height(SEA, 1e6), "source must be"),
        (
            lambda: fo.crest_height(fo.Ocean.from_modes([], n=8, size=10.0), 1e6),
            "without waves has no crests",
        ),
    ],
)
def test_bad_input_is_refused(make, says):
    with pytest.raises(fo.ParameterError, match=says):
        make()


def test_plots_say_what_was_fixed():
    """The sheet of a job's ocean names the crest, and does not rate its height by chance."""
    sea = fo.constrained(ocean(n=32), CREST)
    sheet = fo.plots.plot_job(sea)
    titles = [
        sheet.get_suptitle(),
        *(part.get_suptitle() for row in sheet.subfigs for part in row.subfigs),
    ]
    assert "with crest of 3.3 m at (123.4, 77.7) m, 13.1 s" in titles[0]
    assert any(title.endswith("with fixed values in it") for title in titles)
