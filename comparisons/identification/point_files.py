"""Points of other people's files: markers of a motion capture (C3D), vertices of a scan (PLY).

C3D is read with `ezc3d`, an extra. A file may be another person's, and ezc3d does not survive damaged ones:
reading is a program of its own (`c3d_reader`) with limits of time and memory, and its numbers are checked.

The points of a PLY file, in ASCII or binary, are its element "vertex". Header lines to `end_header`:
`format`, then for each element `element NAME COUNT` with its `property TYPE NAME` or `property list TYPE TYPE
NAME`. The elements' rows follow in that order. Source: Turk, The PLY Polygon File Format (1994).
"""

import sys
from dataclasses import dataclass
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np

from comparisons.identification import c3d_reader
from sheetbench.errors import BadInput, foreign
from sheetbench.process import ONE_THREAD, run
from sheetbench.scenes.language.units import quantity

SECONDS, PER_MB = 20.0, 2.0  # s that reading may take, and more a megabyte of the file
MEMORY_MB, LARGEST = 4096, 2**28  # of address space; bytes of a file


class Markers(NamedTuple):
    """Markers of a motion capture: labels (n,); position (n, frames, 3) [m], nan where a marker was not seen;
    time (frames,) [s]."""

    labels: tuple[str, ...]
    position: np.ndarray
    time: np.ndarray


def read_markers(path: Path) -> Markers:
    """Return the markers of a file, in its own axes. Raises BadInput where it cannot be read, or ezc3d is not
    installed."""
    if find_spec("ezc3d") is None:
        raise BadInput(f"{path}: C3D files need ezc3d: pip install 'sheetbench[c3d]'")
    if not path.is_file():
        raise BadInput(f"{path}: no such file")
    size = path.stat().st_size
    if size > LARGEST:
        raise BadInput(f"{path}: larger than {LARGEST // 2**20} MB: cut the capture")
    # -P: the modules beside the program are not its own
    command = [sys.executable, "-P", c3d_reader.__file__, str(path)]
    seconds = SECONDS + PER_MB * size / 2**20
    process = run(command, b"", seconds, MEMORY_MB, most=8 * LARGEST, variables=ONE_THREAD)
    if process.fault:
        unreadable = process.code == c3d_reader.REFUSED and not process.stopped
        raise BadInput(f"{path}: cannot be read as C3D: {process.complaint if unreadable else process.fault}")
    with np.load(BytesIO(process.answer)) as archive:
        content = dict(archive)
    labels, rate = tuple(map(str, content["labels"])), float(content["rate"])
    position = content["position"].transpose(1, 2, 0)
    if not (0.0 < rate < np.inf and position.size):
        raise BadInput(f"{path}: no markers over time in it")
    if len(labels) != len(position):
        raise BadInput(f"{path}: {len(labels)} labels of {len(position)} markers")
    if np.isinf(position).any():
        raise BadInput(f"{path}: a marker's position is no finite number")
    scale = quantity(f"1 {content['unit']}", "m")
    return Markers(labels, scale * position, np.arange(position.shape[1]) / rate)


TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"},
}
ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class Element:
    """An element's name, its number of rows, and its properties (name, numpy type); a list has no type."""

    name: str
    count: int
    properties: list[tuple[str, str]]

    def row(self, order: str) -> np.dtype:
        """Return a row's type. Raises TypeError if the element has a list."""
        return np.dtype([(name, order + kind) for name, kind in self.properties])


def read_points(path: Path) -> np.ndarray:
    """Return positions (n, 3) of the vertices. Raises BadInput for another format or a damaged file."""
    data = path.read_bytes()
    head, marker, body = data.partition(b"end_header")
    body = body[1:] if body[:1] == b"\n" else body[2:]
    if not data.startswith(b"ply") or not marker:
        raise BadInput(f"{path}: not a PLY file: no header")
    try:
        order, elements = _parse_header(head.decode("ascii", "replace").splitlines())
        index = [element.name for element in elements].index("vertex")
        skipped, vertices = elements[:index], elements[index]
        types = vertices.row(order)
        if order == ORDERS["ascii"]:
            start = sum(element.count for element in skipped)
            lines = body.decode("ascii").split("\n")[start : start + vertices.count]
            rows = np.array([tuple(line.split()) for line in lines], dtype=types)
        else:
            offset = sum(element.row(order).itemsize * element.count for element in skipped)
            rows = np.frombuffer(body, types, vertices.count, offset)
        if len(rows) < vertices.count:
            raise BadInput(f"it ends after {len(rows)} of {vertices.count} points")
        return np.stack([rows[axis].astype(float) for axis in "xyz"], axis=1)
    except (ValueError, KeyError, IndexError, TypeError, OverflowError, MemoryError) as error:
        raise BadInput(f"{path}: a damaged PLY file: {foreign(error)}") from None


def _parse_header(lines: list[str]) -> tuple[str, list[Element]]:
    """Return byte order and elements of a PLY header. Raises errors of any type for a damaged header."""
    order, elements = "", []
    for line in lines:
        word, *rest = line.split() or [""]
        if word == "format":
            order = ORDERS[rest[0]]
        elif word == "element":
            elements.append(Element(rest[0], int(rest[1]), []))
        elif word == "property":
            kind = "" if rest[0] == "list" else TYPES[rest[0]]
            elements[-1].properties.append((rest[-1], kind))
    if not order or any(element.count < 0 for element in elements):
        raise BadInput("its header names no format, or a negative count")
    return order, elements
