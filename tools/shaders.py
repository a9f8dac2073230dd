"""
Kernels in GLSL and Metal, generated from `fftocean/runtime/shaders/fftocean.hlsl`.

`python tools/shaders.py` writes them; with `--check` it fails if they are stale. Their first lines
have the SHA-256 of the source and the versions of the tools. Other versions may write other text:
so where the tools are not those recorded, only the checksum is compared.
"""

import hashlib
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from fftocean.runtime.shaders import ENTRY_POINTS, GENERATED

FOLDER = Path(__file__).resolve().parents[1] / "fftocean" / "runtime" / "shaders"
SOURCE = FOLDER / "fftocean.hlsl"
TOOLS = ("glslangValidator", "spirv-cross")
FORMAT = "FFTOCEAN_IMAGE_FORMAT=[[spv::format_rgba16f]] [[spv::nonreadable]]"
"""Definition by which SPIR-V has the format of the texture that `textures` writes."""

BLOCKS = {"Sea": "sea", "Target": "target_level"}
"""Names of constant buffers, which have none in HLSL: tools give them numbers."""

CHECKED = {
    "glsl": "Compiled by glslangValidator and run on Vulkan (lavapipe), where fields equal those "
    "of the other languages.",
    "metal": "Not run: no Metal compiler was at hand. The same SPIR-V as that of the GLSL kernels, "
    "which are run.",
}


def missing_tools() -> list[str]:
    """Return the tools that are not installed."""
    return [tool for tool in TOOLS if not shutil.which(tool)]


def output_of(*command: str | Path) -> str:
    """Return what a command prints; raise with its messages if it fails."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    if done.returncode:
        raise SystemExit(f"{command[0]} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


def tool_versions() -> str:
    """Return the versions of the tools, as the generated files record them."""
    glslang = output_of("glslangValidator", "--version").splitlines()[0]
    # spirv-cross has no version but a revision, which Debian's does not tell
    cross = " ".join(output_of("spirv-cross", "--revision").split())
    if shutil.which("dpkg-query"):
        found = subprocess.run(
            ["dpkg-query", "-W", "-f=${Version}", "spirv-cross"], capture_output=True, text=True
        )
        cross = found.stdout or cross
    return f"{glslang}; spirv-cross {cross}"


def spirv_of(entry: str, file: Path) -> None:
    """Compile an entry point of the source; without optimisation, names and functions are kept."""
    output_of(
        *("glslangValidator", "-D", "-S", "comp", "-e", entry, "-V", "-g", "-Od"),
        *(f"-D{FORMAT}", "-o", file, SOURCE),
    )


def generated(entry: str, language: str) -> str:
    """Return the text of a kernel in a language, without its first lines."""
    with tempfile.TemporaryDirectory() as folder:
        binary = Path(folder) / "kernel.spv"
        spirv_of(entry, binary)
        flags = {
            "glsl": ("-V", "--version", "450"),
            # buffers keep their numbers: by default each kernel would count its own from 0
            "metal": ("--msl", "--msl-decoration-binding"),
        }[language]
        text = output_of("spirv-cross", *flags, "--remove-unused-variables", binary)
    for block, name in BLOCKS.items():
        found = re.search(
            rf"uniform {block}\n\{{.*?\n\}} (_\d+);|constant {block}& (v_\d+)", text, re.DOTALL
        )
        if found:
            text = re.sub(rf"\b{found.group(1) or found.group(2)}\b", name, text)
    return "\n".join(line.rstrip() for line in text.splitlines()) + "\n"


def source_digest() -> str:
    """Return the SHA-256 of the source."""
    return hashlib.sha256(SOURCE.read_bytes()).hexdigest()


def head_of(entry: str, language: str, tools: str) -> str:
    """Return the first lines of a generated file."""
    return (
        f"// {CHECKED[language]}\n"
        f"// Kernel `{entry}` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.\n"
        f"// Source: fftocean.hlsl, SHA-256 {source_digest()}\n"
        f"// Tools: {tools}\n"
    )


def file_of(entry: str, language: str) -> Path:
    """Return the file of a kernel in a language."""
    return FOLDER / f"fftocean_{entry}.{language}"


def recorded(file: Path) -> tuple[str | None, str | None]:
    """Return the checksum of the source and the tools that a generated file records."""
    if not file.exists():
        return None, None
    text = file.read_text(encoding="utf-8")
    patterns = (r"^// Source: fftocean\.hlsl, SHA-256 (\w+)$", r"^// Tools: (.*)$")
    found = [re.search(pattern, text, re.MULTILINE) for pattern in patterns]
    return found[0] and found[0].group(1), found[1] and found[1].group(1)


def stale() -> list[str]:
    """Return a sentence for each generated file that is not current."""
    found = []
    expected = {file_of(entry, language) for entry in ENTRY_POINTS for language in GENERATED}
    there = {file for language in GENERATED for file in FOLDER.glob(f"*.{language}")}
    found += [f"{file.name} belongs to no kernel" for file in sorted(there - expected)]
    tools = None if missing_tools() else tool_versions()
    for language in GENERATED:
        for entry in ENTRY_POINTS:
            file = file_of(entry, language)
            digest, made_by = recorded(file)
            if digest != source_digest():
                found.append(f"{file.name} is not of the present fftocean.hlsl")
            elif made_by == tools:
                wanted = head_of(entry, language, tools) + generated(entry, language)
                if file.read_bytes() != wanted.encode():
                    found.append(f"{file.name} is not what these tools generate")
    return found


def write() -> None:
    """Write all generated files."""
    tools = tool_versions()
    for language in GENERATED:
        for entry in ENTRY_POINTS:
            text = head_of(entry, language, tools) + generated(entry, language)
            file_of(entry, language).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if "--check" in sys.argv:
        if problems := stale():
            raise SystemExit("\n".join([*problems, "run python tools/shaders.py"]))
    elif missing := missing_tools():
        raise SystemExit(f"{' and '.join(missing)} must be installed: see tests/clients/install")
    else:
        write()
