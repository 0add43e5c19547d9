"""`sheetbench sweep SCENE --vary KEY=VALUES`: every model on every variant of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from comparisons.cli.options import CampaignOptions, Kind, LatticeOptions, Models
from comparisons.cli.output import PictureOptions
from sheetbench.choices import REFERENCE

if TYPE_CHECKING:
    from comparisons.sweep.variation import Variation


def command(
    scene: str,
    vary: Annotated[list[str], Kind(separator=r",(?=\s*[a-z_][\w.]*=)")],
    lattice: LatticeOptions,
    *,
    reference: str = REFERENCE,
    elements: str | None = None,
    law: str | None = None,
    model: Models = None,
    large: bool = False,
    campaign: CampaignOptions,
    output: PictureOptions,
) -> Variation:
    """Solve a scene for many values of its keys.

    Lattice, reference and further models are solved for every combination of values; run it again to resume.

    Args:
        vary (KEY=VALUES): A key of the scene's file and its values: sheet.thickness=1mm,2mm,
            material.young=0.3MPa..3MPa:5 (five from end to end), support.1.tilt=0,0.1.
        reference (MODEL): Reference of the errors: {REFERENCES}; "" for none.
        elements (N): The reference's elements along the shorter side, or 8x4 along x and y; default:
            {ELEMENTS}.
    """
    from comparisons.models.grids import parse_elements
    from comparisons.models.spec import Elements, parse
    from comparisons.sweep.variation import vary as varied
    from sheetbench.errors import require_effect
    from sheetbench.scenes import scene_of

    truth = None
    if reference:
        count = None if elements is None else parse_elements(elements)
        truth = Elements.given(reference, {"elements": count, "law": law})
    else:
        require_effect("without a reference", {"--elements": elements, "--law": law})
    loaded = scene_of(scene)
    models = [lattice.spec, *map(parse, model or ())]
    with output.open(scene=loaded) as out:
        with out.campaign(campaign) as keywords:
            answer = varied(loaded, vary, models=models, reference=truth, **keywords)
        return out.show(answer)
