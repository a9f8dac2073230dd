"""
Notebook widget: the live page in an output cell, with a still picture for the saved notebook.

`fo.view` makes it. The widget carries the sea as the socket does; the page evolves it, and asks the
kernel only for reference fields, with which it verifies itself, and for frames of a bake.
"""

import functools
import io
import math
from base64 import b64encode
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import fftocean
from fftocean.cascade import Cascade
from fftocean.computation import Computation
from fftocean.errors import FFTOceanError, ParameterError, described, how_to_install
from fftocean.fields import EIGHT
from fftocean.limits import Count
from fftocean.ocean import Ocean, from_amplitudes
from fftocean.physics import dispersion
from fftocean.physics.sea import Sea
from fftocean.view import parameters, protocol
from fftocean.view.one_file import one_script
from fftocean.view.page_files import read_text
from fftocean.wave_list import oceans_of

if TYPE_CHECKING:
    from fftocean.view.playback import Playback

HEIGHT = Count("pixels", 120, 4000)
STILL = 640, 360
"""Width and height of the still picture [pixels]."""
LOOP = 64.0
"""Period of a `Sea` that is shown [s]."""
SAMPLES = 128
"""Samples a side of the tiles of a `Sea` that is shown."""

_ACROSS, _NARROWEST = 12.0, 60.0  # peak wavelengths, and metres, across the largest tile
_SMALLER = 7.3  # ratio of the sizes of two tiles; no whole number, so that the sum repeats late
_POINTS = 16  # at which the page checks itself
_MOMENT = 0.1  # of the loop, at which the still is drawn


def view(
    source: Ocean | Cascade | Sea | str | Path,
    *,
    height: int = 420,
    wind: tuple[float, float] | None = None,
    seed: int = 0,
) -> Any:
    """
    Show a sea live in a notebook.

    The picture is computed in the browser, by WebGL 2; Python sends the waves once. In a notebook
    that is saved and opened without a kernel, a still picture stands in its place.

    Args:
        source: an `Ocean` or a `Cascade` with a loop and a power of two of samples a side; a `Sea`,
            of which three tiles are made; or the folder of a bake, which is played.
        height: of the cell [pixels].
        wind: speed [m/s] and direction [degrees] of the wind, which roughen the water below the
            samples; unknown for None.
        seed: random seed of a `Sea`.

    Returns:
        The widget. `widget.show(source)` changes it into another sea, wave by wave.

    Raises:
        ParameterError: a source that cannot be shown, with the rule; or anywidget is missing.
        IntegrityError: a bake that is not finished or was changed.
    """
    widget = _widget_class()()
    widget.height = HEIGHT.check("height", height)
    widget.show(source, wind=wind, seed=seed)
    return widget


class _Shown(NamedTuple):
    """A sea or a bake as the widget carries it."""

    tiles: tuple[Ocean, ...]  # in float64; () for a bake
    playback: "Playback | None"
    sea: bytes  # the container; b"" for a bake
    ticks: int
    number: int  # of the sea, in its document
    about: dict[str, Any]


@functools.cache
def _widget_class() -> Any:
    """
    Return the class of the widget, made when it is first needed.

    Raises:
        ParameterError: anywidget is not installed.
    """
    try:
        import anywidget
        import traitlets
    except ImportError:
        raise ParameterError(
            f"the widget needs anywidget, which is not installed: {how_to_install('notebook')}"
        ) from None

    class SeaWidget(anywidget.AnyWidget):
        """
        A sea, live in a notebook.

        Attributes:
            height: of the cell [pixels].
            still: the picture that stays in a saved notebook, as a PNG; drawn when the widget is
                displayed.
        """

        _esm = one_script("widget.js")
        _css = read_text("page.css")
        sea = traitlets.Bytes(b"").tag(sync=True)
        about = traitlets.Dict().tag(sync=True)
        still = traitlets.Bytes(b"").tag(sync=True)
        height = traitlets.Int(420).tag(sync=True)

        def __init__(self) -> None:
            super().__init__()
            self._shown: _Shown | None = None
            self.on_msg(self._receive)

        def show(
            self,
            source: Ocean | Cascade | Sea | str | Path,
            *,
            wind: tuple[float, float] | None = None,
            seed: int = 0,
        ) -> None:
            """Show another sea; arguments as of `fo.view`."""
            number = 1 if self._shown is None else self._shown.number + 1
            shown = _shown(source, wind, seed, number)
            if self._shown is not None and (shown.playback or self._shown.playback):
                raise ParameterError(
                    "a widget must go on with what it began, a sea or a bake: "
                    "make another one with fo.view(...)"
                )
            self._shown = shown
            with self.hold_sync():
                self.about, self.sea, self.still = shown.about, shown.sea, b""

        def _receive(self, _widget: Any, content: Any, _buffers: Any) -> None:
            """Answer a message of the page."""
            try:
                text = content.get("text") if isinstance(content, dict) else ""
                message = protocol.parsed(text if isinstance(text, str) else "")
                if self._shown is not None:
                    for kind, data in _answers(self._shown, message):
                        self.send({"kind": kind}, [data])
            except FFTOceanError as error:
                self.send({"kind": "refused", "value": {"message": str(error), "name": None}})

        def _repr_mimebundle_(self, **options: Any) -> Any:
            """Return the widget for a live notebook, and the still for one without a kernel."""
            bundle = super()._repr_mimebundle_(**options)
            data, metadata = bundle if isinstance(bundle, tuple) else (bundle, {})
            data = dict(data or {})
            if self._shown is not None:
                self.still = self.still or _still(self._shown)
                data["image/png"] = b64encode(self.still).decode()
            data["text/plain"] = self.about.get("title", "a sea")
            return data, metadata

    return SeaWidget


def _shown(source: Any, wind: tuple[float, float] | None, seed: int, number: int) -> _Shown:
    """Return a sea or a bake as the widget carries it."""
    about: dict[str, Any] = {"version": fftocean.__version__, "table": parameters.table()}
    if isinstance(source, (str, Path)):
        from fftocean.view.playback import open_bake

        playback = open_bake(source)
        document = playback.manifest()
        title = f"{document['source']}: {document['frames']} frames of a bake"
        about |= {"source": document["source"], "title": title, "bake": document}
        return _Shown((), playback, b"", document["ticks"], number, about)
    from fftocean.runtime import pack, to_bytes

    water = _cascade(source, seed) if isinstance(source, Sea) else source
    if not isinstance(water, (Ocean, Cascade)):
        raise ParameterError(
            "fo.view shows an Ocean, a Cascade, a Sea or the folder of a bake, "
            f"got {described(source)}"
        )
    package = pack(water, reference=_POINTS, wind=wind)
    package.document["id"] = number
    realised = package.document["statistics"]["realised"]
    name = "cascade" if isinstance(water, Cascade) else "ocean"
    title = f"{name}: Hs {realised['hs']:.2f} m, Tp {realised['tp']:.1f} s"
    about |= {"source": name, "title": title}
    tiles = tuple(
        from_amplitudes(
            tile.sea, tile.seed, tile.amplitudes, tile.choppiness, Computation("float64")
        )
        for tile in oceans_of(water)
    )
    return _Shown(tiles, None, to_bytes(package), package.document["ticks"], number, about)


def _cascade(sea: Sea, seed: int) -> Cascade:
    """Return three tiles of a sea, the largest some peak wavelengths wide."""
    length = 2.0 * math.pi / float(dispersion.wavenumber(sea.peak, sea.depth))
    largest = max(_ACROSS * length, _NARROWEST)
    tiles = [(SAMPLES, largest / _SMALLER**i) for i in range(3)]
    return Cascade(sea, tiles, seed=seed, loop=LOOP)


def _still(shown: _Shown) -> bytes:
    """Return a picture of one moment as a PNG."""
    from PIL import Image

    from fftocean.baking.previews.render import Water, developed, perspective

    if shown.playback is not None:
        frames = shown.playback.fields(0)
    else:
        moment = round(_MOMENT * shown.ticks)
        frames = [tile.loop_frame(moment, shown.ticks, EIGHT) for tile in shown.tiles]
    image = Image.fromarray(developed(perspective(Water.of(frames), *STILL, taps=1)))
    stream = io.BytesIO()
    image.save(stream, format="PNG")
    return stream.getvalue()


def _answers(shown: _Shown, message: protocol.Message) -> list[tuple[str, bytes]]:
    """
    Return the kinds and contents of the answers to a message.

    Raises:
        FFTOceanError: the message is refused, with the reason.
    """
    if isinstance(message, protocol.BakedFrame) and shown.playback is not None:
        return [("frame", shown.playback.frame(message.tile, message.frame))]
    if isinstance(message, protocol.Verify) and shown.tiles:
        if message.sea not in (None, shown.number):
            raise ParameterError("the sea was changed; verify the one that is shown now")
        found = []
        for i, tile in enumerate(shown.tiles):
            frame = tile.loop_frame(message.tick, shown.ticks, protocol.REFERENCE_FIELDS)
            data = protocol.reference(
                frame, tick=message.tick, ticks=shown.ticks, tile=i, sea=shown.number
            )
            found.append(("reference", data))
        return found
    raise ParameterError("the sea of a notebook is changed in Python: widget.show(...)")
