"""Verbs and options that are gone, each with what replaces it."""

from __future__ import annotations

from collections.abc import Sequence

VERBS = {
    "transfer": "run 'sheetbench study transfer' in a checkout",
    "view": "write a folder with --out and run 'sheetbench report DIR --open': its page turns the sheets; in "
    "Python, solution.to_pyvista().warp_by_vector().plot() opens a window",
}
OPTIONS = {
    ("compare", "--auto"): "'sheetbench advise SCENE' chooses a model and prints the command that solves it",
    ("compare", "--tolerance"): "give it to 'sheetbench advise SCENE', which prints the command to run",
    ("stability", "--study"): "'sheetbench study stability' has the published maps, in a checkout; "
    "'sheetbench stability SCENE --vary NAME' those of your sheet",
    ("stability", "--full"): "'sheetbench study stability --full' has the published maps, in a checkout",
    (
        "verify",
        "--locking",
    ): "'--case locking-plate --case locking-shell --case locking-solid' draws the picture",
    ("verify", "--laws"): "'--case strain-laws' has the table",
    ("verify", "--coverage"): "run 'sheetbench study coverage' in a checkout",
}


def refusal(arguments: Sequence[str]) -> str | None:
    """Return the sentence that refuses a verb or option that is gone; None where there is none."""
    verb, *others = arguments or [""]
    if verb in VERBS:
        return f"{verb}: removed; {VERBS[verb]}"
    for option in (other.partition("=")[0] for other in others):
        if (verb, option) in OPTIONS:
            return f"{verb} {option}: removed; {OPTIONS[verb, option]}"
    return None
