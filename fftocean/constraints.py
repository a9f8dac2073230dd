"""
Seas that have given values at given places and times: the law of Gaussian waves, conditioned.

With the complex amplitudes z of the waves, independent and of the variances E a part (a^2/2 has the
mean E), a value of a field at a place and time is l = sum of Re(c z), where c is the field's
multiplier times e^{i(k.x - omega t)}. Values l_p, l_q have the covariance Lambda_pq = sum of
E Re(c_p c_q*). The waves that have the values b, and are otherwise those of the seed, are

    z + E sum over q of c_q* lambda_q,     Lambda lambda = b - l.

Over seeds these are exactly the waves of the Gaussian sea, given the values: kriging in
meteorology, NewWave for the mean of a crest of given height (Tromans, Anaturk & Hagemeijer 1991),
constrained NewWave for the sea round it (Taylor, Jonathan & Harland 1997).
"""

import math
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import Complex, Integer, Real
from fftocean.cascade import Cascade, from_oceans
from fftocean.errors import ParameterError, SeaWarning, described
from fftocean.fields import FIELDS, multiplier
from fftocean.fixed_values import Crest, Fix, Rarity
from fftocean.kernels import passes
from fftocean.limits import Quantity
from fftocean.ocean import Ocean
from fftocean.physics import dispersion
from fftocean.query import Query
from fftocean.window import Window

Source = TypeVar("Source", Ocean, Cascade)
HeightOf = Callable[[Any, float, float, float], Any]
"""Returns the height [m] of a surface at (x, y) [m] and t [s] for a sea."""

PERIOD = Quantity("s", 1e-3, 1e18)
LEAST_EIGENVALUE = 1e-12
"""Of the correlations of the values, over the largest: below, they say the same twice."""
AGREE = 1e-9
"""Standard deviations by which values that say the same twice may differ."""
_BLOCK = 2**15  # waves at a time
_ROUNDS = 40
_ACCURATE = 1e-10  # of the crest's height

__all__ = ["Crest", "Fix", "Rarity", "constrained", "crest_height"]


def constrained(source: Source, *what: Crest | Fix, height_of: HeightOf | None = None) -> Source:
    """
    Return a sea with given crests, or values of fields, at given places and times.

    Its waves are those of the Gaussian sea under that condition: near the place the mean wave of
    such a crest, far away the waves of the seed. Everything else is as before: frames are pure
    functions of t, loops are exact. Values that the sea was made to have before are kept.

    `rarity` of the result, and of its tiles, says how unusual the values are.

    Args:
        source: an `Ocean` or a `Cascade`.
        what: crests, and single values of fields.
        height_of: function (sea, x, y, t) that returns the height [m] of a surface that follows
            from the waves; the height of each crest is then that of this surface, found by the
            secant method. None is the height of frames: the sum of waves, at order 2 with the bound
            waves. For heights above the still-water level:
            lambda sea, *at: fo.Query(sea, mode="exact").at(*at).heights

    At order 2 the values of `Fix` and the zeros of a crest are those of the waves of first order.

    The crest comes back on every repetition of the tile in space, and of the loop in time. A sea
    of fixed amplitudes no longer has them fixed. Only waves that have energy in the sea can move: a
    sea of a few waves may not be able to have the values.

    The condition is the value at a place, not that of a maximum there: the largest crest of a
    random sea is, besides, weighted with the curvature of the surface (Slepian's model; Lindgren
    1970). The mean wave is the same in the limit of high crests.

    Raises:
        ParameterError: another source, nothing to fix, values that the waves cannot have, or two
            that exclude each other (places and times too near each other: the message names both);
            `height_of` that does not lead to the height.

    Warns:
        SeaWarning: the surface folds at that time.

    Source: Taylor, Jonathan & Harland 1997 (J. Offshore Mechanics and Arctic Engineering 119).
    Pinned by tests/test_constraints.py: the direct sum; mean and variance over seeds.
    """
    if not isinstance(source, (Ocean, Cascade)):
        raise ParameterError(f"source must be an Ocean or a Cascade, got {described(source)}")
    if not what:
        raise ParameterError("what must be at least one Crest or Fix, got none")
    for item in what:
        if not isinstance(item, (Crest, Fix)):
            raise ParameterError(f"what must be Crest or Fix, got {described(item)}")
    tiles = source.oceans if isinstance(source, Cascade) else (source,)
    before = tiles[0].amplitudes.rarity
    values = _Values.of(what, source.choppiness, before)
    law = _Law(tiles, values.fixes)
    heights = np.array(values.heights)
    made = law.apply(values.targets(heights))
    if height_of is None and source.order == 2:
        height_of = _height_in_frames
    if height_of is not None and values.new:
        heights, made = _whole(source, law, values, made, height_of)
    b = values.targets(heights)
    rarity = Rarity(
        fixes=tuple(replace(f, value=float(v)) for f, v in zip(values.fixes, b, strict=True)),
        crests=values.crests,
        linear_heights=tuple(float(h) for h in heights),
        chi2=law.chi2(b - law.own),
        chi2_of_values=law.chi2(b),
        degrees=law.degrees,
        m0=law.m0,
        period=2.0 * math.pi * math.sqrt(law.m0 / law.m2),
        min_jacobian=_least_jacobian(source, made, values.fixes),
    )
    if rarity.min_jacobian <= 0.0:
        warnings.warn(
            f"the surface folds at the time of the {'crest' if values.crests else 'values'} "
            f"(least Jacobian {rarity.min_jacobian:.2f}): no water of that height looks like that; "
            f"a lower choppiness than {source.choppiness:g} or a lower crest does not fold",
            SeaWarning,
            stacklevel=2,
        )
    return _sea_of(source, [replace(a, rarity=rarity) for a in made])


def crest_height(source: Ocean | Cascade, return_period: float) -> float:
    """
    Return the height of the crest that comes once in a period at one place, if the sea lasts [m].

    By Rayleigh's law: sqrt(2 m0 ln(return_period / mean zero-upcrossing period)).

    Args:
        source: an `Ocean` or a `Cascade`; its expected energy counts, not that of the seed.
        return_period: mean time between two such crests [s].

    Raises:
        ParameterError: another source, one without waves, or a time shorter than a wave.
    """
    if not isinstance(source, (Ocean, Cascade)):
        raise ParameterError(f"source must be an Ocean or a Cascade, got {described(source)}")
    tiles = source.oceans if isinstance(source, Cascade) else (source,)
    law = _Law(tiles, ())
    if not law.m0 > 0.0:
        raise ParameterError("a sea without waves has no crests")
    period = 2.0 * math.pi * math.sqrt(law.m0 / law.m2)
    return_period = PERIOD.check("return_period", return_period)
    if not return_period > period:
        raise ParameterError(
            f"return_period must be longer than the {period:.3g} s of a wave, "
            f"got {return_period:g} s"
        )
    return math.sqrt(2.0 * law.m0 * math.log(return_period / period))


@dataclass(frozen=True, slots=True)
class _Values:
    """The values to fix, and the crests among them."""

    fixes: tuple[Fix, ...]
    crests: tuple[Crest, ...]
    at: tuple[int, ...]  # number of the fix that is the height of each crest
    heights: tuple[float, ...]  # of the sum of waves at each crest, to begin with [m]
    new: tuple[int, ...]  # numbers of the crests that were not there before

    @classmethod
    def of(cls, what: Sequence[Crest | Fix], choppiness: float, before: Rarity | None) -> "_Values":
        """Return the values of crests and fixes, after those of an earlier sea."""
        fixes = list(before.fixes) if before else []
        crests, at, heights, new = [], [], [], []
        if before:
            for crest, height in zip(before.crests, before.linear_heights, strict=True):
                here = (crest.x, crest.y, crest.t)
                (first, *_) = [
                    i for i, f in enumerate(fixes) if f.field == "height" and f.place == here
                ]
                crests.append(crest)
                at.append(first)
                heights.append(height)
        for item in what:
            if isinstance(item, Fix):
                fixes.append(item)
            else:
                new.append(len(crests))
                crests.append(item)
                at.append(len(fixes))
                heights.append(item.height)
                fixes += item.fixes(choppiness)
        return cls(tuple(fixes), tuple(crests), tuple(at), tuple(heights), tuple(new))

    def targets(self, heights: Real) -> Real:
        """Return all values, with those heights of the crests."""
        b = np.array([fix.value for fix in self.fixes])
        b[list(self.at)] = heights
        return b


class _TileWaves:
    """The waves of one tile that have energy, each once, and where they stand in its arrays."""

    def __init__(self, amplitudes: Amplitudes) -> None:
        a, grid = amplitudes, amplitudes.grid
        self.amplitudes = a
        ahead, against = a.variance_forward > 0.0, a.variance_backward > 0.0
        against[:, 0] = False  # there they are the same waves as ahead, once more
        self._ahead, self._against = np.nonzero(ahead), np.nonzero(against)
        rows, columns = (
            np.concatenate(pair) for pair in zip(self._ahead, self._against, strict=True)
        )
        sign = np.repeat([1, -1], [self._ahead[0].size, self._against[0].size])
        self.mx: Integer = sign * grid.mx[columns]
        self.my: Integer = sign * grid.my[rows]
        self.omega: Real = a.running_omega[rows, columns]
        self.energy = np.concatenate([a.variance_forward[ahead], a.variance_backward[against]])
        h0 = np.concatenate([a.forward[ahead], np.conj(a.backward[against])])
        self.z: Complex = np.asarray(2.0 * h0, dtype=np.complex128)

    def blocks(self) -> Iterator[slice]:
        """Yield parts of the waves that fit the cache."""
        for start in range(0, self.energy.size, _BLOCK):
            yield slice(start, start + _BLOCK)

    def coefficients(self, fixes: Sequence[Fix], part: slice) -> Complex:
        """Return c of each value and wave, (values, waves)."""
        grid, depth = self.amplitudes.grid, self.amplitudes.depth
        kx, ky, omega = self.mx[part] * grid.dkx, self.my[part] * grid.dky, self.omega[part]
        out = np.empty((len(fixes), kx.size), np.complex128)
        phasors: dict[tuple[float, float, float], Complex] = {}
        for row, fix in zip(out, fixes, strict=True):
            if fix.place not in phasors:
                phasors[fix.place] = self._phasors(fix, part)
            field = FIELDS[fix.field]
            row[:] = multiplier(field, kx, ky, depth) * phasors[fix.place]
            for _ in range(field.dt):
                row *= -1j * omega
        return out

    def _phasors(self, fix: Fix, part: slice) -> Complex:
        """Return e^{i(k.x - omega t)}; phases are reduced in cycles, as those of frames are."""
        a = self.amplitudes
        turns = np.empty((1, self.omega[part].size))
        frequency = dispersion.turns_per_second(self.omega[None, part])
        if a.loop is None:
            passes.phases_at(frequency, fix.t, turns)
        else:
            passes.phases_at(np.rint(frequency * a.loop), math.fmod(fix.t, a.loop) / a.loop, turns)
        x, y = math.fmod(fix.x, a.grid.lx) / a.grid.lx, math.fmod(fix.y, a.grid.ly) / a.grid.ly
        cycles = np.remainder(self.mx[part] * x, 1.0) + np.remainder(self.my[part] * y, 1.0)
        phasors: Complex = np.exp(2j * np.pi * (cycles - turns[0]))
        return phasors

    def with_z(self, z: Complex, fixed: tuple[Fix, ...]) -> Amplitudes:
        """Return amplitudes of these waves, which have those values of their own."""
        a, grid = self.amplitudes, self.amplitudes.grid
        forward, backward = (np.array(h, order="F") for h in (a.forward, a.backward))
        count = self._ahead[0].size
        forward[self._ahead] = 0.5 * z[:count]
        backward[self._against] = 0.5 * np.conj(z[count:])
        # the column mx = 0 holds both k and -k
        backward[:, 0] = np.conj(forward[-np.arange(grid.ny) % grid.ny, 0])
        return replace(a, forward=forward, backward=backward, draw="constrained", fixed=fixed)


class _Law:
    """The covariance of the values, and the waves that have them."""

    def __init__(self, tiles: Sequence[Ocean], fixes: Sequence[Fix]) -> None:
        self._fixes = tuple(fixes)
        self._tiles = [_TileWaves(tile.amplitudes) for tile in tiles]
        count = len(self._fixes)
        covariance, self.own = np.zeros((count, count)), np.zeros(count)
        self.m0 = self.m2 = 0.0
        for tile in self._tiles:
            self.m0 += float(np.sum(tile.energy))
            self.m2 += float(np.sum(tile.energy * tile.omega**2))
            for part in tile.blocks() if count else ():
                c = tile.coefficients(self._fixes, part)
                for p, row in enumerate(c):  # without BLAS, whose sums depend on its threads
                    weighted = tile.energy[part] * row
                    self.own[p] += float(np.sum((row * tile.z[part]).real))
                    for q in range(p + 1):
                        covariance[p, q] += float(np.sum((weighted * np.conj(c[q])).real))
        covariance += np.tril(covariance, -1).T
        self._scale = np.sqrt(np.diagonal(covariance))
        moving = self._scale > 0.0
        correlation = covariance / np.outer(
            np.where(moving, self._scale, 1.0), np.where(moving, self._scale, 1.0)
        )
        values, self._vectors = np.linalg.eigh(correlation)
        self._eigenvalues = values
        self._kept = values > LEAST_EIGENVALUE * np.max(values, initial=0.0)
        self.degrees = int(np.count_nonzero(self._kept))

    def apply(self, b: Real) -> list[Amplitudes]:
        """
        Return the waves of each tile that have the values b.

        Raises:
            ParameterError: they cannot have them.
        """
        z: list[Complex] = [tile.z for tile in self._tiles]
        left: Real = b - self.own
        self._require_possible(left, b)
        for _ in range(3):  # the first does it; the others take away what is left by rounding
            factors = self._solve(left)
            z = [
                self._moved(tile, waves, factors)
                for tile, waves in zip(self._tiles, z, strict=True)
            ]
            shares = [self._read(tile, waves) for tile, waves in zip(self._tiles, z, strict=True)]
            left = b - np.sum(shares, axis=0)
            size = np.maximum(np.abs(b), self._scale)
            if np.all(np.abs(left) <= 16.0 * np.finfo(np.float64).eps * size):
                break
        return [
            tile.with_z(waves, self._held(share))
            for tile, waves, share in zip(self._tiles, z, shares, strict=True)
        ]

    def _held(self, values: Real) -> tuple[Fix, ...]:
        """Return the fixes with other values."""
        return tuple(replace(f, value=float(v)) for f, v in zip(self._fixes, values, strict=True))

    def chi2(self, values: Real) -> float:
        """Return values Lambda^-1 values."""
        return float(values @ self._solve(values))

    def _moved(self, tile: _TileWaves, z: Complex, factors: Real) -> Complex:
        out = np.empty_like(z)
        for part in tile.blocks():
            pull = np.zeros(z[part].shape, np.complex128)
            for factor, row in zip(factors, tile.coefficients(self._fixes, part), strict=True):
                pull += factor * np.conj(row)
            out[part] = z[part] + tile.energy[part] * pull
        return out

    def _read(self, tile: _TileWaves, z: Complex) -> Real:
        found = np.zeros(len(self._fixes))
        for part in tile.blocks():
            for p, row in enumerate(tile.coefficients(self._fixes, part)):
                found[p] += float(np.sum((row * z[part]).real))
        return found

    def _solve(self, values: Real) -> Real:
        """Return Lambda^-1 values, in the directions in which values differ."""
        scale = np.where(self._scale > 0.0, self._scale, np.inf)
        v, w = self._vectors[:, self._kept], self._eigenvalues[self._kept]
        solved: Real = (v @ ((v.T @ (values / scale)) / w)) / scale
        return solved

    def _require_possible(self, left: Real, b: Real) -> None:
        """Raise if values are impossible: none of the waves makes them, or two exclude another."""
        for fix, scale, value in zip(self._fixes, self._scale, b, strict=True):
            if not scale > 0.0 and value != 0.0:
                raise ParameterError(
                    f"{fix.field} must be 0 at every place, as no wave of this sea has any, "
                    f"got {replace(fix, value=float(value))}"
                )
        scaled = np.divide(left, self._scale, out=np.zeros_like(left), where=self._scale > 0.0)
        tolerance = AGREE * max(1.0, float(np.max(np.abs(scaled), initial=0.0)))
        lost = self._vectors[:, ~self._kept]
        parts = lost.T @ scaled
        if np.any(np.abs(parts) > tolerance):
            impossible = lost @ parts  # of each value; 0 where values agree with the others
            one, other = (self._fixes[i] for i in np.argsort(-np.abs(impossible))[:2])
            if one.place != other.place:
                reason = f"{one} and {other} are too near each other to be chosen apart"
            elif one.field == other.field:
                reason = f"{one} excludes {other}"
            else:
                reason = f"the waves of this sea are too few to have both {one} and {other}"
            raise ParameterError(
                f"{reason}: the condition number of the values' correlations must be at most "
                f"{1.0 / LEAST_EIGENVALUE:.0e}"
            )


def _sea_of(source: Source, made: Sequence[Amplitudes]) -> Source:
    """Return the ocean or cascade of other waves."""
    if isinstance(source, Ocean):
        return source.with_amplitudes(made[0])
    oceans = tuple(
        ocean.with_amplitudes(own) for ocean, own in zip(source.oceans, made, strict=True)
    )
    return from_oceans(source.sea, source.seed, oceans)


def _whole(
    source: Source,
    law: _Law,
    values: _Values,
    made: list[Amplitudes],
    height_of: HeightOf,
) -> tuple[Real, list[Amplitudes]]:
    """
    Return the heights of the sum of waves whose whole surface has the crests' heights, and the
    waves, by a secant for each crest.

    Raises:
        ParameterError: it does not converge, or `height_of` returns no number.
    """
    new = list(values.new)
    goal = np.array([values.crests[i].height for i in new])

    def measured(made: Sequence[Amplitudes]) -> Real:
        sea, found = _sea_of(source, made), np.empty(len(new))
        for j, i in enumerate(new):
            crest = values.crests[i]
            try:
                found[j] = float(height_of(sea, crest.x, crest.y, crest.t))
            except (TypeError, ValueError) as error:
                raise ParameterError(f"height_of must return one number: {error}") from None
            if not math.isfinite(found[j]):
                raise ParameterError(f"height_of must return a finite number, got {found[j]}")
        return found

    heights = np.array(values.heights)
    found = measured(made)
    slope = np.ones(len(new))  # of the whole height over that of the sum of waves
    for _ in range(_ROUNDS):
        if np.all(np.abs(found - goal) <= _ACCURATE * np.abs(goal)):
            return heights, made
        step = np.clip((goal - found) / slope, -0.5 * np.abs(goal), 0.5 * np.abs(goal))
        heights[new] += step
        made = law.apply(values.targets(heights))
        last, found = found, measured(made)
        rise = np.divide(found - last, step, out=slope.copy(), where=np.abs(step) > 0.0)
        slope = np.where(rise > 0.05, np.minimum(rise, 20.0), slope)
    raise ParameterError(
        f"height_of must lead to a height of {goal.tolist()} m, and has "
        f"{found.tolist()} m after {_ROUNDS} rounds"
    )


def _height_in_frames(sea: Ocean | Cascade, x: float, y: float, t: float) -> Any:
    """Return the height of frames at the water that rests at (x, y), with all waves."""
    return Query(sea, mode="exact", level="frame").at(x, y, t, "heights").heights


def _least_jacobian(
    source: Ocean | Cascade, made: Sequence[Amplitudes], fixes: Sequence[Fix]
) -> float:
    """
    Return the least Jacobian at the times of the values: over the tile of an ocean; of a cascade
    on a window as wide as its smallest tile about each place.
    """
    if source.choppiness == 0.0:
        return 1.0
    if isinstance(source, Ocean):
        sea = source.with_amplitudes(made[0])
        return min(
            float(np.min(sea.frame(t, ("jacobian",)).jacobian)) for t in {fix.t for fix in fixes}
        )
    grid, least = source.oceans[-1].grid, math.inf
    whole = _sea_of(source, made)
    for x, y, t in {fix.place for fix in fixes}:
        corner = x - grid.lx / 2.0, y - grid.ly / 2.0
        window = Window(
            whole, n=(grid.nx, grid.ny), size=(grid.lx, grid.ly), x=corner[0], y=corner[1]
        )
        least = min(least, float(np.min(window.frame(t, ("jacobian",)).jacobian)))
    return least
