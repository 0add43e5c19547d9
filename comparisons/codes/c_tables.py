"""Tables of a program in C: numbers, sparse matrices, values over time, rows that are alike once."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import numpy as np

from sheetbench.scenes.objects.tables import OverTime


class Tables:
    """C's tables and names, with numbers of a type, as they are added. text: lines; knots, firsts: of values
    over time, {time, value, slope after, slope before}, and where each begins."""

    def __init__(self, real: str):
        self.real = real
        self.text: list[str] = []
        self.knots: list[list[float]] = []
        self.firsts = [0]

    def number(self, x: float) -> str:
        """Return a literal."""
        text = repr(float(x)) if self.real == "double" else f"{float(np.float32(x)):.9g}"
        text += "" if set(text) & set(".en") else ".0"
        return text if self.real == "double" else text + "f"

    def values(self, values: Any, integers: bool) -> str:
        """Return an initialiser."""
        if np.ndim(values):
            return "{" + ",".join(self.values(each, integers) for each in values) + "}"
        return str(int(values)) if integers else self.number(values)

    def add(self, name: str, values: Any, kind: str | None = None, storage: str = "static ") -> None:
        """Add a table; kind: of whole numbers, the smallest that holds them where it is "" ."""
        values = np.asarray(values)
        if kind == "":
            kind = smallest(values.max(initial=0))
        if not values.size:
            values = np.zeros([max(1, n) for n in values.shape])
        shape = "".join(f"[{n}]" for n in values.shape)
        text = self.values(values, kind is not None)
        self.text.append(f"{storage}const {kind or 'real'} {name}{shape} = {text};")

    def define(self, **numbers: int) -> None:
        """Add numbers by name."""
        self.text += [f"#define {name} {int(value)}" for name, value in numbers.items()]

    def sparse(self, name: str, rows: Any) -> None:
        """Add a sparse matrix in compressed rows: starts of rows, columns and values of entries."""
        import scipy.sparse as sp

        rows = sp.csr_array(rows)
        self.add(name, rows.indptr, "int")
        self.add(f"{name}_AT", rows.indices, "")
        self.add(f"{name}_SHARE", rows.data)

    def course(self, of: OverTime | None, key: str) -> int:
        """Return the number of the first of a table's courses, a component each, −1 without a table."""
        if of is None:
            return -1
        curve, times, first = of.over_time(key), np.array(of.time), len(self.firsts) - 1
        parts = [curve.at(times), curve.slope(times), np.array([curve.slope(t, True) for t in of.time])]
        value, after, before = (np.atleast_2d(np.transpose(part)) for part in parts)
        for component in zip(value, after, before, strict=True):
            self.knots += np.stack([times, *component], axis=1).tolist()
            self.firsts.append(len(self.knots))
        return first

    def alike(self, name: str, rows: np.ndarray) -> None:
        """Add rows that differ, by 1e-12, and which each is."""
        rounded = np.array([[float(f"{x:.12e}") for x in row] for row in rows])
        _, first, which = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
        self.add(f"{name}_ROW", rows[first])
        self.add(f"{name}_OF", which.ravel(), "")


def smallest(most: int, least: str = "unsigned char") -> str:
    """Return the smallest type, from the least on, of whole numbers up to the most."""
    kinds = {"unsigned char": 255, "unsigned short": 2**16 - 1, "unsigned": 2**32 - 1}
    return next(k for k in list(kinds)[list(kinds).index(least) :] if most <= kinds[k])


def identifiers(prefix: str, names: Iterable[str]) -> list[str]:
    """Return identifiers in C for names, with a number where two would be equal."""
    found: list[str] = []
    for n, name in enumerate(names):
        one = f"{prefix}_{re.sub(r'[^A-Za-z0-9]+', '_', name).strip('_').upper()}"
        found.append(one if one not in found and not one.endswith("_") else f"{one}_N{n}")
    return found
