"""The files of the page, by fixed names, read once: no request leads to any other file."""

from __future__ import annotations

from importlib import resources

from comparisons.browser import viewer

SOCKET = "socket"
TYPES = {"html": "text/html", "css": "text/css", "js": "text/javascript"}


def assets() -> dict[str, tuple[str, bytes]]:
    """Type and content by name; the page itself has none."""
    page = resources.files("comparisons.live").joinpath("page")
    own = {
        name: page.joinpath(name).read_text(encoding="utf-8") for name in ("live.html", "live.css", "live.js")
    }
    texts = {**own, "viewer.js": viewer.script(), "viewer.css": viewer.style()}
    found = {
        name: (f"{TYPES[name.rpartition('.')[2]]}; charset=utf-8", text.encode())
        for name, text in texts.items()
    }
    return {"": found.pop("live.html"), **found}
