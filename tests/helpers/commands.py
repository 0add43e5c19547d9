"""The command line in this process, as the tests call it, and Python in another."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from comparisons.cli import main
from sheetbench.kernels import NOTICE


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as caught:
        main(list(arguments))
    return int(caught.value.code or 0)


def python(
    *arguments: str, place: Path | None = None, **environment: str | None
) -> subprocess.CompletedProcess[str]:
    """Run Python in a folder, with variables set or, where None, unset."""
    env = {name: value for name, value in (os.environ | environment).items() if value is not None}
    command = [sys.executable, *arguments]
    return subprocess.run(command, env=env, cwd=place, capture_output=True, text=True, timeout=300)


def json_of(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    """Return the JSON document of a command line that succeeds."""
    assert run(*arguments, "--json") == 0
    return json.loads(capsys.readouterr().out)


def one_line(capsys: pytest.CaptureFixture[str]) -> str:
    """Return the one line on standard error, without a traceback, beside which there may be the notice that
    kernels are compiled and how far a solve is that takes so long; nothing is on standard output."""
    printed = capsys.readouterr()
    assert printed.out == ""
    every = printed.err.splitlines(keepends=True)
    lines = [line for line in every if NOTICE not in line and not line.startswith("solving ")]
    assert len(lines) == 1 and lines[0].endswith("\n")
    assert "Traceback" not in printed.err
    return lines[0]
