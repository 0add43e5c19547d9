"""`sheetbench identify SCENE`: material and support parameters from measured displacements."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from comparisons.cli.options import Kind, LatticeOptions, Metres
from comparisons.cli.output import PictureOptions
from comparisons.cli.verb import no_effect

if TYPE_CHECKING:
    from comparisons.identification.answer import Identification
    from comparisons.identification.field import FieldIdentification
    from comparisons.identification.tensile.tensile import TensileFit

OF_SCENE = "scene measured uncertainty unknown model elements law offset refine lattice grid calibration k"


@no_effect(with_tensile=f"{OF_SCENE} layer_distance grading", without_tensile="area gauge up_to")
def command(
    scene: str | None = None,
    measured: Path | None = None,
    unknown: list[str] | None = None,
    *,
    lattice: LatticeOptions,
    tensile: list[str] | None = None,
    up_to: float | None = None,
    area: Annotated[float | None, Kind("m²")] = None,
    gauge: Metres = None,
    model: str | None = None,
    elements: str | None = None,
    law: str | None = None,
    offset: Metres = None,
    uncertainty: Metres = None,
    refine: bool = True,
    large: bool = False,
    output: PictureOptions,
) -> Annotated[Identification | FieldIdentification | TensileFit, "tensile: TensileFit"]:
    """Fit material or support values to measurements of a sheet.

    Values have 95 % intervals. The search starts at the scene's values, and at others if that fit is poor.
    Without --lumped the lattice is refined until the error of its grid is below the noise. Lengths are in
    metres or the unit in a column's header (uz [mm]), in the scene's axes. --tensile fits a rubber's law and
    its constants instead.

    Args:
        scene ([SCENE], argument): Catalogue name or path; not needed for --tensile.
        measured (FILE): CSV with the columns x,y,ux,uy,uz or x,y,uz (metres; with a column time [s], a
            motion), or x,y,z of the deformed surface; or a VTP or PLY point cloud of it.
        unknown (NAMES): young (or E), poisson (nu), density (rho), thickness (h), young_1 and the other
            constants of fibres, patch1.young (or its poisson, density, thickness, angle), curvature_EDGE,
            tilt_EDGE (of a clamp), damping_time, damping_rate, loss_factor, share_N and time_N of a branch,
            drag (of the air), natural.kxx (or patch1.natural.exx and so on), mass1, obstacle1.z; or one of
            young=field, thickness=field, density=field, of every cell of the lattice. Default: young.
        tensile (FILES): A tensile test instead: CSV with stretch, strain or displacement, and
            engineering_stress, true_stress or force, each with its unit (force [N]); pure-shear=FILE or
            equibiaxial=FILE for other tests.
        up_to (STRETCH): Largest stretch of data to use (with --tensile).
        area (M2): Undeformed cross-section, 1.8e-5 or 18mm² (with --tensile and a force).
        gauge (M): Undeformed length, 33mm (with --tensile and a displacement).
        model (MODEL): lumped, shell or solid. Default: lumped.
        elements (N): The shell's or solid's elements along the shorter side, or 8x4 along x and y; default:
            {ELEMENTS}.
        offset (M): Distance of a point cloud from the mid-surface: half the thickness for the sheet's top.
        uncertainty (M): Standard deviation of every measured number, 0.001 or 1mm; a column sd [mm] gives it
            row by row. Default: standard deviation of the residuals.
        refine: Solve with other cells or elements too, for their error.
    """
    from sheetbench.errors import BadInput

    if tensile:
        from comparisons.identification.tensile.tensile import identify_tensile

        curves = identify_tensile(tensile, area=area, gauge=gauge, up_to=up_to)
        with output.open(about={"tensile": list(map(str, tensile))}) as out:
            return out.show(curves)
    if scene is None or measured is None:
        raise BadInput("identify: give a SCENE and --measured FILE, or --tensile FILE")
    from comparisons.comparison.comparison import load_static
    from comparisons.identification.identification import identify
    from comparisons.identification.model import NoAnswer
    from comparisons.models.grids import parse_elements
    from comparisons.models.spec import Lattice

    loaded = load_static(scene)
    with output.open(scene=loaded) as out:
        try:
            fit = identify(
                loaded,
                measured,
                unknown or "young",
                lattice.spec,
                model=model or Lattice.NAME,
                elements=None if elements is None else parse_elements(elements),
                law=law,
                offset=offset or 0.0,
                uncertainty=uncertainty,
                refine=refine,
            )
        except NoAnswer as error:
            out.stop(f"no answer with the scene's own values: {error}")
        return out.show(fit)
