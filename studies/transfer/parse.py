"""What the study is to measure, from lists as people write them."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from comparisons.models.spec import items
from sheetbench.choices import AUTO, CALIBRATIONS
from sheetbench.errors import BadInput, require_choice
from studies.transfer.scenes import transfer_scenes
from studies.transfer.study import METHODS, PARTS


def methods(text: str | None) -> list[str]:
    """Calibrations, "auto" too, all of the study's unless given. Raises BadInput for another."""
    return _chosen("--methods", METHODS if text is None else items(text), (*CALIBRATIONS, AUTO))


def scenes(text: str | None) -> list[str]:
    """Names of scenes, all of the study's unless given. Raises BadInput for another."""
    return _chosen("--scenes", None if text is None else items(text), transfer_scenes())


def parts(names: Sequence[str] | None) -> list[str]:
    """Parts of the study, all unless given. Raises BadInput for another."""
    return _chosen("--part", names or None, PARTS)


def _chosen(option: str, names: Sequence[str] | None, known: Collection[str]) -> list[str]:
    for name in names or ():
        require_choice(option, name, known)
    return list(known if names is None else names)


def grids(text: str) -> list[int]:
    """Masses a side. Raises BadInput unless every one is 4 n + 1 and they grow."""
    try:
        sizes = [int(part) for part in items(text)]
    except ValueError:
        sizes = []
    if not sizes or sizes != sorted(set(sizes)) or any(n < 5 or n % 4 != 1 for n in sizes):
        raise BadInput(f"--grids = '{text}': masses a side, 4 n + 1 of them and rising, as 9,17,33")
    return sizes
