"""Tables of docs/live.md."""

import re

from live_tables import PAGE, filled

from fftocean.view.parameters import ACTIONS, PARAMETERS


def test_the_tables_are_those_of_the_parameters():
    text = PAGE.read_text(encoding="utf-8")
    assert filled(text) == text, "run python tools/live_tables.py"


def test_every_key_is_listed_once():
    keys = re.findall(r"`([^`\n])`(?= |`| \|)", PAGE.read_text(encoding="utf-8"))
    wanted = [k for p in PARAMETERS for k in (p.key_down, p.key_up) if k]
    wanted += [action.key for action in ACTIONS if action.key != " "]
    assert sorted(keys) == sorted(key.upper() for key in wanted)
