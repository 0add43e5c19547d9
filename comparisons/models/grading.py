"""Grading of a lattice, finer cells at the edges: as given, or by the scene's boundary layers.

`auto` looks at the widths of the layers that form at the edges (`comparisons.models.layers`), before
anything is solved, and grades the grid where the narrowest is less than NARROW of the shorter side (of a
sheet that one clamped edge alone holds: of the length that it juts out) and less than RESOLVED cells
wide. On the transfer study's scenes that tells those that grading mends (curved edges, soft and thin
sheets, pressure) from those whose smooth interior it would make coarser; on scenes that were drawn after
the rule was made, of eight that it grades by GRADED seven are nearer and one is not, by ½ two are much
farther off (docs/theory.md). Where one clamped edge is all that holds the sheet it grades towards that
edge alone, by ONE_SIDED.
"""

from __future__ import annotations

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

GRADED = 0.3  # what `auto` grades by towards all edges
ONE_SIDED = 0.5  # and towards the one that holds the sheet
NARROW = 0.6
RESOLVED = 24.0


def parse_grading(grading: GradingLike) -> Graded | str | None:
    """Return a number or a grading towards some edges, or "auto", from a request, text too (0.5,
    0.5:x0,y0); None where nothing is. Raises BadInput."""
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
    """Return the grading that is requested; None for "auto" too. Raises BadInput."""
    chosen = parse_grading(grading)
    return None if isinstance(chosen, str) else chosen


def grading_of(scene: Scene, grid: Sequence[int], lattice: Lattice) -> tuple[Graded | None, str]:
    """Return the grading, None where none is requested and no shapes are drawn whose sides lines can be moved
    to, and the reason in a sentence where it is chosen. Raises BadInput for what is none."""
    chosen = parse_grading(lattice.grading)
    if isinstance(moved := lines_on_shapes(scene, grid, lattice), Grading):
        return None, _ends_of_cells(scene, grid, moved)
    if not isinstance(chosen, str):
        return chosen, ""
    return (0.0, why_not) if (why_not := one_size(grid, lattice)) else _by_layers(scene, grid)


def lines_on_shapes(scene: Scene, grid: Sequence[int], lattice: Lattice) -> Graded:
    """Return equal cells but for lines on the sides of shapes, where no grading is requested."""
    requested = lattice.grading is not None or not scene.shaped_by or one_size(grid, lattice)
    return 0.0 if requested else through(sides_of_shapes(scene), scene.sheet.lengths)


def _ends_of_cells(scene: Scene, grid: Sequence[int], grading: Grading) -> str:
    """Return what lines that are moved to the sides of shapes do, and which sides have none."""
    found = ["the grid's lines are moved to the sides of the shapes; --grading 0 keeps cells of one size"]
    for axis, (places, length, count) in enumerate(
        zip(grading.places, scene.sheet.lengths, grid[:2], strict=True)
    ):
        on_lines = places_with_lines(places, length, count)
        if missed := [f"{1e3 * place:.4g}" for place in places if place not in on_lines]:
            found.append(
                f"sides at {'xy'[axis]} = {', '.join(missed)} mm lie within cells, where a slit is not open: "
                f"that takes {lines_for_all(places, length)} masses along {'xy'[axis]}"
            )
    return "; ".join(found)


def choice_notes(settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Return why a grading and a calibration were chosen, a sentence each, from the settings of an answer;
    none where both were given. The solid's `grading` is a word, a plug-in's may be anything: only one with a
    reason beside it is a lattice's."""
    found = []
    if why := settings.get("grading_reason"):
        given = settings.get("grading")  # a text of a specification, None where none is given
        shown = given if isinstance(given, str) else f"{of_settings(settings, (1.0, 1.0)):g}"
        found.append(why if given is None else f"grading {shown}: {why}")
    if why := settings.get("calibration_reason"):
        found.append(f"calibration {settings['calibration']}: {why}")
    return tuple(found)


def one_size(grid: Sequence[int], lattice: Lattice) -> str:
    """Return why these springs cannot be had cell by cell, "" where they can."""
    method = method_of(lattice.calibration, lattice.k)
    if "grading" not in CALIBRATIONS[method].takes:
        return f"the calibration {method} is for cells of one size"
    if grid[2] != LAYERS or lattice.layer_distance is not None:
        return f"graded grids have {LAYERS} layers at the calibration's own distance"
    return ""


def _by_layers(scene: Scene, grid: Sequence[int]) -> tuple[Graded, str]:
    found = layers(scene)
    if not found:
        return 0.0, "nothing bends the sheet, so that it has no layers at its edges"
    layer = min(found)
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
