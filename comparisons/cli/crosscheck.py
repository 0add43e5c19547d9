"""`sheetbench crosscheck SCENE…`: lattice, references and external codes side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.cli.options import CampaignOptions, SpringOptions
from comparisons.cli.output import PictureOptions

if TYPE_CHECKING:
    from comparisons.comparison.crosscheck_answer import Crosscheck

SIZES = {"lumped": "9,13,17", "plate": "8,12,16", "shell": "8,12,16", "solid": "6,8,12"}


def command(
    scenes: list[str],
    lattice: SpringOptions,
    *,
    grid: list[str] | None = None,
    calibration: str | None = None,
    plate: list[str] | None = None,
    shell: list[str] | None = None,
    solid: list[str] | None = None,
    judges: list[str] | None = None,
    meshes: list[str] | None = None,
    large: bool = False,
    campaign: CampaignOptions,
    output: PictureOptions,
) -> Crosscheck:
    """Compare models and external codes, each with its convergence.

    An empty list leaves out a model, or all external codes: --solid "". Run the command again to resume.

    Args:
        scenes (SCENES, argument): Catalogue names or paths to TOML files; all: the catalogue.
        grid (N,N,N): Masses of the lattice along the shorter side, in rising order. Default: {SIZES[lumped]}.
        plate (N,N,N): Elements of the linear plate along the shorter side, in rising order. Default:
            {SIZES[plate]}.
        shell (N,N,N): Elements of the nonlinear shell along the shorter side, in rising order. Default:
            {SIZES[shell]}.
        solid (N,N,N): Elements of the nonlinear solid along the shorter side, in rising order. Default:
            {SIZES[solid]}.
        judges (NAMES): External codes, or FILE.py:OBJECT; default: all installed codes.
        meshes (N,N,N): Elements of external codes. Default: each code's own.
    """
    from comparisons.comparison.crosscheck import candidates, crosscheck, load_scenes
    from comparisons.external.answer import find_codes
    from sheetbench.errors import require_effect

    codes = find_codes(judges)
    given = dict(zip(SIZES, (grid, plate, shell, solid), strict=True))
    sizes = {name: SIZES[name].split(",") if n is None else n for name, n in given.items()}
    if not codes:
        require_effect("without external codes", {"--meshes": meshes})
    models = candidates(sizes.pop("lumped"), lattice.spec.but(calibration=calibration), sizes, codes, meshes)
    loaded = load_scenes(scenes)
    with output.open(about={"scenes": [scene.document() for scene in loaded]}) as out:
        with out.campaign(campaign) as keywords:
            answer = crosscheck(loaded, **keywords, models=models, codes=codes)
        return out.show(answer)
