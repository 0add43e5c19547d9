"""Whole displacements of a run over time, and the PVD/VTU series of them.

The axes of chains are lines; a file's point data `actuator` is 0 on the lattice and 1, 2, … on the axes, in
the order of their edges in the scene.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from comparisons.report.vtk import write_mesh
from lumped import Lattice, MidSurface
from sheetbench.answers.files import folder, write_text
from sheetbench.scenes import FieldMesh, History


@dataclass(frozen=True)
class Frame:
    """One moment of a run, as far as drawing needs a solution: sampled displacement and a mesh.

    lattice: of the run, its masses the mesh's points; axes: rest places and displacements (p, 3) [m] of the
    points where the segments of each chain end.
    """

    mesh: FieldMesh
    lattice: Lattice
    axes: tuple[tuple[np.ndarray, np.ndarray], ...] = ()

    def with_axes(self) -> FieldMesh:
        """The mesh with the axes as more points and lines."""
        points, displacement, cells = [self.mesh.points], [self.mesh.point_data["displacement"]], []
        of, first = [np.zeros(len(self.mesh.points), dtype=int)], len(self.mesh.points)
        for number, (rest, u) in enumerate(self.axes, 1):
            points.append(rest)
            displacement.append(u)
            of.append(np.full(len(rest), number))
            cells.append(
                ("line", first + np.column_stack([np.arange(len(rest) - 1), np.arange(1, len(rest))]))
            )
            first += len(rest)
        fields = {"displacement": np.concatenate(displacement), "actuator": np.concatenate(of)}
        return FieldMesh(np.concatenate(points), [*self.mesh.cells, *cells], fields)

    def displacement(self, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (n, 3) [m] at plan points (n, 2) [m]."""
        return MidSurface(self.lattice, points).of(self.mesh.point_data["displacement"])


@dataclass(frozen=True)
class Surface:
    """One moment of a reference's run: its mesh with displacements, and what samples its mid-surface."""

    mesh: FieldMesh
    sample: Callable[[np.ndarray, np.ndarray], np.ndarray]
    kept: np.ndarray
    axes: tuple[tuple[np.ndarray, np.ndarray], ...] = ()

    def displacement(self, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (n, 3) [m] at plan points (n, 2) [m]."""
        return self.sample(self.kept, points)


def surfaces(history: History) -> list[tuple[float, Surface]]:
    """Time [s] and sheet of every displacement that a reference's run kept."""
    extra = history.extra
    mesh: FieldMesh = extra["mesh"]
    found = []
    for time, u in zip(extra["frame_times"].tolist(), np.array(extra["frames"]), strict=True):
        moved = FieldMesh(mesh.points, mesh.cells, {"displacement": u})
        found.append((time, Surface(moved, extra["sample"], u)))
    return found


def frames(history: History) -> list[tuple[float, Frame]]:
    """Time [s] and frame of every displacement that the run kept."""
    mesh: FieldMesh = history.extra["mesh"]
    kept = history.extra["frames"]
    times = history.extra["frame_times"][: len(kept)]
    found = []
    for number, (time, u) in enumerate(zip(times, kept, strict=True)):
        moved = FieldMesh(mesh.points, mesh.cells, {"displacement": np.array(u)})
        axes = tuple((rest, over_time[number]) for rest, over_time in history.extra["axes"].values())
        found.append((float(time), Frame(moved, history.extra["lattice"], axes)))
    return found


def write_series(path: Path, shown: Sequence[tuple[float, Frame | FieldMesh]]) -> None:
    """Write frames or meshes as NAME/0000.vtu … and the PVD file that lists them with their times."""
    inside = folder(path.with_suffix(""))
    lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "  <Collection>"]
    for number, (time, frame) in enumerate(shown):
        name = f"{number:04d}.vtu"
        if isinstance(frame, Frame):
            frame = frame.with_axes() if frame.axes else frame.mesh
        write_mesh(inside / name, frame)
        lines.append(f'    <DataSet timestep="{time!r}" part="0" file="{inside.name}/{name}"/>')
    write_text(path, "\n".join([*lines, "  </Collection>", "</VTKFile>", ""]))
