"""`sheetbench crosscheck SCENE…`: lattice, references and external codes side by side."""

from __future__ import annotations

from typing import Any

from comparisons.cli.options import CampaignOptions, Listed, Seconds, SpringOptions
from comparisons.cli.output import PictureOptions
from comparisons.cli.verb import no_effect
from sheetbench.choices import REFERENCE, REFERENCES

SIZES = {"lumped": "9,13,17", "plate": "8,12,16", "shell": "8,12,16", "solid": "6,8,12"}
MOVING = {"lumped": "9,17", "plate": "4,8", "shell": "4,8", "solid": "2,4", "meshes": "4,8"}


@no_effect(with_duration="workers retry")
def command(
    scenes: list[str],
    lattice: SpringOptions,
    *,
    grid: Listed = None,
    calibration: str | None = None,
    plate: Listed = None,
    shell: Listed = None,
    solid: Listed = None,
    judges: Listed = None,
    meshes: Listed = None,
    duration: Seconds = None,
    large: bool = False,
    campaign: CampaignOptions,
    output: PictureOptions,
) -> Any:
    """Compare models and external codes, each with its convergence.

    An empty list leaves a model, or all external codes, out: --solid "". An interrupted run is resumed.

    Args:
        scenes (SCENES, argument): Catalogue names or paths to TOML files; all: the catalogue.
        grid (N,N,N): Masses of the lattice along the shorter side, in rising order. Default: {SIZES[lumped]};
            {MOVING[lumped]} with --duration.
        plate (N,N,N): Elements of the linear plate along the shorter side, in rising order. Default:
            {SIZES[plate]}; {MOVING[plate]} with --duration.
        shell (N,N,N): Elements of the nonlinear shell along the shorter side, in rising order. Default:
            {SIZES[shell]}; {MOVING[shell]} with --duration.
        solid (N,N,N): Elements of the nonlinear solid along the shorter side, in rising order. Default:
            {SIZES[solid]}; {MOVING[solid]} with --duration.
        judges (NAMES): External codes, with commas, or FILE.py:OBJECT; default: all that are installed.
        meshes (N,N,N): Elements of external codes. Default: each code's own; {MOVING[meshes]} with
            --duration.
        duration (S): Compare the motion of one scene over this time instead, each model on the finest of its
            meshes.
    """
    from comparisons.comparison.crosscheck import candidates, crosscheck, load_scenes
    from comparisons.comparison.motion import compare_motion
    from comparisons.external.answer import find_codes
    from comparisons.models.spec import Elements, Lattice, items
    from sheetbench.errors import BadInput, require_effect
    from sheetbench.scenes import scene_of

    codes = find_codes(None if judges is None else items(judges))
    usual = SIZES if duration is None else MOVING
    given = dict(zip(("lumped", *REFERENCES), (grid, plate, shell, solid), strict=True))
    sizes = {name: usual[name] if text is None else text for name, text in given.items()}
    if not codes:
        require_effect("without external codes", {"--meshes": meshes})
    meshes = usual.get("meshes") if meshes is None else meshes
    models = candidates(sizes.pop("lumped"), lattice.spec.but(calibration=calibration), sizes, codes, meshes)
    if duration is not None:
        finest = {name: of[-1] for name, of in models.items()}
        own, shell_spec = finest.pop(Lattice.NAME, None), finest.pop(REFERENCE, None)
        if len(scenes) > 1 or not isinstance(own, Lattice) or not isinstance(shell_spec, Elements):
            raise BadInput("--duration: one scene, a lattice, and a shell that others are measured against")
        scene = scene_of(*scenes)
        with output.open(scene=scene, variant={"--duration": duration}) as out:
            others, kept = list(finest.values()), out.reserve("runs/")
            return out.show(
                compare_motion(scene, duration, own, shell_spec, models=others, leave_out=True, store=kept)
            )
    chosen = load_scenes(scenes)
    with output.open(about={"scenes": [scene.document() for scene in chosen]}) as out:
        with out.campaign(campaign) as run:
            checked = crosscheck(chosen, **run, models=models, codes=codes)
        return out.show(checked)
