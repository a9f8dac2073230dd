"""
A sea that runs on a graphics processor, by `wgpu`: buffers, pipelines and dispatches.
"""

import numpy as np
import wgpu
from kernel_layout import Layout, lifts_of, tables, twiddle_table

BINDINGS = {
    "rows": (0, 1, 2, 3, 4),
    "columns": (0, 3, 4, 5),
    "foam": (0, 5),
    "mips": (0, 5),
    "mips_far": (0, 5),
    "textures": (0, 5, 6, 9),
    "heights": (0, 5, 7, 8),
}
KINDS = {
    0: "uniform", 1: "read-only-storage", 2: "read-only-storage", 3: "read-only-storage",
    4: "storage", 5: "storage", 7: "storage", 8: "read-only-storage", 9: "uniform",
}  # fmt: skip
USES = wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC | wgpu.BufferUsage.COPY_DST
UNIFORM = wgpu.BufferUsage.UNIFORM | wgpu.BufferUsage.COPY_DST


class GpuSea:
    """
    The tiles of a package on a graphics processor.

    Args:
        device: of `wgpu`.
        package: a `SeaPackage`.
        shaders: WGSL text of all kernels, or {kernel: SPIR-V}.
        entry: name of the entry points in SPIR-V; None is that of the kernel.
        foam_side: cells a side of the window of foam, 0 for none.
    """

    def __init__(self, device, package, shaders, *, entry=None, foam_side=0, lifts=True):
        self.device = device
        self.layout = Layout(package.document, lifts_of(package) if lifts else [], foam_side)
        self._shaders, self._entry, self._pipelines = shaders, entry, {}
        h0, wave = tables(package)
        texels = self.layout.texels
        self.buffers = {
            0: device.create_buffer(size=1120, usage=UNIFORM),
            1: self._filled(h0),
            2: self._filled(wave),
            3: self._filled(twiddle_table(self.layout.twiddles)),
            4: device.create_buffer(size=32 * texels, usage=USES),
            5: device.create_buffer(size=16 * self.layout.map_texels, usage=USES),
        }

    def _filled(self, array):
        return self.device.create_buffer_with_data(data=np.ascontiguousarray(array), usage=USES)

    def _pipeline(self, kernel):
        """Return the pipeline of a kernel and the layout of its bindings, made once."""
        if kernel not in self._pipelines:
            entries = [
                {
                    "binding": binding,
                    "visibility": wgpu.ShaderStage.COMPUTE,
                    **(
                        {"storage_texture": {"format": "rgba16float", "access": "write-only"}}
                        if binding == 6
                        else {"buffer": {"type": KINDS[binding]}}
                    ),
                }
                for binding in BINDINGS[kernel]
            ]
            bindings = self.device.create_bind_group_layout(entries=entries)
            code = self._shaders if isinstance(self._shaders, str) else self._shaders[kernel]
            pipeline = self.device.create_compute_pipeline(
                layout=self.device.create_pipeline_layout(bind_group_layouts=[bindings]),
                compute={
                    "module": self.device.create_shader_module(code=code),
                    "entry_point": self._entry or kernel,
                },
            )
            self._pipelines[kernel] = pipeline, bindings
        return self._pipelines[kernel]

    def run(self, kernel, groups, **others):
        """Dispatch a kernel; `others` are resources by binding, as b7=buffer."""
        pipeline, bindings = self._pipeline(kernel)
        resources = {**self.buffers, **{int(name[1:]): one for name, one in others.items()}}
        group = self.device.create_bind_group(
            layout=bindings,
            entries=[
                {
                    "binding": binding,
                    "resource": resources[binding]
                    if binding == 6
                    else {
                        "buffer": resources[binding],
                        "offset": 0,
                        "size": resources[binding].size,
                    },
                }
                for binding in BINDINGS[kernel]
            ],
        )
        encoder = self.device.create_command_encoder()
        compute = encoder.begin_compute_pass()
        compute.set_pipeline(pipeline)
        compute.set_bind_group(0, group)
        compute.dispatch_workgroups(*groups)
        compute.end()
        self.device.queue.submit([encoder.finish()])

    def set(self, tick, **values):
        """Write the uniform block; see `Layout.block`."""
        self.device.queue.write_buffer(self.buffers[0], 0, self.layout.block(tick, **values))

    def frame(self, tick, **values):
        """Compute all tiles at a tick."""
        self.set(tick, **values)
        self.run("rows", self.layout.groups())
        self.run("columns", self.layout.groups())

    def average(self):
        """Compute all levels of all planes."""
        self.run("mips", self.layout.mip_groups(0))
        self.run("mips_far", self.layout.mip_groups(5))

    def step_foam(self):
        """Advance the foam by the step of the uniform block."""
        groups = -(-self.layout.foam_side // 8)
        self.run("foam", (groups, groups, 1))

    def maps(self):
        """Return all of `maps`, (texels, 4)."""
        data = self.device.queue.read_buffer(self.buffers[5])
        return np.frombuffer(data, np.float32).reshape(-1, 4)

    def plane(self, index, level=0):
        """Return one level of a plane, (ny, nx, 4)."""
        at, (nx, ny) = self.layout.plane(index)
        for _ in range(level):
            at += nx * ny
            nx, ny = max(1, nx // 2), max(1, ny // 2)
        return self.maps()[at : at + nx * ny].reshape(ny, nx, 4)

    def fields(self, index):
        """Return the eight fields of a tile at choppiness 1, in the order of `EIGHT`."""
        a, b = self.plane(3 * index), self.plane(3 * index + 1)
        return {
            "height": a[..., 2], "displace_x": a[..., 0], "displace_y": a[..., 1],
            "slope_x": b[..., 0], "slope_y": b[..., 1],
            "stretch_xx": b[..., 2], "stretch_xy": a[..., 3], "stretch_yy": b[..., 3],
        }  # fmt: skip

    def heights(self, x, y):
        """Return `answers` at points, (points, 8); the uniform block must tell their number."""
        places = self._filled(np.stack([x, y], axis=-1).astype(np.float32))
        answers = self.device.create_buffer(size=32 * len(x), usage=USES)
        self.run("heights", (-(-len(x) // 64), 1, 1), b7=answers, b8=places)
        data = self.device.queue.read_buffer(answers)
        return np.frombuffer(data, np.float32).reshape(-1, 8).astype(float)

    def texture(self, plane, level=0):
        """Return a level of a plane after a way through a texture, (ny, nx, 4) as half floats."""
        _, (nx, ny) = self.layout.plane(plane)
        nx, ny = max(1, nx >> level), max(1, ny >> level)
        texture = self.device.create_texture(
            size=(nx, ny, 1),
            format="rgba16float",
            usage=wgpu.TextureUsage.STORAGE_BINDING | wgpu.TextureUsage.COPY_SRC,
        )
        target = self.device.create_buffer_with_data(
            data=np.array([plane, level, 0, 0], np.uint32), usage=UNIFORM
        )
        self.run("textures", (-(-nx // 8), -(-ny // 8), 1), b6=texture.create_view(), b9=target)
        row = -(-nx * 8 // 256) * 256
        data = self.device.queue.read_texture(
            {"texture": texture}, {"bytes_per_row": row, "rows_per_image": ny}, (nx, ny, 1)
        )
        halves = np.frombuffer(data, np.float16).reshape(ny, -1)
        return halves[:, : 4 * nx].reshape(ny, nx, 4)
