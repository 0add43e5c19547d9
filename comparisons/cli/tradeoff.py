"""`sheetbench tradeoff SCENE`: error against time, over models, grids and calibrations."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from comparisons.cli.options import CampaignOptions, Kind, Models, Seconds, Share, SpringOptions
from comparisons.cli.output import PictureOptions
from comparisons.cli.verb import no_effect
from comparisons.tradeoff import usual
from sheetbench.choices import INTEGRATORS, REFERENCE, REFERENCES

if TYPE_CHECKING:
    from comparisons.tradeoff.advice import Advice
    from comparisons.tradeoff.answer import DynamicTradeoff, Tradeoff

OF_ROWS = "model elements repeats duration integrator workers scheduler retry"


@no_effect(
    with_tolerance=OF_ROWS,
    with_budget=OF_ROWS,
    with_duration="repeats",
    without_duration="integrator",
)
def command(
    scene: str,
    lattice: SpringOptions,
    *,
    tolerance: Share = None,
    budget: Seconds = None,
    grid: list[str] | None = None,
    calibration: list[str] | None = None,
    plate: list[str] | None = None,
    shell: list[str] | None = None,
    solid: list[str] | None = None,
    model: Models = None,
    elements: str | None = None,
    repeats: Annotated[int | None, Kind(least=1)] = None,
    duration: Seconds = None,
    integrator: list[str] | None = None,
    large: bool = False,
    campaign: CampaignOptions,
    output: PictureOptions,
) -> Annotated[
    Tradeoff | DynamicTradeoff | Advice,
    "duration: DynamicTradeoff",
    "tolerance: Advice",
    "budget: Advice",
]:
    """Trade error against time over models, or choose the cheapest.

    Errors and costs of many models are listed; run it again to resume. An empty list leaves a model out:
    --solid "". The options --tolerance and --budget choose one model, with the command that solves it; exit
    status 3 if none meets the tolerance.

    Args:
        tolerance (FRACTION): Find the cheapest model within this error, as 0.01 or 1%, with as few solves as
            possible. Empty lists leave models out.
        budget (SECONDS): Find the most accurate model within this solve time, set-up not included.
        grid (GRIDS): Masses of lattices: along the shorter side with near-square cells, or NxM, NxMxL.
            Default: {usual.GRIDS}; 9 with --duration.
        calibration (NAMES): Calibrations of every grid: {CALIBRATIONS}; auto: by the scene. Default:
            {usual.SPRINGS}; with --duration as in `simulate`.
        plate (ELEMENTS): Elements of the linear plate along the shorter side, or NxM; default:
            {usual.MESHES[plate]}.
        shell (ELEMENTS): Elements of the nonlinear shell along the shorter side, or NxM; default:
            {usual.MESHES[shell]}; {usual.MOVING[shell]} with --duration.
        solid (ELEMENTS): Elements of the nonlinear solid along the shorter side, or NxM; default:
            {usual.MESHES[solid]}; {usual.MOVING[solid]} with --duration.
        elements (N): Elements of the reference shell along the shorter side, or 8x4 along x and y; default:
            twice the finest shell's, at least 32; 16 with --duration.
        repeats (N): Least number of timed solves of every row at rest. Default: {usual.REPEATS}.
        duration (S): Trade-off of the motion over this time instead: lattices by integrator and step, the
            other models by their error per step.
        integrator (NAMES): Some of {INTEGRATORS} (with --duration). Default: all.
    """
    from comparisons.comparison.comparison import load_static
    from comparisons.models.grids import parse_elements
    from comparisons.models.spec import Elements, parse
    from comparisons.tradeoff import choices
    from comparisons.tradeoff.advisor import advise
    from comparisons.tradeoff.motion import dynamic_tradeoff
    from comparisons.tradeoff.statics import tradeoff
    from sheetbench.errors import BadInput, require_effect
    from sheetbench.scenes import scene_of

    loaded = scene_of(scene) if duration is not None else load_static(scene)
    meshes = dict(zip(REFERENCES, (plate, shell, solid), strict=True))
    if tolerance is not None or budget is not None:
        lists = {"lumped": grid, **meshes}
        require_effect("with --tolerance or --budget", {f"--{name}": n for name, n in lists.items()})
        if len(calibration or ()) > 1:
            raise BadInput("--calibration: with --tolerance or --budget one calibration")
        models = [name for name, n in lists.items() if n is None and name != "solid"]
        springs = lattice.spec if not calibration else lattice.spec.but(calibration=calibration[0])
        with output.open(scene=loaded, variant={"--tolerance": True}) as out:
            advice = advise(loaded, tolerance, budget, springs, models=models)
            return out.show(replace(advice, called=scene) if isinstance(scene, str) else advice)
    default_meshes = usual.MESHES | ({} if duration is None else usual.MOVING)
    others = [*choices.of_references(meshes, default_meshes), *map(parse, model or ())]
    reference = None if elements is None else Elements(REFERENCE, parse_elements(elements))
    if duration is not None:
        measure: Any = dynamic_tradeoff
        arguments: dict[str, Any] = {
            "lattices": choices.moving_lattices(lattice.spec, grid, calibration),
            **{"duration": duration, "integrators": integrator or sorted(INTEGRATORS), "others": others},
        }
    else:
        measure = tradeoff
        lattices, reasons = choices.of_lattices(loaded, lattice.spec, grid, calibration)
        repeats = repeats or usual.REPEATS
        arguments = {"candidates": [*lattices, *others], "reasons": reasons, "repeats": repeats}
        if not arguments["candidates"]:
            raise BadInput("no model left to measure")
    with output.open(scene=loaded) as out:
        with out.campaign(campaign) as keywords:
            answer = measure(loaded, **keywords, reference=reference, **arguments)
        return out.show(answer)
