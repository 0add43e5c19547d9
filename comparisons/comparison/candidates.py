"""Scenes and candidates of a cross-check, from lists as people write them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from comparisons.comparison.comparison import load_static
from comparisons.external.installed import InstalledCode
from comparisons.models.grids import parse_elements
from comparisons.models.spec import Elements, External, Lattice, Spec, items
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, catalogue

ALL = "all"


def load_scenes(names: Sequence[str]) -> list[Scene]:
    """Return the scenes of names and files, `all` for the catalogue.

    Raises BadInput for one that does not exist, has no static answer, or shares its name with another.
    """
    scenes: dict[str, Scene] = {}
    for name in names:
        for each in catalogue() if name == ALL else [name]:
            scene = load_static(each)
            if scenes.setdefault(scene.name, scene) != scene:
                raise BadInput(f"{each}: another scene has its name, '{scene.name}', already")
    return list(scenes.values())


def candidates(
    grids: str,
    lattice: Lattice,
    meshes: Mapping[str, str],
    codes: Sequence[InstalledCode],
    code_meshes: str | None,
) -> dict[str, list[Spec]]:
    """Return lattice, references and installed external codes, each on its meshes, coarsest first.

    code_meshes: in place of each code's own. Raises BadInput for what cannot be read and for nothing at all.
    """
    models: dict[str, list[Spec]] = {}
    if sizes := _numbers("--lumped", grids, 3):
        models[lattice.model] = [lattice.but(grid=n) for n in sizes]
    for name, text in meshes.items():
        if sizes := _numbers(f"--{name}", text, 1):
            models[name] = [Elements(name, n) for n in sizes]
    for one in codes:
        if one.version is not None:
            sizes = list(one.code.meshes) if code_meshes is None else _numbers("--meshes", code_meshes, 1)
            models[one.code.name] = [External(one.model, {"elements": n}) for n in sizes]
    if not models:
        raise BadInput("no model left to check")
    return models


def _numbers(option: str, text: str, least: int) -> list[int]:
    """Sizes along the shorter side, rising. Raises BadInput, for one alone too: two at least show a
    change."""
    sizes = [parse_elements(part, option) for part in items(text)]
    numbers = [size for size in sizes if isinstance(size, int)]
    fine = (
        len(numbers) == len(sizes) != 1
        and numbers == sorted(set(numbers))
        and min(numbers, default=3) >= least
    )
    if not fine:
        raise BadInput(f"{option} = '{text}': two sizes or three along the shorter side, rising, as 8,12,16")
    return numbers
