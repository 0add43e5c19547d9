"""`sheetbench study transfer`: calibrations tested on scenes that they were not made on."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Annotated, Any

from comparisons.cli import console
from comparisons.cli.options import CampaignOptions, Count, Kind
from comparisons.cli.output import OutputOptions
from sheetbench.choices import AUTO, CALIBRATIONS
from sheetbench.errors import BadInput, require_choice
from studies.transfer.scenes import transfer_scenes
from studies.transfer.study import GRIDS, METHODS, PARTS, transfer
from studies.transfer.training import write_table


def command(
    methods: list[str] | None = None,
    grids: list[str] | None = None,
    grading: str | None = None,
    scenes: list[str] | None = None,
    part: Annotated[list[str] | None, Kind(choices=tuple(PARTS))] = None,
    elements: Count = 24,
    train: bool = False,
    large: bool = False,
    *,
    campaign: CampaignOptions,
    output: OutputOptions,
) -> Any:
    """Measure every calibration on many scenes, statics and frequencies, as the grid is refined.

    On drawn sheets lattices stand beside the shell with its bar. An interrupted study with --out is resumed.

    Args:
        methods (NAMES): Calibrations; all unless given.
        grids (N,N,N): Masses along the shorter side, 4 n + 1, coarsest first. Default: 9,17,33.
        scenes (NAMES): Scenes of the study; all unless given.
        part (NAMES): Only {PARTS}. All unless given.
        elements (N): Elements of the shell along a side.
        train: Only train the calibration central, and write its table."""
    calibrations = _require_known("--methods", methods, (*CALIBRATIONS, AUTO))
    names = _require_known("--scenes", scenes, transfer_scenes())
    sizes = list(GRIDS) if grids is None else _masses(grids)
    if train:
        console.print_status(f"{write_table()}: written")
        return
    with output.open() as out:
        with out.campaign(campaign) as run:
            result = transfer(
                **run,
                methods=calibrations or METHODS,
                grids=sizes,
                grading=grading,
                scenes=names or None,
                parts=part or PARTS,
                elements=elements,
                large=large,
            )
        return out.show(result)


def _require_known(name: str, values: Sequence[str] | None, choices: Collection[str]) -> Sequence[str]:
    """Return the values. Raises BadInput for an unknown one."""
    for value in values or ():
        require_choice(name, value, choices)
    return values or ()


def _masses(counts: Sequence[str]) -> list[int]:
    """Return masses a side. Raises BadInput unless every one is 4 n + 1 and they grow."""
    try:
        sizes = [int(part) for part in counts]
    except ValueError:
        sizes = []
    if not sizes or sizes != sorted(set(sizes)) or any(n < 5 or n % 4 != 1 for n in sizes):
        raise BadInput(
            f"--grids = '{','.join(counts)}': masses a side, 4 n + 1 of them and rising, as 9,17,33"
        )
    return sizes
