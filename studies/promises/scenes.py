"""Scenes drawn at random in the scene language, reproducible by their seed.

Shorter side a 0.05 to 0.5 m, the other up to 1.6 a, h/a 0.003 to 0.05, ν 0 to 0.49; E gives a load
number q a³/D of 0.03 to 10, q the weight per area, as far as ρ g a/E ≤ 0.03. Fourteen arrangements of
supports in turn, turned to any side of the sheet: one, two, three and four edges clamped, hinged or held,
clamps tilted and bent, edges moved; seven kinds of load at random: the weight, upright or slanting, a
pressure, forces at a point or along a free edge, moments. About a third of the sheets are weightless.

Scenes of a kind (`KINDS`) have a feature beside the weight: shorter side 0.1 to 0.3 m, h/a 0.005 to 0.03,
edges clamped or hinged; obstacles are nearer than the sheet would sag.

Probes are the scene's own four and as many of two more anywhere as are on the sheet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import cycle
from typing import Any

import numpy as np
import shapely

from sheetbench.scenes import EDGES, Material, Scene, Sheet

SEED = 41
GRAVITY = 9.81
DOWN = {"gravity": {"acceleration": [0.0, 0.0, -GRAVITY]}}
LARGEST_STRAIN = 0.03  # ρ g a/E
ROUND = ("x0", "y0", "x1", "y1")  # the edges in turn, around the sheet
ADDED = 2  # probes
KINDS = (
    "plain", "natural", "fibres", "patch", "payload", "plane", "points", "rubber", "hole", "temperature",
    "taper", "chain", "ball", "cylinder",
)  # fmt: skip

Edges = tuple[str, str, str, str]  # one, its neighbour, the one opposite, the other neighbour
Part = dict[str, Any]
Range = tuple[float, float]


def drawn_scenes(seed: int = SEED) -> Iterator[Scene]:
    """Yield scenes without end."""
    random = np.random.default_rng(seed)
    number = 0
    while True:
        yield _scene(random, number)
        number += 1


def scenes_of_kinds(kinds: Sequence[str], seed: int = SEED) -> Iterator[Scene]:
    """Yield scenes of kinds in turn without end, named by their kind and number."""
    random = np.random.default_rng(seed)
    for number, kind in enumerate(cycle(kinds)):
        yield _scene(random, number, kind)


def _sheet(random: np.random.Generator, shorter: Range, thickness: Range) -> tuple[Sheet, Material]:
    short, ratio = _log(random, *shorter), random.uniform(1.0, 1.6)
    sides = (short, short * ratio) if random.random() < 0.5 else (short * ratio, short)
    h, poisson = short * _log(random, *thickness), random.uniform(0.0, 0.49)
    density, load = random.uniform(900.0, 2000.0), _log(random, 0.03, 10.0)
    young = 12.0 * (1.0 - poisson**2) * density * GRAVITY * short**3 / (load * h**2)
    young = max(young, density * GRAVITY * max(sides) / LARGEST_STRAIN)
    return Sheet(*sides, h), Material(young, poisson, density)


def _scene(random: np.random.Generator, number: int, kind: str = "") -> Scene:
    sheet, material = _sheet(random, *(((0.1, 0.3), (0.005, 0.03)) if kind else ((0.05, 0.5), (0.003, 0.05))))
    sides, per_area = sheet.lengths, material.density * GRAVITY * sheet.thickness
    first = int(random.integers(4))
    edges: Any = tuple(ROUND[(first + i) % 4] for i in range(4))
    arrangement = int(random.integers(len(SAGS))) if kind else number % len(ARRANGEMENTS)
    holding = ARRANGEMENTS[arrangement](random, edges, sides)
    if kind:
        more = DOWN | _features(random, edges, sheet, material, SAGS[arrangement])[kind]
    else:
        held = {part["edge"] for parts in holding.values() for part in parts}
        more = _loads(random, sides, per_area, [edge for edge in ROUND if edge not in held])
    name = f"{kind or 'drawn'}-{number}"
    base = {"name": name, "sheet": sheet, "material": material, **holding, **more}
    scene = Scene.model_validate(base)
    places = random.uniform(0.05, 0.95, (ADDED, 2)) * sides
    on_sheet = places[shapely.contains_xy(scene.region, places)]
    probes = {f"P{5 + i}": place.tolist() for i, place in enumerate(on_sheet)}
    return Scene.model_validate({**base, "probes": {**scene.probes, **probes}})


def _log(random: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def _either(random: np.random.Generator, low: float, high: float) -> float:
    """Return a random number of either sign with a magnitude between two bounds."""
    return float(random.choice([-1.0, 1.0]) * random.uniform(low, high))


def _supports(kind: str, edges: Sequence[str], **more: Any) -> list[Part]:
    return [{"kind": kind, "edge": edge, **more} for edge in edges]


def _along(clamped: Sequence[int], hinged: Sequence[int] = ()) -> Callable[..., Part]:
    return lambda random, edges, sides: {
        "support": [
            *_supports("clamped", [edges[i] for i in clamped]),
            *_supports("hinged", [edges[i] for i in hinged]),
        ]
    }


def _tilted(random: np.random.Generator, edges: Edges, sides: tuple[float, float]) -> Part:
    return {"support": _supports("clamped", edges[:1], tilt=_either(random, 0.05, 0.4))}


def _tilted_both(random: np.random.Generator, edges: Edges, sides: tuple[float, float]) -> Part:
    tilts = _either(random, 0.02, 0.15), _either(random, 0.02, 0.15)
    both = zip((edges[0], edges[2]), tilts, strict=True)
    return {"support": [part for edge, tilt in both for part in _supports("clamped", [edge], tilt=tilt)]}


def _curved(random: np.random.Generator, edges: Edges, sides: tuple[float, float]) -> Part:
    along = sides[EDGES[edges[0]].along_axis]
    return {"support": _supports("curved", edges[:1], curvature=_either(random, 0.1, 0.75) / along)}


def _on_a_rail(random: np.random.Generator, edges: Edges, sides: tuple[float, float]) -> Part:
    rail = _supports("held", [edges[2]], components=["z"])
    return {"support": [*_supports("clamped", edges[:1]), *rail]}


def _moved(random: np.random.Generator, edges: Edges, sides: tuple[float, float]) -> Part:
    """Return a clamp, and the opposite edge lifted, pulled outwards and turned about itself."""
    moved = EDGES[edges[2]]
    length = sides[moved.normal_axis]
    pull = random.uniform(0.0, 0.005) * length * np.array(moved.outward)
    turn = np.zeros(3)
    turn[moved.along_axis] = _either(random, 0.02, 0.2)
    shift = np.array([*pull[:2], _either(random, 0.01, 0.08) * length])
    still = [0.0, 0.0, 0.0]
    motion = {"time": [0.0, 1.0], "displacement": [still, shift.tolist()], "rotation": [still, turn.tolist()]}
    return {
        "support": _supports("clamped", edges[:1]),
        "actuator": [{"kind": "motion", "edge": edges[2], **motion}],
    }


ARRANGEMENTS: tuple[Callable[..., Part], ...] = (
    *(_along(range(n)) for n in (1, 2)),
    _along((0, 2)),
    *(_along(range(n)) for n in (3, 4)),
    *(_along((), hinged) for hinged in (range(4), (0, 2))),
    *(_along((0,), (n,)) for n in (2, 1)),
    _on_a_rail, _tilted, _tilted_both, _curved, _moved,
)  # fmt: skip
SAGS = (1 / 25, 1 / 80, 1 / 384, 1 / 600, 1 / 800, 1 / 250, 5 / 384, 1 / 185, 1 / 80)  # of the first nine


def _loads(
    random: np.random.Generator, sides: tuple[float, float], per_area: float, free: Sequence[str]
) -> Part:
    """Return the weight and loads of its size; per_area: weight [N/m²]; free: free edges."""
    slant, turn = random.uniform(0.1, 1.0), random.uniform(0.0, 2.0 * np.pi)
    sideways = np.sin(slant) * np.array([np.cos(turn), np.sin(turn)])
    slanting = {"acceleration": [*(GRAVITY * sideways).tolist(), -GRAVITY * float(np.cos(slant))]}
    place = (random.uniform(0.2, 0.9, 2) * sides).tolist()
    weight = per_area * sides[0] * sides[1]
    point = {"kind": "point", "at": place, "force": [0.0, 0.0, _either(random, 0.1, 1.0) * weight]}
    pressure = {"kind": "pressure", "value": _either(random, 0.2, 1.0) * per_area}
    options: list[Part] = [
        DOWN,
        {"gravity": slanting},
        {**DOWN, "load": [point]},
        {**DOWN, "load": [pressure]},
        {"load": [pressure]},
        {"load": [point]},
    ]
    if free:
        edge = free[int(random.integers(len(free)))]
        length = sides[EDGES[edge].along_axis]
        force = random.uniform(-0.5, 0.5, 3) * weight / length
        moment = _either(random, 0.02, 0.1) * weight * sides[EDGES[edge].normal_axis] / length
        along = {"kind": "edge", "edge": edge, "force_per_length": force.tolist()}
        options.append({"load": [{**along, "moment_per_length": moment}]})
    return options[int(random.integers(len(options)))]


def _features(
    random: np.random.Generator, edges: Edges, sheet: Sheet, material: Material, sag: float
) -> dict[str, Part]:
    """Return the tables of a scene of each kind. sag: approximate deflection of the middle in q a⁴/D, the
    largest distance of obstacles."""
    sides, short, h = sheet.lengths, min(sheet.lengths), sheet.thickness
    given, plan = material.model_dump(exclude_defaults=True), sheet.model_dump(exclude_defaults=True)
    per_area, bending = material.density * h, material.young * h**3 / (12.0 * (1.0 - material.poisson**2))
    gap = random.uniform(0.1, 0.5) * short * min(sag * per_area * GRAVITY * short**3 / bending, 0.3)
    at, low, size = (random.uniform(a, b, 2) * sides for a, b in ((0.3, 0.7), (0.1, 0.5), (0.2, 0.4)))
    box = {axis: [low[i], low[i] + size[i]] for i, axis in enumerate("xy")}
    near = np.array([[0.1, 0.1], [0.9, 0.1], [0.5, 0.9]]) + random.uniform(-0.08, 0.08, (3, 2))
    across, edge = material.young / _log(random, 2.0, 60.0), sides[EDGES[edges[2]].along_axis]
    fibres = {"young_1": material.young, "young_2": across, "poisson_12": 0.3, "shear_12": 0.4 * across}
    bend, turn = _either(random, 0.1, 0.5) / short, random.uniform(0.0, np.pi)
    ends = h * (1.0 + _either(random, 0.1, 0.4) * np.array([-1.0, 1.0]))
    rod = {"bending_stiffness": 0.5 * bending * edge, "line_density": 0.1 * per_area * edge}
    chain = {"edge": edges[2], "segments": 6, "radius": 0.5 * h, "curvature": bend, **rod}
    hole, body = random.uniform(0.1, 0.25) * short, random.uniform(0.1, 0.5) * short
    axis = [np.cos(turn), np.sin(turn), 0.0]
    round_body = {"position": [*at, -0.5 * h - gap - body], "radius": body}
    return {
        "plain": {},
        "natural": {"natural": {"curvature": random.uniform(-0.5, 0.5, 3) / short}},
        "fibres": {"material": {"kind": "orthotropic", **fibres, "angle": turn, "density": material.density}},
        "patch": {
            "patch": [{"shape": {"rectangle": box}, "young": _log(random, 2.0, 10.0) * material.young}]
        },
        "payload": {"mass": [{"mass": random.uniform(0.1, 1.0) * per_area * sides[0] * sides[1], "at": at}]},
        "points": {"support": [{"kind": "point", "at": place * sides} for place in near]},
        "rubber": {"material": {**given, "law": "neo-hookean"}},
        "hole": {"cutout": [{"shape": {"circle": {"centre": at, "radius": hole}}}]},
        "temperature": {"material": {**given, "expansion": 2e-4}, "temperature": {"gradient": bend / 2e-4}},
        "taper": {"sheet": {**plan, f"taper_{'xy'[int(turn > 1.0)]}": ends}},
        "chain": {"support": _supports("clamped", edges[:1]), "actuator": [chain]},
        "plane": {"obstacle": [{"kind": "plane", "position": [*at, -0.5 * h - gap]}]},
        "ball": {"obstacle": [{"kind": "sphere", **round_body}]},
        "cylinder": {"obstacle": [{"kind": "cylinder", "axis": axis, **round_body}]},
    }
