# Not run in Unreal: only its syntax is checked, by Python. Compare frame 0 with the first file.
"""
Import of a bake into Unreal 5, beside the maps of

    fftocean bake sea.toml -o sea --engine unreal --format exr      (or exr-float, exr-atlas)

With the plug-in "Python Editor Script Plugin": Tools > Execute Python Script, and choose this file.
Each EXR becomes a texture in /Game/<name of the folder>: HDR (RGBA16F, or RGBA32F for exr-float),
linear, without mipmaps, repeating, never streamed. Displacement is in centimetres and the engine's
axes: World Position Offset takes it as it is. The rules for sampling are in manifest.json
(`sampling`) and, for an atlas, in the .unreal.txt beside it.
"""

import json
from pathlib import Path

import unreal

FOLDER = Path(__file__).resolve().parent


def files_of(folder):
    """Return the EXR files that the manifest of a bake lists, in its order."""
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    profile = manifest["conventions"]["profile"]
    if profile != "unreal":
        raise ValueError(f"{folder}: the bake must be of --engine unreal, got {profile}")
    containers = manifest.get("containers", {}).values()
    listed = [entry["path"] for entries in containers for entry in entries]
    for row in manifest["frames"]:
        listed += [entry["path"] for entry in row["files"].values()]
    single = manifest["job"]["bake.format"] == "exr-float"
    return [folder / path for path in dict.fromkeys(listed) if path.endswith(".exr")], single


def import_bake(folder, destination):
    """Import the maps of a bake as textures of data, one asset folder a map."""
    files, single = files_of(folder)
    tasks = []
    for file in files:
        task = unreal.AssetImportTask()
        inner = file.relative_to(folder).parent.as_posix()
        task.filename = str(file)
        task.destination_path = destination if inner == "." else f"{destination}/{inner}"
        task.destination_name = f"{file.parent.name if inner != '.' else 'atlas'}_{file.stem}"
        task.automated = task.replace_existing = task.save = True
        tasks.append(task)
    unreal.AssetToolsHelpers.get_asset_tools().import_asset_tasks(tasks)
    settings = {
        "compression_settings": (
            unreal.TextureCompressionSettings.TC_HDR_F32
            if single
            else unreal.TextureCompressionSettings.TC_HDR
        ),
        "srgb": False,
        "mip_gen_settings": unreal.TextureMipGenSettings.TMGS_NO_MIPMAPS,
        "never_stream": True,
        "address_x": unreal.TextureAddress.TA_WRAP,
        "address_y": unreal.TextureAddress.TA_WRAP,
    }
    for task in tasks:
        texture = unreal.load_asset(f"{task.destination_path}/{task.destination_name}")
        for name, value in settings.items():
            texture.set_editor_property(name, value)
        unreal.EditorAssetLibrary.save_loaded_asset(texture)
    unreal.log(f"fftocean: {len(tasks)} textures in {destination}")


if __name__ == "__main__":
    tiles = sorted(FOLDER.glob("tile[0-9]*/manifest.json"))
    for place in [path.parent for path in tiles] or [FOLDER]:
        name = f"/Game/{FOLDER.name}" + (f"/{place.name}" if tiles else "")
        import_bake(place, name)
