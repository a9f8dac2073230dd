"""
A server on a free port of the loopback interface, and a headless browser that opens its pages.
"""

import base64
import contextlib
import functools
import http.server
import itertools
import json
import queue
import subprocess
import threading
from pathlib import Path

import numpy as np

# [s] that one page may take, also on a machine that is busy with other work; it takes a few
LONGEST = 300.0


class Site:
    """An HTTP server of some folders, each under its name."""

    def __init__(self, folders):
        self.folders = {name: Path(folder).resolve() for name, folder in folders.items()}

    def __enter__(self):
        handler = functools.partial(_Handler, self.folders)
        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        self._server.daemon_threads = True
        self._thread = threading.Thread(
            target=self._server.serve_forever, kwargs={"poll_interval": 0.1}
        )
        self._thread.start()
        self.address = f"http://127.0.0.1:{self._server.server_address[1]}"
        return self

    def __exit__(self, *_):
        self._server.shutdown()
        self._thread.join()
        self._server.server_close()


class _Handler(http.server.SimpleHTTPRequestHandler):
    """Server of files below the folders, isolated from other origins for engines with threads."""

    extensions_map = {  # noqa: RUF012
        **http.server.SimpleHTTPRequestHandler.extensions_map,
        ".js": "text/javascript",
        ".mjs": "text/javascript",
        ".wasm": "application/wasm",
    }

    def __init__(self, folders, *args, **kwargs):
        self._folders = folders
        super().__init__(*args, **kwargs)

    def translate_path(self, path):
        name, _, rest = path.split("?")[0].lstrip("/").partition("/")
        folder = self._folders.get(name)
        file = (folder / rest).resolve() if folder else None
        return str(file) if file and file.is_relative_to(folder) else "/nonexistent"

    def end_headers(self):
        self.send_header("Cross-Origin-Opener-Policy", "same-origin")
        self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
        self.send_header("Cache-Control", "no-store")
        super().end_headers()

    def log_message(self, *_):
        """Log nothing: the page shows a missing file."""


class Browser:
    """One headless Chromium, controlled by `driver.mjs`."""

    def __init__(self, chromium, modules, site, *, log, graphics="webgl"):
        self.site = site
        self._command = [
            "node",
            str(Path(__file__).with_name("driver.mjs")),
            chromium,
            str(modules),
            graphics,
        ]
        self._log = log
        self._names = itertools.count(1)

    def __enter__(self):
        self._errors = self._log.open("wb")
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(
            self._command, stdin=pipe, stdout=pipe, stderr=self._errors
        )
        self._lines = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()
        try:
            self.version = self._answer()["browser"]
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self._process.stdin.close()  # the driver closes the browser, and ends
        try:
            self._process.wait(60)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._reader.join()
        self._process.stdout.close()
        self._errors.close()

    def run(self, page, args):
        """Return the result of `run(args)` of a page, and its console; fail the test on errors."""
        answer = self.ask({"url": f"{self.site.address}/pages/{page}", "args": args})
        return answer["value"], answer["log"]

    @contextlib.contextmanager
    def page(self, url, **options):
        """
        Open a page, give it as a `Page`, and close it.

        Args:
            url: any address.
            options: `width` and `height` of the window, `reducedMotion`, `before`, a script that
                runs before the page's own, and `empty`, a pattern of modules that are empty.
        """
        name = f"page {next(self._names)}"
        opened = Page(self, name)
        try:
            opened.heard(self.ask({"open": name, "url": url, **options}))
            yield opened
        finally:
            self.ask({"close": name})

    def ask(self, request):
        """Return the driver's answer to a request; fail the test on errors of the page."""
        self._process.stdin.write(json.dumps(request).encode() + b"\n")
        self._process.stdin.flush()
        answer = self._answer()
        assert not answer["failures"], "\n".join([*answer["failures"], *answer["log"]])
        return answer

    def _read(self):
        for line in self._process.stdout:
            self._lines.put(line)
        self._lines.put(None)

    def _answer(self):
        try:
            line = self._lines.get(timeout=LONGEST)
        except queue.Empty:
            self._process.kill()
            raise TimeoutError(f"the browser did not answer within {LONGEST:g} s") from None
        if line is None:
            raise RuntimeError(
                f"the browser's driver ended: {self._log.read_text(errors='replace')[-2000:]}"
            )
        return json.loads(line)


class Page:
    """A page that is open: what is done to it, what it says and what it asks for."""

    def __init__(self, browser, name):
        self._browser, self._name = browser, name
        self.log, self.requests = [], []

    def heard(self, answer):
        """Note what a page said and asked for; return the values."""
        self.log += answer["log"]
        self.requests += answer["requests"]
        return answer["value"]

    def do(self, *steps):
        """Do steps of `driver.mjs`, and return the result of each."""
        return self.heard(self._browser.ask({"page": self._name, "steps": steps}))

    def evaluate(self, expression):
        """Return the value of an expression; a promise is waited for."""
        return self.do({"evaluate": expression})[0]

    def until(self, expression):
        """Wait until an expression is true, and return its value."""
        return self.do({"until": expression})[0]

    def press(self, *keys):
        """Press keys, one after the other."""
        self.do({"press": keys})

    def screenshot(self):
        """Return the bytes of a PNG of the window."""
        return base64.b64decode(self.do({"screenshot": True})[0])


def floats(text, *shape):
    """Return the float32 array that a page sent as base64."""
    return np.frombuffer(base64.b64decode(text), dtype="<f4").reshape(*shape).astype(float)
