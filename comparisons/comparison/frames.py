"""Displacement fields of a run over time, and their PVD/VTU series.

The axes of chains are lines; a file's point data `actuator` is 0 on the lattice and 1, 2, … on the axes, in
the order of their edges in the scene.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from comparisons.pictures.array_files import write_mesh
from sheetbench.answers.files import folder, write_text
from sheetbench.answers.history import History
from sheetbench.answers.solution import FieldMesh


@dataclass(frozen=True)
class Frame:
    """A run at one time, with the attributes of a solution that drawing needs: the mesh with its
    displacement.

    sample: returns displacements of the mid-surface (p, 3) from the mesh's displacement and plan points
    (p, 2) [m]; axes: rest positions and displacements (p, 3) [m] of the ends of each chain's segments.
    """

    mesh: FieldMesh
    sample: Callable[[np.ndarray, np.ndarray], np.ndarray]
    axes: tuple[tuple[np.ndarray, np.ndarray], ...] = ()

    @property
    def of_lattice(self) -> bool:
        """Whether the mesh has links."""
        return any(kind == "line" for kind, _ in self.mesh.cells)

    def with_axes(self) -> FieldMesh:
        """Return the mesh with the axes of chains as additional points and lines."""
        if not self.axes:
            return self.mesh
        points, displacement, cells = [self.mesh.points], [self.mesh.point_data["displacement"]], []
        actuator, first = [np.zeros(len(self.mesh.points), dtype=int)], len(self.mesh.points)
        for number, (rest, u) in enumerate(self.axes, 1):
            points.append(rest)
            displacement.append(u)
            actuator.append(np.full(len(rest), number))
            cells.append(
                ("line", first + np.column_stack([np.arange(len(rest) - 1), np.arange(1, len(rest))]))
            )
            first += len(rest)
        fields = {"displacement": np.concatenate(displacement), "actuator": np.concatenate(actuator)}
        return FieldMesh(np.concatenate(points), [*self.mesh.cells, *cells], fields)

    def displacement(self, points: np.ndarray) -> np.ndarray:
        """Return the mid-surface's displacement (n, 3) [m] at plan points (n, 2) [m]."""
        return self.sample(self.mesh.point_data["displacement"], points)


def frames(history: History) -> list[tuple[float, Frame]]:
    """Return time [s] and frame of every stored displacement field of a run."""
    extra, out = history.extra, []
    for number, u in enumerate(extra.get("frames", ())):
        mesh = FieldMesh(extra["mesh"].points, extra["mesh"].cells, {"displacement": np.array(u)})
        axes = tuple((rest, over_time[number]) for rest, over_time in extra["axes"].values())
        out.append((float(extra["frame_times"][number]), Frame(mesh, extra["sample"], axes)))
    return out


def write_frames(path: Path, history: History) -> None:
    """Write a run's frames as NAME/0000.vtu … and the PVD file that lists them with their times [s]."""
    subfolder = folder(path.with_suffix(""))
    lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "  <Collection>"]
    for number, (time, frame) in enumerate(frames(history)):
        name = f"{number:04d}.vtu"
        write_mesh(subfolder / name, frame.with_axes())
        lines.append(f'    <DataSet timestep="{time!r}" part="0" file="{subfolder.name}/{name}"/>')
    write_text(path, "\n".join([*lines, "  </Collection>", "</VTKFile>", ""]))
