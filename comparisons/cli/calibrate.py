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
            its own sheet of triangles; sofa: the lattice's springs; numpy, matlab: the lattice and a program
            that reads it; c: one C file that steps it and finds it at rest, with a check; fmu: that as an
            FMI 3.0 unit.
        precision (NAME): Precision of the numbers (with --for c or fmu): double or single. Default: double.
        from_ (CODE): Find the sheet that belongs to another code's numbers, given in place of the SCENE as
            tri_ke=1e3,tri_ka=1e3,edge_ke=10; --cell: its mesh; --spacing: the distance of its vertices.
        cell (CELL): Stiffness of a repeated cell as a sheet, its best coefficients, the error that no finer
            mesh removes: one-diagonal, alternate-diagonals, equilateral, unstructured (triangles with
            hinges), bricks, or a TOML file with periods, nodes and elements.
        spacing (LENGTH): Distance of nodes (with --cell or --from), in m or as 5mm. Default with --cell: an
            eighth of the shorter side.
        hinge (WEIGHT): Weight w in the energy of a hinge, ½ k w θ² (with --cell): length: the edge's length;
            angle: 1; height: 3 length² over the area of both triangles. Default: length.
        coefficient (NAME=VALUE): A value to use in place of the computed coefficient (with --cell).
        loss_factor (ETA): Damping of the material, η = 2ζ = tan δ = 1/Q, with --at or --band; of a decay
            2Λ/√(4π² + Λ²), Λ = ln(peak/next peak).
        at (HZ): One damper per spring: the loss factor is right at this frequency only.
        band (LOW HIGH): Two Maxwell branches per decade, for a constant loss factor from LOW to HIGH Hz.
        prony (FILE): Young's modulus and branches from a CSV of frequency [Hz], storage, loss (or tan_delta),
            or of time [s], modulus; moduli in Pa or the unit in the header, as storage [MPa].
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
    from sheetbench.answers.report import Write
    from sheetbench.errors import BadInput, require_choice, require_effect

    require_effect("without --cell or --from", {"--spacing": (cell or from_) is None and spacing})
    if from_ is not None:
        numbers = given_coefficients((scene or "").split(",") if scene else ())
        with output.open(about={"from": from_, "given": numbers}, variant={"--from": from_}) as out:
            density = sheet.values["density"]
            return out.show(sheet_of(from_, numbers, cell=cell, spacing=spacing, density=density))
    if toml and output.json:
        raise BadInput("--toml and --json: choose one")
    damped = damping.keys(loss_factor, at, band, prony)
    if sheet.young is not None and "young" in damped:
        raise BadInput("--young and --prony: the measured moduli give the long-time one; leave --young out")
    if cell is not None and scene is None:
        raise BadInput("--cell: needs a SCENE, for its error there")
    spec, has_scene = lattice.spec, scene is not None
    loaded = subject(scene, sheet.values | damped, "--")
    material = loaded.material
    about = {"sheet": loaded.sheet.model_dump(mode="json"), "material": material.model_dump(mode="json")}
    if cell is not None:
        shape = cell if isinstance(cell, str) else cell.name
        variant = {"--cell": shape, "--spacing": spacing, "--hinge": hinge}
        with output.open(scene=loaded, variant=variant) as out:
            numbers = given_coefficients(coefficient or ())
            return out.show(homogenise(loaded, cell, spacing=spacing, hinge=hinge, coefficients=numbers))
    if for_ is not None:
        require_choice("--for", for_, tuple(dict.fromkeys([*WRITERS, *exchange.CODES])))
    if for_ not in exchange.IN_MOTION:
        require_effect(f"without --for {' or '.join(exchange.IN_MOTION)}", {"--precision": precision})
    if for_ is not None and for_ in WRITERS:
        settings = spec.but(grid=None).settings
        options = {f"--{name.replace('_', '-')}": value for name, value in settings.items()}
        require_effect(f"with --for {for_}", options)
        if reason := undamped(CODES[for_], material):
            require_effect(f"with --for {for_}: {reason}", {"--loss-factor": loss_factor, "--prony": prony})
        code_setup = setup(loaded, for_, squares_of(spec.grid), named=has_scene)
        with output.open(about=about, variant={"--for": for_}) as out:
            return out.show(code_setup)
    with output.open(about=about, variant={"--for": for_} if for_ else None) as out:
        if (export is not None or for_ is not None) and not large:
            require_room(loaded, spec, "--grid")
        if for_ == "sofa" and spec.calibration is None:  # it has springs between two points alone
            spec = spec.but(calibration="central")
        springs = calibrate(loaded, spec, has_scene)
        with_estimate = has_scene and spec.k is None and spec.layer_distance is None
        estimate = expected(loaded, springs) if with_estimate else None
        if export is not None:
            line = command_line(output.verb, output.terminal)
            out.notes.append(exchange.export(export, loaded, springs, line, output.overwrite))
        values = {entry.name: getattr(springs, entry.name) for entry in fields(Calibration)}
        files: tuple[dict[str, Write], list[str]] = ({}, [])
        if for_ is not None:
            files = exchange.lattice_files(loaded, springs, for_, precision or "double")
        answer = SheetCalibration(
            **values, calibration=springs, scene=loaded, expected=estimate, lattice=files
        )
        return out.show(answer, instead=to_toml(springs) + damping.to_toml(material) if toml else None)
