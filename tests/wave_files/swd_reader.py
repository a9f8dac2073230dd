"""
A reader of SWD files, written from the documentation of spectral_wave_data; shares no code with
fftocean.

The waves of a step are read as phi = Re sum c e^{-i k.x} Z(z), zeta = Re sum h e^{-i k.x}, and
differentiated by hand.
"""

import struct

import numpy as np

HEAD = struct.Struct("<fiii30s20si")


def read(path):
    """Return (header, body) of a file; the body is a list of steps, or the waves of a list."""
    data = path.read_bytes()
    magic, version, shape, amp, program, date, length = HEAD.unpack_from(data)
    at = HEAD.size
    about = data[at : at + length]
    at += length
    gravity, scale, strip, steps, dt, order = struct.unpack_from("<ffiifi", data, at)
    at += 24
    head = {
        "magic": magic, "version": version, "shape": shape, "amp": amp, "program": program,
        "date": date, "about": about, "gravity": gravity, "scale": scale, "strip": strip,
        "steps": steps, "dt": dt, "order": order,
    }  # fmt: skip
    if shape == 6:
        n, depth = struct.unpack_from("<if", data, at)
        waves = np.frombuffer(data, "<f4", offset=at + 8).astype(float).reshape(n, 4)
        return head | {"depth": depth}, waves
    nx, ny, dkx, dky = struct.unpack_from("<iiff", data, at)
    at += 16
    depth = -1.0
    if shape == 5:
        (depth,) = struct.unpack_from("<f", data, at)
        at += 4
    arrays = np.frombuffer(data, "<c8", offset=at).astype(complex)
    # Fortran order: jy, from -ny, is the fastest index
    arrays = arrays.reshape(steps, 4, nx + 1, 2 * ny + 1)
    jx, jy = np.meshgrid(np.arange(nx + 1), np.arange(-ny, ny + 1), indexing="ij")
    return head | {"depth": depth, "kx": jx * dkx, "ky": jy * dky}, arrays


def sums(h, c, c_t, kx, ky, depth, x, y, z):
    """Return elevation, velocity, its rate of change at a fixed point, and d phi / dt."""
    k = np.hypot(kx, ky)
    wave = np.exp(-1j * (kx * x + ky * y))
    if depth < 0.0:
        profile, slope = np.exp(k * z), k * np.exp(k * z)
    else:
        profile = np.cosh(k * (z + depth)) / np.cosh(k * depth)
        slope = k * np.sinh(k * (z + depth)) / np.cosh(k * depth)

    def gradient(potential):
        return np.array(
            [
                np.sum((-1j * kx * potential * wave).real * profile),
                np.sum((-1j * ky * potential * wave).real * profile),
                np.sum((potential * wave).real * slope),
            ]
        )

    rate = np.sum((c_t * wave).real * profile)
    return np.sum((h * wave).real), gradient(c), gradient(c_t), rate


def water(path, x, y, z, t):
    """Return elevation, velocity, acceleration and d phi / dt at a point; t is a step's time."""
    head, body = read(path)
    if head["shape"] != 6:
        step = body[round(t / head["dt"])]
        h, _, c, c_t = step
        return sums(h, c, c_t, head["kx"], head["ky"], head["depth"], x, y, z)
    a, k, direction, phase = body.T
    omega2 = head["gravity"] * k * (1.0 if head["depth"] < 0.0 else np.tanh(k * head["depth"]))
    omega = np.sqrt(omega2)
    h = a * np.exp(1j * (omega * t + phase))
    c = 1j * head["gravity"] / omega * h
    kx, ky = k * np.cos(direction), k * np.sin(direction)
    return sums(h, c, 1j * omega * c, kx, ky, head["depth"], x, y, z)
