"""
Tables of docs/live.md: parameters and keys of the live page, from their one table.

`python tools/live_tables.py` writes them between the markers; with `--check` it fails if the page
is stale.
"""

import math
import sys
from pathlib import Path

from fftocean.view.parameters import ACTIONS, PARAMETERS, Parameter

PAGE = Path(__file__).resolve().parents[1] / "docs" / "live.md"
NAMED_KEYS = {" ": "Space"}


def range_of(parameter: Parameter) -> str:
    """Return the values of a parameter's control, with their unit."""
    if parameter.choices:
        return ", ".join(f"`{choice}`" for choice in parameter.choices)
    if parameter.low is None or parameter.high is None:
        return "on, off"
    text = f"{parameter.low:,g} to {parameter.high:,g}"
    unit = parameter.quantity.unit if parameter.quantity else ""
    text += f" {unit}" if unit else ""
    return f"{text}, or {parameter.infinite}" if parameter.infinite else text


def default_of(parameter: Parameter) -> str:
    """Return the default of a parameter as the table shows it."""
    value = parameter.default
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, float) and math.isinf(value):
        return str(parameter.infinite)
    return f"{value:,g}" if isinstance(value, int | float) else f"`{value}`"


def keys_of(parameter: Parameter) -> str:
    """Return the keys of a parameter: down and up, or the one that steps through its values."""
    keys = [parameter.key_down, parameter.key_up]
    return " ".join(f"`{key.upper()}`" for key in keys if key)


def parameter_table() -> str:
    """Return the table of parameters."""
    lines = ["| group | control | range | default | keys | meaning |", "|---|---|---|---|---|---|"]
    group = None
    for parameter in sorted(PARAMETERS, key=lambda p: list(groups()).index(p.group)):
        shown = parameter.group if parameter.group != group else ""
        group = parameter.group
        cells = (
            *(shown, parameter.label, range_of(parameter), default_of(parameter)),
            *(keys_of(parameter), parameter.help),
        )
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def groups() -> dict[str, None]:
    """Return the groups of parameters in the order of their first."""
    return dict.fromkeys(parameter.group for parameter in PARAMETERS)


def action_table() -> str:
    """Return the table of the keys that are no parameter's."""
    lines = ["| key | action |", "|---|---|"]
    for action in ACTIONS:
        lines.append(f"| `{NAMED_KEYS.get(action.key, action.key.upper())}` | {action.label} |")
    return "\n".join(lines)


def filled(text: str) -> str:
    """Return a page with the tables between its markers."""
    for name, table in (("parameters", parameter_table()), ("actions", action_table())):
        start, end = f"<!-- {name} -->\n", f"\n<!-- end of {name} -->"
        before, found, rest = text.partition(start)
        _, ended, after = rest.partition(end)
        if not found or not ended:
            raise SystemExit(f"{PAGE.name} must hold the markers {start.strip()} and {end.strip()}")
        text = before + start + table + end + after
    return text


if __name__ == "__main__":
    old = PAGE.read_text(encoding="utf-8")
    new = filled(old)
    if "--check" in sys.argv and new != old:
        raise SystemExit(f"{PAGE.name} is stale: run python tools/live_tables.py")
    PAGE.write_text(new, encoding="utf-8")
