"""Messages of the page: exactly what the table permits, refused with the reason otherwise."""

import base64
import json
import struct

import numpy as np
import pytest

import fftocean as fo
from fftocean.view import protocol
from fftocean.view.protocol import Copy, Refusal, SetValues, Verify, parsed

GOOD = [
    ('{"set": {"wind_speed": 12, "seed": 3, "depth": null, "model": "pms"}}', SetValues),
    ('{"verify": {"tick": 4294967295}}', Verify),
    ('{"verify": {"tick": 0, "sea": 4}}', Verify),
    ('{"job": ""}', protocol.JobFile),
    ('{"file": {"name": "a", "base64": "YQ=="}}', protocol.DroppedFile),
    ('{"copy": "job"}', Copy),
    ('{"copy": "command"}', Copy),
    ('{"frame": {"tile": 0, "frame": 5}}', protocol.BakedFrame),
]

BAD = [
    (b"{}", "must be text, got 2 bytes of binary data"),
    ("", "must be JSON"),
    ("{", "must be JSON"),
    ("null", "table with one key, got None"),
    ("[]", "table with one key"),
    ("{}", "table with one key"),
    ('{"set": {"seed": 1}, "copy": "job"}', "table with one key"),
    ('{"eval": "1"}', "must be one of set, verify, job, file, copy, frame, got 'eval'"),
    ('{"set": {"wind_speed": NaN}}', "must be finite, got NaN"),
    ('{"set": {"wind_speed": Infinity}}', "must be finite, got Infinity"),
    ('{"set": {"wind_speed": -Infinity}}', "must be finite, got -Infinity"),
    ('{"set": {"wind_speed": 1e999}}', "wind_speed must be between 0 and 40 m/s, got inf"),
    ('{"set": {"wind_speed": true}}', "wind_speed must be a number .*True"),
    ('{"set": {"wind_speed": "12"}}', "wind_speed must be a number .*'12'"),
    ('{"set": {"wind_speed": [12]}}', "wind_speed must be a number"),
    ('{"set": {"wind_speed": {}}}', "wind_speed must be a number"),
    ('{"set": {"wind_speed": null}}', "wind_speed must be a number"),
    ('{"set": {"wind_speed": -1}}', "wind_speed must be between 0 and 40 m/s, got -1"),
    ('{"set": {"seed": 1.5}}', "seed must be a whole number"),
    ('{"set": {"seed": ' + "9" * 400 + "}}", "seed must be a whole number"),
    ('{"set": {"seed": ' + "9" * 5000 + "}}", "must be JSON"),
    ('{"set": {"model": "__proto__"}}', "model must be one of"),
    ('{"set": {"__proto__": {"x": 1}}}', "set must name parameters of the sea"),
    ('{"set": {"sun_elevation": 3}}', "set must name parameters of the sea"),
    ('{"set": {"wind_speed": 5, "wind_speed": 6}}', "given once, got 'wind_speed' twice"),
    ('{"set": {}}', "set must be a table of values"),
    ('{"set": []}', "set must be a table of values"),
    ('{"set": 3}', "set must be a table of values"),
    ('{"verify": {}}', "verify must be a table of sea, tick"),
    ('{"verify": {"tick": -1}}', "tick must be a whole number between 0"),
    ('{"verify": {"tick": 4294967296}}', "tick must be a whole number between 0"),
    ('{"verify": {"tick": 1.0}}', "tick must be a whole number"),
    ('{"verify": {"tick": true}}', "tick must be a whole number"),
    ('{"verify": {"tick": 1, "sea": "1"}}', "sea must be a whole number"),
    ('{"verify": {"tick": 1, "x": 1}}', "verify must be a table of sea, tick"),
    ('{"job": 3}', "job must be the text of a job file"),
    ('{"file": {"name": "a"}}', "file must be a table of base64, name"),
    ('{"file": {"name": 1, "base64": ""}}', "both text"),
    ('{"file": {"name": "a", "base64": "YQ"}}', "must be base64"),
    ('{"file": {"name": "a", "base64": "Y Q = ="}}', "must be base64"),
    ('{"file": {"name": "a", "base64": "\\u00e9"}}', "must be base64"),
    ('{"copy": "secrets"}', "copy must be job or command"),
    ('{"copy": ["job"]}', "copy must be job or command"),
    ('{"frame": {"tile": 0}}', "frame must be a table of frame, tile"),
    ('{"frame": {"tile": -1, "frame": 0}}', "tile must be a whole number"),
    ("[" * 60000, "at most 8 tables within another|must be JSON"),
    ('{"set":' * 6000 + "1" + "}" * 6000, "at most 8 tables within another|must be JSON"),
    ('{"set": {"seed": ' + "[" * 9 + "]" * 9 + "}}", "at most 8 tables within another"),
    ('{"set": {"seed": "' + "x" * 70000 + '"}}', "at most 65536 bytes"),
]


@pytest.mark.parametrize(("text", "kind"), GOOD)
def test_messages_are_parsed(text, kind):
    assert isinstance(parsed(text), kind)


@pytest.mark.parametrize(("text", "reason"), BAD, ids=lambda v: str(v)[:40])
def test_other_messages_are_refused(text, reason):
    with pytest.raises(Refusal, match=reason) as refused:
        parsed(text)
    assert len(str(refused.value)) < 400


def test_a_refusal_names_the_parameter():
    for text in ('{"set": {"seed": 1, "fetch": -1}}', '{"set": {"fetch": "x"}}'):
        with pytest.raises(Refusal) as refused:
            parsed(text)
        assert refused.value.name == "fetch"
        said = json.loads(protocol.refused(str(refused.value), refused.value.name))
        assert said["refused"]["name"] == "fetch"


def test_bytes_of_a_file_come_whole():
    data = bytes(range(256))
    text = json.dumps({"file": {"name": "n", "base64": base64.b64encode(data).decode()}})
    assert parsed(text).data == data


def test_a_reference_is_a_header_and_eight_fields():
    """Read with struct alone."""
    ocean = fo.Ocean.from_modes(
        [(1, 0, 1.0, 0.3), (2, 3, 0.2, 1.0)],
        n=(16, 8),
        size=(50.0, 40.0),
        loop=8.0,
        dtype="float64",
    )
    frame = ocean.loop_frame(3, 16)
    data = protocol.reference(frame, tick=3, ticks=16, tile=2, sea=9)
    kind, version, length, zero = struct.unpack_from("<4s3I", data)
    assert (kind, version, zero, (16 + length) % 16) == (b"FFTR", 1, 0, 0)
    header = json.loads(data[16 : 16 + length])
    assert {k: header[k] for k in ("tick", "ticks", "tile", "nx", "ny", "sea")} == {
        "tick": 3, "ticks": 16, "tile": 2, "nx": 16, "ny": 8, "sea": 9,
    }  # fmt: skip
    fields = np.frombuffer(data, "<f4", offset=16 + length).reshape(8, 8, 16)
    for name, field in zip(header["fields"], fields, strict=True):
        np.testing.assert_array_equal(field, getattr(frame, name).astype(np.float32))
