"""`sheetbench calibrate`: spring constants from E, ν, density, thickness, sides and grid."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from comparisons.cli.options import Export, Grading, Grid, K, Large, LayerDistance, SheetOptions, option
from comparisons.cli.output import OutputOptions
from sheetbench.choices import CALIBRATION, CALIBRATIONS

DAMPING = ("--loss-factor", "--damping-ratio", "--log-decrement", "--quality", "--prony")


def command(
    scene: Annotated[
        str | None, typer.Argument(metavar="[SCENE]", help="Scene with the sheet and its material.")
    ] = None,
    *,
    sheet: SheetOptions,
    grid: Grid = None,
    grading: Grading = None,
    calibration: Annotated[
        str | None,
        option(
            "; ".join(f"{n}: {m.summary}" for n, m in CALIBRATIONS.items())
            + f"; auto: by the SCENE, as with --grading auto. Default: {CALIBRATION}.",
            "NAME",
            "--calibration",
            "--method",
        ),
    ] = None,
    k: K = None,
    layer_distance: LayerDistance = None,
    toml: Annotated[bool, option("Print the \\[springs] table for a scene file.")] = False,
    export: Export = None,
    simulators: Annotated[
        list[str] | None,
        option(
            "Parameters, mesh and scene for another code: newton, mujoco, pybullet, genesis, sofa, arcsim, "
            "c-ipc, ppf, openusd; as files with --out. Together with --export: the lattice's springs for "
            "mujoco or sofa, of a calibration without area springs (--calibration central).",
            "NAME",
            "--for",
        ),
    ] = None,
    loss_factor: Annotated[
        float | None, option("Damping of the material, η = 2ζ = tan δ = 1/Q, with --at or --band.", "ETA")
    ] = None,
    damping_ratio: Annotated[
        float | None, option("Damping as ζ, a fraction of critical damping.", "ZETA")
    ] = None,
    log_decrement: Annotated[
        float | None, option("Damping as the logarithmic decrement of a decay, ln(peak/next peak).", "DELTA")
    ] = None,
    quality: Annotated[float | None, option("Damping as the quality factor of a resonance.", "Q")] = None,
    at: Annotated[
        float | None,
        option("One damper per spring: the loss factor is right at this frequency only.", "HZ", unit="Hz"),
    ] = None,
    band: Annotated[
        tuple[float, float] | None,
        option("Two Maxwell branches a decade, which keep the loss factor from LOW to HIGH Hz.", "LOW HIGH"),
    ] = None,
    prony: Annotated[
        Path | None,
        option(
            "Young's modulus and branches from a CSV of frequency \\[Hz], storage, loss (or tan_delta), "
            "or of time \\[s], modulus; moduli in Pa or as the header has it, storage \\[MPa].",
            "FILE",
        ),
    ] = None,
    large: Large = False,
    output: OutputOptions,
) -> None:
    """Find the spring constants of a lattice, and report which of the sheet's moduli they meet.

    Give a SCENE, or --young --poisson --thickness --side; with both, the options change the scene's values.
    The fitted methods train on the SCENE; without one, on the sheet under its own weight with one edge and
    with two adjacent edges clamped. --export writes the lattice of the SCENE, or of the sheet with one edge
    clamped.
    """
    from comparisons.calibration import damping
    from comparisons.calibration.answer import SheetCalibration, to_toml
    from comparisons.calibration.calibrate import calibrate, expected, subject
    from comparisons.models.sizes import require_room
    from comparisons.models.spec import Lattice
    from sheetbench.errors import BadInput, require_effect

    if toml and output.json:
        raise BadInput("--toml and --json: choose one")
    if simulators and export is None:
        if len(simulators) > 1:
            raise BadInput("--for: one code at a time, but with --export")
        springs_only = {
            "--calibration": calibration,
            "--k": k,
            "--layer-distance": layer_distance,
            "--grading": grading,
            "--toml": toml or None,
        }
        if given := [name for name, value in springs_only.items() if value is not None]:
            raise BadInput(f"{given[0]}: of the lattice's springs, which --for has with --export alone")
    damped = damping.keys(loss_factor, damping_ratio, log_decrement, quality, at, band, prony)
    if sheet.young is not None and "young" in damped:
        raise BadInput("--young and --prony: the measured moduli give the long-time one; leave --young out")
    of = subject(scene, sheet.values | damped, "--")
    about = {"sheet": of.sheet.model_dump(mode="json"), "material": of.material.model_dump(mode="json")}
    if simulators and export is None:
        from comparisons.cells.codes import CODES
        from comparisons.cells.parameters import undamped
        from comparisons.codes.setup import setup, squares_of

        if damped and (code := CODES.get(simulators[0])) and (why := undamped(code, of.material)):
            options = zip(DAMPING, (loss_factor, damping_ratio, log_decrement, quality, prony), strict=True)
            require_effect(f"with --for {code.name}: {why}", dict(options))
        found = setup(of, simulators[0], squares_of(grid), named=scene is not None)
        with output.open(about=about, variant={"--for": simulators[0]}) as out:
            out.show(found)
        return
    with output.open(about=about) as out:
        if export is not None and not large:
            require_room(of, Lattice(grid), "--grid")
        lattice = Lattice(grid, calibration, k, layer_distance, grading)
        springs = calibrate(of, lattice, scene is not None)
        foretold = scene is not None and k is None and layer_distance is None
        off = expected(of, springs) if foretold else None
        swinging = damping.ratios(of, springs)
        out.export(export, of, springs, simulators or ())
        out.show(
            SheetCalibration(springs, of, off, swinging),
            instead=to_toml(springs) + damping.to_toml(of.material) if toml else None,
        )
