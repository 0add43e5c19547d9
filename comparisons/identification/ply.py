"""Points of a PLY file: the element "vertex", in ASCII or binary.

Header lines up to `end_header`: `format`, then for each element `element NAME COUNT` with its
`property TYPE NAME` or `property list TYPE TYPE NAME`. The elements' rows follow in that order.
Source: Turk, The PLY Polygon File Format (1994).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sheetbench.errors import BadInput, foreign

TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"},
}
ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class Element:
    """An element's name, how many rows it has, and its properties (name, numpy type); a list has no type."""

    name: str
    count: int
    properties: list[tuple[str, str]]

    def row(self, order: str) -> np.dtype:
        """Return a row's type. Raises TypeError where there is a list in it."""
        return np.dtype([(name, order + kind) for name, kind in self.properties])


def read_points(path: Path) -> np.ndarray:
    """Positions (n, 3) of the vertices. Raises BadInput where the file is no PLY, or is damaged."""
    data = path.read_bytes()
    head, end, body = data.partition(b"end_header")
    body = body[1:] if body[:1] == b"\n" else body[2:]
    if not data.startswith(b"ply") or not end:
        raise BadInput(f"{path}: not a PLY file: no header")
    try:
        order, elements = _header(head.decode("ascii", "replace").splitlines())
        before = [element.name for element in elements].index("vertex")
        skipped, vertices = elements[:before], elements[before]
        types = vertices.row(order)
        if order == ORDERS["ascii"]:
            first = sum(element.count for element in skipped)
            lines = body.decode("ascii").split("\n")[first : first + vertices.count]
            rows = np.array([tuple(line.split()) for line in lines], dtype=types)
        else:
            ahead = sum(element.row(order).itemsize * element.count for element in skipped)
            rows = np.frombuffer(body, types, vertices.count, ahead)
        if len(rows) < vertices.count:
            raise BadInput(f"it ends after {len(rows)} of {vertices.count} points")
        return np.stack([rows[axis].astype(float) for axis in "xyz"], axis=1)
    except (ValueError, KeyError, IndexError, TypeError, OverflowError, MemoryError) as error:
        raise BadInput(f"{path}: a damaged PLY file: {foreign(error)}") from None


def _header(lines: list[str]) -> tuple[str, list[Element]]:
    """Byte order and elements; whatever error where it cannot be understood."""
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
