"""Verification cases, and the answer of `sheetbench verify`: references against published values."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import groupby
from typing import Any, NamedTuple

from fem_reference.verification import manufactured, patch, round_shapes, square_plates, strain_laws, strips
from fem_reference.verification.rows import Row
from fem_reference.verification.square_plates import LAMINATE, PLY
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import Table, number
from sheetbench.errors import require_choice

LINEAR = ("plate", "shell")  # models of Mindlin's plate; the shell under small loads
FIELDS = ("case", "quantity", "computed", "passed", "mesh", "published", "relative", "held_to", "source")


class Case(NamedTuple):
    """A benchmark: its title, and the function of its rows with the arguments."""

    title: str
    rows: Callable[..., Iterable[Row]]
    arguments: tuple[Any, ...] = ()


CASES = {
    "end-shear": Case("cantilever under an end shear", strips.end_shear),
    "roll-up": Case("cantilever rolled up to a full circle", strips.roll_up),
    "slit-annulus": Case("slit annular plate, lifted", round_shapes.slit_annulus),
    "heavy-elastica": Case("strip under its own weight", strips.heavy_elastica),
    "settling-strip": Case("strip that settles under its own weight", strips.settling),
    "mindlin-simple": Case("Mindlin plate, hard simple support", square_plates.loaded, ("hinged", *LINEAR)),
    "mindlin-clamped": Case("Mindlin plate, clamped", square_plates.loaded, ("clamped", *LINEAR)),
    **{
        name: Case(benchmark.title, square_plates.frequencies, (benchmark,))
        for name, benchmark in square_plates.BENCHMARKS.items()
    },
    "disc-bending": Case("thin disc clamped at its hub", round_shapes.bending),
    "disc-frequencies": Case("thin disc clamped at its hub, vibrating", round_shapes.frequencies),
    "strip-with-hole": Case("strip with a round hole, pulled", round_shapes.strip_with_hole),
    "nafems-le10": Case("thick elliptic plate", round_shapes.elliptic_plate),
    "manufactured-plate": Case("manufactured Mindlin plate: error and order", manufactured.plate),
    "manufactured-solid": Case("manufactured block: error and order", manufactured.solid),
    "large-rotation-order": Case("order of the shell, rolled up", strips.order),
    "locking-plate": Case("plate on 8 × 8, h/a from 1e-5 to 0.2", square_plates.locking, ("plate",)),
    "locking-shell": Case("shell on 8 × 8, h/a from 1e-5 to 0.2", square_plates.locking, ("shell",)),
    "locking-solid": Case("solid on 8 × 8, ν up to 0.4999", square_plates.locking, ("solid",)),
    "strain-laws": Case("strip pulled one way and both ways, three laws of strain", strain_laws.rows),
    "rubber": Case("rubber pulled, pressed and sheared, four laws", strain_laws.rubbers),
    "orthotropic-plate": Case("plate with fibres along x, simply supported", square_plates.fibres, PLY),
    "laminate": Case("laminate [0/90]s, simply supported", square_plates.fibres, LAMINATE),
    "off-axis": Case("strip with oblique fibres, pulled", strips.off_axis),
    "self-bending": Case("sheets that are not flat at rest", square_plates.self_bending),
    "patch": Case("patch tests on distorted meshes", patch.rows),
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
        """Return a table for every case with its title; a column names the mesh of a case with several."""
        tables = []
        for case, of_case in groupby(self.rows, key=lambda row: row.case):
            rows = list(of_case)
            meshes = {row.mesh for row in rows}
            details = ("case", "mesh")[: 1 + (len(meshes) == 1)]
            title = f"{case}: {CASES[case].title}" + (f"; {rows[0].mesh}" if len(meshes) == 1 else "")
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
    """Check the references against published values and return the rows.

    Parameters
    ----------
    case : str or sequence of str, optional
        Keys of `CASES`; all cases by default.
    starting : callable
        Called with a case's key before the case is computed.

    Returns
    -------
    Verification
        Rows of expected and computed values; `succeeded` is true if all pass.

    Raises
    ------
    BadInput
        For an unknown case, before any case is computed.

    Examples
    --------
    >>> from fem_reference.verification import verify
    >>> verify("patch").succeeded
    True
    """
    names = list(CASES) if case is None else [case] if isinstance(case, str) else case
    for name in names:
        require_choice("case", name, CASES)
    rows = list[Row]()
    for name in names:
        starting(name)
        rows += (replace(row, case=name) for row in CASES[name].rows(*CASES[name].arguments))
    return Verification(rows)
