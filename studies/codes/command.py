"""`sheetbench study codes`: other people's codes and our models on the reference set, error and time."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli import console
from comparisons.cli.options import Kind, Models
from comparisons.cli.output import PictureOptions
from studies.codes.answer import codes
from studies.codes.models import SIZES, measure_models, measure_sizes
from studies.codes.trials import run_trials


def command(
    code: list[str] | None = None,
    seconds: float = 60.0,
    budget: float = 1e9,
    ladder: Annotated[list[str] | None, Kind(choices=tuple(SIZES))] = None,
    standing: bool = False,
    model: Models = None,
    suite: Annotated[str, Kind(choices=("statics", "curves"))] = "statics",
    *,
    output: PictureOptions,
) -> Any:
    """Show errors and times of other codes, with numbers in use and with ours, beside our models.

    CODE=PYTHON runs missing or changed rows of a code; rows with unchanged inputs stay.

    Args:
        code (CODE=PYTHON, argument): newton=.venv-newton/bin/python; none: the stored rows.
        seconds: Limit of a run, of processor time.
        budget: Seconds after which no further run of a code begins.
        ladder (NAMES): Measure sizes of {SIZES} on test 1.
        standing: Measure models on a suite, into the reference set's file.
        model (MODELS): Models of --standing: as mujoco:grid=9.
        suite (SUITE): Suite of --standing: statics or curves."""
    with output.open() as out:
        for text in code or ():
            name, _, python = text.partition("=")
            run_trials(name, python, seconds, budget, console.print_status)
        for name in ladder or ():
            measure_sizes(name, console.print_status)
        if standing or model:
            measure_models(model or (), console.print_status, suite)
        return out.show(codes())
