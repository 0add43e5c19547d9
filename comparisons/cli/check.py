"""`sheetbench check SCENE`: what will be solved, in words, with warnings for plausible slips."""

from __future__ import annotations

from comparisons.cli.options import Json, Out, Overwrite, Scene


def command(scene: Scene, json: Json = False, out: Out = None, overwrite: Overwrite = False) -> None:
    """Say in words what a scene asks and what would be solved, and warn of what is hardly meant."""
    from comparisons.check.check import check
    from comparisons.cli.finish import finish
    from sheetbench.scenes import load

    asked = load(scene)
    with finish("check", json, out, overwrite, scene=asked) as end:
        end(check(asked, called=scene))
