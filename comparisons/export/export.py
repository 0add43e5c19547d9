"""A lattice into a folder: its springs, masses, supports and loads, for a simulator of one's own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.export.arrays import arrays
from comparisons.export.mujoco import to_mjcf
from comparisons.export.page import page
from comparisons.export.sofa import to_sofa
from comparisons.export.tables import plan, tables
from comparisons.report.array_files import write_mat, write_npz
from comparisons.runs.folder import Folder
from sheetbench.answers.files import write_text
from sheetbench.errors import require_choice
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Calibration, Description


@dataclass(frozen=True)
class Simulator:
    """Another program: the file that it reads, and what writes that."""

    file: str
    write: Callable[[Description, Scene], str]


SIMULATORS = {
    "mujoco": Simulator("mujoco.xml", to_mjcf),
    "sofa": Simulator("sofa.scn", to_sofa),
}


def export(
    folder: Path | str,
    scene: Scene,
    calibration: Calibration,
    command: Sequence[str] = (),
    overwrite: bool = False,
    simulators: Sequence[str] = (),
) -> str:
    """Write the lattice of a scene with these springs; a sentence that says where and what.

    command: for the manifest. Raises BadInput for a folder that cannot be had or holds another scene's files,
    unless `overwrite`, and for lattices that files cannot say (`lumped.describe`). simulators: of
    `SIMULATORS`, each a file of its own beside them.
    """
    import lumped

    for name in simulators:
        require_choice("--for", name, SIMULATORS)
    lattice = lumped.describe(scene, calibration)
    own = {SIMULATORS[name].file: SIMULATORS[name].write(lattice, scene) for name in simulators}
    target = Folder(
        folder,
        "export",
        command,
        about={"scene": scene.document()},
        variant={"lattice": calibration.title},
        overwrite=overwrite,
        option="--export",
    )
    differing = {} if scene.uniform and not scene.pierced else {"plan.csv": plan(lattice, scene)}
    texts = {**tables(lattice), **differing, "README.md": page(lattice, scene, calibration, own), **own}
    for name, text in texts.items():
        target.write(name, partial(write_text, text=text))
    values = arrays(lattice)
    target.write("lattice.npz", partial(write_npz, values=values))
    target.write("lattice.mat", partial(write_mat, values=values))
    target.finish(calibration.document())
    missing = "".join(f"; {note}" for note in lattice.notes)
    named = "".join(f", and {file} for {name}" for name, file in zip(simulators, own, strict=True))
    return f"Springs, masses, supports and loads in {target.path}{named}: start at its README.md{missing}"
