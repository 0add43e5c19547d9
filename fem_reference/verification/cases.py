"""The table of verification cases, and the answer of `sheetbench verify`: the references against published
values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import groupby
from typing import Any

from fem_reference.verification import manufactured, patch, round_shapes, square_plates, strain_laws, strips
from fem_reference.verification.rows import Row
from fem_reference.verification.square_plates import LAMINATE, PLY
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import Table, number
from sheetbench.errors import require_choice

FIELDS = ("case", "quantity", "computed", "passed", "mesh", "published", "relative", "held_to", "source")


# What a benchmark is, and the function of its rows with its arguments.
CASES: dict[str, tuple[Any, ...]] = {
    "end-shear": ("cantilever under an end shear", strips.end_shear),
    "roll-up": ("cantilever rolled up to a full circle", strips.roll_up),
    "slit-annulus": ("slit annular plate, lifted", round_shapes.slit_annulus),
    "heavy-elastica": ("strip under its own weight", strips.heavy_elastica),
    "settling-strip": ("strip that settles under its own weight", strips.settling),
    "mindlin-simple": (
        "Mindlin plate, hard simple support",
        square_plates.loaded,
        "hinged",
        "plate",
        "shell",
    ),
    "mindlin-clamped": ("Mindlin plate, clamped", square_plates.loaded, "clamped", "plate", "shell"),
    **{
        name: (benchmark.title, square_plates.frequencies, benchmark)
        for name, benchmark in square_plates.BENCHMARKS.items()
    },
    "disc-bending": ("thin disc clamped at its hub", round_shapes.bending),
    "disc-frequencies": ("thin disc clamped at its hub, vibrating", round_shapes.frequencies),
    "strip-with-hole": ("strip with a round hole, pulled", round_shapes.strip_with_hole),
    "nafems-le10": ("thick elliptic plate", round_shapes.elliptic_plate),
    "manufactured-plate": ("manufactured Mindlin plate: error and order", manufactured.plate),
    "manufactured-solid": ("manufactured block: error and order", manufactured.solid),
    "large-rotation-order": ("order of the shell, rolled up", strips.order),
    "locking-plate": ("plate on 8 × 8, h/a from 1e-5 to 0.2", square_plates.locking, "plate"),
    "locking-shell": ("shell on 8 × 8, h/a from 1e-5 to 0.2", square_plates.locking, "shell"),
    "locking-solid": ("solid on 8 × 8, ν up to 0.4999", square_plates.locking, "solid"),
    "strain-laws": ("strip pulled one way and both ways, three laws of strain", strain_laws.rows),
    "rubber": ("rubber pulled, pressed and sheared, four laws", strain_laws.rubbers),
    "orthotropic-plate": ("plate with fibres along x, simply supported", square_plates.fibres, *PLY),
    "laminate": ("laminate [0/90]s, simply supported", square_plates.fibres, *LAMINATE),
    "off-axis": ("strip with oblique fibres, pulled", strips.off_axis),
    "self-bending": ("sheets that are not flat at rest", square_plates.self_bending),
    "patch": ("patch tests on distorted meshes", patch.rows),
}


@dataclass(frozen=True, repr=False)
class Verification(Answer):
    """Rows of expected and computed values."""

    rows: Sequence[Row]

    file_name = "verification"

    @property
    def failed(self) -> list[Row]:
        """Rows off by more than their tolerance."""
        return [row for row in self.rows if not row.passed]

    @property
    def succeeded(self) -> bool:
        return not self.failed

    def heading(self) -> tuple[str, str, str]:
        return "verify", "the references against published and exact values", ""

    def document(self) -> dict[str, Any]:
        return {"rows": [asdict(row) for row in self.rows]}

    def tables(self) -> list[Table]:
        caption = "References against published and exact values"
        return [Table.of(Row, self.rows, caption, "verification", fields=FIELDS)]

    def printed(self) -> list[Table]:
        """Return a table for every case, with what it is; a column names the mesh where there are several."""
        tables = []
        for case, of_case in groupby(self.rows, key=lambda row: row.case):
            rows = list(of_case)
            meshes = {row.mesh for row in rows}
            details = ("case", "mesh")[: 1 + (len(meshes) == 1)]
            title = f"{case}: {CASES[case][0]}" + (f"; {rows[0].mesh}" if len(meshes) == 1 else "")
            tables.append(Table.of(Row, rows, title, "verification", fields=FIELDS, details=details))
        return tables

    def notes(self) -> tuple[str, ...]:
        return (f"{len(self.rows) - len(self.failed)} of {len(self.rows)} rows pass",)

    def complaints(self) -> list[str]:
        return [
            f"{row.case}: {row.quantity}: {number(row.computed)} instead of {number(row.published)}"
            for row in self.failed
        ]


def verify(
    case: Sequence[str] | str | None = None, starting: Callable[[str], None] = lambda name: None
) -> Verification:
    """Check the references against published values, all cases unless some are named.

    starting: called before each case. The answer's `succeeded` says whether all pass. Raises BadInput for a
    case that does not exist, before anything is computed.
    """
    names = list(CASES) if case is None else [case] if isinstance(case, str) else case
    for name in names:
        require_choice("case", name, CASES)
    rows = list[Row]()
    for name in names:
        starting(name)
        _, rows_of, *given = CASES[name]
        rows += (replace(row, case=name) for row in rows_of(*given))
    return Verification(rows)
