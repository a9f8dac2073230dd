"""Sum of waves at samples of a grid, from tables of phasors: no transform."""

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.kernels.compiler import compiled


@compiled
def eight_fields(
    column: Integer,
    row: Integer,
    waves: Real,
    along_x: Real,
    along_y: Real,
    out: Real,
) -> None:
    """
    Add the eight fields of some waves at some points and moments.

    Args:
        column, row: (m,), the wave's number in the tables.
        waves: (m, 3 + 2 q): kx, ky, 1/(k tanh kh), then the real and imaginary parts of the wave's
            complex amplitude at each of q moments.
        along_x, along_y: (n, 2, p): real and imaginary parts of e^(i kx x), e^(i ky y) at points.
        out: (q, 8, p): height, slopes, displacements, stretches xx, xy, yy; added to.
    """
    moments, points = out.shape[0], np.uint64(out.shape[2])
    real, imaginary = np.empty(points), np.empty(points)
    for m in range(column.size):
        x, y, wave = along_x[column[m]], along_y[row[m]], waves[m]
        xr, xi, yr, yi = x[0], x[1], y[0], y[1]
        for p in range(points):
            real[p] = xr[p] * yr[p] - xi[p] * yi[p]
            imaginary[p] = xr[p] * yi[p] + xi[p] * yr[p]
        kx, ky, f = wave[0], wave[1], wave[2]
        kxf, kyf = kx * f, ky * f
        xx, xy, yy = kx * kxf, kx * kyf, ky * kyf
        for q in range(moments):
            a, b = wave[3 + 2 * q], wave[4 + 2 * q]
            o = out[q].reshape(8 * points)  # one array: compilers vectorise loops that write to one
            for p in range(points):
                c = a * real[p] - b * imaginary[p]
                s = a * imaginary[p] + b * real[p]
                k = np.uint64(p)
                o[k] += c
                o[points + k] -= kx * s
                o[np.uint64(2) * points + k] -= ky * s
                o[np.uint64(3) * points + k] -= kxf * s
                o[np.uint64(4) * points + k] -= kyf * s
                o[np.uint64(5) * points + k] -= xx * c
                o[np.uint64(6) * points + k] -= xy * c
                o[np.uint64(7) * points + k] -= yy * c
