"""The one table of parameters and keys of the live page."""

import json
import math
import re

import pytest

from fftocean.errors import ParameterError
from fftocean.view.numbered_seas import preset_rows
from fftocean.view.parameters import ACTIONS, BY_NAME, LOCAL, PARAMETERS, SENT, table

KEYS = {
    "wind_speed": ("o", "p"),
    "swell_speed": ("k", "l"),
    "wind_direction": ("u", "i"),
    "swell_direction": ("h", "j"),
    "choppiness": (",", "."),
    "time_scale": ("[", "]"),
    "seed": (None, "r"),
    "tiles": (None, "t"),
    "view": (None, "v"),
    "model": (None, "g"),
}


def test_keys_of_parameters():
    found = {p.name: (p.key_down, p.key_up) for p in PARAMETERS if p.key_down or p.key_up}
    assert found == KEYS


def test_keys_of_actions():
    keys = {a.name: a.key for a in ACTIONS}
    assert "".join(keys[name] for name in ("forward", "left", "back", "right")) == "wasd"
    assert {keys[n] for n in ("pause", "copy_job", "copy_command", "screenshot", "help")} == {
        " ",
        "c",
        "b",
        "x",
        "?",
    }


def test_every_key_and_every_name_has_one_meaning():
    keys = [key for p in PARAMETERS for key in (p.key_down, p.key_up) if key]
    keys += [a.key for a in ACTIONS]
    assert len(keys) == len(set(keys))
    assert len(BY_NAME) == len(PARAMETERS)
    assert all(key == key.lower() for key in keys)


@pytest.mark.parametrize("parameter", PARAMETERS, ids=lambda p: p.name)
def test_rows_are_complete(parameter):
    row = parameter.as_row()
    json.dumps(row, allow_nan=False)
    assert re.fullmatch(r"[a-z_]+", parameter.name)
    assert all(row[name] for name in ("label", "help", "group"))
    assert parameter.check(row["default"]) == parameter.default
    if row["kind"] == "number":
        assert parameter.quantity.low <= row["low"] < row["high"] <= parameter.quantity.high
        assert row["step"] > 0
        assert not parameter.logarithmic or (row["low"] > 0 and row["step"] > 1)
    if row["kind"] == "choice":
        assert parameter.default in row["choices"]


def test_local_parameters_are_marked():
    assert {row["name"] for row in table()["parameters"] if row.get("local")} == {
        p.name for p in LOCAL
    }
    assert {p.name for p in SENT} >= {"wind_speed", "fetch", "depth", "seed", "tiles", "model"}


@pytest.mark.parametrize(
    "value",
    [math.nan, math.inf, -1.0, 41.0, 1e308, True, "12", None, [12], {"a": 1}, 10**400, 1j],
)
def test_wrong_values_of_a_number_are_refused(value):
    with pytest.raises(ParameterError, match=r"^wind_speed must be .*between 0 and 40 m/s"):
        BY_NAME["wind_speed"].check(value)


@pytest.mark.parametrize("value", [7.0, 0.5, -1, 10**6, True, "7", None])
def test_a_seed_is_a_whole_number(value):
    with pytest.raises(ParameterError, match="seed must be a whole number"):
        BY_NAME["seed"].check(value)


@pytest.mark.parametrize("value", ["FFT", "", 1, None, ["fft"]])
def test_unknown_words_are_refused(value):
    with pytest.raises(ParameterError, match="model must be one of fft, pms"):
        BY_NAME["model"].check(value)


@pytest.mark.parametrize("value", [0, 1, "true", None])
def test_a_switch_is_true_or_false(value):
    with pytest.raises(ParameterError, match="buoy must be true or false"):
        BY_NAME["buoy"].check(value)


def test_null_is_deep_water_and_nothing_else():
    assert BY_NAME["depth"].check(None) == math.inf
    assert BY_NAME["depth"].plain(math.inf) is None
    assert BY_NAME["depth"].as_row()["infinite"] == "deep water"
    with pytest.raises(ParameterError, match="fetch must be"):
        BY_NAME["fetch"].check(None)


def test_presets_are_values_that_the_table_permits():
    rows = preset_rows()
    assert [row["number"] for row in rows] == [*range(13), *range(10)]
    for row in rows:
        for name, value in row["values"].items():
            BY_NAME[name].check(value)
