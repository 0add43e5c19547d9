"""`sheetbench calibrate [SCENE]`: spring constants, and the numbers of other codes and of repeated cells."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from comparisons.cli.options import Kind, LatticeOptions, Metres, SheetOptions
from comparisons.cli.output import OutputOptions, command_line
from comparisons.cli.verb import no_effect
from sheetbench.choices import CALIBRATIONS

if TYPE_CHECKING:
    from comparisons.calibration.calibrate import SheetCalibration
    from comparisons.codes.cell_moduli import CellModuli
    from comparisons.codes.inverse import SheetOfCode
    from comparisons.codes.setup import CodeSetup

SUMMARIES = "; ".join(f"{name}: {method.summary}" for name, method in CALIBRATIONS.items())
SPRINGS = "calibration k layer_distance grading toml"
SHEET = "young poisson thickness side"
DAMPING = "loss_factor at band prony"


@no_effect(
    with_for_="export cell toml",
    with_cell=f"{SPRINGS} {DAMPING} grid export",
    with_from_=f"{SPRINGS} {DAMPING} calibration grid export for_ hinge coefficient {SHEET}",
    without_cell="hinge coefficient",
)
def command(
    scene: str | None = None,
    *,
    sheet: SheetOptions,
    lattice: LatticeOptions,
    toml: bool = False,
    export: str | None = None,
    for_: str | None = None,
    precision: str | None = None,
    from_: str | None = None,
    cell: str | None = None,
    spacing: Metres = None,
    hinge: str | None = None,
    coefficient: list[str] | None = None,
    loss_factor: float | None = None,
    at: Annotated[float | None, Kind("Hz")] = None,
    band: tuple[float, float] | None = None,
    prony: Path | None = None,
    large: bool = False,
    output: OutputOptions,
) -> Annotated[
    SheetCalibration | CodeSetup | CellModuli | SheetOfCode,
    "for_: SheetCalibration | CodeSetup",
    "from_: SheetOfCode",
    "cell: CellModuli",
]:
    """Find spring constants for a sheet, or another code's numbers.

    Give a SCENE, or --young --poisson --thickness --side; with both, the options change the scene's values.
    The fitted methods train on the SCENE; without one, on the sheet under its own weight with one edge and
    with two adjacent edges clamped. --export writes the lattice of the SCENE, or of the sheet with one edge
    clamped.

    Args:
        scene ([SCENE], argument): Scene with the sheet and its material; with --from the code's numbers.
        calibration (NAME): {SUMMARIES}; auto: by the SCENE, as with --grading auto. Default: {CALIBRATION}.
        toml: Print the [springs] table for a scene file.
        for_ (CODE): Numbers for another code, with --out its files too. mujoco, newton, pybullet, genesis:
            its own sheet of triangles; sofa: the lattice's springs; numpy, cpp, matlab: the lattice and a
            program that reads it; c: one C file that steps it, with a check;
            fmu: that as an FMI 3.0 unit.
        precision (NAME): With --for c or fmu: double or single numbers. Default: double.
        from_ (CODE): The sheet that another code's numbers are, given in place of the SCENE as
            tri_ke=1e3,tri_ka=1e3,edge_ke=10; --cell its mesh, --spacing the distance of its vertices.
        cell (CELL): Stiffness of a repeated cell as a sheet, its best coefficients, the error that no finer
            mesh removes: one-diagonal, alternate-diagonals, equilateral, unstructured (triangles with
            hinges), bricks, or a TOML file with periods, nodes and elements.
        spacing (LENGTH): With --cell or --from: distance of nodes, in m or as 5mm. Default with --cell: an
            eighth of the shorter side.
        hinge (WEIGHT): With --cell: energy of a hinge, ½ k w θ²: length, w the edge's; angle, w = 1; height,
            w = 3 length² over the area of both triangles. Default: length.
        coefficient (NAME=VALUE): With --cell: use this in place of the one found.
        loss_factor (ETA): Damping of the material, η = 2ζ = tan δ = 1/Q, with --at or --band; of a decay
            2Λ/√(4π² + Λ²), Λ = ln(peak/next peak).
        at (HZ): One damper per spring: the loss factor is right at this frequency only.
        band (LOW HIGH): Two Maxwell branches a decade, which keep the loss factor from LOW to HIGH Hz.
        prony (FILE): Young's modulus and branches from a CSV of frequency [Hz], storage, loss (or tan_delta),
            or of time [s], modulus; moduli in Pa or as the header has it, storage [MPa].
    """
    from dataclasses import fields

    from comparisons.calibration import damping
    from comparisons.calibration.calibrate import SheetCalibration, calibrate, expected, subject, to_toml
    from comparisons.codes import lattice as exchange
    from comparisons.codes.cell_moduli import given_coefficients, homogenise, undamped
    from comparisons.codes.files import WRITERS
    from comparisons.codes.inverse import sheet_of
    from comparisons.codes.setup import setup, squares_of
    from comparisons.codes.table import CODES
    from comparisons.models.sizes import require_room
    from lumped import Calibration
    from sheetbench.errors import BadInput, require_choice, require_effect

    require_effect("without --cell or --from", {"--spacing": (cell or from_) is None and spacing})
    if from_ is not None:
        given = given_coefficients((scene or "").split(",") if scene else ())
        with output.open(about={"from": from_, "given": given}, variant={"--from": from_}) as out:
            density = sheet.values["density"]
            return out.show(sheet_of(from_, given, cell=cell, spacing=spacing, density=density))
    if toml and output.json:
        raise BadInput("--toml and --json: choose one")
    damped = damping.keys(loss_factor, at, band, prony)
    if sheet.young is not None and "young" in damped:
        raise BadInput("--young and --prony: the measured moduli give the long-time one; leave --young out")
    if cell is not None and scene is None:
        raise BadInput("--cell: needs a SCENE, in which its error is found")
    wanted, named = lattice.spec, scene is not None
    of = subject(scene, sheet.values | damped, "--")
    about = {"sheet": of.sheet.model_dump(mode="json"), "material": of.material.model_dump(mode="json")}
    if cell is not None:
        shape = cell if isinstance(cell, str) else cell.name
        variant = {"--cell": shape, "--spacing": spacing, "--hinge": hinge}
        with output.open(scene=of, variant=variant) as out:
            known = given_coefficients(coefficient or ())
            return out.show(homogenise(of, cell, spacing=spacing, hinge=hinge, coefficients=known))
    if for_ is not None:
        require_choice("--for", for_, tuple(dict.fromkeys([*WRITERS, *exchange.CODES])))
    if for_ not in exchange.IN_MOTION:
        require_effect(f"without --for {' or '.join(exchange.IN_MOTION)}", {"--precision": precision})
    if for_ is not None and for_ in WRITERS:
        of_springs = wanted.but(grid=None).settings
        options = {f"--{name.replace('_', '-')}": value for name, value in of_springs.items()}
        require_effect(f"with --for {for_}", options)
        if why := undamped(CODES[for_], of.material):
            require_effect(f"with --for {for_}: {why}", {"--loss-factor": loss_factor, "--prony": prony})
        found = setup(of, for_, squares_of(wanted.grid), named=named)
        with output.open(about=about, variant={"--for": for_}) as out:
            return out.show(found)
    with output.open(about=about, variant={"--for": for_} if for_ else None) as out:
        if (export is not None or for_ is not None) and not large:
            require_room(of, wanted, "--grid")
        if for_ == "sofa" and wanted.calibration is None:  # it has springs between two points alone
            wanted = wanted.but(calibration="central")
        springs = calibrate(of, wanted, named)
        foretold = named and wanted.k is None and wanted.layer_distance is None
        off = expected(of, springs) if foretold else None
        if export is not None:
            line = command_line(output.verb, output.terminal)
            out.notes.append(exchange.export(export, of, springs, line, output.overwrite))
        own = {one.name: getattr(springs, one.name) for one in fields(Calibration)}
        files = ({}, []) if for_ is None else exchange.lattice_files(of, springs, for_, precision or "double")
        answer = SheetCalibration(**own, found=springs, scene=of, expected=off, lattice=files)
        return out.show(answer, instead=to_toml(springs) + damping.to_toml(of.material) if toml else None)
