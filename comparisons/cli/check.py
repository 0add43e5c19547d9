"""`sheetbench check SCENE`: what will be solved, in words, with warnings for plausible slips."""

from __future__ import annotations

from comparisons.cli.options import Scene
from comparisons.cli.output import PictureOptions


def command(scene: Scene, *, output: PictureOptions) -> None:
    """Explain a scene in plain words and warn about likely mistakes."""
    from warnings import catch_warnings, simplefilter

    from comparisons.check.check import check
    from sheetbench.scenes import load

    with catch_warnings():
        simplefilter("ignore")  # the report has them
        loaded = load(scene)
    with output.open(scene=loaded) as out:
        out.show(check(loaded, called=scene))
