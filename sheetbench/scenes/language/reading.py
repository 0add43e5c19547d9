"""Text files of a user's, up to a size that such a file may have: a device, or a film, has no end."""

from __future__ import annotations

from pathlib import Path

from sheetbench.errors import BadInput

LARGEST = 2**26  # bytes


def read_text(path: Path, most: int = LARGEST) -> str:
    """The text of a file in UTF-8, without the mark that some editors put before it, lines ended by "\\n".

    Raises BadInput for a larger file, OSError and UnicodeDecodeError as reading does.
    """
    with path.open("rb") as file:
        read = file.read(most + 1)
    if len(read) > most:
        raise BadInput(f"{path}: larger than {most // 2**20} MB, which no such file is")
    return read.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
