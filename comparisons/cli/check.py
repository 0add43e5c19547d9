"""`sheetbench check [SCENE]`: what will be solved, in words; the catalogue; the language of scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.cli.output import PictureOptions
from comparisons.cli.verb import no_effect

if TYPE_CHECKING:
    from comparisons.models.catalogue import Catalogue, Schema
    from comparisons.models.check import Check


@no_effect(with_schema="scene")
def command(
    scene: str | None = None,
    *,
    schema: bool = False,
    output: PictureOptions,
) -> Check | Catalogue | Schema:
    """Describe a scene and warn about likely mistakes; list the catalogue.

    Without a SCENE the catalogue is listed. --out draws the scene, and copies catalogue scenes to start from.

    Args:
        scene ([SCENE], argument): Catalogue name or path; without it, the catalogue is listed.
        schema: Print the JSON Schema of scenes, for editors; --out writes it, and a page of every key.
    """
    from warnings import catch_warnings, simplefilter

    from comparisons.models.catalogue import Catalogue, Schema
    from comparisons.models.check import check
    from sheetbench.answers.files import to_json
    from sheetbench.scenes import scene_of

    if schema:
        with output.open(variant={"--schema": True}) as out:
            answer = Schema()
            return out.show(answer, instead=None if output.out else to_json(answer.document()))
    if scene is None:
        with output.open() as out:
            return out.show(Catalogue())
    with catch_warnings():
        simplefilter("ignore")  # the report lists these warnings
        loaded = scene_of(scene)
    with output.open(scene=loaded) as out:
        return out.show(check(loaded, called=scene if isinstance(scene, str) else None))
