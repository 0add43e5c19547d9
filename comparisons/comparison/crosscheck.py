"""Scenes × models × meshes, from lists as people write them, through a campaign's store: a model's limit on
every scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Unpack

from comparisons.comparison.comparison import load_static
from comparisons.comparison.crosscheck_answer import Crosscheck
from comparisons.external.answer import ExternalCode
from comparisons.models.grids import parse_elements
from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, External, Lattice, Spec
from comparisons.sweep.campaign import CampaignKeywords
from comparisons.sweep.limits import Limit
from comparisons.sweep.solved import Ask, sweep
from comparisons.sweep.store import Store
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, catalogue

ALL = "all"


def crosscheck(
    scenes: Sequence[Scene],
    store: Store,
    *,
    models: Mapping[str, Sequence[Spec]],
    codes: Mapping[str, ExternalCode] = {},
    **how: Unpack[CampaignKeywords],
) -> Crosscheck:
    """Carry out what the store does not have, and return every model's limit on every scene.

    models: candidates by what tables call them, coarsest mesh first, those of external codes among them;
    codes: the external ones by the model that selects them, absent too. Raises BadInput, before the first
    run, for candidates that cannot be and for those that take more memory than there is.
    """
    versions = {model: code.version() for model, code in codes.items()}
    asks = [
        Ask(
            resolve(scene, spec).scene,
            spec,
            version=versions.get(spec.model),
            tags={"scene": scene.name, "model": name},
            label=f"{scene.name}, {name} {spec.size}",
        )
        for scene in scenes
        for name, specs in models.items()
        for spec in specs
    ]
    rows = sweep(asks, store, **how)

    def limit(scene: Scene, name: str) -> Limit:
        tags = {"scene": scene.name, "model": name}
        return Limit.of(name, [row for row in rows if row.ask.tags == tags])

    limits = {scene.name: tuple(limit(scene, name) for name in models) for scene in scenes}
    return Crosscheck(tuple(scenes), limits, codes)


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
    grids: Sequence[str],
    lattice: Lattice,
    meshes: Mapping[str, Sequence[str]],
    codes: Mapping[str, ExternalCode],
    code_meshes: Sequence[str] | None,
) -> dict[str, list[Spec]]:
    """Return lattice, references and installed external codes, each on its meshes, coarsest first.

    code_meshes: in place of each code's own. Raises BadInput for what cannot be read and for nothing at all.
    """
    models: dict[str, list[Spec]] = {}
    if sizes := _numbers("--lumped", grids, 3):
        models[lattice.model] = [lattice.but(grid=n) for n in sizes]
    for name, counts in meshes.items():
        if sizes := _numbers(f"--{name}", counts, 1):
            models[name] = [Elements(name, n) for n in sizes]
    for model, code in codes.items():
        if code.version() is not None:
            sizes = list(code.meshes) if code_meshes is None else _numbers("--meshes", code_meshes, 1)
            models[code.name] = [External(model, {"elements": n}) for n in sizes]
    if not models:
        raise BadInput("no model left to check")
    return models


def _numbers(option: str, counts: Sequence[str], least: int) -> list[int]:
    """Sizes along the shorter side, rising. Raises BadInput, for one alone too: two at least show a
    change."""
    sizes = [parse_elements(part, option) for part in counts]
    numbers = [size for size in sizes if isinstance(size, int)]
    fine = (
        len(numbers) == len(sizes) != 1
        and numbers == sorted(set(numbers))
        and min(numbers, default=3) >= least
    )
    if not fine:
        listed = ",".join(counts)
        raise BadInput(
            f"{option} = '{listed}': two sizes or three along the shorter side, rising, as 8,12,16"
        )
    return numbers
