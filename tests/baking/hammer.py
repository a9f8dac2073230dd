"""
Random faults in bakes of every format: kills, flipped bits, cut, missing and exchanged files.

    python tests/baking/hammer.py --kills 50 --flips 200 --cuts 20 --deletions 20 --swaps 10

It prints a line of figures for each kind of fault, and exits with 1 if a bake was taken for
complete that was not, if its bytes in the end differ from those of an undisturbed one, or if
`check` missed a fault.
"""

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import fftocean as fo
from fftocean.baking.finished.check import check
from fftocean.baking.repair import repair
from fftocean.export.formats import FORMATS

HEIGHTS = ("height", "jacobian", "foam")
VECTORS = ("height", "displacement", "normal")


def job(name, n=32, frames=20):
    """A small bake in a format, of maps that it holds."""
    maps = HEIGHTS if name == "r16" else VECTORS
    return fo.Job.default().replaced(
        {"ocean.n": n, "bake.frames": frames, "bake.maps": list(maps), "bake.format": name}
    )


def tree(folder):
    """Every file under a folder with its bytes."""
    return {
        str(p.relative_to(folder)): p.read_bytes()
        for p in sorted(Path(folder).rglob("*"))
        if p.is_file()
    }


def command(sea_job, folder):
    """A bake as a process of its own, with two workers."""
    flags = [
        "--n",
        sea_job.settings["ocean.n"],
        "--frames",
        sea_job.frames,
        "--maps",
        ",".join(sea_job.maps),
        "--format",
        sea_job.format,
    ]
    words = ["bake", "-o", folder, *flags, "--executor", "processes", "--workers", 2, "--quiet"]
    return [sys.executable, "-m", "fftocean", *map(str, words)]


def environment():
    return {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(
            [str(Path(fo.__file__).parent.parent), os.environ.get("PYTHONPATH", "")]
        ),
    }


def undisturbed(sea_job, folder):
    """A bake left alone, and how long it took as a process."""
    start = time.monotonic()
    subprocess.run(command(sea_job, folder), env=environment(), check=True, capture_output=True)
    return tree(folder), time.monotonic() - start


def kills(sea_job, place, count, chance, number=signal.SIGKILL):
    """
    Kill a bake at random moments, each time another one, until it is done; `count` kills in all,
    over several bakes.

    Returns (kills, bakes, false "complete", bakes whose bytes differ in the end, exit codes).
    """
    expected, seconds = undisturbed(sea_job, place / "undisturbed")
    done, bakes, false, different, codes = 0, 0, 0, 0, set()
    while done < count:
        folder = place / f"killed-{bakes}"
        bakes += 1
        for _ in range(4):  # times that one bake is killed
            process = subprocess.Popen(
                command(sea_job, folder),
                env=environment(),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            time.sleep(chance.uniform(0.2, 1.0) * seconds)
            process.send_signal(number)
            codes.add(process.wait())
            done += 1
            left = (
                {name: data for name, data in tree(folder).items() if not name.startswith(".")}
                if folder.exists()
                else {}
            )
            false += "manifest.json" in left and any(
                left.get(name) != data for name, data in expected.items()
            )
            if done == count:
                break
        subprocess.run(command(sea_job, folder), env=environment(), check=True, capture_output=True)
        different += tree(folder) != expected
        shutil.rmtree(folder)
    return done, bakes, false, different, codes


def faults(sea_job, place, counts, chance):
    """
    Do every kind of damage to a bake, one at a time, see whether `check` names the file, and mend
    it.

    Returns {kind: (done, named, mended)}.
    """
    folder = place / sea_job.format
    fo.bake(sea_job, folder, executor="serial")
    expected = tree(folder)
    assert not check(folder), check(folder)
    figures = {}
    for kind, count in counts.items():
        named = mended = 0
        for i in range(count):
            hurt = damage(kind, folder, expected, chance)
            found = check(folder)
            named += all(any(name == finding.path for finding in found) for name in hurt)
            if i % 5 == 0:  # the others are put back by hand, which is quicker
                repair(folder, executor="serial")
                mended += tree(folder) == expected
            for name in hurt:
                (folder / name).write_bytes(expected[name])
        figures[kind] = count, named, mended, len(range(0, count, 5))
    shutil.rmtree(folder)
    return figures


def damage(kind, folder, expected, chance):
    """Damage a bake in one place, and return the files in which."""
    frames = [
        name
        for name in expected
        if name not in ("job.json", "manifest.json", "preview.png", "preview.webp")
    ]
    name = chance.choice(sorted(expected))
    data = bytearray(expected[name])
    if kind == "flips":
        at = chance.randrange(8 * len(data))
        data[at // 8] ^= 1 << at % 8
        (folder / name).write_bytes(data)
    elif kind == "cuts":
        (folder / name).write_bytes(data[: chance.randrange(len(data))])
    elif kind == "deletions":
        (folder / name).unlink()
    else:
        pairs = [(a, b) for a in frames for b in frames if a < b and expected[a] != expected[b]]
        name, other = chance.choice(pairs)
        (folder / name).write_bytes(expected[other])
        (folder / other).write_bytes(expected[name])
        return [name, other]
    return [name]


def main(arguments=None):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for name, default in (
        ("kills", 50),
        ("flips", 200),
        ("cuts", 20),
        ("deletions", 20),
        ("swaps", 10),
        ("n", 32),
        ("frames", 20),
        ("seed", 1),
    ):
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--formats", nargs="+", default=list(FORMATS), choices=list(FORMATS))
    options = parser.parse_args(arguments)
    warnings.simplefilter("ignore", fo.SeaWarning)
    chance, bad = random.Random(options.seed), 0
    with tempfile.TemporaryDirectory() as place:
        if options.kills:
            for name, share in (("exr", 0.6), ("ktx2", 0.4)):
                sea_job = job(name, options.n, options.frames)
                count = round(share * options.kills)
                done, bakes, false, different, _ = kills(
                    sea_job, Path(place) / f"kills-{name}", count, chance
                )
                same = f"{bakes - different} of {bakes} with the same bytes"
                print(
                    f"kill -9, {name}: {done} kills of {bakes} bakes, {false} false "
                    f"complete, {same}",
                    flush=True,
                )
                bad += false + different
        wanted = {kind: getattr(options, kind) for kind in ("flips", "cuts", "deletions", "swaps")}
        totals = dict.fromkeys(wanted, (0, 0, 0, 0))
        for i, name in enumerate(options.formats):
            share = {
                kind: count * (i + 1) // len(options.formats) - count * i // len(options.formats)
                for kind, count in wanted.items()
            }
            for kind, figures in faults(
                job(name, options.n, options.frames), Path(place), share, chance
            ).items():
                totals[kind] = tuple(a + b for a, b in zip(totals[kind], figures, strict=True))
        for kind, (done, named, mended, tried) in totals.items():
            print(
                f"{kind}: {done} over {len(options.formats)} formats, {named} named, "
                f"{mended} of {tried} mended to the same bytes"
            )
            bad += done - named + tried - mended
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
