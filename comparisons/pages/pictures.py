"""Pictures of a study, made small enough for a page."""

from __future__ import annotations

from base64 import b64encode
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

from PIL import Image

from comparisons.pages.studies import Study
from sheetbench.errors import BadInput

WIDEST = 1600  # pixels
AS_THEY_ARE = {".gif": "gif", ".svg": "svg+xml"}  # what moves, and lines; no script runs in a picture
LARGEST = 80_000_000  # pixels of a picture that is opened


def pictures(study: Study) -> list[tuple[str, str]]:
    """Names and data addresses of a study's pictures; of one in several formats the first."""
    names = {Path(name).stem: name for name in reversed(study.ending(".png", ".svg", ".gif"))}
    found = ((name, study.read(name, _small)) for name in reversed(names.values()))
    return [(name, address) for name, address in found if address]


def _small(path: Path) -> str:
    if path.suffix.lower() == ".svg":
        ElementTree.parse(path)  # a damaged one is no picture
    if kind := AS_THEY_ARE.get(path.suffix.lower()):
        return f"data:image/{kind};base64,{b64encode(path.read_bytes()).decode('ascii')}"
    with Image.open(path) as picture:
        if picture.width * picture.height > LARGEST:
            raise BadInput("too many pixels for a page")
        shown = picture.convert("RGB")
    shown.thumbnail((WIDEST, 4 * WIDEST))
    written = BytesIO()
    shown.save(written, "WEBP", quality=88, method=4)
    return f"data:image/webp;base64,{b64encode(written.getvalue()).decode('ascii')}"
