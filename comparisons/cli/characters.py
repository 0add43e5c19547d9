"""Characters that a terminal or a pipe cannot take, by the nearest ASCII: − as -, × as x, ν as nu, ² as ^2.

Greek letters by their names, superscripts behind ^, accents dropped, lines drawn with - | +, and ? for the
rest. UTF-8 takes everything; nothing is changed there.
"""

from __future__ import annotations

import codecs
import unicodedata
from typing import TextIO

HANDLER = "nearest-ascii"
NEAREST = {
    **dict(zip("−–—·×≈∂µ“”‘’─━│┃⁄", "---.x~du\"\"''--||/", strict=True)),
    "…": "...", "±": "+-", "≤": "<=", "≥": ">=", "≠": "!=", "→": "->", "√": "sqrt", "∞": "inf", "∇": "grad",
    "∫": "int", "°": "deg", "‖": "||", "λ": "lambda", "Λ": "Lambda",
}  # fmt: skip
GREEK_KINDS = ("SMALL", "CAPITAL", "LETTER", "SYMBOL")


def adapt(stream: TextIO) -> None:
    """Let a stream print the nearest ASCII where its encoding lacks a character."""
    codecs.register_error(HANDLER, _instead)
    reconfigure = getattr(stream, "reconfigure", None)
    if reconfigure is not None and not takes_everything(stream.encoding):
        reconfigure(errors=HANDLER)


def takes_everything(encoding: str) -> bool:
    """Return whether an encoding has every character."""
    return encoding.lower().startswith("utf")


def spelled(text: str, encoding: str) -> str:
    """Return the text in an encoding's characters, so that its width is known before it is laid out."""
    if takes_everything(encoding):
        return text
    return text.encode(encoding, HANDLER).decode(encoding)


def ascii_of(text: str) -> str:
    """Return a text by the nearest ASCII."""
    plain, raised = "", False
    for character in text:
        name = unicodedata.name(character, "")
        was_raised, raised = raised, name.startswith(("SUPERSCRIPT", "MODIFIER LETTER"))
        plain += "^" if raised and not was_raised else ""
        plain += _nearest(character, name)
    return plain


def _nearest(character: str, name: str) -> str:
    if character in NEAREST or character.isascii():
        return NEAREST.get(character, character)
    if unicodedata.combining(character):
        return ""
    if name.startswith("GREEK "):
        letter = next(word for word in name.split()[1:] if word not in GREEK_KINDS).lower()
        return letter.capitalize() if "CAPITAL" in name else letter
    if name.startswith("BOX DRAWINGS"):
        return "+"
    parts = unicodedata.normalize("NFKD", character)
    if parts == character:
        return "?"
    return "".join(_nearest(part, unicodedata.name(part, "")) for part in parts)


def _instead(error: UnicodeError) -> tuple[str, int]:
    """Return what the codecs machinery asks: a replacement, and where to go on."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return ascii_of(error.object[error.start : error.end]), error.end
