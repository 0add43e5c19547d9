"""Read a mesh or a drawing from one file: a program of its own, which `plan_mesh` runs.

    python mesh_reader.py FILE FORMAT

Standard output is an archive of NumPy's with `points` (n, 2 or 3) and, of a mesh, `triangle` (k, 3) and
`quad` (m, 4), numbers of points from 0; of a drawing `rings` (r,), the numbers of points of its outline and
of each hole, and `unit` (1,), the file's unit [m]. On failure the exit status is 2, and a line on standard
error gives the reason. No module of sheetbench is imported, so that the program starts within 0.2 s.

Wavefront OBJ is parsed here: the lines of places (v) and of faces (f), whose corners may also number texture
places and normals, as 3/1/7, and count back from the last place, as -1. Faces of more than four corners are
cut into triangles about one of them.

A drawing's lines, arcs and curves are joined into rings where their ends meet; the largest ring is the
outline, the rings within it are holes. Curves become polygons with a sagitta of SAGITTA of the drawing's
size at most.
"""

import sys
import warnings
from contextlib import redirect_stderr, redirect_stdout
from io import BytesIO, StringIO
from math import ceil, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np

CORNERS = {"triangle": 3, "quad": 4}
SHOWN = 6  # kinds of cells named
REFUSED = 2  # exit status
SAGITTA = 5e-5  # of a drawing's size
JOINED = 1e-6  # of a drawing's size: ends that are closer meet
PIXEL = 0.0254 / 96.0  # m, of CSS
NO_OUTLINE = ("TEXT", "MTEXT", "ATTDEF", "ATTRIB", "DIMENSION", "LEADER", "MULTILEADER", "HATCH", "POINT")


def read(path: Path, kind: str) -> dict[str, np.ndarray]:
    """Return the arrays of a file in a format of meshio or of this module. Raises ValueError with a clause on
    the reason."""
    if kind == "obj":
        return _obj(path)
    if kind not in DRAWINGS:
        return _by_meshio(path, kind)
    module, lines_of = DRAWINGS[kind]
    try:
        return _rings(*lines_of(path))
    except ModuleNotFoundError:
        raise ValueError(f"reading it needs {module}: pip install 'sheetbench[drawings]'") from None
    except ValueError:
        raise
    except Exception as error:  # ezdxf and svgelements raise errors of any kind
        raise ValueError(f"{module} cannot read it: {type(error).__name__} {_line(str(error))}") from None


def _by_meshio(path: Path, kind: str) -> dict[str, np.ndarray]:
    import meshio

    if kind == "abaqus" and _includes(path):
        raise ValueError("*INCLUDE: other files are not read; write what they hold into this one")
    printed = StringIO()
    try:
        with redirect_stdout(printed), redirect_stderr(printed):  # it prints, and ends the process
            mesh = meshio.read(path, kind)
        arrays: dict[str, np.ndarray] = {"points": np.asarray(mesh.points, dtype=float)}
        for name, corners in CORNERS.items():
            blocks = [b.data for b in mesh.cells if b.type.rstrip("0123456789") == name and len(b.data)]
            if blocks:
                arrays[name] = np.concatenate([np.asarray(block)[:, :corners] for block in blocks])
    except MemoryError:
        raise ValueError("reading it takes more memory than a mesh may") from None
    except SystemExit:
        raise ValueError(f"meshio cannot read it: {_line(printed.getvalue())}") from None
    except KeyError as error:  # a number, mostly
        raise ValueError(f"it names {error.args[0]}, which the file does not have") from None
    except Exception as error:
        raise ValueError(f"meshio cannot read it: {type(error).__name__} {_line(str(error))}") from None
    if len(arrays) == 1:
        kinds = ", ".join(list(dict.fromkeys(block.type for block in mesh.cells))[:SHOWN]) or "none"
        raise ValueError(f"no triangles and no quadrilaterals; its cells: {kinds}")
    return arrays


def _obj(path: Path) -> dict[str, np.ndarray]:
    points: list[list[float]] = []
    faces: dict[str, list[list[int]]] = {name: [] for name in CORNERS}
    for number, line in enumerate(path.read_text(errors="replace").replace("\\\n", " ").splitlines(), 1):
        word, *values = line.partition("#")[0].split() or ("",)
        try:
            if word == "v":
                points.append([float(value) for value in values[:3]])
                if len(points[-1]) < 3:
                    raise ValueError
            elif word == "f":
                named = [int(value.partition("/")[0]) for value in values]
                corners = [one - 1 if one > 0 else len(points) + one for one in named]
                if 0 in named or len(corners) < 3:
                    raise ValueError
                if len(corners) == 4:
                    faces["quad"].append(corners)
                else:
                    faces["triangle"] += _cut(corners, points)
        except ValueError:
            raise ValueError(f"line {number}: {line.strip()[:40]!r} is no {word} of Wavefront OBJ") from None
    cells = {name: np.array(corners) for name, corners in faces.items() if corners}
    if not cells:
        raise ValueError("no faces")
    return {"points": np.array(points).reshape(-1, 3), **cells}


def _cut(corners: list[int], points: list[list[float]]) -> list[list[int]]:
    """Cut a face into triangles about the corner for which the smallest triangle is largest."""
    if len(corners) == 3 or max(corners) >= len(points):
        return [corners[:3]]

    def smallest(triangles: list[list[int]]) -> float:
        a, b, c = (np.array([points[one[n]] for one in triangles]) for n in range(3))
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).min())

    turns = [corners[n:] + corners[:n] for n in range(len(corners))]
    fans = [[[one[0], *one[n : n + 2]] for n in range(1, len(one) - 1)] for one in turns]
    return max(fans, key=smallest)


def _dxf(path: Path) -> tuple[list[np.ndarray], float]:
    """Return the lines (n, 2) of a drawing and its unit [m]."""
    from ezdxf import recover, units
    from ezdxf.disassemble import recursive_decompose
    from ezdxf.enums import InsertUnits
    from ezdxf.path import make_path

    document, _ = recover.readfile(path)
    drawn = (one for one in document.modelspace() if one.dxftype() not in NO_OUTLINE)
    paths = []
    for entity in recursive_decompose(drawn):
        try:
            paths.append(make_path(entity))
        except TypeError:  # a kind without lines
            raise ValueError(f"{entity.dxftype()}: give the outline as lines, arcs and curves") from None
    ends = np.array([at for path in paths for at in (*path.control_vertices(), path.end)]).reshape(-1, 3)
    size = np.ptp(ends, axis=0) if len(ends) else np.ones(3)
    if size[2] > JOINED * size.max() and len(ends):
        raise ValueError("it does not lie in a plane z = constant")
    lines = [np.array([(at.x, at.y) for at in path.flattening(SAGITTA * size.max())]) for path in paths]
    unit = InsertUnits(document.units)
    metres = units.conversion_factor(unit, InsertUnits.Meters) if unit else 1.0
    return lines, float(metres)


def _svg(path: Path) -> tuple[list[np.ndarray], float]:
    """Return the lines (n, 2) of a drawing, y up, and its unit [m]."""
    from svgelements import SVG, Close, Line, Move, Path, Shape

    drawn = (one for one in SVG.parse(str(path), reify=True).elements() if isinstance(one, Shape))
    parts = [Path(part) for one in drawn for part in Path(one).as_subpaths()]
    ends = [(s.end.x, s.end.y) for part in parts for s in part if s.end is not None]
    size = float(np.ptp(ends, axis=0).max()) if ends else 1.0
    lines = []
    for part in parts:
        places: list[Any] = []
        for segment in part:
            if segment.end is None:
                continue
            straight = isinstance(segment, Move | Line | Close)
            # corners of a circle are off by its angle squared over 8 of the radius; a quarter of that here
            count = 1 if straight else ceil(sqrt(pi * segment.length() / (4.0 * SAGITTA * size)))
            places += [segment.end] if straight else map(segment.point, np.linspace(0.0, 1.0, count + 1)[1:])
        lines.append(np.array([(at.x, -at.y) for at in places]))
    return lines, PIXEL


def _rings(lines: list[np.ndarray], unit: float) -> dict[str, np.ndarray]:
    """Join lines (n, 2) into the rings of one outline and its holes."""
    import shapely
    from scipy.spatial import cKDTree

    lines = [line for line in lines if len(line) > 1 and np.abs(line - line[0]).any()]
    if not lines:
        raise ValueError("it draws no lines")
    size = float(np.ptp(np.concatenate(lines), axis=0).max())
    ends = np.concatenate([line[[0, -1]] for line in lines])
    joined = ends[[min(near) for near in cKDTree(ends).query_ball_point(ends, JOINED * size)]]
    for line, (start, end) in zip(lines, joined.reshape(-1, 2, 2), strict=True):
        line[0], line[-1] = start, end
    faces = shapely.get_parts(shapely.polygonize([shapely.LineString(line) for line in lines]))
    if not len(faces):
        raise ValueError("its lines enclose nothing: their ends do not meet")
    sheet = max(faces, key=lambda face: shapely.Polygon(face.exterior).area)
    filled = shapely.Polygon(sheet.exterior)
    if any(not filled.covers(face) for face in faces):
        raise ValueError("it encloses several parts; a sheet is one piece with holes")
    rings = [np.array(ring.coords)[:-1] for ring in (sheet.exterior, *sheet.interiors)]
    lengths = np.array([len(ring) for ring in rings])
    return {"points": np.concatenate(rings), "rings": lengths, "unit": np.array([unit])}


DRAWINGS = {"dxf": ("ezdxf", _dxf), "svg": ("svgelements", _svg)}


def _includes(path: Path) -> bool:
    """Return whether meshio reads a line of the file as *INCLUDE."""
    with path.open(errors="replace") as file:
        return any(line.partition(",")[0].strip().replace("*", "").upper() == "INCLUDE" for line in file)


def _line(text: str) -> str:
    return " ".join(text.split())


if __name__ == "__main__":
    warnings.simplefilter("ignore")  # they would stand before the reason
    try:
        archive = BytesIO()
        np.savez(archive, **read(Path(sys.argv[1]), sys.argv[2]))  # type: ignore[arg-type]
        sys.stdout.buffer.write(archive.getvalue())
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(REFUSED)
