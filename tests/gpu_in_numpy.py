"""
A graphics processor in NumPy, with as much of `wgpu` as fftocean calls.

Its kernels are those of `ocean.wgsl`, written again for whole arrays in double precision; FFTs are
NumPy's. Buffers are bytes, and bindings are checked against the declarations in the shader's text.
So the tables, steps, bindings and copies of `fftocean.gpu` are tested where there is no adapter.
"""

import enum
import re
import types

import numpy as np

PLACES = 2048  # samples of a workgroup: 4 lines of 512 at most


class BufferUsage(enum.IntFlag):
    MAP_READ = 1
    COPY_SRC = 4
    COPY_DST = 8
    VERTEX = 32
    UNIFORM = 64
    STORAGE = 128


class GPUError(Exception):
    """An operation that WebGPU does not allow, or a device that is lost."""


def need(condition, rule):
    if not condition:
        raise GPUError(rule)


class Buffer:
    def __init__(self, size, usage, data=None):
        need(size > 0 and size % 4 == 0, f"a buffer has a multiple of 4 bytes, got {size}")
        self.size, self.usage, self.mapped = size, usage, False
        self.bytes = np.zeros(size, np.uint8) if data is None else np.array(data, np.uint8)

    def map_sync(self, mode):
        need(mode == 1 and self.usage & BufferUsage.MAP_READ, "a mapped buffer needs MAP_READ")
        self.mapped = True

    def read_mapped(self, start, size, copy):
        assert not copy
        need(self.mapped and start + size <= self.size, "beyond what is mapped")
        return memoryview(self.bytes[start : start + size])

    def unmap(self):
        self.mapped = False


class Device:
    def __init__(self):
        self.lost, self.groups_made = False, 0
        self.queue = types.SimpleNamespace(
            submit=self._submit, write_buffer=self._write, read_buffer=lambda b: b.bytes.tobytes()
        )

    def destroy(self):
        self.lost = True

    def create_buffer(self, *, size, usage):
        need(not self.lost, "the device is lost")
        return Buffer(size, usage)

    def create_buffer_with_data(self, *, data, usage):
        data = np.frombuffer(bytes(data), np.uint8)
        return Buffer(data.size, usage, data)

    def _write(self, buffer, offset, data):
        need(buffer.usage & BufferUsage.COPY_DST, "a written buffer needs COPY_DST")
        data = np.frombuffer(bytes(data), np.uint8)
        buffer.bytes[offset : offset + data.size] = data

    def _submit(self, encoders):
        need(not self.lost, "the device is lost")
        for encoder in encoders:
            for command in encoder.commands:
                command()

    def create_shader_module(self, *, code):
        return code

    def create_bind_group_layout(self, *, entries):
        return {entry["binding"]: entry["buffer"]["type"] for entry in entries}

    def create_pipeline_layout(self, *, bind_group_layouts):
        return bind_group_layouts

    def create_compute_pipeline(self, *, layout, compute):
        name = compute["entry_point"]
        for (group, binding), kind in declared(compute["module"], name).items():
            need(layout[group].get(binding) == kind, f"{name}: {group}, {binding} is {kind}")
        return name

    def create_bind_group(self, *, layout, entries):
        self.groups_made += 1
        bound = {}
        for entry in entries:
            part, kind = entry["resource"], layout[entry["binding"]]
            buffer, first, size = part["buffer"], part["offset"], part["size"]
            usage = BufferUsage.UNIFORM if kind == "uniform" else BufferUsage.STORAGE
            need(buffer.usage & usage, f"a {kind} binding needs {usage!r}")
            need(first % 256 == 0, "a binding starts at a multiple of 256 bytes")
            need(first >= 0 and first + size <= buffer.size, "beyond the buffer")
            view = buffer.bytes[first : first + size]
            view.flags.writeable = kind == "storage"
            bound[entry["binding"]] = view
        need(bound.keys() == layout.keys(), "a group has all bindings of its layout")
        return bound

    def create_command_encoder(self):
        return Encoder()


class Encoder:
    """Commands, and the compute pass whose commands they are."""

    def __init__(self):
        self.commands, self.groups = [], {}

    def begin_compute_pass(self):
        return self

    def set_pipeline(self, kernel):
        self.kernel = kernel

    def set_bind_group(self, number, bound):
        self.groups[number] = bound

    def dispatch_workgroups(self, groups):
        bound = {(g, b): view for g, some in self.groups.items() for b, view in some.items()}
        kernel = self.kernel
        self.commands.append(lambda: KERNELS[kernel](bound, groups))

    def copy_buffer_to_buffer(self, source, first, target, at, size):
        need(source.usage & BufferUsage.COPY_SRC, "a copied buffer needs COPY_SRC")
        need(target.usage & BufferUsage.COPY_DST, "a written buffer needs COPY_DST")

        def copy():
            target.bytes[at : at + size] = source.bytes[first : first + size]

        self.commands.append(copy)

    def end(self):
        pass

    def finish(self):
        return self


def declared(code, entry_point):
    """Return the kinds of the bindings that an entry point of a shader uses, by their place."""
    code = re.sub("//.*", "", code)
    kinds = {
        name: ((int(group), int(binding)), kind)
        for group, binding, kind, name in re.findall(
            r"@group\((\d)\) @binding\((\d+)\) var<([^>]*)> (\w+)", code
        )
    }
    names = {"uniform": "uniform", "storage, read": "read-only-storage"}
    bodies = dict(re.findall(r"fn (\w+)\((.*?\n?)(?=\nfn|\n@|\nstruct|\nvar|\Z)", code, re.S))
    seen, ahead = set(), [entry_point]
    while ahead:
        words = set(re.findall(r"(?<!\.)\b\w+\b", bodies[ahead.pop()]))
        ahead += [word for word in words & bodies.keys() if word not in seen]
        seen |= words
    return {at: names.get(kind, "storage") for name, (at, kind) in kinds.items() if name in seen}


def numbers(view, kind=np.float32):
    return view.view(kind)


def complexes(view):
    return numbers(view, np.complex64)


def signed_time(words):
    whole = int(words[0]) | int(words[1]) << 32
    return ((whole << 64) | int(words[2]) | int(words[3]) << 32) % 2**128


def advance(bound, groups):
    assert groups > 0
    words = numbers(bound[1, 0], np.uint32)
    tile = numbers(bound[1, 1], np.uint32)
    pace = numbers(bound[1, 5], np.uint32).reshape(-1, 4)
    count = int(tile[2]) * int(tile[1])
    assert len(pace) == count
    frequency = sum(pace[:, i].astype(object) << (64 - 32 * i) for i in range(3))  # in 2^-64
    turn = (frequency * signed_time(words)) % 2**128  # in 2^-128
    phasor = np.exp(2j * np.pi * (turn / 2**128).astype(float))
    forward, backward = complexes(bound[1, 4]).reshape(-1, 2).T.astype(complex)
    forward, backward = forward * phasor.conj(), backward * phasor
    omega = (frequency / 2**64).astype(float) * words[5:6].view(np.float32)[0]
    rate = words[4] == 1
    complexes(bound[1, 6])[:] = omega * 1j * (backward - forward) if rate else forward + backward


def spectrum(bound):
    """Return the spectrum of A + i B on the whole plane, (ny, nx)."""
    words, tile = (numbers(bound[1, i], np.uint32) for i in (0, 1))
    nx, ny, columns = (int(n) for n in tile[:3])
    dkx, dky = tile[4:6].view(np.float32)
    half = complexes(bound[1, 6]).reshape(ny, columns).astype(complex)
    second = half.copy()
    if words[6] == 1:
        second += complexes(bound[1, 7]).reshape(ny, columns)
    potential = numbers(bound[1, 5]).reshape(ny, columns, 4)[..., 3].astype(float)
    x, y = np.arange(nx), np.arange(ny)[:, None]
    mirrored = 2 * x > nx
    row = np.where(mirrored, -y % ny, y)
    column = np.where(2 * x == nx, 0, np.where(mirrored, nx - x, x))
    kx, ky = (np.fft.fftfreq(n, 1 / n) * dk for n, dk in ((nx, dkx), (ny, dky)))
    pair = numbers(bound[1, 2], np.uint32)
    weights = (1.0, float(pair[7:8].view(np.float32)[0]))
    total = np.zeros((ny, nx), complex)
    for i in range(2):
        dx, dy, of_potential = pair[4 * i : 4 * i + 3]
        values = (half if of_potential else second)[row, column]
        values = np.where(mirrored, values.conj(), values)
        if of_potential:
            values = values * potential[row, column]
        values = values * (1j * kx) ** int(dx) * (1j * ky[:, None]) ** int(dy)
        total += weights[i] * values * 1j**i
    total[:, 2 * x == nx] = 0.0
    return total


def transformed(bound, values, groups):
    """Return the places and results of the lines that some workgroups transform."""
    stage = numbers(bound[1, 3], np.uint32).astype(int)
    read, length, write, lines, inner = stage[:3], stage[3], stage[4:7], stage[7], stage[8]
    lines = min(lines, groups * PLACES // length)
    line, sample = np.arange(lines)[:, None], np.arange(length)

    def places(strides):
        return strides[0] * sample + strides[1] * (line // inner) + strides[2] * (line % inner)

    result = np.fft.ifft(values.ravel()[places(read)], axis=1) * length
    if np.any(stage[10:12]):
        twiddle = complexes(bound[0, 3])
        count = int(numbers(bound[0, 0], np.uint32)[3])
        assert twiddle.size == count
        turns = (stage[10] * (line // inner) + stage[11] * (line % inner)) * sample
        result = result * twiddle[turns % count]
    return places(write), result


def begin(bound, groups):
    places, result = transformed(bound, spectrum(bound), groups)
    complexes(bound[1, 9])[places] = result


def proceed(bound, groups):
    places, result = transformed(bound, complexes(bound[1, 8]).copy(), groups)
    complexes(bound[1, 9])[places] = result


def finish(bound, groups):
    places, result = transformed(bound, complexes(bound[1, 8]), groups)
    pair = numbers(bound[1, 2], np.uint32)
    scales = pair[8:10].view(np.float32)
    numbers(bound[1, 10])[places] = scales[0] * result.real
    if pair[10] == 1:
        numbers(bound[1, 11])[places] = scales[1] * result.imag


def gradients(bound):
    first, count = (int(n) for n in numbers(bound[1, 12], np.uint32)[:2])
    choppiness = numbers(bound[1, 0])[7]
    rows = {
        i: numbers(bound[1, i])[first : first + count] for i in range(13, 18) if (1, i) in bound
    }
    return rows, 1.0 + choppiness * rows[15], choppiness * rows[16], 1.0 + choppiness * rows[17]


def normal(bound, groups):
    assert groups > 0
    rows, a, b, d = gradients(bound)
    sx, sy = rows[13], rows[14]
    across = np.stack([b * sy - sx * d, b * sx - sy * a, a * d - b * b], axis=-1)
    numbers(bound[1, 18])[:] = (across / np.linalg.norm(across, axis=-1, keepdims=True)).ravel()


def jacobian(bound, groups):
    assert groups > 0
    _, a, b, d = gradients(bound)
    numbers(bound[1, 18])[:] = a * d - b * b


KERNELS = {f.__name__: f for f in (advance, begin, proceed, finish, normal, jacobian)}


class Adapter:
    """An adapter, which keeps the devices that it made."""

    def __init__(self, **info):
        self.info = {
            "device": "NumPy",
            "vendor": "Python",
            "description": np.__version__,
            "backend_type": "Vulkan",
            "adapter_type": "CPU",
        } | info
        self.limits = {
            "max-storage-buffer-binding-size": 2**27,
            "max-buffer-size": 2**28,
            "max-bindings": 1000,
        }
        self.devices = []

    def request_device_sync(self, *, required_limits):
        assert {name: self.limits[name] for name in required_limits} == required_limits
        self.devices.append(Device())
        return self.devices[-1]


def module(*adapters):
    """Return a stand-in for the module `wgpu`, whose first adapter is the preferred one."""
    gpu = types.SimpleNamespace(
        request_adapter_sync=lambda *, power_preference: (
            adapters[0] if power_preference == "high-performance" else None
        ),
        enumerate_adapters_sync=lambda: list(adapters),
    )
    return types.SimpleNamespace(
        gpu=gpu,
        BufferUsage=BufferUsage,
        ShaderStage=types.SimpleNamespace(COMPUTE=4),
        MapMode=types.SimpleNamespace(READ=1),
        GPUError=GPUError,
    )
