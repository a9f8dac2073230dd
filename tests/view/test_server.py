"""The socket with real clients: values, seas, references, limits."""

import asyncio
import base64
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from contextlib import ExitStack, suppress
from pathlib import Path

import numpy as np
import pytest
from serving import Running, opened, sea_viewer, small_state
from websockets.exceptions import ConnectionClosed

import fftocean as fo
from fftocean.errors import JobError
from fftocean.view.client import MOST_ANSWERS, MOST_FRAMES, Client
from fftocean.view.playback import open_bake
from fftocean.view.protocol import BakedFrame, Verify
from fftocean.view.server import MOST_BAD, MOST_CLIENTS, MOST_UNFINISHED, WRITE_LIMIT
from fftocean.view.viewer import Viewer, _dropped_job, safe_name, shown_name

REFERENCES = (
    "displace_x", "displace_y", "height", "stretch_xy", "slope_x", "slope_y", "stretch_xx",
    "stretch_yy",
)  # fmt: skip


def test_a_new_client_gets_the_state_and_the_sea(running):
    with running.connect() as client:
        first = client.next("state")
        assert first["state"] == small_state().plain()
        assert first["source"] == "wind sea and swell"
        header, body = client.exact()
        assert header["format"] == "fftocean-runtime"
        assert header["tiles"][0]["n"] == [16, 16]
        assert len(body) == sum(-(-file["bytes"] // 16) * 16 for file in header["files"])
        assert header["job"] == small_state().toml()
        json.dumps(header, allow_nan=False)


def test_a_value_changes_the_sea_of_every_client(running):
    with running.connect() as one, running.connect() as other:
        before, _ = one.exact()
        other.exact()
        one.send({"set": {"wind_speed": 6.5, "wind_direction": 200}})
        for client in (one, other):
            after, _ = client.exact(wind_speed=6.5, wind_direction=200.0)
            assert after["id"] > before["id"]
            assert after["statistics"]["specified"]["hs"] < before["statistics"]["specified"]["hs"]


def test_another_client_is_answered_while_one_floods_the_server(page, monkeypatch):
    """The flood ends with a value of its own; few of its 5,000 values are ever looked at."""
    from fftocean.view.state import State

    looked_at, changed = [], State.changed

    def counted(state, changes):
        looked_at.append(changes)
        return changed(state, changes)

    with Running(sea_viewer(), page) as running, running.connect() as flood:
        flood.exact()
        monkeypatch.setattr(State, "changed", counted)
        for i in range(5000):
            flood.send({"set": {"wind_speed": 5.0 + i % 7}})
        flood.send({"set": {"wind_speed": 4.5}})
        with running.connect() as other:
            assert other.next("state")["state"]["seed"] == small_state().values["seed"]
            other.send({"copy": "job"})
            assert other.next("copied")["copied"]["what"] == "job"
            other.exact(wind_speed=4.5)
    assert len(looked_at) < 2500


def test_a_lost_client_finds_its_state_again(running):
    with running.connect() as client:
        client.exact()
        client.send({"set": {"seed": 21}})
        client.exact(seed=21)
    with running.connect() as client:
        assert client.next("state")["state"]["seed"] == 21


@pytest.mark.parametrize(
    "message",
    [
        '{"set": {"wind_speed": 12, "fetch": NaN}}',
        '{"set": {"wind_speed": 12, "seed": -1}}',
        '{"set": {"wind_speed": 12, "tiles": 3}}',  # one tile was given
        '{"set": {"wind_speed": 12, "nothing": 1}}',
        '{"job": "[sea.wind]\\nspeed = -3"}',
        '{"job": "[[sea.systems]]\\nmeasured = { file = \\"/etc/passwd\\" }"}',
        '{"job": "[ocean]\\nn = 100"}',
        '{"file": {"name": "x.toml", "base64": "/w=="}}',
        '{"file": {"name": "buoy.spec", "base64": "aGVsbG8="}}',
        '{"frame": {"tile": 0, "frame": 0}}',
        b"\x00\x01",
    ],
)
def test_a_refusal_changes_nothing_and_says_why(shared, message):
    with shared.connect() as client:
        before = client.next("state")["state"]
        client.send(message)
        said = client.next("refused")["refused"]["message"]
        assert " must " in said
        assert "root:" not in said
    with shared.connect() as client:
        assert client.next("state")["state"] == before


def refusal_of_file(client, name, data):
    """Return the message by which a dropped file is refused."""
    client.send({"file": {"name": name, "base64": base64.b64encode(data).decode()}})
    return client.next("refused")["refused"]["message"]


def test_a_dropped_file_is_refused_in_plain_words(shared):
    spectra = Path(__file__).parents[1] / "data" / "spectra"
    with shared.connect() as client:
        said = refusal_of_file(client, "x y.spec", b"hello")
        assert said.startswith("x y.spec must be wave spectra in a known format")
        for data in (b"CDF\x01", b"CDF\x01" + bytes(4), b"CDF\x02" + bytes(11)):
            said = refusal_of_file(client, "short.nc", data)
            assert said.startswith("short.nc ")
            assert said.count("short.nc") == 1
            assert "Error" not in said
            assert "mmap" not in said
        data = (spectra / "44004w2000.txt").read_bytes()
        said = refusal_of_file(client, "buoy.txt", data)
        assert said.startswith("buoy.txt: the file has no directions; ")
        assert "spreading = { kind = 'blend' }; start `fftocean view` with such a job" in said


def test_a_sea_that_cannot_be_made_is_refused_and_the_one_before_stays(page):
    """Capillary waves have so many cycles in a long loop that a record cannot hold them."""
    state = small_state().changed({"swell_speed": 0.0})
    job = fo.Job.from_toml(state.toml()).replaced({"ocean.size": 0.02, "sea.surface_tension": 0.07})
    from fftocean.view.state import State

    with Running(Viewer(State.of_job(job)), page) as running, running.connect() as client:
        client.exact()
        client.send({"set": {"loop": 600.0}})
        said = client.next("refused")["refused"]["message"]
        assert "cycles" in said or "loop" in said
        assert client.next("state", lambda tree: not tree["busy"])["state"]["loop"] == 64.0


@pytest.mark.parametrize("tick", [0, 1, 12345, 2**20 - 1, 2**20])
def test_references_are_the_direct_sum(shared, tick):
    """Every field of the job's own tile, summed wave by wave in float64, rounded to float32."""
    with shared.connect() as client:
        header, _ = client.exact()
        assert header["ticks"] == 2**20
        client.send({"verify": {"tick": tick, "sea": header["id"]}})
        answer, body = client.next("FFTR")
    assert answer["sea"] == header["id"]
    assert (answer["tick"], answer["ticks"], answer["tile"]) == (tick, 2**20, 0)
    assert answer["fields"] == list(REFERENCES)
    fields = np.frombuffer(body, "<f4").reshape(8, answer["ny"], answer["nx"])
    ocean = fo.Job.from_toml(header["job"]).ocean(dtype="float64")
    x, y = np.meshgrid(np.arange(16) * 200.0 / 16, np.arange(16) * 200.0 / 16)
    surface = fo.gerstner.surface(ocean, x, y, 64.0 * tick / 2**20)
    for name, field in zip(REFERENCES, fields, strict=True):
        direct = getattr(surface, name)
        # half a unit of the last place of float32, at the largest value
        np.testing.assert_allclose(field, direct, rtol=0.0, atol=6e-8 * np.abs(direct).max())


def test_the_last_two_exact_seas_can_be_verified(running):
    with running.connect() as client:
        numbers = [client.exact()[0]["id"]]
        for seed in (1, 2):
            client.send({"set": {"seed": seed}})
            numbers.append(client.exact(seed=seed)[0]["id"])
        for number in numbers[1:]:
            client.send({"verify": {"tick": 7, "sea": number}})
            assert client.next("FFTR")[0]["sea"] == number
        client.send({"verify": {"tick": 7}})
        assert client.next("FFTR")[0]["sea"] == numbers[-1]
        client.send({"verify": {"tick": 7, "sea": numbers[0]}})
        assert "kept" in client.next("refused")["refused"]["message"]


def test_every_tile_has_its_reference(page):
    with Running(sea_viewer(), page) as running, running.connect() as client:
        client.exact()
        client.send({"job": "[ocean]\nn = 16\nsize = 200.0\n"})
        client.send({"set": {"tiles": 2}})
        client.exact(tiles=2)
        client.send({"verify": {"tick": 3}})
        assert [client.next("FFTR")[0]["tile"] for _ in range(2)] == [0, 1]


def test_a_tick_beyond_the_loop_is_refused(shared):
    with shared.connect() as client:
        client.exact()
        client.send({"verify": {"tick": 2**20 + 1}})
        said = client.next("refused")["refused"]["message"]
        assert said == f"tick must be at most {2**20}, the ticks of the loop, got {2**20 + 1}"


def test_job_and_command_are_copied(shared):
    with shared.connect() as client:
        client.send({"copy": "job"})
        assert client.next("copied")["copied"] == {"what": "job", "text": small_state().toml()}
        client.send({"copy": "command"})
        copied = client.next("copied")["copied"]
        assert copied == {"what": "command", "text": small_state().command()}


def test_a_dropped_job_is_shown(running):
    text = "[sea.wind]\nspeed = 8.5\n[ocean]\nn = 32\nsize = 150.0\n"
    with running.connect() as client:
        client.exact()
        data = base64.b64encode(text.encode()).decode()
        client.send({"file": {"name": "C:\\seas\\../gale <b>.toml", "base64": data}})
        header, _ = client.exact(wind_speed=8.5)
        assert header["tiles"][0]["n"] == [32, 32]
        client.send({"copy": "job"})
        job = fo.Job.from_toml(client.next("copied")["copied"]["text"])
        assert job.settings["sea.wind.speed"] == 8.5
    with running.connect() as client:
        assert client.next("state")["source"] == "gale <b>.toml"


def buoy():
    """Return a measured spectrum in one file, which fits in a message."""
    return Path(__file__).parents[1] / "data" / "spectra" / "swanfile.spec"


def test_a_dropped_spectrum_is_shown(running):
    file = buoy()
    data = base64.b64encode(file.read_bytes()).decode()
    with running.connect() as client:
        client.exact()
        client.send({"file": {"name": f"../../{file.name}", "base64": data}})
        header, _ = client.exact(wind_speed=0.0)
        sea = fo.Sea.from_spectrum(fo.readers.open(file))
        specified = header["statistics"]["specified"]
        assert specified["hs"] == pytest.approx(sea.hs, rel=1e-6)
    with running.connect() as client:
        assert client.next("state")["source"] == file.name


def test_dropped_files_are_removed_at_the_end(page, monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    file = buoy()
    data = base64.b64encode(file.read_bytes()).decode()
    with Running(sea_viewer(), page) as running, running.connect() as client:
        client.exact()
        client.send({"file": {"name": file.name, "base64": data}})
        client.exact(wind_speed=0.0)
        (spool,) = tmp_path.iterdir()
        assert spool.stat().st_mode & 0o077 == 0
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "shown", "safe"),
    [
        ("buoy.spec", "buoy.spec", "buoy.spec"),
        ("../../etc/passwd", "passwd", "passwd"),
        ("C:\\x\\sea.nc", "sea.nc", "sea.nc"),
        ("..", "..", "spectrum_"),
        ("", "the file", "spectrum_"),
        (".hidden", ".hidden", "hidden"),
        ("a\nb\x1b[31m.spec", "a?b?[31m.spec", "a_b__31m.spec"),
        ("CON.spec", "CON.spec", "spectrum_CON.spec"),
        ("-rf", "-rf", "rf"),
        ("x" * 300, "x" * 80, "x" * 80),
        ("\u202egnp.exe", "?gnp.exe", "_gnp.exe"),
    ],
)
def test_names_of_dropped_files(name, shown, safe):
    assert (shown_name(name), safe_name(name)) == (shown, safe)


def test_a_dropped_job_names_no_file_of_this_machine():
    """The page of another user, or a file from elsewhere, does not read what is here."""
    text = '[[sea.systems]]\nmeasured = "/etc/passwd"\n'
    with pytest.raises(JobError, match=r"sea\.systems\[0\]\.measured must not be in a job that is"):
        _dropped_job(text, "a.toml")
    assert _dropped_job("[ocean]\nn = 16\n", "a.toml").settings["ocean.n"] == 16


def test_twenty_bad_messages_close_the_socket(running):
    with running.connect() as other:
        other.exact()
        with running.connect() as client:
            for _ in range(MOST_BAD):
                client.send("no")
            assert client.closed().rcvd.code == 1008
        other.send({"set": {"seed": 3}})
        other.exact(seed=3)


def test_a_message_of_a_mebibyte_closes_the_socket(running):
    with running.connect() as client:
        with suppress(ConnectionClosed):
            client.send('{"job": "' + "x" * 2**20 + '"}')
        closed = client.closed()
        assert closed.rcvd is None or closed.rcvd.code == 1009
    assert running.request("/")[0] == 200


def test_the_seventeenth_client_is_refused(running):
    with ExitStack() as stack:
        clients = [stack.enter_context(running.connect()) for _ in range(MOST_CLIENTS)]
        for client in clients:
            client.next("state")
        status, _, body = running.handshake()
        assert (status, body) == (503, b"there are 16 viewers already\n")
    deadline = time.monotonic() + 20.0
    while running.viewer.clients and time.monotonic() < deadline:
        time.sleep(0.01)
    with running.connect() as client:
        client.next("state")


def test_the_oldest_of_many_silent_connections_are_given_up(running):
    """The server keeps account of so many and no more, and answers those that speak."""
    with ExitStack() as idle:
        for _ in range(MOST_UNFINISHED + 20):
            idle.enter_context(socket.create_connection(("127.0.0.1", running.port), timeout=60.0))
        assert running.request("/")[0] == 200
        assert len(running._server._unfinished) <= MOST_UNFINISHED


@pytest.mark.slow
def test_five_hundred_connections_that_say_nothing(running):
    idle = []
    try:
        for i in range(500):
            idle.append(socket.create_connection(("127.0.0.1", running.port), timeout=20.0))
            idle[-1].sendall(b"GET / HTTP/1.1\r\n" if i % 2 else b"")
        assert running.request("/")[0] == 200
        with running.connect() as client:
            client.exact()
            client.send({"set": {"seed": 9}})
            client.exact(seed=9)
    finally:
        for one in idle:
            one.close()


@pytest.mark.slow
def test_a_client_that_never_reads_holds_little_while_others_are_served(running):
    """
    5,000 changes: for it wait one message in the socket's buffer, and one of each kind behind it.
    """
    with running.connect() as reader:
        reader.exact()
        lazy = socket.socket()
        lazy.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        lazy.connect(("127.0.0.1", running.port))
        lazy.sendall(
            (
                f"GET /socket HTTP/1.1\r\nHost: {running.host}\r\nOrigin: http://{running.host}\r\n"
                f"Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                f"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                f"Sec-WebSocket-Protocol: fftocean.{running.token}\r\n\r\n"
            ).encode()
        )
        largest = 0
        for i in range(5000):
            reader.send({"set": {"choppiness": (i % 200) / 100}})
            if i % 500 == 499:  # read what came, as a page does
                header, _ = reader.next("FFTO")
                largest = max(largest, 16 + len(json.dumps(header)) + 2**14)
        reader.exact(choppiness=199 / 100)
        waiting = [
            client.waiting + client.socket.transport.get_write_buffer_size()
            for client in running.viewer.clients
        ]
        assert len(waiting) == 2
        # a message is handed on when the buffer holds less than its limit
        assert max(waiting) <= WRITE_LIMIT + 4 * largest
        lazy.close()


class NeverRead:
    """A socket that takes no message."""

    async def send(self, _message):
        await asyncio.Event().wait()


def test_what_waits_for_a_client_that_never_reads_is_bounded():
    """Of the answers the last few, of states and seas the newest, of requests a few."""

    async def flood():
        client = Client(NeverRead(), None)
        sending = asyncio.create_task(client.pump())
        for i in range(10 * MOST_ANSWERS):
            client.tell(f"{i:05}")
            client.offer("state", "s" * 100)
            client.offer("sea", b"x" * 10_000)
            client.ask(Verify(i, None))
            client.ask(BakedFrame(0, i))
            await asyncio.sleep(0)
        sending.cancel()
        return client

    client = asyncio.run(flood())
    assert client.waiting <= MOST_ANSWERS * 5 + 100 + 10_000
    assert client.requests <= 1 + MOST_FRAMES


def start(page, *arguments):
    """Start the command in a process; return it and the address of the page."""
    code = (
        "import sys, pathlib; from fftocean.view import page_files; "
        f"page_files.built_page = lambda: pathlib.Path({str(page)!r}); "
        "from fftocean.cli import main; sys.exit(main(sys.argv[1:]))"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code, "view", "--no-browser", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    line = process.stdout.readline()
    assert line.startswith("live page: http://127.0.0.1:"), line + process.stderr.read()
    return process, line.split()[-1]


@pytest.mark.slow
@pytest.mark.process
@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 0), (signal.SIGTERM, 143)])
def test_a_signal_ends_the_server(page, number, code):
    """
    With a client that never reads, a half request, and a sea in the making: within the 2 s that
    the time-outs add up to, and some more for a loaded machine.
    """
    process, address = start(page, "--n", "256")
    host, port = address.split("/")[2].split(":")
    token = address.split("#")[1]
    half = socket.create_connection((host, int(port)))
    half.sendall(b"GET / HTTP/1.1\r\n")
    lazy = socket.create_connection((host, int(port)))
    lazy.sendall(
        (
            f"GET /socket HTTP/1.1\r\nHost: {host}:{port}\r\nOrigin: http://{host}:{port}\r\n"
            "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
            f"Sec-WebSocket-Protocol: fftocean.{token}\r\n\r\n"
        ).encode()
    )
    assert lazy.recv(12) == b"HTTP/1.1 101"
    began = time.monotonic()
    process.send_signal(number)
    out, err = process.communicate(timeout=30.0)
    assert time.monotonic() - began < 10.0
    assert process.returncode == code
    assert out == ""
    assert "Traceback" not in err
    assert err == "press Ctrl-C to stop\n"
    half.close()
    lazy.close()


def test_opened_reads_what_the_server_sends(shared):
    """The reader of the tests refuses what is no message."""
    with pytest.raises(AssertionError):
        opened(b"FFTO" + bytes([2]) + bytes(40))
    assert shared.request("/")[0] == 200


def test_a_slider_gets_moving_seas_and_then_the_exact_one(running):
    """The moving sea has nearly the waves of the exact one: the phases, and the heights to 1 %."""
    with running.connect() as client:
        client.exact()
        client.send({"set": {"wind_speed": 8.0}})
        moving, waves = client.next("FFTO")
        assert (moving["quality"], moving["files"][0]["name"]) == ("moving", "tile0.waves")
        exact, exact_waves = client.exact(wind_speed=8.0)
        assert exact["id"] > moving["id"]
    record = np.dtype("<i2, <i2, <u2, <f4, <f4")
    found = [
        np.frombuffer(data[: header["files"][0]["bytes"]], record)
        for header, data in ((moving, waves), (exact, exact_waves))
    ]
    one, other = (
        {(w["f0"].item(), w["f1"].item()): complex(w["f3"], w["f4"]) for w in table}
        for table in found
    )
    keys = one.keys() & other.keys()
    a, b = (np.array([table[key] for key in sorted(keys)]) for table in (one, other))
    assert np.abs(np.angle(a / b)).max() < 1e-5
    assert np.sqrt(np.sum(np.abs(a - b) ** 2) / np.sum(np.abs(b) ** 2)) < 0.01
    missed = [abs(table[key]) for table in (one, other) for key in table.keys() - keys]
    assert sum(missed) < 1e-6 * np.abs(b).sum()


def test_a_moving_sea_is_not_verified(running):
    with running.connect() as client:
        first, _ = client.exact()
        client.send({"set": {"wind_speed": 8.0}})
        moving, _ = client.next("FFTO")
        client.send({"verify": {"tick": 1, "sea": moving["id"]}})
        assert "exact sea that is kept" in client.next("refused")["refused"]["message"]
        del first


def test_choppiness_uses_the_waves_again(running):
    with running.connect() as client:
        before, waves = client.exact()
        client.send({"set": {"choppiness": 0.25}})
        after, same = client.exact(choppiness=0.25)
    assert (before["choppiness"], after["choppiness"]) == (1.0, 0.25)
    size = before["files"][0]["bytes"]
    assert waves[:size] == same[:size]


def test_a_few_wave_model_comes_with_the_sea(running):
    with running.connect() as client:
        assert client.exact()[0]["few_waves"] is None
        for model in ("pms", "cwr", "slides", "steepness"):
            client.send({"set": {"model": model}})
            few = client.exact(model=model)[0]["few_waves"]
            assert few["model"] == model
            assert 1 <= len(few["amplitude"]) <= 64
        client.send({"set": {"model": "fft"}})
        assert client.exact(model="fft")[0]["few_waves"] is None


@pytest.fixture(scope="module")
def baked(tmp_path_factory):
    """Bake a small job."""
    folder = tmp_path_factory.mktemp("bake") / "sea"
    job = fo.Job.default().replaced(
        {"ocean.n": 16, "bake.frames": 12, "bake.maps": ["displacement"], "bake.pictures": []}
    )
    fo.bake(job, folder, executor="serial")
    return folder


@pytest.mark.parametrize(
    ("message", "said"),
    [
        ({"copy": "job"}, "a bake has no job to copy; its manifest holds the job"),
        ({"set": {"seed": 1}}, "a bake is played as it was baked; its values cannot be changed"),
        ({"verify": {"tick": 0}}, "a bake cannot be verified on the page; `fftocean check` "),
        ({"job": ""}, "a job cannot be dropped on a bake; start `fftocean view` without one"),
        ({"file": {"name": "x", "base64": ""}}, "a file cannot be dropped on a bake; "),
    ],
)
def test_what_is_for_a_sea_is_refused_in_plain_words_by_a_bake(page, baked, message, said):
    viewer = Viewer(bake=open_bake(baked), source="sea")
    with Running(viewer, page) as running, running.connect() as client:
        client.send(message)
        assert client.next("refused")["refused"]["message"].startswith(said)


def test_a_bake_is_played(page, baked):
    viewer = Viewer(bake=open_bake(baked), source="sea")
    with Running(viewer, page) as running, running.connect() as client:
        manifest = client.next("bake")
        assert manifest["source"] == "sea"
        assert (manifest["bake"]["frames"], manifest["bake"]["tiles"][0]["n"]) == (12, [16, 16])
        for i in range(4):
            client.send({"frame": {"tile": 0, "frame": i}})
        found = [client.next("FFTB") for _ in range(4)]
        assert [header["frame"] for header, _ in found] == [0, 1, 2, 3]
        assert {len(body) for _, body in found} == {3 * 16 * 16 * 4 * 2}
        client.send({"frame": {"tile": 1, "frame": 0}})
        assert " must " in client.next("refused")["refused"]["message"]


def test_a_damaged_frame_is_told_and_the_others_are_played(page, baked, tmp_path):
    folder = tmp_path / "damaged"
    shutil.copytree(baked, folder)
    file = sorted((folder / "displacement").iterdir())[2]
    file.write_bytes(file.read_bytes()[:-1])
    viewer = Viewer(bake=open_bake(folder), source="sea")
    with Running(viewer, page) as running, running.connect() as client:
        client.send({"frame": {"tile": 0, "frame": 2}})
        assert file.name in client.next("refused")["refused"]["message"]
        client.send({"frame": {"tile": 0, "frame": 1}})
        assert client.next("FFTB")[0]["frame"] == 1


def test_messages_of_one_client_do_not_keep_the_others_waiting(running):
    """Of 300 changes that come at once, another client sees many, not just the last."""
    with running.connect() as busy, running.connect() as other:
        busy.exact()
        other.exact()
        for i in range(300):
            busy.send({"set": {"choppiness": i / 300}})
            busy.send({"copy": "job"})  # between two values, so that both are carried out
        seen = 0
        while other.next("state")["state"]["choppiness"] != 299 / 300:
            seen += 1
        assert seen > 20
