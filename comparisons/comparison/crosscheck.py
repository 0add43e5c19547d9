"""Convergence of many models on many scenes, with meshes from lists, through a campaign's store."""

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
from comparisons.sweep.solved import Request, sweep
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
    **campaign: Unpack[CampaignKeywords],
) -> Crosscheck:
    """Carry out runs missing from the store, and return every model's converged limit on every scene.

    models: candidates by their names in tables, external codes included, coarsest mesh first; codes: external
    codes by their model, installed or not. Raises BadInput, before the first run, for impossible candidates
    and for candidates that need more memory than is free.
    """
    versions = {model: code.version() for model, code in codes.items()}
    requests = [
        Request(
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
    rows = sweep(requests, store, **campaign)

    def limit(scene: Scene, name: str) -> Limit:
        tags = {"scene": scene.name, "model": name}
        return Limit.of(name, [row for row in rows if row.request.tags == tags])

    limits = {scene.name: tuple(limit(scene, name) for name in models) for scene in scenes}
    return Crosscheck(tuple(scenes), limits, codes)


def load_scenes(names: Sequence[str]) -> list[Scene]:
    """Return the scenes of names and files, `all` for the catalogue. Raises BadInput for a scene that is
    unknown, has no static answer, or shares its name with another."""
    scenes: dict[str, Scene] = {}
    for path in [path for name in names for path in (catalogue() if name == ALL else [name])]:
        scene = load_static(path)
        if scenes.setdefault(scene.name, scene) != scene:
            raise BadInput(f"{path}: another scene has its name, '{scene.name}', already")
    return list(scenes.values())


def candidates(
    grids: Sequence[str],
    lattice: Lattice,
    meshes: Mapping[str, Sequence[str]],
    codes: Mapping[str, ExternalCode],
    code_meshes: Sequence[str] | None,
) -> dict[str, list[Spec]]:
    """Return lattice, references and installed external codes, each on its meshes, coarsest first.
    code_meshes: replace each code's own. Raises BadInput for invalid lists and if no model is left."""
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
    """Return sizes along the shorter side, rising. Raises BadInput, also for a single size."""
    sizes = [parse_elements(part, option) for part in counts]
    numbers = [size for size in sizes if isinstance(size, int)]
    rising = len(numbers) == len(sizes) != 1 and numbers == sorted(set(numbers))
    if not rising or min(numbers, default=3) < least:
        listed = ",".join(counts)
        raise BadInput(
            f"{option} = '{listed}': two sizes or three along the shorter side, rising, as 8,12,16"
        )
    return numbers
