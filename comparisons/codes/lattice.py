"""A lattice as files for other codes: its springs, masses, supports and loads, and a program that reads them.

The tables and arrays can be read by any program; `CODES` have a file of their own beside them.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.codes.files import script, to_sofa
from comparisons.codes.page import page
from comparisons.codes.tables import arrays, natural, plan, tables
from comparisons.pictures.array_files import write_mat, write_npz
from comparisons.sweep.folder import Folder
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import require_flat_at_rest
from sheetbench.scenes.meaning.distances import require_no_obstacles

if TYPE_CHECKING:
    from lumped import Calibration

SOFA = "sofa"  # has links alone
READERS = {"numpy": "read_lattice.py", "cpp": "read_lattice.cpp", "matlab": "read_lattice.m"}
CODES = (SOFA, *READERS)


def lattice_files(
    scene: Scene, calibration: Calibration, code: str | None = None
) -> tuple[dict[str, Write], list[str]]:
    """Return the files of a scene's lattice with these springs, and what is not in them, in sentences.

    code: of `CODES`, whose file comes beside them. Raises BadInput for lattices that files cannot say
    (`lumped.describe`), and for what the code does not have.
    """
    import lumped

    if code == SOFA:
        require_flat_at_rest(scene, "--for sofa")
    if code in (SOFA, "cpp", "matlab"):
        require_no_obstacles(scene, f"the reader of --for {code}")
    lattice = lumped.describe(scene, calibration)
    own = {} if code is None or code == SOFA else {READERS[code]: script(READERS[code])}
    if code == SOFA:
        own = {"sofa.scn": to_sofa(lattice, scene)}
    differing = {} if scene.uniform and not scene.pierced else {"plan.csv": plan(lattice, scene)}
    if scene.natural_by:
        differing["natural.csv"] = natural(lattice)
    texts = {**tables(lattice), **differing, "README.md": page(lattice, scene, calibration, own), **own}
    values = arrays(lattice)
    found: dict[str, Write] = {name: partial(write_text, text=text) for name, text in texts.items()}
    found["lattice.npz"] = partial(write_npz, values=values)
    found["lattice.mat"] = partial(write_mat, values=values)
    return found, list(lattice.notes)


def export(
    folder: Path | str,
    scene: Scene,
    calibration: Calibration,
    command: Sequence[str] = (),
    overwrite: bool = False,
) -> str:
    """Write the lattice of a scene with these springs; a sentence that says where and what.

    command: for the manifest. Raises BadInput for a folder that cannot be had or holds another scene's files,
    unless `overwrite`, and for lattices that files cannot say.
    """
    files, missing = lattice_files(scene, calibration)
    target = Folder(
        folder,
        "export",
        command,
        about={"scene": scene.document()},
        variant={"lattice": calibration.title},
        overwrite=overwrite,
        option="--export",
    )
    for name, write in files.items():
        target.write(name, write)
    target.finish(calibration.document())
    notes = "".join(f"; {note}" for note in missing)
    return f"Springs, masses, supports and loads in {target.path}: start at its README.md{notes}"
