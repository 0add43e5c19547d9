"""The command line against a system that is against it: outputs, names, terminals' sizes, files."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = (sys.executable, "-m", "sheetbench")


@pytest.mark.sweep(2)
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
@pytest.mark.parametrize("arguments", [("check",), ("check", "--json"), ("--help",), ("--version",)], ids=str)
def test_an_output_that_cannot_be_written_is_said_in_a_line(arguments):
    with open("/dev/full", "wb") as full:
        done = subprocess.run([*PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2
    assert done.stderr == "sheetbench: the output cannot be written: no space left on device\n"


def test_a_size_of_the_terminal_that_cannot_be_counts_for_nothing():
    plain = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    usual, *odd = (
        subprocess.run([*PROGRAM, "--help"], env=plain | given, capture_output=True, text=True)
        for given in ({}, {"COLUMNS": "0", "LINES": "²"}, {"COLUMNS": "9" * 12, "LINES": "0"})
    )
    for one in odd:
        assert (one.returncode, one.stdout, one.stderr) == (0, usual.stdout, "")


@pytest.mark.nightly
def test_a_drawing_needs_no_window_whatever_matplotlib_is_told(tmp_path):
    few = ["check", "one-edge-clamped", "--out", str(tmp_path)]
    environment = {**os.environ, "MPLBACKEND": "nope"}
    done = subprocess.run([*PROGRAM, *few], env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and "nope" not in done.stderr and list(tmp_path.glob("*.png"))
