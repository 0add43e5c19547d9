"""Plan meshes of the flat sheet: quadrilaterals, near-square, with the edges named as in the scene.

A mesh is scikit-fem's `MeshQuad` with the boundaries "x0", "x1", "y0", "y1"; the models take any other
flat quadrilateral mesh as well. Biquadratic nodes lie at corners, mid-sides and centres, in the
order of scikit-fem's `ElementQuad2`. Coordinates in metres.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np
from skfem import MeshQuad, MeshQuad2

from fem_reference.surface.borders import borders_of, has_lines, shapes_of
from fem_reference.surface.outlined import LAYERS, quadrilaterals
from fem_reference.surface.placement import mesh_of_cells
from sheetbench.errors import BadInput
from sheetbench.numerics.cache import cached
from sheetbench.scenes import EDGES, EdgeLoad, PiecewiseCurve, Scene, Sheet, Symmetric
from sheetbench.scenes.meaning.region import area_in, edge_length
from sheetbench.scenes.objects.grading import is_mirrored, line_numbers
from sheetbench.scenes.objects.grid import MESH, elements_of
from sheetbench.scenes.objects.plan_mesh import divided
from sheetbench.scenes.objects.shapes import COINCIDENT, Shape

Elements = int | tuple[int, int]

# A nine-node element drawn as four bilinear quadrilaterals; local nodes: 4 corners, 4 mid-sides, centre.
TOUCHING = 0.05  # largest distance of a shape that touches a side, over the side's length
MISSED_AREA = 0.03  # share of a round shape's area that straight sides, 16 or more around, miss
_QUARTERS = np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]])


def divisions(sheet: Sheet, elements: Elements) -> tuple[int, int]:
    """Return the elements along x and y: a given pair, or the counts of `scenes.objects.grid.elements_of`.
    Raises BadInput for fewer than one element."""
    counts = elements if isinstance(elements, tuple) else elements_of(sheet, elements)
    if min(counts) < 1:
        raise BadInput(f"elements = {elements}: at least one element along each side")
    return counts


def spacing(count: int, layer: int) -> np.ndarray:
    """Return fractions (count + 1,) of a side, finer towards both ends over `layer` elements in all. Sizes go
    like sin π(i + ½)/layer at the ends and are equal between: with layer = count the Chebyshev points ½ (1 −
    cos π i/count), with layer = 1 equal spacing."""
    from_end = np.minimum(np.arange(count), np.arange(count)[::-1]) + 0.5
    size = np.sin(np.pi * np.minimum(from_end / layer, 0.5))
    return np.concatenate([[0.0], np.cumsum(size)]) / size.sum()


def rectangle(sheet: Sheet, elements: Elements, graded: bool = False) -> MeshQuad:
    """Return a mesh of the sheet whose boundaries carry the edges' names, uniform or graded towards all
    edges. At edges a clamp that ends at a free edge has a singularity and a thick sheet has boundary layers:
    with as many elements, the error is far smaller."""
    return _tensor(*_lines(sheet, divisions(sheet, elements), graded, ()), *sheet.lengths)


@cached(last=16, most=1 << 14)
def _tensor(x: np.ndarray, y: np.ndarray, *lengths: float) -> MeshQuad:
    """Return the mesh between lines at x and y of a sheet with given side lengths [m]."""
    return _with_edges(MeshQuad.init_tensor(x, y), lengths)


def _with_edges(mesh: MeshQuad, lengths: Sequence[float]) -> MeshQuad:
    """Return the mesh with named boundaries at the edges of a sheet with given side lengths [m]."""

    def on(name: str) -> Callable[[np.ndarray], np.ndarray]:
        axis, far = EDGES[name].normal_axis, EDGES[name].far_end
        return lambda x: np.isclose(x[axis], lengths[axis] * far, rtol=1e-9, atol=1e-12)

    return mesh.with_boundaries({name: on(name) for name in EDGES})


@dataclass(frozen=True, eq=False)
class Plan:
    """Mesh, the biquadratic nodes of its elements (m, 9), and the nodes' plan positions (n, 2) [m]."""

    mesh: MeshQuad
    elements: np.ndarray
    nodes: np.ndarray

    @property
    def corners(self) -> np.ndarray:
        """Plan positions (m, 9, 2) [m] of the elements' nodes."""
        return self.nodes[self.elements]

    def within(self, shape: Shape | None) -> np.ndarray:
        """Return the elements (k,) in a shape, whose borders lie on their sides, or all."""
        middles = self.nodes[self.elements[:, 8]]
        return np.arange(len(middles)) if shape is None else np.flatnonzero(shape.contains(middles))

    def touching(self, shape: Shape) -> np.ndarray:
        """Return the nodes (k,) of the elements in a shape, or, if there are none, of the rim's sides that it
        touches. The distance to a touched side is small against its length: the shape may have more corners
        than the mesh."""
        inside = self.within(shape)
        if len(inside):
            return np.unique(self.elements[inside])
        import shapely

        facets = self.mesh.boundary_facets()
        ends = self.mesh.p[:, self.mesh.facets[:, facets]]
        near = TOUCHING * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=0)
        places = np.stack([*ends.swapaxes(0, 1), ends.mean(axis=1)])  # ends and middles
        off = shapely.distance(shape.area, shapely.points(places.swapaxes(1, 2)))
        return self._on_facets(facets[(off < near).all(axis=0)])

    def on_boundary(self, name: str) -> np.ndarray:
        """Return the nodes (k,) of a boundary, in order."""
        return self._on_facets(self.mesh.boundaries[name])

    def _on_facets(self, facets: np.ndarray) -> np.ndarray:
        return np.unique(np.concatenate([self.mesh.facets[:, facets].ravel(), self.mesh.nvertices + facets]))


def plan_of(mesh: MeshQuad) -> Plan:
    """Return a mesh with biquadratic nodes: corners, mid-sides, centres; not to be changed."""
    return Plan(mesh, *_nodes(type(mesh), mesh.doflocs, mesh.t))


@cached(last=8, most=1 << 18)
def _nodes(kind: type[MeshQuad], places: np.ndarray, elements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    mesh = kind(places, elements)
    curved = mesh if kind is MeshQuad2 else MeshQuad2.from_mesh(mesh)
    # of one layout: kernels are compiled for it
    return np.ascontiguousarray(curved.dofs.element_dofs.T), np.ascontiguousarray(curved.doflocs.T)


def mesh_of(scene: Scene, elements: Elements, graded: bool = False, reach: float = 1.0) -> MeshQuad:
    """Return the mesh of a scene's sheet; its planes of symmetry are no edges (see `rectangle`). Sides of
    elements lie on the borders of shapes. If all borders lie along the axes, lines near them are moved there,
    with more lines where there are fewer than borders; else see `outlined`. A sheet's own mesh is taken where
    it has as many elements, unchanged or with each cut into 4, 16, …; none of its meshes has thinner rows
    along rims."""
    counts, lengths = divisions(scene.sheet, elements), scene.sheet.lengths
    graded = graded and scene.sheet.mesh is None
    if (own_mesh := _own_mesh(scene.sheet, counts)) is not None:
        mesh = _with_edges(own_mesh, lengths)
        _require_borders(scene, mesh)
        return mesh
    borders = borders_of(scene)
    if borders is None or borders.along_axes:
        mesh = _tensor(*lines_of(scene, counts, graded, reach), *lengths)
        if borders is None or not scene.pierced:
            return mesh
        import shapely

        inside = shapely.contains_xy(borders.region, *mesh.p[:, mesh.t].mean(axis=1))
        return _with_edges(mesh.restrict(np.flatnonzero(inside)), lengths)
    spacing = lengths[0] / counts[0], lengths[1] / counts[1]
    return _with_edges(quadrilaterals(*borders, spacing, graded), lengths)


def _own_mesh(sheet: Sheet, counts: tuple[int, int]) -> MeshQuad | None:
    """Return the sheet's own mesh, cut into the requested number of elements, or None if it cannot be."""
    if sheet.mesh is None:
        return None
    cuts = max(0, round(np.log2(min(counts) / min(elements_of(sheet, MESH)))))
    if elements_of(sheet, MESH << cuts) != counts:
        return None
    points, quads = sheet.mesh.arrays
    for _ in range(cuts):
        points, quads = divided(points, [quads])
    return mesh_of_cells(points, quads)


def _require_borders(scene: Scene, mesh: MeshQuad) -> None:
    """Raise BadInput for a shape whose border is not, or not nearly, made of element sides."""
    import shapely

    elements = shapely.polygons(mesh.p[:, mesh.t].transpose(2, 1, 0))
    parts = []
    for shape in shapes_of(scene, lines=False):
        covered = shapely.area(elements[shape.contains(mesh.p[:, mesh.t].mean(axis=1).T)]).sum()
        parts.append((shape, covered, area_in(scene, shape)))
    for load in scene.loads:
        if isinstance(load, EdgeLoad) and load.where is not None:
            ends = mesh.p[:, mesh.facets[:, facets_on(mesh, load)]]
            length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=0).sum()
            parts.append((load.where, length, edge_length(scene, load.edge, load.where)))
    for shape, covered, size in parts:
        if abs(covered - size) > MISSED_AREA * size:
            raise BadInput(
                f"sheet.mesh: its sides do not lie on the border of the {shape.in_words()}: elements with "
                f"their middles there are {100.0 * covered / size:.3g} % of the part; give it its own mesh"
            )


def lines_of(
    scene: Scene, counts: tuple[int, int], graded: bool, reach: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return the lines of `mesh_of`, x and y [m]; equally spaced lines for a mesh without lines."""
    borders, graded = borders_of(scene), graded and scene.sheet.mesh is None
    if not has_lines(scene):
        x, y = _lines(scene.sheet, counts, False, _cuts(scene))
        return (_with_rows(x), _with_rows(y)) if graded else (x, y)
    x, y = _lines(scene.sheet, counts, graded, _cuts(scene), reach)
    if borders is None:
        return x, y
    along_x, along_y = borders.lines(scene.sheet.lengths)
    return _through(x, along_x), _through(y, along_y)


def _with_rows(lines: np.ndarray) -> np.ndarray:
    """Return lines with the thin rows of `outlined` along the rim."""
    first, last = np.diff(lines)[[0, -1]]
    rows = np.array(LAYERS)
    low, high = lines[0] + first * rows, lines[-1] - last * rows[::-1]
    return np.concatenate([lines[:1], low, lines[1:-1], high, lines[-1:]])


def _through(lines: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Return the lines with some moved to the sides, at least one each, and the others in proportion. Sides
    in mirror symmetry with one in the middle have an even number of elements."""
    count, places, length = max(len(lines) - 1, len(sides) + 1), sides.tolist(), float(lines[-1])
    if len(sides) % 2 and is_mirrored(places, length):
        count += count % 2
    numbers = np.arange(count + 1)
    lines = PiecewiseCurve(np.linspace(0.0, count, len(lines)).tolist(), lines.tolist()).at(numbers)
    in_elements = PiecewiseCurve(lines.tolist(), numbers.tolist()).at(sides)
    fixed = [0, *line_numbers(in_elements.tolist(), count), count]
    return PiecewiseCurve(lines[fixed].tolist(), [lines[0], *places, lines[-1]]).at(lines)


def _cuts(scene: Scene) -> list[str]:
    return [support.edge for support in scene.supports if isinstance(support, Symmetric)]


def _lines(
    sheet: Sheet, counts: tuple[int, int], graded: bool, cuts: Collection[str], reach: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    cut = [[name for name in cuts if EDGES[name].normal_axis == axis] for axis in (0, 1)]
    across = min(n << len(at) for n, at in zip(counts, cut, strict=True))
    layer = max(1, round(reach * across)) if graded else 1
    x, y = (length * _part(n, layer, at) for length, n, at in zip(sheet.lengths, counts, cut, strict=True))
    return x, y


def _part(count: int, layer: int, cuts: Collection[str]) -> np.ndarray:
    """Return fractions (count + 1,) of a side; of a half side, where it is cut at one end."""
    if not cuts:
        return spacing(count, layer)
    half = 2.0 * spacing(2 * count, layer)[: count + 1]
    return half if all(EDGES[name].far_end for name in cuts) else 1.0 - half[::-1]


def facets_on(mesh: MeshQuad, load: EdgeLoad) -> np.ndarray:
    """Return the facets (k,) of a load's edge, or of its part in a shape, whose borders lie on their ends."""
    facets = np.asarray(mesh.boundaries[load.edge])
    if load.where is None:
        return facets
    import shapely

    middles = shapely.points(mesh.p[:, mesh.facets[:, facets]].mean(axis=1).T)
    return facets[shapely.distance(load.where.area, middles) < COINCIDENT * np.ptp(mesh.p)]


def quarters(element_nodes: np.ndarray) -> np.ndarray:
    """Return nine-node elements (9, m) as bilinear cells (4 m, 4) for drawing."""
    return element_nodes.T[:, _QUARTERS].reshape(-1, 4)
