"""Grading of a lattice, finer cells at the edges: as given, or by the scene's boundary layers.

`auto` compares the widths of the layers at the edges (`comparisons.models.layers`) before a solve. It grades
the grid if the narrowest layer is less than NARROW of the shorter side wide (for a sheet with one clamped
edge: of the length across that edge) and less than RESOLVED cells wide. A sheet held by one clamped edge
alone is graded towards that edge, by ONE_SIDED, every other sheet towards all edges, by GRADED. The rule
separates the transfer study's scenes that grading improves (curved edges, soft and thin sheets, pressure)
from scenes with a smooth interior, which it would make coarser. Eight scenes drawn after the rule was made
are graded by GRADED: seven improve and one does not; by ½, two become much worse (docs/theory.md).
"""

from collections.abc import Mapping, Sequence
from typing import Any

from comparisons.models.layers import layers
from comparisons.models.spec import GradingLike, Lattice
from sheetbench.choices import AUTO, CALIBRATIONS, method_of
from sheetbench.errors import BadInput
from sheetbench.scenes import EDGES, Clamped, Scene
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.meaning.region import sides_of_shapes
from sheetbench.scenes.objects.grading import (
    Graded,
    Grading,
    lines_for_all,
    of_settings,
    places_with_lines,
    through,
    towards,
)
from sheetbench.scenes.objects.grid import LAYERS
from sheetbench.scenes.objects.supports import place

GRADED = 0.3  # grading of `auto` towards all edges
ONE_SIDED = 0.5  # grading of `auto` towards the only clamped edge
NARROW = 0.6
RESOLVED = 24.0


def parse_grading(grading: GradingLike) -> Graded | str | None:
    """Return a grading from a number or text (0.5, 0.5:x0,y0): a number, a grading towards some edges,
    "auto", or None for None. Raises BadInput."""
    if grading is None or grading == AUTO or isinstance(grading, Grading):
        return grading
    by, _, edges = str(grading).partition(":")
    try:
        value = float(by)
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= 1.0:
        raise BadInput(
            f"grading = {grading}: a number from 0 (cells of one size) to 1 (finest at the edges), 0.5:x0 "
            "(at that edge alone), or auto"
        )
    return towards(value, edges.split(",") if edges else None)


def fixed(grading: GradingLike) -> Graded | None:
    """Return a requested grading, None for "auto". Raises BadInput."""
    parsed = parse_grading(grading)
    return None if isinstance(parsed, str) else parsed


def grading_of(scene: Scene, grid: Sequence[int], lattice: Lattice) -> tuple[Graded | None, str]:
    """Return the grading of a lattice and a sentence with the reason for a choice made here.

    The grading is None if none is requested; the reason then describes the grid lines moved to the sides of
    shapes, if there are any. Raises BadInput for an invalid grading.
    """
    requested = parse_grading(lattice.grading)
    if isinstance(moved := lines_on_shapes(scene, grid, lattice), Grading):
        return None, _moved_lines_note(scene, grid, moved)
    if not isinstance(requested, str):
        return requested, ""
    return (0.0, why_not) if (why_not := one_size(grid, lattice)) else _by_layers(scene, grid)


def lines_on_shapes(scene: Scene, grid: Sequence[int], lattice: Lattice) -> Graded:
    """Return a grading that moves grid lines to the sides of shapes, 0 if a grading is requested or the sheet
    has no shapes."""
    requested = lattice.grading is not None or not scene.shaped_by or one_size(grid, lattice)
    return 0.0 if requested else through(sides_of_shapes(scene), scene.sheet.lengths)


def _moved_lines_note(scene: Scene, grid: Sequence[int], grading: Grading) -> str:
    """Return a note on grid lines moved to the sides of shapes, and on sides without a line."""
    clauses = ["the grid's lines are moved to the sides of the shapes; --grading 0 keeps cells of one size"]
    for axis, (places, length, count) in enumerate(
        zip(grading.places, scene.sheet.lengths, grid[:2], strict=True)
    ):
        on_lines = places_with_lines(places, length, count)
        if missed := [f"{1e3 * place:.4g}" for place in places if place not in on_lines]:
            clauses.append(
                f"sides at {'xy'[axis]} = {', '.join(missed)} mm lie within cells, where a slit is not open: "
                f"that takes {lines_for_all(places, length)} masses along {'xy'[axis]}"
            )
    return "; ".join(clauses)


def choice_notes(settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the reasons for an automatic grading and calibration, a sentence each, from an answer's
    settings. A `grading` without a reason belongs to a solid or a plug-in and is ignored."""
    notes = []
    if reason := settings.get("grading_reason"):
        grading = settings.get("grading")  # text of a specification, None if none was given
        text = grading if isinstance(grading, str) else f"{of_settings(settings, (1.0, 1.0)):g}"
        notes.append(reason if grading is None else f"grading {text}: {reason}")
    if reason := settings.get("calibration_reason"):
        notes.append(f"calibration {settings['calibration']}: {reason}")
    return tuple(notes)


def one_size(grid: Sequence[int], lattice: Lattice) -> str:
    """Return the reason why a lattice's cells must have one size, "" if they may differ."""
    method = method_of(lattice.calibration, lattice.k)
    if "grading" not in CALIBRATIONS[method].takes:
        return f"the calibration {method} is for cells of one size"
    if grid[2] != LAYERS or lattice.layer_distance is not None:
        return f"graded grids have {LAYERS} layers at the calibration's own distance"
    return ""


def _by_layers(scene: Scene, grid: Sequence[int]) -> tuple[Graded, str]:
    boundary_layers = layers(scene)
    if not boundary_layers:
        return 0.0, "nothing bends the sheet, so that it has no layers at its edges"
    layer = min(boundary_layers)
    width, held = layer.width, scene.supports
    one_sided = not (layer.bent_edge or scene.actuators) and len(held) == 1 and isinstance(held[0], Clamped)
    one_sided = one_sided and place(held[0]) is None
    side = scene.sheet.lengths[EDGES[held[0].edge].normal_axis] if one_sided else min(scene.sheet.lengths)
    cell = max(length / (n - 1) for length, n in zip(scene.sheet.lengths, grid[:2], strict=True))
    cells = f"{few(width / cell)} cells of {1e3 * cell:.3g} mm where all are alike"
    if width >= NARROW * side:
        return 0.0, f"{layer}, no narrow layer beside a side of {1e3 * side:.3g} mm"
    if cell * RESOLVED < width:
        return 0.0, f"{layer}, {cells}"
    if not one_sided:
        return GRADED, f"{layer}, {cells}"
    edge = held[0].edge
    return towards(ONE_SIDED, [edge]), f"{layer}, {cells}; {edge} alone holds the sheet"
