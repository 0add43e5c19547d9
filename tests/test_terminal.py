"""What people see on a terminal: every verb there as well as in a pipe."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from comparisons.cli import console
from comparisons.runs.campaign import Progress


@pytest.mark.parametrize("width", [50, 80, 160])
def test_a_campaigns_bar_stands_before_its_first_run_is_done(
    monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    screen = io.StringIO()
    monkeypatch.setattr(console, "err", Console(file=screen, force_terminal=True, width=width))
    with console.campaign_progress() as progress:
        progress(Progress(1, 3, "shell [2]", "converged", None))
        progress(Progress(3, 3, "shell [4]", "converged", 0.0))
    assert "starting" in screen.getvalue() and "3/3" in screen.getvalue() and "shell [4]" in screen.getvalue()
