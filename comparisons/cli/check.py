"""`sheetbench check SCENE`: what will be solved, in words, with warnings for plausible slips."""

from __future__ import annotations

from comparisons.cli.options import Json, Out, Overwrite, Scene


def command(scene: Scene, json: Json = False, out: Out = None, overwrite: Overwrite = False) -> None:
    """Explain a scene in plain words and warn about likely mistakes."""
    from warnings import catch_warnings, simplefilter

    from comparisons.check.check import check
    from comparisons.cli.finish import finish
    from sheetbench.scenes import load

    with catch_warnings():
        simplefilter("ignore")  # the report has them
        asked = load(scene)
    with finish("check", json, out, overwrite, scene=asked) as end:
        end(check(asked, called=scene))
