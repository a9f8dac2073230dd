"""
Synthesis of fields on a graphics processor.

Each pair of real fields A and B takes one complex transform, of A + i B. Waves are divided by the
largest of them, and the second field of a pair is made as large as the first, by powers of two, as
in `fftocean.synthesis`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from importlib import import_module
from typing import Any, TypeVar

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import Complex, Integer, Real
from fftocean.bound_waves import BoundSpectrum, Shown
from fftocean.computation import Computation
from fftocean.errors import DeviceError, ParameterError
from fftocean.fields import FIELDS, POINTWISE, potential_factor
from fftocean.gpu import readback
from fftocean.gpu.device import Device, device, errors, forget
from fftocean.gpu.kernels import Buffers, Dispatches, Kept
from fftocean.gpu.stages import stages, twiddles
from fftocean.phases import Moment
from fftocean.physics import dispersion
from fftocean.synthesis import Synthesis, balancing_weight, largest_wave, root_mean_squares

PAIRS: tuple[tuple[str, ...], ...] = (
    ("displace_x", "displace_y"),
    ("height", "stretch_xy"),
    ("slope_x", "slope_y"),
    ("stretch_xx", "stretch_yy"),
    ("velocity_x", "velocity_y"),
    ("velocity_z",),
)
"""
The fields that share a transform, as in the run-time kernels.

Pairs are computed whole, so a field has the same bits whatever is asked beside it.
"""

SIDE = 4096
"""Samples a side, at most."""
_REACH = 90  # a power of two: see `balancing_weight`
_GROUPS = 4096  # workgroups, at most, of the kernels that loop over entries
_PIECE = 2**22  # samples of a dispatch of normals, whose binding would else be too large
_SEA_BYTES = 1120  # of the uniform block of fftocean.wgsl, which tells the number of twiddles

Result = TypeVar("Result")


class DeviceSynthesis:
    """
    The waves of one tile on a graphics processor; see `Synthesis`, whose place it takes.

    A device that is lost is replaced once; a forked child makes its own.

    Raises:
        ParameterError: `wgpu` or an adapter is missing, or the tile is not one for the kernels.
    """

    backend = "gpu"

    def __init__(
        self, amplitudes: Amplitudes, computation: Computation, bound: Shown | None
    ) -> None:
        grid = amplitudes.grid
        _require_side(grid.nx, "nx")
        _require_side(grid.ny, "ny")
        if computation.dtype != "float32":
            raise ParameterError(
                f"backend 'gpu' computes fields in float32, got dtype={computation.dtype!r}"
            )
        self._amplitudes, self.shape = amplitudes, grid.shape
        self.columns = (grid.nx + 1) // 2
        self._unit = largest_wave(amplitudes)
        self._size = root_mean_squares(amplitudes)
        self._stages = stages(grid.nx, grid.ny)
        self._bound = (
            BoundSpectrum(bound, self._unit, self.columns, 1)
            if bound is not None and len(bound.waves)
            else None
        )
        self._tables: _Tables | None = None
        self._on_device(lambda _: None)

    @property
    def frequency(self) -> Real:
        """Frequency of each wave in cycles a second or, on a loop, a period; (ny, columns)."""
        a = self._amplitudes
        if a.cycles is not None:
            return np.asarray(a.cycles[:, : self.columns], np.float64)
        return dispersion.turns_per_second(a.omega[:, : self.columns])

    def restart(self) -> None:
        """Do nothing: a forked child sees that its device is another one."""

    def run(self, moment: Moment, outputs: Mapping[str, Real], choppiness: float) -> None:
        """Compute fields; see `Synthesis.run`."""

        def compute(tables: "_Tables") -> None:
            buffers = {name: tables.own(name) for name in outputs}
            self._compute(tables, moment, buffers, choppiness)
            readback.read(tables.device.handle, buffers, outputs)

        self._on_device(compute)

    def buffers(
        self, moment: Moment, fields: Sequence[str], choppiness: float
    ) -> tuple[Any, dict[str, Any]]:
        """Return the device, and new buffers on it with the fields."""

        def compute(tables: "_Tables") -> tuple[Any, dict[str, Any]]:
            buffers = {name: tables.new(name) for name in fields}
            self._compute(tables, moment, buffers, choppiness)
            return tables.device.handle, buffers

        return self._on_device(compute)

    def _on_device(self, work: "Callable[[_Tables], Result]") -> Result:
        """
        Return what `work` does with the tables of this process's device.

        Raises:
            DeviceError: it fails on a second device, too.
        """
        lost: Exception | None = None
        for _ in range(2):
            current = device()
            with current.lock:
                try:
                    if self._tables is None or self._tables.device is not current:
                        self._tables = None  # the old ones, before there is memory for others
                        self._tables = _Tables(current, self)
                    return work(self._tables)
                except errors() as error:
                    lost = error
            forget(current)
        raise DeviceError(
            f"the graphics adapter {current.adapter.name} failed, and again on a new device, with "
            f"{self.shape[1]} x {self.shape[0]} samples: {' '.join(str(lost).split()):.300}"
        ) from lost

    def _compute(
        self,
        tables: "_Tables",
        moment: Moment,
        outputs: Mapping[str, Any],
        choppiness: float,
    ) -> None:
        """Start the computation of fields into buffers."""
        linear = {
            part for name in outputs for part in ((name,) if name in FIELDS else POINTWISE[name])
        }
        own = {name: outputs.get(name) or tables.own(name) for name in sorted(linear)}
        for rate in (0, 1):
            pairs = [pair for pair in PAIRS if linear & set(pair) and FIELDS[pair[0]].dt == rate]
            if not pairs:
                continue
            second = self._sum_bound_waves(tables, moment, rate)
            tables.set_moment(_block(moment, self._amplitudes.loop, rate, second, choppiness))
            dispatches = Dispatches(tables.device, tables.kept)
            dispatches.add("advance", _groups(self.columns * self.shape[0]), tables.common)
            for pair in pairs:
                self._transform(dispatches, tables, pair, own)
            if rate == 0:
                for name in POINTWISE:
                    if name in outputs:
                        self._pointwise(dispatches, tables, name, outputs[name], own)
            dispatches.submit()

    def _transform(
        self,
        dispatches: Dispatches,
        tables: "_Tables",
        pair: tuple[str, ...],
        own: Mapping[str, Any],
    ) -> None:
        """Add the dispatches of one pair."""
        planes = [own.get(name) or tables.spare for name in pair]
        ends = {(1, 10): planes[0], (1, 11): planes[1] if len(pair) == 2 else tables.nothing}
        last = len(self._stages) - 1
        for i, stage in enumerate(self._stages):
            kernel = "begin" if i == 0 else "finish" if i == last else "proceed"
            between: Buffers = {(1, 8): tables.work[(i + 1) % 2], (1, 9): tables.work[i % 2]}
            uniforms = {(1, 2): tables.pairs[pair], (1, 3): tables.stages[i]}
            dispatches.add(kernel, stage.groups, {**tables.common, **uniforms, **between, **ends})

    def _pointwise(
        self,
        dispatches: Dispatches,
        tables: "_Tables",
        name: str,
        output: Any,
        own: Mapping[str, Any],
    ) -> None:
        """Add the dispatches of normals or Jacobians."""
        inputs = {
            (1, 13 + i): own[part] for i, part in enumerate(POINTWISE["normal"]) if part in own
        }
        channels = 3 if name == "normal" else 1
        for first, count, piece in tables.pieces:
            part = output, 4 * channels * first, 4 * channels * count
            bound = {**tables.common, **inputs, (1, 12): piece, (1, 18): part}
            dispatches.add(name, _groups(count), bound)

    def _sum_bound_waves(self, tables: "_Tables", moment: Moment, rate: int) -> bool:
        """Upload the waves of second order, which the processor sums; False if there are none."""
        if self._bound is None:
            return False
        self._bound.advance(moment, [rate])
        for part in range(self._bound.parts):
            self._bound.sum(part, [rate])
        real, imag = np.zeros((2, self.columns, self.shape[0]), np.float32)
        self._bound.add(rate, 0, real, imag)
        tables.upload_bound(np.stack([real.T, imag.T], axis=-1))
        return True

    def wave_table(self) -> Real:
        """Return forward and backward waves over the largest, (ny, columns, 4) float32."""
        a = self._amplitudes
        table = np.empty((*self.shape[:1], self.columns, 4), np.float32)
        for i, waves in enumerate((a.forward, a.backward)):
            half: Complex = waves[:, : self.columns] / self._unit
            table[..., 2 * i], table[..., 2 * i + 1] = half.real, half.imag
        table[np.abs(table) < 1e-30] = 0.0  # as in `Synthesis`
        return table

    def pace_table(self) -> Integer:
        """
        Return frequencies and factors to the potential, (ny, columns, 4) uint32.

        Frequencies are in cycles a second, or in 2^32 cycles a loop: whole, 2^-32 and 2^-64 parts.
        """
        frequency = self.frequency
        if self._amplitudes.loop is not None:
            frequency = frequency * 2.0**-32
        whole = np.floor(frequency)
        part = np.rint((frequency - whole) * 2.0**64).astype(np.uint64)
        factor = potential_factor(
            self._amplitudes.grid.k[:, : self.columns], self._amplitudes.depth
        )
        table = np.empty((*frequency.shape, 4), np.uint32)
        table[..., 0] = whole
        table[..., 1], table[..., 2] = part >> np.uint64(32), part & np.uint64(0xFFFFFFFF)
        table[..., 3] = factor.astype(np.float32).view(np.uint32)
        return table

    def patch_block(self) -> bytes:
        """Return the uniform block of the tile."""
        grid = self._amplitudes.grid
        block = np.zeros(8, np.uint32)
        block[:3] = grid.nx, grid.ny, self.columns
        block[4:6] = np.array([grid.dkx, grid.dky], np.float32).view(np.uint32)
        return block.tobytes()

    def pair_block(self, pair: tuple[str, ...]) -> bytes:
        """Return the uniform block of a pair: derivatives, and factors before and after."""
        block = np.zeros(12, np.uint32)
        for i, name in enumerate(pair):
            field = FIELDS[name]
            block[4 * i : 4 * i + 3] = field.dx, field.dy, field.of == "potential"
        sizes = [self._size[name] for name in pair]
        weight = balancing_weight(sizes[0], sizes[1], _REACH) if len(pair) == 2 else 0.0
        # A field without waves is exactly 0, without the rounding errors of its partner.
        scales = [
            self._unit / lift if size > 0.0 else 0.0
            for size, lift in zip(sizes, (1.0, weight), strict=False)
        ]
        block[7] = np.float32(weight).view(np.uint32)
        block[8 : 8 + len(pair)] = np.array(scales, np.float32).view(np.uint32)
        block[10] = len(pair) == 2
        return block.tobytes()

    def stage_blocks(self, count: int) -> list[bytes]:
        """Return the uniform block of each step of a transform."""
        return [stage.words(count).tobytes() for stage in self._stages]


class _Tables:
    """The buffers of one ocean on one device."""

    def __init__(self, made_for: Device, synthesis: DeviceSynthesis) -> None:
        wgpu = import_module("wgpu")
        self.device, self.kept = made_for, Kept()
        use = wgpu.BufferUsage
        self._storage = use.STORAGE | use.COPY_SRC | use.COPY_DST | use.VERTEX
        self._uniform = use.UNIFORM | use.COPY_DST
        ny, nx = synthesis.shape
        self._samples = nx * ny
        half = synthesis.columns * ny
        count = max(nx, ny)
        sea = np.zeros(_SEA_BYTES, np.uint8)
        sea.view(np.uint32)[3] = count
        self.common: dict[tuple[int, int], Any] = {
            (0, 0): self._filled(sea.tobytes(), self._uniform),
            (0, 3): self._filled(twiddles(count)),
            (1, 0): self._filled(bytes(32), self._uniform),
            (1, 1): self._filled(synthesis.patch_block(), self._uniform),
            (1, 4): self._filled(synthesis.wave_table()),
            (1, 5): self._filled(synthesis.pace_table()),
            (1, 6): self._keep(self._empty(8 * half)),
            (1, 7): self._keep(self._empty(8 if synthesis._bound is None else 8 * half)),
        }
        self.pairs = {
            pair: self._filled(synthesis.pair_block(pair), self._uniform) for pair in PAIRS
        }
        self.stages = [
            self._filled(block, self._uniform) for block in synthesis.stage_blocks(count)
        ]
        self.pieces = [
            (first, n, self._filled(np.array([first, n, 0, 0], np.uint32), self._uniform))
            for first in range(0, self._samples, _PIECE)
            for n in (min(_PIECE, self._samples - first),)
        ]
        self.work = [self._keep(self._empty(8 * self._samples)) for _ in range(2)]
        self.spare, self.nothing = (self._keep(self._empty(4 * n)) for n in (self._samples, 1))
        self._fields: dict[str, Any] = {}

    def own(self, name: str) -> Any:
        """Return the buffer of a field that the next frame overwrites."""
        if name not in self._fields:
            self._fields[name] = self._keep(self.new(name))
        return self._fields[name]

    def new(self, name: str) -> Any:
        """Return a new buffer for a field."""
        return self._empty((12 if name == "normal" else 4) * self._samples)

    def set_moment(self, block: bytes) -> None:
        """Write the uniform block of a moment."""
        self.device.handle.queue.write_buffer(self.common[1, 0], 0, block)

    def upload_bound(self, spectrum: Real) -> None:
        """Write the waves of second order, (ny, columns, 2) float32."""
        self.device.handle.queue.write_buffer(self.common[1, 7], 0, np.ascontiguousarray(spectrum))

    def _filled(self, data: Any, usage: int | None = None) -> Any:
        return self._keep(
            self.device.handle.create_buffer_with_data(
                data=data, usage=self._storage if usage is None else usage
            )
        )

    def _keep(self, buffer: Any) -> Any:
        """Return a buffer that lives as long as these tables, for bindings to be made once."""
        self.kept.buffers.add(id(buffer))
        return buffer

    def _empty(self, size: int) -> Any:
        return self.device.handle.create_buffer(size=size, usage=self._storage)


def _block(moment: Moment, loop: float | None, rate: int, second: bool, choppiness: float) -> bytes:
    """Return the uniform block of a moment: its time in 2^-64 units, of 128 bits."""
    scale, per_unit = (2**64, 1.0) if loop is None else (2**96, 2.0**32 / loop)
    words = round(moment.exact * scale) % 2**128
    part, whole = words % 2**64, words >> 64
    block = np.zeros(8, np.uint32)
    block[:5] = whole % 2**32, whole >> 32, part % 2**32, part >> 32, rate
    block[5] = np.float32(2.0 * np.pi * per_unit).view(np.uint32)
    block[6] = second
    block[7] = np.float32(choppiness).view(np.uint32)
    return block.tobytes()


def _groups(count: int) -> int:
    """Return the workgroups of a kernel with a loop over `count` entries."""
    return min(_GROUPS, -(-count // 256))


def _require_side(n: int, name: str) -> None:
    if n & (n - 1) or not 2 <= n <= SIDE:
        raise ParameterError(
            f"backend 'gpu' takes powers of two from 2 to {SIDE} samples a side, got {name} = {n}; "
            "'gpu-or-cpu' computes others on the CPU"
        )


def synthesis_of(
    amplitudes: Amplitudes, computation: Computation, bound: Shown | None
) -> Synthesis | DeviceSynthesis:
    """
    Return the synthesis of a tile by the backend of a computation.

    Raises:
        ParameterError: as `Synthesis` and `DeviceSynthesis`; "gpu-or-cpu" only as the former.
    """
    if computation.backend not in ("gpu", "gpu-or-cpu"):
        return Synthesis(amplitudes, computation, bound)
    try:
        return DeviceSynthesis(amplitudes, computation, bound)
    except (ParameterError, DeviceError):
        if computation.backend == "gpu":
            raise
        return Synthesis(amplitudes, replace(computation, backend="auto"), bound)
