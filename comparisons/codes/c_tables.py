"""Tables of a program in C: arrays, sparse matrices, curves over time, tables of distinct rows."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import numpy as np

from sheetbench.numerics.sparse_products import csr_arrays
from sheetbench.scenes.objects.tables import OverTime

PRECISIONS: dict[str, tuple[str, Any]] = {"double": ("double", np.float64), "single": ("float", np.float32)}
BRACES = str.maketrans("[]", "{}", " ")
NEVER, LATE = 1e300, 1e-9  # s; share of a curve's length by which a time may be late, by rounding
WHOLE = {1: "unsigned char", 2: "unsigned short", 4: "int"}  # types by their bytes


class Tables:
    """Tables in C. lines: of source; sizes: lengths of tables, by the plural of their names, and other whole
    numbers; knots: of curves, one behind another, {since when, from, coefficients}."""

    def __init__(self, precision: str):
        self.real, self.rounded = PRECISIONS[precision]
        self.lines: list[str] = []
        self.sizes: dict[str, int] = {}
        self.knots: list[list[float]] = []

    def add(self, name: str, values: Any, kind: str = "", storage: str = "static ") -> None:
        """Add a table, of the smallest type of whole numbers unless given one."""
        values = np.asarray(values)
        self.sizes[f"{name}S"] = len(values)
        if not values.size:
            values = np.zeros([max(1, n) for n in values.shape], values.dtype)
        if values.dtype.kind == "f":
            values, kind = values if kind == "double" else values.astype(self.rounded), kind or "real"
        else:
            values, kind = values.astype(int), kind or WHOLE[np.min_scalar_type(values.max()).itemsize]
        shape = "".join(f"[{n}]" for n in values.shape)
        self.lines.append(f"{storage}const {kind} {name}{shape} = {str(values.tolist()).translate(BRACES)};")

    def add_sparse(self, name: str, rows: Any) -> None:
        """Add a sparse matrix: starts of its rows, columns and values of entries."""
        import scipy.sparse as sp

        arrays = rows if isinstance(rows, tuple) else csr_arrays(sp.csr_array(rows))
        for ending, values in zip(("", "_AT", "_SHARE"), arrays, strict=True):
            self.add(f"{name}{ending}", values)

    def add_distinct(self, name: str, rows: np.ndarray) -> None:
        """Add rows that differ, by 1e-12, and the number of each row among them."""
        rounded = np.array([[float(f"{x:.12e}") for x in row] for row in rows])
        _, first, which = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
        self.add(f"{name}_ROW", rows[first])
        self.add(f"{name}_OF", which.ravel())

    def curves(self, table: OverTime | None, key: str, width: int) -> list[int]:
        """Add the curves of a table over time to the knots; return the first knot of each component, −1
        without a table."""
        if table is None:
            return [-1] * width
        times, firsts = np.array([table.time[0], *table.time]), []
        since = np.array([NEVER, *(times[1:] - LATE * np.ptp(times))])  # no curve goes on to the next one
        pieces = table.over_time(key).pieces  # before, between and after the samples
        for of in np.reshape(pieces, (*pieces.shape[:2], -1)).T:
            firsts.append(len(self.knots))
            self.knots += np.pad(np.column_stack([since, times, of]), ((0, 0), (0, 4 - of.shape[1]))).tolist()
        return firsts


def identifiers(names: Iterable[str]) -> list[str]:
    """Return names of letters, digits and underscores, with their number where two would be equal."""
    found: list[str] = []
    for number, name in enumerate(names):
        plain = re.sub(r"[^A-Za-z0-9]+", "_", name)
        while plain in found:
            plain += f"_{number}"
        found.append(plain)
    return found
