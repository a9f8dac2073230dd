"""`fftocean view`: what it is given, what it refuses, what it writes."""

import sys
import threading
from pathlib import Path

import pytest

import fftocean as fo
from fftocean.view import page_files

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "view"))
from serving import write_page


@pytest.fixture
def page(tmp_path_factory, monkeypatch):
    """Take the small page in place of the built one."""
    folder = write_page(tmp_path_factory.mktemp("page"))
    monkeypatch.setattr(page_files, "built_page", lambda: folder)


@pytest.fixture
def served(monkeypatch):
    """Begin to serve and end at once; return the states that were served."""
    states = []

    class AtOnce(threading.Thread):
        """A thread that has ended when it is started."""

        def start(self):
            super().start()
            if self.name != "fftocean-view":
                self.join(20.0)

    monkeypatch.setattr("threading.Thread", AtOnce)

    def serve(server, ready):
        async def once():
            async with server.listening():
                states.append(server._viewer.state)
                ready(server.address)
            return 2

        return once()

    monkeypatch.setattr("fftocean.view.server.serve_until_stopped", serve)
    return states


pytestmark = pytest.mark.usefixtures("page")


def test_the_address_is_printed_and_the_browser_opened(run, served, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or True)
    code, out, err = run("view", "--tiles", "16:200")
    assert code == 0
    assert out.startswith("live page: http://127.0.0.1:")
    assert opened == [out.split()[-1]]
    assert err == "press Ctrl-C to stop\n"
    assert served[0].tiles == ((16, 200.0),)


def test_no_browser_is_opened_on_request(run, served, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda _: pytest.fail("opened"))
    assert run("view", "--tiles", "16:200", "--no-browser")[0] == 0
    assert len(served) == 1


def test_a_missing_browser_is_told(run, served, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda _: False)
    code, _, err = run("view", "--tiles", "16:200")
    assert (code, len(served)) == (0, 1)
    assert "no browser could be opened" in err


def test_a_job_is_shown(run, served):
    Path("gale.toml").write_text("[sea.wind]\nspeed = 20.0\n[ocean]\nn = 32\nsize = 400.0\n")
    assert run("view", "gale.toml", "--no-browser")[0] == 0
    assert served[0].values["wind_speed"] == 20.0
    assert (served[0].tiles, served[0].source) == (((32, 400.0),), "gale.toml")
    assert run("view", "gale.toml", "--no-browser", "--n", "16")[0] == 0
    assert served[1].tiles == ((16, 400.0),)


def test_a_measured_spectrum_is_shown(run, served):
    file = Path(__file__).parents[1] / "data" / "spectra" / "swanfile.spec"
    assert run("view", file, "--no-browser", "--n", "16")[0] == 0
    assert served[0].sea().hs == pytest.approx(fo.Sea.from_spectrum(fo.readers.open(file)).hs)
    assert str(file) in served[0].toml()


def test_a_bake_is_played(run, served, baked):
    assert run("view", baked, "--no-browser")[0] == 0
    assert served == [None]


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (["--n", "100"], 2, "n must be a power of two on a page, got 100; the next is 128"),
        (["--n", "4096"], 2, "n must be a power of two from 8 to 1024 on a page, got 4096"),
        (["--tiles", "96:500"], 2, "the samples of a tile must be a power of two on a page"),
        (["--tiles", "16:9,16:99"], 2, "tiles must go from the largest to the smallest"),
        (["--tiles", "16:500", "--n", "16"], 2, "--n and --tiles must not be given together"),
        (["--tiles", ",".join(["16:9"] * 5)], 2, "tiles must be at most 4, got 5"),
        (["--port", "70000"], 2, "port must be a whole number between 0 and 65535, got 70000"),
        (["missing.toml"], 2, "missing.toml must be a TOML file, and does not exist"),
        (["empty"], 5, "manifest.json"),
        (["bad.spec"], 3, "bad.spec must be wave spectra in a known format"),
        (["odd.toml"], 2, "ocean.n must be a power of two on a page, got 100; the next is 128"),
        (["--static", ""], 2, "--static must be a file or a folder"),
        (["empty", "--static", "x.html"], 2, "--static must be given for a sea, not for a bake"),
        (["--static", "no/such/sea.html"], 4, "no/such/sea.html could not be written"),
        (["deep.toml"], 2, "wind"),
    ],
)
def test_bad_input_is_refused(run, served, arguments, code, says):
    Path("empty").mkdir()
    Path("bad.spec").write_text("hello\n")
    Path("odd.toml").write_text("[ocean]\nn = 100\n")
    Path("deep.toml").write_text("[sea.wind]\nspeed = nan\n")
    before = sorted(Path().rglob("*"))
    got, out, err = run("view", *arguments, "--no-browser")
    assert (got, out, served) == (code, "", [])
    assert says in err
    assert len(err.splitlines()) == 1
    assert sorted(Path().rglob("*")) == before


def test_a_port_that_is_taken_is_told(run, monkeypatch):
    import socket

    monkeypatch.setattr("webbrowser.open", lambda _: True)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        code, out, err = run("view", "--tiles", "16:200", "--port", port)
    assert (code, out) == (4, "")
    assert err.startswith(f"fftocean: port {port} of 127.0.0.1 cannot be had: ")


def test_a_missing_package_is_told_with_the_command(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "websockets", None)
    monkeypatch.setitem(sys.modules, "websockets.asyncio.server", None)
    code, out, err = run("view")
    assert (code, out) == (2, "")
    assert "needs the package websockets 15 or later: pip install websockets" in err


def test_a_page_that_is_not_built_is_told(run, monkeypatch, tmp_path):
    monkeypatch.setattr(page_files, "built_page", lambda: tmp_path)
    code, _, err = run("view", "--no-browser")
    assert code == 4
    assert "build it: npm ci && npm run build" in err


def test_a_static_page_needs_no_websockets(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "websockets", None)
    code, out, _ = run("view", "--tiles", "16:200", "--static", "sea.html")
    assert code == 0
    size = Path("sea.html").stat().st_size
    assert out == f"{size / 1e3:.0f} kB: sea.html\n"


def test_a_static_folder_has_page_and_package(run):
    assert run("view", "--tiles", "16:200", "--static", "site/")[0] == 0
    assert Path("site/index.html").is_file()
    assert run("check", "site/sea")[0] == 0
    code, out, _ = run("check", "site")
    assert code == 5
    assert "this is no bake; check the folder in it: sea" in " ".join(out.split())
    code, _, err = run("view", "site/sea", "--no-browser")
    assert code == 2
    assert "is a run-time package, which has waves and no frames to play" in err
    Path("other").mkdir()
    assert run("view", "--tiles", "16:200", "--static", "other")[0] == 0
    assert Path("other/index.html").is_file()
