"""
A sea in Blender: a still picture, a looping film, a scene to work on.

From a run-time package (`fftocean export-sea`) or a bake (`fftocean bake --engine blender`), by
Blender, or by a Python that has it as a module; fftocean itself is not needed:

    blender --background --python render_sea.py -- sea --still sea.png
    python render_sea.py sea --film frames/ --frames 64 --size 480x270 --samples 16

Without --background Blender opens its window with the sea in it. Frame 1 is the moment 0, and the
frame after the last is the first again, to the pixel. The camera looks north (+y); to see the waves
from elsewhere, turn the sea's wind. A folder that this script cannot show is an error.
"""

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))  # Blender does not


def pair(convert, separator):
    """Return a parser of two numbers, such as 960x540."""
    return lambda text: tuple(convert(part) for part in text.split(separator, 1))


def flags():
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(
        prog="render_sea.py",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("folder", type=Path, nargs="?", default=HERE, help="package or bake (default: beside this)")
    add("--still", type=Path, help="picture to render: .png, .jpg or .webp")
    add("--film", type=Path, help="folder for the pictures of the loop, or an .mp4")
    add("--save", type=Path, help=".blend file to write")
    add("--frame", type=int, default=0, help="of the still, counted from 0")
    add("--frames", type=int, help="of the loop of a package (default: 24 a second)")
    add("--size", type=pair(int, "x"), default=(960, 540), metavar="WxH")
    add("--samples", type=int, default=48, help="a pixel (default: 48)")
    add("--eye", type=float, default=5.0, help="height of the camera [m] (default: 5)")
    add("--place", type=pair(float, ","), default=(0.0, 0.0), metavar="X,Y", help="of it [m]")
    add("--near", type=float, default=0.1, help="spacing of vertices below it [m] (default: 0.1)")
    add("--ratio", type=float, default=0.02, help="spacing over distance, farther off (0.02)")
    add(
        "--sun",
        type=pair(float, ","),
        default=(16.0, 72.0),
        metavar="UP,TURN",
        help="elevation, and direction counter-clockwise from east [degrees] (default: 16,72)",
    )
    add("--exposure", type=float, default=-4.6, help="[stops] (default: -4.6)")
    add("--chlorophyll", type=float, default=0.4, help="colour of the water [mg/m3]")
    return parser


def package_scene(options):
    """Make the scene of a package; return its number of frames."""
    import bpy
    import look
    from evolved import EvolvedSea, view_surface
    from package import Sea

    sea = Sea(options.folder)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    frames = options.frames or round(24.0 * sea.loop)
    surface = view_surface(sea, options.place, options.ratio, options.near)
    water = EvolvedSea(surface, frames, eye=options.place)
    water.follow()
    rest = look.attribute("rest", 1)

    def normal(nodes):
        """Return the mesh's normals with ripples on them."""
        near = look.attribute("near")(nodes)
        return look.ripples(nodes, rest(nodes), near, look.drift_node(nodes, frames))

    material = look.water_material(
        look.attribute("foam"),
        place=rest,
        roughness=look.attribute("roughness"),
        normal=normal,
        chlorophyll=options.chlorophyll,
    )
    water.object.data.materials.append(material)
    x, y = options.place
    look.camera((x, y, options.eye), (x, y + 40.0, 0.2 * options.eye))
    look.quality(*options.size, options.samples, frames, sea.loop)
    return frames


def bake_scene(options):
    """Make the scene of a bake, its tile repeated around the camera; return its frames."""
    import displace
    import look

    manifest = displace.read_bake(options.folder)
    (nx, ny), (lx, ly) = manifest["ocean"]["n"], manifest["ocean"]["size"]
    tiles = max(1, int((VERTICES / (nx * ny)) ** 0.5))
    displace.animated_sea(options.folder, (tiles * nx + 1, tiles * ny + 1))
    x, eye = 0.5 * tiles * lx, options.eye + manifest["extremes"]["max_height"]
    look.camera((x, 0.02 * ly, eye), (x, 40.0, 0.2 * eye))
    frames = len(manifest["frames"])
    look.quality(*options.size, options.samples, frames, manifest["ocean"]["loop"])
    return frames


VERTICES = 1e6  # of the repeated tile of a bake, at most


def render_still(file, frame):
    """Render a frame, counted from 0, in the format of the file's suffix."""
    import bpy

    scene = bpy.context.scene
    kinds = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG", ".webp": "WEBP"}
    if file.suffix.lower() not in kinds:
        sys.exit(f"--still must be a .png, .jpg or .webp, got {file}")
    scene.render.image_settings.file_format = kinds[file.suffix.lower()]
    scene.render.image_settings.quality = 85
    scene.frame_set(frame + 1)
    scene.render.filepath = str(file.resolve())
    bpy.ops.render.render(write_still=True)


def render_film(path):
    """Render all frames of the loop, into a folder of pictures or a film."""
    import bpy

    scene = bpy.context.scene
    if path.suffix.lower() == ".mp4":
        if bpy.app.version >= (5, 0, 0):
            scene.render.image_settings.media_type = "VIDEO"
        scene.render.image_settings.file_format = "FFMPEG"
        scene.render.ffmpeg.format = "MPEG4"
        scene.render.filepath = str(path.resolve())
    else:
        path.mkdir(parents=True, exist_ok=True)
        scene.render.image_settings.file_format = "PNG"
        scene.render.filepath = str(path.resolve()) + "/"
    bpy.ops.render.render(animation=True)


def main():
    """Make the scene of a folder, and what is asked for."""
    given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    options = flags().parse_args(given)
    import bpy
    import look

    packed = (options.folder / "sea.json").is_file()
    if not packed and not (options.folder / "manifest.json").is_file():
        sys.exit(f"{options.folder} must hold sea.json (a package) or manifest.json (a bake)")
    frames = package_scene(options) if packed else bake_scene(options)
    look.sky(*options.sun, options.exposure)
    bpy.context.scene.frame_set(1)
    print(f"{frames} frames from {'a package' if packed else 'a bake'}: {options.folder}")
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.save.resolve()))
    if options.still:
        render_still(options.still, options.frame)
    if options.film:
        render_film(options.film)


if __name__ == "__main__":
    main()
