"""
Bytes of a run-time package, read by a decoder of this file that shares no code with the package.
"""

import json
import struct

import builders_of_packages as build
import numpy as np
import pytest

import fftocean as fo
from fftocean import runtime


@pytest.fixture(scope="module")
def cascade():
    return build.cascade()


def read_container(data):
    """Return the document and the files of a container."""
    magic, version, length, zero = struct.unpack_from("<4sIII", data)
    assert (magic, version, length % 16, zero) == (b"FFTO", 1, 0, 0)
    document = json.loads(data[16 : 16 + length])
    at, files = 16 + length, {}
    for row in document["files"]:
        files[row["name"]] = data[at : at + row["bytes"]]
        at += row["bytes"]
        padding = -at % 16
        assert data[at : at + padding] == bytes(padding)
        at += padding
    assert at == len(data)
    return document, files


def read_waves(data):
    """Return (mx, my, cycles, h0) of each record."""
    return [
        (mx, my, cycles, complex(re, im))
        for mx, my, cycles, re, im in struct.iter_unpack("<hhHff", data)
    ]


def test_the_records_are_the_waves_of_the_ocean(cascade):
    """height = sum of a cos(k.x - phase) has h0 = a/2 e^(-i phase)."""
    document, files = read_container(runtime.to_bytes(runtime.pack(cascade)))
    assert document["depth"] == 30.0
    assert document["choppiness"] == 0.9
    for i, (ocean, tile) in enumerate(zip(cascade.oceans, document["tiles"], strict=True)):
        (lx, ly), modes = tile["size"], ocean.modes()
        waves = read_waves(files[f"tile{i}.waves"])
        found = {(mx, my): (cycles, h0) for mx, my, cycles, h0 in waves}
        assert len(found) == len(waves) == tile["waves"] == modes.kx.size
        for kx, ky, amplitude, phase, omega in zip(*modes, strict=True):
            place = round(kx * lx / (2 * np.pi)), round(ky * ly / (2 * np.pi))
            cycles, h0 = found[place]
            assert cycles == round(omega * 64.0 / (2 * np.pi))
            assert h0 == pytest.approx(0.5 * amplitude * np.exp(-1j * phase), rel=1.2e-7)


@pytest.mark.parametrize("turned", [False, True])
def test_wavenumbers_of_oblong_tiles_have_their_sign(turned):
    """Up to the largest along each side, which is not the other's."""
    places = [(7, 1), (-7, -3), (6, -3), (-5, 2), (0, 3)]
    n, size = (16, 8), (60.0, 40.0)
    if turned:
        places, n, size = [place[::-1] for place in places], n[::-1], size[::-1]
    waves = [(mx, my, 0.01, 0.3) for mx, my in places]
    ocean = fo.Ocean.from_modes(waves, n=n, size=size, loop=64.0)
    _, files = read_container(runtime.to_bytes(runtime.pack(ocean)))
    assert {(mx, my) for mx, my, _, _ in read_waves(files["tile0.waves"])} == set(places)


def test_records_follow_the_rows_of_the_plane(cascade):
    package = runtime.pack(cascade, reference=False)
    for tile, data in zip(package.document["tiles"], package.files.values(), strict=True):
        nx, ny = tile["n"]
        places = [(my % ny) * nx + mx % nx for mx, my, _, _ in read_waves(data)]
        assert places == sorted(set(places))


def test_textures_are_both_halves_of_each_wave(cascade):
    package = runtime.pack(cascade, textures=True, reference=False)
    for i, (ocean, tile) in enumerate(zip(cascade.oceans, package.document["tiles"], strict=True)):
        nx, ny = tile["n"]
        h0 = np.frombuffer(package.files[f"tile{i}_h0.bin"], "<f4").reshape(ny, nx, 4)
        wave = np.frombuffer(package.files[f"tile{i}_wave.bin"], "<f4").reshape(ny, nx, 2)
        expected = np.zeros_like(h0)
        cycles = np.zeros((ny, nx))
        for mx, my, count, amplitude in read_waves(package.files[f"tile{i}.waves"]):
            expected[my, mx, :2] = amplitude.real, amplitude.imag
            expected[-my, -mx, 2:] = amplitude.real, -amplitude.imag
            cycles[my, mx] = cycles[-my, -mx] = count
        assert np.array_equal(h0, expected)
        assert np.array_equal(wave[..., 0], cycles)
        kx = 2 * np.pi * np.fft.fftfreq(nx, ocean.grid.lx / nx)
        ky = 2 * np.pi * np.fft.fftfreq(ny, ocean.grid.ly / ny)
        k = np.hypot(kx, ky[:, None])
        k[0, 0] = np.inf
        np.testing.assert_allclose(wave[..., 1], 1 / (k * np.tanh(30.0 * k)), rtol=1e-6)
        ours = runtime.amplitude_planes(ocean)
        assert np.array_equal(ours[0], h0)
        assert np.array_equal(ours[1], wave)


def test_planes_become_the_waves_they_were(cascade):
    for ocean in cascade.oceans:
        h0, _ = runtime.amplitude_planes(ocean)
        a = runtime.waves_from_planes(
            h0[..., 0] + 1j * h0[..., 1], ocean.grid, loop=64.0, depth=30.0
        )
        assert np.array_equal(a.forward, ocean.amplitudes.forward.astype(np.complex64))
        assert np.array_equal(a.backward, ocean.amplitudes.backward.astype(np.complex64))
        assert np.array_equal(a.cycles, ocean.amplitudes.cycles)


def test_a_moving_sea_is_packed_from_amplitudes(cascade):
    """The slow parts are left out; the waves are the same bytes."""
    source = runtime.Source(
        tiles=tuple(ocean.amplitudes for ocean in cascade.oceans), choppiness=0.9, sea=build.SEA
    )
    moving = runtime.pack(source, quality="moving")
    exact = runtime.pack(cascade)
    assert moving.document["quality"] == "moving"
    assert all(exact.files[name] == data for name, data in moving.files.items())
    assert set(exact.files) - set(moving.files) == {"check.json"}
    assert moving.document["files"][0]["sha256"] is None
    hs = moving.document["statistics"]["specified"]["hs"]
    assert hs == pytest.approx(build.SEA.hs, rel=0.01)


def test_seas_of_several_systems_and_of_none_are_packed():
    crossed = fo.Sea(
        fo.WaveSystem(spectrum=fo.JONSWAP(peak=0.8), direction=40.0),
        fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=11.0), direction=100.0),
    )
    for sea in (crossed, fo.Sea.beaufort(0), fo.Sea()):
        ocean = fo.Ocean(sea, n=16, size=200.0, loop=64.0)
        states = [
            runtime.pack(ocean, quality=quality).document["statistics"]["specified"]
            for quality in ("exact", "moving")
        ]
        assert states[1]["hs"] == pytest.approx(states[0]["hs"], rel=0.01)
        assert states[1]["tp"] == states[0]["tp"]
        assert states[1]["direction"] == pytest.approx(states[0]["direction"], abs=5.0)
        assert runtime.from_bytes(runtime.to_bytes(runtime.pack(ocean))).files


@pytest.mark.parametrize(
    ("keyword", "value", "words"),
    [
        ("textures", 1, "textures must be True, False or one of bin, ktx2, exr, got 1"),
        ("reference", -1, "reference must be a whole number between 0 and 4096"),
        ("reference", 2.0, "reference must be a whole number"),
        ("quality", "fast", "quality must be 'exact' or 'moving'"),
        ("foam", 0.7, "foam must be a Foam"),
        ("job", fo.Job.default(), "job must be TOML text"),
        ("job", "#" * 300_000, "job must be TOML text of at most 262144 characters"),
        ("wind", 8.0, r"wind must be \(speed, direction\)"),
        ("wind", (float("nan"), 0.0), r"wind\[0\] must be between 0 and 150 m/s"),
        ("wind", (8.0, "N"), r"wind\[1\] must be a number"),
    ],
)
def test_options_out_of_range_are_refused(keyword, value, words):
    ocean = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=50.0, loop=20.0)
    with pytest.raises(fo.ParameterError, match=words):
        runtime.pack(ocean, **{keyword: value})


def test_bounds_are_reached_and_not_passed(cascade):
    """
    Those that are measured are the largest of eight moments, the sum over tiles at their worst;
    those that are estimated, five standard deviations, are never below.
    """
    measured = runtime.pack(cascade).document["bounds"]
    estimated = runtime.pack(cascade, reference=False).document["bounds"]
    assert (measured["moments"], estimated["moments"]) == (8, 0)
    frames = [cascade.loop_frame(j, 8) for j in range(8)]
    highest = sum(max(float(np.max(np.abs(frame[i].height))) for frame in frames) for i in range(3))
    farthest = sum(
        max(float(np.max(np.hypot(frame[i].displace_x, frame[i].displace_y))) for frame in frames)
        for i in range(3)
    )
    assert measured["height"] == pytest.approx(highest)
    assert measured["displacement"] == pytest.approx(0.9 * farthest)
    assert measured["height"] < 1.2 * estimated["height"]
    assert measured["displacement"] < 1.2 * estimated["displacement"]
    assert estimated["jacobian"] < measured["jacobian"] < 1.0


def test_the_table_of_the_spectrum_holds_the_energy_of_the_waves(cascade):
    """Densities times the widths of their bins, which lie half way between whole cycles."""
    document = runtime.pack(cascade).document
    table, state = document["spectrum"], document["statistics"]["realised"]
    frequency, realised = (np.array(table[key]) for key in ("frequency", "realised"))
    assert np.all(np.diff(frequency) > 0.0)
    edges = [
        (
            min(
                tile.amplitudes.cycles[tile.amplitudes.forward != 0].min()
                for tile in cascade.oceans
            )
            - 0.5
        )
        / 64.0
    ]
    for middle in frequency:
        edges.append(2.0 * middle - edges[-1])
    m0 = np.sum(realised * np.diff(edges))
    assert 4.0 * np.sqrt(m0) == pytest.approx(state["hs"], rel=1e-4)
    middle = 2.0 * np.pi * frequency
    # six digits of the frequency, of which the density takes the fifth power
    np.testing.assert_allclose(table["density"], 2.0 * np.pi * build.SEA(middle), rtol=5e-5)


def test_slopes_are_captured_total_and_beyond(cascade):
    """
    Captured: the sum of a^2/2 k k^T of given waves. Total: Cox and Munk's 0.00316 U along the
    wind and 0.003 + 0.00192 U across it.
    """
    ocean = fo.Ocean.from_modes(
        [(1, 0, 0.3, 0.0), (-2, 1, 0.1, 1.0)], n=8, size=(50.0, 40.0), loop=20.0
    )
    kx, ky, half = np.array([[1, 0, 0.045], [-2, 1, 0.005]]).T * [
        [2 * np.pi / 50.0],
        [2 * np.pi / 40.0],
        [1.0],
    ]
    slopes = runtime.pack(ocean).document["slope_variance"]
    expected = [np.sum(half * kx * kx), np.sum(half * ky * ky), np.sum(half * kx * ky)]
    assert slopes["captured"] == pytest.approx(expected)
    assert np.subtract(slopes["total"], slopes["captured"]) == pytest.approx(slopes["beyond"])
    slopes = runtime.pack(cascade, reference=False, wind=(12.0, 90.0)).document["slope_variance"]
    assert slopes["total"] == pytest.approx([0.003 + 0.00192 * 12, 0.00316 * 12, 0.0])
    assert np.add(slopes["captured"], slopes["beyond"]) == pytest.approx(slopes["total"])


def test_foam_follows_the_wind_and_what_is_given(cascade):
    """Less wind covers less of the same waves; a moving sea has that of the exact one."""
    default = runtime.pack(cascade, reference=False).document["foam"]
    assert default == {"decay": 3.5, "threshold": 0.72, "strength": 60.0}
    given = fo.Foam(tau=2.0, threshold=0.6, strength=30.0)
    document = runtime.pack(cascade, reference=False, wind=(12.0, 30.0), foam=given).document
    assert document["foam"] == {"decay": 2.0, "threshold": 0.6, "strength": 30.0}
    assert document["wind"] == {"speed": 12.0, "direction": 30.0}
    expected = fo.Foam.from_wind(cascade, 12.0).threshold
    source = runtime.Source.of(cascade)
    for quality in ("exact", "moving"):
        package = runtime.pack(source, reference=False, quality=quality, wind=(12.0, 30.0))
        assert package.document["foam"]["threshold"] == pytest.approx(expected, rel=1e-12)
    calm = runtime.pack(source, quality="moving", wind=(5.0, 30.0)).document["foam"]
    assert calm["threshold"] < expected


def test_statistics_are_those_measured_on_the_fields(cascade):
    document = runtime.pack(cascade).document
    measured = fo.measure(cascade)
    realised = document["statistics"]["realised"]
    assert realised["hs"] == pytest.approx(measured.hs, rel=1e-5)
    assert realised["direction"] == pytest.approx(measured.mean_direction, abs=1e-3)
    assert realised["tp"] == pytest.approx(measured.tp, rel=1e-4)
    assert document["statistics"]["specified"]["hs"] == pytest.approx(build.SEA.hs)
