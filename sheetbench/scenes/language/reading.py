"""Reading of a user's text files, up to a largest size."""

from pathlib import Path

from sheetbench.errors import BadInput

LARGEST = 2**26  # bytes


def read_text(path: Path, most: int = LARGEST) -> str:
    """Return the text of a file in UTF-8, without a byte order mark, with lines ended by "\\n".

    Raises BadInput for a file above `most` bytes, OSError and UnicodeDecodeError as `open` does.
    """
    with path.open("rb") as file:
        read = file.read(most + 1)
    if len(read) > most:
        raise BadInput(f"{path}: larger than {most // 2**20} MB, which no such file is")
    return read.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
