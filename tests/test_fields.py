"""One table of signs: each row is the derivative that its name says."""

import inspect
import math

import numpy as np
import pytest

from fftocean.errors import FieldError
from fftocean.fields import EIGHT, FIELDS, multiplier, potential_factor
from fftocean.frame import EulerianFrame, Frame
from fftocean.grid import Grid

pytestmark = pytest.mark.nojit


def test_the_signs_written_out_once_more():
    """
    As the papers print them (Tessendorf 2001, eq. 20, 29, 37-40, with +i), for one wavenumber in
    water of 5 m.
    """
    kx, ky, depth = 0.3, -0.4, 5.0
    k = 0.5
    coth = 1.0 / math.tanh(k * depth)
    expected = {
        "height": 1.0,
        "displace_x": 1j * kx / k * coth,
        "displace_y": 1j * ky / k * coth,
        "slope_x": 1j * kx,
        "slope_y": 1j * ky,
        "stretch_xx": -kx * kx / k * coth,
        "stretch_xy": -kx * ky / k * coth,
        "stretch_yy": -ky * ky / k * coth,
        "velocity_x": 1j * kx / k * coth,
        "velocity_y": 1j * ky / k * coth,
        "velocity_z": 1.0,
    }
    assert set(expected) == set(FIELDS)
    for name, value in expected.items():
        assert complex(
            multiplier(FIELDS[name], np.float64(kx), np.float64(ky), depth)
        ) == pytest.approx(value, rel=1e-14)
    assert len(EIGHT) == 8
    assert not any(FIELDS[name].dt for name in EIGHT)


def test_potential_factor_limits():
    """1/k in deep water; 1/(k^2 h) in shallow; 0 where there is no wave; finite everywhere."""
    k = np.array([0.0, 1e-8, 1e-3, 1.0, 1e4])
    assert np.allclose(potential_factor(k, math.inf)[1:], 1.0 / k[1:], rtol=1e-15)
    assert potential_factor(k, math.inf)[0] == potential_factor(k, 1e-6)[0] == 0.0
    assert potential_factor(k, 0.01)[2] == pytest.approx(1.0 / (1e-6 * 0.01), rel=1e-9)
    assert np.all(np.isfinite(potential_factor(k, 1e-6)))


def test_every_field_is_an_attribute_of_a_frame_with_its_caption_and_unit():
    """Captions and units come from the table; a frame by world position has no displacement."""
    for name, field in FIELDS.items():
        document = inspect.getdoc(getattr(Frame, name))
        assert document.lower().startswith(field.caption.lower())
        assert document.endswith(f" [{'-' if field.unit == '1' else field.unit}].")
        arrays = {name: np.full((2, 2), 3.0)}
        assert getattr(Frame(0.0, Grid.of(2, 1.0), 1.0, arrays), name) is arrays[name]
    assert isinstance(Frame.height, property)
    assert EulerianFrame.velocity_z is Frame.velocity_z
    with pytest.raises(FieldError, match="an eulerian frame has no displace_x"):
        _ = EulerianFrame(0.0, Grid.of(2, 1.0), 1.0, {}).displace_x
