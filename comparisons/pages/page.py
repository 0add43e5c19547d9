"""The page of a folder: its studies in one HTML file that makes no request.

A content security policy lets the page's own script and style alone do anything, by their digests; all words
of a scene or a file are text (Jinja escapes them), and data are read as JSON. Scene points go as float32,
pictures as WebP.
"""

import hashlib
from base64 import b64encode
from collections import Counter
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from PIL import Image

from comparisons.pages.sheets import own_text
from comparisons.pages.stage import stage
from comparisons.pages.studies import FolderContents, Study, tables
from comparisons.pictures.work import memory
from comparisons.sweep.manifest import made_with
from sheetbench.answers.escape import terminal
from sheetbench.answers.files import plain
from sheetbench.answers.table import number, quantity
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.words import in_words

PACKAGE = "comparisons.pages"
AS_THEY_ARE = ("title", "verb", "place", "command", "date", "result", "notes", "complaints")  # of a study
FOLDED_FROM = 4  # studies from which on each is folded
TIMES = ("duration", "step", "largest_step", "every")
MACHINE = {"processor": "{}", "cpu_count": "{} processors", "system": "{}", "python": "Python {}"}
UNITS = {"layer_distance": "m", "k": "N/m", **dict.fromkeys(TIMES, "s")}  # of settings
WIDEST = 1600  # pixels of a picture
MOVING_OR_LINES = {".gif": "gif", ".svg": "svg+xml"}  # shown as they are; no script runs in a picture
LARGEST = 80_000_000  # pixels of a picture that is opened


def page(contents: FolderContents, title: str) -> str:
    """Return the HTML of a folder's studies."""
    values = [_describe_study(study, n) for n, study in enumerate(contents.studies, start=1)]
    titles = Counter(study.title for study in contents.studies)
    troubles = [*contents.troubles, *(trouble for study in contents.studies for trouble in study.troubles)]
    style, script = (own_text(f"viewer.{kind}") + own_text(f"page.{kind}") for kind in ("css", "js"))
    environment = Environment(
        loader=PackageLoader(PACKAGE, "."), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, finalize=_spell_out,
    )  # fmt: skip
    environment.filters["whole_words"] = whole_words
    environment.policies["json.dumps_kwargs"] = {"allow_nan": False, "separators": (",", ":")}
    return environment.get_template("page.html").render(
        title=title,
        studies=values,
        ambiguous={title for title, count in titles.items() if count > 1},
        brief=len(values) > FOLDED_FROM,
        troubles=list(dict.fromkeys(troubles)),
        made_with=made_with(),
        policy=policy(script, style),
        script=script,
        style=style,
    )


def policy(script: str, style: str) -> str:
    """Return the content security policy of a page with this script and style and no other."""
    return (
        f"default-src 'none'; script-src '{_digest(script)}'; style-src '{_digest(style)}'; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )


def whole_words(text: str) -> Markup:
    """Return the text so that options and names with hyphens are not broken over lines at hyphens."""
    span = Markup('<span class="whole">{}</span>')
    words = _spell_out(text).split(" ")
    return Markup(" ").join(span.format(word) if "-" in word else word for word in words)


def memory_of(size: int) -> str:
    """Return a file's size."""
    return memory(size) if size >= 1e6 else f"{max(size / 1e3, 0.1):.3g} kB"


def _digest(text: str) -> str:
    return f"sha256-{b64encode(hashlib.sha256(text.encode()).digest()).decode('ascii')}"


def _spell_out(value: Any) -> Any:
    """Return text with its control characters spelled out; other values unchanged."""
    return terminal(value, keep="\n") if type(value) is str else value


def _describe_study(study: Study, number: int) -> dict[str, Any]:
    """Return a study's values for the template."""
    sheets, images, words = stage(study), pictures(study), study.words
    has_still_sheets = sheets is not None and not any(sheet.get("frames") for sheet in sheets["sheets"])
    folded = [one for one in images if has_still_sheets and not one[0].endswith(".svg")]
    return {
        **{name: getattr(study, name) for name in AS_THEY_ARE},
        "id": f"study-{number}",
        "subtitle": words.get("subtitle") or "",
        "lead": words.get("lead") or "",
        "question": question(study),
        "unfinished": bool(study.run) and not study.run.get("finished", True),
        "stage": plain({**sheets, "label": f"Sheet of {study.title}"}) if sheets else None,
        "tables": tables(study),
        "pictures": images,
        "figures": [one for one in images if one not in folded],
        "folded": folded,
        "made": _list_sources(study.record, study.run),
        "files": [(name, _read_size(study.folder / name)) for name in study.files],
    }


def _list_sources(record: Mapping[str, Any], run: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the machine, the versions and the times of a study."""
    machine = record.get("machine") or {}
    versions = record.get("versions") or {}
    parts = {
        "date": run.get("date"),
        "sheetbench": record.get("sheetbench"),
        "source": record.get("source"),
        "machine": ", ".join(text.format(machine[key]) for key, text in MACHINE.items() if key in machine),
        "packages": ", ".join(f"{name} {version}" for name, version in versions.items()),
    }
    return [(name, str(value)) for name, value in parts.items() if value]


def _read_size(path: Path) -> str:
    return memory_of(path.stat().st_size) if path.is_file() else ""


def question(study: Study) -> list[tuple[str, str]]:
    """Return pairs of a topic and its sentence: of the scene, of each model's settings, of common settings;
    reasons of choices are among the notes."""
    scene = study.scene
    sentences = study.guarded("scene", lambda: [*in_words(scene)]) if scene is not None else []
    settings = study.run.get("settings")
    settings = settings if isinstance(settings, dict) else {}
    nested = {k: v for k, v in settings.items() if isinstance(v, dict)}
    lines = [(name, _join_settings(values)) for name, values in nested.items() if values]
    common = _join_settings({k: v for k, v in settings.items() if k not in nested})
    return [*(sentences or []), *lines, *([("settings", common)] if common else [])]


def _join_settings(values: Mapping[str, Any]) -> str:
    shown = ((key.replace("_", " "), _shorten(key, value)) for key, value in values.items())
    return ", ".join(f"{key} {value}" for key, value in shown if value and not key.endswith(" reason"))


def _shorten(key: str, value: Any) -> str:
    """Return a setting in a few characters; nothing of one that is long, which the document has."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, int | float) and key in UNITS:
        return quantity(value, UNITS[key])
    if isinstance(value, float):
        return number(value, ".4g")
    if isinstance(value, list) and key == "grids":  # several, and not the sides of one
        return ", ".join(map(str, value))
    if isinstance(value, list) and all(isinstance(part, int) for part in value) and len(value) <= 3:
        return " × ".join(map(str, value))
    return str(value) if isinstance(value, str | int) and len(str(value)) <= 60 else ""


def pictures(study: Study) -> list[tuple[str, str]]:
    """Return names and data addresses of a study's pictures; of a picture in several formats the first."""
    names = {Path(name).stem: name for name in reversed(study.with_suffix(".png", ".svg", ".gif"))}
    images = ((name, study.read(name, _encode_picture)) for name in reversed(names.values()))
    return [(name, address) for name, address in images if address]


def _encode_picture(path: Path) -> str:
    if path.suffix.lower() == ".svg":
        ElementTree.parse(path)  # a damaged one is no picture
    if kind := MOVING_OR_LINES.get(path.suffix.lower()):
        return f"data:image/{kind};base64,{b64encode(path.read_bytes()).decode('ascii')}"
    with Image.open(path) as picture:
        if picture.width * picture.height > LARGEST:
            raise BadInput("too many pixels for a page")
        image = picture.convert("RGB")
    image.thumbnail((WIDEST, 4 * WIDEST))
    buffer = BytesIO()
    image.save(buffer, "WEBP", quality=88, method=4)
    return f"data:image/webp;base64,{b64encode(buffer.getvalue()).decode('ascii')}"
