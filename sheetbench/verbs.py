"""Functions of `import sheetbench` for the verbs that keep rows, write files or read folders.

Each takes what its verb takes and returns what the verb reports on: an object with `report()`, a Report, or
the path of what was written. Those with `workers` compute in processes of their own: a script calls them
under `if __name__ == "__main__":`.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from comparisons.models.context import large_in_context
from comparisons.models.keywords import LatticeKeywords, SpringKeywords
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice, items
from sheetbench.choices import REFERENCE, REFERENCES
from sheetbench.errors import require_choice, require_effect
from sheetbench.scenes import AnyScene, Scene, scene_of
from sheetbench.scenes.schema import for_editors

if TYPE_CHECKING:
    from comparisons.crosscheck.crosscheck import Crosscheck
    from comparisons.scoring.score import Score
    from comparisons.stability.extremes import Stability
    from lumped import Calibration


def export(
    scene: AnyScene,
    folder: str | Path,
    lattice: Lattice | None = None,
    *,
    springs: Calibration | None = None,
    simulators: Sequence[str] = (),
    overwrite: bool = False,
    **keywords: Unpack[LatticeKeywords],
) -> Path:
    """Write the scene's lattice into a folder, for another simulator, and return the folder.

    The lattice is that of `solve` with the same settings, or has the `springs` that `calibrate` returned.
    simulators: "mujoco" and "sofa" have a file of their own as well. Raises BadInput for a folder that holds
    another scene's lattice, unless `overwrite`, and for lattices that files cannot hold.
    """
    from comparisons.export.export import export as write

    scene = scene_of(scene)
    calibration = springs or resolve(scene, Lattice.given(lattice, keywords), "springs").springs
    write(folder, scene, calibration, ["sheetbench.export"], overwrite, simulators)
    return Path(folder)


@large_in_context
def crosscheck(
    scenes: AnyScene | Sequence[AnyScene],
    lattice: Lattice | None = None,
    *,
    grid: Sequence[int] = (9, 13, 17),
    calibration: str | None = None,
    plate: Sequence[int] = (8, 12, 16),
    shell: Sequence[int] = (8, 12, 16),
    solid: Sequence[int] = (6, 8, 12),
    judges: Sequence[str] | str | None = None,
    meshes: Sequence[int] | None = None,
    workers: int = 1,
    out: str | Path | None = None,
    large: bool = False,
    **keywords: Unpack[SpringKeywords],
) -> Crosscheck:
    """Solve scenes by every model and by the other finite-element programs that are installed.

    grid: masses, plate to solid: elements along the shorter side, rising; none leaves a model out.
    judges: names of other programs, all that are found unless given; meshes: their elements. out: a folder
    that keeps the rows, so that the same call goes on where an earlier one was stopped.
    """
    from comparisons.crosscheck.candidates import candidates
    from comparisons.crosscheck.crosscheck import crosscheck as check
    from comparisons.external.installed import find_codes
    from comparisons.runs.campaign import campaign

    def listed(numbers: Sequence[int] | None) -> str:
        return ",".join(map(str, numbers or ()))

    usual = Lattice.given(lattice, keywords)
    usual = usual if calibration is None else usual.but(calibration=calibration)
    many = [scenes] if isinstance(scenes, Scene | str | Path) else list(scenes)
    codes = find_codes(items(judges) if isinstance(judges, str) else judges)
    if not codes:
        require_effect("without external codes", {"meshes": meshes})
    counts = dict(zip(REFERENCES, map(listed, (plate, shell, solid)), strict=True))
    of_programs = None if meshes is None else listed(meshes)
    models = candidates(listed(grid), usual, counts, codes, of_programs)
    with campaign(out) as store:
        return check([scene_of(one) for one in many], store, models=models, codes=codes, workers=workers)


@large_in_context
def stability(
    scene: AnyScene,
    lattice: Lattice | None = None,
    *,
    vary: Sequence[str] | str | None = None,
    reference: str = REFERENCE,
    elements: int = 12,
    workers: int = 1,
    out: str | Path | None = None,
    large: bool = False,
    **keywords: Unpack[LatticeKeywords],
) -> Stability:
    """Map where each model of a scene holds, degrades, refuses or fails, as its sheet goes to extremes.

    vary: "load", "slenderness", "young", "grid", "damping", "time-step", all unless some are named. out: a
    folder that keeps the rows of an interrupted call.
    """
    from comparisons.runs.campaign import campaign
    from comparisons.stability.extremes import VARIED
    from comparisons.stability.extremes import stability as measure

    with campaign(out) as store:
        return measure(
            scene_of(scene),
            store,
            varied=(items(vary) if isinstance(vary, str) else vary) or VARIED,
            lattice=Lattice.given(lattice, keywords),
            reference=reference,
            elements=elements,
            workers=workers,
        )


def report(folder: str | Path, out: str | Path | None = None) -> Path:
    """Write one HTML page of the studies in a folder and return its path, FOLDER/report.html unless given."""
    from comparisons.pages.page import page
    from comparisons.pages.studies import read
    from sheetbench.answers.files import write_text

    folder = Path(folder)
    target = folder / "report.html" if out is None else Path(out)
    write_text(target, page(read(folder), folder.resolve().name))
    return target


def score(answers: str | Path, suite: str | None = None, case: str | Sequence[str] = ()) -> Score:
    """Score a CSV of answers to the reference set: of the suite that its header is of, and of all its cases,
    unless some are named."""
    from comparisons.scoring.cases import SUITES
    from comparisons.scoring.score import score as rate

    if suite is not None:
        require_choice("suite", suite, SUITES)
    return rate(Path(answers), suite, case)


def schema() -> dict[str, Any]:
    """Return the JSON Schema of a scene, for editors."""
    return for_editors(Scene)
