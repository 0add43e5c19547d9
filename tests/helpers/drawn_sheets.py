"""Random sheets of the drawn kind, what becomes of them mirrored, turned, enlarged and in other words."""

from typing import Any

import numpy as np

from sheetbench.scenes import EDGES

Document = dict[str, Any]
CHANGES = {  # what becomes of vectors in space
    "mirrored": np.diag([-1.0, 1.0, 1.0]),
    "turned by 90°": np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
    "upside down": np.diag([1.0, 1.0, -1.0]),
    "ten times as large": np.diag([10.0, 10.0, 10.0]),
}


class _Pen:
    """A source of random numbers, half of them round ones, so that sides and ties of lines lie on them."""

    def __init__(self, seed: int, oblique: bool):
        self.random = np.random.default_rng(seed)
        self.oblique = oblique

    def either(self, *options: Any) -> Any:
        return options[self.random.integers(len(options))]

    def share(self, low: float, high: float) -> float:
        place = low + (high - low) * self.random.random()
        return float(self.either(round(place, 4), round(20.0 * place) / 20.0))

    def span(self, length: float) -> list[float]:
        low = self.share(0.1, 0.6)
        return [low * length, (low + self.share(0.15, 0.35)) * length]

    def shape(self, lx: float, ly: float) -> Document:
        kind = self.either("box", "circle", "polygon") if self.oblique else "box"
        if kind == "box":
            return {"rectangle": {"x": self.span(lx), "y": self.span(ly)}}
        x, y = self.share(0.3, 0.7) * lx, self.share(0.3, 0.7) * ly
        if kind == "circle":
            return {"circle": {"centre": [x, y], "radius": self.share(0.1, 0.2) * lx}}
        corners = self.either(3, 5)
        angles = self.random.random() + 2.0 * np.pi * np.arange(corners) / corners
        return {"polygon": [[x + 0.18 * lx * np.cos(a), y + 0.18 * lx * np.sin(a)] for a in angles]}


def draw(seed: int, oblique: bool = False) -> Document:
    """Draw a sheet with holes, patches or an outline, supports and loads at edges and in parts, that bends
    little."""
    pen = _Pen(seed, oblique)
    lx = round(0.1 + 0.04 * pen.random.random(), int(pen.either(2, 5)))
    ly = round(lx * pen.either(1.0, 0.75, 1.5, 1.8), 6)
    scene: Document = {
        "name": f"drawn {seed}",
        "sheet": {"length_x": lx, "length_y": ly, "thickness": 3e-3},
        "material": {"young": 5e6, "poisson": 0.35, "density": 1000.0},
        "gravity": {"acceleration": [0.0, 0.0, -0.02]},
        "supports": [],
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
    pressed = {"rectangle": {"x": [0.7 * lx, 0.95 * lx], "y": [0.05 * ly, 0.35 * ly]}}
    loads = (
        [{"kind": "pressure", "value": 0.2}],
        [{"kind": "pressure", "value": 0.4, "where": pressed}],
        [{"kind": "edge", "edge": "y0", "force_per_length": [0.01, 0.02, -0.005]}],
        [],
    )
    return {**scene, "loads": pen.either(*loads)}


def furnish(seed: int) -> Document:
    """Draw further parts for a drawn sheet: natural strain or pretension, heat, held points, tilted and
    sliding edges, moving supports, forces, payloads, obstacles."""
    pen, scene = _Pen(10_000 + seed, True), draw(seed, seed % 2 > 0)
    for patch in scene.get("patches", []) if seed % 4 < 2 else []:  # as thick all over, which the solid takes
        patch["young"] = patch.pop("thickness", 0.0) * 3e9 or patch["young"]
    lx, ly, h = (scene["sheet"][key] for key in ("length_x", "length_y", "thickness"))
    rectangle = "outline" not in scene["sheet"] and "cutouts" not in scene

    def anywhere() -> list[float]:
        return [pen.share(0.6, 0.9) * lx, pen.share(0.2, 0.8) * ly]

    def some(high: float, low: float = 0.0) -> float:
        return low + (high - low) * pen.random.random()

    for support in scene["supports"]:
        if support["kind"] == "hinged":
            support["twist"] = pen.either("free", "held")
    kind = pen.either("strain", "curvature", "both", "tension", "none", "none")
    if kind == "tension" and "patches" not in scene:
        scene["natural"] = {"pretension": [some(50.0), some(50.0)]}
    elif kind != "none":
        natural = {"strain": [some(1e-4, -5e-3) for _ in range(3)]}
        natural["curvature"] = [some(1.0, -1.0) for _ in range(3)]
        scene["natural"] = natural if kind == "both" else {kind: natural[kind]} if kind in natural else {}
    if pen.either(True, False, False):
        scene["material"]["expansion"] = 2e-4
        scene["temperature"] = {"change": some(0.0, -20.0), "gradient": some(500.0, -500.0)}
    held, motion = scene["supports"], {"time": [0.0], "displacement": [[1e-4, -5e-5, 1e-4]]}
    if "edge" in held[0] and pen.either(True, False, False):
        held[0] |= pen.either({"motion": motion}, {"tilt": 0.02}) if len(held) == 1 else {}
    elif rectangle and pen.either(True, False):
        axes = pen.either(["x", "y", "z"], ["z"], ["x"], ["y", "z"])
        point = {"kind": "point", "at": anywhere()}
        kinds = point, point, {"kind": "held", "edge": "x1"}, {"kind": "held", "edge": "y1"}
        held.append({**pen.either(*kinds), "components": axes})
    loads = scene["loads"] = [*scene["loads"]]
    if rectangle and pen.either(True, False):
        loads.append({"kind": "point", "at": anywhere(), "force": [1e-3, -2e-3, some(2e-3, -2e-3)]})
    if pen.either(True, False):
        part = {
            "where": pen.shape(lx, ly)
            if rectangle
            else {"rectangle": {"x": [0.0, 0.5 * lx], "y": [0.0, 0.3 * ly]}}
        }
        scene["masses"] = [{"mass": 1e-3, **(pen.either({"at": anywhere()}, part) if rectangle else part)}]
    if pen.either(True, False, False, False):
        below = {"position": [0.6 * lx, 0.5 * ly, -0.03 - 0.5 * h - 1e-3], "radius": 0.03}
        plane = {"position": [0.0, 0.0, -0.5 * h - 2e-4], "normal": [0.0, 0.0, 1.0]}
        scene["obstacles"] = [pen.either({"kind": "sphere", **below}, {"kind": "plane", **plane})]
    return scene


class Change:
    """One of CHANGES of a scene of a sheet with sides lx and ly [m]."""

    def __init__(self, kind: str, lx: float, ly: float):
        self.map = CHANGES[kind]
        self.plan, self.up, self.size = self.map[:2, :2], np.sign(self.map[2, 2]), abs(self.map[2, 2])
        corners = np.array([[0.0, 0.0], [lx, ly]]) @ self.plan.T
        self.corner, self.lengths = corners.min(axis=0), np.ptp(corners, axis=0)

    def places(self, points: Any) -> Any:
        """Return the images of plan points."""
        return (np.array(points) @ self.plan.T - self.corner).tolist()

    def edge(self, name: str) -> str:
        """Return the image of an edge."""
        outward = self.map @ EDGES[name].outward
        return next(each for each, edge in EDGES.items() if outward @ edge.outward > 0.5)

    def shape(self, shape: Document) -> Document:
        if "rectangle" in shape:
            corners = self.places([*zip(*shape["rectangle"].values(), strict=True)])
            return {"rectangle": dict(zip("xy", np.sort(corners, axis=0).T.tolist(), strict=True))}
        if "circle" in shape:
            (centre,) = self.places([shape["circle"]["centre"]])
            return {"circle": {"centre": centre, "radius": self.size * shape["circle"]["radius"]}}
        return {"polygon": self.places(shape["polygon"])}

    def vector(self, vector: Any) -> Any:
        return (self.map @ vector).tolist()

    def form(self, form: Any) -> Any:
        """Return the image of a symmetric form in the plan, [xx, yy, xy]."""
        xx, yy, xy = form
        (xx, xy), (_, yy) = self.plan @ [[xx, xy], [xy, yy]] @ self.plan.T / self.size**2
        return [xx, yy, xy]

    def curvature(self, curvature: Any) -> Any:
        return [self.up / self.size * k for k in self.form(curvature)]

    def part(self, part: Document) -> Document:
        """Return the image of a support, a load, a patch, a cutout, the sheet or another part."""
        changes = {
            "at": lambda at: self.places([at])[0],
            "components": lambda names: ["xyz"[np.abs(self.map["xyz".index(k)]).argmax()] for k in names],
            "motion": self.part,
            "displacement": lambda course: [*map(self.vector, course)],
            "tilt": lambda tilt: self.up * tilt,
            "natural": self.part,
            "strain": self.form,
            "curvature": self.curvature,
            "pretension": lambda pull: [self.size * n for n in self.form([*pull, 0.0])[:2]],
            "gradient": lambda gradient: self.up * gradient / self.size,
            "force": lambda force: [self.size * f for f in self.vector(force)],
            "mass": lambda mass: self.size**3 * mass,
            "position": lambda at: [*self.places([at[:2]])[0], float(self.map[2, 2] * at[2])],
            "radius": lambda radius: self.size * radius,
            "normal": self.vector,
            "where": self.shape,
            "shape": self.shape,
            "edge": self.edge,
            "outline": self.places,
            "thickness": lambda thickness: self.size * thickness,
            "force_per_length": self.vector,
            "value": lambda pressure: self.up * pressure,
        }
        return {key: changes[key](value) if key in changes else value for key, value in part.items()}

    def scene(self, scene: Document) -> Document:
        """Return the image of the scene, with forces for which its deformed shape is the image too."""
        lists = {key: [*map(self.part, each)] for key, each in scene.items() if isinstance(each, list)}
        sheet = self.part(scene["sheet"]) | dict(zip(("length_x", "length_y"), self.lengths, strict=True))
        fall = self.map @ scene["gravity"]["acceleration"] / self.size**2
        tables = {key: self.part(scene[key]) for key in ("natural", "temperature") if key in scene}
        return {**scene, **lists, **tables, "sheet": sheet, "gravity": {"acceleration": fall.tolist()}}


def halved(scene: Document) -> Document:
    """Return the loads, each as two of half its size."""
    values = ("force", "force_per_length", "value")
    loads = scene["loads"]
    halves = [
        {k: (0.5 * np.array(v)).tolist() if k in values else v for k, v in load.items()} for load in loads
    ]
    return {"loads": 2 * halves}


def in_text(scene: Document) -> Document:
    """Return sheet and material, their numbers with units; an outline is in metres."""
    if "outline" in scene["sheet"]:
        return {}
    lengths = {key: f"{1e3 * scene['sheet'][key]!r} mm" for key in ("length_x", "length_y", "thickness")}
    young = f"{1e-6 * scene['material']['young']!r} MPa"
    return {"sheet": {**scene["sheet"], **lengths}, "material": {**scene["material"], "young": young}}


def patched(scene: Document) -> Document:
    """Return a patch of the sheet's own material, where one is allowed."""
    if "pretension" in scene.get("natural", {}):
        return {}
    lx, ly = scene["sheet"]["length_x"], scene["sheet"]["length_y"]
    part = {"rectangle": {"x": [0.25 * lx, 0.75 * lx], "y": [0.25 * ly, 0.75 * ly]}}
    same = {"shape": part, "young": scene["material"]["young"]}
    return {"patches": [same, *scene.get("patches", [])]}


def in_time(scene: Document) -> Document:
    """Return the tables that may have a history, each with one of 1."""
    history = {"history": {"time": [0.0, 1.0], "factor": [1.0, 1.0]}}
    tables = {key: {**scene[key], **history} for key in ("gravity", "natural", "temperature") if key in scene}
    return {**tables, "loads": [{**load, **history} for load in scene["loads"]]}


def not_warmed(scene: Document) -> Document:
    """Return a temperature change of zero for a scene without one."""
    if "temperature" in scene:
        return {}
    return {"temperature": {"change": 0.0}, "material": {"expansion": 1e-4, **scene["material"]}}


FAR = {"kind": "sphere", "position": [0.0, 0.0, -50.0], "radius": 1.0}
WORDS = {  # what else of a scene means the same
    "loads in halves": halved,
    "numbers with units": in_text,
    "a patch of the sheet's own": patched,
    "a far obstacle": lambda scene: {"obstacles": [*scene.get("obstacles", []), FAR]},
    "no natural strain": lambda scene: {"natural": scene.get("natural", {"strain": [0.0, 0.0, 0.0]})},
    "no heat": not_warmed,
    "a history of 1": in_time,
}
