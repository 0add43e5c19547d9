"""A lattice into a folder: its springs, masses, supports and loads, for a simulator of one's own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from comparisons.export.arrays import arrays
from comparisons.export.page import page
from comparisons.export.tables import tables
from comparisons.report.files import write_text
from comparisons.runs.folder import Folder
from sheetbench.files import whole
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Calibration

Arrays = dict[str, np.ndarray]


def export(
    folder: Path | str,
    scene: Scene,
    calibration: Calibration,
    command: Sequence[str] = (),
    overwrite: bool = False,
) -> str:
    """Write the lattice of a scene with these springs; a sentence that says where and what.

    command: for the manifest. Raises BadInput for a folder that cannot be had or holds another scene's files,
    unless `overwrite`, and for lattices that files cannot say (`lumped.describe`).
    """
    import lumped

    lattice = lumped.describe(scene, calibration)
    target = Folder(
        folder,
        "export",
        command,
        about={"scene": scene.document()},
        apart={"lattice": calibration.title},
        overwrite=overwrite,
        option="--export",
    )
    texts = {**tables(lattice), "README.md": page(lattice, scene, calibration)}
    for name, text in texts.items():
        target.write(name, partial(write_text, text=text))
    values = arrays(lattice)
    target.write("lattice.npz", lambda path: _written(path, _to_npz, values))
    target.write("lattice.mat", lambda path: _written(path, _to_mat, values))
    target.finish(calibration.as_dict())
    missing = "".join(f"; {said}" for said in lattice.notes)
    return f"Springs, masses, supports and loads in {target.path}: start at its README.md{missing}"


def _written(path: Path, write: Callable[[Path, Arrays], None], values: Arrays) -> None:
    with whole(path) as partial:
        write(partial, values)


def _to_npz(path: Path, values: Arrays) -> None:
    np.savez(path, **values)  # type: ignore[arg-type]


def _to_mat(path: Path, values: Arrays) -> None:
    from scipy.io import savemat

    texts = {name: np.array(v, dtype=object) for name, v in values.items() if v.dtype.kind == "U"}
    savemat(path, {**values, **texts}, oned_as="column")
