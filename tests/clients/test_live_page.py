"""
The live page with its real server in headless Chromium: keys, controls, refusals, reconnection,
verification, a lost graphics context, dropped files, the static page, and access without mouse or
sight. The server's state is read by a client of its own.
"""

import base64
import contextlib
import io
import json
import re
import signal
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT, require
from PIL import Image

from fftocean.view.page_files import PARTS, TYPES

pytest.importorskip("websockets")
from websockets.sync.client import connect  # after the skip

pytestmark = pytest.mark.client

PAGE = ROOT / "fftocean" / "view" / "page"
SPECTRA = ROOT / "tests" / "data" / "spectra"
TILES = "64:300,64:40"
SMALL = {"width": 320, "height": 240, "reducedMotion": True}

# pixels of the picture at the page's moment, as a short text
PICTURE = """fftocean.still().then(async (blob) => {
  const bytes = await crypto.subtle.digest('SHA-256', await blob.arrayBuffer());
  return [...new Uint8Array(bytes).slice(0, 12)].join(' ');
})"""
SETTLED = "globalThis.fftocean?.settled"


class Server:
    """`fftocean view` as a process, and a client beside the page that reads its state."""

    def __init__(self, *arguments):
        command = [sys.executable, "-m", "fftocean", "view", "--no-browser", *arguments]
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        line = self._process.stdout.readline()
        self.address = re.search(r"http://\S+", line)[0]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.send_signal(signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(30)
        self._process.kill()
        self._process.wait()
        self._process.stdout.close()

    def state(self):
        """Return the values and the rest of the state, as a new client hears them."""
        site, token = self.address.split("/#")
        with connect(
            site.replace("http", "ws") + "/socket",
            origin=site,
            subprotocols=[f"fftocean.{token}"],
            max_size=None,
            proxy=None,
        ) as socket:
            while True:
                message = socket.recv(timeout=60.0)
                if isinstance(message, str) and "state" in (tree := json.loads(message)):
                    return tree


@pytest.fixture(scope="module")
def server():
    """Start one server for the tests that put its state back, or need none of its own."""
    require((PAGE / "page.js").is_file(), "the live page is not built (npm run build)")
    with Server("--tiles", TILES) as started:
        yield started


# Everything that is the page's own, as it was at the beginning.
AT_REST = """(() => {
  const { camera, clock, layout, table } = fftocean;
  document.documentElement.style.fontSize = '';
  for (const name of ['figures', 'controls']) layout.toggle(name, false);
  for (const dialog of [layout.help, layout.text]) dialog?.node.close();
  for (const group of document.querySelectorAll('details')) group.open = true;
  layout.toasts.replaceChildren();
  layout.showBanner('');
  const local = table.parameters.filter((row) => row.local);
  fftocean.change(Object.fromEntries(local.map((row) => [row.name, row.default])));
  Object.assign(camera, { east: 0, north: 0, yaw: 60, pitch: -6 });
  fftocean.held.clear();
  fftocean.refusal = fftocean.copied = fftocean.verdict = null;
  document.activeElement.blur();
  clock.tick = 0;
  if (!clock.paused) fftocean.pause(true);
  fftocean.changed();
})()"""


@pytest.fixture(scope="module")
def one_page(browser, server):
    """Open the page small and still, for all tests that leave the server as it was."""
    with browser.page(server.address, **SMALL) as opened:
        opened.until(f"{SETTLED} && fftocean.frames > 0 && fftocean.whole")
        yield opened


@pytest.fixture
def page(one_page):
    """Return the page at rest; afterwards, it has said nothing on the console."""
    one_page.do({"size": [SMALL["width"], SMALL["height"]]}, {"evaluate": AT_REST})
    one_page.until(SETTLED)
    yield one_page
    assert one_page.log == []
    assert one_page.evaluate("fftocean.glError") == 0


def value(page, name):
    """Return a value as the page shows it."""
    return page.evaluate(f"fftocean.values.{name}")


def settle(page):
    """Wait until the picture shows the newest sea."""
    page.until(SETTLED)


# --- The picture -------------------------------------------------------------------------------


def test_the_page_asks_for_its_own_files_alone(server, page):
    """Nothing comes from elsewhere, and what comes is the closed list."""
    site = server.address.split("/#")[0]
    paths = {re.sub(r"^(http|ws)://[^/]+", "", url).split("#")[0] for url in page.requests}
    assert all(url.startswith((site, site.replace("http", "ws"))) for url in page.requests)
    assert paths <= {"/", "/parameters.json", "/socket", *(f"/{name}" for name in TYPES)}
    assert server.address.split("#")[1] not in "".join(url.split("#")[0] for url in page.requests)


def test_the_core_alone_shows_the_sea(browser, server):
    """With all parts of the page empty, even its interface, the sea is there."""
    parts = "|".join(name.removesuffix(".js") for name in PARTS)
    options = {**SMALL, "empty": f"/(?:{parts})\\.js$"}
    with browser.page(server.address, **options) as page:
        page.until("document.querySelector('canvas.sea')?.width !== 300")  # of a canvas not drawn
        page.until(
            "document.querySelector('.without-scripts')"
        )  # what says that the rest is missing
        image = Image.open(io.BytesIO(page.screenshot())).convert("L")
        sky, water = (np.asarray(image.crop((0, top, 320, top + 60))) for top in (10, 100))
        assert sky.mean() > water.mean() + 20
        assert np.abs(np.diff(water.astype(float), axis=1)).mean() > 1.0  # waves
        scripts = {url.rsplit("/", 1)[1] for url in page.requests if url.endswith(".js")}
        assert scripts - set(PARTS) == {"page.js", "core.js"}


def test_short_names_are_none_of_the_browser_s(page):
    """No property that becomes short in the bundle, and no constant, is another in the browser."""
    web = PAGE.parent / "web"
    short = json.loads((web / "short_names.json").read_text())["properties"]
    clash = page.evaluate(
        f"""(() => {{
          const seen = new Set(), names = new Set();
          const visit = (one, depth) => {{
            if (one === null || !['object', 'function'].includes(typeof one)) return;
            if (seen.has(one) || depth > 5) return;
            seen.add(one);
            for (const [name, about] of Object.entries(Object.getOwnPropertyDescriptors(one))) {{
              names.add(name);
              if ('value' in about) visit(about.value, depth + 1);
            }}
            visit(Object.getPrototypeOf(one), depth + 1);
          }};
          for (const name of Object.getOwnPropertyNames(globalThis)) {{
            if (name !== 'fftocean' && /^[A-Z]/.test(name)) visit(globalThis[name], 0);
          }}
          return {json.dumps(short)}.filter((name) => names.has(name));
        }})()"""
    )
    assert clash == []
    constants = json.loads((web / "gl_constants.json").read_text())
    known = page.evaluate(
        f"{json.dumps([*constants])}.map((name) => [name, WebGL2RenderingContext[name]])"
    )
    assert dict(known) == constants


def test_a_still_picture_stays_and_a_moving_one_changes(page):
    """Paused, two screenshots are the same bytes; running, the sea and its picture move."""
    assert page.evaluate("fftocean.clock.paused")
    page.evaluate("fftocean.layout.toggle('figures', false)")
    first, picture = page.screenshot(), page.evaluate(PICTURE)
    tick = page.evaluate("fftocean.clock.tick")
    assert page.screenshot() == first
    page.press(" ")
    page.until(f"fftocean.clock.tick !== {tick}")
    frames = page.evaluate("fftocean.frames")
    page.until(f"fftocean.frames > {frames}")
    page.press(" ")
    assert page.evaluate(PICTURE) != picture
    settle(page)
    moved = page.screenshot()
    assert moved != first
    assert page.screenshot() == moved


def test_reduced_motion_begins_still_and_others_begin_to_move(browser, server):
    """The wish of the system decides how the page begins."""
    with browser.page(server.address, **{**SMALL, "reducedMotion": False}) as moving:
        moving.until("globalThis.fftocean?.frames > 1")
        assert not moving.evaluate("fftocean.clock.paused")
    with browser.page(server.address, **SMALL) as still:
        still.until(f"{SETTLED} && fftocean.frames > 0")
        assert still.evaluate("fftocean.clock.paused")
        assert still.evaluate("fftocean.clock.tick") == 0


def test_verify_compares_every_field_of_every_tile(page):
    """
    The page's float32 fields are those of the library within 5e-7 (24 roundings of 6e-8 along a
    transform of 64 samples and its inputs, in the mean square).
    """
    page.evaluate("fftocean.clock.tick = 12345")
    page.evaluate("fftocean.verify()")
    verdict = page.evaluate("fftocean.verdict")
    assert {row["tile"] for row in verdict["rows"]} == {0, 1}
    assert len(verdict["rows"]) == 16
    assert all(0.0 < row["error"] <= 5e-7 for row in verdict["rows"])
    assert verdict["passed"]
    assert "Verified" in page.evaluate("document.querySelector('.verdict').textContent")
    # and it would see a wrong sea
    page.evaluate("globalThis.size = fftocean.stage.simulation.tiles[1].lx")
    page.evaluate("fftocean.stage.simulation.tiles[1].lx *= 1.0001")
    page.evaluate("fftocean.verify()")
    assert not page.evaluate("fftocean.verdict.passed")
    page.evaluate("fftocean.stage.simulation.tiles[1].lx = size")


@pytest.mark.parametrize("restored", [True, False], ids=["restored", "replaced"])
def test_a_lost_context_comes_back(page, restored):
    """The picture is the same after the loss, on the same canvas or on another one."""
    before = page.evaluate(PICTURE)
    losses = page.evaluate("fftocean.stage.losses")
    page.evaluate(
        f"""new Promise((done) => {{
          const loss = fftocean.stage.gl.getExtension('WEBGL_lose_context');
          globalThis.old = fftocean.canvas;
          old.addEventListener('webglcontextlost', () => {{
            globalThis.said = fftocean.layout.banner.textContent;
            setTimeout(() => done({json.dumps(restored)} ? loss.restoreContext() : null));
          }}, {{ once: true }});
          loss.loseContext();
        }})"""
    )
    assert page.evaluate("fftocean.stage.losses") == losses + 1
    assert "lost" in page.evaluate("said")
    page.press("p")  # the page lives on
    page.until("fftocean.served.wind_speed === 11.5")
    settle(page)
    assert page.evaluate("fftocean.canvas === globalThis.old") == restored
    assert page.evaluate("fftocean.layout.banner.hidden")
    assert page.evaluate(PICTURE) != before
    page.press("o")
    page.until("fftocean.served.wind_speed === 11")
    settle(page)
    assert page.evaluate(PICTURE) == before


# --- Keys --------------------------------------------------------------------------------------

SENT_KEYS = {
    "p": ("wind_speed", 11.5),
    "o": ("wind_speed", 11.0),
    "i": ("wind_direction", 35.0),
    "u": ("wind_direction", 30.0),
    "l": ("swell_speed", None),
    "k": ("swell_speed", None),
    "j": ("swell_direction", 80.0),
    "h": ("swell_direction", 75.0),
    ".": ("choppiness", 1.05),
    ",": ("choppiness", 1.0),
    "r": ("seed", 8),
    "Shift+R": ("seed", 7),
    "t": ("tiles", 1),
    "Shift+T": ("tiles", 2),
    "g": ("model", "pms"),
    "Shift+G": ("model", "fft"),
}


def test_every_key_of_the_sea_changes_the_server_and_the_picture(server, page):
    """One press is one step of the table, in the server's own state and in the pixels."""
    before = page.evaluate(PICTURE)
    for key, (name, expected) in SENT_KEYS.items():
        old = server.state()["state"][name]
        page.press(key)
        page.until(f"fftocean.served.{name} === fftocean.values.{name}")
        settle(page)
        new = server.state()["state"][name]
        assert new != old, key
        assert expected is None or new == pytest.approx(expected), key
        picture = page.evaluate(PICTURE)
        assert picture != before, key
        before = picture


def test_keys_of_the_page_itself(page):
    """Views, time, camera and help act here, and nothing is sent."""
    page.evaluate(
        "globalThis.sent = []; fftocean.connection.socket.send = (text) => sent.push(text); null"
    )
    picture = page.evaluate(PICTURE)
    views = []
    for _ in range(9):
        page.press("v")
        views.append(value(page, "view"))
        seen = page.evaluate(PICTURE)
        assert seen != picture, views[-1]
        picture = seen
    assert len(set(views)) == 9
    assert views[-1] == "sea"
    page.press("]")
    assert page.evaluate("fftocean.clock.scale") == 1.25
    page.press("[", "[")
    assert page.evaluate("fftocean.clock.scale") == 0.75
    start = page.evaluate("({...fftocean.camera})")
    for key, name, sign in (
        ("w", "north", 1),
        ("s", "north", -1),
        ("a", "east", -1),
        ("d", "east", 1),
        ("e", "height", 1),
        ("q", "height", -1),
        ("ArrowLeft", "yaw", 1),
        ("ArrowRight", "yaw", -1),
        ("ArrowUp", "pitch", 1),
        ("ArrowDown", "pitch", -1),
    ):
        page.evaluate(f"Object.assign(fftocean.camera, {json.dumps({**start, 'yaw': 90})})")
        origin = 90 if name == "yaw" else start[name]
        condition = f"{sign} * (fftocean.camera.{name} - {origin}) > 0"
        page.do({"hold": key, "until": condition})
    assert page.evaluate("fftocean.held.any") is False
    page.press("?")
    page.until("fftocean.layout.help?.node.open")
    page.press("Escape")
    assert not page.evaluate("fftocean.layout.help.node.open")
    assert page.evaluate("sent.length") == 0
    page.evaluate("delete fftocean.connection.socket.send; null")


def test_every_key_is_listed_and_has_a_control(page):
    """The list of keys has every key of the tables, and each parameter a labelled control."""
    table = page.evaluate("fetch('parameters.json').then((answer) => answer.json())")
    page.press("?")
    page.until("fftocean.layout.help?.node.open")
    shown = page.evaluate(
        "[...document.querySelectorAll('.keys-list kbd')].map(n => n.textContent)"
    )
    names = {" ": "Space"}
    keys = [row[k] for row in table["parameters"] for k in ("key_down", "key_up") if k in row]
    keys += [action["key"] for action in table["actions"]]
    assert {names.get(key, key.upper()) for key in keys} <= set(shown)
    labels = page.evaluate(
        "[...document.querySelectorAll('.control label')].filter(n => n.control)"
        ".map(n => n.textContent.toLowerCase())"
    )
    assert {row["label"].lower() for row in table["parameters"]} <= set(labels)


def test_screenshot_and_copies(page):
    """X saves a PNG; C and B put the server's texts on the clipboard."""
    page.press("x")
    page.until("fftocean.layout.toasts.textContent.includes('Saved')")
    assert any(url.startswith("download: fftocean-") for url in page.requests)
    for key, what, words in (("c", "job", "[sea"), ("b", "command", "fftocean bake")):
        page.press(key)
        page.until(f"fftocean.copied?.what === {what!r}")
        page.until("fftocean.layout.toasts.textContent.includes('on the clipboard')")
        text = page.evaluate("navigator.clipboard.readText()")
        assert words in text
        assert page.evaluate("fftocean.copied.text") == text
        page.evaluate("fftocean.layout.toasts.replaceChildren()")


def test_a_text_that_cannot_be_copied_is_shown(page):
    """The text stands selected in a dialog if the browser refuses the clipboard."""
    page.evaluate("navigator.clipboard.writeText = () => Promise.reject(new Error('no')); null")
    page.press("b")
    page.until("fftocean.layout.text?.node.open")
    assert page.evaluate("document.activeElement.value") == page.evaluate("fftocean.copied.text")
    page.press("Escape")
    assert not page.evaluate("fftocean.layout.text.node.open")
    page.evaluate("delete navigator.clipboard.writeText; null")


def test_keys_are_left_alone_in_fields(server, page):
    """Letters in a field are text; Escape gives the keys back to the sea."""
    before = server.state()["state"]
    page.evaluate(
        "fftocean.layout.toggle('controls', true); document.querySelector('.number').focus()"
    )
    page.press("p", "r", "t", " ", "v", "?")
    assert server.state()["state"] == before
    assert value(page, "view") == "sea"
    page.press("Escape")
    assert page.evaluate("document.activeElement === fftocean.canvas")
    page.press("v")
    assert value(page, "view") == "height"


def test_drag_and_wheel_move_the_camera(page):
    """A drag turns the eye, the wheel goes ahead."""
    before = page.evaluate("({...fftocean.camera})")
    page.do({"drag": [[200, 150], [240, 130]]}, {"wheel": [200, 150, -200]})
    after = page.evaluate("({...fftocean.camera})")
    assert after["yaw"] != before["yaw"]
    assert after["pitch"] != before["pitch"]
    assert (after["east"], after["north"]) != (before["east"], before["north"])


# --- Controls, refusals, reconnection, files ---------------------------------------------------


def test_a_field_and_a_slider_set_the_server(server, page):
    """A number typed, and a slider moved by its keys, arrive as they stand."""
    page.evaluate("fftocean.layout.toggle('controls', true)")
    page.evaluate("document.querySelector('.number').select()")
    page.do({"type": "17,25"}, {"press": ["Enter"]})
    page.until("fftocean.served.wind_speed === 17.25")
    assert server.state()["state"]["wind_speed"] == 17.25
    page.press("Tab", "ArrowLeft", "ArrowLeft")
    page.until("fftocean.served.wind_speed < 17")
    shown = float(page.evaluate("document.querySelector('.number').value"))
    assert server.state()["state"]["wind_speed"] == shown == pytest.approx(16.5, abs=0.51)
    page.evaluate("fftocean.change({ wind_speed: 11 })")
    settle(page)


def test_a_refusal_changes_nothing_and_is_shown(server, page):
    """By the page's own rule, and by the server's; the control shows the old value again."""
    before, picture = server.state()["state"], page.evaluate(PICTURE)
    page.evaluate("fftocean.layout.toggle('controls', true)")
    page.evaluate("document.querySelector('.number').select()")
    page.do({"type": "99"}, {"press": ["Enter"]})
    assert "0 to 40 m/s, got 99" in page.evaluate("document.querySelector('.fault').textContent")
    page.press("Escape")
    page.evaluate("fftocean.change({ wind_speed: 1e9 })")
    page.until("fftocean.refusal?.includes('wind_speed')")
    assert "wind_speed must be" in page.evaluate("fftocean.layout.toasts.textContent")
    assert value(page, "wind_speed") == before["wind_speed"]
    assert page.evaluate("document.querySelector('.number').value") == "11"
    page.evaluate("fftocean.connection.send({ nonsense: '<b>bold</b>' })")
    page.until("fftocean.refusal?.includes('nonsense')")
    assert page.evaluate("document.querySelectorAll('.fftocean b').length") == 0
    assert server.state()["state"] == before
    settle(page)
    assert page.evaluate(PICTURE) == picture


def test_a_lost_socket_comes_back_with_its_state(server, page):
    """The sea goes on meanwhile; what was set meanwhile arrives; what is local stays."""
    page.evaluate("fftocean.change({ sun_elevation: 12, wind_speed: 14 })")
    page.until("fftocean.served.wind_speed === 14")
    settle(page)
    page.evaluate("fftocean.connection.socket.close()")
    page.until("!fftocean.connection.ready")
    page.evaluate("fftocean.change({ seed: 21 })")
    page.until("fftocean.connection.ready && fftocean.served.seed === 21")
    settle(page)
    state = server.state()["state"]
    assert (state["wind_speed"], state["seed"]) == (14, 21)
    assert value(page, "sun_elevation") == 12
    assert value(page, "wind_speed") == 14
    page.evaluate("fftocean.change({ seed: 7, wind_speed: 11 })")
    settle(page)


def drop(page, name, data):
    """Drop a file of some bytes on the page."""
    page.evaluate(
        f"""(() => {{
          const bytes = Uint8Array.from(atob({base64.b64encode(data).decode()!r}),
            (letter) => letter.charCodeAt(0));
          const dataTransfer = new DataTransfer();
          dataTransfer.items.add(new File([bytes], {json.dumps(name)}));
          const event = (kind) => new DragEvent(kind, {{ dataTransfer, bubbles: true,
            cancelable: true }});
          for (const kind of ['dragenter', 'dragover', 'drop'])
            fftocean.canvas.dispatchEvent(event(kind));
        }})()"""
    )


def test_dropped_files_become_the_sea(browser):
    """A job and a buoy's spectrum; a bad one is refused, and names are text."""
    require((PAGE / "page.js").is_file(), "the live page is not built (npm run build)")
    with Server("--tiles", TILES) as server, browser.page(server.address, **SMALL) as page:
        page.until(f"{SETTLED} && fftocean.frames > 0")
        drop(page, "sea.toml", b"[sea.wind]\nspeed = 6.5\n[ocean]\nn = 64\nsize = 150.0\n")
        page.until("fftocean.served.wind_speed === 6.5")
        settle(page)
        assert page.evaluate("fftocean.sea.document.tiles[0].size[0]") == 150.0
        before = server.state()
        drop(page, "<img src=x>.toml", b"[sea.wind]\nspeed = -1\n")
        page.until("fftocean.refusal?.includes('speed')")
        drop(page, "<img src=y>.txt", b"no spectrum at all")
        page.until("fftocean.refusal?.includes('.txt')")
        drop(page, "large.nc", bytes(50 * 1024))
        page.until("fftocean.refusal?.includes('at most 47 KiB')")
        assert page.evaluate("document.querySelectorAll('.fftocean img').length") == 0
        assert server.state()["state"] == before["state"]
        buoy = SPECTRA / "42098w9999.nc"
        drop(page, buoy.name, buoy.read_bytes())
        page.until("fftocean.source.includes('42098w9999')")
        settle(page)
        assert server.state()["state"]["wind_speed"] == 0
        assert page.evaluate("fftocean.sea.document.statistics.specified.hs") > 0


def test_a_bake_is_played(browser, tmp_path):
    """The maps of a folder move in the same picture; what would need a server's sea is hidden."""
    require((PAGE / "page.js").is_file(), "the live page is not built (npm run build)")
    folder = tmp_path / "sea"
    command = [sys.executable, "-m", "fftocean", "bake", "-o", str(folder), "--n", "32"]
    more = ["--frames", "4", "--size", "100", "--maps", "height,displacement,derivative"]
    subprocess.run([*command, *more], check=True, capture_output=True)
    with Server(str(folder)) as server, browser.page(server.address, **SMALL) as page:
        page.until(SETTLED)
        assert page.evaluate("fftocean.stage.playback.shownFrame") == 0
        assert page.evaluate("fftocean.frames") > 0
        first = page.evaluate(PICTURE)
        page.evaluate("fftocean.clock.tick = fftocean.clock.ticks / 2; fftocean.changed()")
        page.until("fftocean.stage.playback.shownFrame === 2")
        assert page.evaluate(PICTURE) != first
        page.press("p")
        assert "fixed" in page.evaluate("fftocean.refusal")
        assert page.evaluate("fftocean.verifyButton.hidden")
        assert page.evaluate("fftocean.glError") == 0
        assert page.log == []


# --- What a browser may lack -------------------------------------------------------------------

WITHOUT_WEBGL = """
const get = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return kind === 'webgl2' ? null : get.call(this, kind, ...more);
};"""
WITHOUT_FLOATS = """
const get = WebGL2RenderingContext.prototype.getExtension;
WebGL2RenderingContext.prototype.getExtension = function (name) {
  return name === 'EXT_color_buffer_float' ? null : get.call(this, name);
};"""


def test_without_webgl_the_page_says_so_and_its_figures_work(browser, server):
    """A sentence instead of the picture; the server is still controlled."""
    with browser.page(server.address, **SMALL, before=WITHOUT_WEBGL) as page:
        page.until("globalThis.fftocean?.sea")
        assert "WebGL 2" in page.evaluate("fftocean.layout.banner.textContent")
        page.press("p")
        page.until("fftocean.served.wind_speed === 11.5")
        page.press("o")
        page.until("fftocean.served.wind_speed === 11 && !fftocean.busy")
        assert "Hs" in page.evaluate("fftocean.layout.chip.textContent")
        assert page.log == []


def test_without_float_targets_a_worker_computes_the_sea(browser, server):
    """The page says which way it goes, and is as exact (2e-7: float64 rounded once)."""
    with browser.page(server.address, **SMALL, before=WITHOUT_FLOATS) as page:
        page.until(f"{SETTLED} && fftocean.frames > 0")
        assert page.evaluate("fftocean.stage.kind") == "worker"
        page.evaluate("fftocean.verify()")
        assert "JavaScript" in page.evaluate("document.querySelector('.notes').textContent")
        assert page.evaluate("fftocean.verdict.worst") <= 2e-7
        assert page.log == []


# --- The page that is one file -----------------------------------------------------------------


@pytest.fixture(scope="module")
def one_file(tmp_path_factory):
    """Write the static page with the command line."""
    require((PAGE / "static.js").is_file(), "the live page is not built (npm run build)")
    file = tmp_path_factory.mktemp("static") / "sea.html"
    command = [sys.executable, "-m", "fftocean", "view", "--static", str(file), "--tiles", TILES]
    subprocess.run(command, check=True, capture_output=True)
    return file


def test_the_static_page_asks_for_nothing_and_checks_itself(browser, one_file):
    """From file:// there is one request, for the file; its points agree to 5e-7."""
    with browser.page(one_file.as_uri(), **SMALL) as page:
        page.until("globalThis.fftocean?.verdict")
        assert page.evaluate("fftocean.verdict.passed")
        assert page.evaluate("fftocean.verdict.worst") <= 5e-7
        assert page.requests == [one_file.as_uri()]
        picture = page.evaluate(PICTURE)
        for key, name in ((".", "choppiness"), ("v", "view")):
            before = value(page, name)
            page.press(key)
            assert value(page, name) != before
            assert page.evaluate(PICTURE) != picture
        page.press("p")
        assert "fixed" in page.evaluate("fftocean.refusal")
        page.press("c")
        page.until("fftocean.copied?.what === 'job'")
        assert "[sea" in page.evaluate("fftocean.copied.text")
        assert page.log == []
        assert page.requests == [one_file.as_uri()]


def test_the_static_page_says_what_it_is(browser, one_file):
    """Its sea, Hs, seed and the version that made it."""
    with browser.page(one_file.as_uri(), **SMALL) as page:
        page.until("globalThis.fftocean?.verdict")
        text = page.evaluate("fftocean.layout.figures.textContent")
        for word in ("Seed7", "Made byfftocean", "Hs [m]"):
            assert word in text
        labels = page.evaluate(
            "[...document.querySelectorAll('.control:not([hidden]) label')].map(n => n.textContent)"
        )
        for name in ("Choppiness", "Sun elevation", "Chlorophyll", "Time scale"):
            assert name in labels


# --- Access ------------------------------------------------------------------------------------

# What has the focus: its name, whether it can be seen, and whether the focus can be seen.
FOCUS = """(() => {
  const node = document.activeElement;
  if (!node || node === document.body) return null;
  const style = getComputedStyle(node), box = node.getBoundingClientRect();
  const labels = [...(node.labels ?? [])].map((label) => label.textContent).join(' ');
  const by = document.getElementById(node.getAttribute('aria-labelledby'))?.textContent;
  return {
    name: (node.getAttribute('aria-label') || by || labels || node.textContent).trim(),
    kind: node.tagName + (node.type ? ` ${node.type}` : ''),
    outline: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2,
    seen: box.width > 0 && box.height > 0 && box.bottom > 0 && box.top < innerHeight
      && box.right > 0 && box.left < innerWidth,
  };
})()"""


def test_everything_is_reached_by_the_keyboard(page):
    """Tab goes through every control in turn, each with a name and a visible focus, and out."""
    page.evaluate(
        "fftocean.layout.toggle('controls', true);"
        "for (const group of document.querySelectorAll('details.group')) group.open = true"
    )
    page.evaluate("[...fftocean.root.querySelectorAll('.bar button')].at(-1).focus()")
    page.press("Tab")  # out of the page, so that the next one begins at its top
    reached = []
    for _ in range(200):
        page.press("Tab")
        if (focus := page.evaluate(FOCUS)) is None:
            break
        reached.append(focus)
    assert reached[0]["name"] == "The sea, live"
    assert all(focus["name"] for focus in reached), reached
    assert [focus for focus in reached if not (focus["outline"] and focus["seen"])] == []
    wanted = page.evaluate(
        "[...fftocean.root.querySelectorAll('button, input, select, summary, canvas.sea')]"
        ".filter((n) => n.checkVisibility() && !n.disabled && n.tabIndex >= 0).length"
    )
    assert len(reached) == wanted
    assert len(reached) > 60


def test_enter_and_space_press_buttons(page):
    """A focused button obeys the keyboard; the space bar does not pause then."""
    page.evaluate("fftocean.layout.viewButton.focus()")
    page.press("Enter", " ")
    assert value(page, "view") == "slopes"
    assert page.evaluate("fftocean.clock.paused")


@pytest.mark.parametrize("zoom", [100, 200], ids="{} % text".format)
def test_360_pixels_are_wide_enough(page, zoom):
    """Nothing scrolls sideways, the page or a panel, and no control is cut off."""
    page.do({"size": [360, 740]})
    page.evaluate(f"document.documentElement.style.fontSize = '{zoom}%'")
    for panel in ("figures", "controls"):
        page.evaluate(
            f"fftocean.layout.toggle({panel!r}, true);"
            "for (const group of document.querySelectorAll('details')) group.open = true"
        )
        page.until("fftocean.settled")
        found = page.evaluate(
            f"""(() => {{
              const panel = fftocean.layout[{panel!r}];
              const wide = (node) => node.scrollWidth - node.clientWidth;
              const edge = panel.getBoundingClientRect();
              const cut = [...panel.querySelectorAll('*')].filter((node) => {{
                const box = node.getBoundingClientRect();
                return box.width > 0 && (box.left < edge.left - 1 || box.right > edge.right + 1);
              }}).map((node) => node.className || node.tagName);
              return {{ page: wide(document.documentElement), root: wide(fftocean.root),
                panel: wide(panel), cut }};
            }})()"""
        )
        assert found == {"page": 0, "root": 0, "panel": 0, "cut": []}


# The lowest contrast of a text over what may lie under it: the panels are translucent, so both a
# white and a black sea are tried; [contrast, text] of every text below 4.5.
CONTRAST = """(() => {
  const parts = (text) => (text.match(/[\\d.]+/g) ?? [0, 0, 0, 0]).map(Number);
  const over = ([r, g, b, a = 1], below) => [r, g, b].map((v, i) => a * v + (1 - a) * below[i]);
  const linear = (v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4);
  const light = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const ratio = (a, b) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  const low = [];
  let count = 0;
  for (const node of fftocean.root.querySelectorAll('*')) {
    const own = [...node.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
    const field = node.matches('input[type=text], select, textarea');
    if (!(own || field) || !node.checkVisibility() || node.closest('.spoken, option')) continue;
    count += 1;
    for (const ground of [[0, 0, 0], [255, 255, 255]]) {
      const layers = [];
      for (let at = node; at && at !== fftocean.root; at = at.parentElement) layers.push(at);
      const below = layers.reverse().reduce(
        (colour, at) => over(parts(getComputedStyle(at).backgroundColor), colour), ground);
      const text = over(parts(getComputedStyle(node).color), below);
      const found = ratio(light(text), light(below));
      if (found < 4.5) low.push([found.toFixed(2), node.className, node.textContent.slice(0, 40)]);
    }
  }
  return { count, low };
})()"""


def test_every_text_has_enough_contrast(page):
    """4.5 to 1 at least, over the whitest foam and the blackest water."""
    page.do({"size": [1000, 700]})
    page.evaluate(
        "for (const name of ['figures', 'controls']) fftocean.layout.toggle(name, true);"
        "for (const group of document.querySelectorAll('details')) group.open = true;"
        "fftocean.refuse('a refusal'); fftocean.layout.toast('a note');"
        "fftocean.layout.showBanner('a banner'); fftocean.layout.showView('Height')"
    )
    page.evaluate("fftocean.verify()")
    page.evaluate("fftocean.act('help')")
    found = page.evaluate(CONTRAST)
    assert found["count"] > 150
    assert found["low"] == []


def test_the_sea_is_described_in_words(page):
    """A polite live region has the sea in a sentence, and says when it changes."""
    page.until("fftocean.layout.spoken.textContent.includes('significant wave height')")
    assert page.evaluate("fftocean.layout.spoken.getAttribute('aria-live')") == "polite"
    text = page.evaluate("fftocean.layout.spoken.textContent")
    assert "Wind of 11 metres per second toward the east-north-east, Beaufort 6" in text
    page.press(" ")
    page.until("fftocean.layout.spoken.textContent === 'Time goes on.'")
    page.press(" ")


def test_the_presets_are_the_scales(server, page):
    """Beaufort 8 chosen from the list is a gale on the server."""
    page.evaluate("fftocean.layout.toggle('controls', true)")
    page.evaluate(
        "(() => { const list = document.querySelector('.preset select');"
        "list.value = [...list.options].find((o) => o.text.startsWith('Beaufort 8')).value;"
        "list.dispatchEvent(new Event('change')); })()"
    )
    page.until("fftocean.served.wind_speed > 15 && fftocean.served.swell_speed === 0")
    settle(page)
    assert page.evaluate("fftocean.sea.document.statistics.specified.hs") == pytest.approx(
        5.5, rel=0.02
    )
    assert server.state()["state"]["wind_speed"] == pytest.approx(19.0, abs=0.5)
    page.evaluate("fftocean.change({ wind_speed: 11, fetch: 150e3, swell_speed: 12 })")
    settle(page)


# --- Sizes, words and a server that is gone ------------------------------------------------------

CUTS = """((first, second) => {
  const [a, b] = [first, second].map((node) => node.getBoundingClientRect());
  return a.width > 0 && b.width > 0 && a.left < b.right && b.left < a.right
    && a.top < b.bottom && b.top < a.bottom;
})"""


def test_a_narrower_page_closes_its_panels_and_stretches_no_plot(page):
    page.do({"size": [1280, 720]})
    page.evaluate("for (const p of ['figures', 'controls']) fftocean.layout.toggle(p, true)")
    page.until("fftocean.wasWide && fftocean.panel?.plot.width > 0")
    page.do({"size": [390, 740]})
    page.until("fftocean.layout.figures.hidden && fftocean.layout.controls.hidden")
    page.evaluate("fftocean.layout.toggle('figures', true)")
    for width in (390, 330):
        page.do({"size": [width, 740]})
        page.until(
            f"fftocean.root.clientWidth === {width} && ((plot) => Math.abs(plot.width / plot.height"
            " - plot.clientWidth / plot.clientHeight) < 0.02)(fftocean.panel.plot)"
        )


@pytest.mark.parametrize("size", [(1280, 720), (800, 500), (480, 740)], ids="{0[0]}".format)
def test_names_of_halves_and_tools_are_clear_of_panels_and_messages(page, size):
    page.do({"size": list(size)})
    page.evaluate("fftocean.change({ model: 'pms' })")
    page.until(f"{SETTLED} && !fftocean.layout.halves.hidden")
    names = ["FFT: 123 456 waves, transforms 1.2 ms, picture 3.4 ms", "PMS: 12 waves, half 1 ms"]
    for panels in (["figures"], ["controls"], ["figures", "controls"]):
        cut = page.evaluate(
            f"""(() => {{
              const {{ layout }} = fftocean;
              for (const p of ['figures', 'controls']) layout.toggle(p, false);
              for (const p of {panels}) layout.toggle(p, true);
              layout.showSplit({names});
              layout.toast('A message of some length over the picture of the sea');
              const over = [layout.figures, layout.controls, layout.toasts.lastChild];
              const under = [...layout.split, layout.bar];
              return over.flatMap((a) => under.filter((b) => {CUTS}(a, b)).map((b) =>
                `${{a.className}} over ${{b.className}}`));
            }})()"""
        )
        assert cut == []
    page.evaluate("fftocean.change({ model: 'fft' })")
    settle(page)


def test_the_verdict_is_scrolled_into_view(page):
    page.do({"size": [1280, 500]})
    page.until("fftocean.wasWide")
    page.evaluate("fftocean.verify()")
    page.until("fftocean.verdict && !fftocean.verifying")
    assert page.evaluate(
        """(() => {
          const panel = fftocean.layout.figures.getBoundingClientRect();
          const verdict = document.querySelector('.verdict').getBoundingClientRect();
          return verdict.top >= panel.top && verdict.bottom <= panel.bottom;
        })()"""
    )


def test_the_line_between_the_halves_takes_no_drag(page):
    page.evaluate("fftocean.change({ model: 'pms' })")
    page.until(f"{SETTLED} && !fftocean.layout.halves.hidden")
    assert page.evaluate(
        "document.elementFromPoint(fftocean.root.clientWidth / 2, 100) === fftocean.canvas"
    )
    page.evaluate("fftocean.change({ model: 'fft' })")
    settle(page)


# every socket fails from now on; the browser would write each real failure to its console
NO_SERVER = """(() => {
  const { connection } = fftocean;
  connection.openBefore = connection.open;
  connection.open = () => {
    const socket = { close() {} };
    setTimeout(() => socket.onclose({}));
    return socket;
  };
  connection.socket.close();
})()"""


def test_a_server_that_is_gone_is_named_and_changes_nothing(page):
    """Changes made while it might have come back are undone; light, camera and view go on."""
    shown = value(page, "wind_speed")
    page.evaluate(NO_SERVER)
    page.until("!fftocean.connection.ready")
    page.evaluate(f"fftocean.change({{ wind_speed: {shown + 3} }})")
    page.until("fftocean.serverGone")
    assert value(page, "wind_speed") == shown
    page.evaluate("fftocean.refusal = null")
    page.press("p")
    assert value(page, "wind_speed") == shown
    assert "address that it prints" in page.evaluate("fftocean.refusal")
    page.evaluate("fftocean.change({ sun_elevation: 9 })")
    assert value(page, "sun_elevation") == 9
    page.evaluate(
        "fftocean.connection.open = fftocean.connection.openBefore;fftocean.connection.retryNow()"
    )
    page.until("fftocean.connection.ready && !fftocean.serverGone")
    settle(page)
