"""
The inner loops of point queries: find the parameters whose water is at a world point, and sum or
interpolate what is there.

A source of waves is a few tiles, each periodic in its own size (inf: not at all), which add up.
Tiles are either texels, to be interpolated, or lists of waves, to be summed. Parameters are kept as
the world point, reduced to the first period of each tile, plus an offset of a few metres: far from
the origin nothing but the reduction itself loses digits.

    kind     BILINEAR, SPLINE or WAVES
    sizes    (tiles, 2)      lx, ly [m]
    rates    (tiles, 2)      nx/lx, ny/ly: texels to the metre
    layout   (tiles, 3)      first, nx, ny of each tile's texels in the flat arrays
    texels   (4 all,)        displace_x, displace_y, height and nothing of each: 16 bytes in single
    precision first    (tiles + 1,)    where the waves of each tile begin
    waves    (5, all)        kx, ky, a, push, start: height a cos f, displacement -push (kx, ky) sin
    f, with f = kx x + ky y - start
"""

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.kernels.compiler import compiled
from fftocean.kernels.interpolate import (
    BLOCK,
    bilinear_gradient,
    bilinear_gradients,
    spline_gradient,
    spline_gradients,
)

BILINEAR, SPLINE, WAVES = 0, 1, 2

FAR = 4503599627370496.0  # 2^52 periods away the reduction below would not end in the first period


@compiled
def _reduce(x: float, y: float, sizes: Real, origin: Real) -> None:
    """origin[i] = (x, y) in the first period of tile i."""
    for i in range(sizes.shape[0]):
        origin[i, 0] = _reduced(x, sizes[i, 0])
        origin[i, 1] = _reduced(y, sizes[i, 1])


@compiled
def _reduced(x: float, size: float) -> float:
    """x - size floor(x/size), or x itself where nothing repeats."""
    if np.isinf(size):
        return x
    periods = float(np.floor(x / size))
    if abs(periods) > FAR:
        return float(np.fmod(x, size))
    return x - periods * size


@compiled
def follow(
    cubic: bool,
    sizes: Real,
    rates: Real,
    layout: Integer,
    texels: Real,
    x: Real,
    y: Real,
    choppiness: float,
    limit: float,
    origins: Real,
    moved: Real,
    desk: Real,
    points: Integer,
    offsets: Real,
    heights: Real,
    residuals: Real,
    jacobians: Real,
) -> None:
    """
    The same as `invert` for texels where the way is easy, which it nearly always is: Newton's steps
    as they come, a few of them.

    Stops where the residual is at most `limit` [m]. What is left above it, with an infinite
    residual, is for `invert`. The first step does without the last tile: the others displace the
    water furthest, and where it ends up is as good a place to look at ripples as the start was.
    Points go through in blocks, and leave them as they are found. Room to work in: `origins`
    (tiles, 2, BLOCK), `moved` (2, BLOCK), `desk` as in `bilinear_gradients`, `points` (BLOCK,).
    """
    tiles = sizes.shape[0]
    for start in range(0, heights.size, BLOCK):
        live = _enter(
            x,
            y,
            start,
            min(BLOCK, heights.size - start),
            sizes,
            rates,
            origins,
            points,
            offsets,
            heights,
            residuals,
            jacobians,
        )
        moved[:] = 0.0
        for count in range(EASY):
            known = tiles - 1 if count == 0 and tiles > 1 else tiles
            desk[2 * BLOCK : 9 * BLOCK] = 0.0
            for i in range(known):
                for q in range(live):
                    desk[q] = origins[i, 0, points[q]] + moved[0, q] * rates[i, 0]
                    desk[BLOCK + q] = origins[i, 1, points[q]] + moved[1, q] * rates[i, 1]
                if cubic:
                    spline_gradients(
                        texels,
                        layout[i, 0],
                        layout[i, 1],
                        layout[i, 2],
                        rates[i, 0],
                        rates[i, 1],
                        live,
                        desk,
                    )
                else:
                    bilinear_gradients(
                        texels,
                        layout[i, 0],
                        layout[i, 1],
                        layout[i, 2],
                        rates[i, 0],
                        rates[i, 1],
                        live,
                        desk,
                    )
            enough = limit if known == tiles else -1.0
            live = _step(
                choppiness,
                enough,
                start,
                live,
                moved,
                desk,
                points,
                offsets,
                heights,
                residuals,
                jacobians,
            )
            if live == 0:
                break


@compiled
def _enter(
    x: Real,
    y: Real,
    start: int,
    size: int,
    sizes: Real,
    rates: Real,
    origins: Real,
    points: Integer,
    offsets: Real,
    heights: Real,
    residuals: Real,
    jacobians: Real,
) -> int:
    """
    Let the points of a block in that are finite: their places in texels, and how many they are. The
    others are done with.
    """
    live = 0
    for q in range(size):
        p = start + q
        residuals[p] = jacobians[p] = np.inf
        if np.isfinite(x[p]) and np.isfinite(y[p]):
            points[live] = q
            live += 1
            for i in range(sizes.shape[0]):
                origins[i, 0, q] = _reduced(x[p], sizes[i, 0]) * rates[i, 0]
                origins[i, 1, q] = _reduced(y[p], sizes[i, 1]) * rates[i, 1]
        else:
            offsets[p, 0] = offsets[p, 1] = heights[p] = residuals[p] = jacobians[p] = np.nan
    return live


@compiled
def _step(
    choppiness: float,
    enough: float,
    start: int,
    live: int,
    moved: Real,
    desk: Real,
    points: Integer,
    offsets: Real,
    heights: Real,
    residuals: Real,
    jacobians: Real,
) -> int:
    """
    Take Newton's step with the points whose residual is above `enough` [m], and let the others go;
    return how many stay.
    """
    kept = 0
    for q in range(live):
        p, sx, sy = start + points[q], moved[0, q], moved[1, q]
        rx, ry = sx + choppiness * desk[2 * BLOCK + q], sy + choppiness * desk[3 * BLOCK + q]
        a, b = 1.0 + choppiness * desk[5 * BLOCK + q], choppiness * desk[6 * BLOCK + q]
        c, d = choppiness * desk[7 * BLOCK + q], 1.0 + choppiness * desk[8 * BLOCK + q]
        jacobian = a * d - b * c
        jacobians[p] = min(jacobians[p], jacobian)
        residual = np.sqrt(rx * rx + ry * ry)
        if residual <= enough:
            offsets[p, 0], offsets[p, 1] = sx, sy
            heights[p], residuals[p] = desk[4 * BLOCK + q], residual
            continue
        if jacobian > STEEP:
            inverse = 1.0 / jacobian
            sx += (b * ry - d * rx) * inverse
            sy += (c * rx - a * ry) * inverse
        else:
            sx -= rx
            sy -= ry
        points[kept], moved[0, kept], moved[1, kept] = points[q], sx, sy
        kept += 1
    return kept


EASY, STEEP = 12, 0.1


@compiled
def invert(
    kind: int,
    sizes: Real,
    layout: Integer,
    texels: Real,
    first: Integer,
    waves: Real,
    x: Real,
    y: Real,
    choppiness: float,
    aim: float,
    limit: float,
    reach: float,
    origin: Real,
    offsets: Real,
    heights: Real,
    residuals: Real,
    jacobians: Real,
) -> None:
    """
    Find for each point x the offset s with s + c D(x + s) = 0: the parameters x + s are those of
    the water at x.

    Newton's method with the exact Jacobian 1 + c dD/dx of whatever is summed or interpolated. A
    step that does not bring the residual down is halved. Where that leads nowhere, as it can beside
    a fold, the search starts again from points around, up to `reach` [m] away; an answer there is,
    as a bounded displacement leaves no hole in the surface.

    Stops where the residual is at most `aim` [m], or, after some steps, at most `limit`; else the
    best point found is kept. `offsets` (points, 2), `heights`, `residuals` [m] and the least of the
    `jacobians` met on the way are written: where the surface is folded, the way leads over water
    that lies upside down. NaN for points that are not finite. `origin` (tiles, 2) is room to work
    in.
    """
    for p in range(heights.size):
        if not (np.isfinite(x[p]) and np.isfinite(y[p])):
            offsets[p, :] = np.nan
            heights[p] = residuals[p] = jacobians[p] = np.nan
            continue
        _reduce(x[p], y[p], sizes, origin)
        offsets[p, :] = np.nan  # until something is found
        heights[p] = residuals[p] = np.nan
        best = least = np.inf
        for start in range(STARTS):
            # The first from the point itself, the next along a spiral that covers all within reach
            # (steps of the golden angle).
            angle, radius = 2.399963229728653 * start, reach * np.sqrt(start / STARTS)
            sx, sy = radius * np.cos(angle), radius * np.sin(angle)
            base_x, base_y, base, step_x, step_y, part = sx, sy, np.inf, 0.0, 0.0, 1.0
            for _ in range(STEPS):
                dx, dy, height, xx, xy, yx, yy = _water(
                    kind, sizes, layout, texels, first, waves, origin, sx, sy
                )
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
                    if (
                        length > LONGEST * residual
                    ):  # next to a fold, where the Jacobian says little
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
def _water(
    kind: int,
    sizes: Real,
    layout: Integer,
    texels: Real,
    first: Integer,
    waves: Real,
    origin: Real,
    sx: float,
    sy: float,
) -> tuple[float, float, float, float, float, float, float]:
    """
    Displacement, height, and d displacement/dx: (dx, dy, height, xx, xy, yx, yy) of all tiles at
    origin + (sx, sy).
    """
    dx = dy = height = xx = xy = yx = yy = 0.0
    for i in range(sizes.shape[0]):
        px, py = origin[i, 0] + sx, origin[i, 1] + sy
        if kind == WAVES:
            for m in range(first[i], first[i + 1]):
                kx, ky = waves[0, m], waves[1, m]
                angle = kx * px + ky * py - waves[4, m]
                cosine, sine = np.cos(angle), waves[3, m] * np.sin(angle)
                height += waves[2, m] * cosine
                cosine *= waves[3, m]
                dx -= kx * sine
                dy -= ky * sine
                xx -= kx * kx * cosine
                xy -= kx * ky * cosine
                yy -= ky * ky * cosine
            yx = xy
        else:
            start, nx, ny = layout[i, 0], layout[i, 1], layout[i, 2]
            per_x, per_y = nx / sizes[i, 0], ny / sizes[i, 1]
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
    sizes: Real,
    first: Integer,
    waves: Real,
    omega: Real,
    x: Real,
    y: Real,
    offsets: Real,
    origin: Real,
    out: Real,
) -> None:
    """
    out[p] = the sums over all waves at (x, y) + offsets of the displaced surface's derivatives,
    (points, 14):

    slope_x, slope_y, stretch_xx, stretch_xy, stretch_yy, then position, velocity and acceleration
    (x, y and z of each), where position is the displacement before choppiness.
    """
    for p in range(out.shape[0]):
        if not (np.isfinite(x[p]) and np.isfinite(y[p])):
            out[p, :] = np.nan
            continue
        out[p, :] = 0.0
        _reduce(x[p], y[p], sizes, origin)
        for i in range(sizes.shape[0]):
            px, py = origin[i, 0] + offsets[p, 0], origin[i, 1] + offsets[p, 1]
            for m in range(first[i], first[i + 1]):
                kx, ky, rate = waves[0, m], waves[1, m], omega[m]
                angle = kx * px + ky * py - waves[4, m]
                cosine, sine = np.cos(angle), np.sin(angle)
                up_cosine, up_sine = waves[2, m] * cosine, waves[2, m] * sine
                cosine *= waves[3, m]
                sine *= waves[3, m]
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
    """(u, v) = where (x, y) + offsets is on a tile, in texels; NaN where it is not finite."""
    for p in range(u.size):
        if np.isfinite(x[p]) and np.isfinite(y[p]):
            u[p] = (_reduced(x[p], lx) + offsets[p, 0]) * (nx / lx)
            v[p] = (_reduced(y[p], ly) + offsets[p, 1]) * (ny / ly)
        else:
            u[p] = v[p] = np.nan


@compiled
def sum_heights(
    sizes: Real, first: Integer, waves: Real, x: Real, y: Real, origin: Real, out: Real
) -> None:
    """
    out[p] = the sum of a cos f at (x, y): the surface of linear theory, where no water moves
    sideways; NaN where not finite.
    """
    for p in range(out.size):
        out[p] = 0.0 if np.isfinite(x[p]) and np.isfinite(y[p]) else np.nan
        _reduce(x[p], y[p], sizes, origin)
        for i in range(sizes.shape[0]):
            for m in range(first[i], first[i + 1]):
                out[p] += waves[2, m] * np.cos(
                    waves[0, m] * origin[i, 0] + waves[1, m] * origin[i, 1] - waves[4, m]
                )


@compiled
def sum_below(
    sizes: Real,
    first: Integer,
    waves: Real,
    omega: Real,
    depth: float,
    x: Real,
    y: Real,
    z: Real,
    origin: Real,
    out: Real,
) -> None:
    """
    out[p] = what the waves do at (x, y, z), z <= 0: velocity and acceleration, x, y and z of each,
    and -d potential/dt, (points, 7).

    A wave moves the water by cosh k(z + h)/sinh kh along and sinh k(z + h)/sinh kh up. Both are
    written with exponents that are never positive, so that nothing overflows; deep water is their
    limit, e^{kz}.
    """
    for p in range(out.shape[0]):
        if not (np.isfinite(x[p]) and np.isfinite(y[p]) and np.isfinite(z[p])):
            out[p, :] = np.nan
            continue
        out[p, :] = 0.0
        _reduce(x[p], y[p], sizes, origin)
        for i in range(sizes.shape[0]):
            for m in range(first[i], first[i + 1]):
                kx, ky, rate = waves[0, m], waves[1, m], omega[m]
                k = np.sqrt(kx * kx + ky * ky)
                angle = kx * origin[i, 0] + ky * origin[i, 1] - waves[4, m]
                along = up = np.exp(k * z[p])
                if depth < np.inf:
                    mirrored = np.exp(-k * (z[p] + 2.0 * depth))
                    whole = -np.expm1(-2.0 * k * depth)
                    along, up = (along + mirrored) / whole, (up - mirrored) / whole
                along *= waves[2, m] * rate / k
                up *= waves[2, m] * rate
                cosine, sine = np.cos(angle), np.sin(angle)
                out[p, 0] += along * kx * cosine
                out[p, 1] += along * ky * cosine
                out[p, 2] += up * sine
                out[p, 3] += along * rate * kx * sine
                out[p, 4] += along * rate * ky * sine
                out[p, 5] -= up * rate * cosine
                out[p, 6] += along * rate * cosine
