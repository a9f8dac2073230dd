"""Text of job files, read back by the standard TOML parser."""

import tomllib

import pytest

from fftocean.job.job_text import toml_value


@pytest.mark.parametrize(
    "value", ["plain", 'quoted "\\"', "line\nline\t", "\x7f\x00", "\ue000", "\U000e0001", "æ 波 🌊"]
)
def test_any_text_is_read_back(value):
    assert tomllib.loads(f"x = {toml_value(value)}")["x"] == value
