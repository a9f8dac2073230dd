"""Positions of instruments and of points of models: degrees east and north."""

import pytest
from instrument_files import write_triaxys, write_ww3_text
from spectrum_files import sea

from fftocean import readers


@pytest.mark.parametrize(
    ("text", "lon", "lat"),
    [
        ("4857.6668S16631.6837W", -(166.0 + 31.6837 / 60.0), -(48.0 + 57.6668 / 60.0)),
        ("4857.6668N16631.6837E", 166.0 + 31.6837 / 60.0, 48.0 + 57.6668 / 60.0),
        ("0130.0000S 0745.0000E", 7.75, -1.5),
    ],
)
def test_triaxys_has_degrees_and_minutes(text, lon, lat, tmp_path):
    """Two digits of degrees of latitude, the rest are minutes; south and west are negative."""
    path = write_triaxys(tmp_path / "a.DIRSPEC", sea())
    title, *rest = path.read_text().splitlines()
    before = title.rpartition(" - ")[0]  # the last part is a position
    path.write_text("\n".join([f"{before} - {text}", *rest]) + "\n")
    data = readers.open(path)
    assert float(data.lon) == pytest.approx(lon, abs=1e-9)
    assert float(data.lat) == pytest.approx(lat, abs=1e-9)


def test_wavewatch_text_has_the_latitude_first(tmp_path):
    data = readers.open(write_ww3_text(tmp_path / "a.spec", sea()))
    assert (float(data.lat), float(data.lon)) == (45.0, -130.0)
