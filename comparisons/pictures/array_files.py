"""Named arrays as files of NumPy and of MATLAB, and meshes with their fields as VTU.

Every VTU file has point data `displacement` (n, 3) [m] at points of the undeformed sheet.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from sheetbench.answers.solution import FieldMesh
from sheetbench.files import replacing


def write_npz(path: Path, values: Mapping[str, Any]) -> None:
    """Write arrays for NumPy, a sparse matrix M as M_data, M_indices, M_indptr of its columns."""
    parts: dict[str, Any] = {}
    for name, value in values.items():
        if hasattr(value, "indptr"):
            parts |= {f"{name}_{part}": getattr(value, part) for part in ("data", "indices", "indptr")}
        else:
            parts[name] = value
    with replacing(path) as partial:
        np.savez(partial, **parts)


def write_mat(path: Path, values: Mapping[str, Any]) -> None:
    """Write arrays and sparse matrices for MATLAB and Octave, texts as cells."""
    from scipy.io import savemat

    texts = {name: np.array(v, dtype=object) for name, v in values.items() if np.asarray(v).dtype.kind == "U"}
    with replacing(path) as partial:
        savemat(partial, {**values, **texts}, oned_as="column")


def write_mesh(path: Path, mesh: FieldMesh) -> None:
    """Write a mesh with its fields as VTU."""
    import meshio  # its import takes half as long as all others of a comparison together

    file = meshio.Mesh(mesh.points, mesh.cells, mesh.point_data, mesh.cell_data)
    with replacing(path) as partial:
        meshio.write(partial, file, file_format="vtu")
