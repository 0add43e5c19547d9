"""A scene in words: its parts, whether it can rest, and what the models do with it by default.

Nothing is solved. What is hardly meant (`sheetbench.scenes.plausibility`) stands among the complaints.
"""

from __future__ import annotations

import shlex
from warnings import catch_warnings, simplefilter

from comparisons.models.grids import scene_grid
from sheetbench.answers.report import Report
from sheetbench.answers.table import Column, Table
from sheetbench.choices import ELEMENTS
from sheetbench.errors import Implausible
from sheetbench.scenes import AnyScene, Scene, free_rigid_motions, scene_of
from sheetbench.scenes.grid import near_square
from sheetbench.scenes.plausibility import slips
from sheetbench.scenes.words import in_words


def check(scene: AnyScene, called: str | None = None) -> Report:
    """The report of `sheetbench check`; called: the catalogue name or path that commands shall have."""
    called = called or (scene.name if isinstance(scene, Scene) else str(scene))
    with catch_warnings():
        simplefilter("ignore", Implausible)  # they stand in the report
        scene = scene_of(scene)
    warnings = [f"{called}: {slip}" for slip in slips(scene)]
    parts = [*in_words(scene), ("lattice", _lattice(scene)), ("shell", _shell(scene))]
    free, foretold = free_rigid_motions(scene), _foretold(scene)
    return Report(
        name="check",
        title=scene.name,
        subtitle=scene.title,
        tables=(Table("What will be solved", (Column("part"), Column("what", prose=True)), tuple(parts)),),
        notes=(
            *foretold,
            *([] if free else [f"Solve it with:\nsheetbench compare {shlex.quote(called)}"]),
        ),
        complaints=(
            *warnings,
            *(["the sheet can move as a rigid body: only `modes` and `simulate` can answer"] if free else []),
        ),
        document={
            "scene": scene.document(),
            "parts": [{"part": part, "what": what} for part, what in parts],
            "free_rigid_motions": free,
            "foretold": foretold,
            "warnings": warnings,
        },
    )


def _foretold(scene: Scene) -> list[str]:
    """What the lattice's answer will be off by, as far as it is known before solving."""
    if not scene.actuators:
        return []
    from lumped import polygons

    return [warning] if (warning := polygons(scene, scene_grid(scene))) else []


def _lattice(scene: Scene) -> str:
    nx, ny, layers = scene_grid(scene, None)
    x, y = (1e3 * length / (n - 1) for length, n in zip(scene.sheet.lengths, (nx, ny), strict=True))
    springs = "the scene's own springs" if scene.springs is not None else "consistent springs"
    return (
        f"{nx} × {ny} × {layers} masses in cells of {x:.3g} × {y:.3g} mm, {springs} (--lumped, --calibration)"
    )


def _shell(scene: Scene) -> str:
    nx, ny = near_square(scene.sheet, ELEMENTS)
    return f"{nx} × {ny} elements (--elements; --reference plate or solid)"
