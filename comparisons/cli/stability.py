"""`sheetbench stability SCENE`: ranges in which each model of a scene holds, degrades, refuses or fails."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from comparisons.cli.options import CampaignOptions, Kind, LatticeOptions
from comparisons.cli.output import PictureOptions
from sheetbench.choices import REFERENCE, VARIED

if TYPE_CHECKING:
    from comparisons.stability.answer import Stability


def command(
    scene: str,
    lattice: LatticeOptions,
    *,
    vary: Annotated[list[str] | None, Kind(choices=tuple(VARIED))] = None,
    reference: str = REFERENCE,
    elements: str = "12",
    large: bool = False,
    campaign: CampaignOptions,
    output: PictureOptions,
) -> Stability:
    """Map where each model is accurate, degrades, refuses or fails.

    Load, thickness, Young's modulus, grid, damping and time step are varied over decades; for explicit
    integrators the largest stable step is shown. Run the command again with --out to resume.

    Args:
        vary (NAMES): Only {VARIED}. Default: all.
        reference (MODEL): Reference of the errors: {REFERENCES}.
        elements (N): Elements of the references along the shorter side, or 8x4 along x and y.
    """
    from comparisons.models.grids import parse_elements
    from comparisons.stability.extremes import stability
    from sheetbench.errors import BadInput
    from sheetbench.scenes import scene_of

    if any(style.narrow for style in output.styles):
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
                elements=parse_elements(elements),
            )
        return out.show(maps)
