"""Who may talk to the page: what knows its token, asks this machine by its own name, and comes from the page.

The server listens on the loopback alone, and yet every page open in the browser can send requests there.
So a request needs the random token in its path; its Host must be the loopback's, else a foreign name that was
made to lead here (DNS rebinding) would do; an Origin that it brings must be the page's own, and a question,
which browsers let any page post, needs one. The token is compared in constant time.

A browser gets what it is to open on its command line, which every user of the machine can read. So that is
the address of a file that its user alone can read; the page's is in it, and it is gone when the page ends.
"""

from __future__ import annotations

import os
import secrets
from email.message import Message
from html import escape
from http import HTTPStatus
from pathlib import Path

LOOPBACK = "127.0.0.1"
NAMES = (LOOPBACK, "localhost")
REDIRECTION = """<!doctype html>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0;url={address}">
<title>sheetbench live</title>
<a href="{address}">sheetbench live</a>
"""


HEADERS = {  # of every answer: scripts, styles and answers of this server alone, and nobody's frame
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Guard:
    """The token of a server on a port, and what it lets in."""

    def __init__(self, port: int) -> None:
        self._token = secrets.token_urlsafe(32)
        self._hosts = {f"{name}:{port}" for name in NAMES}
        self.address = f"http://{LOOPBACK}:{port}/{self._token}/"

    def refusal(self, path: str, headers: Message, own: bool = False) -> HTTPStatus | None:
        """Return why a request is not answered, None where it is; own: whether it must name its origin."""
        hosts, origins = headers.get_all("Host", []), headers.get_all("Origin", [])
        if len(hosts) != 1 or hosts[0].lower() not in self._hosts:
            return HTTPStatus.MISDIRECTED_REQUEST
        ours = {f"http://{host}" for host in self._hosts}
        token = path.partition("?")[0].split("/")[1:2] or [""]
        known = secrets.compare_digest(token[0].encode(), self._token.encode())
        one = len(origins) <= 1 and (origins or not own) and ours.issuperset(map(str.lower, origins))
        return None if known and one else HTTPStatus.FORBIDDEN

    def name(self, path: str) -> str:
        """Return what a path that was let in asks for, below the token."""
        return path.partition("?")[0].removeprefix(f"/{self._token}").removeprefix("/")


def redirection(folder: str, address: str) -> str:
    """Write a file that leads to an address into a folder of mode 700; return the file's own, as file://…"""
    file = Path(folder) / "live.html"
    with os.fdopen(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as stream:
        stream.write(REDIRECTION.format(address=escape(address)))
    return file.as_uri()
