"""The directive `run` of MyST pages: commands, and what they print, run when the site is built.

    ```{run}
    sheetbench compare two-edges-clamped --no-pictures
    ```

The commands of a page share one folder, so that a later one may read what an earlier one wrote. A command
that does not end with status 0 is an error of the build.
"""

import os
import shlex
import subprocess
import sys
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from docutils import nodes
from sphinx.errors import ExtensionError
from sphinx.util.docutils import SphinxDirective

COLUMNS = 82
FOLDERS: dict[str, Path] = {}  # of a page, in this build: a later one starts with empty folders
BUSY = "times are not reliable"  # of the machine that builds the site
ROWS = 45  # of one command's output; what is longer is cut, and says so


def printed(command: str, folder: Path) -> str:
    """Return what a command line of sheetbench prints to a terminal of COLUMNS columns, run in a folder.

    Raises ExtensionError where it does not end with status 0.
    """
    _, *words = shlex.split(command, comments=True)
    done = subprocess.run(
        [sys.executable, "-m", "sheetbench", *words],
        cwd=folder,
        env=os.environ | {"COLUMNS": str(COLUMNS), "FORCE_COLOR": "1", "TERM": "dumb"},  # as a plain terminal
        capture_output=True,
        text=True,
    )
    if done.returncode:
        raise ExtensionError(f"{command}: status {done.returncode}\n{done.stderr}")
    lines = done.stdout.strip("\n").splitlines()
    lines = [line for line in lines if not line.startswith(BUSY)]
    cut = [f"… ({len(lines) - ROWS} more lines)"] if len(lines) > ROWS else []
    return "\n".join([line.rstrip() for line in lines[:ROWS]] + cut)


class Run(SphinxDirective):
    """Commands of sheetbench as a block of code, each followed by what it prints."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return a block a command, and one with its output."""
        folder = FOLDERS.setdefault(self.env.docname, Path(mkdtemp()))
        blocks: list[nodes.Node] = []
        for command in (line for line in self.content if line.strip()):
            text = printed(command, folder)
            blocks.append(nodes.literal_block(command, command, language="sh"))
            if text:
                blocks.append(nodes.literal_block(text, text, language="text"))
        return blocks


def setup(app: Any) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("run", Run)
    return {"parallel_read_safe": False}
