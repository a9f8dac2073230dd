"""
Sources and generated files of the kernels: they are current, and name the same bindings.
"""

import re
import subprocess
import sys

import pytest
import shaders as tool
from builders import ROOT
from kernel_layout import SEA_BYTES, TABLE, TILE_BYTES
from kernel_sources import require_command

from fftocean.errors import ParameterError
from fftocean.runtime import shaders

ENTRIES = shaders.ENTRY_POINTS
PAGE = (ROOT / "docs" / "kernels.md").read_text(encoding="utf-8")


def text(language, entry=None):
    """Return a source, or the generated file of a kernel."""
    found = shaders.files(language)
    return found[f"fftocean_{entry}.{language}" if entry else f"fftocean.{language}"].decode()


def without_comments(source):
    """Return a shader without its comments."""
    return re.sub(r"//[^\n]*", "", source)


@pytest.mark.parametrize("language", shaders.LANGUAGES)
def test_each_language_has_every_kernel(language):
    found = shaders.files(language)
    assert tuple(found) == shaders.names(language)
    assert len(found) == (1 if language in shaders.SOURCES else len(ENTRIES))
    everything = b"".join(found.values()).decode()
    for entry in ENTRIES:
        assert re.search(rf"\b(fn|void) _?{entry}\(", everything)


def test_another_language_is_refused():
    with pytest.raises(ParameterError, match="wgsl, hlsl, glsl, metal, got 'cuda'"):
        shaders.files("cuda")


def test_generated_files_are_of_the_present_source():
    """
    The checksum of the source, always; and each byte, where the tools are those that made them.
    """
    assert tool.stale() == []


@pytest.mark.client
def test_generated_files_are_what_their_tools_make():
    """The tools that are there, even others than recorded, accept the source."""
    for command in tool.TOOLS:
        require_command(command)
    for language, head in (("glsl", "void main()"), ("metal", "kernel void foam(")):
        assert head in tool.generated("foam", language)


def test_a_stale_file_is_told(tmp_path, monkeypatch):
    """After a change of the source, of a generated file, and with one that belongs to no kernel."""
    for file in tool.FOLDER.iterdir():
        if file.suffix in (".hlsl", ".glsl", ".metal"):
            (tmp_path / file.name).write_bytes(file.read_bytes())
    monkeypatch.setattr(tool, "FOLDER", tmp_path)
    monkeypatch.setattr(tool, "SOURCE", tmp_path / "fftocean.hlsl")
    # the tools stand still: only the checksum decides
    monkeypatch.setattr(tool, "missing_tools", lambda: ["spirv-cross"])
    assert tool.stale() == []
    (tmp_path / "fftocean_old.glsl").write_text("")
    assert tool.stale() == ["fftocean_old.glsl belongs to no kernel"]
    (tmp_path / "fftocean_old.glsl").unlink()
    (tmp_path / "fftocean_foam.metal").unlink()
    assert tool.stale() == ["fftocean_foam.metal is not of the present fftocean.hlsl"]
    with tool.SOURCE.open("a") as source:
        source.write("// one more line\n")
    assert len(tool.stale()) == 2 * len(ENTRIES)


@pytest.mark.client
def test_a_changed_byte_is_told(tmp_path, monkeypatch):
    """By the tools that made the file."""
    for command in tool.TOOLS:
        require_command(command)
    if tool.recorded(tool.file_of("foam", "glsl"))[1] != tool.tool_versions():
        pytest.skip("the tools are not those that made the committed files")
    for file in tool.FOLDER.iterdir():
        if file.suffix in (".hlsl", ".glsl", ".metal"):
            (tmp_path / file.name).write_bytes(file.read_bytes())
    monkeypatch.setattr(tool, "FOLDER", tmp_path)
    changed = tool.file_of("foam", "glsl")
    changed.write_text(changed.read_text().replace("0.25", "0.35"))
    assert tool.stale() == ["fftocean_foam.glsl is not what these tools generate"]


@pytest.mark.process
def test_the_tool_checks():
    command = [sys.executable, ROOT / "tools" / "shaders.py", "--check"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


@pytest.mark.parametrize("language", shaders.LANGUAGES)
def test_no_sine_of_the_platform_is_used(language):
    """Such sines are only good to 2^-11, and transforms take their twiddle factors of a table."""
    for name, source in shaders.files(language).items():
        found = re.findall(r"\b(sin|cos|sincos|tan)\s*\(", without_comments(source.decode()))
        assert not found, name


def test_no_pointer_to_workgroup_memory_is_passed():
    """Firefox's compiler refuses such functions."""
    assert "ptr<" not in without_comments(text("wgsl"))


def test_workgroup_memory_is_what_webgpu_promises():
    found = re.findall(r"var<workgroup> \w+: array<vec4f, (\d+)>;", text("wgsl"))
    assert [int(count) * 16 for count in found] == [16384]
    assert re.findall(r"groupshared float4 \w+\[(\d+)\];", text("hlsl")) == found


def page_bindings():
    """Return the names that each kernel reads or writes, from the table of the page."""
    rows = re.findall(
        r"^\| `(\w+)` \| [\dx ]+ \|[^|]*\| ([^|]*) \| ([^|]*) \|$", PAGE, re.MULTILINE
    )
    return {
        kernel: set(re.findall(r"`(\w+)`", reads + writes.partition(":")[0]))
        for kernel, reads, writes in rows
    }


def page_numbers():
    """Return the number of each binding, from the table of the page."""
    rows = re.findall(r"^\| (\d) \| `(\w+)` \| [btu](\d) \|", PAGE, re.MULTILINE)
    assert [number for number, _, _ in rows] == [register for _, _, register in rows]
    return {name: int(number) for number, name, _ in rows}


def test_the_page_has_every_kernel_and_binding():
    assert set(page_bindings()) == set(ENTRIES)
    assert sorted(page_numbers().values()) == list(range(10))


@pytest.mark.parametrize("entry", ENTRIES)
def test_generated_kernels_have_the_bindings_of_the_page(entry):
    expected = {page_numbers()[name] for name in page_bindings()[entry]}
    glsl, metal = text("glsl", entry), text("metal", entry)
    assert {int(n) for n in re.findall(r"set = 0, binding = (\d+)", glsl)} == expected
    # Metal passes a buffer that only another kernel needs to the functions they share; no more
    head = metal.rpartition("kernel void")[2].partition("{")[0]
    numbers = {int(n) for n in re.findall(r"\[\[(?:buffer|texture)\((\d+)\)\]\]", head)}
    assert numbers == expected


def test_wgsl_has_the_bindings_of_the_page():
    found = re.findall(r"@binding\((\d)\) var(?:<[\w, ]+>)? (\w+):", text("wgsl"))
    renamed = {"target_level": "target"}
    assert {renamed.get(name, name): int(n) for n, name in found} == page_numbers()


SIZES = {"uint": 4, "int": 4, "float": 4, "uint2": 8, "int2": 8, "float2": 8, "float4": 16}


def struct_layout(source, name):
    """Return {member: offset} and the size of a struct of Metal, by C++'s rules of alignment."""
    body = re.search(rf"struct {name}\n\{{(.*?)\n\}};", source, re.DOTALL).group(1)
    offsets, at, widest = {}, 0, 4
    for kind, member, count in re.findall(r"(\w+) (\w+)(?:\[(\d+)\])?;", body):
        size = struct_layout(source, kind)[1] if kind == "Tile" else SIZES[kind]
        align = 16 if kind == "Tile" else SIZES[kind]
        at = -(-at // align) * align
        offsets[member] = at
        at += size * int(count or 1)
        widest = max(widest, align)
    return offsets, -(-at // widest) * widest


@pytest.mark.parametrize("entry", ENTRIES)
def test_metal_has_the_offsets_of_the_page(entry):
    """Its structs have no offsets of their own: they follow from the members' alignment."""
    metal = text("metal", entry)
    offsets, size = struct_layout(metal, "Sea")
    assert size == SEA_BYTES
    assert offsets["table"] == TABLE
    listed = {name: int(at) for at, name in re.findall(r"\| (\d+) \| `(\w+)` [uif]", PAGE)}
    listed |= {"table": TABLE, "ny": 4}
    tile, size = struct_layout(metal, "Tile")
    assert size == TILE_BYTES
    for name, at in {**offsets, **tile}.items():
        if not name.startswith("unused"):
            assert listed[name] == at, name


def test_metal_says_that_it_was_not_run():
    for entry in ENTRIES:
        assert text("metal", entry).startswith("// Not run: no Metal compiler was at hand.")


@pytest.mark.parametrize("language", shaders.GENERATED)
@pytest.mark.parametrize("entry", ENTRIES)
def test_names_are_kept(language, entry):
    """Functions and variables of the source have their names, and no numbers in their place."""
    source = without_comments(text(language, entry))
    assert not re.findall(r"\b_\d+\b|\bv_\d+\b", source)
    assert "sea.table" in source
