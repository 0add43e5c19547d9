"""`sheetbench tradeoff SCENE`: error against time, over models, grids and calibrations."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

from comparisons.cli.options import ClusterOptions, Large, Models, Scene, SpringOptions, Symmetry, option
from comparisons.cli.output import PictureOptions
from comparisons.cli.verb import no_effect
from comparisons.tradeoff.usual import GRIDS, MESHES, MOVING, PAIRS, REPEATS, SPRINGS
from sheetbench.choices import CALIBRATIONS, INTEGRATORS, REFERENCES, listed


def _elements(name: str, what: str) -> Any:
    """The option of a reference's meshes."""
    usual = f"default: {MESHES[name]}; {MOVING[name]} with --duration"
    text = f"Elements of the {what} along the shorter side, or NxM; {usual}."
    return option(text, "ELEMENTS", listed=True)


OF_ROWS = "lumped_pair model symmetry elements repeats duration integrator workers scheduler wait retry"


@no_effect(
    with_tolerance=OF_ROWS,
    with_budget=OF_ROWS,
    with_duration="symmetry lumped_pair repeats",
    without_duration="integrator",
)
def command(
    scene: Scene,
    lattice: SpringOptions,
    *,
    tolerance: Annotated[
        float | None,
        option(
            "Find the cheapest model with no larger error, as 0.01 or 1%, with as few solves as possible. "
            "0.01 with --budget alone. Empty lists leave models out.",
            "FRACTION",
            unit="",
        ),
    ] = None,
    budget: Annotated[
        float | None,
        option(
            "The most accurate model that is solved in this time, set-up not included.", "SECONDS", unit="s"
        ),
    ] = None,
    grid: Annotated[
        str | None,
        option(
            "Masses of lattices: along the shorter side with near-square cells, or NxM, NxMxL. "
            f"Default: {GRIDS}; 9 with --duration.",
            "GRIDS",
            "--lumped",
            "--grid",
            listed=True,
        ),
    ] = None,
    lumped_pair: Annotated[
        str | None,
        option(
            "Pairs of grids, the coarser first, and one answer extrapolated from both, with its error "
            f"bar. Default: {PAIRS}, none where grids or other springs are listed.",
            "PAIRS",
            listed=True,
        ),
    ] = None,
    calibration: Annotated[
        str | None,
        option(
            f"Calibrations of every grid: {listed(CALIBRATIONS)}; auto: by the scene. Default: {SPRINGS}; "
            "with --duration that of `simulate`.",
            "NAMES",
            listed=True,
        ),
    ] = None,
    plate: Annotated[str | None, _elements("plate", "linear plate")] = None,
    shell: Annotated[str | None, _elements("shell", "nonlinear shell")] = None,
    solid: Annotated[str | None, _elements("solid", "nonlinear solid")] = None,
    model: Models = None,
    symmetry: Symmetry = False,
    elements: Annotated[
        str | None,
        option(
            "Elements of the reference shell along the shorter side, or 8x4 along x and y; default: "
            "twice the finest one's, at least 32; 16 with --duration.",
            "N",
        ),
    ] = None,
    repeats: Annotated[
        int | None,
        option("Least number of timed solves of every row at rest.", "N", show_default=str(REPEATS), min=1),
    ] = None,
    duration: Annotated[
        float | None,
        option(
            "Trade-off of the motion over this time instead: lattices by integrator and step, the other "
            "models by their error per step.",
            "S",
            unit="s",
        ),
    ] = None,
    integrator: Annotated[
        str | None,
        option(
            "With --duration: the integrators.",
            "NAMES",
            listed=True,
            show_default=", ".join(sorted(INTEGRATORS)),
        ),
    ] = None,
    large: Large = False,
    campaign: ClusterOptions,
    output: PictureOptions,
) -> Any:
    """Trade error against time over models, or choose the cheapest.

    What each model gets wrong and what it costs; run it again to resume. An empty list leaves a model out:
    --solid "". With --tolerance or --budget it names one model and the command that solves it; exit status 3
    where none meets the tolerance.
    """
    from comparisons.comparison.comparison import load_static
    from comparisons.models.spec import items
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
        require_effect(
            "with --tolerance or --budget", {f"--{name}": of or None for name, of in lists.items()}
        )
        models = [name for name, of in lists.items() if of is None and name != "solid"]
        with output.open(scene=loaded, variant={"--tolerance": True}) as out:
            found = advise(loaded, tolerance, budget, lattice.spec, models=models, calibration=calibration)
            return out.show(replace(found, called=scene) if isinstance(scene, str) else found)
    own, usual = lattice.spec, MESHES if duration is None else MOVING
    others, extra = choices.of_references(meshes, usual, symmetry), choices.named(model or ())
    reference = choices.finest(elements)
    if duration is not None:
        more: dict[str, Any] = {"lattices": choices.moving_lattices(own, grid, calibration)}
        measure: Any = dynamic_tradeoff
        more |= {"duration": duration, "integrators": items(integrator) or sorted(INTEGRATORS)}
        more |= {"others": [*others, *extra]}
    else:
        measure = tradeoff
        lattices, reasons = choices.of_lattices(loaded, own, grid, lumped_pair, calibration)
        lattices = [one.but(symmetry=True) for one in lattices] if symmetry else lattices
        more = {"candidates": [*lattices, *others, *extra], "reasons": reasons, "repeats": repeats or REPEATS}
        if not more["candidates"]:
            raise BadInput("no model left to measure")
    with output.open(scene=loaded) as out:
        with out.campaign(campaign) as run:
            traded = measure(loaded, **run, reference=reference, **more)
        return out.show(traded)
