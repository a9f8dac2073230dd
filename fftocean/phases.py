"""Phases of waves at a moment, exact however far from zero."""

from dataclasses import dataclass
from fractions import Fraction

from fftocean.arrays import Real
from fftocean.kernels import passes
from fftocean.kernels.whole_passes import Moment as Numbers


@dataclass(frozen=True, slots=True)
class AtTime:
    """A time, for frequencies in cycles a second, or a share of a loop, for cycles in one."""

    time: float

    def __call__(self, frequency: Real, out: Real) -> None:
        """Write the phases of waves in cycles, -1/2 to 1/2."""
        passes.phases(*self.numbers, frequency, out)

    @property
    def numbers(self) -> Numbers:
        """The time as compiled loops take it: see `passes.phases`."""
        return 0, self.time, 1.0

    @property
    def exact(self) -> Fraction:
        """The time as a fraction."""
        return Fraction(self.time)


@dataclass(frozen=True, slots=True)
class InLoop:
    """One of `count` equally spaced moments of a loop, for whole numbers of cycles in it."""

    step: int  # 0 to count - 1
    count: int  # up to 2^32
    few_cycles: bool  # below 2^50

    def __call__(self, frequency: Real, out: Real) -> None:
        """Write the phases of waves in cycles, -1/2 to 1/2."""
        passes.phases(*self.numbers, frequency, out)

    @property
    def numbers(self) -> Numbers:
        """The step as compiled loops take it: see `passes.phases`."""
        kind = 1 if self.count <= 2**26 and self.few_cycles else 2
        return kind, float(self.step), float(self.count)

    @property
    def exact(self) -> Fraction:
        """The share of the loop as a fraction."""
        return Fraction(self.step, self.count)


Moment = AtTime | InLoop
