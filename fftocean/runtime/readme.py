"""Page that a package's folder carries: how to load, run and verify the sea."""

from collections.abc import Mapping
from typing import Any

from fftocean.engine_projects import ENGINES
from fftocean.runtime.layout import TWIDDLE


def readme_of(document: Mapping[str, Any]) -> bytes:
    """Return the text of README.md for a document."""
    rows = [
        f"- `tile{i}.waves`: {tile['n'][0]} x {tile['n'][1]} texels over "
        f"{tile['size'][0]:g} x {tile['size'][1]:g} m, {tile['waves']} waves"
        for i, tile in enumerate(document["tiles"])
    ]
    names = [file["name"] for file in document["files"]]
    if textures := [name for name in names if "_h0." in name or "_wave." in name]:
        rows.append(f"- `{textures[0]}` ...: the same waves as textures of float32")
    if TWIDDLE in names:
        rows.append(f"- `{TWIDDLE}`: cosine and sine of 2 pi i/n, float32")
    if kernels := [name for name in names if name.startswith("fftocean")]:
        rows.append(f"- `{kernels[0]}` ...: kernels for a graphics processor")
    if "project" in document:
        engine = ENGINES[document["project"]["engine"]]
        rows.append(f"- `{engine.readme}` and the other files: a project for {engine.caption}")
    tiles = "\n".join(rows)
    return f"""# A sea that loops after {document["loop"]:g} s

Written by {document["tool"]}. `sea.json` describes the sea, with the SHA-256 of every file.

{tiles}
- `check.json`: every field at some points, summed wave by wave in float64

To run it, little-endian, for each tile and moment `tick` from 0 to {document["ticks"] - 1}:

1. Read records of 14 bytes: int16 mx, int16 my, uint16 cycles, float32 re, float32 im of h0(k),
   k = 2 pi (mx/lx, my/ly). A wavenumber without a record has h0 = 0.
2. Phase: p = 2 pi ((cycles * tick) mod ticks) / ticks, the product in uint32, ticks a power of two.
3. h(k) = h0(k) e^(-ip) + conj(h0(-k)) e^(+ip), entry (mx mod nx, my mod ny) of the plane.
4. Inverse transform without 1/N: height of h; slopes of i kx h, i ky h; with
   d = h / (|k| tanh(|k| depth)): displacement of i kx d, i ky d; stretches of -kx kx d, -kx ky d,
   -ky ky d.
5. Add the tiles, each repeated over its own size. The surface is at (x, y) + choppiness
   displacement. Form normals of the summed fields, not of one tile.
6. Verify with `check.json`, or with `fftocean check` on this folder.
""".encode()
