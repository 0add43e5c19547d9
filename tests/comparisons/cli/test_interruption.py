"""Ctrl-C on a terminal: a line, status 130, no traceback, nobody left behind, and what was kept goes on."""

import pytest
from terminals import COMMAND, Terminal

from comparisons.cli import interruption

CTRL_C = b"\x03"
DEAF = """
from hashlib import pbkdf2_hmac
from comparisons.cli import main
from comparisons.models import solve
solve.warm = lambda model: None
solve._solve = lambda *_: pbkdf2_hmac("sha256", b"", b"", 2**31 - 1)  # an hour of native code
main()
"""
LINGERS = """
import atexit, sys, time
from comparisons.cli import main
atexit.register(lambda: (print("clearing up", flush=True), time.sleep(1.0)))
main()
"""


SIMULATE = ["simulate", "two-edges-settling", "--lumped", "3", "--duration", "500", "--out", "kept"]
COMPARE = ["compare", "two-edges-clamped", "--out", "kept"]
TRADEOFF = ["tradeoff", "two-edges-clamped", "--solid", "48", "--workers", "2", "--out", "kept"]
STABILITY = ["stability", "one-edge-clamped", "--vary", "load", "--workers", "1", "--out", "kept"]


@pytest.mark.sweep
@pytest.mark.parametrize(("code", "arguments", "begun", "left"), [
    (DEAF, COMPARE, "solving", "nothing was kept"),
    (COMMAND, SIMULATE, "of 500 s", "run the same command again to resume"),
    (COMMAND, TRADEOFF, "0/", "run the same command again to resume"),
    pytest.param(LINGERS, STABILITY, "0/", "", marks=pytest.mark.nightly),
], ids=["compare", "simulate", "tradeoff", "impatient"])  # fmt: skip
def test_a_long_command_is_interrupted(tmp_path, monkeypatch, code, arguments, begun, left):
    """By impatient people again, while it is cleared up and while the interpreter ends."""
    monkeypatch.chdir(tmp_path)
    terminal = Terminal(code, *arguments)
    terminal.wait_for(begun)
    terminal.press(CTRL_C)
    if code is LINGERS:
        terminal.press(CTRL_C)
        terminal.wait_for("clearing up")
        terminal.press(CTRL_C)
    assert terminal.end() == interruption.STATUS
    assert code is LINGERS or f"interrupted; {left}" in terminal.shown
    assert "Traceback" not in terminal.shown and "Error" not in terminal.shown


@pytest.mark.sweep
def test_an_interrupt_of_a_command_that_has_ended_changes_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    terminal = Terminal(LINGERS, "check", "two-edges-clamped")
    terminal.wait_for("clearing up")
    terminal.press(CTRL_C)
    assert terminal.end() == 0 and "Traceback" not in terminal.shown
