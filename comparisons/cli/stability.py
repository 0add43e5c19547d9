"""`sheetbench stability SCENE`: where each model of a scene holds, degrades, refuses or fails."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli.options import ClusterOptions, Count, Kind, LatticeOptions
from comparisons.cli.output import PictureOptions
from sheetbench.choices import REFERENCE, VARIED


def command(
    scene: str,
    lattice: LatticeOptions,
    *,
    vary: Annotated[list[str] | None, Kind(choices=tuple(VARIED))] = None,
    reference: str = REFERENCE,
    elements: Count = 12,
    large: bool = False,
    campaign: ClusterOptions,
    output: PictureOptions,
) -> Any:
    """Map where each model is accurate, degrades, refuses or fails.

    Its load, thickness, Young's modulus, grid, damping and time step are varied over decades; of the explicit
    integrators the largest stable step is shown. With --out an interrupted run is resumed.

    Args:
        vary (NAME): Only {VARIED}; may be repeated. Default: all.
        reference (MODEL): What errors are measured from: {REFERENCES}.
        elements (N): Elements of the references along the shorter side.
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
