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


SIMULATE = ["simulate", "two-edges-settling", "--lumped", "3", "--duration", "500", "--out", "kept"]
COMPARE = ["compare", "two-edges-clamped", "--out", "kept"]
TRADEOFF = ["tradeoff", "two-edges-clamped", "--solid", "48", "--workers", "2", "--out", "kept"]


@pytest.mark.sweep
@pytest.mark.parametrize(("code", "arguments", "begun", "left"), [
    (DEAF, COMPARE, "solving", "files written so far are in kept"),
    (COMMAND, SIMULATE, "of 500 s", "the same command goes on"),
    (COMMAND, TRADEOFF, "0/", "the same command goes on"),
], ids=["compare", "simulate", "tradeoff"])  # fmt: skip
def test_a_long_command_is_interrupted(tmp_path, monkeypatch, code, arguments, begun, left):
    monkeypatch.chdir(tmp_path)
    terminal = Terminal(code, *arguments)
    terminal.wait_for(begun)
    terminal.press(CTRL_C)
    assert terminal.end() == interruption.STATUS
    assert f"interrupted; {left}" in terminal.shown
    assert "Traceback" not in terminal.shown and "Error" not in terminal.shown


LINGERS = """
import atexit, sys, time
from comparisons.cli import main
atexit.register(lambda: (print("clearing up", flush=True), time.sleep(1.0)))
main()
"""


@pytest.mark.nightly
def test_a_second_interrupt_shows_no_traceback(tmp_path, monkeypatch):
    """It met what was being cleared up, and the end of the interpreter."""
    monkeypatch.chdir(tmp_path)
    terminal = Terminal(
        LINGERS, "stability", "one-edge-clamped", "--vary", "load", "--workers", "1", "--out", "kept"
    )
    terminal.wait_for("0/")
    terminal.press(CTRL_C)
    terminal.press(CTRL_C)
    terminal.wait_for("clearing up")
    terminal.press(CTRL_C)
    assert terminal.end() == interruption.STATUS
    assert "Traceback" not in terminal.shown and "Error" not in terminal.shown
