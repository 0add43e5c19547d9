"""Drawn sheets answer alike mirrored, turned, upside down and ten times as large, but for rounding."""

from typing import Any

import numpy as np
import pytest

import fem_reference
import lumped
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from sheetbench.answers.solution import Status
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.region import off_sheet

Document = dict[str, Any]
CHANGES = ("mirrored", "turned by 90°", "upside down", "ten times as large")
_EDGES = {
    "mirrored": {"x0": "x1", "x1": "x0", "y0": "y0"},
    "turned by 90°": {"x0": "y0", "y0": "x1", "y1": "x0"},
}


class _Pen:
    """Draws numbers, half of them round ones, on which sides and ties of lines lie."""

    def __init__(self, seed: int, oblique: bool):
        self.random = np.random.default_rng(seed)
        self.oblique = oblique

    def either(self, *options: Any) -> Any:
        return options[self.random.integers(len(options))]

    def share(self, low: float, high: float) -> float:
        place = low + (high - low) * self.random.random()
        return float(self.either(round(place, 4), round(20.0 * place) / 20.0))

    def box(self, lx: float, ly: float) -> Document:
        spans = []
        for length in (lx, ly):
            low = self.share(0.1, 0.6)
            spans.append([low * length, (low + self.share(0.15, 0.35)) * length])
        return {"rectangle": {"x": spans[0], "y": spans[1]}}

    def shape(self, lx: float, ly: float) -> Document:
        kind = self.either("box", "circle", "polygon") if self.oblique else "box"
        if kind == "box":
            return self.box(lx, ly)
        x, y = self.share(0.3, 0.7) * lx, self.share(0.3, 0.7) * ly
        if kind == "circle":
            return {"circle": {"centre": [x, y], "radius": self.share(0.1, 0.2) * lx}}
        corners = self.either(3, 5)
        angles = self.random.random() + 2.0 * np.pi * np.arange(corners) / corners
        return {"polygon": [[x + 0.18 * lx * np.cos(a), y + 0.18 * lx * np.sin(a)] for a in angles]}


def draw(seed: int, oblique: bool = False) -> Document:
    """A sheet with holes, patches or an outline, held and loaded at edges and in parts, that bends little."""
    pen = _Pen(seed, oblique)
    lx = round(0.1 + 0.04 * pen.random.random(), int(pen.either(2, 5)))
    ly = round(lx * pen.either(1.0, 0.75, 1.5, 1.8), 6)
    scene: Document = {
        "name": f"drawn {seed}",
        "sheet": {"length_x": lx, "length_y": ly, "thickness": 3e-3},
        "material": {"young": 5e6, "poisson": 0.35, "density": 1000.0},
        "gravity": {"acceleration": [0.0, 0.0, -0.02]},
        "supports": [],
        "loads": [],
    }
    kind = pen.either("hole", "patch", "both", "outline")
    if kind in ("hole", "both"):
        scene["cutouts"] = [{"shape": pen.shape(lx, ly)}]
    if kind in ("patch", "both"):
        scene["patches"] = [{"shape": pen.shape(lx, ly), "thickness": 0.005}]
        if pen.random.random() < 0.4:
            scene["patches"].append({"shape": pen.shape(lx, ly), "young": 2e7})
    if kind == "outline":
        x, y = pen.share(0.3, 0.7) * lx, pen.share(0.4, 0.8) * ly
        cut = [[x, ly]] if oblique else [[x, y], [x, ly]]
        scene["sheet"]["outline"] = [[0.0, 0.0], [lx, 0.0], [lx, y], *cut, [0.0, ly]]
    if kind != "outline" and pen.random.random() < 0.3:
        part = pen.share(0.25, 0.4)
        held = {"rectangle": {"x": [0.0, part * lx], "y": [0.0, part * ly]}}
        scene["supports"].append({"kind": "clamped", "where": held})
    else:
        scene["supports"].append({"kind": "clamped", "edge": "x0"})
    if pen.random.random() < 0.3:
        scene["supports"].append({"kind": "hinged", "edge": "y0"})
    load = pen.either("pressure", "part", "edge", "none")
    if load == "pressure":
        scene["loads"].append({"kind": "pressure", "value": 0.2})
    if load == "part":
        pressed = {"rectangle": {"x": [0.7 * lx, 0.95 * lx], "y": [0.05 * ly, 0.35 * ly]}}
        scene["loads"].append({"kind": "pressure", "value": 0.4, "where": pressed})
    if load == "edge":
        scene["loads"].append({"kind": "edge", "edge": "y0", "force_per_length": [0.01, 0.02, -0.005]})
    return scene


class Change:
    """One of CHANGES of a scene of a sheet with sides lx and ly [m]."""

    def __init__(self, kind: str, lx: float, ly: float):
        self.kind, self.lx, self.ly = kind, lx, ly
        self.size = 10.0 if kind == "ten times as large" else 1.0

    def place(self, point: Any) -> list[float]:
        """Where a plan point comes to lie."""
        x, y = (float(at) for at in point)
        if self.kind == "mirrored":
            return [self.lx - x, y]
        return [self.ly - y, x] if self.kind == "turned by 90°" else [self.size * x, self.size * y]

    def vector(self, vector: Any) -> list[float]:
        """What becomes of a vector in space, but for its size."""
        x, y, z = (float(part) for part in vector)
        changed = {"mirrored": [-x, y, z], "turned by 90°": [-y, x, z], "upside down": [x, y, -z]}
        return changed.get(self.kind, [x, y, z])

    def _shape(self, shape: Document) -> Document:
        if "rectangle" in shape:
            corners = np.array([self.place(at) for at in zip(*shape["rectangle"].values(), strict=True)])
            return {"rectangle": dict(zip("xy", np.sort(corners, axis=0).T.tolist(), strict=True))}
        if "circle" in shape:
            centre, radius = shape["circle"]["centre"], self.size * shape["circle"]["radius"]
            return {"circle": {"centre": self.place(centre), "radius": radius}}
        return {"polygon": [self.place(at) for at in shape["polygon"]]}

    def _part(self, part: Document) -> Document:
        """A support, a load, a patch or a cutout."""
        new = {**part}
        for key in {"where", "shape"} & {*part}:
            new[key] = self._shape(part[key])
        if "edge" in part:
            new["edge"] = _EDGES.get(self.kind, {}).get(part["edge"], part["edge"])
        if "thickness" in part:
            new["thickness"] = self.size * part["thickness"]
        if "force_per_length" in part:
            new["force_per_length"] = [self.size * each for each in self.vector(part["force_per_length"])]
        if part.get("kind") == "pressure" and self.kind == "upside down":
            new["value"] = -part["value"]
        return new

    def scene(self, scene: Document) -> Document:
        """The scene; enlarged with forces that bend it to a shape ten times as large."""
        sheet = {**scene["sheet"], "thickness": self.size * scene["sheet"]["thickness"]}
        sides = (self.ly, self.lx) if self.kind == "turned by 90°" else (self.lx, self.ly)
        sheet["length_x"], sheet["length_y"] = (self.size * side for side in sides)
        if "outline" in sheet:
            sheet["outline"] = [self.place(at) for at in sheet["outline"]]
        fall = [each / self.size for each in self.vector(scene["gravity"]["acceleration"])]
        parts = {
            key: [self._part(part) for part in scene[key]]
            for key in ("supports", "loads", "patches", "cutouts")
            if key in scene
        }
        return {**scene, **parts, "sheet": sheet, "gravity": {"acceleration": fall}}


def points_of(scene: Scene) -> np.ndarray:
    """Plan points [m] on the sheet: on lines of a grid of 7, between them, and anywhere."""
    even = np.linspace(0.0, 1.0, 13)
    anywhere = np.random.default_rng(5).random((40, 2))
    places = np.concatenate([np.stack(np.meshgrid(even, even), axis=-1).reshape(-1, 2), anywhere])
    return np.array([point for point in places * scene.sheet.lengths if not off_sheet(scene, tuple(point))])


ALIGNED, OBLIQUE = range(30), range(30, 50)  # seeds: of sides along the axes, of any sides
# that differed, some by ties of lines or held masses, others between cells
OFTEN = {"lattice": (3, 14, 28, 45), "shell": (9, 24, 32, 47)}
# 7.5 cells of a lattice of 6 along one side, of a shell of 5 likewise
HALVES = {"lattice": (4, 18), "shell": (4, 39)}


def lattice(scene, grid=7):
    return lumped.solve(scene, resolve(scene, Lattice(grid=grid)).springs)


def shell(scene, elements=4):
    return fem_reference.solve(scene, "shell", elements=elements)


def by_turns(part, n):
    """Points of a square of side 1 about its middle, and more numbers, of n sectors."""
    turned = [(complex(x, y) * 1j ** (4 * k // n), more) for k in range(n) for x, y, *more in part]
    return [(0.5 + at.real, 0.5 + at.imag, *more) for at, more in turned]


# parts of a square of side 1 that are their own image across a diagonal or more lines, or by a turn alone
OWN_IMAGES = {
    "triangle": {"outline": [(0, 0), (1, 0), (0, 1)]},
    "cut corner": {"outline": [(0, 0), (1, 0), (1, 0.6), (0.6, 1), (0, 1)]},
    "two holes": {"holes": [(0.3, 0.7, 0.1), (0.7, 0.3, 0.1)]},
    "hole in the middle": {"holes": [(0.5, 0.5, 0.2)]},
    "parallelogram": {"outline": by_turns([(-0.5, -0.5), (0.5, -0.2)], 2)},
    "pinwheel of holes": {"holes": by_turns([(-0.2, -0.1, 0.1)], 4)},
    "pinwheel about a hole": {"holes": [*by_turns([(-0.25, -0.15, 0.08)], 4), (0.5, 0.5, 0.12)]},
    "four holes in a row": {"holes": by_turns([(-0.3, -0.2, 0.1), (-0.1, -0.15, 0.07)], 2)},
}


def square(outline=(), holes=()):
    """A drawn sheet 100 mm wide, clamped at x0."""
    scene = {**draw(0), "supports": [{"kind": "clamped", "edge": "x0"}], "loads": []}
    scene = {key: part for key, part in scene.items() if key not in ("cutouts", "patches")}
    scene["sheet"] = {"length_x": 0.1, "length_y": 0.1, "thickness": 3e-3}
    if outline:
        scene["sheet"]["outline"] = [[0.1 * x, 0.1 * y] for x, y in outline]
    circles = [{"centre": [0.1 * x, 0.1 * y], "radius": 0.1 * radius} for x, y, radius in holes]
    return {**scene, "cutouts": [{"shape": {"circle": circle}} for circle in circles]}


def changed_by(drawn, answer):
    """How far the answers to changed scenes are from the changed answer, in parts of the largest."""
    scene = Scene(**drawn)
    points = points_of(scene)
    whole = answer(scene)
    assert whole.status is Status.CONVERGED
    own = whole.displacement(points)
    assert np.abs(own).max() > 1e-7
    away = {}
    for kind in CHANGES:
        change = Change(kind, *scene.sheet.lengths)
        found = answer(Scene(**change.scene(drawn))).displacement([change.place(point) for point in points])
        meant = change.size * np.array([change.vector(u) for u in own])
        away[kind] = float(np.abs(found - meant).max() / np.abs(meant).max())
    return away


MODELS = {"lattice": (lattice, 7, 6), "shell": (shell, 4, 5)}  # and sizes, one that leaves half a cell over


def rows():
    """A model, a seed and whether half a cell is left over; by day those that differed."""
    for model, often in OFTEN.items():
        for seed in (*ALIGNED, *OBLIQUE):
            yield pytest.param(model, seed, False, marks=() if seed in often else pytest.mark.nightly)
        yield from ((model, seed, True) for seed in HALVES[model])


@pytest.mark.parametrize(("model", "seed", "half"), list(rows()))
def test_a_drawn_sheet_answers_alike(model, seed, half):
    answer, *sizes = MODELS[model]
    changes = changed_by(draw(seed, seed in OBLIQUE), lambda scene: answer(scene, sizes[half]))
    assert max(changes.values()) < 1e-9


@pytest.mark.sweep(2)
@pytest.mark.parametrize("plan", OWN_IMAGES)
def test_a_shell_that_is_its_own_image_answers_alike(plan):
    """They were 1e-4 to 1e-3 off: chance chose between two like triangulations."""
    assert max(changed_by(square(**OWN_IMAGES[plan]), shell).values()) < 1e-9
