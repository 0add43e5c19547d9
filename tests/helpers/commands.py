"""The command line in this process, as the tests call it, and Python in another."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from comparisons.cli import main


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as caught:
        main(list(arguments))
    return int(caught.value.code or 0)


def python(
    *arguments: str, place: Path | None = None, **environment: str | None
) -> subprocess.CompletedProcess[str]:
    """A process of Python in a folder, with variables set or, where None, unset."""
    env = {name: value for name, value in (os.environ | environment).items() if value is not None}
    command = [sys.executable, *arguments]
    return subprocess.run(command, env=env, cwd=place, capture_output=True, text=True, timeout=300)


def json_of(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    """The JSON document of a command line that answers."""
    assert run(*arguments, "--json") == 0
    return json.loads(capsys.readouterr().out)


def one_line(capsys: pytest.CaptureFixture[str]) -> str:
    """What was said on standard error: one line and no traceback, and nothing on standard output."""
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.count("\n") == 1 and printed.err.endswith("\n")
    assert "Traceback" not in printed.err
    return printed.err
