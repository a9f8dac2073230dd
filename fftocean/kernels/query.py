"""
Loops of point queries: inversion of the horizontal displacement, and sums of waves at points.

A source of waves is one or more tiles, each periodic in its own size (inf: not periodic), which add
up. Tiles are either texels, to be interpolated, or lists of waves, to be summed. The parameters of
a point are kept as the world point, reduced to the first period of each tile, plus an offset of a
few metres: far from the origin only the reduction itself loses digits.

Arrays that belong together are named tuples here, and plain tuples where Python calls a kernel: the
dispatcher takes 1 us for a plain tuple, 6 us for a named one.
"""

from typing import Any, NamedTuple

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.kernels.compiler import compiled
from fftocean.kernels.interpolate import (
    BLOCK,
    DISPLACE_X,
    DISPLACE_Y,
    HEIGHT,
    XX,
    XY,
    YX,
    YY,
    U,
    V,
    bilinear_gradient,
    bilinear_gradients,
    spline_gradient,
    spline_gradients,
)

BILINEAR, SPLINE, WAVES = 0, 1, 2
"""The kinds of a source: texels, with their interpolation, or waves."""

KX, KY, AMPLITUDE, POTENTIAL, PHASE = range(5)
"""Rows of `Tiles.waves`."""

FAR = 4503599627370496.0  # 2^52 periods away the reduction below would not end in the first period


class Tiles(NamedTuple):
    """
    A source of waves: texels or waves of one or more tiles, end to end.

    With f = kx x + ky y - phase, a wave has the height amplitude cos f, and the displacement
    -potential (kx, ky) sin f.
    """

    sizes: Real  # (tiles, 2): lx, ly [m]
    layout: Integer  # (tiles, 3): first texel, nx, ny of each tile
    # (4 all,): displace_x, displace_y, height and nothing: 16 bytes if single; each tile is framed
    # as by `interpolate.frame_texels`
    texels: Real
    first: Integer  # (tiles + 1,): number of the first wave of each tile
    waves: Real  # (5, all): kx, ky [rad/m], amplitude [m], potential [m^2], phase [rad]


class Found(NamedTuple):
    """The result of an inversion, written to."""

    offsets: Real  # (points, 2): from the point to its parameters [m]
    heights: Real  # (points,) [m]
    residuals: Real  # (points,): distance of the water found from the point [m]
    jacobians: Real  # (points,): the least Jacobian met on the way [-]


class Search(NamedTuple):
    """Settings of `invert`."""

    choppiness: float  # [-]
    aim: float  # a residual that ends the search [m]
    limit: float  # a residual that is accepted after some steps [m]
    reach: float  # radius around the point from which to start again [m]


class Workspace(NamedTuple):
    """Buffers of `follow` for a block of points, written to."""

    origins: Real  # (tiles, 2, BLOCK): the points, reduced, in texels
    offsets: Real  # (2, BLOCK): of the points that are still searched for [m]
    rows: Real  # (ROWS * BLOCK,): as in `bilinear_gradients`
    points: Integer  # (BLOCK,): numbers of those points within the block


@compiled
def _reduce(x: float, y: float, sizes: Real, origin: Real) -> None:
    """Write origin[i] = (x, y) in the first period of tile i."""
    for i in range(sizes.shape[0]):
        origin[i, 0] = reduced(x, sizes[i, 0])
        origin[i, 1] = reduced(y, sizes[i, 1])


@compiled
def reduced(x: float, size: float) -> float:
    """Return x - size floor(x/size), or x itself if nothing repeats."""
    if np.isinf(size):
        return x
    periods = float(np.floor(x / size))
    if abs(periods) > FAR:
        return float(np.fmod(x, size))
    return x - periods * size


@compiled
def follow(
    cubic: bool,
    tiles: tuple[Any, ...],
    rates: Real,
    x: Real,
    y: Real,
    choppiness: float,
    limit: float,
    workspace: tuple[Any, ...],
    found: tuple[Any, ...],
) -> None:
    """
    Do the same as `invert` for texels, by at most `EASY` plain Newton steps: the fast path.

    A point is done when its residual is at most `limit` [m]. The others keep an infinite residual,
    and are left for `invert`. The first step leaves out the last tile: the others displace the
    water furthest, and their result is as good a place to start with ripples as the point itself.
    Points are searched for in blocks, and leave them as they are found.

    Args:
        cubic: interpolate by cubic splines, not linearly.
        tiles: the fields of `Tiles`.
        rates: nx/lx, ny/ly of each tile, (tiles, 2): texels to the metre.
        x, y: the points [m].
        choppiness: factor on the displacement [-].
        limit: largest residual [m].
        workspace: the fields of `Workspace`.
        found: the fields of `Found`.
    """
    source, buffers, result = Tiles(*tiles), Workspace(*workspace), Found(*found)
    count = source.sizes.shape[0]
    layout, rows, points = source.layout, buffers.rows, buffers.points
    origins, offsets = buffers.origins, buffers.offsets
    for start in range(0, result.heights.size, BLOCK):
        size = min(BLOCK, result.heights.size - start)
        live = _load_block(x, y, start, size, source.sizes, rates, buffers, result)
        offsets[:] = 0.0
        for step in range(EASY):
            used = count - 1 if step == 0 and count > 1 else count
            rows[DISPLACE_X : YY + BLOCK] = 0.0
            for i in range(used):
                per_x, per_y = rates[i, 0], rates[i, 1]
                for q in range(live):
                    rows[U + q] = origins[i, 0, points[q]] + offsets[0, q] * per_x
                    rows[V + q] = origins[i, 1, points[q]] + offsets[1, q] * per_y
                first, nx, ny = layout[i, 0], layout[i, 1], layout[i, 2]
                if cubic:
                    spline_gradients(source.texels, first, nx, ny, per_x, per_y, live, rows)
                else:
                    bilinear_gradients(source.texels, first, nx, ny, per_x, per_y, live, rows)
            enough = limit if used == count else -1.0
            live = _newton_step(choppiness, enough, start, live, buffers, result)
            if live == 0:
                break


@compiled
def _load_block(
    x: Real,
    y: Real,
    start: int,
    size: int,
    sizes: Real,
    rates: Real,
    workspace: Workspace,
    found: Found,
) -> int:
    """
    Load the finite points of a block, and return their number.

    The results of the others become NaN.
    """
    live = 0
    for q in range(size):
        p = start + q
        found.residuals[p] = found.jacobians[p] = np.inf
        if np.isfinite(x[p]) and np.isfinite(y[p]):
            workspace.points[live] = q
            live += 1
            for i in range(sizes.shape[0]):
                workspace.origins[i, 0, q] = reduced(x[p], sizes[i, 0]) * rates[i, 0]
                workspace.origins[i, 1, q] = reduced(y[p], sizes[i, 1]) * rates[i, 1]
        else:
            found.offsets[p, 0] = found.offsets[p, 1] = found.heights[p] = np.nan
            found.residuals[p] = found.jacobians[p] = np.nan
    return live


@compiled
def _newton_step(
    choppiness: float, enough: float, start: int, live: int, workspace: Workspace, found: Found
) -> int:
    """
    Move the points whose residual is above `enough` [m] by a Newton step; return their number.

    The results of the others are written, and they leave the block.
    """
    rows, points, offsets = workspace.rows, workspace.points, workspace.offsets
    kept = 0
    for q in range(live):
        p, sx, sy = start + points[q], offsets[0, q], offsets[1, q]
        rx, ry = sx + choppiness * rows[DISPLACE_X + q], sy + choppiness * rows[DISPLACE_Y + q]
        a, b = 1.0 + choppiness * rows[XX + q], choppiness * rows[XY + q]
        c, d = choppiness * rows[YX + q], 1.0 + choppiness * rows[YY + q]
        jacobian = a * d - b * c
        found.jacobians[p] = min(found.jacobians[p], jacobian)
        residual = np.sqrt(rx * rx + ry * ry)
        if residual <= enough:
            found.offsets[p, 0], found.offsets[p, 1] = sx, sy
            found.heights[p], found.residuals[p] = rows[HEIGHT + q], residual
            continue
        if jacobian > STEEP:
            inverse = 1.0 / jacobian
            sx += (b * ry - d * rx) * inverse
            sy += (c * rx - a * ry) * inverse
        else:
            sx -= rx
            sy -= ry
        points[kept], offsets[0, kept], offsets[1, kept] = points[q], sx, sy
        kept += 1
    return kept


EASY, STEEP = 12, 0.1  # steps of the fast path; the least Jacobian that it trusts


@compiled
def invert(
    kind: int,
    tiles: tuple[Any, ...],
    x: Real,
    y: Real,
    search: tuple[float, ...],
    origin: Real,
    found: tuple[Any, ...],
) -> None:
    """
    Find for each point x the offset s with s + c D(x + s) = 0, the water at x having the parameters
    x + s.

    Newton's method with the exact Jacobian 1 + c dD/dx of the sum or interpolant. A step that does
    not reduce the residual is halved. Where that fails, as it can beside a fold, the search starts
    again from points around, up to `search.reach` away. An answer exists there, because a bounded
    displacement leaves no hole in the surface. If none is within the limit, the best point is kept.

    The Jacobian written is the least on the way: where the surface is folded, the way leads over
    water that lies upside down. Results are NaN for points that are not finite.

    Args:
        kind: `BILINEAR`, `SPLINE` or `WAVES`.
        tiles: the fields of `Tiles`.
        x, y: the points [m].
        search: the fields of `Search`.
        origin: a buffer, (tiles, 2).
        found: the fields of `Found`.
    """
    source, result = Tiles(*tiles), Found(*found)
    choppiness, aim, limit, reach = search
    offsets, heights = result.offsets, result.heights
    residuals, jacobians = result.residuals, result.jacobians
    for p in range(heights.size):
        if not (np.isfinite(x[p]) and np.isfinite(y[p])):
            offsets[p, :] = np.nan
            heights[p] = residuals[p] = jacobians[p] = np.nan
            continue
        _reduce(x[p], y[p], source.sizes, origin)
        offsets[p, :] = np.nan  # until something is found
        heights[p] = residuals[p] = np.nan
        best = least = np.inf
        for start in range(STARTS):
            # The first start is the point itself, the next lie on a spiral that covers the circle
            # within reach (steps of the golden angle).
            angle, radius = 2.399963229728653 * start, reach * np.sqrt(start / STARTS)
            sx, sy = radius * np.cos(angle), radius * np.sin(angle)
            base_x, base_y, base, step_x, step_y, part = sx, sy, np.inf, 0.0, 0.0, 1.0
            for _ in range(STEPS):
                dx, dy, height, xx, xy, yx, yy = _displacement(kind, source, origin, sx, sy)
                rx, ry = sx + choppiness * dx, sy + choppiness * dy
                residual = np.sqrt(rx * rx + ry * ry)
                a, b, c, d = (
                    1.0 + choppiness * xx,
                    choppiness * xy,
                    choppiness * yx,
                    1.0 + choppiness * yy,
                )
                jacobian = a * d - b * c
                least = min(least, jacobian)
                if residual < best:
                    best = residual
                    offsets[p, 0], offsets[p, 1] = sx, sy
                    heights[p], residuals[p] = height, residual
                if residual <= aim:
                    break
                if residual < base:
                    base_x, base_y, base, part = sx, sy, residual, 1.0
                    if abs(jacobian) > 1e-12:
                        step_x, step_y = (b * ry - d * rx) / jacobian, (c * rx - a * ry) / jacobian
                    else:
                        step_x, step_y = -rx, -ry  # the fixed point's step
                    length = np.sqrt(step_x * step_x + step_y * step_y)
                    # Next to a fold the Jacobian gives no useful length.
                    if length > LONGEST * residual:
                        step_x *= LONGEST * residual / length
                        step_y *= LONGEST * residual / length
                else:
                    part *= 0.5
                    if part < SHORTEST:
                        break
                sx, sy = base_x + part * step_x, base_y + part * step_y
            if best <= limit:
                break
        jacobians[p] = least


STARTS, STEPS, LONGEST, SHORTEST = 100, 40, 10.0, 1e-3


@compiled
def _displacement(
    kind: int, tiles: Tiles, origin: Real, sx: float, sy: float
) -> tuple[float, float, float, float, float, float, float]:
    """
    Return displacement, height and displacement gradient of all tiles at origin + (sx, sy).

    As (dx, dy, height, xx, xy, yx, yy), with xy = d displace_x / dy.
    """
    first, waves, layout, texels = tiles.first, tiles.waves, tiles.layout, tiles.texels
    dx = dy = height = xx = xy = yx = yy = 0.0
    for i in range(tiles.sizes.shape[0]):
        px, py = origin[i, 0] + sx, origin[i, 1] + sy
        if kind == WAVES:
            for m in range(first[i], first[i + 1]):
                kx, ky = waves[KX, m], waves[KY, m]
                angle = kx * px + ky * py - waves[PHASE, m]
                cosine, sine = np.cos(angle), waves[POTENTIAL, m] * np.sin(angle)
                height += waves[AMPLITUDE, m] * cosine
                cosine *= waves[POTENTIAL, m]
                dx -= kx * sine
                dy -= ky * sine
                xx -= kx * kx * cosine
                xy -= kx * ky * cosine
                yy -= ky * ky * cosine
            yx = xy
        else:
            start, nx, ny = layout[i, 0], layout[i, 1], layout[i, 2]
            per_x, per_y = nx / tiles.sizes[i, 0], ny / tiles.sizes[i, 1]
            if kind == BILINEAR:
                a, b, h, a_u, a_v, b_u, b_v = bilinear_gradient(
                    texels, start, nx, ny, px * per_x, py * per_y
                )
            else:
                a, b, h, a_u, a_v, b_u, b_v = spline_gradient(
                    texels, start, nx, ny, px * per_x, py * per_y
                )
            dx += a
            dy += b
            height += h
            xx += a_u * per_x
            xy += a_v * per_y
            yx += b_u * per_x
            yy += b_v * per_y
    return dx, dy, height, xx, xy, yx, yy


@compiled
def sum_waves(
    tiles: tuple[Any, ...],
    omega: Real,
    x: Real,
    y: Real,
    offsets: Real,
    origin: Real,
    out: Real,
) -> None:
    """
    Write the derivatives of the displaced surface at (x, y) + offsets, summed over all waves.

    Args:
        tiles: the fields of `Tiles`, of which the waves are used.
        omega: of each wave [rad/s].
        x, y, offsets: the points, and what to add to them, (points, 2) [m].
        origin: a buffer, (tiles, 2).
        out: (points, 14): slope_x, slope_y, stretch_xx, stretch_xy, stretch_yy, then position,
            velocity and acceleration (x, y and z of each), where position is the displacement
            before choppiness.
    """
    source = Tiles(*tiles)
    sizes, first, waves = source.sizes, source.first, source.waves
    for p in range(out.shape[0]):
        if not (np.isfinite(x[p]) and np.isfinite(y[p])):
            out[p, :] = np.nan
            continue
        out[p, :] = 0.0
        _reduce(x[p], y[p], sizes, origin)
        for i in range(sizes.shape[0]):
            px, py = origin[i, 0] + offsets[p, 0], origin[i, 1] + offsets[p, 1]
            for m in range(first[i], first[i + 1]):
                kx, ky, rate = waves[KX, m], waves[KY, m], omega[m]
                angle = kx * px + ky * py - waves[PHASE, m]
                cosine, sine = np.cos(angle), np.sin(angle)
                up_cosine, up_sine = waves[AMPLITUDE, m] * cosine, waves[AMPLITUDE, m] * sine
                cosine *= waves[POTENTIAL, m]
                sine *= waves[POTENTIAL, m]
                out[p, 0] -= kx * up_sine
                out[p, 1] -= ky * up_sine
                out[p, 2] -= kx * kx * cosine
                out[p, 3] -= kx * ky * cosine
                out[p, 4] -= ky * ky * cosine
                out[p, 5] -= kx * sine
                out[p, 6] -= ky * sine
                out[p, 7] += up_cosine
                out[p, 8] += rate * kx * cosine
                out[p, 9] += rate * ky * cosine
                out[p, 10] += rate * up_sine
                out[p, 11] += rate * rate * kx * sine
                out[p, 12] += rate * rate * ky * sine
                out[p, 13] -= rate * rate * up_cosine


@compiled
def texel_coordinates(
    x: Real, y: Real, offsets: Real, lx: float, ly: float, nx: int, ny: int, u: Real, v: Real
) -> None:
    """Write u, v = the place of (x, y) + offsets on a tile, in texels; NaN if it is not finite."""
    for p in range(u.size):
        if np.isfinite(x[p]) and np.isfinite(y[p]):
            u[p] = (reduced(x[p], lx) + offsets[p, 0]) * (nx / lx)
            v[p] = (reduced(y[p], ly) + offsets[p, 1]) * (ny / ly)
        else:
            u[p] = v[p] = np.nan
