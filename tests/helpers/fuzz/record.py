"""What long runs have in common: what they are requested, and the lines that one keeps for the next."""

import argparse
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TextIO

Line = dict[str, Any]


def parse_arguments(about: str, counts: Mapping[str, int]) -> argparse.Namespace:
    """The command line: a folder, which is made, a seed, and how many of each kind, `counts` unless given."""
    parser = argparse.ArgumentParser(description=about.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    for name, usual in counts.items():
        parser.add_argument(f"--{name}", type=int, default=usual, metavar="N")
    found = parser.parse_args()
    found.folder.mkdir(parents=True, exist_ok=True)
    return found


class Record:
    """Lines of a file by their kind and number, the last one of each."""

    def __init__(self, file: TextIO, number: str):
        file.seek(0)
        self._file = file
        self._lines = {(line["kind"], line[number]): line for line in map(json.loads, file)}

    def get(self, kind: str, number: int) -> Line | None:
        """What an earlier run kept."""
        return self._lines.get((kind, number))

    def add(self, line: Line) -> None:
        """Keep a line, whatever happens next."""
        self._file.write(json.dumps(line) + "\n")
        self._file.flush()


@contextmanager
def opened(path: Path, number: str) -> Iterator[Record]:
    """The lines of a file, made where there is none; number: the key that numbers those of a kind."""
    with path.open("a+", encoding="utf-8") as file:
        yield Record(file, number)
