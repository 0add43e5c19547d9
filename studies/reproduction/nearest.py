"""Which sheets come nearest to the published tables, and how near.

Two questions: could the lattice of Habibi et al. have computed the published model's table, and could a plate
have shown the published experiment's? Each is asked of every test by itself and of both together, and for
test 2 with the rod's ends up and down. Scans: the tests over a row of layer distances with k as published,
and of E. Fits: from the nearest of a scan on, in ever more numbers, by the search of
`comparisons.identification`; every published component weighs the same. Where a sheet snaps as a number
changes, the misfit jumps, and a search may end at the jump. Least squares mind the largest entries; beside
them stands the sheet of each scan that meets most entries.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from comparisons.identification.measurements import Displacements
from comparisons.identification.misfit import Misfit
from comparisons.identification.prediction import NotReached
from comparisons.identification.search import search
from comparisons.reproduction.published import DIGIT, published, scene
from sheetbench.answers.table import MEGAPASCALS, MILLIMETRES, PERCENT, Column, Unit
from sheetbench.scenes.habibi import published_inputs
from studies.reproduction.sheets import KINDS, RODS, Sheets

FIRST = {"sheet": "young", "lattice": "layer_distance"}
SOURCE = {"sheet": "experiment", "lattice": "model"}  # which published table a kind is requested
SOUGHT: dict[str, tuple[tuple[str, ...], ...]] = {
    "sheet": (("young",), ("young", "tilt")),
    "lattice": (("layer_distance",), ("layer_distance", "k"), ("layer_distance", "k", "tilt")),
}
ROD = "curvature"  # sought last, where the only test is the one with the rod
ASKED = (((1,), 0), ((2,), 1), ((2,), -1), ((1, 2), 1), ((1, 2), -1))  # tests, and the rod's sense
YOUNG = 2.0 ** np.arange(-5.0, 2.1, 0.25)  # of the published E
LAYERS = 2.0 ** np.arange(-0.5, 2.95, 0.125)  # layer distances, of the thickness
ENOUGH = 1e-5  # change of x, or of the sum of squares, that ends a search: far below what is printed
EVALUATIONS = 20  # of a search
SQUARES, MOST = "misfit", "entries"
NEAR = 0.1  # of an entry: what counts as met
COLUMNS = {
    "young": MEGAPASCALS(".3g", "E"),
    "k": Unit("N/m", "N/m")(".3g", "k"),
    "layer_distance": MILLIMETRES(".3g", "lz"),
    "tilt": Unit("rad", "°", 180.0 / np.pi)(".2g", "tilt"),
    "curvature": Unit("1/m", "1/m")(".3g", "κ"),
}


@dataclass(frozen=True)
class Scan:
    """A kind of sheets over a row of values of `name`: displacement (values, probes, 3) [m], nan where there
    is no stable equilibrium; tests in turn; sense: of the rod."""

    kind: str
    tests: tuple[int, ...]
    sense: int
    name: str
    values: np.ndarray
    displacement: np.ndarray


@dataclass(frozen=True)
class Fit:
    """The sheet of a kind that comes nearest to a published table.

    sought: what was free, with the value found; displacement (probes, 3) [m] beside what is published; by:
    the measure that it is the nearest in; converged: whether a search reached its end.
    """

    kind: Annotated[str, Column("of")]
    tests: tuple[int, ...]
    sense: int
    sought: Mapping[str, float]
    displacement: np.ndarray
    target: np.ndarray
    by: str
    converged: bool

    @property
    def test_names(self) -> Annotated[str, Column("tests")]:
        """The tests in words."""
        return " and ".join(map(str, self.tests))

    @property
    def rod(self) -> str:
        """The sense of the rod in words."""
        return "sought" if ROD in self.sought else RODS[self.sense]

    @property
    def values(self) -> dict[Column, float | None]:
        """What was found, None of what is as published."""
        return {column: self.sought.get(name) for name, column in COLUMNS.items()}

    @property
    def met(self) -> str:
        """How many published components it has."""
        return f"{int(self.matches.sum())} of {self.entries}"

    @property
    def source(self) -> Annotated[str, Column("table", detail=True)]:
        """Which published table it was to come near to."""
        return SOURCE[self.kind]

    @property
    def rms(self) -> Annotated[float, PERCENT(".3g")]:
        """Of the differences, of the largest published component."""
        return float(np.sqrt(np.nanmean((self.displacement - self.target) ** 2))) / self._largest

    @property
    def error(self) -> Annotated[float, PERCENT(".3g")]:
        """The largest difference, of the largest published component."""
        return float(np.nanmax(np.abs(self.displacement - self.target))) / self._largest

    @property
    def _largest(self) -> float:
        return float(np.nanmax(np.abs(self.target)))

    @property
    def matches(self) -> np.ndarray:
        """Which published components it has, (probes, 3) bool."""
        return matches(self.displacement, self.target)

    @property
    def missed(self) -> np.ndarray:
        """Which published components it has not, (probes, 3) bool."""
        return ~self.matches & np.isfinite(self.target)

    @property
    def entries(self) -> int:
        """How many components are published."""
        return int(np.isfinite(self.target).sum())

    def as_dict(self) -> dict[str, Any]:
        """For JSON: SI units."""
        return {
            "kind": self.kind,
            "tests": list(self.tests),
            "sense": self.sense,
            "source": self.source,
            "by": self.by,
            "sought": dict(self.sought),
            "rms": self.rms,
            "error": self.error,
            "met": int(self.matches.sum()),
            "entries": self.entries,
            "converged": self.converged,
            "displacement": self.displacement,
            "published": self.target,
        }


def matches(moved: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Which of the wanted components are met within NEAR of themselves, or within the last printed digit."""
    inside: np.ndarray = np.abs(moved - wanted) <= np.maximum(NEAR * np.abs(wanted), DIGIT)
    return inside


def target(tests: Sequence[int], source: str) -> np.ndarray:
    """What is published of these tests, one after the other, (probes, 3) [m]."""
    return np.vstack([published(test, source) for test in tests])


def sheets_of(kind: str, tests: Sequence[int], sense: int) -> Sheets:
    """The sheets of a kind under these tests."""
    return Sheets(kind, [scene(test, sense or 1) for test in tests])


def scan(kind: str, tests: tuple[int, ...], sense: int) -> Scan:
    """The sheets of a kind over the first of what may vary."""
    given, name = published_inputs(), FIRST[kind]
    values = given["young"] * YOUNG if kind == "sheet" else given["thickness"] * LAYERS
    displacements = sheets_of(kind, tests, sense).displacements([{name: float(value)} for value in values])
    return Scan(kind, tests, sense, name, values, np.stack(displacements))


def combined(first: Scan, second: Scan) -> Scan:
    """Two tests of the same sheets as one."""
    moved = np.concatenate([first.displacement, second.displacement], axis=1)
    return Scan(second.kind, (*first.tests, *second.tests), second.sense, second.name, second.values, moved)


def fits(scanned: Scan, wanted: np.ndarray, progress: Callable[[str], None] = lambda what: None) -> list[Fit]:
    """The nearest sheets to a table (probes, 3) [m], in ever more numbers, from the nearest of a scan on; and
    the one of the scan that meets most entries."""
    sheets = sheets_of(scanned.kind, scanned.tests, scanned.sense)
    points = np.vstack([one.probe_points() for one in sheets.scenes])
    misfit = Misfit(Displacements(points, wanted), (np.empty(0), np.empty(0)))
    squares = np.nansum((scanned.displacement - wanted) ** 2, axis=(1, 2))
    squares[np.isnan(scanned.displacement).any(axis=(1, 2))] = np.inf
    given = published_inputs()
    best = {
        scanned.name: float(scanned.values[int(np.argmin(squares))]),
        "k": given["k"],
        "tilt": 0.0,
        ROD: (scanned.sense or 1) * given["curvature"],
    }

    def fit(values: Mapping[str, float], moved: np.ndarray, by: str, converged: bool) -> Fit:
        return Fit(scanned.kind, scanned.tests, scanned.sense, values, moved, wanted, by, converged)

    reached = []
    for names in _sought(scanned):
        unknowns = [sheets.unknown(name, best[name]) for name in names]
        try:
            end = search(sheets, unknowns, misfit, ENOUGH, EVALUATIONS, progress=progress)
        except NotReached:
            continue
        values = {one.name: one.value(x) for one, x in zip(unknowns, end.x, strict=True)}
        best |= values
        (moved,) = sheets.displacements([values])
        reached.append(fit(values, moved, SQUARES, end.converged))
    counts = [matches(moved, wanted).sum() for moved in scanned.displacement]
    most = int(np.argmax(counts))
    return [
        *reached,
        fit({scanned.name: float(scanned.values[most])}, scanned.displacement[most], MOST, True),
    ]


def _sought(scanned: Scan) -> Sequence[tuple[str, ...]]:
    """Numbers to seek, in turn: all at once for a test alone, for both together those of the sheet."""
    rows = SOUGHT[scanned.kind]
    if len(scanned.tests) > 1:
        return rows[:-1]
    return (*rows[:-1], (*rows[-1], ROD)) if scanned.tests == (2,) else rows


def scans(progress: Callable[[str], None] = lambda what: None) -> list[Scan]:
    """Every scan: each kind under each of ASKED."""
    every: list[Scan] = []
    for kind in KINDS:
        alone = {}
        for tests, sense in ASKED:
            if len(tests) == 1:
                progress(f"scanning {kind}: test {tests[0]}")
                alone[tests, sense] = scan(kind, tests, sense)
        every += [
            alone[tests, sense] if len(tests) == 1 else combined(alone[(1,), 0], alone[(2,), sense])
            for tests, sense in ASKED
        ]
    return every


def nearest(scanned: Sequence[Scan], progress: Callable[[str], None] = lambda what: None) -> list[Fit]:
    """Every fit from these scans, each kind to its own published table."""
    return [fit for one in scanned for fit in fits(one, target(one.tests, SOURCE[one.kind]), progress)]
