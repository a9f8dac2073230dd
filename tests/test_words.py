"""Plain words: first words of docstrings, length of lines, terms of the glossary."""

import ast
import io
import re
import tokenize
from functools import cache

import pytest
from builders import ROOT
from imports import PACKAGE, docstrings, questions, widths

METAPHORS = re.compile(
    r"""\b(
        crews? | ledgers? | seats? | seated | desks? | astern | borne\s+out | bears?\s+out
        | hirelings? | hire[sd]? | dismiss(es|ed)? | corridors? | whoever | how-manieth
        | squeezes? | squeezed | doors?
        | (?:this|that|one|another|whose|each|other)\s+rooms?
    )\b""",
    re.VERBOSE | re.IGNORECASE,
)
"""Words that stand for something else than they say."""

IN_NAMES = re.compile(r"\b(claims?|rooms?|hands?|guests?)\b", re.IGNORECASE)
"""Words that are plain English in a sentence, and are metaphors in a name."""

PARTS = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+")


PRONOUN = re.compile(r"(It|They)\b")
"""Words that no docstring begins with: a reader does not know yet what they stand for."""


@cache
def files():
    """Return the text of every source file of the package, by its path."""
    return texts(PACKAGE)


@cache
def all_files():
    """Return the text of every source file of package, tests and tools, but for this one."""
    folders = (PACKAGE, ROOT / "tests", ROOT / "tools", ROOT / "benchmarks")
    every = {path: text for folder in folders for path, text in texts(folder).items()}
    return {path: text for path, text in every.items() if path != "tests/test_words.py"}


def texts(folder):
    """Return the text of every source file below a folder, by its path."""
    return {
        path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(folder.rglob("*.py"))
        if "node_modules" not in path.parts  # npm packages of the page's tools
        if "node_modules" not in path.parts
    }


def metaphors(source):
    """Return (line, word) of every metaphor in docstrings, comments and names of a source."""
    found = []
    for line, text in docstrings(source):
        found += [(line, match.group()) for match in METAPHORS.finditer(text)]
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            text = token.string
        elif token.type == tokenize.NAME:
            text = " ".join(PARTS.findall(token.string))
            found += [(token.start[0], match.group()) for match in IN_NAMES.finditer(text)]
        else:
            continue
        found += [(token.start[0], match.group()) for match in METAPHORS.finditer(text)]
    return found


def test_no_docstring_begins_with_a_question_word():
    found = [
        f"{path}:{line}: {text}"
        for path, source in all_files().items()
        for line, text in questions(source)
    ]
    assert not found, "\n".join(found)


def test_no_docstring_begins_with_a_pronoun():
    found = [
        f"{path}:{line}: {text.splitlines()[0]}"
        for path, source in all_files().items()
        for line, text in docstrings(source)
        if PRONOUN.match(text)
    ]
    assert not found, "\n".join(found)


def test_no_line_is_longer_than_100_columns():
    found = [
        f"{path}:{i}: {width}"
        for path, source in all_files().items()
        for i, width in enumerate(widths(source), 1)
        if width > 100
    ]
    assert not found, "\n".join(found)


def test_no_metaphors_in_docstrings_comments_and_names():
    found = {}
    for path, source in all_files().items():
        for line, word in metaphors(source):
            found.setdefault(f"{path}: {word.lower()}, lines", []).append(str(line))
    assert not found, "\n".join(f"{where} {', '.join(lines)}" for where, lines in found.items())


def test_every_public_module_has_a_caption():
    assert [
        path for path, source in files().items() if not ast.get_docstring(ast.parse(source))
    ] == []


def test_captions_are_one_sentence_without_a_question():
    """A caption is a noun phrase: it ends with a full stop and asks nothing."""
    for path, source in files().items():
        caption = (ast.get_docstring(ast.parse(source)) or "").split("\n\n")[0]
        assert caption.endswith((".", ":")), f"{path}: {caption}"
        assert "?" not in caption, f"{path}: {caption}"


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("# the crew waits\n", ["crew"]),
        ("_desk = 1\n", ["desk"]),
        ("def hire_crew():\n    '''Return it.'''\n", ["hire", "crew"]),
        ("class CrewList:\n    pass\n", ["Crew"]),
        ("'''What the disk bears out.'''\n", ["bears out"]),
        ("message = 'a seat'\n", []),
        ("import foam as foam_room  # by hand\n", ["room"]),
        ("# room for one more; of this room\n", ["this room"]),
        ("# higher, hired, crewman, transept, desktop\n", ["hired"]),
    ],
)
def test_metaphors_are_found_where_they_stand(source, words):
    assert [word for _, word in metaphors(source)] == words


def test_terms_stand_in_the_glossary_once():
    page = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    terms = re.findall(r"^\| ([^|]+?) \|", page.partition("## Symbols")[0], re.MULTILINE)
    names = [
        name.strip("` ")
        for term in terms
        if term not in ("term", "---")
        for name in re.sub(r"\(.*?\)", "", term).split(",")
    ]
    assert len(names) > 80
    assert sorted({name for name in names if names.count(name) > 1} - {""}) == []
