"""Random inputs of the program: scenes, command lines and measured files, valid ones and mutated ones.

A scene is drawn from a grammar of sound ones, or is one of the catalogue; a mutation then drops, doubles,
swaps, renames or replaces values anywhere in it, and another breaks its text.
"""

import copy
import tomllib
from math import cos, pi, sin
from typing import Any

import tomlkit
from hypothesis import strategies as st

from sheetbench import scenes

EDGES = ("x0", "x1", "y0", "y1")
CATALOGUE = {name: tomllib.loads(path.read_text("utf-8")) for name, path in scenes.catalogue().items()}
HOSTILE: tuple[Any, ...] = (
    *(0, 1, -1, 3, 10**30, -0.0, 0.5, 1e-308, 5e-324, 1e308, -1e308, float("inf"), float("nan")),
    *("", "x0", "clamped", "nan", "\x1b[31m", "$x_", "=1+1", "<b>|", "a\nb", "é", "9" * 4400, True, False),
    *([], {}, [[]], [{}], [0.0], [1.0, 2.0], [0.0, 0.0, -9.81], ["x", "x"], {"time": [0.0], "factor": [1.0]}),
    *({"kind": "clamped"}, [[0.0, 0.1], [0.1, 0.1]], [1e308] * 3, list(range(50))),
)
BROKEN = (
    *("\x00", "\x1b[2J", "[[", "]]", "= 3", "a = " + "[" * 500, "a = " + "{a = " * 500, "9" * 4400, "'''"),
    *(".".join("a" * 600) + " = 1", "[a]\n[a]\n", "\ufeff", '"\\ud800"', "#\r", "1979-05-27T07:32:00Z"),
)
OPTIONS = {  # verb → its options, without one that names what is run
    "calibrate": "--grid --layer-distance --k --young --poisson --thickness --side --calibration",
    "check": "",
    "compare": "--lumped --elements --calibration --k --layer-distance --reference --model",
    "simulate": "--lumped --duration --step --every --integrator --calibration",
    "modes": "--lumped --elements --count --calibration --reference --about",
}
SMALL = {  # what keeps a run short; a mutation comes after it and wins
    "compare": "--lumped 3 --elements 2 --no-uncertainty",
    "simulate": "--lumped 3 --duration 0.004 --every 0.002",
    "modes": "--lumped 3 --elements 2 --count 2",
}
WORDS = (
    *("", " ", "0", "1", "-1", "2", "3", "3x2", "2x2x3", "0x0", "3.5", "1e-308", "1e308", "-1e308", "nan"),
    *("consistent", "uniform", "cauchy", "moduli", "verlet", "midpoint", "plate", "shell", "solid", "inf"),
    *("true", "weight", "é", "\x1b[31m", "../../etc", "--json", "9" * 30, "lumped:grid=3", "lumped:grid=,"),
    "a:b",
)


def numbers(least: float, most: float) -> st.SearchStrategy[float]:
    return st.floats(least, most, allow_subnormal=False).map(lambda value: float(f"{value:.4g}"))


@st.composite
def sound(draw: st.DrawFn) -> dict[str, Any]:
    """Draw a scene of the grammar: valid keys, numbers of sheets; it may be refused nevertheless."""
    side, aspect = draw(numbers(0.05, 0.5)), draw(st.sampled_from([1.0, 1.0, 0.5, 1.7, 3.0]))
    lengths = [side, side * aspect]
    data: dict[str, Any] = {
        "name": "drawn",
        "sheet": {
            "length_x": lengths[0],
            "length_y": lengths[1],
            "thickness": side * draw(st.sampled_from([3e-3, 0.016, 0.05])),
        },
        "material": {
            "young": draw(st.sampled_from([1e6, 1e7, 54.5e6])),
            "poisson": draw(st.sampled_from([0.0, 0.3, 0.48])),
            "density": 1000.0,
        },
        "probes": {"A": [0.5 * lengths[0], 0.5 * lengths[1]], "B": [lengths[0], lengths[1]]},
    }
    if draw(st.booleans()):
        data["gravity"] = {"acceleration": draw(st.lists(numbers(-10.0, 10.0), min_size=3, max_size=3))}
    edges = draw(st.permutations(EDGES))
    held = draw(st.integers(1, 3))
    data["support"] = [draw(support(edge)) for edge in edges[:held]]
    if draw(st.booleans()):
        data["support"].append(draw(pin(lengths)))
    if draw(st.integers(0, 2)) == 0:
        data["natural"] = draw(natural(side))
    if draw(st.integers(0, 2)) == 0:
        data["material"]["expansion"] = 1e-4
        data["temperature"] = {"change": draw(numbers(-50.0, 50.0)), "gradient": draw(numbers(-1e3, 1e3))}
    data["load"] = draw(st.lists(load(lengths), max_size=2))
    data["mass"] = draw(st.lists(payload(lengths), max_size=2))
    if held < 3 and draw(st.booleans()):
        data["actuator"] = [draw(actuator(edges[held]))]
    return data


@st.composite
def shape(draw: st.DrawFn, lengths: list[float]) -> dict[str, Any]:
    """Draw a shape about a point of the sheet, its sides on lines of coarse grids or not."""
    share = st.sampled_from([0.0, 0.25, 0.5, 0.75, 1.0]) | numbers(-0.1, 1.1)
    middle = [draw(share) * length for length in lengths]
    size = draw(st.sampled_from([0.125, 0.25, 0.5]) | numbers(0.02, 0.4))
    kind = draw(st.sampled_from(["rectangle", "circle", "polygon"]))
    if kind == "circle":
        return {"circle": {"centre": middle, "radius": 0.5 * size * min(lengths)}}
    if kind == "rectangle":
        x, y = (
            [at - side, at + side]
            for at, side in zip(middle, (0.5 * size * length for length in lengths), strict=True)
        )
        return {"rectangle": {"x": x, "y": y}}
    turns = sorted(draw(st.sets(st.integers(0, 11), min_size=3, max_size=6)))
    radii = [draw(st.sampled_from([0.5, 1.0])) * size * min(lengths) for _ in turns]
    corners = zip(radii, (turn * pi / 6.0 for turn in turns), strict=True)
    return {"polygon": [[middle[0] + r * cos(a), middle[1] + r * sin(a)] for r, a in corners]}


@st.composite
def shaped(draw: st.DrawFn) -> dict[str, Any]:
    """Draw a scene of the grammar with an outline, cutouts and patches, and supports and loads in shapes."""
    data = draw(sound())
    lengths = [data["sheet"]["length_x"], data["sheet"]["length_y"]]
    del data["probes"]
    data.pop("actuator", None)
    if draw(st.booleans()):
        cut = [draw(st.sampled_from([0.0, 0.1, 0.3])) for _ in range(4)]
        at = [(cut[0], 0.0), (1.0, cut[1]), (1.0 - cut[2], 1.0), (0.0, 1.0 - cut[3])]
        data["sheet"]["outline"] = [[x * lengths[0], y * lengths[1]] for x, y in at]
    data["cutout"] = [{"shape": draw(shape(lengths))} for _ in range(draw(st.integers(0, 3)))]
    own = st.just({"young": 1e7}) | natural(min(lengths)).map(lambda it: {"natural": it})
    data["patch"] = [
        {"shape": draw(shape(lengths)), **draw(own)} for _ in range(draw(st.sampled_from([0, 0, 1])))
    ]
    if draw(st.booleans()):
        data["support"].append({"kind": "clamped", "where": draw(shape(lengths))})
    force = draw(st.lists(numbers(-2.0, 2.0), min_size=3, max_size=3))
    loads = {"kind": "pressure", "value": 5.0}, {"kind": "area", "force_per_area": force}
    if draw(st.booleans()):
        data["load"].append({**draw(st.sampled_from(loads)), "where": draw(shape(lengths))})
    if draw(st.booleans()):
        data["mass"].append({"mass": draw(numbers(1e-5, 0.1)), "where": draw(shape(lengths))})
    return data


@st.composite
def support(draw: st.DrawFn, edge: str) -> dict[str, Any]:
    kind = draw(st.sampled_from(["clamped", "clamped", "hinged", "held", "curved", "symmetric"]))
    more: dict[str, Any] = {
        "held": {"components": draw(st.lists(st.sampled_from("xyz"), min_size=1, unique=True))},
        "curved": {"curvature": draw(numbers(-4.0, 4.0))},
        "clamped": draw(st.sampled_from([{}, {"tilt": 0.2}, {"tilt": -0.1}])),
    }.get(kind, {})
    return {"edge": edge, "kind": kind, **more}


@st.composite
def pin(draw: st.DrawFn, lengths: list[float]) -> dict[str, Any]:
    """Draw a held point, on lines of the coarsest grid."""
    at = [draw(st.sampled_from([0.0, 0.5, 1.0])) * length for length in lengths]
    return {
        "kind": "point",
        "at": at,
        "components": draw(st.lists(st.sampled_from("xyz"), min_size=1, unique=True)),
    }


@st.composite
def natural(draw: st.DrawFn, side: float) -> dict[str, Any]:
    """Draw a natural strain up to 3 %, a curvature up to 1.5 rad over the side; with a history or not."""
    strain = draw(st.lists(numbers(-0.03, 0.03), min_size=3, max_size=3))
    curvature = [turn / side for turn in draw(st.lists(numbers(-1.5, 1.5), min_size=3, max_size=3))]
    data: dict[str, Any] = {"strain": strain, "curvature": curvature}
    if draw(st.booleans()):
        data["history"] = {"time": [0.0, 1.0], "factor": [0.0, draw(numbers(-1.0, 1.0))]}
    return data


@st.composite
def payload(draw: st.DrawFn, lengths: list[float]) -> dict[str, Any]:
    """Draw a body at a point, or over a part with moments of inertia, small or large beside the sheet."""
    at = [draw(st.sampled_from([0.0, 0.3, 1.0])) * length for length in lengths]
    data: dict[str, Any] = {"at": at, "mass": draw(numbers(1e-5, 0.1))}
    if draw(st.booleans()):
        x, y = lengths
        data["where"] = {"rectangle": {"x": [0.0, 0.5 * x], "y": [0.0, 0.5 * y]}}
        del data["at"]
        data["inertia"] = draw(st.lists(numbers(0.0, 1e-5), min_size=3, max_size=3))
    return data


@st.composite
def load(draw: st.DrawFn, lengths: list[float]) -> dict[str, Any]:
    force = draw(st.lists(numbers(-0.2, 0.2), min_size=3, max_size=3))
    share = draw(st.sampled_from([0.0, 0.3, 1.0]))
    point = {"kind": "point", "at": [share * length for length in lengths], "force": force}
    edge = {"kind": "edge", "edge": "x1", "force_per_length": force, "moment_per_length": 0.1 * force[0]}
    data = draw(st.sampled_from([point, edge, {"kind": "pressure", "value": 100.0 * force[1]}]))
    if draw(st.booleans()):
        data["history"] = {"time": [0.0, 1.0], "factor": [1.0, draw(numbers(-1.0, 1.0))]}
    return data


@st.composite
def actuator(draw: st.DrawFn, edge: str) -> dict[str, Any]:
    if draw(st.integers(0, 3)) == 0:
        moved = draw(st.lists(numbers(-0.005, 0.005), min_size=3, max_size=3))
        return {"kind": "motion", "edge": edge, "time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], moved]}
    return {
        "edge": edge,
        "segments": draw(st.integers(1, 4)),
        "bending_stiffness": draw(st.sampled_from([0.002, 0.2])),
        "line_density": 0.05,
        "radius": 1.5e-3,
        "face": draw(st.sampled_from(["mid", "top", "bottom"])),
        "curvature": draw(numbers(-4.0, 4.0)),
    }


def places(data: Any) -> list[tuple[Any, Any]]:
    """Return every (container, key) of a document."""
    keys = data.keys() if isinstance(data, dict) else range(len(data)) if isinstance(data, list) else ()
    return [place for key in keys for place in [(data, key), *places(data[key])]]


@st.composite
def documents(draw: st.DrawFn) -> dict[str, Any]:
    """Draw a scene's keys and values, mutated up to four times."""
    data = copy.deepcopy(draw(st.one_of(st.sampled_from(list(CATALOGUE.values())), sound())))
    for _ in range(draw(st.integers(0, 4))):
        if not (found := places(data)):
            break
        inside, key = draw(st.sampled_from(found))
        match draw(st.sampled_from(["replace", "replace", "scale", "drop", "double", "rename", "swap"])):
            case "replace":
                inside[key] = copy.deepcopy(draw(st.sampled_from(HOSTILE)))
            case "scale" if isinstance(inside[key], float):
                inside[key] *= 10.0 ** draw(st.integers(-12, 12))
            case "drop":
                del inside[key]
            case "double" if isinstance(inside, list):
                inside.append(copy.deepcopy(inside[key]))
            case "rename" if isinstance(inside, dict):
                inside[draw(st.sampled_from(["x", "yung", "a.b", "", "support"]))] = inside.pop(key)
            case "swap":
                other, its = draw(st.sampled_from(found))
                inside[key] = copy.deepcopy(other[its]) if key in _keys(inside) and its in _keys(other) else 0
    return data


def _keys(inside: Any) -> Any:
    return inside if isinstance(inside, dict) else range(len(inside))


@st.composite
def texts(draw: st.DrawFn) -> bytes:
    """Draw a scene's file: a document's, sometimes with its text broken."""
    try:
        text = tomlkit.dumps(draw(documents()))
    except (ValueError, TypeError):  # nothing that TOML can say, such as a list of tables and numbers
        text = tomlkit.dumps(CATALOGUE["curved-edge"])
    return _broken(draw, text.encode("utf-8", "surrogatepass"), BROKEN)


def _broken(draw: st.DrawFn, text: bytes, pieces: tuple[str, ...]) -> bytes:
    """Return a text, one time in four cut, overwritten or interspersed."""
    if draw(st.integers(0, 3)):
        return text
    at = draw(st.integers(0, len(text)))
    piece = draw(st.one_of(st.sampled_from(pieces).map(lambda p: p.encode("utf-8")), st.binary(max_size=8)))
    return text[:at] + piece + text[at + draw(st.sampled_from([0, 0, 5, 10**6])) :]


@st.composite
def command_lines(draw: st.DrawFn) -> list[str]:
    """Draw a verb, its scene and up to three options with arbitrary values; short runs otherwise."""
    verb = draw(st.sampled_from(list(OPTIONS)))
    arguments = [verb, draw(st.sampled_from([*CATALOGUE, "no-such-scene"])), *SMALL.get(verb, "").split()]
    for _ in range(draw(st.integers(0, 3)) if OPTIONS[verb] else 0):
        option = draw(st.sampled_from(OPTIONS[verb].split()))
        arguments += [option, draw(st.one_of(st.sampled_from(WORDS), numbers(-10.0, 10.0).map(str)))]
    return [*arguments, *(["--json"] if draw(st.booleans()) else [])]


ROW = ("0.188,0.188,-0.0004,-0.0004,-0.0135", "0.094,0.094,0,0,-0.00245", "0.1,0.15,,,-0.0075", "0.1,0.1,1,,")
CELLS = (
    *("", "nan", "-inf", "inf", "1e308", "1e-308", "1,5", "x", "P4", '"', '"a', ";", "\t", "#", "\x00"),
    *("\n\n", "9" * 140_000, "x,y,uz", "time", "-", "0x10", "١", "\ufeff", "=1+1"),
)


@st.composite
def measured_files(draw: st.DrawFn) -> bytes:
    """Draw a table of measured displacements, or of a motion's samples, cells replaced and its text
    broken."""
    head = draw(
        st.sampled_from(["x,y,ux,uy,uz", "time,probe,ux,uy,uz", "probe,ux,uy,uz", "x;y;uz", "X\tY\tuz [m]"])
    )
    rows = draw(st.lists(st.sampled_from(ROW), min_size=1, max_size=5))
    if head.startswith(("time", "probe")):
        first = "0.001,P4," if head.startswith("time") else "P4,"
        rows = [first + row.split(",", 2)[2] for row in rows]
    cells = [[head], *(row.split(",") for row in rows)]
    for _ in range(draw(st.integers(0, 3))):
        row = draw(st.sampled_from(cells))
        row[draw(st.integers(0, len(row) - 1))] = draw(st.sampled_from(CELLS))
    return _broken(draw, "\n".join(",".join(row) for row in cells).encode("utf-8"), CELLS)
