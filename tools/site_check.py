"""
Check of a built site: `python tools/site_check.py FOLDER`.

Every link and picture within the site leads to a file, and to a place in it that exists; nothing is
loaded from another host; every picture has a text in its place. Prints what is wrong, and fails.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {"img": "src", "script": "src", "link": "href", "source": "src", "iframe": "src"}
"""Attributes whose address a browser loads by itself; `a` waits for a click."""


class Page(HTMLParser):
    """Links, places and pictures of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[tuple[str, str]] = []  # tag, address
        self.places: set[str] = set()
        self.silent: list[str] = []  # pictures without a text
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what a tag names."""
        found = dict(attrs)
        self.places |= {v for v in (found.get("id"), found.get("name")) if v}
        address = found.get("href" if tag == "a" else LOADED.get(tag, ""))
        if address:
            self.links.append((tag, address))
        if tag == "img" and not (found.get("alt") or "").strip():
            self.silent.append(found.get("src") or "")


def problems(folder: Path) -> list[str]:
    """Return what is wrong with a site, one line each."""
    pages = {
        path: Page(path.read_text(encoding="utf-8")) for path in sorted(folder.rglob("*.html"))
    }
    found = []
    for path, page in pages.items():
        name = path.relative_to(folder).as_posix()
        found += [f"{name}: picture without text: {source}" for source in page.silent]
        for tag, address in page.links:
            parts = urlsplit(address)
            if parts.scheme == "data":
                continue
            if parts.scheme or parts.netloc:
                if tag != "a":
                    found.append(f"{name}: loads {address}")
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file():
                found.append(f"{name}: no file {address}")
            elif parts.fragment and target in pages and parts.fragment not in pages[target].places:
                found.append(f"{name}: no place {address}")
    return found


def main(folder: str) -> int:
    """Print the problems of a site; return 1 if there are any."""
    root = Path(folder).resolve()
    found = problems(root)
    print("\n".join(found) or f"{len(list(root.rglob('*.html')))} pages: no problems found")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
