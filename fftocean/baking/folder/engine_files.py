"""
Files that play a bake in its engine, beside the maps: a page, a scene, a shader, an import script.

They are those of the projects in `examples/`, byte for byte; only a page is told which document of
the bake it plays.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fftocean.example_projects import project_files
from fftocean.export.formats import FORMATS
from fftocean.files import write_whole
from fftocean.job.parameters import ENGINES

PAGE_DOCUMENT = b'data-sea="sea.json"'
"""Place in a page that names its document: a run-time package's in the example."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Player:
    """
    Files that play, or import, a bake in an engine.

    Attributes:
        project: folder in `examples/`.
        files: names in that folder, and in that of the bake.
        formats: formats that they read.
        maps: maps of which they need one.
        start: next step of the user.
    """

    project: str
    files: tuple[str, ...]
    formats: tuple[str, ...]
    maps: tuple[str, ...]
    start: str


_EXR = ("exr", "exr-float", "exr-atlas")
_PLACES = ("displacement", "height")
_PAGE = (
    *("index.html", "main.js", "package.js", "passes.js", "simulation.js", "playback.js"),
    *("sky.js", "water.js", "buoy.js"),
)
_SERVE = "`npm install three` in the folder once, then `python -m http.server`, and open the page"


def players_of(players: Mapping[str, Player]) -> Mapping[str, Player]:
    """
    Return players by engine.

    Raises:
        ImportError: an engine or a format that does not exist, or a player without a part.
    """
    for engine, player in players.items():
        if engine not in ENGINES or not set(player.formats) <= FORMATS.keys():
            raise ImportError(f"the player of {engine} must be of a known engine and formats")
        if not (player.files and player.formats and player.maps and player.start):
            raise ImportError(f"the player of {engine} must have files, formats, maps and a start")
    return players


PLAYERS = players_of({
    "three": Player(
        project="threejs", files=_PAGE, formats=(*_EXR, "bin", "ktx2"), maps=_PLACES, start=_SERVE
    ),
    "three-exr": Player(
        project="threejs", files=_PAGE, formats=_EXR, maps=_PLACES, start=_SERVE
    ),
    "godot": Player(
        project="godot4",
        files=(
            *("sea_bake.tscn", "sea_bake.gd", "sea_bake.gdshader", "sea_bake_maps.gdshaderinc"),
            *("sea_light.gdshaderinc", "sea_mesh.gd", "sea_buoy.gd", "sea_camera.gd"),
        ),
        formats=(*_EXR, "bin"),
        maps=_PLACES,
        start="put the folder into a Godot 4 project and open sea_bake.tscn",
    ),
    "unity": Player(
        project="bake_import",
        files=("FFToceanBakeImport.cs",),
        formats=(*_EXR, "bin"),
        maps=_PLACES,
        start="put the folder into Assets; menu Assets > fftocean > Build texture arrays",
    ),
    "unreal": Player(
        project="bake_import",
        files=("fftocean_bake_import.py",),
        formats=_EXR,
        maps=_PLACES,
        start="Tools > Execute Python Script (of the Python Editor Script Plugin): "
        "fftocean_bake_import.py",
    ),
})  # fmt: skip

NAMES = frozenset(name for player in PLAYERS.values() for name in player.files)
"""Names of the files of all players."""


def player_for(described: Mapping[str, Any]) -> Player | None:
    """
    Return the player of a bake; None where its engine, format or maps have none.

    Args:
        described: the job as plain data, of a bake or of a cascade.
    """
    player = PLAYERS.get(str(described.get("bake.engine")))
    maps = described.get("bake.maps")
    if player is None or described.get("bake.engine_files") is not True:
        return None
    has_place = isinstance(maps, list) and set(player.maps) & set(map(str, maps))
    return player if described.get("bake.format") in player.formats and has_place else None


def names_for(described: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of the files that a bake's player has; () where it has none."""
    player = player_for(described)
    return () if player is None else player.files


def existing(folder: Path, names: Iterable[str]) -> list[Path]:
    """Return the files of those names that are in a folder, whatever they are."""
    paths = [folder / name for name in names]
    return [path for path in paths if path.is_symlink() or path.exists()]


def write_player(folder: Path, described: Mapping[str, Any], document: str) -> list[dict[str, Any]]:
    """
    Write the files of a bake's player; return their entries of the manifest.

    Args:
        folder: of the bake.
        described: its job as plain data.
        document: name of the file that describes it: that of a bake, or of a cascade.

    Raises:
        OutputError: a file cannot be written, or the projects are not installed.
    """
    player = player_for(described)
    if player is None:
        return []
    sources = project_files(player.project)
    entries = []
    for name in player.files:
        data = sources[name].read_bytes()
        if name.endswith(".html"):
            data = data.replace(PAGE_DOCUMENT, f'data-sea="{document}"'.encode())
        sha256 = write_whole(folder / name, data)
        entries.append({"path": name, "bytes": len(data), "sha256": sha256})
    return entries


def in_words(described: Mapping[str, Any]) -> str:
    """Return in a sentence which files play a bake in its engine, or why there are none."""
    engine, player = described["bake.engine"], PLAYERS.get(described["bake.engine"])
    if player is None:
        return f"no files to play it with {engine}: docs/engines.md has the steps"
    if described["bake.engine_files"] is not True:
        return f"no files to play it with {engine}: bake.engine_files is false"
    if described["bake.format"] not in player.formats:
        return f"no files to play it with {engine}: they read {', '.join(player.formats)}"
    if player_for(described) is None:
        return f"no files to play it with {engine}: they need one of {', '.join(player.maps)}"
    return f"to play it with {engine}: {player.start}"
