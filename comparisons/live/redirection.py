"""How the browser learns the page's secret address: from a file that its user alone can read.

A browser gets what it is to open on its command line, which every user of the machine can read. So that is
the file's address, and the page's is in the file, which sends the browser on and is gone when the page ends.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory

PAGE = """<!doctype html>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0;url={address}">
<title>sheetbench live</title>
<a href="{address}">sheetbench live</a>
"""


@contextmanager
def kept() -> Iterator[Callable[[str], str]]:
    """What writes a file that leads to an address and returns the file's own, as file://…; at the end it is
    removed."""
    with TemporaryDirectory(prefix="sheetbench-live-") as folder:  # of mode 700

        def leads_to(address: str) -> str:
            file = Path(folder) / "live.html"
            with os.fdopen(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as stream:
                stream.write(PAGE.format(address=escape(address)))
            return file.as_uri()

        yield leads_to
