"""Requirements on every run: its exit status, its messages, its numbers, its folder."""

import contextlib
import io
import json
import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matrix_rows import LONGEST, require_balanced

from comparisons.cli import main

DONE, BAD_INPUT, NOT_CONVERGED = 0, 2, 3


@dataclass(frozen=True)
class Outcome:
    status: object
    out: str
    err: str


def outcome(arguments: Sequence[str], folder: Path) -> Outcome:
    """Run a command in this process, in a folder of its own; terminal and pipe as for a program."""
    out, err = io.StringIO(), io.StringIO()
    before, status = Path.cwd(), 0
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
            warnings.simplefilter("default")
            try:
                main(list(arguments))
            except SystemExit as leaving:
                status = leaving.code or 0
            except BaseException:
                traceback.print_exc(file=sys.stderr)
                status = 1
    finally:
        os.chdir(before)
    return Outcome(status, out.getvalue(), err.getvalue())


def held(result: Outcome, about: object) -> None:
    """Assert a documented status, no traceback, a refusal in one line at the end, no raw control
    characters."""
    said = f"{about!r} → {result.status}\n{result.out[-2000:]}\n{result.err[-6000:]}"
    assert result.status in (DONE, BAD_INPUT, NOT_CONVERGED), said
    assert "Traceback" not in result.out + result.err, said
    if result.status == BAD_INPUT:
        last = result.err.rstrip("\n").rpartition("\n")[2]
        assert last.strip() and len(last) <= LONGEST, said
        assert not result.out, said
    for text in (result.out, result.err):
        assert not any((c < " " and c not in "\n\t\r") or "\x7f" <= c < "\xa0" for c in text), said


def document(result: Outcome) -> Any:
    """Return the JSON document of a run, if any; assert that every number in it is finite."""

    def refuse(word: str) -> None:
        raise AssertionError(f"{word} in {result.out[:2000]}")

    return json.loads(result.out, parse_constant=refuse)


def in_balance(answer: dict[str, Any]) -> None:
    """Assert that a converged answer is in balance, with a displacement of every probe."""
    for solution in answer["solutions"]:
        require_balanced(solution)
        places = np.ravel(list(solution["probes"].values())).tolist()
        assert solution["status"] != "converged" or (places and None not in places), json.dumps(answer)


def files(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if not path.is_dir()}
