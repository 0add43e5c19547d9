"""`sheetbench stability SCENE`: where each model of a scene holds, degrades, refuses or fails."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli.options import ClusterOptions, Large, LatticeOptions, Scene, option
from comparisons.cli.output import PictureOptions
from sheetbench.choices import REFERENCE, REFERENCES, VARIED, listed


def command(
    scene: Scene,
    lattice: LatticeOptions,
    *,
    vary: Annotated[
        list[str] | None,
        option(
            f"Only {listed(VARIED)}; may be repeated. Default: all.",
            "NAME",
            choices=VARIED,
        ),
    ] = None,
    reference: Annotated[
        str, option(f"What errors are measured from: {listed(REFERENCES)}.", "MODEL")
    ] = REFERENCE,
    elements: Annotated[int, option("Elements of the references along the shorter side.", "N", min=1)] = 12,
    large: Large = False,
    campaign: ClusterOptions,
    output: PictureOptions,
) -> Any:
    """Map where each model is accurate, degrades, refuses or fails.

    Its load, thickness, Young's modulus, grid, damping and time step are varied over decades; of the explicit
    integrators the largest stable step is measured. With --out an interrupted run is resumed.
    """
    from comparisons.stability.extremes import stability
    from sheetbench.answers.figure_style import parse_figure
    from sheetbench.errors import BadInput
    from sheetbench.scenes import scene_of

    if any(style.narrow for style in parse_figure(output.figure)):
        raise BadInput("--figure: maps with their numbers need both columns; leave ':single' out")
    loaded = scene_of(scene)
    with output.open(scene=loaded) as out:
        with out.campaign(campaign) as run:
            maps = stability(
                loaded,
                **run,
                varied=vary or VARIED,
                lattice=lattice.spec,
                reference=reference,
                elements=elements,
            )
        return out.show(maps)
