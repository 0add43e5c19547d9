"""The table of verification cases, and how they are run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial

from fem_reference.verification import (
    elliptic_plate,
    large_deflections,
    manufactured_plate,
    manufactured_solid,
    mindlin_plates,
    natural_frequencies,
    orthotropic,
    patch,
    round_shapes,
    self_bending,
    settling_strip,
    slit_annulus,
    strain_laws,
)
from fem_reference.verification.rows import Case, Row
from sheetbench.errors import require_choice

CASES: dict[str, Case] = {
    "end-shear": Case("cantilever under an end shear", large_deflections.end_shear),
    "roll-up": Case("cantilever rolled up to a full circle", large_deflections.roll_up),
    "slit-annulus": Case("slit annular plate, lifted", slit_annulus.rows),
    "heavy-elastica": Case("strip under its own weight", large_deflections.heavy_elastica),
    "settling-strip": Case("strip that settles under its own weight", settling_strip.rows),
    "mindlin-simple": Case(
        "Mindlin plate, hard simple support", partial(mindlin_plates.rows, "hinged", "plate")
    ),
    "mindlin-clamped": Case(
        "Mindlin plate, clamped", partial(mindlin_plates.rows, "clamped", "plate", "shell")
    ),
    **{
        name: Case(benchmark.title, partial(natural_frequencies.rows, name))
        for name, benchmark in natural_frequencies.BENCHMARKS.items()
    },
    "disc-bending": Case("thin disc clamped at its hub", round_shapes.bending),
    "disc-frequencies": Case("thin disc clamped at its hub, vibrating", round_shapes.frequencies),
    "strip-with-hole": Case("strip with a round hole, pulled", round_shapes.strip_with_hole),
    "nafems-le10": Case("thick elliptic plate", elliptic_plate.rows),
    "manufactured-plate": Case("manufactured Mindlin plate: error and order", manufactured_plate.rows),
    "manufactured-solid": Case("manufactured block: error and order", manufactured_solid.rows),
    "large-rotation-order": Case("order of the shell, rolled up", large_deflections.order),
    "locking-plate": Case("plate on 8 × 8, h/a from 1e-5 to 0.2", partial(mindlin_plates.locking, "plate")),
    "locking-shell": Case("shell on 8 × 8, h/a from 1e-5 to 0.2", partial(mindlin_plates.locking, "shell")),
    "locking-solid": Case("solid on 8 × 8, ν up to 0.4999", partial(mindlin_plates.locking, "solid")),
    "strain-laws": Case("strip pulled one way and both ways, three laws of strain", strain_laws.rows),
    "rubber": Case("rubber pulled, pressed and sheared, four laws", strain_laws.rubbers),
    "orthotropic-plate": Case("plate with fibres along x, simply supported", orthotropic.plate),
    "laminate": Case("laminate [0/90]s, simply supported", orthotropic.laminate),
    "off-axis": Case("strip with oblique fibres, pulled", orthotropic.off_axis),
    "self-bending": Case("sheets that are not flat at rest", self_bending.rows),
    "patch": Case("patch tests on distorted meshes", patch.rows),
}


def run(
    names: Iterable[str] | None = None, starting: Callable[[str], None] = lambda name: None
) -> Iterator[Row]:
    """The rows of the named cases, all unless given; `starting` is called before each case.

    Raises BadInput for an unknown name, before anything is computed.
    """
    chosen = tuple(CASES) if names is None else tuple(names)
    for name in chosen:
        require_choice("case", name, CASES)
    return _rows(chosen, starting)


def _rows(names: tuple[str, ...], starting: Callable[[str], None]) -> Iterator[Row]:
    for name in names:
        starting(name)
        yield from (replace(row, case=name) for row in CASES[name].rows())
