"""Combinations of options: every pair of values of any two dimensions in one row at least; and a row's run.

`pairwise` is greedy: a row starts with a pair that no row has yet, and every other dimension takes the value
that brings most new pairs. It needs about as many rows as the product of the two largest dimensions.
"""

import json
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import pytest
from commands import run

from comparisons.cli.output import Output
from sheetbench.answers.answer import Answer

LONGEST = 400  # characters of a refusal with its paths
Row = tuple[tuple[str, ...], ...]


def pairwise(dimensions: Sequence[Sequence[tuple[str, ...]]]) -> list[Row]:
    """Return rows with every pair of values of two dimensions."""
    left = {
        (i, a, j, b)
        for i, j in combinations(range(len(dimensions)), 2)
        for a in range(len(dimensions[i]))
        for b in range(len(dimensions[j]))
    }
    rows = []
    while left:
        i, a, j, b = min(left)
        taken = {i: a, j: b}
        for k, values in enumerate(dimensions):
            if k not in taken:
                gains = [sum(_pair(k, v, m, w) in left for m, w in taken.items()) for v in range(len(values))]
                taken[k] = gains.index(max(gains))
        left -= {_pair(m, taken[m], n, taken[n]) for m, n in combinations(taken, 2)}
        rows.append(tuple(dimensions[k][taken[k]] for k in range(len(dimensions))))
    return rows


def _pair(i: int, a: int, j: int, b: int) -> tuple[int, int, int, int]:
    return (i, a, j, b) if i < j else (j, b, i, a)


def named(row: Row) -> str:
    """Return a row as a test's name."""
    return " ".join(part for options in row for part in options) or "-"


def check(
    arguments: Sequence[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> int:
    """Run a command line: no traceback, exit status 0, 2 or 3, a document with --json unless it is refused, a
    refusal in few words, and each converged answer in balance."""
    answers: list[Answer] = []
    show = Output.show

    def shown(self: Output, answer: Answer, instead: str | None = None) -> None:
        answers.append(answer)
        show(self, answer, instead)

    monkeypatch.setattr(Output, "show", shown)
    status = run(*arguments)
    output = capsys.readouterr()
    assert "Traceback" not in output.err, output.err[-3000:]
    assert status in (0, 2, 3), output.err
    if status == 2:
        assert output.err.strip() and not answers and not output.out
        assert len(output.err.splitlines()[-1]) <= LONGEST, output.err
        for kind in ("option", "command"):  # the row means something
            assert f"No such {kind}" not in output.err, output.err
    elif "--json" in arguments:
        json.loads(output.out)
    for answer in answers:
        for solution in answer.document().get("solutions", ()):
            require_balanced(solution)
    return status


def require_balanced(solution: Mapping[str, Any]) -> None:
    """Fail where a converged answer's forces or moments do not balance."""
    balance = solution.get("balance")
    if solution.get("status") == "converged" and balance is not None:
        assert balance["holds"], f"{solution['label']}: converged, and {balance}"
