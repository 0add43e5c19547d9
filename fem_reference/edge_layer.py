"""Boundary layer along edges without twisting moment, and the part of it that a mesh does not resolve.

Along a free, hinged or held edge the director's tilt ψ along the edge turns until no twisting moment is left,
within a layer of length ℓ = h/√10 (D (1 − ν)/2 ψ'' = k G h ψ, k = 5/6), and the sheet is softer for it: a
strip of width b has the torsion constant b h³/3 (1 − 0.63 h/b), so that each edge takes 0.315 h/b. Elements
of lengths t, t', … in units of ℓ behind the edge find the share

    c = e₀ · (K + M)⁻¹ e₀,     K, M of ∫ ψ' φ' and ∫ ψ φ on quadratic elements,

of the layer's compliance: 1 for t ≪ 1, 6 √2/t for equal t ≫ 1. Coarser meshes do not reveal the rest, 1 − c:
they miss it as well, and agree. Linear plates with four hinged edges are (0.63 ± 0.06) times
Σ 0.315 h/b (1 − c) too stiff, for h/a from 0.003 to 0.025 and 6 to 24 elements; others, where less of the
energy is twist, less.
Lengths in metres.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from fem_reference.surface.borders import has_lines
from fem_reference.surface.mesh import divisions, lines_of
from sheetbench.scenes import EDGES, Scene

LENGTH = 10.0**-0.5  # of the layer, in thicknesses
SOFTENING = 0.315  # thicknesses over the width, by one edge
ELASTIC = {"young", "poisson", "angle"}
_SLOPES = np.array([[7.0, -8.0, 1.0], [-8.0, 16.0, -8.0], [1.0, -8.0, 7.0]]) / 3.0
_VALUES = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]]) / 30.0


class UnresolvedLayers(NamedTuple):
    """Parts of the edge layers that a mesh does not resolve. share: the largest 1 − c of any edge;
    stiffening: the sum of 0.315 h/b (1 − c) over the edges, the relative excess stiffness of a sheet that
    only twists."""

    share: float
    stiffening: float


NOTHING = UnresolvedLayers(0.0, 0.0)


def unresolved(scene: Scene, settings: Mapping[str, Any]) -> UnresolvedLayers:
    """Return the unresolved parts of the layers on the mesh of an answer, given its settings. The mesh is
    graded unless the settings exclude it. Bricks (their settings have a `grading`) also have a layer about as
    wide as the sheet is thick where its stiffness steps, and do not resolve it: they converge in first order
    there."""
    requested = settings["elements"]
    counts = divisions(scene.sheet, requested if isinstance(requested, int) else tuple(requested))
    uniform = settings.get("graded") is False or settings.get("grading") == "uniform"
    bricks = "grading" in settings
    graded = not bricks or has_lines(scene)
    lines, thickness = lines_of(scene, counts, graded and not uniform), scene.sheet.thickness
    share, stiffening = 0.0, 0.0
    for name in sorted(scene.twisting_edges()):  # alike in every process
        edge = EDGES[name]
        cells = np.diff(lines[edge.normal_axis])
        missed = 1.0 - resolved((cells[::-1] if edge.far_end else cells) / (LENGTH * thickness))
        share = max(share, missed)
        stiffening += missed * SOFTENING * thickness / scene.sheet.lengths[edge.normal_axis]
    local_values = [(name, patch.own[name]) for patch in scene.patches for name in ELASTIC & set(patch.own)]
    if bricks and any(value != getattr(scene.material, name) for name, value in local_values):
        share = 1.0
    return UnresolvedLayers(share, stiffening)


def resolved(cells: np.ndarray) -> float:
    """Return the resolved share c of the layer by cells (n,) in layer lengths, from the edge inwards."""
    matrix = np.zeros((2 * len(cells) + 1, 2 * len(cells) + 1))
    for i, cell in enumerate(cells):
        nodes = slice(2 * i, 2 * i + 3)
        matrix[nodes, nodes] += _SLOPES / cell + cell * _VALUES
    load = np.zeros(len(matrix))
    load[0] = 1.0
    return min(float(np.linalg.solve(matrix, load)[0]), 1.0)
