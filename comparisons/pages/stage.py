"""Options of the three-dimensional viewer, from a study's VTU files.

A file has point data `displacement`; a comparison's plan grid has one a model, and the difference; a file of
modes has one a mode. A PVD file lists the moments of a motion.
"""

import re
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import meshio
import numpy as np

from comparisons.pages.sheets import displaced, eye, field, outline, viewer_sheet
from comparisons.pages.studies import Study
from sheetbench.answers.solution import FieldMesh
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene

FRAMES, MOVED = 60, 400_000  # moments of a motion on a page; numbers in all of them
Options = dict[str, Any]


def stage(study: Study) -> Options | None:
    """Return the viewer's options, or None without sheets to show."""
    meshes = {name: mesh for name in study.with_suffix(".vtu") if (mesh := study.read(name, _read_mesh))}
    motions = {
        name: series for name in study.with_suffix(".pvd") if (series := study.read(name, _read_series))
    }
    sheets: list[Options] = []
    views: list[Options] = []
    models = _list_models(study.document)
    for name, frames in motions.items():
        model = Path(name).stem if Path(name).stem in models else ""
        key = model or name
        sheet = study.guarded(name, partial(_animate_frames, key, frames, study.scene))
        if sheet is not None:
            sheets.append(sheet)
            field_name = _choose_field(frames[-1][1])
            views.append({"name": key, "label": model or "Motion", "sheets": [key], "field": field_name})
    for name, mesh in meshes.items():
        parts = study.guarded(name, partial(_split_file, name, mesh, study))
        for sheet, view in parts or []:
            sheets.append(sheet)
            views.append(view)
    if not sheets:
        return None
    view_options = {} if study.scene is None else {"outline": outline(study.scene), "from": eye(study.scene)}
    return {"sheets": sheets, "views": _order_views(views, study), **view_options}


def _split_file(name: str, mesh: FieldMesh, study: Study) -> list[tuple[Options, Options]]:
    """Return the sheets of a file with the view of each."""
    data = mesh.point_data
    modes = [key for key in data if re.fullmatch(r".+_mode_\d+", key)]
    if modes:
        moved = {key: FieldMesh(mesh.points, mesh.cells, {"displacement": data[key]}) for key in modes}
        return [_view_mesh(key, mode, key.replace("_", " "), study.scene) for key, mode in moved.items()]
    differences = {key: data[key] for key in data if key == "difference" or key.startswith("difference_")}
    if not differences:
        stem = Path(name).stem
        return [_view_mesh(stem, mesh, stem, study.scene)]
    chosen = _list_models(study.document)
    label = {"difference": chosen[0] if chosen else "lattice"}
    return [
        _view_difference(key, mesh, vector, label.get(key, key.removeprefix("difference_")), study.scene)
        for key, vector in differences.items()
    ]


def _view_mesh(name: str, mesh: FieldMesh, label: str, scene: Scene | None) -> tuple[Options, Options]:
    sheet = viewer_sheet(name, mesh, label, scene=scene)
    return sheet, {"name": name, "label": label, "sheets": [name], "field": _choose_field(mesh)}


def _choose_field(mesh: FieldMesh) -> str:
    """Return the field to begin with: uz, as in the pictures, but for a sheet that moves in its plane."""
    across, up = np.split(np.abs(np.nan_to_num(mesh.point_data["displacement"])), [2], axis=1)
    return "uz" if up.max(initial=0.0) > 0.01 * across.max(initial=0.0) else "displacement"


def _view_difference(
    name: str, mesh: FieldMesh, vector: np.ndarray, of: str, scene: Scene | None
) -> tuple[Options, Options]:
    """Return the reference's sheet, coloured by how far a model is from it."""
    size = np.linalg.norm(vector, axis=1)
    distance = field("difference", "Distance from the reference", size, "mm", 1e3) | {"kind": "difference"}
    fields = [distance, field("offz", "Difference in uz", vector[:, 2], "mm", 1e3) | {"kind": "signed"}]
    sheet = viewer_sheet(name, mesh, f"{of} − reference", fields, scene)
    sheet["fields"] = [*fields, displaced()]
    return sheet, {"name": name, "label": f"Difference: {of}", "sheets": [name], "field": "difference"}


def _list_models(document: Mapping[str, Any]) -> list[str]:
    """Return the models of a comparison, the compared one first."""
    solutions = document.get("solutions")
    listed = solutions if isinstance(solutions, list) else []
    return [str(one.get("model")) for one in listed if isinstance(one, dict)]


def _order_views(views: list[Options], study: Study) -> list[Options]:
    """Return the views in order: both models of a comparison side by side, each model alone, then the
    rest."""
    models = _list_models(study.document)
    order = {name: place for place, name in enumerate(models)}
    ordered = sorted(views, key=lambda view: order.get(view["name"], len(order)))
    names = [view["name"] for view in ordered]
    if len(models) > 1 and all(name in names for name in models[:2]):
        pair = {"name": "both", "label": f"{models[0]} and {models[1]}", "sheets": models[:2]}
        ordered.insert(0, {**pair, "field": ordered[0]["field"]})
    return ordered


def _animate_frames(name: str, frames: list[tuple[float, FieldMesh]], scene: Scene | None) -> Options:
    size = frames[-1][1].points.size
    count = max(2, min(FRAMES, MOVED // size))
    samples = [frames[i] for i in np.unique(np.linspace(0, len(frames) - 1, count).astype(int))]
    moments = [(time, mesh.point_data["displacement"]) for time, mesh in samples]
    return viewer_sheet(name, samples[-1][1], "motion", scene=scene, frames=moments)


def _read_mesh(path: Path) -> FieldMesh:
    read = meshio.read(path, "vtu")  # whatever its name: a list of moments may be another person's
    points = np.asarray(read.points, dtype=float)
    u = np.asarray(read.point_data["displacement"], dtype=float)
    if u.shape != points.shape or points.shape[1] != 3:
        raise BadInput(f"displacement of shape {u.shape} at points of shape {points.shape}")
    cells = [(block.type, np.asarray(block.data)) for block in read.cells]
    if any(data.size and not 0 <= data.min() <= data.max() < len(points) for _, data in cells):
        raise BadInput("a cell names a point that is not there")
    vectors = {key: np.asarray(v) for key, v in read.point_data.items() if len(v) == len(points)}
    return FieldMesh(points, cells, vectors)


def _read_series(path: Path) -> list[tuple[float, FieldMesh]]:
    """Return times [s] and meshes listed in a PVD file. Raises BadInput for a mesh outside its folder."""
    root = path.parent.resolve()
    entries = []
    for entry in ElementTree.fromstring(path.read_text(encoding="utf-8")).iter("DataSet"):
        place = (path.parent / entry.attrib["file"]).resolve()
        if not place.is_relative_to(root):
            raise BadInput(f"{entry.attrib['file']} lies outside the folder")
        entries.append((float(entry.attrib["timestep"]), place))
    chosen = np.unique(np.linspace(0, len(entries) - 1, min(FRAMES, len(entries))).astype(int))
    return [(entries[i][0], _read_mesh(entries[i][1])) for i in chosen]
