"""Sources of the live page: they pass their own checks, and the bundle in the package is theirs."""

import subprocess

import pytest
from conftest import LIVE

pytestmark = [pytest.mark.client, pytest.mark.process]


@pytest.mark.usefixtures("live_tools")
@pytest.mark.parametrize(
    "command",
    [("run", "lint"), ("test",), ("run", "build", "--", "--check")],
    ids=["lint", "unit tests", "bundle"],
)
def test_the_sources_pass(command):
    """eslint and prettier; node's own test runner; and the bundle byte by byte."""
    done = subprocess.run(
        ["npm", *command], cwd=LIVE.parent, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stdout + done.stderr
