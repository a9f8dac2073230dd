"""
Foam of breaking waves.

Foam is made where water breaks, stays with that water, and decays:

    df/dt = -f / tau + strength max(threshold - lambda, 0),

at each rest position; lambda is the smallest eigenvalue of the deformation gradient (Tessendorf
2001), which is 1 on still water and 0 where a crest folds. The equation is linear in f, but not in
the waves: the foam of a cascade follows from the summed displacement gradient, and is no sum or
product of the foams of its tiles.

So a step of any length is an exponential and an integral, and on a loop of period T the state that
returns to itself is known in closed form: f(0) = g / (1 - e^{-T/tau}), where g is the foam that one
period makes on clean water. Only the coverage saturates: patches laid down at random with density f
cover 1 - e^{-f} of the water.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fftocean.arrays import Real
from fftocean.cascade import Cascade
from fftocean.errors import ParameterError
from fftocean.fields import DISPLACEMENT_GRADIENT, potential_factor
from fftocean.foam_coverage import COVERAGE, threshold_for, threshold_of_coverage
from fftocean.frame import Frame
from fftocean.kernels import foam as kernel
from fftocean.kernels import surface
from fftocean.limits import FOAM_STRENGTH, FOAM_TAU, FOAM_THRESHOLD, FRAMES, TIME, keep_checked
from fftocean.ocean import Ocean
from fftocean.window import Window

SPAN = 16
"""Frames of a loop that are baked from one stored state."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Foam:
    """
    Parameters of foam: `loop` gives the foam of a loop, `live` that of a running sea.

    The defaults: foam of breaking waves fades in 3.5 s (Monahan 1986: 3.53 s in sea water), and the
    waves of a 10 m/s wind cover about 1 % of the sea (Monahan & O'Muircheartaigh 1980), at
    choppiness 1 and samples 0.8 m apart. The eigenvalues of linear waves hardly depend on the wind,
    but they do on choppiness and on the shortest wave: with finer samples or more choppiness use a
    lower threshold, for storms a higher one. `whitecaps` finds it for a wind, and `covering` for a
    share of the water, whatever the samples and the choppiness.

    Args:
        tau: time in which foam decays to 1/e [s].
        threshold: smallest eigenvalue of the deformation gradient below which water foams: 1 is
            still water, 0 a fold [-].
        strength: foam made per second and unit of eigenvalue below the threshold [1/s].

    Raises:
        ParameterError: a parameter out of its range.
    """

    tau: float = 3.5
    threshold: float = 0.72
    strength: float = 60.0

    def __post_init__(self) -> None:
        keep_checked(self, tau=FOAM_TAU, threshold=FOAM_THRESHOLD, strength=FOAM_STRENGTH)

    @classmethod
    def covering(
        cls,
        source: Cascade | Ocean,
        fraction: float,
        *,
        tau: float = 3.5,
        strength: float = 60.0,
        shortest: float = 0.0,
    ) -> "Foam":
        """
        Return the foam that covers a share of some water, on average over space and time.

        The threshold follows from the covariance of the stretches, a sum over the waves; no frame
        is computed. The foam of frames covers the share within a tenth or so.

        Args:
            source: the water; its choppiness and its shortest waves matter, its samples do not.
            fraction: share of the water, 0 to 0.95; with 0 there is no foam.
            tau, strength: as of `Foam`.
            shortest: waves shorter than this are left out [m], as by `Window`.

        Raises:
            ParameterError: no cascade or ocean, or a value out of range.
        """
        COVERAGE.check("fraction", fraction)
        threshold = threshold_of_coverage(
            source, fraction, tau=tau, strength=strength, shortest=shortest
        )
        return cls(tau=tau, threshold=threshold, strength=strength)

    @classmethod
    def whitecaps(
        cls,
        source: Cascade | Ocean,
        wind_speed: float,
        *,
        tau: float = 3.5,
        strength: float = 60.0,
        shortest: float = 0.0,
    ) -> "Foam":
        """
        Return the foam that covers as much of some water as whitecaps cover in a wind, on average.

        The share is 3.84e-6 U^3.41 (Monahan & O'Muircheartaigh 1980), at most 0.95.

        Args:
            source: the water; its choppiness and its shortest waves matter, its samples do not.
            wind_speed: 10 m above the sea [m/s]; in still air there is no foam.
            tau, strength: as of `Foam`.
            shortest: waves shorter than this are left out [m], as by `Window`.

        Raises:
            ParameterError: no cascade or ocean, or a value out of range.
        """
        threshold = threshold_for(source, wind_speed, tau=tau, strength=strength, shortest=shortest)
        return cls(tau=tau, threshold=threshold, strength=strength)

    @classmethod
    def from_wind(
        cls,
        source: Cascade | Ocean,
        wind_speed: float,
        *,
        tau: float = 3.5,
        strength: float = 60.0,
        shortest: float = 0.0,
    ) -> "Foam":
        """Return `whitecaps` for a wind [m/s]: the earlier name."""
        return cls.whitecaps(source, wind_speed, tau=tau, strength=strength, shortest=shortest)

    def loop(self, ocean: Ocean | Cascade | Window, count: int) -> Iterator[Real]:
        """
        Yield the foam coverage of `count` frames of a loop, each (ny, nx) in 0..1 [-], indexed by
        the undisplaced position.

        Args:
            ocean: an ocean; a `Window` on a cascade; or a cascade, which stands for the window of
                its largest tile.
            count: frames of the loop.

        Raises:
            ParameterError: the ocean does not loop, or `count` is out of range.

        Pinned by tests/test_foam.py, against a dense quadrature of the integral.
        """
        ocean, count = _water(ocean), FRAMES.check("count", count)
        spans = spans_of(count)
        made = [self.response(ocean, count, first, stop) for first, stop in spans]
        for (first, stop), state in zip(spans, self.starts(made, ocean, count), strict=True):
            for _, f in self.states(ocean, count, state, first, stop):
                yield coverage(f)

    def live(self, ocean: Ocean | Cascade | Window, t: float = 0.0) -> "LiveFoam":
        """
        Start on clean water at time t [s]; a start 3 tau earlier than is shown has foam from the
        first picture on.
        """
        return LiveFoam(self, _water(ocean), t)

    def response(self, ocean: Ocean | Window, count: int, first: int, stop: int) -> Real:
        """
        Return the state at frame `stop` of `count` if the water was clean at frame `first`: (ny,
        nx), float64 [-].
        """
        _require_looping(ocean)
        state = np.zeros(ocean.grid.shape)
        for _ in self._run(ocean, count, state, first, stop):
            pass
        return state

    def starts(self, made: Sequence[Real], ocean: Ocean | Window, count: int) -> Real:
        """
        Return the states of the loop at the first frame of each span, (spans, ny, nx), float64 [-].

        Args:
            made: the `response` of each span of `spans_of(count)`, in order.
        """
        loop = _require_looping(ocean)
        kept = [
            math.exp(-(stop - first) * loop / count / self.tau) for first, stop in spans_of(count)
        ]
        turn = np.zeros(ocean.grid.shape)
        for decay, new in zip(kept, made, strict=True):
            turn = decay * turn + new
        states = np.empty((len(made), *ocean.grid.shape))
        states[0] = turn / -math.expm1(-loop / self.tau)
        for i in range(1, len(made)):
            states[i] = kept[i - 1] * states[i - 1] + made[i - 1]
        return states

    def states(
        self, ocean: Ocean | Window, count: int, start: Real, first: int, stop: int
    ) -> Iterator[tuple[int, Real]]:
        """
        Yield (j, state) for the frames first <= j < stop, from the state `start` at frame `first`;
        each is (ny, nx) [-], and good until the next.

        The same start gives the same bits: a frame's state does not depend on `stop`.
        """
        state = np.array(start, dtype=np.float64)
        yield first, state
        for j in self._run(ocean, count, state, first, stop - 1):
            yield j, state

    def _run(
        self, ocean: Ocean | Window, count: int, state: Real, first: int, last: int
    ) -> Iterator[int]:
        """Advance a state from frame `first`, yielding at each frame up to `last`."""
        loop = _require_looping(ocean)
        count = FRAMES.check("count", count)
        parts = max(1, math.ceil(loop / count / longest_step(ocean)))
        stepper = _Stepper(self, loop / (count * parts))
        watch = _Watch(ocean)
        window = (
            [watch.in_loop(first * parts + i, count * parts) for i in (-1, 0, 1)]
            if last > first
            else []
        )
        for j in range(first, last):
            for i in range(parts):
                window.append(watch.in_loop(j * parts + i + 2, count * parts))
                stepper.advance(window, state)
                watch.give_back(window.pop(0))
            yield j + 1


class LiveFoam:
    """
    The foam of a running sea: it keeps the state, and `at(t)` moves it on.

    It steps at a pace of its own that suits the waves, so that what it shows does not depend on how
    often it is asked; between two steps it interpolates. One thread at a time.
    """

    def __init__(self, settings: Foam, ocean: Ocean | Window, t: float = 0.0) -> None:
        self._settings, self._ocean = settings, ocean
        self._start = self._last = TIME.check("t", t)
        step = longest_step(ocean)
        self._step = step if math.isfinite(step) else settings.tau
        self._watch = _Watch(ocean)
        self._stepper = _Stepper(settings, self._step)
        self._begin(0)

    def __repr__(self) -> str:
        return f"LiveFoam({self._settings}, {self._ocean}, t={self._last:g})"

    def at(self, t: float) -> Real:
        """
        Move on to time t [s], and return the coverage there, (ny, nx) in 0..1.

        After a leap only the last 20 tau are followed: e^-20 of what was before is left, 2e-9.

        Raises:
            ParameterError: `t` lies before the last one asked for.
        """
        t = TIME.check("t", t)
        if t < self._last:
            raise ParameterError(
                f"foam cannot go back: t must be at least {self._last!r}, got {t!r}; "
                "start another `live`"
            )
        self._last = t
        place = (t - self._start) / self._step
        tick = math.floor(place)
        memory = math.ceil(20.0 * self._settings.tau / self._step)
        if tick - self._tick > memory + 4:
            self._begin(tick - memory)
        while self._tick <= tick:
            self._advance()
        share = place - tick
        return coverage((1.0 - share) * self._before + share * self._state)

    def _begin(self, tick: int) -> None:
        """
        Clean water at a step; `_before` is the state one step before `_state`, which is that of
        `_tick`.
        """
        self._tick = tick
        self._before, self._state = np.zeros((2, *self._ocean.grid.shape))
        self._window = [self._watch.at(self._start + (tick + i) * self._step) for i in (-1, 0, 1)]
        self._advance()

    def _advance(self) -> None:
        self._before[:] = self._state
        self._window.append(self._watch.at(self._start + (self._tick + 2) * self._step))
        self._stepper.advance(self._window, self._state)
        self._watch.give_back(self._window.pop(0))
        self._tick += 1


def spans_of(count: int) -> list[tuple[int, int]]:
    """
    The spans of frames, (first, stop), that each start from a stored state: the parts of a bake's
    survey.
    """
    return [(first, min(first + SPAN, count)) for first in range(0, count, SPAN)]


def coverage(state: Real) -> Real:
    """Return the share that is covered, 1 - e^{-state}, float32 in 0..1 [-], shaped like it."""
    out = np.empty(state.shape, dtype=np.float32)
    kernel.coverage(state, out)
    return out


def _water(source: Any) -> Ocean | Window:
    """
    Return what foam can be made on.

    Raises:
        ParameterError: it is no water.
    """
    if isinstance(source, Cascade):
        return Window(source)
    if not isinstance(source, (Ocean, Window)):
        raise ParameterError(f"foam needs an Ocean, a Cascade or a Window, got {source!r:.80}")
    return source


def _require_looping(source: Any) -> float:
    """
    Return the period [s] of the water that a state of foam belongs to.

    Raises:
        ParameterError: it is no water with samples of its own, or does not loop.
    """
    if not isinstance(source, (Ocean, Window)):
        raise ParameterError(f"a state of foam needs an Ocean or a Window, got {source!r:.80}")
    if source.loop is None:
        raise ParameterError(
            "foam on a loop needs an ocean that loops: Ocean(..., loop=16.0); `live` does without"
        )
    return source.loop


def longest_step(ocean: Ocean | Window) -> float:
    """
    Return the step of time [s] that resolves breaking: a third of a radian of its waves, inf
    without waves.

    Their frequency is the root mean square over waves weighted with the variance of their stretch.
    Half the step changes the foam by half a percent.
    """
    total = fast = 0.0
    for tile in ocean.oceans if isinstance(ocean, Window) else (ocean,):
        a = tile.amplitudes
        k = a.grid.k
        stretch = a.squares * (potential_factor(k, a.depth) * k * k) ** 2
        total += float(np.sum(stretch))
        fast += float(np.sum(stretch * a.running_omega**2))
    fast = fast / total if total > 0.0 else 0.0
    return 1.0 / (3.0 * math.sqrt(fast)) if fast > 0.0 else math.inf


class _Watch:
    """Smallest eigenvalue of an ocean at any time; arrays that are given back are used again."""

    def __init__(self, ocean: Ocean | Window) -> None:
        self._ocean = ocean
        self._frame: Frame | None = None
        self._spare: list[Real] = []

    def at(self, t: float) -> Real:
        """Return it at time t [s], (ny, nx)."""
        self._frame = self._ocean.frame(t, DISPLACEMENT_GRADIENT, out=self._frame)
        return self._minimum_eigenvalue(self._frame)

    def in_loop(self, j: int, count: int) -> Real:
        """Return it at frame j of `count` frames of the loop, (ny, nx)."""
        self._frame = self._ocean.loop_frame(j, count, DISPLACEMENT_GRADIENT, out=self._frame)
        return self._minimum_eigenvalue(self._frame)

    def give_back(self, array: Real) -> None:
        """Take back an array that is not needed any more."""
        self._spare.append(array)

    def _minimum_eigenvalue(self, frame: Frame) -> Real:
        out = (
            self._spare.pop()
            if self._spare
            else np.empty(frame.grid.shape, dtype=frame.stretch_xx.dtype)
        )
        c: Any = frame.stretch_xx.dtype.type(frame.choppiness)
        surface.minimum_eigenvalue(frame.stretch_xx, frame.stretch_xy, frame.stretch_yy, c, out)
        return out


class _Stepper:
    """
    One step of a fixed length: the integral of e^{-(dt - s)/tau} source(s) over it, the source
    linear between quarter steps.
    """

    def __init__(self, settings: Foam, step: float) -> None:
        self._threshold = settings.threshold
        self._decay = math.exp(-step / settings.tau)
        u = np.linspace(0.0, 1.0, 5)
        lagrange = [
            -u * (u - 1) * (u - 2) / 6,
            (u + 1) * (u - 1) * (u - 2) / 2,
            -u * (u + 1) * (u - 2) / 2,
            u * (u + 1) * (u - 1) / 6,
        ]
        self._cubic = np.ascontiguousarray(np.stack(lagrange, axis=1))
        early, late = _exponential_weights(0.25 * step / settings.tau)
        left = np.exp(
            -(1.0 - u) * step / settings.tau
        )  # of what is there at each quarter, at the end
        self._weights = np.zeros(5)
        self._weights[:-1] += early * left[1:]
        self._weights[1:] += late * left[1:]
        self._weights *= settings.tau * settings.strength

    def advance(self, window: Sequence[Real], state: Real) -> None:
        """Advance a state; `window` has the eigenvalues before, at start and end, and after."""
        before, now, then, after = window
        kernel.advance(
            before,
            now,
            then,
            after,
            self._cubic,
            self._weights,
            self._threshold,
            self._decay,
            state,
        )


def _exponential_weights(x: float) -> tuple[float, float]:
    """
    The weights of the two ends of a step of x decay times: the integrals of e^{-(x - s)} (1 - s/x)
    and e^{-(x - s)} s/x over 0..x.

    They are (1 - e^-x)/x - e^-x and 1 - (1 - e^-x)/x; by series below 1e-3, where both are
    differences of near equals.
    """
    if x < 1e-3:
        return x * (1 / 2 - x * (1 / 3 - x * (1 / 8 - x * (1 / 30)))), x * (
            1 / 2 - x * (1 / 6 - x * (1 / 24 - x * (1 / 120)))
        )
    mean = -math.expm1(-x) / x
    return mean - math.exp(-x), 1.0 - mean
